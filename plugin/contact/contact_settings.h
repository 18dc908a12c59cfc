#pragma once
// Settings and coefficients of the contact law, the same for both engines, and the keywords that both have.

#include "contact/contact_source.h"
#include "physics/contact_law.h"
#include "physics/friction_law.h"
#include "physics/restitution.h"
#include "support/arguments.h"

#include <string>
#include <vector>

namespace drumlin {

/// Coefficients of a pair of types.
struct ContactCoefficients {
  physics::LinearContact normal;
  double friction = 0.0;                 ///< mu
  double tangential_stiffness = 0.0;     ///< kt, N/m
  double tangential_damping = 0.0;       ///< ct, N s/m
  double tangential_damping_share = 0.5; ///< of the normal damping coefficient, on top of ct

  /// Takes kt as 2/7 of the normal stiffness and ct as half of the normal damping coefficient, where a deck
  /// gives neither.
  static ContactCoefficients with_defaults(const physics::LinearContact &normal) {
    ContactCoefficients p;
    p.normal = normal;
    p.tangential_stiffness = 2.0 / 7.0 * normal.stiffness;
    return p;
  }
  void set_tangential_damping(double ct) {
    tangential_damping = ct;
    tangential_damping_share = 0.0;
  }

  /// ct, N s/m, of a contact whose normal damping coefficient is c.
  double tangential_dashpot(double c) const { return tangential_damping_share * c + tangential_damping; }
  physics::Friction tangential(double c, physics::Cap cap) const {
    return {tangential_stiffness, tangential_dashpot(c), friction, cap};
  }
};

/// What a deck gives for the normal dashpot: c, D, or the restitution e of an impact without gravity.
enum class DampingInput { coefficient, ratio, restitution };

/// What pair style and walls are told by keywords.
struct ContactSettings {
  physics::Transition transition = physics::Transition::B;
  DampingInput damping = DampingInput::ratio;
  bool stock = false; ///< the scheme: the engine's own, else the second-order one
  FrictionModel tangential = FrictionModel::none;
  physics::Cap cap = physics::Cap::total;

  /// Numbers that a contact remembers: the tangential spring, then with the second-order scheme the normal
  /// force.
  int history() const { return spring() + (stock ? 0 : 1); }
  int spring() const { return tangential == FrictionModel::history ? 3 : 0; }

  /// The parameters of a normal law from what a deck gives. A restitution, > 0 and <= 1, becomes the D that
  /// gives it under the transition condition.
  physics::LinearContact normal(double stiffness, double given) const {
    const double damping_value = damping == DampingInput::restitution
                                     ? physics::damping_ratio_of_restitution(transition, given)
                                     : given;
    return {stiffness, damping_value, kind(), transition};
  }
  /// What the damping of normal() means.
  physics::Damping kind() const {
    return damping == DampingInput::coefficient ? physics::Damping::coefficient : physics::Damping::ratio;
  }
};

/// Keywords that both engines' styles have, for error texts and read_setting().
inline std::vector<std::string> common_keywords() { return {"transition", "damping", "stepping"}; }

/// Reads the value of one of them. \returns false if the keyword is none of them
inline bool read_setting(Arguments &in, const std::string &keyword, ContactSettings &settings) {
  const std::string what = "keyword " + keyword;
  if (keyword == "transition")
    settings.transition = in.choice(what, {"A", "B"}) == 0 ? physics::Transition::A : physics::Transition::B;
  else if (keyword == "damping")
    settings.damping = static_cast<DampingInput>(in.choice(what, {"coefficient", "ratio", "restitution"}));
  else if (keyword == "stepping")
    settings.stock = in.choice(what, {"stock", "second"}) == 0;
  else
    return false;
  return true;
}

} // namespace drumlin
