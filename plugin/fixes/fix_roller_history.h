#pragma once
// fix roller/history: motion and forces of drum and frame in time, and sums over each cycle. See
// plugin/doc/fix_roller_history.md.

#include "engine.h"
#include "contact/contact_source.h"
#include "fixes/bed_sums.h"
#include "fixes/cycle_sums.h"
#include "fixes/drum_contacts.h"
#include "fixes/roller_body.h"
#include "fixes/roller_state.h"
#include "fixes/roller_tables.h"
#include "support/clock.h"
#include "support/output_file.h"

#include <optional>
#include <vector>

namespace LAMMPS_NS {

class FixDrumExcite;
class FixDrumTravel;
class FixBondSpring;
class FixBoundaryAbsorb;
class FixClump;

/// Writes samples (chain.csv or bed.csv) and, for each cycle, extremes, harmonics and energies over every
/// step (cycles.csv). Forces and accelerations in a row are the right-hand sides of Eq. (1) at the positions
/// and velocities of that row.
class FixRollerHistory : public drumlin::engine::GhostFix, public drumlin::ContactObserver {
public:
  FixRollerHistory(LAMMPS *, int, char **);

  int setmask() override;
  void init() override;
  void setup_pre_force(int) override;
  void setup(int) override;
  void post_integrate() override;
  void pre_neighbor() override;
  void pre_force(int) override;
  void end_of_step() override;
  void see_contact(const drumlin::ContactRecord &record) override { bed_->add(record); }
  bool takes_heat() const override { return true; }
  void see_heat(int i, int j, double normal, double tangential) override;
  void post_run() override;
  void pack_ghosts(int, const int *, double *) override;
  void unpack_ghosts(int, int, double *) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  /// 0-9: the columns of chain.csv at the last step at which they were computed.
  double compute_vector(int) override;

private:
  /// Values of a bed before the first step of the first run, relative to which its changes are given. All
  /// members are of type double, and a restart file stores them.
  struct Reference {
    double height = 0.0;            // kg m, BallSums::height
    double tangential_stored = 0.0; // J
    double window_top = 0.0;        // m, along the axis
  };

  void parse(int narg, char **arg);
  void refuse_other_step() const;
  void find_partners();
  void find_bodies();
  void follow_tilt();
  void open_files();
  void set_reference();
  void evaluate();
  void add_forces_of_partners(double moment);
  void add_ground();
  std::optional<drumlin::BedSample> bed_sample() const;
  drumlin::RollerMasses masses() const {
    return {drum_.mass, frame_.mass, gravity_, drum_inertia_, frame_inertia_};
  }
  void write_sample();
  void write_cycle();
  void flush();
  bool yields() const;
  double along(const double *vector) const;

  std::string file_name_, cycles_name_, travel_id_, frame_group_;
  std::vector<std::string> bond_ids_, excite_ids_;
  std::optional<bool> append_; ///< none: as drumlin/read has found
  int every_ = 0;              // steps between rows
  int steps_per_cycle_ = 0;    // 0: no cycles file
  std::array<double, 3> axis_{};
  bool has_axis_ = false;

  std::optional<drumlin::OutputFile> file_, cycles_file_;
  const drumlin::ContactSource *source_ = nullptr;
  std::vector<FixDrumExcite *> excites_;
  FixDrumTravel *travel_ = nullptr;
  std::vector<FixBondSpring *> bonds_;
  std::optional<double> sensor_; // m, distance of a_left and a_right from the middle; none: nothing tilts
  const FixClump *drum_body_ = nullptr, *frame_body_ = nullptr; // that tilt
  double drum_inertia_ = 0.0, frame_inertia_ = 0.0;             // kg m2
  double centre_ = 0.0;                                         // of the drum along its axle, m
  std::vector<const FixBoundaryAbsorb *> ground_;               // absorbing boundaries of the bed
  drumlin::Clock clock_;
  drumlin::RollerBody drum_, frame_;
  double gravity_ = 0.0; // m/s2, downwards along the axis
  drumlin::DrumContacts contacts_;
  bool pairs_outdated_ = true; // the neighbour list was built again after contacts_ had read it
  drumlin::RollerState state_; // of the last evaluated step
  drumlin::CycleSums cycle_;
  double yield_heat_ = 0.0; // J, of the springs of a bed since the start
  int soil_groupbit_ = 0;   // 0: no bed
  std::optional<drumlin::BedSums> bed_;
  drumlin::ContactSums bed_contacts_; // of the last evaluated step
  Reference reference_;
  bigint last_sample_ = -1; // step of the last row
};

} // namespace LAMMPS_NS
