#pragma once
// fix contact/energy: energies of balls and contacts, and the heat of the contacts. See
// plugin/doc/fix_contact_energy.md.

#include "engine.h"
#include "fixes/bed_sums.h"

#include <optional>

namespace LAMMPS_NS {

/// Sums of energy over all balls and contacts in every step, and the heat of the contacts since the first
/// set-up.
class FixContactEnergy : public drumlin::engine::GhostFix, public drumlin::ContactObserver {
public:
  FixContactEnergy(LAMMPS *, int, char **);

  int setmask() override;
  void init() override;
  void setup_pre_force(int) override;
  void setup(int) override;
  void pre_force(int) override;
  void end_of_step() override;
  void see_contact(const drumlin::ContactRecord &record) override { sums_.add(record); }
  bool takes_heat() const override { return true; }
  void see_heat(int i, int j, double normal, double tangential) override {
    sums_.add_heat(i, j, normal, tangential);
  }
  void pack_ghosts(int, const int *, double *) override;
  void unpack_ghosts(int, int, double *) override;
  /// 0: kinetic energy, J; 1, 2: energy of the normal and of the tangential springs, J; 3, 4: heat of the
  /// normal dashpots, and of friction and rolling, J; 5: mean number of contacts of a ball of the group; 6:
  /// heat of contacts that yield, J.
  double compute_vector(int) override;

private:
  void evaluate();

  drumlin::BedSums sums_;
  drumlin::ContactSums now_;       // of the last evaluated step
  drumlin::BallSums balls_;        // of the last evaluated step
  double dt_ = 0.0;                // s, of the present step: at its end another fix may set that of the next
  double normal_heat_ = 0.0;       // J, since the first set-up
  double yield_heat_ = 0.0;        // J, since then
  double tangential_work_ = 0.0;   // J, taken from the balls by friction and rolling since then
  std::optional<double> spring_0_; // J, in the tangential springs at the first set-up
};

} // namespace LAMMPS_NS
