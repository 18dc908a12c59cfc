#pragma once
/// The engines' part of a step, for tests of laws and of advance(): velocity Verlet as in fix nve/sphere, of
/// a ball on a line among fixed partners.
#include "tests/support/prelude.h"
#include "physics/scheme/advance.h"

namespace verlet {

/// The engines' own scheme, or that of the plugin.
enum class Scheme { stock, second };

/// The forces are those of advance() or advance_stock(); this class makes the half kicks and the drift, and
/// applies a StepResult as FixStepping does in the engines.
template <class Law>
class Ball {
public:
  /// A partner touches the ball where sign * (x - place) = 0 and overlaps below.
  struct Partner {
    double place;
    double sign; ///< +1: the partner is below
    Law law;
    double suction = 0.0; ///< N
    drumlin::physics::ContactState state{};
    double power = 0.0; ///< W, heat of the dashpot at the end of the step
    Law fresh = law;    ///< that of a contact that begins
  };

  Ball(double mass, double x_start, double v_start, double dt, std::vector<Partner> partners,
       double constant_force = 0.0, Scheme scheme = Scheme::second)
      : x(x_start), v(v_start), constant(constant_force), mass_(mass), dt_(dt), scheme_(scheme),
        partners_(std::move(partners)), force_(constant_force) {
    for (Partner &p : partners_) {
      const double d = overlap(p);
      if (d <= 0.0) continue;
      p.state = {p.law.force(d, -p.sign * v), true};
      force_ += p.sign * (p.state.force - p.suction);
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
      const StepResult f = contact_step(p, motion);
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
      end_step(p);
    }
    return largest;
  }

  double overlap(const Partner &p) const { return -p.sign * (x - p.place); }
  const Partner &partner() const { return partners_.front(); }

  /// Kinetic energy, and what the contacts and a constant force can give back, J.
  double energy() const {
    double sum = 0.5 * mass_ * v * v - constant * x;
    for (const Partner &p : partners_)
      sum += p.law.energy(overlap(p)) - p.suction * std::max(0.0, overlap(p));
    return sum;
  }

  double x, v;
  double constant;   ///< N, such as a weight; a force that changes is set before each step for its end
  double heat = 0.0; ///< J, of all contacts since the beginning

private:
  drumlin::physics::StepResult contact_step(Partner &p, const drumlin::physics::StepMotion &motion) {
    if (scheme_ == Scheme::stock) {
      drumlin::physics::StepResult f = advance_stock(p.law, motion, p.state);
      if (motion.overlap > 0.0) f.force = f.kick = f.force - p.suction;
      return f;
    }
    const drumlin::physics::ContactState old = p.state;
    const drumlin::physics::StepResult own = advance(p.law, motion, p.state, {mass_, damping_, false});
    const drumlin::physics::StepResult f = with_suction(own, p.suction, motion, old, false);
    heat += heat_of_change(p.law, p.suction, motion, old, own, f, mass_);
    return f;
  }

  /// Adds the heat of the dashpot, by the trapezoidal rule, and of yielding; takes up the overlap.
  void end_step(Partner &p) {
    const double d = overlap(p);
    const double power = d > 0.0 ? (p.state.force - p.law.spring(d)) * -p.sign * v : 0.0;
    heat += 0.5 * dt_ * (p.power + power);
    p.power = power;
    if (d > 0.0) {
      const double yielded = p.law.yielded(0.0);
      p.law.remember(d);
      heat += p.law.yielded(0.0) - yielded;
    } else {
      p.law = p.fresh;
    }
  }

  double mass_, dt_;
  Scheme scheme_;
  std::vector<Partner> partners_;
  double force_;
  double shift_ = 0.0;
  double damping_ = 0.0;
};

} // namespace verlet
