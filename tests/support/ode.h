#pragma once
/// An ordinary differential equation solved by SUNDIALS CVODE to tight tolerances: the oracle of these tests
/// that shares no code with the core. It neither includes nor calls plugin/physics.
#include "tests/support/prelude.h"

namespace oracle {

using State = std::vector<double>;
using Rates = std::function<void(double t, const State &y, State &dydt)>;
using Event = std::function<double(double t, const State &y)>; ///< zero where the event happens

/// Integrates y' = rates(t, y) from (t, y). `scale` is a typical size of every component, from which the
/// absolute tolerances follow.
class Ode {
public:
  Ode(Rates rates, double t, State y, const State &scale);
  ~Ode();
  Ode(const Ode &) = delete;
  Ode &operator=(const Ode &) = delete;

  /// Goes to t_end, or to the first zero of an event on the way. Returns the event's index, or -1 at t_end.
  int advance(double t_end, const std::vector<Event> &events = {});
  /// Replaces the state at the present time, after a jump of the rates or of the state.
  void restart(const State &y);

  [[nodiscard]] double time() const;
  [[nodiscard]] const State &state() const;

private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

} // namespace oracle
