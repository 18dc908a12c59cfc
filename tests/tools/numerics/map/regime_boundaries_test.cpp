// The boundaries of regimes that are found from orbits, against CVODE: the loss of contact against the direct
// solver, the period doubling against a Poincare map that is integrated here. Both to a relative 1e-6.
#include "chain/one_contact.h"
#include "map/orbits.h"
#include "tests/support/chain_by_cvode.h"
#include "tests/support/ode.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <cmath>
#include <vector>

namespace {

using namespace drumlin::post;

// The map from the start of a cycle to that of the next, by CVODE with the equations of motion and the
// transition condition B written down again.
class CvodeMap {
public:
  explicit CvodeMap(const ChainParameters &p) : p_(p), scale_(state_scale(p)) {}

  Eigen::Vector4d operator()(const Eigen::Vector4d &start) const {
    phase_ = start[0] > 0.0                    ? Phase::flight
             : force(start[0], start[1]) > 0.0 ? Phase::contact
                                               : Phase::clamped;
    const auto rates = [this](double t, const oracle::State &y, oracle::State &rate) {
      const double bond = p_.c23 * (y[3] - y[1]) + p_.k23 * (y[2] - y[0]);
      const double contact = phase_ == Phase::contact ? force(y[0], y[1]) : 0.0;
      rate = {y[1], (contact + bond - p_.Fw * std::sin(p_.omega * t)) / p_.m2 - p_.g, y[3],
              -bond / p_.m3 - p_.g};
    };
    oracle::Ode ode(rates, 0.0, {start.data(), start.data() + 4}, {scale_.data(), scale_.data() + 4});
    const oracle::Event gap = [](double, const oracle::State &y) { return y[0]; };
    const oracle::Event load = [this](double, const oracle::State &y) { return force(y[0], y[1]); };
    while (true) {
      const std::vector<oracle::Event> events = phase_ == Phase::contact  ? std::vector{load}
                                                : phase_ == Phase::flight ? std::vector{gap}
                                                                          : std::vector{gap, load};
      const int event = ode.advance(p_.period(), events);
      if (event < 0) break;
      phase_ = phase_ == Phase::contact  ? Phase::clamped
               : phase_ == Phase::flight ? Phase::contact
               : event == 0              ? Phase::flight
                                         : Phase::contact;
      ode.restart(ode.state());
    }
    return Eigen::Map<const Eigen::Vector4d>(ode.state().data());
  }

  Eigen::Matrix4d jacobian(const Eigen::Vector4d &at) const {
    constexpr double share = 1e-4;
    Eigen::Matrix4d result;
    for (Eigen::Index i = 0; i < 4; ++i) {
      Eigen::Vector4d up = at;
      Eigen::Vector4d down = at;
      up[i] += share * scale_[i];
      down[i] -= share * scale_[i];
      result.col(i) = ((*this)(up) - (*this)(down)) / (2.0 * share * scale_[i]);
    }
    return result;
  }

  // The periodic motion next to a guess, by Newton's method.
  Eigen::Vector4d orbit(Eigen::Vector4d state) const {
    for (int i = 0; i < 3; ++i) {
      const Eigen::Matrix4d equation = Eigen::Matrix4d::Identity() - jacobian(state);
      state += equation.fullPivLu().solve((*this)(state)-state);
    }
    EXPECT_LT(((*this)(state)-state).cwiseQuotient(scale_).norm(), 1e-8);
    return state;
  }

private:
  enum class Phase { contact, flight, clamped };
  double force(double x, double v) const { return -(p_.k * x + p_.damping() * v); }

  ChainParameters p_;
  Eigen::Vector4d scale_;
  mutable Phase phase_ = Phase::contact;
};

TEST(Boundaries, ContactIsLostWhereTheDirectSolverLosesIt) {
  for (const Transition transition : {Transition::A, Transition::B}) {
    SCOPED_TRACE(transition_name(transition));
    const ChainFamily family = [&](double k) {
      ChainParameters p = table1_case("I", transition);
      p.k = k;
      return p;
    };
    const auto onset = locate_contact_loss(family, 5e6, 20e6);
    ASSERT_TRUE(onset);
    for (const double side : {-1e-6, 1e-6}) {
      ExactOptions options;
      options.cycles = 200;
      options.samples_per_cycle = 1;
      const CycleSummary last =
          drumlin::test::solve_by_cvode(family(onset->value * (1.0 + side)), options).cycles.back();
      EXPECT_EQ(last.breaks > 0, side > 0.0) << side;
    }
  }
}

TEST(Boundaries, AMultiplierPassesMinusOneWhereThatOfCvodesMapDoes) {
  const ChainFamily family = [](double k) {
    ChainParameters p = table1_case("II", Transition::B);
    p.D = 0.1;
    p.k = k;
    return p;
  };
  const ChainSolver before(family(15e6));
  ChainMotion motion = before.start();
  for (int cycle = 0; cycle < 400; ++cycle)
    before.finish_cycle(motion);
  const auto start = find_orbit(before, motion.state, 1);
  ASSERT_TRUE(start);
  const auto doubling = locate_doubling(family, 15e6, 25e6, *start);
  ASSERT_TRUE(doubling);
  const std::vector<BranchPoint> branch = continue_orbit(family, 15e6, doubling->value, 8, *start);
  for (const double side : {-1e-6, 1e-6}) {
    const CvodeMap map(family(doubling->value * (1.0 + side)));
    const Eigen::Vector4d orbit = map.orbit(branch.back().orbit.state);
    const double determinant = (map.jacobian(orbit) + Eigen::Matrix4d::Identity()).determinant();
    EXPECT_EQ(determinant > 0.0, side < 0.0) << side << " " << determinant;
  }
}

} // namespace
