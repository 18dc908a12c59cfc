#pragma once
// fix wall/gran/transition: see plugin/doc/fix_wall_gran_transition.md.

#include "engine.h"
#include "support/arguments.h"
#include "contact/contact_history.h"
#include "contact/contact_settings.h"

namespace LAMMPS_NS {

class FixStepping;
class PairGranTransition;
class Region;

/// A pair of planes at rest across an axis of the box, or the surface of a region at rest, with the law of
/// the pair style between balls and a type.
class FixWallGranTransition : public Fix {
public:
  FixWallGranTransition(LAMMPS *, int, char **);
  ~FixWallGranTransition() override;

  int setmask() override;
  void init() override;
  void setup(int) override;
  void post_force(int) override;
  /// 0-2: force of the walls on the balls, N: the mean of what acts in the half kicks that end and begin at
  /// this time, so that its sum over the steps is the momentum that the walls have given.
  double compute_vector(int) override;

  void grow_arrays(int) override;
  void copy_arrays(int, int, int) override;
  void set_arrays(int) override;
  int pack_exchange(int, double *) override;
  int unpack_exchange(int, double *) override;
  int pack_restart(int, double *) override;
  void unpack_restart(int, int) override;
  int maxsize_restart() override { return 1 + numbers(); }
  int size_restart(int) override { return 1 + numbers(); }
  double memory_usage() override;

  /// Type, 1 to ntypes, of the pair_coeff lines that hold for the wall.
  int wall_type() const { return type_; }
  /// Largest number of contacts that a ball may have with the wall at once.
  int sides() const { return region_id_.empty() ? (has_[0] ? 1 : 0) + (has_[1] ? 1 : 0) : places_; }

private:
  static constexpr int of_a_side = 10; // whether it touches, then what a contact can remember, at most
  int numbers() const { return places_ * of_a_side; }
  double *row(int i, int place) { return memory_[i] + static_cast<std::ptrdiff_t>(place) * of_a_side; }
  void check_coefficients() const;
  void read_planes(drumlin::Arguments &, int axis);
  void read_region(drumlin::Arguments &);
  /// A face of the wall at a ball.
  struct Face {
    int place;                               // of its contact history
    drumlin::physics::Vec3 normal;           // from the wall to the ball,
    drumlin::physics::Vec3 normal_in_middle; // and where the ball was in the middle of the step
    double distance;                         // of its centre, m
  };
  template <bool stepped, drumlin::FrictionModel tangential, bool rolling, class Parameters>
  void touch_balls(const drumlin::CoefficientTable<Parameters> &);
  void find_planes(int i);
  void find_faces(int i, bool rolls);
  template <class Forces>
  void touch(Forces &, int i, const Face &);

  int places_ = 2;        // number of faces; each has a row of contact history of its own
  std::string region_id_; // empty: planes
  Region *region_ = nullptr;
  std::vector<bool> near_;  // whether one ball is near each face of the region
  std::vector<Face> faces_; // of one ball
  int axis_ = 0;
  int type_ = 1;
  std::array<bool, 2> has_{};     // low side, high side
  std::array<double, 2> place_{}; // m
  double **memory_ = nullptr;     // of each ball, for each side
  std::array<double, 3> force_{}; // N, of this rank
  const PairGranTransition *pair_ = nullptr;
  drumlin::HistoryPlaces
      places_of_side_; // behind the first number; a spring has its place whether there is one or not
  FixStepping *stepping_ = nullptr;
};

} // namespace LAMMPS_NS
