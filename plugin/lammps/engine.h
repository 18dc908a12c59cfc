#pragma once
// The functions and types of LAMMPS that fixes, commands and contact step use. plugin/liggghts/engine.h
// defines the same names for LIGGGHTS, so that the sources in plugin/{support,contact,fixes,commands} are
// compiled for either engine without change.

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "fix_deform.h"
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
#include "physics/laws/contact_mixing.h"
#include "support/deforming_box.h"

#include <array>
#include <cstdio>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::engine {

using LAMMPS_NS::bigint;
using LAMMPS_NS::LAMMPS;

/// Name and version of the engine, for logs and parameters.csv.
inline std::string name_and_version() { return std::string("LAMMPS ") + LAMMPS_VERSION; }

/// What a deck writes before the name of one of the plugin's contact laws.
constexpr const char *pair_style_before_law = "pair_style gran/";

/// Base class of fixes that communicate with ghosts or take part in the integration. It has one name for
/// functions that the engines name differently.
class GhostFix : public LAMMPS_NS::Fix {
public:
  using Fix::Fix;
  /// Writes `comm_forward` numbers of each of n owned balls to a buffer. (n, indices of the balls, buffer)
  virtual void pack_ghosts(int, const int *, double *) {}
  /// Reads them for n ghosts. (n, index of the first ghost, buffer)
  virtual void unpack_ghosts(int, int, double *) {}
  /// Reverse communication, with newton on: writes `comm_reverse` numbers of each of n ghosts to a buffer.
  /// (n, index of the first ghost, buffer)
  virtual void pack_gathered(int, int, double *) {}
  /// Adds them to those of their owners. (n, indices of the owned balls, buffer)
  virtual void join_gathered(int, const int *, const double *) {}
  /// Called when all forces of the step are known, before velocity Verlet computes the velocities at the end
  /// of the step; if setmask() has `closes_forces`. LAMMPS calls fixes in the order of the deck: this fix
  /// must be defined before those that integrate.
  virtual void close_forces() {}
  /// Called at the beginning of a step, before velocities and positions change; if setmask() has
  /// `opens_step`. The fix must be defined before those that integrate.
  virtual void open_step() {}
  /// Called once, when the engine knows the fix: it may add further fixes.
  virtual void added() {}

  int pack_forward_comm(int n, int *balls, double *numbers, int periodic, int *shift) final {
    velocity_of_ghosts_ = velocity_of_image(*domain, periodic != 0 ? shift : nullptr);
    pack_ghosts(n, balls, numbers);
    velocity_of_ghosts_ = {};
    return n * comm_forward;
  }
  void unpack_forward_comm(int n, int first, double *numbers) final { unpack_ghosts(n, first, numbers); }
  int pack_reverse_comm(int n, int first, double *numbers) final {
    pack_gathered(n, first, numbers);
    return n * comm_reverse;
  }
  void unpack_reverse_comm(int n, int *balls, double *numbers) final { join_gathered(n, balls, numbers); }
  void post_constructor() final { added(); }
  void final_integrate() final { close_forces(); }
  void initial_integrate(int) override { open_step(); }

protected:
  /// While pack_ghosts() is called for ghosts: their velocity, m/s, relative to their owners. Zero except
  /// across a periodic side of a box that deforms.
  const std::array<double, 3> &velocity_of_ghosts() const { return velocity_of_ghosts_; }
  /// Lets `fix_modify` add the fix's scalar to the potential energy, and what it adds by v_tally() to the
  /// pressure.
  void offer_energy_and_virial() { energy_global_flag = virial_global_flag = virial_peratom_flag = 1; }
  /// To be called when forces are computed, before v_tally(); sets `evflag` if the virial is needed in this
  /// step.
  void begin_virial(int vflag) { v_init(vflag); }

private:
  std::array<double, 3> velocity_of_ghosts_{};
};
constexpr int closes_forces = LAMMPS_NS::FixConst::FINAL_INTEGRATE;
constexpr int opens_step = LAMMPS_NS::FixConst::INITIAL_INTEGRATE;

/// Number of bytes at the end of a restart file by which the engine recognizes that the file is complete.
constexpr int restart_end_mark = 16;
/// For error texts: what decks can read instead of a restart file NAME.
constexpr bool reads_data_beside = true;

/// Sets up a run, as the command `run` does before its first step.
inline void set_up_run(LAMMPS_NS::Integrate *integrate) { integrate->setup(1); }

/// Whether the engine writes a restart file at a step of a run (command `restart`).
inline bool writes_restart(const LAMMPS_NS::Output *output, bigint step) {
  return output->next_restart == step;
}

/// A text in the type that error->all() takes unchanged. (It would take a pointer to characters for a format,
/// and {} in it for an argument.)
inline const std::string &error_text(const std::string &text) { return text; }

/// Lets the engine end each run after the present step. To be called on all ranks.
inline void end_runs(LAMMPS *lmp) { lmp->timer->force_timeout(); }
/// Whether the engine ends its runs, because of end_runs() or the command `timer timeout`. To be called on
/// all ranks.
inline bool runs_have_ended(const LAMMPS *lmp) { return lmp->timer->is_timeout(); }

/// Copies numbers of owned balls to their ghosts by the fix's pack_ghosts() and unpack_ghosts().
inline void forward_comm(LAMMPS_NS::Comm *comm, LAMMPS_NS::Fix *fix) { version::forward_comm(comm, fix); }

/// Sends numbers of ghosts to their owners by the fix's pack_gathered() and join_gathered().
inline void reverse_comm(LAMMPS_NS::Comm *comm, LAMMPS_NS::Fix *fix) { version::reverse_comm(comm, fix); }

using version::find_fix;
using version::fix_mask;
using version::fixes;

/// Present acceleration, m/s2, of the deck's first fix gravity; zero without one.
inline std::array<double, 3> gravity(LAMMPS_NS::Modify *modify) {
  for (LAMMPS_NS::Fix *fix : fixes(modify))
    if (const std::string style = fix->style;
        style == "gravity" || style.rfind("gravity/", 0) == 0) { // gravity/omp with -sf omp
      int dimension = 0;
      if (const auto *g = static_cast<const double *>(fix->extract("gvec", dimension)))
        return {g[0], g[1], g[2]};
    }
  return {0.0, 0.0, 0.0};
}

/// Replaces a vector, m, by the shortest of its periodic images.
inline void minimum_image(LAMMPS_NS::Domain *domain, std::array<double, 3> &d) {
  version::minimum_image(domain, d.data());
}

/// I / (m r^2) with which fix nve/sphere rotates the balls: that of discs with its keyword `disc`.
double inertia_share(const LAMMPS *lmp);

/// Gives the pair style of the deck the contacts of each pair of types, as lines pair_coeff.
/// \param table rows of as many contacts as there are types
/// \param rubs, rolling whether the pair style has friction and rolling friction \param yield k2/k1 of the
/// law that yields; none: the linear law
inline void set_contacts(LAMMPS *lmp, const std::vector<physics::ContactValues> &table, bool rubs,
                         bool rolling, const std::optional<double> &yield) {
  const auto types = static_cast<std::size_t>(lmp->atom->ntypes);
  for (std::size_t a = 0; a < types; ++a)
    for (std::size_t b = a; b < types; ++b) {
      const physics::ContactValues &contact = table[a * types + b];
      std::string line = fmt::format("pair_coeff {} {} {:.17g}", a + 1, b + 1, contact.stiffness);
      if (yield) line += fmt::format(" {:.17g}", *yield);
      line += fmt::format(" {:.17g}", contact.damping_ratio);
      if (rubs) line += fmt::format(" {:.17g}", contact.friction);
      if (rolling) line += fmt::format(" rolling {:.17g}", contact.rolling);
      if (contact.suction > 0.0) line += fmt::format(" suction {:.17g}", contact.suction);
      lmp->input->one(line);
    }
}

} // namespace drumlin::engine

#include "support/engine_functions.h"
