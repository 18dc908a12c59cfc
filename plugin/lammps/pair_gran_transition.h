#pragma once
// The pair styles gran/LAW/transition: see plugin/doc/pair_gran_hooke_transition.md.

#include "engine.h"
#include "contact/contact_loop.h"
#include "contact/contact_source.h"
#include "contact/deck_check.h"
#include "fixes/fix_clump.h"

#include <algorithm>
#include <array>
#include <string>
#include <type_traits>
#include <vector>

namespace drumlin {

struct PairMotion;

/// The order in which a contact's numbers are stored, which restart files have.
constexpr std::array<Remembered, 5> history_order{Remembered::spring, Remembered::stiffness,
                                                  Remembered::force, Remembered::rolling_spring,
                                                  Remembered::memory};

/// Calls run(stepped, tangential, rolling) with the scheme, the friction model and the presence of rolling
/// resistance of the settings as compile-time constants (std::integral_constant).
template <class Run>
void with_models(const ContactSettings &settings, Run &&run) {
  const auto with_stepping = [&](auto tangential) {
    const auto with_rolling = [&](auto stepped) {
      settings.rolling ? run(stepped, tangential, std::true_type{})
                       : run(stepped, tangential, std::false_type{});
    };
    settings.stock ? with_rolling(std::false_type{}) : with_rolling(std::true_type{});
  };
  switch (settings.tangential) {
  case FrictionModel::none:
    return with_stepping(std::integral_constant<FrictionModel, FrictionModel::none>{});
  case FrictionModel::no_history:
    return with_stepping(std::integral_constant<FrictionModel, FrictionModel::no_history>{});
  case FrictionModel::history:
    return with_stepping(std::integral_constant<FrictionModel, FrictionModel::history>{});
  }
}

} // namespace drumlin

namespace LAMMPS_NS {

class FixNeighHistory;
class FixWallGranTransition;

/// A contact law of plugin/physics between balls, in LAMMPS. The history of contacts is stored by LAMMPS's
/// fix NEIGH_HISTORY, as for gran/hooke/history.
class PairGranTransition : public Pair, public drumlin::ContactSource {
public:
  /// \param law parameters of the law, see contact/laws.h
  template <class Parameters>
  PairGranTransition(LAMMPS *lammps, drumlin::LawTag<Parameters>)
      : PairGranTransition(lammps, Tables(drumlin::CoefficientTable<Parameters>{})) {}
  ~PairGranTransition() override;

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

  std::string law_name() const override;
  drumlin::AnyTable table() const override;
  drumlin::CoefficientTable<drumlin::physics::LinearContact> *linear_table() override;
  double mass(int i) const override;
  /// The same, kg, but finite for a ball in the group of fix freeze: walls do not treat such balls
  /// differently.
  double mass_unless_frozen(int i) const;
  drumlin::physics::Dashpots wall_dashpots(int i) const override;
  drumlin::FrictionModel friction_model() const override { return settings_.tangential; }
  const double *history(int i, int jj) const override;
  const drumlin::HistoryPlaces &places() const override { return places_; }
  const NeighList *contact_list() const override { return list; }

  /// The pair style of this engine instance if it is of this class, or the only part of a hybrid pair style
  /// that is; nullptr if there is none, or more than one.
  static PairGranTransition *find(LAMMPS *lmp);
  /// Whether a pair_coeff line has given the coefficients of a pair of types, in either order.
  bool has_coefficients(int itype, int jtype) const {
    return setflag[std::min(itype, jtype)][std::max(itype, jtype)] != 0;
  }
  /// The text of the error for a pair of types without coefficients.
  std::string missing_coefficients(int itype, int jtype) const;
  const drumlin::ContactSettings &contact_settings() const { return settings_; }
  /// What contacts, of balls or with walls, have in common in this step. \param places of what they remember
  template <class Parameters>
  drumlin::ContactStep<Parameters> step_of(const drumlin::CoefficientTable<Parameters> &table,
                                           const drumlin::HistoryPlaces &places) const {
    return {table,     places,     settings_.cap, drumlin::physics::Resisted::rolling,
            stepping_, observers_, update->dt,    update->setupflag == 0};
  }

protected:
  const Atom &balls() const override { return *atom; }
  drumlin::physics::Cap cap() const override { return settings_.cap; }

private:
  using Tables = drumlin::OneOfLaws<drumlin::CoefficientTable>;

  PairGranTransition(LAMMPS *, Tables tables);

  std::string style_name() const;
  void allocate();
  template <class Parameters>
  void set_coefficients(int i, int j, const drumlin::ContactCoefficients<Parameters> &);
  template <class Parameters, bool stepped, drumlin::FrictionModel tangential, bool rolling>
  class LoopAdapter; // see loop_adapter.h
  template <class Parameters>
  void tell_single(const drumlin::ContactCoefficients<Parameters> &, const drumlin::PairMotion &, int i,
                   int j, const double *remembered, double &force_over_distance);
  void check_engine();
  void share_rigid_masses();
  void take_settings(const drumlin::ContactSettings &settings);
  /// The history of the contact of balls i and j; nullptr if j is not in i's neighbour list, or if there is
  /// none.
  const double *history_of_pair(int i, int j) const;

  drumlin::ContactSettings settings_;
  drumlin::HistoryPlaces places_; // that follow from them
  Tables tables_;                 // of the law
  FixNeighHistory *history_ = nullptr;
  FixStepping *stepping_ = nullptr;
  drumlin::LoopMemory loop_memory_;
  int freeze_groupbit_ = 0;
  drumlin::DeckCheck deck_check_;
  drumlin::ContactObservers observers_;
  Clumps clumps_;
  std::vector<const FixWallGranTransition *> walls_;
  std::vector<Fix *> rigid_;
  std::vector<double>
      rigid_mass_; // body's mass of owned balls and ghosts, kg; 0: in no rigid body; empty without fix rigid
  std::vector<double> reach_, frozen_reach_; // greatest radius by type, m
};

} // namespace LAMMPS_NS
