#pragma once
// Signals that tell a run to stop: Ctrl-C (SIGINT) and what schedulers and mpirun send (SIGTERM).

#include "engine.h"

#include <chrono>
#include <csignal>
#include <vector>

namespace drumlin {

/// While an object of this class exists, SIGINT and SIGTERM do not end the process: they ask the engine to
/// stop the run, which it does within about a tenth of a second, on all ranks after the same time step. The
/// third signal ends the process at once. The destructor restores the earlier signal handlers. Signals are
/// sent to a process, so that there may be only one object at a time in it.
class StopSignal {
public:
  explicit StopSignal(engine::LAMMPS *lmp);
  ~StopSignal();
  StopSignal(const StopSignal &) = delete;
  StopSignal &operator=(const StopSignal &) = delete;

  /// Whether a rank has received a signal to stop; the engine then ends its runs. Collective.
  static bool received(engine::LAMMPS *lmp);

private:
  engine::LAMMPS *lmp_;
  struct Handler {
    int number = 0;
    struct sigaction before {};
  };
  std::vector<Handler> handlers_;
};

} // namespace drumlin

namespace LAMMPS_NS {

/// fix drumlin/stop, which StopSignal adds to the run; decks do not use it. On one rank it checks for a
/// signal in every time step. On several ranks each check is a collective call that costs all of them
/// time, so it checks about fifty times a second. That is often enough: mpirun kills a rank one second after
/// it has sent it SIGTERM.
class FixStop : public Fix {
public:
  using Fix::Fix;
  int setmask() override { return FixConst::POST_INTEGRATE; }
  /// Before the forces of the step, which FixBetweenRuns then knows for the last.
  void post_integrate() override;

  static constexpr const char *style_name = "drumlin/stop";

private:
  int interval_ = 1; ///< time steps between two checks, the same on all ranks
  int steps_ = 0;    ///< time steps since the last check
  std::chrono::steady_clock::time_point last_check_ = std::chrono::steady_clock::now();
};

} // namespace LAMMPS_NS
