#include "fixes/fix_contact_events.h"

#include "support/arguments.h"
#include "contact/pair_motion.h"
#include "support/restart_record.h"

#include <algorithm>
#include <fmt/format.h>
#include <tuple>

using namespace LAMMPS_NS;
namespace engine = drumlin::engine;
namespace physics = drumlin::physics;

namespace {

constexpr const char *command = "fix contact/events";
constexpr const char *file_keyword = "fix contact/events: keyword file";
/// Steps between two writes, which are collective: an event stays in memory for at most as many steps.
constexpr int write_interval = 1000;

std::string file_argument(Error *error, int narg, char **arg) {
  drumlin::Arguments in(error, command, narg - 3, arg + 3);
  if (in.empty() || in.peek() != "file")
    in.fail("keyword file is missing; allowed: file NAME as the first keyword");
  in.word("keyword");
  return in.word("keyword file", drumlin::output_name_allowed);
}

bool append_argument(int narg, char **arg) {
  for (int n = 3; n + 1 < narg; ++n)
    if (std::string(arg[n]) == "append") return std::string(arg[n + 1]) == "yes";
  return false;
}

} // namespace

FixContactEvents::FixContactEvents(LAMMPS *lammps, int narg, char **arg)
    : GhostFix(lammps, narg, arg), file_(file_argument(error, narg, arg), append_argument(narg, arg)) {
  scalar_flag = 1;
  extscalar = 0;
  global_freq = 1;
  nevery = 1;
  restart_global = 1;
  time_depend = 1;
  comm_forward = 3;

  drumlin::Arguments in(error, command, narg - 5, arg + 5);
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "types") {
      for (int &type : types_)
        type = static_cast<int>(in.integer("keyword types", 1, atom->ntypes));
    } else if (keyword == "between") {
      for (int &bit : groupbits_)
        bit = group->bitmask[in.group("keyword between", group)];
    } else if (keyword == "append") {
      in.choice("keyword append", {"yes", "no"});
    } else {
      in.fail("keyword", keyword, "types, between or append");
    }
  }
}

int FixContactEvents::setmask() {
  return FixConst::PRE_EXCHANGE | FixConst::PRE_NEIGHBOR | FixConst::END_OF_STEP | FixConst::POST_RUN;
}

void FixContactEvents::init() {
  source_ = drumlin::contact_source(lmp);
  if (source_ == nullptr) error->all(FLERR, engine::error_text(drumlin::other_pair_style(lmp, command)));
  drumlin::OutputFile::check(file_.name(), comm, error, world, file_keyword);
}

void FixContactEvents::setup(int) {
  clock_.set_up(update->ntimestep, update->dt);
  file_.open(comm, error, world, file_keyword, "time,event,overlap,overlap_rate,force,id_i,id_j");
  states_.clear(); // at set-up positions and velocities tell whether a contact acts
  list_pairs();
}

bool FixContactEvents::is_selected(int i, int j) const {
  const int *mask = atom->mask;
  if (!(mask[i] & groupbit) || !(mask[j] & groupbit)) return false;
  if (!engine::owns_pair(lmp, i, j)) return false;
  if (groupbits_[0] != 0 && !((mask[i] & groupbits_[0]) && (mask[j] & groupbits_[1])) &&
      !((mask[i] & groupbits_[1]) && (mask[j] & groupbits_[0])))
    return false;
  if (types_[0] == 0) return true;
  const int a = atom->type[i];
  const int b = atom->type[j];
  return (a == types_[0] && b == types_[1]) || (a == types_[1] && b == types_[0]);
}

void FixContactEvents::list_pairs() {
  pairs_.clear();
  const NeighList *list = source_->contact_list();
  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    for (int jj = 0; jj < list->numneigh[i]; ++jj) {
      const int j = engine::neighbour_index(list->firstneigh[i][jj]);
      if (!is_selected(i, j)) continue;
      Pair pair{i, j, std::minmax(atom->tag[i], atom->tag[j]), source_->law(i, j), {}};
      if (const auto known = states_.find(pair.tags); known != states_.end()) {
        pair.state = known->second;
      } else {
        const drumlin::PairMotion now = drumlin::pair_motion(*atom, i, j);
        pair.state = {now.overlap, now.rate};
        // A pair that is new in the list during a run. One step earlier the gap between the balls was about
        // the neighbour skin.
        if (!update->setupflag) pair.state.overlap -= update->dt * now.rate;
      }
      pairs_.push_back(pair);
    }
  }
  states_.clear();
  pairs_outdated_ = false;
}

void FixContactEvents::pre_exchange() {
  // Balls change ranks after this: each rank gets the states of all pairs.
  struct Entry {
    int tag_i, tag_j;
    physics::OverlapState state;
  };
  std::vector<Entry> mine;
  for (const Pair &pair : pairs_)
    mine.push_back({pair.tags.first, pair.tags.second, pair.state});
  std::vector<int> bytes(static_cast<std::size_t>(comm->nprocs));
  std::vector<int> offsets(bytes.size());
  int my_bytes = static_cast<int>(mine.size() * sizeof(Entry));
  MPI_Allgather(&my_bytes, 1, MPI_INT, bytes.data(), 1, MPI_INT, world);
  int total = 0;
  for (std::size_t rank = 0; rank < bytes.size(); total += bytes[rank++])
    offsets[rank] = total;
  std::vector<Entry> all(static_cast<std::size_t>(total) / sizeof(Entry));
  MPI_Allgatherv(mine.data(), my_bytes, MPI_BYTE, all.data(), bytes.data(), offsets.data(), MPI_BYTE, world);
  states_.clear();
  for (const Entry &entry : all)
    states_[{entry.tag_i, entry.tag_j}] = entry.state;
}

void FixContactEvents::pre_neighbor() { pairs_outdated_ = true; }

void FixContactEvents::refresh_ghost_velocities() {
  if (comm->nprocs > 1 || atom->nghost > 0) engine::forward_comm(comm, this);
}

void FixContactEvents::pack_ghosts(int n, const int *list, double *buf) {
  drumlin::pack_velocities(*atom, n, list, buf);
}
void FixContactEvents::unpack_ghosts(int n, int first, double *buf) {
  drumlin::unpack_velocities(*atom, n, first, buf);
}

void FixContactEvents::end_of_step() {
  refresh_ghost_velocities();
  if (pairs_outdated_) list_pairs();
  const double dt = update->dt;
  for (Pair &pair : pairs_) {
    const drumlin::PairMotion motion = drumlin::pair_motion(*atom, pair.i, pair.j);
    const physics::OverlapState now{motion.overlap, motion.rate};
    const auto event = std::visit(
        [&](const auto &law) { return physics::locate_transition(law, dt, pair.state, now); }, pair.law);
    if (event)
      pending_.push_back({clock_.time(update->ntimestep - 1) + event->since, event->make ? 1 : 0,
                          event->overlap, event->rate, event->force, pair.tags.first, pair.tags.second});
    pair.state = now;
  }
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
  file_.flush(error, world, file_keyword);
  MPI_Bcast(&written, 1, MPI_LMP_BIGINT, 0, world);
  count_ += written;
}

void FixContactEvents::write_restart(FILE *file) {
  const auto state = clock_.state();
  drumlin::write_restart_record(file, comm->me, {state.begin(), state.end()});
}

void FixContactEvents::restart(char *buffer) { clock_.restore(reinterpret_cast<const double *>(buffer)); }

double FixContactEvents::compute_scalar() { return static_cast<double>(count_); }
