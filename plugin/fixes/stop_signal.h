#pragma once
// Signals that tell a run to stop: Ctrl-C (SIGINT) and what schedulers and mpirun send (SIGTERM).

#include "engine.h"

#include <chrono>
#include <csignal>
#include <vector>

namespace drumlin {

/// While an object lives, a signal does no more than ask for the end of the run, which the engine then ends after a step, on all ranks after
/// the same one, some tenth of a second later. The third signal ends the process at once. Handlers of before come back with the end of the object. One at a time.
class StopSignal {
public:
  explicit StopSignal(engine::LAMMPS *lmp);
  ~StopSignal();
  StopSignal(const StopSignal &) = delete;
  StopSignal &operator=(const StopSignal &) = delete;

  /// Whether a rank has been told to stop; the engine then ends its runs. Collective.
  static bool told(engine::LAMMPS *lmp);

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

/// fix drumlin/stop: made by StopSignal, not by decks. It asks during a run: after every step on one rank, on several about fifty times
/// a second, since all ranks wait for the slowest to answer. (mpirun kills a rank a second after it has told it to stop.)
class FixStop : public Fix {
public:
  FixStop(LAMMPS *lammps, int narg, char **arg) : Fix(lammps, narg, arg) { nevery = 1; }
  int setmask() override { return FixConst::END_OF_STEP; }
  void end_of_step() override;

  static constexpr const char *style_name = "drumlin/stop";

private:
  int interval_ = 1; ///< steps from one question to the next, the same on all ranks
  int steps_ = 0;    ///< since the last
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
};

} // namespace LAMMPS_NS
