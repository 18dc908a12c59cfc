#pragma once
// fix roller/history: motion and forces of drum and frame, at one instant. See
// plugin/doc/fix_roller_history.md.

#include "engine.h"
#include "fixes/bed_state.h"
#include "support/clock.h"
#include "contact/contact_source.h"
#include "support/output_file.h"
#include "contact/pair_motion.h"

#include <optional>

namespace LAMMPS_NS {

class FixDrumExcite;
class FixBondSpring;

/// Writes chain.csv or bed.csv (samples) and cycles.csv (extremes, harmonics and energies over every step).
/// The forces and accelerations in a row are the right-hand sides of Eq. (1) at the positions and velocities
/// of that row.
class FixRollerHistory : public drumlin::engine::GhostFix, public drumlin::ContactObserver {
public:
  FixRollerHistory(LAMMPS *, int, char **);

  int setmask() override;
  void init() override;
  void setup_pre_force(int) override;
  void setup(int) override;
  void pre_neighbor() override;
  void pre_force(int) override;
  void end_of_step() override;
  void see_contact(const drumlin::ContactRecord &record) override { bed_->add(record); }
  void post_run() override;
  void pack_ghosts(int, const int *, double *) override;
  void unpack_ghosts(int, int, double *) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  /// 0-9: the columns of chain.csv at the last evaluated step.
  double compute_vector(int) override;

private:
  struct Body {
    int groupbit = 0;
    double mass = 0.0;
    double origin = 0.0; // engine coordinate along the axis where x = 0
    bool has_origin = false;
    double x = 0.0, v = 0.0, a = 0.0;
  };
  struct Candidate { // a pair of the list: a ball of the drum, and one that is neither drum nor frame
    int i, j;
    double sign; // 1: ball i is the drum's; -1: ball j
    drumlin::physics::LinearLaw law;
    drumlin::physics::Friction friction;
    const double *spring; // of the tangential model; nullptr if it has none
  };
  struct Forces {
    double contact = 0.0, excitation = 0.0, bond = 0.0;
    double contact_dissipated = 0.0, contact_stored = 0.0; // W, J
    double bond_dissipated = 0.0, bond_stored = 0.0;       // W, J
    double excitation_power = 0.0;                         // W
    double tangential_power = 0.0;                         // W, of a bed
    bool in_contact = false;
  };
  /// Accumulated over the steps of a cycle, or since the start (energies).
  struct Cycle {
    double number = 0.0, steps = 0.0;
    double a_min = 0.0, a_max = 0.0, F_min = 0.0, F_max = 0.0, contact_steps = 0.0;
    std::array<double, 6> harmonic{}; // a1 cos, sin; a2 cos, sin; a(1/2) cos, sin
    double work = 0.0, contact_dissipated = 0.0, bond_dissipated = 0.0;
    double tangential_work = 0.0; // J, into friction and rolling
    double sinking = 0.0;         // sum of -x_drum over the steps
    double settlement = 0.0;      // m, mean of -x_drum over the last whole cycle
  };
  /// What a bed is measured against, from the first set-up on.
  struct Reference {
    double height = 0.0;            // kg m, BallSums::height
    double tangential_stored = 0.0; // J
    double window_top = 0.0;        // m, along the axis
  };

  void parse(int narg, char **arg);
  void rebuild();
  void evaluate();
  void locate(Body &body, const char *name, double stretch = 0.0);
  void evaluate_bed();
  drumlin::BallSums ball_sums() const { return bed_->balls(axis_, reference_.window_top); }
  double tangential_heat() const {
    return cycle_.tangential_work - (sums_.tangential_stored - reference_.tangential_stored);
  }
  void write_sample();
  void flush();
  void start_cycle();
  void count_step(const Forces &before, double v_before);
  void write_cycle();
  double along(const double *vector) const;
  double time() const { return clock_.time(update->ntimestep); }

  std::string file_name_, cycles_name_, excite_id_, bond_id_, frame_group_;
  bool append_ = false;
  int every_ = 0;           // steps between rows
  int steps_per_cycle_ = 0; // 0: no cycles file
  std::array<double, 3> axis_{};
  bool has_axis_ = false;

  std::optional<drumlin::OutputFile> file_, cycles_file_;
  const drumlin::ContactSource *source_ = nullptr;
  FixDrumExcite *excite_ = nullptr;
  FixBondSpring *bond_ = nullptr;
  drumlin::Clock clock_;
  Body drum_, frame_;
  double gravity_ = 0.0; // m/s2, downwards along the axis
  Forces forces_;
  Cycle cycle_;
  int soil_groupbit_ = 0; // 0: no bed
  std::optional<drumlin::BedState> bed_;
  drumlin::ContactSums sums_; // of the last evaluated step
  Reference reference_;
  std::vector<Candidate> candidates_;
  bool stale_ = true;
  bigint last_sample_ = -1;
};

} // namespace LAMMPS_NS
