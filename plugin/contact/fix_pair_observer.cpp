#include "contact/fix_pair_observer.h"

#include "contact/pair_motion.h"

#include <algorithm>

using namespace LAMMPS_NS;
namespace engine = drumlin::engine;
namespace physics = drumlin::physics;

int FixPairObserver::setmask() {
  return FixConst::POST_INTEGRATE | FixConst::PRE_EXCHANGE | FixConst::PRE_NEIGHBOR | FixConst::END_OF_STEP;
}

void FixPairObserver::init() {
  source_ = drumlin::contact_source(lmp);
  if (source_ == nullptr)
    error->all(FLERR, engine::error_text(drumlin::other_pair_style(lmp, std::string("fix ") + style)));
}

void FixPairObserver::setup(int) {
  states_.clear(); // a run begins with the present positions and velocities
  list_pairs();
}

void FixPairObserver::list_pairs() {
  pairs_.clear();
  const NeighList *list = source_->contact_list();
  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    for (int jj = 0; jj < list->numneigh[i]; ++jj) {
      const int j = engine::neighbour_index(list->firstneigh[i][jj]);
      if (!engine::owns_pair(lmp, i, j) || !selects(i, j)) continue;
      const Tags tags = std::minmax(atom->tag[i], atom->tag[j]);
      const double *remembered = source_->law_memory(i, jj);
      State state{};
      if (const auto known = states_.find(tags); known != states_.end()) {
        state = known->second;
      } else {
        const drumlin::PairMotion now = drumlin::pair_motion(*atom, i, j);
        state = {{now.overlap, now.rate}, drumlin::memory_at(remembered)};
        // The balls have become neighbours during the run. One step earlier the gap between them was about as
        // large as the neighbour skin.
        if (!update->setupflag) state = {{now.overlap - dt_ * now.rate, now.rate}, 0.0};
      }
      pairs_.push_back({i, j, tags, remembered, {*source_, i, j, state.memory}, state});
    }
  }
  states_.clear();
  pairs_outdated_ = false;
}

void FixPairObserver::post_integrate() { dt_ = update->dt; }

void FixPairObserver::pre_exchange() {
  // The balls may move to other ranks now. Each rank therefore gets the overlaps and rates of all pairs.
  struct Entry {
    int tag_i, tag_j;
    State state;
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

void FixPairObserver::pre_neighbor() { pairs_outdated_ = true; }

void FixPairObserver::pack_ghosts(int n, const int *list, double *buf) {
  drumlin::pack_velocities(*atom, n, list, buf, velocity_of_ghosts());
}
void FixPairObserver::unpack_ghosts(int n, int first, double *buf) {
  drumlin::unpack_velocities(*atom, n, first, buf);
}

void FixPairObserver::end_of_step() {
  if (comm->nprocs > 1 || atom->nghost > 0) engine::forward_comm(comm, this);
  if (pairs_outdated_) list_pairs();
  for (Pair &pair : pairs_) {
    const drumlin::PairMotion motion = drumlin::pair_motion(*atom, pair.i, pair.j);
    const physics::OverlapState now{motion.overlap, motion.rate};
    pair.law.follow(*source_, pair.i, pair.j, pair.state.memory);
    see_pair({pair.tags.first, pair.tags.second, pair.law.law(), source_->suction(pair.i, pair.j), dt_,
              pair.state.overlap, now});
    pair.state = {now, drumlin::memory_at(pair.memory)};
  }
}
