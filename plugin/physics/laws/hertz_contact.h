#pragma once
/// Hertz contact of spheres with a dashpot that fits it (Tsuji, Tanaka and Ishida 1992, Powder Technology 71,
/// 239-250):
///   Fc = k d^(3/2) + c d^(1/4) d'.
/// y = d^(5/4) obeys the linear law in the speed u = d':  5/4 u du/dy = -(k y + c u) / m.  With D = c / (2
/// sqrt(5/4 k m)) the restitution is therefore that of the linear law with the same D, under A and B and at
/// any impact speed.

#include "physics/laws/contact_law.h"
#include "physics/laws/law_parameters.h"
#include "physics/laws/restitution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace drumlin::physics {

namespace detail {

/// Hurwitz zeta function, the sum of (n + a)^(-s) over n >= 0 continued to s < 1: Euler-Maclaurin from the
/// sixth term on. For -1 < s < 0 and 1 <= a <= 2 it has 10 digits.
[[nodiscard]] inline double hurwitz_zeta(double s, double a) {
  double sum = 0.0;
  constexpr int terms = 6;
  for (int n = 0; n < terms; ++n)
    sum += std::pow(a + n, -s);
  const double x = a + terms;
  const double power = std::pow(x, -s);
  return sum +
         power * (x / (s - 1.0) + 0.5 + s / (12.0 * x) - s * (s + 1.0) * (s + 2.0) / (720.0 * x * x * x) +
                  s * (s + 1.0) * (s + 2.0) * (s + 3.0) * (s + 4.0) / (30240.0 * x * x * x * x * x));
}

} // namespace detail

/// The Hertz law of one contact.
class HertzLaw : public ContactLaw<HertzLaw> {
public:
  /// \param k stiffness, N/m^(3/2) \param c damping coefficient, N s/m^(5/4)
  HertzLaw(double k, double c, Transition transition) : ContactLaw(transition), k_(k), c_(c) {}

  [[nodiscard]] double spring(double overlap) const { return k_ * overlap * std::sqrt(overlap); }
  [[nodiscard]] double dashpot(double overlap) const { return c_ * std::sqrt(std::sqrt(overlap)); }
  [[nodiscard]] double slope(double overlap) const { return 1.5 * k_ * std::sqrt(overlap); }
  [[nodiscard]] double stored(double overlap) const {
    return 0.4 * k_ * overlap * overlap * std::sqrt(overlap);
  }
  [[nodiscard]] double spring_change(double overlap, double rate, double dt) const {
    return spring(overlap) - spring(std::max(0.0, overlap - dt * rate));
  }

  static constexpr bool is_linear = false;
  static constexpr double exponent = 1.5;
  static constexpr double dashpot_exponent = 0.25;
  /// The force begins with 0, but not smoothly: with the time since the make to the power 1/4.
  static constexpr bool begins_with_jump = false;
  /// After the make the force grows as t^(1/4), and the steps sum it instead of integrating it. By the
  /// Euler-Maclaurin formula this sum, from a time inside a step on, differs from the integral by dt
  /// zeta(-1/4, share) times the force at dt. The weight of the first force, at share dt, in the closing half
  /// kick compensates for this.
  [[nodiscard]] static double first_weight(double share) {
    const double at_least = std::max(share, 1e-12); // the force is 0 at 0, the weight infinite
    return -2.0 * detail::hurwitz_zeta(-0.25, 1.0 + share) / std::sqrt(std::sqrt(at_least)) - 1.0;
  }

private:
  double k_, c_;
};

/// Parameters of the Hertz law for a pair of types; law() gives the law for balls of given masses and radii.
struct HertzContact {
  using Law = HertzLaw;
  static constexpr const char *name = "hertz/transition";
  static constexpr bool depends_on_radius = true;
  static constexpr bool tangential_varies = true;
  static constexpr bool remembers = false;

  double youngs_modulus = 0.0;                 ///< effective, E*, Pa
  double shear_modulus = 0.0;                  ///< effective, G*, Pa
  double damping = 0.0;                        ///< c in N s/m^(5/4) or D without dimension, finite and >= 0
  Damping damping_kind = Damping::coefficient; ///< which of the two `damping` is
  Transition transition = Transition::B;

  /// Takes E* and G* from Young's moduli E, Pa, and Poisson's ratios nu of the two bodies:
  ///   1/E* = (1 - nu1^2) / E1 + (1 - nu2^2) / E2,
  ///   1/G* = 2 (2 - nu1) (1 + nu1) / E1 + 2 (2 - nu2) (1 + nu2) / E2.
  void set_moduli(double E1, double nu1, double E2, double nu2) {
    youngs_modulus = 1.0 / ((1.0 - nu1 * nu1) / E1 + (1.0 - nu2 * nu2) / E2);
    shear_modulus = 1.0 / (2.0 * (2.0 - nu1) * (1.0 + nu1) / E1 + 2.0 * (2.0 - nu2) * (1.0 + nu2) / E2);
  }

  static constexpr std::array<LawParameter<HertzContact>, 2> parameters() {
    return {
        {{&HertzContact::youngs_modulus, "effective Young's modulus", "Pa", Range::positive, nullptr, "E*"},
         {&HertzContact::shear_modulus, "effective shear modulus", "Pa", Range::positive, nullptr, "G*"}}};
  }
  static constexpr std::array<MaterialParameter, 2> material() {
    return {{{"Young's modulus", "Pa", Range::positive, "youngsModulus", "E"},
             {"Poisson's ratio", "", {-1.0, true, 0.5}, "poissonsRatio", "nu"}}};
  }
  /// Takes the parameters from those of the materials of the two bodies.
  void set_material(const std::array<double, 2> &one, const std::array<double, 2> &other) {
    set_moduli(one[0], one[1], other[0], other[1]);
  }
  void set_defaults() {}
  [[nodiscard]] static double largest_restitution() { return 1.0; }
  /// The relation of D and e is that of the linear law: see above.
  void set_restitution(double e) {
    damping = damping_ratio_of_restitution(transition, e);
    damping_kind = Damping::ratio;
  }

  /// k, N/m^(3/2), 4/3 E* sqrt(R). \param r_eff effective radius R, m, > 0
  [[nodiscard]] double stiffness(double r_eff) const { return 4.0 / 3.0 * youngs_modulus * std::sqrt(r_eff); }

  /// The law of a contact of effective mass m_eff, kg, > 0, and effective radius, m, > 0. The dashpot
  /// coefficient c, N s/m^(5/4), is 2 D sqrt(5/4 k m_eff), or the coefficient itself if that was given.
  [[nodiscard]] HertzLaw law(double m_eff, double r_eff, double = 0.0) const {
    const double k = stiffness(r_eff);
    const double c =
        damping_kind == Damping::coefficient ? damping : 2.0 * damping * std::sqrt(1.25 * k * m_eff);
    return {k, c, transition};
  }

  /// Stiffness kt, N/m, of the spring of friction: 8 G* sqrt(R d), that of Mindlin's contact that does not
  /// slip. Not 0 at d = 0, so that a force over it stays finite.
  [[nodiscard]] double tangential(double overlap, double r_eff) const {
    return 8.0 * shear_modulus * std::sqrt(r_eff * std::max(overlap, std::numeric_limits<double>::min()));
  }
};

} // namespace drumlin::physics
