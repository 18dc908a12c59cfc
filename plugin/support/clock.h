#pragma once
// The clock of a fix: time since the fix's first run, through further runs, restarts and changes of the time
// step, between runs and within one.

#include "engine.h"

namespace drumlin {

/// Time = base time + (step - base step) dt. The engine's restart file has the step, but neither time nor dt:
/// a fix stores the three numbers of state() there, and its clock then continues with the same bits as
/// without the restart.
class Clock {
public:
  /// Starts the clock at time 0; when it runs, carries the time over a change of the time step. Call at each
  /// set-up of a run.
  /// \param dt s, > 0
  void set_up(engine::bigint step, double dt) {
    if (!running_) {
      running_ = true;
      base_step_ = step;
      dt_ = dt;
    } else
      change_step(step, dt);
  }

  /// Follows a change of the time step within a run. Call in each step when the balls have moved
  /// (post_integrate): the step that has begun then is the first with the time step dt. In an engine's
  /// end_of_step a fix cannot know whether dt is still that of the step that ends, or already that of the
  /// next.
  /// \param step the number of this step
  void follow(engine::bigint step, double dt) { change_step(step - 1, dt); }

  /// The time step, s, of the last step.
  double dt() const { return dt_; }

  /// Time at a step, s. Valid after set_up() or restore().
  double time(engine::bigint step) const { return base_time_ + static_cast<double>(step - base_step_) * dt_; }
  /// Whether the clock has been started or restored.
  bool running() const { return running_; }

  /// Base time, base step and time step, for a restart file.
  std::array<double, 3> state() const { return {base_time_, static_cast<double>(base_step_), dt_}; }
  /// \param state the three numbers of state()
  void restore(const double *state) {
    running_ = true;
    base_time_ = state[0];
    base_step_ = static_cast<engine::bigint>(state[1]);
    dt_ = state[2];
  }

private:
  /// From the end of a step on, the time step is dt.
  void change_step(engine::bigint step, double dt) {
    if (dt == dt_) return;
    base_time_ = time(step);
    base_step_ = step;
    dt_ = dt;
  }

  bool running_ = false;
  double base_time_ = 0.0;
  engine::bigint base_step_ = 0;
  double dt_ = 0.0;
};

} // namespace drumlin
