#include "fixes/fix_contact_events.h"

#include "support/arguments.h"
#include "support/restart_record.h"

#include <algorithm>
#include <fmt/format.h>
#include <tuple>

using namespace LAMMPS_NS;
namespace physics = drumlin::physics;

namespace {

constexpr const char *events_fix = "fix contact/events";
constexpr const char *events_file_keyword = "fix contact/events: keyword file";
/// Steps between two writes, which are collective: an event stays in memory for at most as many steps.
constexpr int write_interval = 1000;

std::string file_argument(Error *error, int narg, char **arg) {
  drumlin::Arguments in(error, events_fix, narg - 3, arg + 3);
  if (in.empty() || in.peek() != "file")
    in.fail("keyword file is missing; allowed: file NAME as the first keyword");
  in.word("keyword");
  return in.word("keyword file", drumlin::output_name_allowed);
}

bool append_argument(LAMMPS *lmp, int narg, char **arg) {
  for (int n = 3; n + 1 < narg; ++n)
    if (std::string(arg[n]) == "append") return std::string(arg[n + 1]) == "yes";
  return drumlin::engine::continues(lmp);
}

} // namespace

FixContactEvents::FixContactEvents(LAMMPS *lammps, int narg, char **arg)
    : FixPairObserver(lammps, narg, arg),
      file_(file_argument(error, narg, arg), append_argument(lammps, narg, arg)) {
  scalar_flag = 1;
  extscalar = 0;
  global_freq = 1;
  nevery = 1;
  restart_global = 1;
  time_depend = 1;

  drumlin::Arguments in(error, events_fix, narg - 5, arg + 5);
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "types") {
      for (int &type : types_)
        type = static_cast<int>(in.integer("keyword types", 1, atom->ntypes));
    } else if (keyword == "between") {
      for (int &bit : groupbits_)
        bit = drumlin::engine::group_bit(in.group("keyword between", group));
    } else if (keyword == "append") {
      in.choice("keyword append", {"yes", "no"});
    } else {
      in.fail("keyword", keyword, "types, between or append");
    }
  }
}

int FixContactEvents::setmask() { return FixPairObserver::setmask() | FixConst::POST_RUN; }

void FixContactEvents::init() {
  FixPairObserver::init();
  drumlin::OutputFile::check(file_.name(), comm, error, world, events_file_keyword);
}

void FixContactEvents::setup(int vflag) {
  clock_.set_up(update->ntimestep, update->dt);
  file_.open(comm, error, world, events_file_keyword, "time,event,overlap,overlap_rate,force,id_i,id_j");
  FixPairObserver::setup(vflag);
}

bool FixContactEvents::selects(int i, int j) const {
  const int *mask = atom->mask;
  if (!(mask[i] & groupbit) || !(mask[j] & groupbit)) return false;
  if (groupbits_[0] != 0 && !((mask[i] & groupbits_[0]) && (mask[j] & groupbits_[1])) &&
      !((mask[i] & groupbits_[1]) && (mask[j] & groupbits_[0])))
    return false;
  if (types_[0] == 0) return true;
  const int a = atom->type[i];
  const int b = atom->type[j];
  return (a == types_[0] && b == types_[1]) || (a == types_[1] && b == types_[0]);
}

void FixContactEvents::see_pair(const drumlin::PairStep &pair) {
  const auto event = std::visit(
      [&](const auto &law) {
        return physics::locate_transition(law, pair.dt, pair.before, pair.after, pair.suction);
      },
      pair.law);
  if (event)
    pending_.push_back({clock_.time(update->ntimestep - 1) + event->since, event->make ? 1 : 0,
                        event->overlap, event->rate, event->force, pair.tag_i, pair.tag_j});
}

void FixContactEvents::post_integrate() {
  FixPairObserver::post_integrate();
  clock_.follow(update->ntimestep, update->dt);
}

void FixContactEvents::end_of_step() {
  FixPairObserver::end_of_step();
  if (update->ntimestep % write_interval == 0) write_out();
}

void FixContactEvents::post_run() { write_out(); }

void FixContactEvents::write_out() {
  int my_bytes = static_cast<int>(pending_.size() * sizeof(Event));
  std::vector<int> bytes(static_cast<std::size_t>(comm->nprocs));
  std::vector<int> offsets(bytes.size());
  MPI_Gather(&my_bytes, 1, MPI_INT, bytes.data(), 1, MPI_INT, 0, world);
  int total = 0;
  for (std::size_t rank = 0; rank < bytes.size(); total += bytes[rank++])
    offsets[rank] = total;
  std::vector<Event> all(static_cast<std::size_t>(total) / sizeof(Event));
  MPI_Gatherv(pending_.data(), my_bytes, MPI_BYTE, all.data(), bytes.data(), offsets.data(), MPI_BYTE, 0,
              world);
  pending_.clear();
  // Sorted, so that the file does not depend on which rank has found an event.
  std::sort(all.begin(), all.end(), [](const Event &a, const Event &b) {
    return std::tie(a.time, a.tag_i, a.tag_j) < std::tie(b.time, b.tag_i, b.tag_j);
  });
  bigint written = static_cast<bigint>(all.size());
  for (const Event &e : all)
    std::fprintf(file_.get(), "%.17g,%s,%.17g,%.17g,%.17g,%d,%d\n", e.time, e.make ? "make" : "break",
                 e.overlap, e.rate, e.force, e.tag_i, e.tag_j);
  file_.flush(error, world, events_file_keyword);
  MPI_Bcast(&written, 1, MPI_LMP_BIGINT, 0, world);
  count_ += written;
}

void FixContactEvents::write_restart(FILE *file) {
  const auto state = clock_.state();
  drumlin::write_restart_record(file, comm->me, {state.begin(), state.end()});
}

void FixContactEvents::restart(char *buffer) { clock_.restore(reinterpret_cast<const double *>(buffer)); }

double FixContactEvents::compute_scalar() { return static_cast<double>(count_); }
