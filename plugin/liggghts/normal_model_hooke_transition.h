// Adapter of the core's linear contact law to LIGGGHTS's contact models: `model hooke/transition`.
// (LIGGGHTS includes this file several times; the first branch only announces the model.)
#ifdef NORMAL_MODEL
NORMAL_MODEL(HOOKE_TRANSITION, hooke / transition, 21)
#else
#ifndef DRUMLIN_NORMAL_MODEL_HOOKE_TRANSITION_H
#define DRUMLIN_NORMAL_MODEL_HOOKE_TRANSITION_H

#include "contact_models.h"
#include "atom.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "neighbor.h"
#include "normal_model_base.h"
#include "pair_gran.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/contact_source.h"
#include "fixes/fix_clump.h"
#include "contact/fix_stepping.h"
#include "contact/stepped_contact.h"
#include "liggghts/contact_table.h"
#include "physics/contact_step.h"

namespace LIGGGHTS {
namespace ContactModels {

/// Linear spring-dashpot with transition condition A or B (Eqs. 2 to 9). The engine's own tangential and
/// rolling models take the normal force, stiffnesses and dampings from here.
template <>
class NormalModel<HOOKE_TRANSITION> : public NormalModelBase {
public:
  NormalModel(LAMMPS *lmp, IContactHistorySetup *hsetup, ContactModelBase *model)
      : NormalModelBase(lmp, hsetup, model), is_wall_(model->is_wall()) {}

  // The deck's keywords reach here as the switches below: see model_settings.h.
  void registerSettings(Settings &settings) {
    settings.registerOnOff("transition_A", transition_a_, false);
    settings.registerOnOff("damping_coefficient", damping_coefficient_, false);
    settings.registerOnOff("damping_restitution", damping_restitution_, false);
    settings.registerOnOff("stepping_stock", stepping_stock_, false);
    settings.registerOnOff("tangential_spring", tangential_spring_, false);
  }

  // While the deck is parsed: a fix added later, in the initialization of a run, would miss that run. A wall
  // is a fix under construction and cannot add another.
  void postSettings(IContactHistorySetup *history, ContactModelBase *all) {
    if (is_wall_)
      take_stepping_of_pair();
    else if (!stepping_stock_)
      stepping_ = LAMMPS_NS::FixStepping::provide(lmp);
    if (stepping_stock_) return;
    state_offset_ = history->add_history_value(drumlin::final_force_name, "0");
    history->add_history_value("normal_in_contact", "0");
    all->add_history_offset(drumlin::final_force_name, state_offset_);
  }

  void connectToProperties(PropertyRegistry &registry) {
    drumlin::ContactSettings settings;
    if (transition_a_) settings.transition = drumlin::physics::Transition::A;
    if (damping_coefficient_) settings.damping = drumlin::DampingInput::coefficient;
    if (damping_restitution_) settings.damping = drumlin::DampingInput::restitution;
    table_.read(lmp, registry.max_type(), settings, is_wall_);
    if (tangential_spring_) {
      registry.registerProperty("coeffFrict", &MODEL_PARAMS::createCoeffFrict);
      registry.connect("coeffFrict", friction_, "model hooke/transition");
    }
    if (is_wall_) take_stepping_of_pair(); // a pair_style line behind the wall may have changed it
    pair_ = drumlin::gran_pair(lmp);
    clumps_.find(*lmp->modify);
    // The step in which contact ends needs a call although the balls no longer overlap: see surfacesClose().
    if (stepping_) neighbor->register_contact_dist_factor(drumlin::contact_distance_factor);
  }

  double stressStrainExponent() { return 1.0; }

  inline void surfacesIntersect(SurfacesIntersectData &sidata, ForceData &i_forces, ForceData &j_forces) {
    if (sidata.contact_flags) *sidata.contact_flags |= CONTACT_NORMAL_MODEL;
    const drumlin::ContactCoefficients &p = table_.at(sidata.itype, sidata.jtype);
    if (!clumps_.empty()) take_body_masses(sidata);
    const drumlin::physics::LinearLaw law = p.normal.of_mass(sidata.meff);
    sidata.kn = law.stiffness(sidata.deltan);
    sidata.gamman = law.dashpot(sidata.deltan);
    sidata.kt = p.tangential_stiffness;
    sidata.gammat = p.tangential_dashpot(sidata.gamman);
    const double share = sidata.is_wall ? sidata.area_ratio : 1.0;
    if (stepping_ == nullptr) {
      // The engine's vn is positive when the balls separate: overlap_rate = -vn.
      drumlin::physics::ContactState state;
      const double rate = -sidata.vn;
      sidata.Fn = drumlin::physics::advance_stock(law, {sidata.deltan, rate, rate, update->dt}, state).force;
      add(share * sidata.Fn, sidata.en, sidata, i_forces, j_forces);
    } else
      second_order(sidata, law, share, i_forces, j_forces);
  }

  void surfacesClose(SurfacesCloseData &scdata, ForceData &i_forces, ForceData &j_forces) {
    if (scdata.contact_flags) *scdata.contact_flags &= ~CONTACT_NORMAL_MODEL;
    if (stepping_ == nullptr || !scdata.computeflag || scdata.contact_history == nullptr) return;
    if (scdata.contact_history[state_offset_ + 1] == 0.0) return; // they did not touch a step ago
    end_contact(scdata, i_forces, j_forces);
    std::fill_n(scdata.contact_history + state_offset_, 2, 0.0);
  }

  void beginPass(SurfacesIntersectData &, ForceData &, ForceData &) {}
  void endPass(SurfacesIntersectData &, ForceData &, ForceData &) {}

private:
  bool is_frozen(int i) const { return pair_ != nullptr && (atom->mask[i] & pair_->freeze_group_bit()); }

  /// Ends the run where the stepping of a wall is not that of the pair style.
  void take_stepping_of_pair() {
    stepping_ = LAMMPS_NS::FixStepping::find(lmp);
    if (stepping_stock_ == (stepping_ == nullptr)) return;
    const std::string own = stepping_stock_ ? "'stock'" : "'second' (its default)";
    const bool law = drumlin::gran_pair(lmp) != nullptr &&
                     drumlin::gran_pair(lmp)->contact_match("normal", "hooke/transition");
    const std::string pair =
        stepping_stock_ || law
            ? "and that of the pair style is " + std::string(stepping_stock_ ? "'second'" : "'stock'")
            : "and there is no pair_style gran model hooke/transition yet";
    error->all(FLERR, drumlin::engine::error_text(
                          "fix wall/gran model hooke/transition: keyword stepping is " + own + " " + pair +
                          "; allowed: the same stepping for both, the pair style first"));
  }

  /// A ball of a clump has the clump's mass in its contacts.
  void take_body_masses(SurfacesIntersectData &sidata) const {
    sidata.mi = clumps_.mass_of(*atom, sidata.i, sidata.mi);
    sidata.meff = sidata.mi;
    if (sidata.is_wall) return;
    sidata.mj = clumps_.mass_of(*atom, sidata.j, sidata.mj);
    sidata.meff = is_frozen(sidata.j)   ? sidata.mi
                  : is_frozen(sidata.i) ? sidata.mj
                                        : drumlin::physics::effective_mass(sidata.mi, sidata.mj);
  }

  /// Sets sidata.Fn and adds the force.
  inline void second_order(SurfacesIntersectData &sidata, const drumlin::physics::LinearLaw &law,
                           double share, ForceData &i_forces, ForceData &j_forces) {
    double *const stored = sidata.contact_history + state_offset_; // force, N; 1 if in contact, else 0
    drumlin::physics::ContactState state{stored[0], stored[1] != 0.0, {}};
    if (sidata.computeflag && drumlin::hold_contact(law, *stepping_, sidata.i, sidata.is_wall ? -1 : sidata.j,
                                                    motion_of(sidata), sidata.meff, state)) {
      stored[0] = sidata.Fn = state.force;
      add(share * sidata.Fn, sidata.en, sidata, i_forces, j_forces);
    } else
      second_order_rare(sidata, law, share, i_forces, j_forces);
  }

  inline drumlin::physics::StepMotion motion_of(const SurfacesIntersectData &sidata) const {
    const double *v_j = sidata.is_wall ? sidata.v_j : stepping_->velocity_before(sidata.j);
    return {sidata.deltan, -sidata.vn,
            drumlin::rate_before(*stepping_, sidata.i, v_j, {sidata.en[0], sidata.en[1], sidata.en[2]}),
            stepping_->dt()};
  }

  [[gnu::noinline]] void second_order_rare(SurfacesIntersectData &sidata,
                                           const drumlin::physics::LinearLaw &law, double share,
                                           ForceData &i_forces, ForceData &j_forces) {
    if (!sidata.computeflag) {
      look(sidata, share, i_forces, j_forces);
      return;
    }
    double *const stored = sidata.contact_history + state_offset_;
    drumlin::physics::ContactState state{stored[0], stored[1] != 0.0, {}};
    const auto push = [&](double force) { add(force, sidata.en, sidata, i_forces, j_forces); };
    drumlin::exert_contact(law, *stepping_,
                           {sidata.i,
                            sidata.is_wall ? -1 : sidata.j,
                            {sidata.en[0], sidata.en[1], sidata.en[2]},
                            sidata.is_wall ? sidata.v_j : nullptr,
                            sidata.deltan,
                            -sidata.vn,
                            sidata.meff,
                            share},
                           state, stored[0], push);
    stored[0] = sidata.Fn = state.force;
    stored[1] = 1.0;
  }

  /// What compute pair/gran/local sees behind a step, when the velocities of the step are gone: the force on
  /// record. The step left the spring of a contact that slid at the friction limit, to rounding. The engine's
  /// `tangential history` must find it above the limit, or, where the limit is zero, not damped: else it
  /// takes the contact for one that sticks and puts a dashpot on top.
  void look(SurfacesIntersectData &sidata, double share, ForceData &i_forces, ForceData &j_forces) const {
    sidata.Fn = sidata.contact_history[state_offset_];
    add(share * sidata.Fn, sidata.en, sidata, i_forces, j_forces);
    if (!tangential_spring_) return;
    constexpr double below = 1.0 - 1e-12;
    sidata.Fn *= below;
    if (friction_[sidata.itype][sidata.jtype] * sidata.Fn == 0.0) sidata.gammat = 0.0;
  }

  /// Adds a force on both balls.
  static inline void add(double force, const double *normal, const SurfacesCloseData &data,
                         ForceData &i_forces, ForceData &j_forces) {
    const double x = force * normal[0], y = force * normal[1], z = force * normal[2];
    i_forces.delta_F[0] += x;
    i_forces.delta_F[1] += y;
    i_forces.delta_F[2] += z;
    if (data.is_wall) return;
    j_forces.delta_F[0] -= x;
    j_forces.delta_F[1] -= y;
    j_forces.delta_F[2] -= z;
  }

  /// The step in which a contact ends: a force of tension has acted for part of it.
  void end_contact(SurfacesCloseData &scdata, ForceData &i_forces, ForceData &j_forces) {
    const double r = std::sqrt(scdata.rsq);
    const double normal[3] = {scdata.delta[0] / r, scdata.delta[1] / r, scdata.delta[2] / r};
    double rate_half = 0.0;
    for (int a = 0; a < 3; ++a)
      rate_half -= (scdata.v_i[a] - scdata.v_j[a]) * normal[a];
    const double mi = clumps_.mass_of(*atom, scdata.i, atom->rmass[scdata.i]);
    const double m_eff = scdata.is_wall ? mi : effective_mass(scdata.i, scdata.j);
    double *const stored = scdata.contact_history + state_offset_;
    drumlin::physics::ContactState state{stored[0], true, {}};
    const auto push = [&](double force) {
      if (force == 0.0) return;
      add(force, normal, scdata, i_forces, j_forces);
      scdata.has_force_update = true;
    };
    drumlin::exert_contact(table_.at(scdata.itype, scdata.jtype).normal.of_mass(m_eff), *stepping_,
                           {scdata.i,
                            scdata.is_wall ? -1 : scdata.j,
                            {normal[0], normal[1], normal[2]},
                            scdata.is_wall ? scdata.v_j : nullptr,
                            std::min(scdata.radsum - r, -std::numeric_limits<double>::min()),
                            rate_half,
                            m_eff,
                            1.0},
                           state, stored[0], push);
  }

  double effective_mass(int i, int j) const {
    const auto *source = drumlin::contact_source(lmp);
    return source ? source->effective_mass(i, j)
                  : drumlin::physics::effective_mass(atom->rmass[i], atom->rmass[j]);
  }

  const bool is_wall_;
  bool transition_a_ = false;
  bool damping_coefficient_ = false;
  bool damping_restitution_ = false;
  bool stepping_stock_ = false;
  LAMMPS_NS::Clumps clumps_;
  bool tangential_spring_ = false;             // what the tangential model beside this one has
  LAMMPS_NS::PairGran *pair_ = nullptr;        // that knows which balls are frozen
  LAMMPS_NS::FixStepping *stepping_ = nullptr; // none under stock stepping
  int state_offset_ = 0; // of force and 'in contact' in the contact history, with the second-order scheme
  double **friction_ = nullptr; // coefficients by types, as the engine's `tangential history` has them
  drumlin::ContactTable table_;
};

} // namespace ContactModels
} // namespace LIGGGHTS

#endif
#endif
