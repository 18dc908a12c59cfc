#pragma once
/// The second-order stepping of one ball among fixed partners on a line, as the plugin does it in the engines: half kick, drift,
/// forces by physics/stepping.h, half kick, then what stepping.h puts back or shifts.

#include "physics/stepping.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace stepping {

/// A ball on a line; partner n touches it where sign * (x - place) = 0 and overlaps below.
class SecondOrderBall {
public:
  struct Partner {
    double place;
    double sign; ///< +1: the partner is below
    double k, c;
    double force = 0.0; // of the opening half kick
  };

  SecondOrderBall(double mass, double x_start, double v_start, double dt,
                  drumlin::physics::Transition transition, std::vector<Partner> partners,
                  double constant_force = 0.0)
      : x(x_start), v(v_start), mass_(mass), dt_(dt), transition_(transition), partners_(std::move(partners)),
        constant_(constant_force), force_(constant_force) {
    for (Partner &p : partners_) {
      const double d = overlap(p);
      p.force = drumlin::physics::normal_force(transition_, p.k, p.c, d, -p.sign * v);
      force_ += p.sign * p.force;
      if (d > 0.0) damping_ += p.c / mass_;
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
    double kick = constant_;
    double damping = 0.0;
    force_ = constant_;
    std::vector<std::pair<Partner *, CoupledDashpot>> coupled;
    for (Partner &p : partners_) {
      const StepMotion motion{overlap(p), -p.sign * half, -p.sign * before, dt_};
      StepForce f{0.0, 0.0, 0.0};
      if (motion.overlap > 0.0) {
        f = second_order_force(transition_, p.k, p.c, motion, p.force, p.c / mass_);
        damping += p.c / mass_;
        if (needs_coupling(dt_, p.k, p.c, damping_) && !made_in_step(motion, p.force)) {
          coupled.emplace_back(&p, coupled_dashpot(transition_, p.k, p.c, motion, p.force, damping_));
          f.force = f.kick = coupled.back().second.first;
        }
      } else {
        f = second_order_break(transition_, p.k, p.c, motion);
      }
      p.force = f.force;
      force_ += p.sign * f.force;
      kick += p.sign * f.kick;
      shift_ += p.sign * f.shift;
    }
    const double predicted = half + 0.5 * dt_ * kick / mass_;
    for (auto &[p, dashpot] : coupled) {
      p->force = coupled_force(dashpot, -p->sign * predicted);
      force_ += p->sign * (p->force - dashpot.first);
      kick += p->sign * (p->force - dashpot.first);
    }
    damping_ = damping;
    v = half + 0.5 * dt_ * kick / mass_;
    double largest = 0.0;
    for (const Partner &p : partners_)
      largest = std::max(largest, p.force);
    return largest;
  }

  double overlap(const Partner &p) const { return -p.sign * (x - p.place); }

  double x, v;

private:
  double mass_, dt_;
  drumlin::physics::Transition transition_;
  std::vector<Partner> partners_;
  double constant_; // such as a weight
  double force_;
  double shift_ = 0.0;
  double damping_ = 0.0;
};

} // namespace stepping
