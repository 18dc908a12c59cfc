#pragma once
// The own clock of a fix: time since its first run, through several runs, restarts and changes of the time
// step.

#include "engine.h"

namespace drumlin {

/// Time = base + (step - base_step) dt. The engine's restart file keeps the step number, but neither time nor
/// dt; a fix stores these three numbers and goes on bitwise.
class Clock {
public:
  /// Starts the clock at time 0, or carries it over a change of the time step. Call at each set-up.
  void set_up(engine::bigint step, double dt) {
    if (!running_) {
      running_ = true;
      base_step_ = step;
      dt_ = dt;
    } else if (dt != dt_) {
      base_time_ = time(step);
      base_step_ = step;
      dt_ = dt;
    }
  }

  double time(engine::bigint step) const { return base_time_ + static_cast<double>(step - base_step_) * dt_; }
  bool running() const { return running_; }

  /// State as numbers for a restart file, and back.
  std::array<double, 3> state() const { return {base_time_, static_cast<double>(base_step_), dt_}; }
  void restore(const double *state) {
    running_ = true;
    base_time_ = state[0];
    base_step_ = static_cast<engine::bigint>(state[1]);
    dt_ = state[2];
  }

private:
  bool running_ = false;
  double base_time_ = 0.0;
  engine::bigint base_step_ = 0;
  double dt_ = 0.0;
};

} // namespace drumlin
