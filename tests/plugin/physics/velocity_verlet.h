#pragma once
/// The engines' part of a step, for tests of laws and of advance(): velocity Verlet as in fix nve/sphere, of
/// balls on a line.

#include "physics/scheme/advance.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace verlet {

template <std::size_t N>
struct Balls {
  std::array<double, N> mass; ///< infinite: moves only with the velocity that it has
  std::array<double, N> x;
  std::array<double, N> v;
  std::array<double, N> force{}; ///< of the last step; zero before the first
};

/// One step of dt to time t_end. forces(t_end, x, v) returns the force on every ball from the new positions
/// and the half-step velocities, as the stock scheme has it.
template <std::size_t N, typename Forces>
void stock_step(Balls<N> &balls, double t_end, double dt, const Forces &forces) {
  for (std::size_t i = 0; i < N; ++i) {
    balls.v[i] += 0.5 * dt * balls.force[i] / balls.mass[i];
    balls.x[i] += dt * balls.v[i];
  }
  balls.force = forces(t_end, balls.x, balls.v);
  for (std::size_t i = 0; i < N; ++i)
    balls.v[i] += 0.5 * dt * balls.force[i] / balls.mass[i];
}

/// A ball on a line among fixed partners, with the second-order scheme. The forces are those of advance();
/// this class makes the half kicks and the drift, and applies a StepResult as FixStepping does in the
/// engines.
template <class Law>
class SecondOrderBall {
public:
  /// A partner touches the ball where sign * (x - place) = 0 and overlaps below.
  struct Partner {
    double place;
    double sign; ///< +1: the partner is below
    Law law;
    drumlin::physics::ContactState state{};
    double suction = 0.0; ///< N
    Law fresh = law;      ///< that of a contact that begins
  };

  SecondOrderBall(double mass, double x_start, double v_start, double dt, std::vector<Partner> partners,
                  double constant_force = 0.0)
      : x(x_start), v(v_start), constant(constant_force), mass_(mass), dt_(dt),
        partners_(std::move(partners)), force_(constant_force) {
    for (Partner &p : partners_) {
      const double d = overlap(p), rate = -p.sign * v;
      if (d <= 0.0) continue;
      force_ +=
          p.sign * (advance(p.law, {d, rate, rate, dt_}, p.state, {mass_, 0.0, true}).force - p.suction);
      damping_ += std::sqrt(p.law.dashpot(d)) / mass_;
    }
  }

  /// One step; returns the largest contact force in it.
  double step() {
    using namespace drumlin::physics;
    const double before = v;
    double half = v + 0.5 * dt_ * (force_ + shift_) / mass_;
    x += dt_ * half;
    half -= 0.5 * dt_ * shift_ / mass_;
    shift_ = 0.0;
    double kick = constant;
    double damping = 0.0;
    force_ = constant;
    std::vector<std::pair<Partner *, CoupledDashpot>> coupled;
    for (Partner &p : partners_) {
      const StepMotion motion{overlap(p), -p.sign * half, -p.sign * before, dt_};
      const ContactState old = p.state;
      const StepResult own = advance(p.law, motion, p.state, {mass_, damping_, false});
      const StepResult f = with_suction(own, p.suction, motion, old, false);
      if (p.state.in_contact) damping += std::sqrt(p.law.dashpot(motion.overlap)) / mass_;
      if (f.coupled) coupled.emplace_back(&p, f.dashpot);
      force_ += p.sign * (f.coupled ? f.kick : f.force);
      kick += p.sign * f.kick;
      shift_ += p.sign * f.shift;
    }
    const double predicted = half + 0.5 * dt_ * kick / mass_;
    for (auto &[p, dashpot] : coupled) {
      p->state.force = coupled_force(dashpot, -p->sign * predicted);
      force_ += p->sign * (p->state.force - dashpot.first);
      kick += p->sign * (p->state.force - dashpot.first);
    }
    damping_ = damping;
    v = half + 0.5 * dt_ * kick / mass_;
    double largest = 0.0;
    for (Partner &p : partners_) {
      largest = std::max(largest, p.state.force);
      if (overlap(p) > 0.0)
        p.law.remember(overlap(p));
      else
        p.law = p.fresh;
    }
    return largest;
  }

  double overlap(const Partner &p) const { return -p.sign * (x - p.place); }

  double x, v;
  double constant; ///< N, such as a weight; a force that changes is set before each step for its end

private:
  double mass_, dt_;
  std::vector<Partner> partners_;
  double force_;
  double shift_ = 0.0;
  double damping_ = 0.0;
};

} // namespace verlet
