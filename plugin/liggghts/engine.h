#pragma once
// The functions and types of LIGGGHTS that fixes, commands and contact step use. plugin/lammps/engine.h
// defines the same names for LAMMPS, so that the sources in plugin/{support,contact,fixes,commands} are
// compiled for either engine without change.

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "fix_deform.h"
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

#include "physics/laws/contact_mixing.h"
#include "support/deforming_box.h"

#include <algorithm>
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
inline std::string name_and_version() { return std::string("LIGGGHTS ") + LIGGGHTS_VERSION; }

/// What a deck writes before the name of one of the plugin's contact laws.
constexpr const char *pair_style_before_law = "pair_style gran model ";

/// Base class of fixes that communicate with ghosts or take part in the integration. It has one name for
/// functions that the engines name differently.
class GhostFix : public LAMMPS_NS::Fix {
public:
  using Fix::Fix;
  /// Writes `comm_forward` numbers of each of n owned balls to a buffer. (n, indices of the balls, buffer)
  virtual void pack_ghosts(int, const int *, double *) {}
  /// Reads them for n ghosts. (n, index of the first ghost, buffer)
  virtual void unpack_ghosts(int, int, double *) {}
  /// Reverse communication, from ghosts to their owners with newton on: not called in LIGGGHTS, where newton
  /// is off, see reverse_comm().
  virtual void pack_gathered(int, int, double *) {}
  virtual void join_gathered(int, const int *, const double *) {}
  /// Called when all forces of the step are known, before velocity Verlet computes the velocities at the end
  /// of the step; if setmask() has `closes_forces`.
  virtual void close_forces() {}
  /// Called at the beginning of a step, before velocities and positions change; if setmask() has
  /// `opens_step`.
  virtual void open_step() {}
  /// Called once, when the engine knows the fix: it may add further fixes.
  virtual void added() {}

  int pack_comm(int n, int *balls, double *numbers, int periodic, int *shift) final {
    velocity_of_ghosts_ = velocity_of_image(*domain, periodic != 0 ? shift : nullptr);
    pack_ghosts(n, balls, numbers);
    velocity_of_ghosts_ = {};
    return comm_forward; // LIGGGHTS expects the number of values per ball
  }
  void unpack_comm(int n, int first, double *numbers) final { unpack_ghosts(n, first, numbers); }
  void post_create() final { added(); }
  void pre_final_integrate() final { close_forces(); }
  void pre_initial_integrate() final { open_step(); }

protected:
  /// While pack_ghosts() is called for ghosts: their velocity, m/s, relative to their owners. Zero except
  /// across a periodic side of a box that deforms.
  const std::array<double, 3> &velocity_of_ghosts() const { return velocity_of_ghosts_; }
  /// Lets the fix contribute to the pressure by v_tally(). (LIGGGHTS has no potential energy, to which LAMMPS
  /// can add the fix's scalar.)
  void offer_energy_and_virial() { virial_flag = 1; }
  /// To be called when forces are computed, before v_tally(); sets `evflag` if the virial is needed in this
  /// step.
  void begin_virial(int vflag) { vflag ? v_setup(vflag) : void(evflag = 0); }

private:
  std::array<double, 3> velocity_of_ghosts_{};
};
constexpr int closes_forces = LAMMPS_NS::FixConst::PRE_FINAL_INTEGRATE;
constexpr int opens_step = LAMMPS_NS::FixConst::PRE_INITIAL_INTEGRATE;

/// Number of bytes at the end of a restart file by which the engine recognizes that the file is complete;
/// LIGGGHTS has none.
constexpr int restart_end_mark = 0;
/// Whether drumlin/read reads a data file NAME.data beside a restart file in its place.
constexpr bool reads_data_beside = false;

/// Sets up a run, as the command `run` does before its first step.
inline void set_up_run(LAMMPS_NS::Integrate *integrate) { integrate->setup(); }

/// Whether the engine writes a restart file at a step of a run (command `restart`).
inline bool writes_restart(LAMMPS_NS::Output *output, bigint step) { return output->restart_requested(step); }

/// A text in the type that error->all() takes.
inline const char *error_text(const std::string &text) { return text.c_str(); }

/// Lets the engine end each run after the present step. To be called on all ranks.
inline void end_runs(LAMMPS *) { LAMMPS_NS::SignalHandler::request_quit = true; }
/// Whether the engine ends its runs, because of end_runs() or a signal that it has received itself.
/// Collective.
inline bool runs_have_ended(const LAMMPS *lmp) {
  int ended = LAMMPS_NS::SignalHandler::request_quit ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &ended, 1, MPI_INT, MPI_MAX, lmp->world);
  return ended != 0;
}

/// Copies numbers of owned balls to their ghosts by the fix's pack_ghosts() and unpack_ghosts().
inline void forward_comm(LAMMPS_NS::Comm *comm, LAMMPS_NS::Fix *fix) { comm->forward_comm_fix(fix); }

/// Does nothing: contact history needs newton off in LIGGGHTS, and then ghosts have nothing to send to their
/// owners.
inline void reverse_comm(LAMMPS_NS::Comm *, LAMMPS_NS::Fix *) {}

/// All fixes, in the order of the deck.
inline std::vector<LAMMPS_NS::Fix *> fixes(LAMMPS_NS::Modify *modify) {
  std::vector<LAMMPS_NS::Fix *> all(static_cast<std::size_t>(modify->nfix));
  std::copy_n(modify->fix, modify->nfix, all.begin());
  return all;
}

/// A fix by its ID; nullptr if there is none.
inline LAMMPS_NS::Fix *find_fix(LAMMPS_NS::Modify *modify, const std::string &id) {
  const int index = modify->find_fix(id.c_str());
  return index < 0 ? nullptr : modify->fix[index];
}

/// When the engine calls a fix: the bits of FixConst.
inline int fix_mask(LAMMPS_NS::Modify *modify, const LAMMPS_NS::Fix *fix) {
  for (int n = 0; n < modify->nfix; ++n)
    if (modify->fix[n] == fix) return modify->fmask[n];
  return 0;
}

/// Present acceleration, m/s2, of the deck's first fix gravity; zero without one.
inline std::array<double, 3> gravity(LAMMPS_NS::Modify *modify) {
  std::array<double, 3> g{0.0, 0.0, 0.0};
  auto *fix = static_cast<LAMMPS_NS::FixGravity *>(modify->find_fix_style("gravity", 0));
  if (fix != nullptr) fix->get_gravity(g.data());
  return g;
}

/// Replaces a vector, m, by the shortest of its periodic images.
inline void minimum_image(LAMMPS_NS::Domain *domain, std::array<double, 3> &d) {
  domain->minimum_image(d[0], d[1], d[2]);
}

/// I / (m r^2) with which fix nve/sphere rotates the balls: that of discs in two dimensions.
inline double inertia_share(const LAMMPS *lmp) { return lmp->domain->dimension == 2 ? 0.5 : 0.4; }

/// Gives the pair style of the deck the contacts of each pair of types, as properties.
/// \param table rows of as many contacts as there are types
/// \param rubs, rolling whether the deck's models have friction and rolling friction \param yield k2/k1 of
/// the law that yields; none: the linear law
inline void set_contacts(LAMMPS *lmp, const std::vector<physics::ContactValues> &table, bool rubs,
                         bool rolling, const std::optional<double> &yield) {
  const struct {
    const char *property;
    double physics::ContactValues::*value;
  } properties[] = {{"kn", &physics::ContactValues::stiffness},
                    {"dampingRatio", &physics::ContactValues::damping_ratio},
                    {"coefficientFriction", &physics::ContactValues::friction},
                    {"coefficientRollingFriction", &physics::ContactValues::rolling},
                    {"suction", &physics::ContactValues::suction}};
  const bool pulls =
      std::any_of(table.begin(), table.end(), [](const auto &one) { return one.suction > 0.0; });
  const auto give = [&](const char *property, const auto &number_of) {
    std::string line =
        fmt::format("fix {0} all property/global {0} peratomtypepair {1}", property, lmp->atom->ntypes);
    for (const physics::ContactValues &contact : table)
      line += fmt::format(" {:.17g}", number_of(contact));
    lmp->input->one(line.c_str());
  };
  for (const auto &property : properties) {
    if (property.value == &physics::ContactValues::friction && !rubs) continue;
    if (property.value == &physics::ContactValues::rolling && !rolling) continue;
    const bool pulled = pulls || find_fix(lmp->modify, property.property) != nullptr;
    if (property.value == &physics::ContactValues::suction && !pulled) continue;
    give(property.property, [&](const physics::ContactValues &contact) { return contact.*property.value; });
  }
  if (yield) give("stiffnessRatio", [&](const physics::ContactValues &) { return *yield; });
}

} // namespace drumlin::engine

#include "support/engine_functions.h"
