#pragma once
// Functions whose names or parameters differ between releases of LAMMPS, from 29 Sep 2021 on.
// plugin/lammps/CMakeLists.txt looks into the headers of the release that the plugin is built for, and
// defines each DRUMLIN_LAMMPS_... as 1 if the release has the feature, else as 0.

#include "comm.h"
#include "domain.h"
#include "fix.h"
#include "force.h"
#include "input.h"
#include "lammps.h"
#include "lmptype.h"
#include "modify.h"
#include "neigh_request.h"
#include "neighbor.h"
#include "pair.h"
#include "region.h"

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

namespace drumlin::engine::version {

inline void forward_comm(LAMMPS_NS::Comm *comm, LAMMPS_NS::Fix *fix) {
#if DRUMLIN_LAMMPS_COMM_OVERLOADS
  comm->forward_comm(fix);
#else
  comm->forward_comm_fix(fix);
#endif
}

inline void forward_comm(LAMMPS_NS::Comm *comm, LAMMPS_NS::Pair *pair) {
#if DRUMLIN_LAMMPS_COMM_OVERLOADS
  comm->forward_comm(pair);
#else
  comm->forward_comm_pair(pair);
#endif
}

inline void reverse_comm(LAMMPS_NS::Comm *comm, LAMMPS_NS::Fix *fix) {
#if DRUMLIN_LAMMPS_COMM_OVERLOADS
  comm->reverse_comm(fix);
#else
  comm->reverse_comm_fix(fix);
#endif
}

/// All fixes, in the order of the deck.
inline std::vector<LAMMPS_NS::Fix *> fixes(LAMMPS_NS::Modify *modify) {
#if DRUMLIN_LAMMPS_FIX_LIST
  return modify->get_fix_list();
#else
  std::vector<LAMMPS_NS::Fix *> all(static_cast<std::size_t>(modify->nfix));
  std::copy_n(modify->fix, modify->nfix, all.begin());
  return all;
#endif
}

/// A fix by its ID, or nullptr.
inline LAMMPS_NS::Fix *find_fix(LAMMPS_NS::Modify *modify, const std::string &id) {
#if DRUMLIN_LAMMPS_FIX_LIST
  return modify->get_fix_by_id(id);
#else
  const int index = modify->find_fix(id);
  return index < 0 ? nullptr : modify->fix[index];
#endif
}

/// When the engine calls a fix: the bits of FixConst.
inline int fix_mask(LAMMPS_NS::Modify *modify, LAMMPS_NS::Fix *fix) {
#if DRUMLIN_LAMMPS_FIX_MASK
  return modify->get_fix_mask(fix);
#else
  for (int n = 0; n < modify->nfix; ++n)
    if (modify->fix[n] == fix) return modify->fmask[n];
  return 0;
#endif
}

/// A region by its ID, or nullptr.
inline LAMMPS_NS::Region *find_region(LAMMPS_NS::Domain *domain, const std::string &id) {
#if DRUMLIN_LAMMPS_REGION_BY_ID
  return domain->get_region_by_id(id);
#else
  const int index = domain->find_region(id);
  return index < 0 ? nullptr : domain->regions[index];
#endif
}

inline void minimum_image(LAMMPS_NS::Domain *domain, double *d) {
#if DRUMLIN_LAMMPS_IMAGE_SAYS_WHERE
  domain->minimum_image(FLERR, d);
#else
  domain->minimum_image(d[0], d[1], d[2]);
#endif
}

/// Requests the neighbour list of a pair style for balls of finite size. \param history whether the list has
/// a contact history
inline void request_list(LAMMPS_NS::Neighbor *neighbor, LAMMPS_NS::Pair *pair, int instance, bool history) {
#if DRUMLIN_LAMMPS_LIST_FLAGS
  (void)instance;
  neighbor->add_request(pair,
                        LAMMPS_NS::NeighConst::REQ_SIZE | (history ? LAMMPS_NS::NeighConst::REQ_HISTORY : 0));
#else
  const int index = neighbor->request(pair, instance); // may reallocate the array of requests
  LAMMPS_NS::NeighRequest *request = neighbor->requests[index];
  request->size = 1;
  request->history = history ? 1 : 0;
#endif
}

/// Enters a style of a plugin that another instance in the process has loaded into the list of this one.
/// Later releases have one list for all instances. \param category pair, fix or command \param make the
/// style's creator, in any type
inline void enter_style([[maybe_unused]] LAMMPS_NS::LAMMPS *lmp, [[maybe_unused]] const std::string &category,
                        [[maybe_unused]] const char *name, [[maybe_unused]] void (*make)()) {
#if DRUMLIN_LAMMPS_STYLES_OF_INSTANCE
  // The cast of the function's type is the one that the engine's own plugin interface makes.
  const auto enter = [&](auto &styles) {
    styles[name] = reinterpret_cast<typename std::decay_t<decltype(styles)>::mapped_type>(make);
  };
  if (category == "pair")
    enter(*lmp->force->pair_map);
  else if (category == "fix")
    enter(*lmp->modify->fix_map);
  else
    enter(*lmp->input->command_map);
#endif
}

} // namespace drumlin::engine::version

/// The parameters of Pair::transfer_history() that follow the two arrays.
#if DRUMLIN_LAMMPS_TRANSFER_TYPES
#define DRUMLIN_TRANSFER_TYPES , int, int
#else
#define DRUMLIN_TRANSFER_TYPES
#endif
