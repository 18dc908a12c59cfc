#include "map/ends.h"

#include "chain/linear_algebra.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace drumlin::post {

const std::array<const char *, ends_mode_count> ends_mode_names = {
    "continuous contact", "uplift of one end", "uplift of both ends", "double jump", "rocking",
    "combined",           "higher period",     "aperiodic",           "undecided"};

EndsCycles::Passage EndsCycles::pass(const TwoEndsState &state, int cycles, bool with_jacobian) const {
  Passage passage;
  TwoEndsMotion motion = solver.start_at(state);
  for (int cycle = 0; cycle < cycles; ++cycle)
    if (with_jacobian)
      passage.jacobian = (solver.monodromy(motion) * passage.jacobian).eval();
    else
      solver.finish_cycle(motion);
  passage.end = motion.state;
  return passage;
}

TwoEndsState EndsCycles::scale() const {
  const TwoEnds &machine = solver.machine();
  const ChainParameters &p = machine.chain;
  double speed = std::max(p.Fw / p.m2, p.g) / p.omega;
  if (speed <= 0.0) speed = 1.0;
  Eigen::Vector4d of_speed(speed, speed, speed * std::sqrt(p.m2 / machine.drum_inertia),
                           speed * std::sqrt(p.m3 / machine.frame_inertia));
  TwoEndsState scale;
  scale << of_speed / p.omega, of_speed;
  return scale;
}

void EndsCycles::advance(TwoEndsMotion &motion, TwoEndsState *tangent) const {
  if (tangent == nullptr)
    solver.finish_cycle(motion);
  else
    *tangent = (solver.monodromy(motion) * *tangent).eval();
}

namespace {

/// Range of the tilt and time in contact of both halves.
class HalfSums : public TwoEndsObserver {
public:
  explicit HalfSums(const TwoEnds &machine) {
    for (std::size_t j = 0; j < machine.contacts.size(); ++j) {
      const double y = machine.contacts[j].y;
      if (y <= 0.0) halves_[0] |= 1U << j;
      if (y >= 0.0) halves_[1] |= 1U << j;
    }
  }
  void piece(const ContactSet::Piece &piece, const ContactSet & /*set*/, std::uint32_t acting) override {
    constexpr int parts = 8;
    for (int part = 0; part <= parts; ++part) {
      const double tilt = piece.state(piece.end * part / parts)[2];
      least_ = std::min(least_, tilt);
      most_ = std::max(most_, tilt);
    }
    for (std::size_t half = 0; half < 2; ++half) {
      if ((acting & halves_[half]) != 0) time_[half] += piece.length * piece.end;
      lost_[half] = lost_[half] || (acting & halves_[half]) != halves_[half];
    }
  }
  void change(const ContactChange & /*change*/) override {}

  bool lost(std::size_t half) const { return lost_[half]; }
  void take(EndsPoint &point, double time) const {
    point.tilt = 0.5 * (most_ - least_);
    for (std::size_t half = 0; half < 2; ++half)
      point.contact_share[half] = std::min(1.0, time_[half] / time);
  }

private:
  std::array<std::uint32_t, 2> halves_{};
  std::array<double, 2> time_{};
  std::array<bool, 2> lost_{};
  double least_ = std::numeric_limits<double>::infinity(), most_ = -least_;
};

/// The mode of a motion of two cycles by what differs between them.
EndsMode mode_of_two(const EndsCycles &system, const TwoEndsState &state) {
  const TwoEndsState apart = (system.pass(state, 1, false).end - state).cwiseQuotient(system.scale());
  const double height = std::hypot(apart[0], apart[4]), tilt = std::hypot(apart[2], apart[6]);
  constexpr double mostly = 3.0;
  return tilt < height / mostly   ? EndsMode::double_jump
         : tilt > mostly * height ? EndsMode::rocking
                                  : EndsMode::combined;
}

} // namespace

EndsPoint judge_ends_from(const TwoEndsSolver &solver, TwoEndsMotion &motion, int cycles) {
  const EndsCycles system{solver};
  const auto settled = settle(system, motion, cycles);
  EndsPoint point;
  constexpr int window = 64;
  int counted = window;
  TwoEndsState state = settled.state;
  if (settled.orbit) {
    state = settled.orbit->state;
    counted = point.period = settled.orbit->period;
    point.multiplier = std::abs(settled.orbit->multipliers[0]);
    constexpr double forgotten = -1e3; // a multiplier of zero has no logarithm
    const double rate = point.multiplier > 0.0 ? std::log(point.multiplier) / point.period : forgotten;
    point.exponent = {rate, rate, rate};
  } else {
    point.exponent = settled.exponent;
    if (settled.aperiodic) point.mode = EndsMode::aperiodic;
  }
  HalfSums sums(solver.machine());
  motion = solver.start_at(state);
  for (int cycle = 0; cycle < counted; ++cycle)
    solver.finish_cycle(motion, &sums);
  sums.take(point, counted * solver.machine().chain.period());
  if (point.period == 1)
    point.mode = sums.lost(0) && sums.lost(1)   ? EndsMode::uplift_of_both_ends
                 : sums.lost(0) || sums.lost(1) ? EndsMode::uplift_of_one_end
                                                : EndsMode::continuous_contact;
  else if (point.period == 2)
    point.mode = mode_of_two(system, state);
  else if (point.period > 2)
    point.mode = EndsMode::higher_period;
  return point;
}

EndsPoint judge_ends(const TwoEnds &machine, int cycles) {
  const TwoEndsSolver solver(machine);
  TwoEndsMotion motion = solver.start();
  return judge_ends_from(solver, motion, cycles);
}

double ends_margin(const TwoEnds &machine) {
  using Complex = std::complex<double>;
  const ChainParameters &p = machine.chain;
  Eigen::Matrix4cd dynamic = Eigen::Matrix4cd::Zero();
  Eigen::Matrix4d spring = Eigen::Matrix4d::Zero();
  dynamic.diagonal() =
      -p.omega * p.omega * Eigen::Vector4cd(p.m2, p.m3, machine.drum_inertia, machine.frame_inertia);
  const auto add = [&](const AxleLink &link, const Eigen::Vector4d &way) {
    const Eigen::Matrix4d square = way * way.transpose();
    dynamic += Complex(link.k, p.omega * link.c) * square.cast<Complex>();
    spring += link.k * square;
  };
  for (const AxleLink &link : machine.contacts)
    add(link, {1.0, 0.0, link.y, 0.0});
  for (const AxleLink &link : machine.bonds)
    add(link, {1.0, -1.0, link.y, -link.y});
  const Eigen::Vector4d push(-p.Fw, 0.0, -machine.exciter * p.Fw, 0.0),
      weight(-p.m2 * p.g, -p.m3 * p.g, 0.0, 0.0);
  const Eigen::Vector4cd amplitude = dynamic.fullPivLu().solve(push.cast<Complex>());
  const Eigen::Vector4d mean = solution_of(spring, weight);
  double least = std::numeric_limits<double>::infinity();
  for (const AxleLink &link : machine.contacts) {
    const double c = p.transition == Transition::B ? link.c : 0.0;
    const double swing = std::abs((amplitude[0] + link.y * amplitude[2]) * Complex(link.k, p.omega * c));
    least = std::min(least, -link.k * (mean[0] + link.y * mean[2]) - swing);
  }
  return least;
}

} // namespace drumlin::post
