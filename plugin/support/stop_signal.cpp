#include "support/stop_signal.h"

#include <algorithm>
#include <string>

namespace {

volatile std::sig_atomic_t signals = 0;

/// The first two signals are only counted, because Ctrl-C reaches the ranks twice: from the terminal, and as
/// SIGTERM from mpirun.
void count_signal(int number) {
  signals = signals + 1;
  if (signals < 3) return;
  std::signal(number, SIG_DFL);
  std::raise(number);
}

/// Ends the engine's runs, after the present step, if a rank has received a signal. Collective.
void end_runs_after_signal(drumlin::engine::LAMMPS *lmp) {
  int stop = signals;
  if (lmp->comm->nprocs > 1) MPI_Allreduce(MPI_IN_PLACE, &stop, 1, MPI_INT, MPI_MAX, lmp->world);
  if (stop == 0) return;
  drumlin::engine::end_runs(lmp);
  lmp->update->laststep = lmp->update->ntimestep;
}

constexpr const char *fix_id = "drumlin_stop";

} // namespace

drumlin::StopSignal::StopSignal(engine::LAMMPS *lmp) : lmp_(lmp) {
  std::string words[] = {fix_id, "all", LAMMPS_NS::FixStop::style_name};
  char *arg[] = {words[0].data(), words[1].data(), words[2].data()};
  lmp->modify->add_fix(3, arg);
  signals = 0;
  struct sigaction counting {};
  counting.sa_handler = count_signal;
  counting.sa_flags = SA_RESTART; // a signal does not interrupt a write to a file
  for (const int number : {SIGINT, SIGTERM}) {
    Handler &handler = handlers_.emplace_back();
    handler.number = number;
    sigaction(number, &counting, &handler.before);
  }
}

drumlin::StopSignal::~StopSignal() {
  for (const Handler &handler : handlers_)
    sigaction(handler.number, &handler.before, nullptr);
  if (engine::find_fix(lmp_->modify, fix_id) != nullptr) lmp_->modify->delete_fix(fix_id);
}

bool drumlin::StopSignal::received(engine::LAMMPS *lmp) {
  end_runs_after_signal(lmp);
  return engine::runs_have_ended(lmp);
}

void LAMMPS_NS::FixStop::post_integrate() {
  if (++steps_ < interval_) return;
  steps_ = 0;
  end_runs_after_signal(lmp);
  if (comm->nprocs == 1) return;
  constexpr double wanted = 0.02; // s between two checks
  // Time steps between two checks: few enough for steps that become slower when the machine gets other work.
  constexpr int most = 200;
  const auto now = std::chrono::steady_clock::now();
  double passed = std::chrono::duration<double>(now - last_check_).count();
  last_check_ = now;
  MPI_Allreduce(MPI_IN_PLACE, &passed, 1, MPI_DOUBLE, MPI_MAX, world);
  const double steps = interval_ * std::clamp(wanted / std::max(passed, 1e-9), 0.1, 2.0);
  interval_ = static_cast<int>(std::clamp(steps, 1.0, 1.0 * most));
}
