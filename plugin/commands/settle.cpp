#include "commands/commands.h"

#include "support/arguments.h"
#include "support/stop_signal.h"

#include <algorithm>
#include <fmt/format.h>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

/// Runs the scene of the deck in pieces and computes the unbalanced ratio after each.
class Settle : LAMMPS_NS::Pointers {
public:
  Settle(LAMMPS *engine, int narg, char **arg) : Pointers(engine) {
    Arguments in(error, "drumlin/settle", narg, arg);
    while (!in.empty()) {
      const std::string keyword = in.word("keyword");
      if (keyword == "ratio")
        ratio_ = in.number("keyword ratio", Range::positive);
      else if (keyword == "every")
        every_ = static_cast<int>(in.integer("keyword every", 1));
      else if (keyword == "limit")
        limit_ = in.integer("keyword limit", 0);
      else if (keyword == "force")
        force_ = in.number("keyword force", Range::positive);
      else if (keyword == "fixed") {
        fixed_groupbit_ = group->bitmask[in.group("keyword fixed", group)];
      } else
        in.fail("keyword", keyword, "ratio, every, limit, force or fixed");
    }
    if (domain->box_exist == 0)
      in.fail("simulation box is missing; allowed: the command after create_box and create_atoms");
  }

  void run() {
    const StopSignal signals(lmp);
    update->whichflag = 1;
    update->nsteps = static_cast<int>(limit_);
    update->firststep = update->beginstep = update->ntimestep;
    update->laststep = update->endstep = update->ntimestep + limit_;
    lmp->init();
    engine::set_up_run(update->integrate);
    timer->init();

    double ratio = unbalanced_ratio();
    const engine::bigint first = update->ntimestep;
    while (ratio > ratio_ && update->ntimestep - first < limit_) {
      const auto piece =
          static_cast<int>(std::min<engine::bigint>(every_, limit_ - (update->ntimestep - first)));
      update->integrate->run(piece);
      ratio = unbalanced_ratio();
      if (!std::isfinite(ratio)) break;
      if (StopSignal::received(lmp))
        engine::stop(
            lmp, fmt::format("drumlin/settle: stopped by a signal after {} steps, unbalanced ratio {:.3g}; "
                             "allowed: to run until it has settled",
                             update->ntimestep - first, ratio));
      const engine::bigint done = update->ntimestep - first;
      if (done / every_ % pieces_per_line == 0)
        engine::log_message(
            lmp, fmt::format("drumlin/settle: unbalanced ratio {:.3g} after {} steps, limit {:.3g}\n", ratio,
                             done, ratio_));
    }
    update->integrate->cleanup();
    update->whichflag = 0;
    update->firststep = update->laststep = 0;
    update->beginstep = update->endstep = 0;
    const engine::bigint steps = update->ntimestep - first;
    if (!(ratio <= ratio_))
      engine::stop(lmp, limit_ == 0
                            ? fmt::format("drumlin/settle: unbalanced ratio is '{:.3g}', the scene is "
                                          "not in equilibrium; allowed: at most "
                                          "{:.3g}",
                                          ratio, ratio_)
                            : fmt::format("drumlin/settle: unbalanced ratio is '{:.3g}' after {} steps, "
                                          "no equilibrium; allowed: at most {:.3g} "
                                          "within {} steps (a scene without damping never comes to rest)",
                                          ratio, steps, ratio_, limit_));
    engine::log_message(
        lmp, fmt::format("drumlin/settle: unbalanced ratio {:.3g} after {} steps\n", ratio, steps));
  }

private:
  static constexpr engine::bigint pieces_per_line = 10;

  /// Largest net force on a ball over the given force, or over the mean weight of a ball. The force that would
  /// stop a ball within one piece counts like a net force: a ball that moves through its equilibrium has no net
  /// force but is not at rest. With neither force nor gravity the ratio is 1, or 0 if there are neither forces
  /// nor motion. Collective.
  double unbalanced_ratio() {
    const std::array<double, 3> g = engine::gravity(modify);
    const double gravity = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    double worst = 0.0;
    std::array<double, 2> mine{};
    for (int i = 0; i < atom->nlocal; ++i) {
      if (atom->mask[i] & fixed_groupbit_) continue;
      const double *f = atom->f[i];
      const double *v = atom->v[i];
      const double m = atom->rmass[i];
      const double net = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
      const double speed = is_moving(i) ? std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) : 0.0;
      const double stopping = m * speed / (every_ * update->dt);
      worst = std::isfinite(net + stopping) ? std::max({worst, net, stopping})
                                            : std::numeric_limits<double>::infinity();
      mine[0] += m * gravity;
      mine[1] += 1.0;
    }
    double largest = 0.0;
    std::array<double, 2> all{};
    MPI_Allreduce(&worst, &largest, 1, MPI_DOUBLE, MPI_MAX, world);
    MPI_Allreduce(mine.data(), all.data(), 2, MPI_DOUBLE, MPI_SUM, world);
    if (largest == 0.0) return 0.0;
    const double weight = all[1] > 0.0 ? all[0] / all[1] : 0.0;
    const double scale = force_ > 0.0 ? force_ : weight;
    return scale > 0.0 ? largest / scale : 1.0;
  }

  /// Whether a time step changes the ball's position. With short steps a velocity that a dashpot slows down
  /// ever less becomes too small to change the last digit of the position; it would never become 0.
  bool is_moving(int i) const {
    const double *x = atom->x[i];
    const double *v = atom->v[i];
    bool moving = false;
    for (int a = 0; a < 3; ++a)
      moving = moving || x[a] + update->dt * v[a] != x[a];
    return moving;
  }

  double ratio_ = 1e-10;
  double force_ = 0.0; // N, with which net forces are compared; 0: the mean weight of a ball
  int every_ = 1000;
  engine::bigint limit_ = 5'000'000;
  int fixed_groupbit_ = 0;
};

} // namespace

void settle_command(LAMMPS *lmp, int narg, char **arg) { Settle(lmp, narg, arg).run(); }

} // namespace drumlin
