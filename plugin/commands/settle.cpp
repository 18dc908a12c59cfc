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
      else if (keyword == "loose") {
        loose_share_ = in.number("keyword loose, share", Range::non_negative);
        loose_steps_ = in.integer("keyword loose, steps", 1);
      } else if (keyword == "fixed") {
        fixed_groupbit_ = engine::group_bit(in.group("keyword fixed", group));
      } else
        in.fail("keyword", keyword, "ratio, every, limit, force, loose or fixed");
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

    const engine::bigint first = disturbed_ = update->ntimestep;
    Unrest unrest = measure();
    bool settled = is_rest(unrest);
    while (!settled && std::isfinite(unrest.ratio) && update->ntimestep - first < limit_) {
      const auto piece =
          static_cast<int>(std::min<engine::bigint>(every_, limit_ - (update->ntimestep - first)));
      update->integrate->run(piece);
      unrest = measure();
      settled = is_rest(unrest);
      if (StopSignal::received(lmp))
        engine::stop(lmp, fmt::format("drumlin/settle: stopped by a signal after {} steps, unbalanced ratio "
                                      "{:.3g}; allowed: to run until it has settled",
                                      update->ntimestep - first, unrest.ratio));
      const engine::bigint done = update->ntimestep - first;
      if (done / every_ % pieces_per_line == 0)
        engine::log_message(
            lmp, fmt::format("drumlin/settle: unbalanced ratio {:.3g} after {} steps, limit {:.3g}{}\n",
                             unrest.ratio, done, ratio_,
                             loose_share_ > 0.0
                                 ? fmt::format(", {} of {} balls not at rest", unrest.moving, unrest.balls)
                                 : ""));
    }
    update->integrate->cleanup();
    update->whichflag = 0;
    update->firststep = update->laststep = 0;
    update->beginstep = update->endstep = 0;
    const engine::bigint steps = update->ntimestep - first;
    if (!settled)
      engine::stop(
          lmp,
          limit_ == 0
              ? fmt::format("drumlin/settle: unbalanced ratio is '{:.3g}', the scene is not in equilibrium; "
                            "allowed: at most {:.3g}",
                            unrest.ratio, ratio_)
              : fmt::format(
                    "drumlin/settle: unbalanced ratio is '{:.3g}' after {} steps, no equilibrium; allowed: "
                    "at most {:.3g} within {} steps (a scene without damping never comes to rest)",
                    unrest.ratio, steps, ratio_, limit_));
    engine::log_message(
        lmp, fmt::format("drumlin/settle: unbalanced ratio {:.3g} after {} steps{}\n", unrest.ratio, steps,
                         unrest.ratio <= ratio_
                             ? ""
                             : fmt::format(", {} of {} balls still not at rest, all others for {} steps",
                                           unrest.moving, unrest.balls, loose_steps_)));
  }

private:
  static constexpr engine::bigint pieces_per_line = 10;

  struct Unrest {
    double ratio;
    long long moving, falling,
        balls; // those above the limit of the ratio, those of them that fall, and all that are considered
  };

  /// Whether a scene is at rest, or has been for loose_steps_ steps but for a few loose balls.
  bool is_rest(const Unrest &unrest) {
    if (unrest.ratio <= ratio_) return true;
    if (unrest.falling > 0 ||
        static_cast<double>(unrest.moving) > loose_share_ * static_cast<double>(unrest.balls))
      disturbed_ = update->ntimestep;
    return loose_share_ > 0.0 && std::isfinite(unrest.ratio) &&
           update->ntimestep - disturbed_ >= loose_steps_;
  }

  /// The force that a ball at rest would not have: its net force, or the force that would stop it within one
  /// piece. A ball that moves through its equilibrium has no net force but is not at rest.
  double unbalanced_force(int i) const {
    const double *f = atom->f[i];
    const double *v = atom->v[i];
    const double net = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    const double speed = is_moving(i) ? std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) : 0.0;
    const double stopping = atom->rmass[i] * speed / (every_ * update->dt);
    return std::isfinite(net + stopping) ? std::max(net, stopping) : std::numeric_limits<double>::infinity();
  }

  /// The ratio is that of the largest unbalanced force to the given force, or to the mean weight of a ball.
  /// With neither force nor gravity it is 1, or 0 if there are neither forces nor motion. Collective.
  Unrest measure() const {
    const std::array<double, 3> g = engine::gravity(modify);
    const double gravity = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    double worst = 0.0;
    std::array<double, 2> mine{};
    const auto considered = [&](int i) { return (atom->mask[i] & fixed_groupbit_) == 0; };
    for (int i = 0; i < atom->nlocal; ++i) {
      if (!considered(i)) continue;
      worst = std::max(worst, unbalanced_force(i));
      mine[0] += atom->rmass[i] * gravity;
      mine[1] += 1.0;
    }
    double largest = 0.0;
    std::array<double, 2> all{};
    MPI_Allreduce(&worst, &largest, 1, MPI_DOUBLE, MPI_MAX, world);
    MPI_Allreduce(mine.data(), all.data(), 2, MPI_DOUBLE, MPI_SUM, world);
    const double weight = all[1] > 0.0 ? all[0] / all[1] : 0.0;
    const double scale = force_ > 0.0 ? force_ : weight;
    Unrest unrest{largest == 0.0 ? 0.0
                  : scale > 0.0  ? largest / scale
                                 : 1.0,
                  0, 0, static_cast<long long>(all[1])};
    if (loose_share_ == 0.0) return unrest;
    std::array<long long, 2> my_moving{}, all_moving{};
    for (int i = 0; i < atom->nlocal; ++i)
      if (considered(i) && unbalanced_force(i) > ratio_ * scale) {
        ++my_moving[0];
        my_moving[1] += is_falling(i, g) ? 1 : 0;
      }
    MPI_Allreduce(my_moving.data(), all_moving.data(), 2, MPI_LONG_LONG, MPI_SUM, world);
    unrest.moving = all_moving[0];
    unrest.falling = all_moving[1];
    return unrest;
  }

  /// Whether a ball moves downwards, within six degrees: it falls towards the others, and does not roll on
  /// them.
  bool is_falling(int i, const std::array<double, 3> &g) const {
    constexpr double cosine = 0.995;
    double down = 0.0, v2 = 0.0, g2 = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      down += atom->v[i][a] * g[a];
      v2 += atom->v[i][a] * atom->v[i][a];
      g2 += g[a] * g[a];
    }
    return down > cosine * std::sqrt(v2 * g2);
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
  double loose_share_ =
      0.0; // of the balls, which need not be at rest if all others have been for loose_steps_
  engine::bigint loose_steps_ = 0;
  engine::bigint disturbed_ = 0; // the last step at which more balls than this share were not at rest
};

} // namespace

void settle_command(LAMMPS *lmp, int narg, char **arg) { Settle(lmp, narg, arg).run(); }

} // namespace drumlin
