#pragma once
// pair_style gran/hooke/transition: see plugin/doc/pair_gran_hooke_transition.md.

#include "engine.h"
#include "contact/contact_source.h"
#include "fixes/fix_clump.h"
#include "lammps/contact_terms.h"

#include <algorithm>

namespace LAMMPS_NS {

class FixNeighHistory;

/// The contact law of plugin/physics between balls, in LAMMPS. The history of contacts is stored by LAMMPS's
/// fix NEIGH_HISTORY, as for gran/hooke/history.
class PairGranHookeTransition : public Pair, public drumlin::ContactSource {
public:
  explicit PairGranHookeTransition(LAMMPS *);
  ~PairGranHookeTransition() override;

  void compute(int, int) override;
  void settings(int, char **) override;
  void coeff(int, char **) override;
  void init_style() override;
  double init_one(int, int) override;
  double single(int, int, int, int, double, double, double, double &) override;
  void write_restart(FILE *) override;
  void read_restart(FILE *) override;
  void write_restart_settings(FILE *) override;
  void read_restart_settings(FILE *) override;
  void transfer_history(double *, double *DRUMLIN_TRANSFER_TYPES) override;
  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;
  double memory_usage() override { return static_cast<double>(rigid_mass_.capacity()) * sizeof(double); }
#if DRUMLIN_LAMMPS_PAIR_CUTOFFS // older releases compute these cutoffs from the radii themselves
  double atom2cut(int i) override { return 2.0 * atom->radius[i]; }
  double radii2cut(double r1, double r2) override { return r1 + r2; }
#endif

  const drumlin::physics::LinearContact &law(int itype, int jtype) const override {
    return at(itype, jtype).normal;
  }
  double mass(int i) const override;
  /// The same, kg, but finite for a ball in the group of fix freeze: walls do not treat such balls
  /// differently.
  double mass_unless_frozen(int i) const;
  drumlin::physics::Dashpots wall_dashpots(int i) const override;
  drumlin::FrictionModel friction_model() const override { return settings_.tangential; }
  drumlin::physics::Friction friction(int itype, int jtype, double c) const override {
    return at(itype, jtype).tangential(c, settings_.cap);
  }
  const double *tangential_spring(int i, int jj) const override;
  const NeighList *contact_list() const override { return list; }

  /// The pair style of this engine instance if it is of this class, or the only part of a hybrid pair style
  /// that is; nullptr if there is none, or more than one.
  static PairGranHookeTransition *find(LAMMPS *lmp);
  /// Whether a pair_coeff line has given the coefficients of a pair of types, in either order.
  bool has_coefficients(int itype, int jtype) const {
    return setflag[std::min(itype, jtype)][std::max(itype, jtype)] != 0;
  }
  /// The text of the error for a pair of types without coefficients.
  static std::string missing_coefficients(int itype, int jtype);
  const drumlin::ContactSettings &contact_settings() const { return settings_; }
  const drumlin::ContactCoefficients &at(int itype, int jtype) const {
    return coefficients_[static_cast<std::size_t>(itype) * stride_ + static_cast<std::size_t>(jtype)];
  }

private:
  void allocate();
  template <bool stepped, drumlin::FrictionModel tangential>
  void compute_contacts();
  [[gnu::noinline]] void report(const drumlin::Contact &, const drumlin::ContactForces &) const;
  void check_engine() const;
  void share_rigid_masses();
  /// The history of the contact of ball i with its neighbour j; nullptr if j is not in i's neighbour list.
  const double *history(int i, int j) const;

  drumlin::ContactSettings settings_;
  std::size_t stride_ = 0;
  std::vector<drumlin::ContactCoefficients> coefficients_;
  FixNeighHistory *history_ = nullptr;
  FixStepping *stepping_ = nullptr;
  int freeze_groupbit_ = 0;
  drumlin::ContactObservers observers_;
  Clumps clumps_;
  std::vector<const drumlin::Walls *> walls_;
  std::vector<Fix *> rigid_;
  std::vector<double>
      rigid_mass_; // body's mass of owned balls and ghosts, kg; 0: in no rigid body; empty without fix rigid
  std::vector<double> reach_, frozen_reach_; // greatest radius by type, m
};

} // namespace LAMMPS_NS
