#pragma once
// The plugin's contact laws as contact models of LIGGGHTS: what the engine calls for each contact with a
// wall, and for each of two balls in those steps in which its own loop computes them.

#include "atom.h"
#include "contact_model_base.h"
#include "contact_model_constants.h"
#include "error.h"
#include "fix_mesh_surface.h"
#include "fix_wall_gran.h"
#include "force.h"
#include "neighbor.h"
#include "pair_gran.h"
#include "primitive_wall.h"
#include "settings.h"
#include "tri_mesh.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "contact/contact_forces.h"
#include "contact/contact_source.h"
#include "fixes/fix_clump.h"
#include "liggghts/pair_source.h"

namespace drumlin {

/// The engine's number of the normal model with a law, 24 to 63 for a new one. Each law has its own
/// specialization.
template <class Contact>
constexpr int normal_model_number = 0;
template <>
constexpr int normal_model_number<physics::LinearContact> = 21;
template <>
constexpr int normal_model_number<physics::HertzContact> = 22;
template <>
constexpr int normal_model_number<physics::YieldContact> = 23;

/// A model that decks name with the normal model, and its number. Those of `history` and `epsd2` are the
/// engine's, whose names they have.
struct NumberedModel {
  int number;
  const char *name;
};
constexpr NumberedModel no_model{0, "off"}, tangential_history{2, "history"},
    tangential_coulomb{21, "coulomb"}, rolling_epsd2{3, "epsd2"};

/// A contact law with friction and rolling resistance. \tparam cap of friction, if there is any
template <class Law, FrictionModel tangential, physics::Cap cap, bool rolling>
struct Combination {
  using Contact = Law;
  static constexpr FrictionModel friction = tangential;
  static constexpr physics::Cap limit = cap;
  static constexpr bool rolls = rolling, rubs = tangential != FrictionModel::none;
  static constexpr NumberedModel tangential_model = !rubs                         ? no_model
                                                    : cap == physics::Cap::spring ? tangential_history
                                                                                  : tangential_coulomb;
  static constexpr NumberedModel rolling_model = rolling ? rolling_epsd2 : no_model;
  /// That restart files have.
  static constexpr int number =
      normal_model_number<Law> | tangential_model.number << 6 | rolling_model.number << 18;
  /// Bits of the engine's flags that say that two balls touch.
  static constexpr int flags = LIGGGHTS::ContactModels::CONTACT_NORMAL_MODEL |
                               (rubs ? LIGGGHTS::ContactModels::CONTACT_TANGENTIAL_MODEL : 0) |
                               (rolling ? LIGGGHTS::ContactModels::CONTACT_ROLLING_MODEL : 0);

  static ContactSettings settings(bool stock) {
    ContactSettings all;
    all.tangential = tangential;
    all.cap = cap;
    all.rolling = rolling;
    all.stock = stock;
    all.take_law<Law>();
    return all;
  }
};

template <class Models>
class TransitionModel : public LIGGGHTS::ContactModels::ContactModelBase {
  using LAMMPS = LAMMPS_NS::LAMMPS;
  using SurfacesIntersectData = LIGGGHTS::ContactModels::SurfacesIntersectData;
  using SurfacesCloseData = LIGGGHTS::ContactModels::SurfacesCloseData;
  using ForceData = LIGGGHTS::ContactModels::ForceData;
  using Contact = typename Models::Contact;
  using Partner = physics::Partner;

public:
  /// \param history the pair style or the wall that the model belongs to
  TransitionModel(LAMMPS *engine, LIGGGHTS::IContactHistorySetup *history, bool is_wall, int64_t)
      : ContactModelBase(engine, is_wall), engine_(engine),
        wall_(is_wall ? static_cast<LAMMPS_NS::FixWallGran *>(history) : nullptr) {}

  int64_t hashcode() const { return Models::number; }
  bool contact_match(const std::string &kind, const std::string &model) const {
    return (kind == "normal" && model == Contact::name) || (kind == "surface" && model == "default") ||
           (kind == "tangential" && model == Models::tangential_model.name) ||
           (kind == "rolling_friction" && model == Models::rolling_model.name) ||
           (kind == "cohesion" && model == no_model.name);
  }
  static double stressStrainExponent() { return Contact::Law::exponent; }

  // The deck's keywords reach here as the switches below: see model_settings.h.
  void registerSettings(Settings &settings) {
    settings.registerOnOff("transition_A", transition_a_, false);
    settings.registerOnOff("damping_coefficient", damping_coefficient_, false);
    settings.registerOnOff("damping_restitution", damping_restitution_, false);
    settings.registerOnOff("stepping_stock", stepping_stock_, false);
    if (Models::rolls) settings.registerOnOff("torsionTorque", torsion_, false);
  }

  // While the deck is parsed: a fix added later, in the initialization of a run, would miss that run. A wall
  // is a fix under construction and cannot add another.
  void postSettings(LIGGGHTS::IContactHistorySetup *history) {
    const ContactSettings settings = Models::settings(stepping_stock_);
    places_ = settings.places(history_order);
    if (is_wall())
      take_stepping_of_pair();
    else if (!stepping_stock_)
      stepping_ = LAMMPS_NS::FixStepping::provide(engine_);
    for (const Remembered what : history_order)
      if (settings.stores(what)) announce(*history, what);
    if (!stepping_stock_) add_history_offset(force_name, places_[Remembered::force]);
  }

  void connectToProperties(PropertyRegistry &registry) {
    // The step in which contact ends needs a call although the balls no longer overlap: see surfacesClose().
    if (places_.count() > 0) engine_->neighbor->register_contact_dist_factor(contact_distance_factor);
    ContactSettings settings = Models::settings(stepping_stock_);
    if (transition_a_) settings.transition = physics::Transition::A;
    if (damping_coefficient_) settings.damping = DampingInput::coefficient;
    if (damping_restitution_) settings.damping = DampingInput::restitution;
    read_table(table_, engine_, registry.max_type(), settings, is_wall());
    if (is_wall()) take_stepping_of_pair(); // a pair_style line behind the wall may have changed it
    pair_ = gran_pair(engine_);
    clumps_.find(*engine_->modify);
    observers_.find(*engine_->modify);
  }

  static bool checkSurfaceIntersect(SurfacesIntersectData &) { return true; }

  void surfacesIntersect(SurfacesIntersectData &data, ForceData &i_forces, ForceData &j_forces) {
    if (stepping_ != nullptr)
      data.is_wall ? exert<true, Partner::wall>(data, i_forces, j_forces)
                   : exert<true, Partner::ball>(data, i_forces, j_forces);
    else
      data.is_wall ? exert<false, Partner::wall>(data, i_forces, j_forces)
                   : exert<false, Partner::ball>(data, i_forces, j_forces);
  }

  void surfacesClose(SurfacesCloseData &data, ForceData &i_forces, ForceData &j_forces) {
    if (data.contact_flags) *data.contact_flags &= ~Models::flags;
    if (data.contact_history == nullptr || !data.computeflag) return;
    if (stepping_ != nullptr && *stored(data, Remembered::touches) != 0.0) // one step ago
      data.is_wall ? end<Partner::wall>(data, i_forces, j_forces)
                   : end<Partner::ball>(data, i_forces, j_forces);
    std::fill_n(data.contact_history, places_.count(), 0.0);
  }

  static void endSurfacesIntersect(SurfacesIntersectData &, LAMMPS_NS::TriMesh *, ForceData &, ForceData &) {}
  static void beginPass(SurfacesIntersectData &, ForceData &, ForceData &) {}
  static void endPass(SurfacesIntersectData &, ForceData &, ForceData &) {}
  void tally_pp(double, int, int, int) override {}
  void tally_pw(double, int, int, int) override {}

private:
  template <bool stepped, Partner partner>
  using Forces = ContactForces<Contact, stepped, Models::friction, Models::rolls, partner>;

  /// What a contact remembers, which must be stored.
  double *stored(const SurfacesCloseData &data, Remembered what) const {
    return data.contact_history + places_[what];
  }

  ContactStep<Contact> step(bool moves) const {
    return {table_,
            places_,
            Models::limit,
            torsion_ ? physics::Resisted::all : physics::Resisted::rolling,
            stepping_,
            observers_,
            engine_->update->dt,
            moves};
  }

  /// A contact whose surfaces overlap.
  template <bool stepped, Partner partner>
  void exert(SurfacesIntersectData &data, ForceData &i_forces, ForceData &j_forces) {
    const bool moves = data.computeflag && data.shearupdate; // not in a set-up, nor for computes
    Forces<stepped, partner> forces(*engine_->atom, step(moves));
    const BlockContact contact{data.i, data.is_wall ? -1 : data.j, 0, true, data.contact_history};
    const bool begins = !touched<stepped>(data);
    const physics::Vec3 normal{data.en[0], data.en[1], data.en[2]};
    data.deltan = data.radsum - data.r; // which other parts of the engine use
    if constexpr (partner == Partner::wall)
      forces.take_wall(data.i,
                       {normal,
                        turns && step(moves).slips_in_middle() ? normal_in_middle(data, normal) : normal,
                        {data.v_j[0], data.v_j[1], data.v_j[2]},
                        data.deltan,
                        mass_of_body(data.i, data.mi),
                        data.jtype,
                        data.area_ratio});
    else
      take_balls(forces, data, mass_of_balls(data));
    forces.take_histories(&contact, 1);
    if (data.computeflag)
      forces.compute(&contact, 1, begins ? 1 : 0, true);
    else
      forces.show(&contact);
    if (data.contact_flags) *data.contact_flags |= Models::flags;
    if (stepped && data.computeflag) *stored(data, Remembered::touches) = 1.0;
    data.Fn = forces.block.force[0];
    add(forces, data, i_forces, j_forces);
  }

  /// The step in which a contact ends: a force of tension has acted for part of it.
  template <Partner partner>
  void end(SurfacesCloseData &data, ForceData &i_forces, ForceData &j_forces) {
    Forces<true, partner> forces(*engine_->atom, step(data.shearupdate));
    const BlockContact contact{data.i, data.is_wall ? -1 : data.j, 0, false, data.contact_history};
    if constexpr (partner == Partner::wall) {
      const double r = std::sqrt(data.rsq),
                   inverse = 1.0 / r; // the normal as the engine has it in other steps
      const physics::Vec3 normal = physics::scaled(inverse, {data.delta[0], data.delta[1], data.delta[2]});
      forces.take_wall(data.i, {normal,
                                normal,
                                {data.v_j[0], data.v_j[1], data.v_j[2]},
                                data.radsum - r,
                                mass_of_body(data.i, engine_->atom->rmass[data.i]),
                                data.jtype});
    } else
      take_balls(forces, data, mass_before(data.i, data.j));
    forces.take_histories(&contact, 1);
    forces.compute(&contact, 1, 1, true);
    if (forces.block.push[0] == 0.0) return;
    add(forces, data, i_forces, j_forces);
    data.has_force_update = true;
  }

  /// Whether the surfaces touched in the step before. Where that is not stored, a contact whose springs have
  /// no length counts as one that begins.
  template <bool stepped>
  bool touched(const SurfacesIntersectData &data) const {
    if (stepped) return *stored(data, Remembered::touches) != 0.0;
    if (data.contact_flags != nullptr) return *data.contact_flags != 0;
    const double *const first = data.contact_history;
    return std::any_of(first, first + places_.count(), [](double number) { return number != 0.0; });
  }

  /// Describes two balls as the only contact of a block.
  template <bool stepped>
  void take_balls(Forces<stepped, Partner::ball> &forces, const SurfacesCloseData &data, double m_eff) const {
    physics::ContactBlock &b = forces.block;
    const auto difference = [](const double *one, const double *other) {
      return physics::Vec3{one[0] - other[0], one[1] - other[1], one[2] - other[2]};
    };
    const LAMMPS_NS::Atom &balls = *engine_->atom;
    const double *const wi = balls.omega[data.i], *const wj = balls.omega[data.j];
    b.separation.set(0, {data.delta[0], data.delta[1], data.delta[2]});
    b.squared[0] = data.rsq;
    b.ri[0] = balls.radius[data.i];
    b.rj[0] = balls.radius[data.j];
    b.m_eff[0] = m_eff;
    b.velocity.set(0, difference(data.v_i, data.v_j));
    b.wi.set(0, {wi[0], wi[1], wi[2]});
    b.wj.set(0, {wj[0], wj[1], wj[2]});
    if constexpr (stepped) {
      b.velocity_before.set(
          0, difference(stepping_->velocity_before(data.i), stepping_->velocity_before(data.j)));
      b.damping_over_mass[0] = stepping_->damping_over_mass(data.i) + stepping_->damping_over_mass(data.j);
    }
  }

  template <class Block>
  static void add(const Block &forces, const SurfacesCloseData &data, ForceData &i_forces,
                  ForceData &j_forces) {
    const physics::Vec3 force = forces.block.total_force[0];
    const physics::Vec3 torque_i = forces.torque_i(0), torque_j = forces.torque_j(0);
    for (std::size_t a = 0; a < 3; ++a) {
      i_forces.delta_F[a] += force[a];
      i_forces.delta_torque[a] += torque_i[a];
      if (data.is_wall) continue;
      j_forces.delta_F[a] -= force[a];
      j_forces.delta_torque[a] += torque_j[a];
    }
  }

  /// Mass, kg, of a ball, or of the clump that it belongs to.
  double mass_of_body(int i, double own) const { return clumps_.mass_of(*engine_->atom, i, own); }

  bool is_frozen(int i) const {
    return pair_ != nullptr && (engine_->atom->mask[i] & pair_->freeze_group_bit()) != 0;
  }

  /// Effective mass, kg, of two balls.
  double mass_of_balls(const SurfacesIntersectData &data) const {
    if (clumps_.empty()) return data.meff;
    const double mi = mass_of_body(data.i, data.mi), mj = mass_of_body(data.j, data.mj);
    return is_frozen(data.j) ? mi : is_frozen(data.i) ? mj : engine_effective_mass(mi, mj);
  }

  /// The effective mass that the contact had in the steps before.
  double mass_before(int i, int j) const {
    const auto *source = contact_source(engine_);
    if (source == nullptr) return engine_effective_mass(engine_->atom->rmass[i], engine_->atom->rmass[j]);
    const double mi = source->mass(i), mj = source->mass(j);
    return std::isinf(mi) ? mj : std::isinf(mj) ? mi : engine_effective_mass(mi, mj);
  }

  /// Whether friction takes the normal of the middle of the step.
  static constexpr bool turns = Models::rubs && Models::limit == physics::Cap::coulomb;

  /// The normal of the wall where the ball was, relative to it, in the middle of the step: another one at the
  /// edges and corners of a mesh and on a cylinder. A surface that moves within its shape (`shear`,
  /// `surface_vel`) turns no normal. \param normal that of the end of the step
  physics::Vec3 normal_in_middle(const SurfacesIntersectData &data, const physics::Vec3 &normal) const {
    double middle[3], delta[3] = {};
    const bool shape_moves = data.j >= 0 && data.fix_mesh != nullptr && data.fix_mesh->triMesh()->isMoving();
    for (int a = 0; a < 3; ++a)
      middle[a] = engine_->atom->x[data.i][a] -
                  0.5 * engine_->update->dt * (data.v_i[a] - (shape_moves ? data.v_j[a] : 0.0));
    if (data.j < 0)
      wall_->primitiveWall()->resolveContact(middle, data.radi, delta);
    else if (data.fix_mesh != nullptr) {
      int sign = 0;
      data.fix_mesh->triMesh()->resolveTriSphereContact(data.i, data.j, data.radi, middle, delta, sign);
    }
    const physics::Vec3 found{delta[0], delta[1], delta[2]};
    const double squared = physics::dot(found, found), along = physics::dot(found, normal);
    // It may have another sign, and none is found where the ball is nearer to another part of the mesh.
    return along * along > 0.25 * squared
               ? physics::scaled((along > 0.0 ? 1.0 : -1.0) / std::sqrt(squared), found)
               : normal;
  }

  /// Ends the run where the stepping of a wall is not that of the pair style.
  void take_stepping_of_pair() {
    stepping_ = LAMMPS_NS::FixStepping::find(engine_);
    if (stepping_stock_ == (stepping_ == nullptr)) return;
    const std::string own = stepping_stock_ ? "'stock'" : "'second' (its default)";
    const bool law = pair_source(engine_) != nullptr;
    const std::string pair =
        stepping_stock_ || law
            ? "and that of the pair style is " + std::string(stepping_stock_ ? "'second'" : "'stock'")
            : "and there is no pair_style gran model " + std::string(Contact::name) + " yet";
    engine_->error->all(FLERR, engine::error_text(std::string("fix wall/gran model ") + Contact::name +
                                                  ": keyword stepping is " + own + " " + pair +
                                                  "; allowed: the same stepping for both, the pair style "
                                                  "first"));
  }

  LAMMPS *const engine_;
  LAMMPS_NS::FixWallGran *const wall_; // nullptr: a pair style
  bool transition_a_ = false;
  bool damping_coefficient_ = false;
  bool damping_restitution_ = false;
  bool stepping_stock_ = false;
  bool torsion_ = false; // whether rolling resistance also resists torsion
  LAMMPS_NS::Clumps clumps_;
  ContactObservers observers_;
  LAMMPS_NS::PairGran *pair_ = nullptr;        // gives the group of frozen balls
  LAMMPS_NS::FixStepping *stepping_ = nullptr; // none under stock stepping
  HistoryPlaces places_;
  CoefficientTable<Contact> table_;
};

} // namespace drumlin
