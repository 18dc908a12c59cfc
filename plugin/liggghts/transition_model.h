#pragma once
// Adapter of the core's contact laws to LIGGGHTS's contact models: what is the same for every law.

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
#include <string>

#include "contact/contact_source.h"
#include "fixes/fix_clump.h"
#include "contact/fix_stepping.h"
#include "contact/exert_contact.h"
#include "liggghts/pair_source.h"
#include "physics/scheme/advance.h"
#include "physics/laws/rolling_law.h"

namespace drumlin {

/// The engine's number of the normal model with a law. Each law has its own specialization.
template <class Contact>
constexpr int normal_model_number = 0;

template <class Contact>
class TransitionModel;

/// Base of the combination of models that a normal model is part of, which takes the law of each contact from
/// it.
template <class Contact>
struct WithNormalModel {
  const TransitionModel<Contact> *normal_model = nullptr;
};

/// Base of the normal model with the law of the parameters `Contact`, with transition condition A or B. The
/// engine's own tangential and rolling models take the normal force, stiffnesses and dampings from here.
template <class Contact>
class TransitionModel : public LIGGGHTS::ContactModels::NormalModelBase {
protected:
  using LAMMPS = LAMMPS_NS::LAMMPS;
  using Settings = ::Settings;
  using IContactHistorySetup = LIGGGHTS::IContactHistorySetup;
  using ContactModelBase = LIGGGHTS::ContactModels::ContactModelBase;
  using SurfacesIntersectData = LIGGGHTS::ContactModels::SurfacesIntersectData;
  using SurfacesCloseData = LIGGGHTS::ContactModels::SurfacesCloseData;
  using ForceData = LIGGGHTS::ContactModels::ForceData;
  using Law = typename Contact::Law;

public:
  TransitionModel(LAMMPS *lmp, IContactHistorySetup *hsetup, ContactModelBase *model)
      : NormalModelBase(lmp, hsetup, model), is_wall_(model->is_wall()) {}

  // The deck's keywords reach here as the switches below: see model_settings.h.
  void registerSettings(Settings &settings) {
    settings.registerOnOff("transition_A", transition_a_, false);
    settings.registerOnOff("damping_coefficient", damping_coefficient_, false);
    settings.registerOnOff("damping_restitution", damping_restitution_, false);
    settings.registerOnOff("stepping_stock", stepping_stock_, false);
    settings.registerOnOff("tangential_spring", tangential_spring_, false);
    settings.registerOnOff("rolling_spring", rolling_spring_, false);
  }

  // While the deck is parsed: a fix added later, in the initialization of a run, would miss that run. A wall
  // is a fix under construction and cannot add another.
  void postSettings(IContactHistorySetup *history, ContactModelBase *all) {
    if (auto *combination = dynamic_cast<WithNormalModel<Contact> *>(all)) combination->normal_model = this;
    ContactSettings settings;
    settings.tangential = tangential_spring_ ? FrictionModel::history : FrictionModel::none;
    settings.rolling = rolling_spring_;
    settings.stock = stepping_stock_;
    settings.take_law<Contact>();
    places_ = settings.places(history_order);
    if (is_wall_)
      take_stepping_of_pair();
    else if (!stepping_stock_)
      stepping_ = LAMMPS_NS::FixStepping::provide(lmp);
    for (const Remembered what : history_order) // but the springs, which their models announce
      if (settings.stores(what) && what != Remembered::spring && what != Remembered::rolling_spring)
        announce(*history, what);
    if (!stepping_stock_) all->add_history_offset(force_name, places_[Remembered::force]);
  }

  void connectToProperties(PropertyRegistry &registry) {
    ContactSettings settings;
    if (transition_a_) settings.transition = physics::Transition::A;
    if (damping_coefficient_) settings.damping = DampingInput::coefficient;
    if (damping_restitution_) settings.damping = DampingInput::restitution;
    read_table(table_, lmp, registry.max_type(), settings, is_wall_);
    if (tangential_spring_) {
      registry.registerProperty("coeffFrict", &MODEL_PARAMS::createCoeffFrict);
      registry.connect("coeffFrict", friction_, (std::string("model ") + Contact::name).c_str());
    }
    if (is_wall_) take_stepping_of_pair(); // a pair_style line behind the wall may have changed it
    pair_ = gran_pair(lmp);
    clumps_.find(*lmp->modify);
    // The step in which contact ends needs a call although the balls no longer overlap: see surfacesClose().
    if (stepping_) neighbor->register_contact_dist_factor(contact_distance_factor);
  }

  double stressStrainExponent() { return Law::exponent; }

  inline void surfacesIntersect(SurfacesIntersectData &sidata, ForceData &i_forces, ForceData &j_forces) {
    if (sidata.contact_flags) *sidata.contact_flags |= LIGGGHTS::ContactModels::CONTACT_NORMAL_MODEL;
    const ContactCoefficients<Contact> &p = table_.at(sidata.itype, sidata.jtype);
    if (!clumps_.empty()) take_body_masses(sidata);
    const double r_eff = effective_radius_of(sidata);
    Law law = law_of(sidata);
    sidata.kn = law.secant(sidata.deltan); // times the overlap it is the force of the spring
    sidata.gamman = law.dashpot(sidata.deltan);
    if constexpr (Contact::tangential_varies)
      take_tangential_stiffness(sidata, p.contact, r_eff);
    else
      sidata.kt = p.contact.tangential(sidata.deltan, r_eff);
    sidata.gammat = p.tangential_dashpot(sidata.gamman);
    const double share = sidata.is_wall ? sidata.area_ratio : 1.0;
    if (stepping_ == nullptr) {
      // The engine's vn is positive when the balls separate: overlap_rate = -vn.
      physics::ContactState state;
      const double rate = -sidata.vn;
      sidata.Fn = physics::advance_stock(law, {sidata.deltan, rate, rate, update->dt}, state).force;
      add(share * sidata.Fn, sidata.en, sidata, i_forces, j_forces);
    } else
      second_order(sidata, law, share, i_forces, j_forces);
    if constexpr (Contact::remembers) {
      law.remember(sidata.deltan);
      *stored(sidata, Remembered::memory) = law.memory();
    }
  }

  /// The law of a contact with what it remembers at present.
  Law law_of(const SurfacesIntersectData &data) const {
    const double memory = Contact::remembers ? *stored(data, Remembered::memory) : 0.0;
    return table_.at(data.itype, data.jtype).contact.law(data.meff, effective_radius_of(data), memory);
  }

  void surfacesClose(SurfacesCloseData &scdata, ForceData &i_forces, ForceData &j_forces) {
    if (scdata.contact_flags) *scdata.contact_flags &= ~LIGGGHTS::ContactModels::CONTACT_NORMAL_MODEL;
    if (scdata.contact_history == nullptr || !scdata.computeflag) return;
    if (stepping_ != nullptr && *stored(scdata, Remembered::touches) != 0.0) // one step ago
      end_contact(scdata, i_forces, j_forces);
    std::fill_n(scdata.contact_history, places_.count(), 0.0);
  }

  void beginPass(SurfacesIntersectData &, ForceData &, ForceData &) {}
  void endPass(SurfacesIntersectData &, ForceData &, ForceData &) {}

private:
  /// What a contact remembers, which must be stored.
  double *stored(const SurfacesCloseData &data, Remembered what) const {
    return data.contact_history + places_[what];
  }
  /// 0 for a law that does not depend on it.
  static double effective_radius_of(const SurfacesIntersectData &data) {
    return data.is_wall ? radius_for<Contact>(data.radi) : radius_for<Contact>(data.radi, data.radj);
  }

  bool is_frozen(int i) const { return pair_ != nullptr && (atom->mask[i] & pair_->freeze_group_bit()); }

  /// Ends the run where the stepping of a wall is not that of the pair style.
  void take_stepping_of_pair() {
    stepping_ = LAMMPS_NS::FixStepping::find(lmp);
    if (stepping_stock_ == (stepping_ == nullptr)) return;
    const std::string own = stepping_stock_ ? "'stock'" : "'second' (its default)";
    const bool law = pair_source(lmp) != nullptr;
    const std::string pair =
        stepping_stock_ || law
            ? "and that of the pair style is " + std::string(stepping_stock_ ? "'second'" : "'stock'")
            : "and there is no pair_style gran model " + std::string(Contact::name) + " yet";
    error->all(FLERR, engine::error_text(std::string("fix wall/gran model ") + Contact::name +
                                         ": keyword stepping is " + own + " " + pair +
                                         "; allowed: the same stepping for both, the pair style first"));
  }

  /// Replaces the mass of a ball that belongs to a clump by the mass of the clump.
  void take_body_masses(SurfacesIntersectData &sidata) const {
    sidata.mi = clumps_.mass_of(*atom, sidata.i, sidata.mi);
    sidata.meff = sidata.mi;
    if (sidata.is_wall) return;
    sidata.mj = clumps_.mass_of(*atom, sidata.j, sidata.mj);
    sidata.meff = is_frozen(sidata.j)   ? sidata.mi
                  : is_frozen(sidata.i) ? sidata.mj
                                        : engine_effective_mass(sidata.mi, sidata.mj);
  }

  /// Sets the tangential stiffness of a law in which it varies, and lets the springs of the tangential and
  /// the rolling model follow its change.
  inline void take_tangential_stiffness(SurfacesIntersectData &sidata, const Contact &contact, double r_eff) {
    const double dt = update->dt;
    sidata.kt = contact.tangential(physics::overlap_of_spring(sidata.deltan, -sidata.vn, dt), r_eff);
    const bool moves = sidata.computeflag && sidata.shearupdate; // not in a set-up, nor for computes
    sidata.kt = follow_stiffness(places_, sidata.contact_history, sidata.kt, moves);
  }

  /// Sets sidata.Fn and adds the force.
  inline void second_order(SurfacesIntersectData &sidata, const Law &law, double share, ForceData &i_forces,
                           ForceData &j_forces) {
    physics::ContactState state = state_of(sidata);
    const std::array<double, 3> normal{sidata.en[0], sidata.en[1], sidata.en[2]};
    if (sidata.computeflag && hold_contact(law, *stepping_, sidata.i, sidata.is_wall ? -1 : sidata.j, normal,
                                           motion_of(sidata), sidata.meff, share, state)) {
      *stored(sidata, Remembered::force) = sidata.Fn = state.force;
      add(share * sidata.Fn, sidata.en, sidata, i_forces, j_forces);
    } else
      second_order_rare(sidata, law, share, i_forces, j_forces);
  }

  physics::ContactState state_of(const SurfacesIntersectData &data) const {
    return {*stored(data, Remembered::force), *stored(data, Remembered::touches) != 0.0};
  }

  inline physics::StepMotion motion_of(const SurfacesIntersectData &sidata) const {
    const double *v_j = sidata.is_wall ? sidata.v_j : stepping_->velocity_before(sidata.j);
    return {sidata.deltan, -sidata.vn,
            rate_before(*stepping_, sidata.i, v_j, {sidata.en[0], sidata.en[1], sidata.en[2]}),
            stepping_->dt()};
  }

  [[gnu::noinline]] void second_order_rare(SurfacesIntersectData &sidata, const Law &law, double share,
                                           ForceData &i_forces, ForceData &j_forces) {
    if (!sidata.computeflag) {
      add_stored_force(sidata, share, i_forces, j_forces);
      return;
    }
    physics::ContactState state = state_of(sidata);
    double &force = *stored(sidata, Remembered::force);
    const double push = exert_contact(law, *stepping_,
                                      {sidata.i,
                                       sidata.is_wall ? -1 : sidata.j,
                                       {sidata.en[0], sidata.en[1], sidata.en[2]},
                                       sidata.is_wall ? sidata.v_j : nullptr,
                                       sidata.deltan,
                                       -sidata.vn,
                                       sidata.meff,
                                       share},
                                      state, force);
    add(push, sidata.en, sidata, i_forces, j_forces);
    force = sidata.Fn = state.force;
    *stored(sidata, Remembered::touches) = 1.0;
  }

  /// For compute pair/gran/local, which is called after the step: adds the stored contact force, since the
  /// velocities from which it was computed are no longer there. The spring of a contact that slid is at the
  /// friction limit within rounding errors. The normal force is reported slightly smaller, and where the
  /// limit is zero the tangential damping as zero: otherwise the engine's `tangential history` could take the
  /// contact for a sticking one and add a dashpot force.
  void add_stored_force(SurfacesIntersectData &sidata, double share, ForceData &i_forces,
                        ForceData &j_forces) const {
    sidata.Fn = *stored(sidata, Remembered::force);
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
    const double inverse = 1.0 / r; // the normal as the engine has it in other steps
    const double normal[3] = {inverse * scdata.delta[0], inverse * scdata.delta[1],
                              inverse * scdata.delta[2]};
    double rate_half = 0.0;
    for (int a = 0; a < 3; ++a)
      rate_half -= (scdata.v_i[a] - scdata.v_j[a]) * normal[a];
    const double mi = clumps_.mass_of(*atom, scdata.i, atom->rmass[scdata.i]);
    const double m_eff = scdata.is_wall ? mi : effective_mass(scdata.i, scdata.j);
    double &force = *stored(scdata, Remembered::force);
    physics::ContactState state{force, true};
    const double memory = Contact::remembers ? *stored(scdata, Remembered::memory) : 0.0;
    const double ri = atom->radius[scdata.i];
    const double r_eff =
        scdata.is_wall ? radius_for<Contact>(ri) : radius_for<Contact>(ri, atom->radius[scdata.j]);
    const double push =
        exert_contact(table_.at(scdata.itype, scdata.jtype).contact.law(m_eff, r_eff, memory), *stepping_,
                      {scdata.i,
                       scdata.is_wall ? -1 : scdata.j,
                       {normal[0], normal[1], normal[2]},
                       scdata.is_wall ? scdata.v_j : nullptr,
                       std::min(scdata.radsum - r, -std::numeric_limits<double>::min()),
                       rate_half,
                       m_eff,
                       1.0},
                      state, force);
    if (push == 0.0) return;
    add(push, normal, scdata, i_forces, j_forces);
    scdata.has_force_update = true;
  }

  /// The effective mass that the contact had in the steps before.
  double effective_mass(int i, int j) const {
    const auto *source = contact_source(lmp);
    if (source == nullptr) return engine_effective_mass(atom->rmass[i], atom->rmass[j]);
    const double mi = source->mass(i), mj = source->mass(j);
    return std::isinf(mi) ? mj : std::isinf(mj) ? mi : engine_effective_mass(mi, mj);
  }

  const bool is_wall_;
  bool transition_a_ = false;
  bool damping_coefficient_ = false;
  bool damping_restitution_ = false;
  bool stepping_stock_ = false;
  LAMMPS_NS::Clumps clumps_;
  bool tangential_spring_ = false;             // whether the tangential model has one,
  bool rolling_spring_ = false;                // and the rolling model
  LAMMPS_NS::PairGran *pair_ = nullptr;        // gives the group of frozen balls
  LAMMPS_NS::FixStepping *stepping_ = nullptr; // none under stock stepping
  HistoryPlaces places_;
  double **friction_ = nullptr; // coefficients by types, as the engine's `tangential history` has them
  CoefficientTable<Contact> table_;
};

} // namespace drumlin
