#pragma once
// The thin layer under the engine-neutral fixes and commands: what they need of LAMMPS, under the names that plugin/liggghts/engine.h
// gives as well. Nothing else in plugin/fixes knows which engine it is compiled for.

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "fix_freeze.h"
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
#include "timer.h"
#include "update.h"
#include "variable.h"
#include "version.h"

#include "lammps/lammps_version.h"

#include <array>
#include <cstdio>
#include <string>
#include <vector>

namespace drumlin::engine {

using LAMMPS_NS::bigint;
using LAMMPS_NS::LAMMPS;

/// Name and version of the engine, for logs and run records.
inline std::string name_and_version() { return std::string("LAMMPS ") + LAMMPS_VERSION; }

/// The pair style with the plugin's law, as a deck names it.
constexpr const char *pair_style = "pair_style gran/hooke/transition";

/// A fix, with names of its own for what the engines name differently.
class GhostFix : public LAMMPS_NS::Fix {
public:
  using Fix::Fix;
  /// Numbers of owned balls for their ghosts, `comm_forward` for each of the n balls.
  virtual void pack_ghosts(int, const int *, double *) {}
  virtual void unpack_ghosts(int, int, double *) {}
  /// The way back, with newton on: what the n ghosts from `first` on have gathered, `comm_reverse` numbers for each, for their owners,
  /// who join it to what they have.
  virtual void pack_gathered(int, int, double *) {}
  virtual void join_gathered(int, const int *, const double *) {}
  /// When all forces of the step are known and before the closing half kick, if setmask() has `closes_forces`. Fixes act in the order of
  /// the deck: this one must stand before those that integrate.
  virtual void close_forces() {}

  int pack_forward_comm(int n, int *balls, double *numbers, int, int *) final {
    pack_ghosts(n, balls, numbers);
    return n * comm_forward;
  }
  void unpack_forward_comm(int n, int first, double *numbers) final { unpack_ghosts(n, first, numbers); }
  int pack_reverse_comm(int n, int first, double *numbers) final {
    pack_gathered(n, first, numbers);
    return n * comm_reverse;
  }
  void unpack_reverse_comm(int n, int *balls, double *numbers) final { join_gathered(n, balls, numbers); }
  void final_integrate() final { close_forces(); }

protected:
  /// Lets `fix_modify` add the fix's scalar to the potential energy, and what it tallies to the pressure.
  void offer_energy_and_virial() { energy_global_flag = virial_global_flag = virial_peratom_flag = 1; }
  /// To be called where forces are computed, before v_tally(); evflag then says whether it is wanted.
  void begin_virial(int vflag) { v_init(vflag); }
};
constexpr int closes_forces = LAMMPS_NS::FixConst::FINAL_INTEGRATE;

/// Bytes at the end of a restart file by which the engine knows that it is whole: a word and its zero.
constexpr int restart_end_mark = 16;
/// What the decks read as well as NAME, a restart file, for lines on bad input.
constexpr const char *beside_restart = ", or NAME beside which a NAME.data lies";

inline void set_up_run(LAMMPS_NS::Integrate *integrate) { integrate->setup(1); }

/// The words of an error as the engine's error->all() takes them: as a string, for pointers to characters are formats to it, in which {} stands
/// for an argument.
inline const std::string &as_is(const std::string &words) { return words; }

/// Tells the engine to end each run after the step, and whether it was told so, by this or by the command `timer timeout`. To be called on
/// all ranks alike.
inline void end_runs(LAMMPS *lmp) { lmp->timer->force_timeout(); }
inline bool runs_have_ended(const LAMMPS *lmp) { return lmp->timer->is_timeout(); }

/// Copies the numbers of owned balls to their ghosts through the fix's pack_ghosts/unpack_ghosts pair.
inline void forward_comm(LAMMPS_NS::Comm *comm, LAMMPS_NS::Fix *fix) { version::forward_comm(comm, fix); }

/// Takes what ghosts have gathered to their owners through the fix's pack_gathered/join_gathered pair.
inline void reverse_comm(LAMMPS_NS::Comm *comm, LAMMPS_NS::Fix *fix) { version::reverse_comm(comm, fix); }

/// Acceleration of gravity (m/s2) as the deck's fix gravity gives it now; zero without one.
inline std::array<double, 3> gravity(LAMMPS_NS::Modify *modify) {
  for (int n = 0; n < modify->nfix; ++n)
    if (std::string(modify->fix[n]->style) == "gravity") {
      int dimension = 0;
      if (const auto *g = static_cast<const double *>(modify->fix[n]->extract("gvec", dimension)))
        return {g[0], g[1], g[2]};
    }
  return {0.0, 0.0, 0.0};
}

/// The shortest of a vector's periodic images, m.
inline void minimum_image(LAMMPS_NS::Domain *domain, std::array<double, 3> &d) {
  version::minimum_image(domain, d.data());
}

/// I / (m r^2) of balls, as fix nve/sphere turns them: a disc's with its keyword `disc`.
double inertia_share(const LAMMPS *lmp);

} // namespace drumlin::engine

#include "support/engine_functions.h"
