#pragma once
// The helper fix that leads from one run to the next, also through restart files: it knows each ball whatever
// its ID, keeps contact history where an engine would lose it, and lets `stepping second` continue exactly.

#include "engine.h"

#include <array>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Added by the pair styles and by fixes that hold balls by their IDs.
///
/// **IDs.** It notes each ball's ID, so that the next run notices if balls have been renumbered
/// (delete_atoms).
///
/// **Contact history of LIGGGHTS.** The engine copies it from the neighbour list to the balls only when it
/// builds that list: too early for a restart file written within a run, which then lacks the last step, and
/// too late at the end of a run: balls created before the next (create_atoms) have taken the indices of
/// ghosts by then. Here it is copied at both times, as LAMMPS does.
///
/// **Velocities.** In a step forces are computed with velocities of its middle, which the set-up of a run
/// does not have: a dashpot would act with another velocity, and friction would slip otherwise. Under
/// `stepping second` they are noted in the last step of a run, and where a restart file is written, with the
/// forces at its end. In the set-up the forces of the plugin's contacts and bonds are computed with them, as
/// long as a ball, the contact law and the time step are as they were.
class FixBetweenRuns : public drumlin::engine::GhostFix {
public:
  FixBetweenRuns(LAMMPS *, int, char **);
  ~FixBetweenRuns() override;

  /// The fix of this engine instance; nullptr if there is none.
  static FixBetweenRuns *find(LAMMPS *lmp);
  /// The fix of this engine instance, which is added if there is none.
  static FixBetweenRuns *provide(LAMMPS *lmp);
  static constexpr const char *style_name = "drumlin/between_runs";

  int setmask() override;
  void init() override;
  void setup_pre_force(int) override;
  void pre_force(int) override;
  void post_run() override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  void grow_arrays(int) override;
  void copy_arrays(int, int, int) override;
  void set_arrays(int) override;
  int pack_exchange(int, double *) override;
  int unpack_exchange(int, double *) override;
  int pack_restart(int, double *) override;
  void unpack_restart(int, int) override;
  int maxsize_restart() override { return 1 + numbers; }
  int size_restart(int) override;
  void pack_ghosts(int, const int *, double *) override;
  void unpack_ghosts(int, int, double *) override;
  double memory_usage() override { return static_cast<double>(balls_.capacity() * sizeof(Ball)); }

  /// How often balls were found to have got other IDs. Collective.
  int numbering();
  /// For a pair style, in its initialization: ends the run if contacts have a history, which the engines keep
  /// by IDs, and balls have got other IDs since the last run. Collective.
  void check_contacts(const std::string &command, bool have_history);
  /// In a set-up: whether the state of any ball, or of ball i (owned or ghost), is that of the end of the
  /// step before, so that its contacts continue.
  bool any_continues() const { return any_continues_; }
  bool continues(int i) const { return any_continues_ && ball(i).continues != 0.0; }
  /// In a set-up: counts a force, N, on ball i, for the rounding error of their sum.
  void load(int i, double newton) { ball(i).load += std::fabs(newton); }
  /// Before the first step: gives owned balls the forces of the step before where those of the set-up differ
  /// by rounding errors only. \param shift called with (i, force) for the forces that act in the next drift
  /// only: see FixStepping
  template <class Shift>
  void restore_forces(const Shift &shift) {
    for (int i = 0; any_continues_ && i < atom->nlocal; ++i) {
      const Ball &of = ball(i);
      if (of.continues == 0.0) continue;
      take_if_near(of.force, atom->f[i], of.load);
      take_if_near(of.torque, atom->torque[i], of.load * atom->radius[i]);
      if (of.shift != Vector{}) shift(i, of.shift);
    }
    any_continues_ = false;
  }

private:
  friend class VelocitiesOfStep;
  using Vector = std::array<double, 3>;
  /// All members are doubles, since the struct is sent and stored as an array of doubles.
  struct Ball {
    double id = 0.0;    // when the fix looked last; 0: not yet
    double state = 0.0; // number of the state at the end of the step whose values follow; 0: there are none
    Vector velocity{}, spin{};          // m/s and rad/s, of the middle of the step
    Vector force{}, torque{}, shift{};  // N and N m, from the end of the step
    double continues = 0.0, load = 0.0; // of a set-up
  };
  static constexpr int numbers = sizeof(Ball) / sizeof(double);

  Ball &ball(int i) { return balls_[static_cast<std::size_t>(i)]; }
  const Ball &ball(int i) const { return balls_[static_cast<std::size_t>(i)]; }
  static void take_if_near(const Vector &before, double *now, double scale);
  double state_of(int i) const;
  double law_in_force() const;
  void note_end();
  void refuse_two_contacts() const;

  std::vector<Ball> balls_;
  bool any_continues_ = false;
  double law_ = 0.0;      // number of the contact law and the time step in this run
  double kept_law_ = 0.0; // the same when the values of balls were noted
  bigint noted_ = -1;     // the step in whose middle velocities were noted
  int numbering_ = 0;
  int numbering_of_contacts_ = 0; // at the last initialization of a pair style
  bool has_run_ = false;
};

/// While it lives in the set-up of a run, balls that continue have the velocities with which the forces of
/// the step before were computed. It does nothing in a step.
class VelocitiesOfStep {
public:
  explicit VelocitiesOfStep(LAMMPS *lmp) : VelocitiesOfStep(lmp, 0, lmp->atom->nlocal + lmp->atom->nghost) {}
  /// The same for ball i alone.
  VelocitiesOfStep(LAMMPS *lmp, int i) : VelocitiesOfStep(lmp, i, i + 1) {}
  ~VelocitiesOfStep() { exchange(); }
  VelocitiesOfStep(const VelocitiesOfStep &) = delete;
  VelocitiesOfStep &operator=(const VelocitiesOfStep &) = delete;

private:
  VelocitiesOfStep(LAMMPS *lmp, int first, int end);
  void exchange();

  FixBetweenRuns *fix_;
  Atom *atom_;
  int first_, end_;
};

} // namespace LAMMPS_NS
