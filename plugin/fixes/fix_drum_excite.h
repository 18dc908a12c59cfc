#pragma once
// fix drum/excite: the excitation force of the vibratory drum. See plugin/doc/fix_drum_excite.md.

#include "contact/deck_check.h"
#include "engine.h"
#include "physics/bodies/excitation.h"
#include "support/clock.h"

#include <optional>
#include <string>

namespace drumlin {
class Arguments;
}

namespace LAMMPS_NS {

/// Adds the excitation force Fe(t) to a group, distributed over its balls in proportion to their masses. Fe
/// is positive along `direction`, by default that of gravity; t is the time of the positions of the same
/// step.
class FixDrumExcite : public Fix {
public:
  FixDrumExcite(LAMMPS *, int, char **);

  int setmask() override;
  void init() override;
  void setup(int) override;
  void post_integrate() override;
  void post_force(int) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  /// Fe along the direction, N.
  double compute_scalar() override;
  /// 0-2: force components, N; 3: phase, rad; 4: angular frequency, rad/s; 5: time on the fix's clock, s.
  double compute_vector(int) override;

  /// Where the force acts on a body that tilts: distance from its centre of mass along the axle, m.
  double place() const { return place_; }

private:
  using Vector = std::array<double, 3>;
  void parse(int narg, char **arg);
  void parse_excitation(drumlin::Arguments &in, const std::string &keyword);
  double now() const;
  double vibration() const;
  Vector force_now() const;
  void find_body();
  template <class Add>
  void share(const Vector &whole, const Add &add) const;

  drumlin::physics::Excitation excitation_;
  std::optional<Vector> given_direction_;
  std::optional<Vector> axis_; // of rotation
  Vector direction_{};
  Vector normal_{};       // axis x direction: direction of the second component of a rotating force
  std::string travel_id_; // empty: the roller does not drive
  const class FixDrumTravel *travel_ = nullptr; // since the initialization of the run
  double place_ = 0.0;
  const class FixClump *body_ = nullptr;  // on which the force exerts a moment; nullptr: it exerts none
  class FixStepping *stepping_ = nullptr; // nullptr under stock stepping
  Vector acted_{};                        // force of the last step
  drumlin::Clock clock_;
  double mass_ = 0.0; // of the group
  drumlin::DeckCheck deck_check_;
  bool echoed_ = false;
};

} // namespace LAMMPS_NS
