#pragma once
// Settings and coefficients of the contact law, the same for both engines, and the keywords that both have.

#include "contact/contact_history.h"
#include "physics/laws/friction_law.h"
#include "physics/laws/laws.h"
#include "physics/laws/rolling_law.h"
#include "physics/scheme/implicit_dashpot.h"
#include "support/arguments.h"

#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace drumlin {

/// The friction model. history: with a tangential spring, limited as Friction::cap says; no_history: a
/// dashpot alone.
enum class FrictionModel { none, no_history, history };

/// Coefficients of a pair of types, of the law with the parameters `Contact`. Where a deck does not give ct,
/// it is half of the normal damping coefficient.
template <class Contact>
struct ContactCoefficients {
  Contact contact;
  double friction = 0.0;                 ///< mu
  double tangential_damping = 0.0;       ///< ct, N s/m
  double tangential_damping_share = 0.5; ///< of the normal damping coefficient, on top of ct
  double rolling = 0.0;                  ///< mu_r
  double suction = 0.0;                  ///< F_a, N, see physics::with_suction()
  /// Whether stiffness and damping change at one instant of the present step, from those of `contact_before`
  /// to those of `contact`: a roller crosses a step of the soil. See physics::advance_over_jump().
  bool jumps = false;
  double share_after = 0.0; ///< part of the step behind the jump, 0 to 1
  Contact contact_before{};

  void set_tangential_damping(double ct) {
    tangential_damping = ct;
    tangential_damping_share = 0.0;
  }

  /// ct, N s/m, of a contact whose normal damping coefficient is c.
  double tangential_dashpot(double c) const { return tangential_damping_share * c + tangential_damping; }
  physics::Friction tangential(double kt, double c, physics::Cap cap) const {
    return {kt, tangential_dashpot(c), friction, cap};
  }
  /// \param kt present tangential stiffness, N/m \param radius effective radius of the contact, m
  physics::Rolling rolling_resistance(double kt, double radius, physics::Resisted resisted) const {
    return physics::rolling_of(kt, rolling, radius, resisted);
  }
};

/// Coefficients of all pairs of types, 1 to ntypes.
template <class Contact>
class CoefficientTable {
public:
  void resize(int ntypes) {
    stride_ = static_cast<std::size_t>(ntypes) + 1;
    coefficients_.assign(stride_ * stride_, {});
  }
  const ContactCoefficients<Contact> &at(int itype, int jtype) const {
    return coefficients_[place(itype, jtype)];
  }
  ContactCoefficients<Contact> &at(int itype, int jtype) { return coefficients_[place(itype, jtype)]; }

private:
  std::size_t place(int itype, int jtype) const {
    return static_cast<std::size_t>(itype) * stride_ + static_cast<std::size_t>(jtype);
  }

  std::vector<ContactCoefficients<Contact>> coefficients_;
  std::size_t stride_ = 0;
};

/// Effective radius, m, of two balls; 0 for a law that does not depend on it.
template <class Contact>
inline double radius_for(double ri, double rj) {
  if constexpr (Contact::depends_on_radius) return physics::effective_radius(ri, rj);
  return 0.0;
}
/// The same of a ball and a wall, whose curvature does not count.
template <class Contact>
inline double radius_for(double r) {
  return Contact::depends_on_radius ? r : 0.0;
}

/// The strongest dashpot, and the largest ratio of stiffness to dashpot, of contacts with a law: those at the
/// overlap, m, that can be largest.
template <class Contact>
void add_dashpot(physics::Dashpots &all, const Contact &contact, double m_eff, double r_eff, double overlap) {
  const auto law = contact.law(m_eff, r_eff, 0.0);
  all.add(law.stiffest(overlap), law.dashpot(overlap));
}

/// What a deck gives for the normal dashpot: c, D, or the restitution e of an impact without gravity.
enum class DampingInput { coefficient, ratio, restitution };

/// The settings that the keywords of pair style and walls give.
struct ContactSettings {
  physics::Transition transition = physics::Transition::B;
  DampingInput damping = DampingInput::ratio;
  bool stock = false; ///< the scheme: the engine's own, else the second-order one
  FrictionModel tangential = FrictionModel::none;
  physics::Cap cap = physics::Cap::total;
  bool rolling = false;           ///< whether there is rolling resistance
  bool tangential_varies = false; ///< of the law, as its parameters say
  bool remembers = false;         ///< the same

  template <class Parameters>
  void take_law() {
    tangential_varies = Parameters::tangential_varies;
    remembers = Parameters::remembers;
  }

  bool has_spring() const { return tangential == FrictionModel::history; }
  /// Whether a contact stores what an engine's list of remembered numbers has.
  bool stores(Remembered what) const {
    switch (what) {
    case Remembered::spring:
      return has_spring();
    case Remembered::rolling_spring:
      return rolling;
    case Remembered::stiffness:
      return tangential_varies && (has_spring() || rolling);
    case Remembered::memory:
      return remembers;
    case Remembered::force:
    case Remembered::touches:
      return !stock;
    }
    return false;
  }
  /// Where in a contact's history its numbers are. \param order in which the engine's adapter stores them
  template <class Order>
  HistoryPlaces places(const Order &order) const {
    HistoryPlaces all;
    for (const Remembered what : order)
      if (stores(what)) all.add(what);
    return all;
  }

  /// Sets the damping of a law's parameters to what a deck gives, and the transition.
  template <class Contact>
  void set_damping(Contact &contact, double given) const {
    contact.transition = transition;
    contact.damping_kind = kind();
    if (damping == DampingInput::restitution)
      contact.set_restitution(given);
    else
      contact.damping = given;
  }
  /// Which numbers a deck may give for it. \param contact with all its parameters but the damping
  template <class Contact>
  Range damping_range(const Contact &contact) const {
    return damping == DampingInput::restitution ? Range{0.0, true, contact.largest_restitution()}
                                                : Range::non_negative;
  }
  /// What that damping means.
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
