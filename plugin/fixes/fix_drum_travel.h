#pragma once
// fix drum/travel: a roller that drives. See plugin/doc/fix_drum_travel.md.

#include "contact/deck_check.h"
#include "engine.h"
#include "physics/bodies/travel.h"
#include "support/clock.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace drumlin {
class Arguments;
}

namespace LAMMPS_NS {

/// Prescribes the motion of a group along an axis of the box, and the rotation of its drum. It replaces
/// positions and velocities after the engine's fixes have integrated them, and computes force, torque and
/// work of what drives the roller from the forces that it overrules.
class FixDrumTravel : public Fix {
public:
  FixDrumTravel(LAMMPS *, int, char **);

  int setmask() override;
  void init() override;
  void setup_pre_exchange() override;
  void setup(int) override;
  void initial_integrate(int) override;
  void final_integrate() override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  /// Duration of the programme, s.
  double compute_scalar() override;
  /// 0: pass; 1: place, m; 2: its rate, m/s; 3: traction, N; 4: torque, N m; 5, 6: work of the two, J; 7:
  /// time since the first set-up, s; 8: angular velocity of the drum about its axle, rad/s.
  double compute_vector(int) override;
  /// "axis": the index (0, 1, 2) of the axis along which the motion of the group is prescribed.
  void *extract(const char *name, int &dimensions) override;

  const drumlin::physics::Travel &travel() const { return travel_; }
  /// The roller at the end of the present step.
  const drumlin::physics::TravelState &state() const { return now_; }
  /// Share of the full vibration that acts now, 0 to 1: the present speed over that of the passes.
  double vibration() const { return std::fabs(now_.velocity) / travel_.speed; }
  /// Adds work, J, of this step that soil takes from the roller without a force on its balls.
  void add_work(double work);
  /// Way of this step, m, towards greater places.
  double way_of_step() const { return half_velocity_ * clock_.dt(); }
  /// Time, s, by which the present pass had begun at the end of this step.
  double time_in_pass() const;
  /// Work of traction and torque on the group, J.
  double work() const { return work_ + torque_work_; }
  /// Traction, N, and torque, N m, means of the last step, and their works since the first set-up, J.
  std::array<double, 4> drive() const { return {traction_, torque_, work_, torque_work_}; }
  /// Kinetic energy of rotation, J, that the engine does not see: that of the given moment of inertia less
  /// that of the balls.
  double further_kinetic() const;

  /// Whether the drum rolls and is the clump with this group.
  bool rolls_clump(int its_group) const { return rotation_ != Rotation::none && drum_group_ == its_group; }
  /// Whether it has been set up: from then on the balls of a clump that rolls have different velocities.
  bool begun() const { return spacing_ != 0.0; }
  /// Torque, N m, about the axle of a force, N, on an owned ball of the drum.
  double torque_about_axle(int i, const double *pull) const;
  /// Direction of the axle about which the drum rolls when it drives towards greater places.
  const std::array<double, 3> &axle() const { return axle_; }

private:
  enum class Rotation { none, driven, towed };
  /// Sums over the balls of the group, of all ranks.
  struct Sums {
    double force = 0.0;  // N, along the axis
    double torque = 0.0; // N m, on the drum about its axle
    double mass = 0.0;   // kg
    double rise = 0.0;   // m/s, upwards, of a clump that rolls
  };
  /// A ball of a clump that rolls, and its place relative to the axle at the angle 0, m.
  struct BodyBall {
    double tag;
    drumlin::physics::InPlane place;
  };

  void parse(int narg, char **arg);
  void refuse_order();
  void find_axle();
  void find_drum();
  void begin();
  void begin_clump();
  void check_clump() const;
  void find_inertia();
  const drumlin::physics::InPlane &place_in_body(int i) const;
  drumlin::physics::InPlane in_plane(const double *vector) const;
  void set_in_plane(double *vector, const drumlin::physics::InPlane &parts) const;
  void move_clump();
  void end_clump();
  /// Calls `act` with the index of each owned ball of a clump that rolls, and its place in the body.
  template <class Act>
  void for_each_of_clump(const Act &act) const;
  void refuse_torn(double reach) const;
  std::pair<double, double> way_of_centre() const;
  void refuse_leaving(double least, double most) const;
  Sums sums(bool opening) const;
  void rotate(double spin);
  void note_places();
  double on_grid(double place) const;
  double spin_change(double torque) const;

  drumlin::physics::Travel travel_;
  int axis_ = 0;
  Rotation rotation_ = Rotation::none;
  std::optional<double> radius_, inertia_; // as given, m, kg m2
  std::optional<std::array<double, 3>> up_;
  int drum_group_ = -1, drum_bit_ = 0;
  bool clump_ = false; // whether the drum is a clump and rolls

  class FixStepping *stepping_ = nullptr; // nullptr under stock stepping
  drumlin::Clock clock_;
  drumlin::physics::TravelState before_, now_; // at the start and the end of the step
  std::vector<std::pair<int, double>> places_; // of this rank's balls at the end of the last step: ID, m
  std::array<double, 3> upwards_{};            // the direction up, at right angles to the way
  std::array<double, 3> axle_{}; // about which the drum rolls when it drives towards greater places
  double rolling_radius_ = 0.0;  // m
  double drum_inertia_ = 0.0;    // kg m2
  double ball_inertia_ = 0.0;    // kg m2, with which the engine counts its energy
  std::vector<BodyBall> body_;   // all balls of a clump that rolls, on every rank, sorted by tag
  double start_ = 0.0;           // m, place of its axle along the axis at the first set-up
  double height_ = 0.0;          // m, of its axle
  double rise_ = 0.0;            // m/s, the rate of the height
  double angle_ = 0.0;           // rad, by which it has turned since the first set-up
  double spacing_ =
      0.0; // m, distance of the places that balls can have along the axis; 0 before the first set-up
  double moved_ = 0.0;         // m, way along the axis since the first set-up, a multiple of spacing_
  double spin_ = 0.0;          // rad/s, about the axle
  double half_velocity_ = 0.0; // m/s, the mean of the present step
  double half_spin_ = 0.0;     // rad/s, the same
  Sums opening_;               // of the opening half kick of the step
  double traction_ = 0.0, torque_ = 0.0;  // N, N m, means of the last step
  double work_ = 0.0, torque_work_ = 0.0; // J
  drumlin::DeckCheck deck_check_;
  bool echoed_ = false;
};

} // namespace LAMMPS_NS
