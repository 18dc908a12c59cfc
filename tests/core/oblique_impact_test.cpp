/// Oblique impacts of a ball on a plane with `tangential coulomb`, of both contact laws and under both
/// schemes: the impulses against CVODE, which finds each change between sticking and sliding.

#include "physics/scheme/advance.h"
#include "physics/laws/friction_law.h"
#include "physics/laws/hertz_contact.h"
#include "physics/laws/linear_contact.h"
#include "tests/core/contact_friction.h"
#include "tests/support/ode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace {

using namespace drumlin::physics;

constexpr double slip_mass = 2.0 / 7.0; // kg, of the contact point of a ball of 1 kg
constexpr double radius = 0.04;         // m
constexpr double kn = 1e5, E_eff = 1e8; // N/m, Pa
const double pi = std::acos(-1.0);

/// An impact at 1 m/s.
struct Oblique {
  double degrees; ///< from the normal
  double D, mu;
  Transition transition = Transition::B;
  double ct =
      0.0; ///< N s/m, of the tangential dashpot besides half of the normal one, the default of both engines
  Cap cap = Cap::coulomb;

  [[nodiscard]] double normal_speed() const { return std::cos(degrees / 180.0 * pi); }
  [[nodiscard]] double slip_speed() const { return std::sin(degrees / 180.0 * pi); }
};

std::ostream &operator<<(std::ostream &out, const Oblique &impact) {
  return out << impact.degrees << " degrees, D " << impact.D << ", mu " << impact.mu
             << (impact.transition == Transition::A ? ", A" : ", B");
}

/// Normal and tangential impulse, N s, and the tangential velocity of the contact point after the impact,
/// m/s.
struct Impulses {
  double normal, tangential, slip_after;
};

template <class Contact>
Contact contact_of(const Oblique &impact);

template <>
LinearContact contact_of(const Oblique &impact) {
  return {kn, impact.D, Damping::ratio, impact.transition, 2.0 / 7.0 * kn};
}

template <>
HertzContact contact_of(const Oblique &impact) {
  return {E_eff, 0.4 * E_eff, impact.D, Damping::ratio, impact.transition};
}

/// k d^p + c d^q d' and kt d^r, written out here for the reference solution.
struct Formula {
  double k, p, c, q, kt, r;
};

Formula formula_of(const LinearContact &contact) {
  return {contact.stiffness,
          1.0,
          2.0 * contact.damping * std::sqrt(contact.stiffness),
          0.0,
          contact.tangential_stiffness,
          0.0};
}

Formula formula_of(const HertzContact &contact) {
  const double k = 4.0 / 3.0 * E_eff * std::sqrt(radius);
  return {k,  1.5, 2.0 * contact.damping * std::sqrt(1.25 * k), 0.25, 8.0 * 0.4 * E_eff * std::sqrt(radius),
          0.5};
}

/// Duration of the impact without a dashpot, s.
template <class Contact>
double duration(const Oblique &impact) {
  if constexpr (std::is_same_v<Contact, LinearContact>)
    return pi / std::sqrt(kn);
  else {
    const double k = formula_of(contact_of<HertzContact>(impact)).k, v = impact.normal_speed();
    return 2.94 / v * std::pow(1.25 * v * v / k, 0.4);
  }
}

/// The impact in steps of velocity Verlet with the forces of advance() and friction_step().
/// \param onset share of the first step before the touch
template <class Contact>
Impulses in_steps(const Contact &contact, const Oblique &impact, bool stock, double dt, double onset = 0.5) {
  const auto law = contact.law(1.0, radius);
  verlet::ContactFriction<Contact> friction(contact, impact.mu, radius, impact.cap);
  ContactState state;
  double rate = impact.normal_speed(), slip = impact.slip_speed(), d = -onset * dt * rate;
  double push = 0.0, rub = 0.0, shift = 0.0;
  for (bool touched = false, over = false; !over;) {
    const double rate_before = rate;
    rate -= 0.5 * dt * push;
    slip += 0.5 * dt * rub / slip_mass;
    d += dt * (rate - 0.5 * dt * shift);
    const StepMotion motion{d, rate, rate_before, dt};
    const StepResult result = stock ? advance_stock(law, motion, state) : advance(law, motion, state, {1.0});
    rub = 0.0;
    double closing = 0.0;
    if (d > 0.0) {
      touched = true;
      const FrictionStep now = friction.step(motion, result.force, 0.5 * law.dashpot(d) + impact.ct,
                                             {0.0, 0.0, 1.0}, {slip, 0.0, 0.0});
      rub = now.force[0];
      closing = friction.closing(result, now)[0];
    }
    push = result.force;
    shift = result.shift;
    rate -= 0.5 * dt * result.kick;
    slip += 0.5 * dt * closing / slip_mass;
    over = touched && (d <= 0.0 || (law.transition() == Transition::B && push == 0.0 && rate < 0.0));
  }
  return {impact.normal_speed() - rate, slip_mass * (impact.slip_speed() - slip), slip};
}

/// The same from the differential equations: a slider in series with spring and dashpot. The force f of the
/// spring grows by kt u while the contact is loaded, and shrinks with kt besides while it is unloaded.
class Reference {
public:
  Reference(const Formula &formula, const Oblique &impact) : formula_(formula), impact_(impact) {}

  Impulses solve() {
    const double v = impact_.normal_speed(), u = impact_.slip_speed();
    const double time = std::pow(v * v / formula_.k, 1.0 / (formula_.p + 1.0)) / v, d0 = 1e-6 * v * time;
    oracle::State start{d0, v, u, kt(d0) * u * d0 / v / (1.0 + formula_.r), 0.0, 0.0};
    if (sticking_pull(start) > impact_.mu * push(start)) start = sliding(start, 1.0);
    const double force = formula_.k * std::pow(v * time, formula_.p);
    oracle::Ode motion([this](double, const oracle::State &y, oracle::State &f) { rates(y, f); }, 0.0, start,
                       {v * time, 1.0, 1.0, force, 1.0, 1.0});
    while (true) {
      const int event = motion.advance(1000.0 * time, events(force));
      if (event <= 0) break;
      if (slides_ != 0.0)
        slides_ = 0.0;
      else
        motion.restart(sliding(motion.state(), event == 1 ? 1.0 : -1.0));
    }
    return {motion.state()[normal] + tension(motion.state(), time), motion.state()[tangential],
            motion.state()[slip]};
  }

private:
  enum { overlap, rate, slip, spring, normal, tangential };

  [[nodiscard]] double power(double d, double exponent) const {
    return exponent == 0.0 ? 1.0 : std::pow(std::max(d, 1e-15), exponent);
  }
  [[nodiscard]] double kt(double d) const { return formula_.kt * power(d, formula_.r); }
  [[nodiscard]] double ct(double d) const { return 0.5 * formula_.c * power(d, formula_.q) + impact_.ct; }
  [[nodiscard]] double push(const oracle::State &y) const {
    return formula_.k * power(y[overlap], formula_.p) + formula_.c * power(y[overlap], formula_.q) * y[rate];
  }
  /// Has the sign of the normal force, and is also defined where the overlap d is negative.
  [[nodiscard]] double end(const oracle::State &y) const {
    const double d = y[overlap];
    return std::copysign(std::pow(std::fabs(d), formula_.p - formula_.q), d) * formula_.k +
           formula_.c * y[rate];
  }
  [[nodiscard]] double sticking_pull(const oracle::State &y) const {
    return y[spring] + ct(y[overlap]) * y[slip];
  }
  /// Begins to slide. Without a dashpot the spring then has the force mu Fn.
  oracle::State sliding(oracle::State y, double way) {
    slides_ = way;
    if (ct(y[overlap]) == 0.0) y[spring] = way * impact_.mu * push(y);
    return y;
  }
  /// Rate of change of the spring's force, N/s, while unloading makes the spring softer.
  [[nodiscard]] double unloading(const oracle::State &y) const {
    return y[rate] < 0.0 ? formula_.r * y[spring] * y[rate] / std::max(y[overlap], 1e-15) : 0.0;
  }
  /// Rate of change of the spring's length, m/s, while the contact slides.
  [[nodiscard]] double stretching(const oracle::State &y) const {
    const double d = y[overlap];
    if (ct(d) > 0.0) return (slides_ * impact_.mu * push(y) - y[spring]) / ct(d);
    const double push_rate =
        formula_.k * formula_.p * power(d, formula_.p - 1.0) * y[rate] - formula_.c * push(y);
    return (slides_ * impact_.mu * push_rate - unloading(y)) / kt(d);
  }
  void rates(const oracle::State &y, oracle::State &f) const {
    const double force = push(y), pull = slides_ != 0.0 ? slides_ * impact_.mu * force : sticking_pull(y);
    f[overlap] = y[rate];
    f[rate] = -force;
    f[slip] = -pull / slip_mass;
    f[spring] = kt(y[overlap]) * (slides_ != 0.0 ? stretching(y) : y[slip]) + unloading(y);
    f[normal] = force;
    f[tangential] = pull;
  }
  /// The end of the contact, then the changes between sticking and sliding. An event that is zero where its
  /// mode begins happens a little below zero.
  [[nodiscard]] std::vector<oracle::Event> events(double force) const {
    std::vector<oracle::Event> all{[this](double, const oracle::State &y) { return end(y); }};
    if (slides_ != 0.0)
      all.emplace_back(
          [this](double, const oracle::State &y) { return slides_ * (y[slip] - stretching(y)) + 1e-9; });
    else
      for (const double way : {1.0, -1.0})
        all.emplace_back([this, way, force](double, const oracle::State &y) {
          return way * sticking_pull(y) - impact_.mu * push(y) - 1e-9 * force;
        });
    return all;
  }
  /// Under A the tension acts, without friction, until the overlap is 0.
  [[nodiscard]] double tension(const oracle::State &y, double time) const {
    if (impact_.transition == Transition::B || impact_.D == 0.0) return 0.0;
    oracle::Ode pull(
        [this](double, const oracle::State &z, oracle::State &f) {
          f[overlap] = z[rate];
          f[rate] = -push(z);
        },
        0.0, {y[overlap], y[rate]}, {time, 1.0});
    EXPECT_EQ(pull.advance(1000.0 * time, {[](double, const oracle::State &z) { return z[overlap]; }}), 0);
    return y[rate] - pull.state()[rate];
  }

  const Formula formula_;
  const Oblique impact_;
  double slides_ = 0.0; // direction of sliding, +1 or -1; 0: sticking
};

template <class Contact>
Impulses exact_impact(const Oblique &impact) {
  return Reference(formula_of(contact_of<Contact>(impact)), impact).solve();
}

template <class Contact>
Impulses impact_in_steps(const Oblique &impact, bool stock, double steps_per_contact) {
  return in_steps(contact_of<Contact>(impact), impact, stock, duration<Contact>(impact) / steps_per_contact);
}

template <class Contact>
class ObliqueImpact : public testing::Test {
protected:
  static double expect_exact(const Oblique &impact, double tolerance) {
    const Impulses exact = exact_impact<Contact>(impact);
    double worst = 0.0;
    for (const bool stock : {false, true}) {
      const Impulses found = impact_in_steps<Contact>(impact, stock, 4000.0);
      const double scale = std::fabs(exact.normal) + std::fabs(exact.tangential);
      const double error =
          std::max({std::fabs(found.normal - exact.normal), std::fabs(found.tangential - exact.tangential),
                    slip_mass * std::fabs(found.slip_after - exact.slip_after)}) /
          scale;
      EXPECT_LT(error, tolerance) << impact << (stock ? ", stock" : ", second") << ": normal " << found.normal
                                  << " of " << exact.normal << ", tangential " << found.tangential << " of "
                                  << exact.tangential;
      worst = std::max(worst, error);
    }
    return worst;
  }
};

using Laws = testing::Types<LinearContact, HertzContact>;
struct NameOfLaw {
  template <class Contact>
  static std::string GetName(int /* of the type */) {
    return std::is_same_v<Contact, LinearContact> ? "linear" : "hertz";
  }
};
TYPED_TEST_SUITE(ObliqueImpact, Laws, NameOfLaw);

// Under A with D >= 1 the contact does not end.
TYPED_TEST(ObliqueImpact, HasTheImpulsesOfTheDifferentialEquations) {
  double worst = 0.0;
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double D : {0.0, 0.1, 0.5, 2.0})
      for (const double mu : {0.05, 0.5, 2.0})
        for (const double degrees : {0.0, 10.0, 35.0, 60.0, 76.0, 89.0})
          if (transition == Transition::B || D < 1.0)
            worst = std::max(worst, this->expect_exact({degrees, D, mu, transition}, 3e-4));
  this->RecordProperty("worst", std::to_string(worst));
}

TYPED_TEST(ObliqueImpact, HasTheImpulsesOfTheDifferentialEquationsAtRandom) {
  std::mt19937 random(20261124);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double worst = 0.0;
  for (int n = 0; n < 200; ++n) {
    Oblique impact{89.0 * unit(random), n % 10 == 0 ? 0.0 : 10.0 * unit(random), 10.0 * unit(random)};
    if (n % 3 == 0) {
      impact.transition = Transition::A;
      impact.D *= 0.09;
    }
    worst = std::max(worst, this->expect_exact(impact, 3e-4));
  }
  this->RecordProperty("worst", std::to_string(worst));
}

// At a given number of steps, by each scheme.
TYPED_TEST(ObliqueImpact, OfASlidingBallHasMuTimesTheNormalImpulse) {
  double most = 0.0;
  for (const bool stock : {false, true})
    for (const double D : {0.0, 0.1, 0.3, 0.5, 1.0, 2.0, 5.0, 10.0})
      for (const double degrees : {72.0, 76.0, 80.0, 85.0}) {
        // The elastic ball of the Hertz law stops sliding at 72 degrees, as its reference solution does.
        const bool sticks = std::is_same_v<TypeParam, HertzContact> && D == 0.0 && degrees == 72.0;
        const Oblique impact{degrees, D, 0.5};
        const Impulses all = impact_in_steps<TypeParam>(impact, stock, 1000.0);
        const Impulses exact = exact_impact<TypeParam>(impact);
        const double expected = sticks ? exact.tangential / (0.5 * exact.normal) : 1.0;
        const double ratio = all.tangential / (0.5 * all.normal);
        EXPECT_NEAR(ratio, expected, 0.01) << impact << ' ' << stock;
        most = std::max(most, std::fabs(ratio - expected));
      }
  this->RecordProperty("most", std::to_string(most));
}

TYPED_TEST(ObliqueImpact, GainsNoEnergyByFriction) {
  std::mt19937 random(15485867);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double most = 0.0;
  for (int n = 0; n < 2000; ++n) {
    const Oblique impact{89.0 * unit(random), n % 4 == 0 ? 0.0 : 10.0 * unit(random), 10.0 * unit(random)};
    const Impulses after = impact_in_steps<TypeParam>(impact, n % 2 == 0, 200.0);
    most = std::max(most, std::fabs(after.slip_after) / impact.slip_speed());
  }
  EXPECT_LT(most, 1.0 + 1e-3);
}

/// Largest errors of the tangential impulse over that of the reference solution, and of its ratio to mu times
/// the normal impulse, over places of the make in its step.
template <class Contact>
std::pair<double, double> errors_of_sliding(const Oblique &impact, double steps) {
  const double exact = exact_impact<Contact>(impact).tangential;
  std::pair<double, double> worst{0.0, 0.0};
  for (const double factor : {1.0, 1.03, 1.07, 1.12, 1.18}) // which moves the place of the break
    for (int n = 0; n < 10; ++n) {
      const double dt = duration<Contact>(impact) / (factor * steps);
      const Impulses all = in_steps(contact_of<Contact>(impact), impact, false, dt, (n + 0.5) / 10.0);
      worst.first = std::max(worst.first, std::fabs(all.tangential / exact - 1.0));
      worst.second = std::max(worst.second, std::fabs(all.tangential / (impact.mu * all.normal) - 1.0));
    }
  return worst;
}

// In the step of a make friction takes the normal force of the half kick, not the whole one.
TYPED_TEST(ObliqueImpact, OfASlidingBallHasAnImpulseOfSecondOrder) {
  for (const double D : {0.02, 0.1, 0.3, 0.5, 1.0, 2.0})
    for (const double degrees : {76.0, 85.0}) {
      const Oblique impact{degrees, D, 0.5};
      const auto [coarse, ratio] = errors_of_sliding<TypeParam>(impact, 50.0);
      const auto [fine, ratio_fine] = errors_of_sliding<TypeParam>(impact, 400.0);
      EXPECT_LT(ratio, 1e-2) << impact;
      EXPECT_LT(errors_of_sliding<TypeParam>(impact, 200.0).second, 1e-3) << impact;
      EXPECT_LT(ratio_fine, 3e-4) << impact;
      EXPECT_GT(std::log2(coarse / fine) / 3.0, 1.9) << impact << ": " << coarse << ' ' << fine;
    }
}

// The engines' rule at 76 degrees.
TEST(ObliqueImpactOfHistory, ExceedsCoulombsLimit) {
  for (const auto &[D, known] : {std::pair{0.3, 1.49}, {2.0, 2.24}}) {
    const Oblique impact{76.0, D, 0.5, Transition::B, 0.0, Cap::spring};
    const Impulses all = impact_in_steps<LinearContact>(impact, true, 400.0);
    EXPECT_NEAR(all.tangential / (0.5 * all.normal), known, 0.03) << D;
  }
}

/// How the error of slip after an impact shrinks with the step, where the slider acts: twice the steps divide
/// it by 2^order. Normal dashpot none, so that the order is that of friction. The changes from stick to slide
/// fall anywhere within a step, and so does the make: means of many.
double order_of_impact(const Oblique &impact) {
  LinearContact contact = contact_of<LinearContact>(impact);
  contact.tangential_stiffness = 0.6 * kn; // with 2/7 kn both directions swing alike, and errors cancel
  const double exact = Reference(formula_of(contact), impact).solve().slip_after;
  const auto error = [&](int steps) {
    double sum = 0.0;
    for (int n = 0; n < 20; ++n)
      sum += std::fabs(
          in_steps(contact, impact, true, pi / std::sqrt(kn) / (steps + 7 * n), (n + 0.5) / 20.0).slip_after -
          exact);
    return sum;
  };
  return std::log2(error(200) / error(850)) / std::log2(917.0 / 267.0);
}

// Without a dashpot a ball that sticks at first errs in the first order if its spring takes up the whole step
// of the make.
TEST(ObliqueImpactOrder, IsOneWithADashpotAndTwoOrMoreWithout) {
  for (const double degrees : {20.0, 45.0, 60.0}) { // the last two slide and stick
    EXPECT_GT(order_of_impact({degrees, 0.0, 0.5}), 1.85) << degrees;
    EXPECT_NEAR(order_of_impact({degrees, 0.0, 0.5, Transition::B, 0.3 * std::sqrt(kn)}), 1.0, 0.15)
        << degrees;
  }
}

} // namespace
