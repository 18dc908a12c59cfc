#pragma once
// fix contact/way: soil that changes along the way of a roller. See plugin/doc/fix_contact_way.md.

#include "contact/contact_observer.h"
#include "contact/contact_settings.h"
#include "engine.h"
#include "physics/files/way.h"

namespace drumlin {
class ContactSource;
}

namespace LAMMPS_NS {

class FixDrumTravel;

/// Gives the contacts of two groups, of one type of balls each, the stiffness and the damping ratio of the
/// roller's place in every step, and counts the work that it takes to drive over soil that changes.
class FixContactWay : public Fix, public drumlin::ContactObserver {
public:
  FixContactWay(LAMMPS *, int, char **);

  int setmask() override;
  void init() override;
  void setup_pre_force(int) override;
  void setup(int) override;
  void post_integrate() override;
  void pre_force(int) override;
  void end_of_step() override;
  void post_run() override;
  void see_contact(const drumlin::ContactRecord &record) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  /// 0: stiffness, N/m; 1: damping ratio; 2: work of the soil's changes, J.
  double compute_vector(int) override;

private:
  using Coefficients = drumlin::ContactCoefficients<drumlin::physics::LinearContact>;
  /// The soil at a place.
  struct Soil {
    double k = 0.0, D = 0.0;
  };
  /// What the soil's steps within a time step amount to.
  struct Jump {
    double k = 0.0, D = 0.0; // changes
    double share = 0.0;      // part of the time step behind it
    bool any = false;
  };

  void read(const std::string &file);
  [[noreturn]] void refuse(const std::string &fault) const;
  int type_of(int group_number) const;
  Soil soil_at(double place, bool forth) const;
  bool drives_forth() const;
  Jump jump_since(double place_before, int pass_before, const Soil &before) const;
  void give(const Soil &soil, const Jump &jump);
  double sum_of_squares() const;

  std::string file_, travel_id_;
  std::array<int, 2> groups_{}, bits_{}, types_{};
  drumlin::Way way_;
  FixDrumTravel *travel_ = nullptr;
  drumlin::ContactSource *source_ = nullptr;
  Coefficients of_deck_; // which the contacts have between runs
  bool given_ = false;   // whether they have others now
  Soil now_;
  double place_ = 0.0; // m, at the end of the last step
  int pass_ = 1;
  Jump jump_;            // of the present step
  Soil before_;          // at its beginning
  double seen_ = 0.0;    // m2, sum of d^2 over this rank's contacts in this step
  double squares_ = 0.0; // m2, over all at the end of the last step
  double work_ = 0.0;    // J
};

} // namespace LAMMPS_NS
