// Fields of a bed of balls: averages over its balls and contacts in the cells of a grid (coarse graining).
//
// A ball counts at its centre, a contact at the middle of its overlap. Each is distributed over the cells
// whose centres surround this point p, with the weights
//   w_c(p) = prod_a max(0, 1 - |p_a - x_c,a| / h_a),    h the sides of a cell, x_c the centre of cell c,
// and the weight of a cell beyond the edge is given to the last cell inside. The weights of a point in the
// grid add up to 1, so that a sum over the cells is the sum over the balls or contacts. With V = prod_a h_a,
// over soil balls b (volume V_b, mass m_b) and contacts k of two soil balls (force f and branch l from centre
// to centre, normal n = l/|l|):
//   solid fraction       phi   = 1/V sum_b w V_b
//   bulk density         rho   = 1/V sum_b w m_b
//   velocity             v     = sum_b w m_b v_b / sum_b w m_b
//   coordination         Z     = sum_b w z_b / sum_b w,      z_b the number of contacts of b with soil balls
//   contact stress       sigma = 1/V sum_k w f l,            sigma_ij of f_i l_j; compression is positive
//   fabric               F     = sum_k w n n / sum_k w
// In two dimensions, the plane z = 0, all is taken per metre out of the plane: V_b = pi r^2 times 1 m. Drum
// and frame are not soil, and their contacts with the soil and those of the walls are not part of its stress,
// which is therefore too small in cells next to them. The stress is that of the grain skeleton (effective
// stress), without the momentum of the balls' motion about their mean.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace drumlin::post {

using Vector = std::array<double, 3>;
/// Components xx xy xz yx yy yz zx zy zz.
using Tensor = std::array<double, 9>;

/// Types of balls in the decks of inputs/bed.
enum BallType : int { soil_type = 1, drum_type = 2, frame_type = 3 };

/// The layer of soil that balls of a type belong to, counted from 1, the lowest; 0 for drum and frame. The
/// types of the layers are 1, 4, 5, ...
constexpr int layer_of(int type) { return type == soil_type ? 1 : type > frame_type ? type - 2 : 0; }
constexpr bool is_soil(int type) { return layer_of(type) > 0; }

struct Ball {
  long id = 0;
  int type = soil_type;
  double radius = 0.0; ///< m
  double mass = 0.0;   ///< kg
  Vector position{};   ///< m
  Vector velocity{};   ///< m/s
  Vector spin{};       ///< angular velocity, rad/s
  Vector force{};      ///< all forces on it, N
};

/// Whether all balls lie in z = 0.
bool in_a_plane(const std::vector<Ball> &balls);

/// Two balls that overlap.
struct BallContact {
  std::size_t i = 0, j = 0; ///< indices of the balls in their vector
  Vector branch{}; ///< to the centre of ball i from that of ball j, or of its image beyond a periodic side, m
  Vector force{};  ///< on ball i by ball j, N
  double overlap = 0.0; ///< m
};

/// A ball that overlaps with a wall.
struct WallContact {
  std::size_t i = 0;    ///< index of the ball in its vector
  Vector force{};       ///< on the ball, N
  Vector normal{};      ///< unit vector from the wall to the centre of the ball
  double overlap = 0.0; ///< m
};

/// Where the ball touches the wall, m.
Vector foot(const Ball &ball, const WallContact &contact);

/// All contacts at one instant.
struct BedContacts {
  std::vector<BallContact> balls;
  std::vector<WallContact> walls;
};

/// Contacts of each ball with other balls.
std::vector<int> coordination(std::size_t balls, const std::vector<BallContact> &contacts);

/// Mean pressure inside each ball, Pa, compression positive:
///   p = -1/(d V) sum_c f_c . r_c
/// summed over all contacts c of the ball, those with drum and walls included, where f_c (N) is the contact
/// force on the ball, r_c (m) the vector from its centre to the contact point (the middle of the overlap, or
/// the point on the wall), d the number of dimensions (2 or 3) and V (m3) the volume of the ball. The mean is
/// exact for a ball that does not spin. It is taken over the ball alone, without the pores around it, so that
/// it is larger than the pressure of the soil as a continuum (BedFields).
std::vector<double> ball_pressures(const std::vector<Ball> &balls, const BedContacts &contacts);

/// The force of a contact along its normal, positive in compression, and the magnitude of what remains, N.
struct ForceParts {
  double normal = 0.0, tangential = 0.0;
};
ForceParts force_parts(const BallContact &contact);
ForceParts force_parts(const WallContact &contact);

/// The smallest box around some balls, m.
struct Bounds {
  Vector low{inf, inf, inf};
  Vector high{-inf, -inf, -inf};
  void add(const Ball &ball);
  bool empty() const { return low[0] > high[0]; }

private:
  static constexpr double inf = std::numeric_limits<double>::infinity();
};

/// Cells of equal size. The first axis runs fastest.
struct FieldGrid {
  Vector origin{};                           ///< lowest corner, m
  Vector sides{1.0, 1.0, 1.0};               ///< of a cell, m; the third is the 1 m of two dimensions
  std::array<std::size_t, 3> cells{1, 1, 1}; ///< along each axis
  bool flat = false;                         ///< two dimensions

  std::size_t size() const { return cells[0] * cells[1] * cells[2]; }
  double cell_volume() const { return sides[0] * sides[1] * sides[2]; }
};

/// The most cells that fitted_grid() gives.
constexpr double largest_grid = 1e7;

/// A grid that just covers the bounds. Along each axis the side of its cells is as near to `side` as a whole
/// number of cells allows, so that no cell extends beyond the bounds. Throws std::invalid_argument if it
/// would have more than largest_grid cells.
FieldGrid fitted_grid(const Bounds &bounds, double side, bool flat);

/// One value per cell. Where there is no ball, velocity and coordination are 0, and fabric where there is no
/// contact.
struct BedFields {
  std::vector<double> solid_fraction;
  std::vector<double> bulk_density; ///< kg/m3
  std::vector<Vector> velocity;     ///< m/s
  std::vector<double> coordination;
  std::vector<Tensor> stress;   ///< Pa
  std::vector<double> pressure; ///< a half (two dimensions) or a third of the trace of the stress, Pa
  std::vector<Tensor> fabric;
};

/// The fields of the soil. A ball or contact whose point p is outside the grid does not count.
BedFields coarse_grained(const std::vector<Ball> &balls, const std::vector<BallContact> &contacts,
                         const FieldGrid &grid);

} // namespace drumlin::post
