#include "commands/commands.h"

#include "commands/bed_files.h"
#include "commands/deck_variables.h"
#include "support/arguments.h"
#include "support/stop_signal.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

/// Runs the scene of the deck in pieces, each of which is a command `run`.
class Run : LAMMPS_NS::Pointers {
public:
  Run(LAMMPS *engine, int narg, char **arg) : Pointers(engine) {
    Arguments in(error, "drumlin/run", narg, arg);
    DeckVariables::stop_on_fault(lmp);
    last_ = in.integer("the last step", 0, std::numeric_limits<engine::bigint>::max());
    while (!in.empty()) {
      const std::string keyword = in.word("keyword");
      if (keyword == "every")
        every_ = in.integer("keyword every", 1);
      else if (keyword == "limit")
        limit_ = in.number("keyword limit", Range::positive);
      else if (keyword == "restart") {
        restart_ = in.word("keyword restart", restart_name_allowed);
        notes_ = read_notes(lmp, in);
      } else
        in.fail("keyword", keyword, "every, limit or restart");
    }
    if (domain->box_exist == 0)
      in.fail("simulation box is missing; allowed: the command after create_box, read_data or read_restart");
    if (every_ == 0) { // one piece
      origin_ = update->ntimestep;
      every_ = std::max<engine::bigint>(last_ - origin_, 1);
    }
    if (std::isfinite(limit_) && restart_.empty())
      in.fail("keyword restart is missing with keyword limit; allowed: limit SECONDS restart FILE");
    if (!restart_.empty()) check_restart_name(lmp, restart_, "drumlin/run: keyword restart");
    if (update->ntimestep > last_)
      in.fail(fmt::format("the last step is '{}'; allowed: at least {}, the present step", last_,
                          update->ntimestep));
  }

  void run() {
    const StopSignal signals(lmp);
    const double begin = MPI_Wtime();
    const engine::bigint first = update->ntimestep;
    double longest = 0.0; // s, of the pieces
    double before = 0.0;
    while (update->ntimestep < last_) {
      const engine::bigint piece =
          std::min(every_ - (update->ntimestep - origin_) % every_, last_ - update->ntimestep);
      input->one(fmt::format("run {} post no", piece).c_str());
      double now = MPI_Wtime() - begin;
      MPI_Bcast(&now, 1, MPI_DOUBLE, 0,
                world); // all ranks use the clock of rank 0, to come to the same decision
      longest = std::max(longest, now - before);
      before = now;
      const auto done = static_cast<double>(update->ntimestep - first);
      engine::log_message(
          lmp, fmt::format("drumlin/run: {:.0f} %, step {} of {}, {:.6g} s simulated, {:.0f} s so far, about "
                           "{:.0f} s left\n",
                           100.0 * static_cast<double>(update->ntimestep) / static_cast<double>(last_),
                           update->ntimestep, last_, static_cast<double>(update->ntimestep) * update->dt, now,
                           now / done * static_cast<double>(last_ - update->ntimestep)));
      if (StopSignal::received(lmp)) {
        if (!restart_.empty()) write_noted_restart(lmp, restart_, notes_, "drumlin/run: keyword restart");
        engine::stop(lmp,
                     fmt::format("drumlin/run: stopped by a signal at step {} of {}; allowed: to {}",
                                 update->ntimestep, last_,
                                 restart_.empty() ? "run to the last step" : "continue from " + restart_));
      }
      if (update->ntimestep < last_ && now + longest > limit_) return stop();
    }
  }

private:
  /// Ends the engine because there is no time for another piece.
  void stop() {
    write_noted_restart(lmp, restart_, notes_, "drumlin/run: keyword restart");
    const std::string end =
        fmt::format("drumlin/run: stopped at step {} of {} by limit {:.6g} s; continue from {}",
                    update->ntimestep, last_, limit_, restart_);
    engine::note_end(lmp, end);
    engine::log_message(lmp, end + "\n");
    // The engine's command `quit` would exit with status 1, but this is no error.
    MPI_Barrier(world);
    MPI_Finalize();
    std::exit(0); // NOLINT(concurrency-mt-unsafe): as the engine ends itself
  }

  engine::bigint last_ = 0;
  engine::bigint every_ = 0;
  engine::bigint origin_ = 0;                              // pieces end at this step plus multiples of every_
  double limit_ = std::numeric_limits<double>::infinity(); // s of wall time
  std::string restart_;
  RestartNotes notes_;
};

} // namespace

void run_command(LAMMPS *lmp, int narg, char **arg) { Run(lmp, narg, arg).run(); }

} // namespace drumlin
