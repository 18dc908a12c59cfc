#pragma once
// The thin layer under the engine-neutral fixes and commands: what they need of LIGGGHTS, under names that an
// adapter to LAMMPS can give as well. Nothing else in plugin/fixes knows which engine it is compiled for.

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "fix_freeze.h"
#include "fix_gravity.h"
#include "fix_setforce.h"
#include "force.h"
#include "group.h"
#include "input.h"
#include "integrate.h"
#include "memory.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "output.h"
#include "pair.h"
#include "pointers.h"
#include "signal_handling.h"
#include "timer.h"
#include "update.h"
#include "variable.h"

#include <array>
#include <cstdio>
#include <string>
#include <vector>

namespace drumlin::engine {

using LAMMPS_NS::bigint;
using LAMMPS_NS::LAMMPS;

/// Name and version of the engine, for logs and run records.
inline std::string name_and_version() { return std::string("LIGGGHTS ") + LIGGGHTS_VERSION; }

/// The pair style with the plugin's law, as a deck names it.
constexpr const char *pair_style = "pair_style gran model hooke/transition";

/// A fix, with names of its own for what the engines name differently.
class GhostFix : public LAMMPS_NS::Fix {
public:
  using Fix::Fix;
  /// Numbers of owned balls for their ghosts, `comm_forward` for each of the n balls.
  virtual void pack_ghosts(int, const int *, double *) {}
  virtual void unpack_ghosts(int, int, double *) {}
  /// What ghosts gather for their owners where newton is on: never, see reverse_comm().
  virtual void pack_gathered(int, int, double *) {}
  virtual void join_gathered(int, const int *, const double *) {}
  /// When all forces of the step are known and before the closing half kick, if setmask() has `closes_forces`.
  virtual void close_forces() {}

  int pack_comm(int n, int *balls, double *numbers, int, int *) final {
    pack_ghosts(n, balls, numbers);
    return comm_forward; // for one ball
  }
  void unpack_comm(int n, int first, double *numbers) final { unpack_ghosts(n, first, numbers); }
  void pre_final_integrate() final { close_forces(); }

protected:
  /// LIGGGHTS has no potential energy that the fix's scalar could be part of; what it tallies always counts in the pressure.
  void offer_energy_and_virial() { virial_flag = 1; }
  /// To be called where forces are computed, before v_tally(); evflag then says whether it is wanted.
  void begin_virial(int vflag) { vflag ? v_setup(vflag) : void(evflag = 0); }
};
constexpr int closes_forces = LAMMPS_NS::FixConst::PRE_FINAL_INTEGRATE;

/// Bytes at the end of a restart file by which the engine knows that it is whole.
constexpr int restart_end_mark = 0;
/// What the decks read as well as a restart file, for lines on bad input: nothing.
constexpr const char *beside_restart = "";

inline void set_up_run(LAMMPS_NS::Integrate *integrate) { integrate->setup(); }

/// The words of an error as the engine's error->all() takes them.
inline const char *as_is(const std::string &words) { return words.c_str(); }

/// Tells the engine to end each run after the step, and whether it was told so, by this or by a signal of its own. To be called on all
/// ranks alike.
inline void end_runs(LAMMPS *) { LAMMPS_NS::SignalHandler::request_quit = true; }
inline bool runs_have_ended(const LAMMPS *lmp) {
  int ended = LAMMPS_NS::SignalHandler::request_quit ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &ended, 1, MPI_INT, MPI_MAX, lmp->world);
  return ended != 0;
}

/// Copies the velocities of owned balls to their ghosts through the fix's pack_comm/unpack_comm pair.
inline void forward_comm(LAMMPS_NS::Comm *comm, LAMMPS_NS::Fix *fix) { comm->forward_comm_fix(fix); }

/// Contacts that remember something need newton off in LIGGGHTS: ghosts gather nothing.
inline void reverse_comm(LAMMPS_NS::Comm *, LAMMPS_NS::Fix *) {}

/// Acceleration of gravity (m/s2) as the deck's fix gravity gives it now; zero without one.
inline std::array<double, 3> gravity(LAMMPS_NS::Modify *modify) {
  std::array<double, 3> g{0.0, 0.0, 0.0};
  auto *fix = static_cast<LAMMPS_NS::FixGravity *>(modify->find_fix_style("gravity", 0));
  if (fix != nullptr) fix->get_gravity(g.data());
  return g;
}

/// The shortest of a vector's periodic images, m.
inline void minimum_image(LAMMPS_NS::Domain *domain, std::array<double, 3> &d) {
  domain->minimum_image(d[0], d[1], d[2]);
}

/// I / (m r^2) of balls, as fix nve/sphere turns them: a disc's in two dimensions.
inline double inertia_share(const LAMMPS *lmp) { return lmp->domain->dimension == 2 ? 0.5 : 0.4; }

} // namespace drumlin::engine

#include "support/engine_functions.h"
