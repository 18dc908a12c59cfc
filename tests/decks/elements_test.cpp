// Element tests of soil against closed forms: a table of runs, of which each gives numbers within bounds.
#include "tests/support/engine_runs.h"

namespace drumlin::test {
namespace {

constexpr double diameter = 0.04, density = 2650; // m, kg/m3, the decks'
constexpr double kn = 1e9, kt = 2.0 / 7.0 * kn;   // N/m, the decks' in two dimensions
constexpr int columns = 6, layers = 7;            // of the lattices of the biaxial test
const double root2 = std::sqrt(2.0), root3 = std::sqrt(3.0);
const double mass = pi * diameter * diameter / 4 * density; // kg, of a disc

// --- closed forms

/// A regular lattice. A uniform compression along y, with n the unit vector of a contact and d the diameter,
/// gives
///   modulus = sum over the contacts of a ball of d^2 n_y^2 (kn n_y^2 + kt (1 - n_y^2)) / (2 V),
/// V being the volume (area) per ball. No ball rotates, as each is at a centre of symmetry.
struct Lattice {
  const char *name;
  double kn, kt;             // N/m
  double normal, tangential; // 1/m (1 in two dimensions): modulus = normal kn + tangential kt
  double void_ratio;
  double volume; // m3 (m2), from centre to centre of the plates, of the deck's numbers of columns, rows and
                 // layers
};

const Lattice lattices[] = {
    {"hexagonal", 1e8, 3e7, 3 * root3 / 4, root3 / 4, 2 * root3 / pi - 1, 8 * diameter * 4 * root3 *diameter},
    {"square", 1e8, 3e7, 1, 0, 4 / pi - 1, 4 * diameter * 4 * diameter},
    {"cubic", 4e6, 1e6, 1 / diameter, 0, 6 / pi - 1, 4 * diameter * 4 * diameter * 4 * diameter},
    {"face_centred", 4e6, 1e6, root2 / diameter, root2 / diameter, 3 * root2 / pi - 1,
     8 / root2 *diameter * 32 * diameter *diameter}};

/// When a hexagonal lattice, rows across the load, has yielded, the balls of a row are apart, and all forces
/// are in contacts at 60 degrees, inclined by the angle of friction to their normals: the ratio of the
/// stresses is tan 60 tan(60 + phi).
double strength(double friction) { return root3 * std::tan(pi / 3 + std::atan(friction)); }

/// Modulus of the hexagonal lattice between the opening of the contacts within rows and yielding. Rows
/// approach by a, and neighbours in a row separate by 2 b, so that a contact at 60 degrees is compressed by
/// (root3 a - b)/2 and sheared by (a + root3 b)/2. The side force is constant: b = root3 a (kn - kt)/(kn + 3
/// kt). A ball at a plate has two such contacts above or below it and one with the plate.
double hexagonal_modulus() {
  const double a = 1.0, b = root3 * a * (kn - kt) / (kn + 3 * kt);
  const double axial_force = (kn * (3 * a - root3 * b) + kt * (a + root3 * b)) / 4; // of a contact
  const double height = (layers - 1) * root3 / 2 * diameter;
  const double settlement = (layers - 1) * a + 2 * 2 * axial_force / kn;
  return 2 * axial_force / diameter * height / settlement;
}

/// Columns of a square lattice, each with a contact less than layers, and those with the plates; heights and
/// widths are between centres.
double square_modulus() {
  const double force_per_width = columns / ((columns - 1) * diameter);
  return force_per_width * kn / (layers + 1) * (layers - 1) * diameter;
}

/// Stiffness of the contacts of the triaxial test, N/m, and layers of its lattices.
constexpr double kn3 = 4e7, kt3 = 2.0 / 7.0 * kn3;
constexpr int layers3 = 5;

/// The springs of a face-centred lattice between smooth plates, solved for small displacements: each ball has
/// contacts with its neighbours, of stiffness kn3 along and kt3 across the line of centres, and those at the
/// surface one of kn3 with the plate.
class FaceCentredSprings {
public:
  /// \param across layers of balls, half a cube apart, along x and z
  /// \param along the same along y
  FaceCentredSprings(int across, int along) : across_(across), along_(along) {
    for (int i = 0; i < across; ++i)
      for (int j = 0; j < along; ++j)
        for (int k = 0; k < across; ++k)
          if ((i + j + k) % 2 == 0) balls_.emplace(Place{i, j, k}, balls_.size());
    for (const auto &[place, ball] : balls_) {
      for (const Place &step : {Place{1, 1, 0}, {1, -1, 0}, {0, 1, 1}, {0, 1, -1}, {1, 0, 1}, {1, 0, -1}}) {
        const auto other = balls_.find({place[0] + step[0], place[1] + step[1], place[2] + step[2]});
        if (other == balls_.end()) continue;
        links_.push_back({ball, other->second, {}});
        for (std::size_t axis = 0; axis < 3; ++axis)
          links_.back().normal[axis] = step[axis] / std::sqrt(2.0);
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (place[axis] == 0) walls_.push_back({6 * ball + axis, none});
        if (place[axis] == (axis == 1 ? along : across) - 1) walls_.push_back({6 * ball + axis, plate(axis)});
      }
    }
  }

  /// Axial force, N, and outward displacement of a side platen, m, when the upper platen has settled by 1 m
  /// and the forces on the side platens have not changed.
  struct Response {
    double force, expansion;
  };
  /// By conjugate gradients.
  Response settle() const {
    std::vector<double> u(6 * balls_.size() + 3, 0.0);
    u[plate(1)] = -1.0;
    std::vector<double> residual = forces(u);
    for (double &value : residual)
      value = -value;
    residual[plate(1)] = 0.0;
    std::vector<double> direction = residual;
    double square = dot(residual, residual);
    for (const double end = 1e-20 * square; square > end;) {
      std::vector<double> image = forces(direction);
      image[plate(1)] = 0.0;
      const double step = square / dot(direction, image);
      for (std::size_t n = 0; n < u.size(); ++n) {
        u[n] += step * direction[n];
        residual[n] -= step * image[n];
      }
      const double next = dot(residual, residual);
      for (std::size_t n = 0; n < u.size(); ++n)
        direction[n] = residual[n] + next / square * direction[n];
      square = next;
    }
    return {-forces(u)[plate(1)], u[plate(0)]};
  }

  /// Distances of the outer centres, m.
  double width() const { return (across_ - 1) * diameter / std::sqrt(2.0); }
  double height() const { return (along_ - 1) * diameter / std::sqrt(2.0); }
  std::size_t balls() const { return balls_.size(); }

private:
  using Place = std::array<int, 3>;
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  struct Link {
    std::size_t a, b;
    std::array<double, 3> normal;
  };
  struct Wall {
    std::size_t ball, plate; // unknowns
  };

  std::size_t plate(std::size_t axis) const { return 6 * balls_.size() + axis; }
  static double dot(const std::vector<double> &a, const std::vector<double> &b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  }
  static std::array<double, 3> cross(const std::array<double, 3> &a, const std::array<double, 3> &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }

  /// The forces that the springs need: of each ball three components and three torques, then one for each
  /// platen.
  std::vector<double> forces(const std::vector<double> &u) const {
    std::vector<double> f(u.size(), 0.0);
    constexpr double radius = diameter / 2;
    for (const Link &link : links_) {
      const std::size_t a = 6 * link.a, b = 6 * link.b;
      const std::array<double, 3> turn =
          cross({u[a + 3] + u[b + 3], u[a + 4] + u[b + 4], u[a + 5] + u[b + 5]}, link.normal);
      std::array<double, 3> slip{}, force{};
      double normal = 0.0;
      for (std::size_t n = 0; n < 3; ++n) {
        slip[n] = u[a + n] - u[b + n] + radius * turn[n];
        normal += slip[n] * link.normal[n];
      }
      for (std::size_t n = 0; n < 3; ++n) {
        force[n] = kt3 * slip[n] + (kn3 - kt3) * normal * link.normal[n];
        f[a + n] += force[n];
        f[b + n] -= force[n];
      }
      const std::array<double, 3> torque = cross(link.normal, force);
      for (std::size_t n = 0; n < 3; ++n) {
        f[a + 3 + n] += radius * torque[n];
        f[b + 3 + n] += radius * torque[n];
      }
    }
    for (const Wall &wall : walls_) {
      const double force = kn3 * (u[wall.ball] - (wall.plate == none ? 0.0 : u[wall.plate]));
      f[wall.ball] += force;
      if (wall.plate != none) f[wall.plate] -= force;
    }
    return f;
  }

  int across_, along_;
  std::map<Place, std::size_t> balls_;
  std::vector<Link> links_;
  std::vector<Wall> walls_;
};

/// Axial force per metre by which neighbouring layers of a face-centred lattice approach, far from its ends.
/// Neighbours in layers across the load separate by 2 b and the force across the load is constant: a contact
/// at 45 degrees to the load has the normal force kn (a - b)/root2 and the shear force kt (a + b)/root2, one
/// across the load the normal force -kn root2 b, and there are `across` layers with the first for each
/// `across` - 1 with the second.
double force_of_approach(int across) {
  const double b = across * (kn3 - kt3) / (2 * (across - 1) * kn3 + across * (kn3 + kt3)); // for a = 1
  return across * (across - 1) * (kn3 * (1 - b) + kt3 * (1 + b));
}

TEST(FaceCentredLattice, HasTheStiffnessOfTheClosedForm) {
  const double shorter = 1 / FaceCentredSprings(7, 9).settle().force,
               longer = 1 / FaceCentredSprings(7, 13).settle().force;
  const double expected = 4 / force_of_approach(7);
  EXPECT_NEAR(longer - shorter, expected, 2e-3 * expected);
}

/// Stiffness of columns of a cubic lattice under the load, each with a contact less than layers, and those
/// with the plates; heights and widths are between centres.
double cubic_modulus() { return 16.0 / 9.0 * kn3 / (layers3 + 1) * (layers3 - 1) / diameter; }

/// Forces of a hexagonal lattice on walls and floor over its weight.
struct Statics {
  double walls = 0.0; ///< normal force on both walls
  double floor = 0.0;
};

/// Equilibrium of the balls of a lattice, row by row from above, if the balls of a row are apart and have no
/// friction between each other, so that all forces are normal ones in contacts at 60 degrees, and the outer
/// balls of every second row, the longer ones, slide down the walls. The lowest row is a shorter one. A
/// contact of a ball inside passes on the force from above in its direction and half of the ball's weight.
/// \param longest balls in a longer row
Statics statics(int longest, int rows, double wall_friction) {
  const double sine = std::sqrt(0.75), cosine = 0.5;
  // To the right and to the left down, of each ball of a row; weights are 1. Outside of the outer balls there
  // is none.
  std::vector<double> right, left;
  double walls = 0.0, weight = 0.0;
  for (int row = rows; row > 0; --row) {
    const bool longer = row % 2 == 0;
    const int balls = longer ? longest : longest - 1;
    std::vector<double> from_left(static_cast<std::size_t>(balls), 0.0), from_right = from_left;
    for (std::size_t n = 0; n < right.size(); ++n) {
      if (longer) {
        from_left[n + 1] = right[n];
        from_right[n] = left[n];
        continue;
      }
      if (n < from_left.size()) from_left[n] = right[n];
      if (n > 0) from_right[n - 1] = left[n];
    }
    right = from_left;
    left = from_right;
    for (std::size_t n = 0; n < right.size(); ++n) {
      right[n] += 0.5 / sine;
      left[n] += 0.5 / sine;
    }
    weight += balls;
    if (!longer) continue;
    // The outer balls: from one side f, to the same side g; N = (f + g) cos 60, (g - f) sin 60 = weight -
    // friction N.
    const auto reflected = [&](double f) {
      const double g = (f * (sine - wall_friction * cosine) + 1.0) / (sine + wall_friction * cosine);
      walls += (f + g) * cosine;
      return g;
    };
    right.front() = reflected(from_right.front());
    left.front() = 0.0;
    left.back() = reflected(from_left.back());
    right.back() = 0.0;
  }
  const double floor = sine * (std::accumulate(right.begin(), right.end(), 0.0) +
                               std::accumulate(left.begin(), left.end(), 0.0));
  return {walls / weight, floor / weight};
}

// The statics themselves: without friction of the walls the floor carries all, and a wall as much as the sum
// over the longer rows, j rows below the top, of j weights over tan 60, a third of the hydrostatic force for
// many rows.
TEST(LatticeStatics, AreThoseOfSmoothWalls) {
  const Statics smooth = statics(8, 9, 0.0);
  EXPECT_NEAR(smooth.floor, 1.0, 1e-12);
  EXPECT_NEAR(smooth.walls, 2 * (2 + 4 + 6 + 8) / std::sqrt(3.0) / 67, 1e-12);
  const Statics rough = statics(8, 9, 0.3);
  EXPECT_NEAR(rough.floor + 0.3 * rough.walls, 1.0, 1e-12);
  const double height = 25 * root3 * 0.02, width = 8 * diameter, x = 2 * 0.3 / 3 * height / width;
  EXPECT_NEAR(statics(8, 25, 0.3).floor, (1 - std::exp(-x)) / x, 0.02) << "too small for Janssen's theory";
}

// --- the table

/// Numbers of a table, and the bounds in which each of them must be. `what` is one of
///   first, last, most, each, later (each but the first), row:N COLUMNS
///   mean:N COLUMNS         of the last N rows
///   ratio COLUMNS          of the last row to the first
///   gain:A:B COLUMNS       from row A to row B
///   slope:A:B COLUMNS per COLUMNS
///   rows
/// with COLUMNS a column, a sum A+B of some, or a quotient of these, A+B/C+D.
struct Check {
  std::string what;
  double least, most;
};
constexpr double infinite = std::numeric_limits<double>::infinity();
Check near(const std::string &what, double value, double error) {
  return {what, value - error, value + error};
}
Check above(const std::string &what, double bound) { return {what, bound, infinite}; }
Check below(const std::string &what, double bound) { return {what, -infinite, bound}; }
Check energy_balance(double bound) { return near("each energy_error", 0, bound); }

std::vector<double> sum_of(const post::Table &table, const std::string &text) {
  std::vector<double> sum(table.rows(), 0.0);
  for (const std::string &column : parts_of(text, "+")) {
    const std::vector<std::string> cells = table.text(column); // of which the first may be empty
    for (std::size_t n = 0; n < sum.size(); ++n)
      sum[n] += post::any_number_from_text(cells[n]).value_or(std::nan(""));
  }
  return sum;
}

std::vector<double> values_of(const post::Table &table, const std::string &text) {
  const std::vector<std::string> sides = parts_of(text, "/");
  std::vector<double> values = sum_of(table, sides.at(0));
  if (sides.size() > 1) {
    const std::vector<double> below = sum_of(table, sides[1]);
    for (std::size_t n = 0; n < values.size(); ++n)
      values[n] /= below[n];
  }
  return values;
}

std::vector<double> judged(const post::Table &table, const std::string &what) {
  const std::vector<std::string> words = words_of(what), how = parts_of(words.at(0), ":");
  const auto number = [&how](std::size_t n) { return std::stoul(how.at(n)); };
  if (how[0] == "rows") return {static_cast<double>(table.rows())};
  const std::vector<double> values = values_of(table, words.at(1));
  if (how[0] == "first") return {values.front()};
  if (how[0] == "last") return {values.back()};
  if (how[0] == "most") return {*std::max_element(values.begin(), values.end())};
  if (how[0] == "each") return values;
  if (how[0] == "later") return {values.begin() + 1, values.end()};
  if (how[0] == "row") return {values.at(number(1))};
  if (how[0] == "ratio") return {values.back() / values.front()};
  if (how[0] == "mean") {
    const auto count = static_cast<std::ptrdiff_t>(number(1));
    return {std::accumulate(values.end() - count, values.end(), 0.0) / static_cast<double>(count)};
  }
  const double gain = values.at(number(2)) - values.at(number(1));
  if (how[0] == "gain") return {gain};
  if (how[0] != "slope" || words.at(2) != "per") throw std::logic_error("no numbers are '" + what + "'");
  const std::vector<double> over = values_of(table, words.at(3));
  return {gain / (over.at(number(2)) - over.at(number(1)))};
}

struct Row {
  std::string test, name;
  std::string variables;
  std::vector<std::string> ways; ///< further variables of a run each
  std::vector<Check> checks;
  std::string file = ""; ///< by default that of the test
  bool in_both = true;
};

void PrintTo(const Row &row, std::ostream *out) { *out << row.variables; }

const std::vector<std::string> once = {""}, schemes = {"stepping stock", "stepping second"};

// At these loads the strains are below 1e-4: the modulus differs from that of small strains by so much. The
// energy s^2/(2 M) per volume, from 5 to 6 and 7 kPa.
void add_oedometers(std::vector<Row> &rows) {
  for (const Lattice &one : lattices)
    for (const bool rubs : {false, true}) {
      const double modulus = one.normal * one.kn + (rubs ? one.tangential * one.kt : 0.0);
      const auto energy = [&](double from, double to) {
        return one.volume * (to * to - from * from) / (2 * modulus);
      };
      rows.push_back(
          {"oedometer",
           std::string("MeasuresTheModulusOfALattice_") + one.name + (rubs ? "_friction" : "_frictionless"),
           fmt::format("sample {}, loads 6 7 6, ratio 1e-9, friction {}, k {}, kt {}", one.name,
                       rubs ? "0.5" : "0", one.kn, one.kt),
           once,
           {near("rows", 4, 0), near("later modulus_MPa", 1e-6 * modulus, 2e-10 * modulus),
            near("first void_ratio", one.void_ratio, 2e-4), near("later energy_error", 0, 1e-7),
            near("row:1 stored_J", energy(5e3, 6e3), 1e-3 * energy(5e3, 6e3)),
            near("row:2 stored_J", energy(5e3, 7e3), 1e-3 * energy(5e3, 7e3))}});
    }
  // A disordered sample becomes stiffer with stress, but not as stiff as the hexagonal lattice, which is the
  // densest packing; it dissipates energy.
  rows.push_back({"oedometer",
                  "LoadsADisorderedSample",
                  "columns 10, layers 10, loads 50 200 50, ramp 1000, ratio 1e-3",
                  once,
                  {above("row:1 modulus_MPa", 10), above("gain:1:2 modulus_MPa", 0),
                   below("row:2 modulus_MPa", 130), above("gain:2:3 modulus_MPa", 0),
                   above("row:3 contact_heat_J", 0), near("later energy_error", 0, 1e-4)}});
}

void add_shear(std::vector<Row> &rows) {
  // A hexagonal lattice with rows along the platen has contacts at 60 degrees to the rows. Since all balls
  // but those of the plates turn freely, these contacts carry no friction: with equal angular velocities
  // neighbours roll on each other. Under shear one contact of each ball with the row below is compressed and
  // the other unloaded, by half the displacement u of the row: the shear force of a ball is kn u/2, and the
  // modulus, force over width times row height over displacement, is root3/4 kn. With an even number of rows
  // between the plates their balls, which do not turn, change nothing. When the second contact opens, the
  // rows climb over each other at 30 degrees: that is the angle of friction.
  const std::string angle = "shear_stress_kPa/normal_stress_kPa";
  rows.push_back(
      {"shear",
       "FindsStrengthAndStiffnessOfAHexagonalLattice",
       "sample hexagonal, columns 4, layers 9, friction 0.3, rolling 0, samples_of_strain 25, ramp 400, "
       "inertial_number 2e-5, strain 2.5e-4",
       schemes,
       {near("slope:4:12 shear_stress_kPa per shear_strain", 1e-3 * root3 / 4 * kn, 1e-6 * kn),
        near("most " + angle, 1 / root3, 1e-3), near("last " + angle, 1 / root3, 2e-3),
        energy_balance(1e-4)}});
  // As above the shear force of a ball is that of one contact pair, kn u/2 and c u'/2 of the dashpot, whether
  // two contacts are compressed or not: over a cycle of angular frequency w the lattice is a spring and a
  // dashpot side by side, whose damping ratio is c w/(2 kn), with c = 2 D sqrt(kn m*). m* is half the mass of
  // a ball, at the plates, which do not give way, the whole.
  constexpr double amplitude = 1e-5, rate = 1.5e-3;
  constexpr int balls = 9;                                            // layers
  const double of_soil = rate / amplitude * std::sqrt(mass / 2 / kn), // D = 1
      ratio = of_soil * (balls - 3 + 2 * root2) / (balls - 1);
  rows.push_back(
      {"shear",
       "FindsModulusAndDampingRatioOfAnElasticLattice",
       fmt::format("sample hexagonal, columns 4, layers {}, rolling 0, D 1, dt {}, ramp 8000, every 800, "
                   "cycles 2, amplitude {}, inertial_number {}",
                   balls, 0.025 * std::sqrt(mass / kn), amplitude,
                   rate * diameter * std::sqrt(density / 1e5)),
       once,
       {near("rows", 2, 0), near("each amplitude", amplitude, 1e-6 * amplitude),
        near("each secant_modulus_MPa", 1e-6 * root3 / 4 * kn, 5e-9 * kn),
        near("each damping_ratio", ratio, 0.02 * ratio),
        near("each damping_ratio_of_heat", ratio, 0.02 * ratio),
        near("each volumetric_strain", 0, 1e-4 * amplitude)},
       "loops.csv"});
  // In a disordered sample the area of a loop is what the contacts dissipate, less the work of the normal
  // stress, and below that of a rectangle; a dense one has hardly changed its volume after so few cycles.
  rows.push_back({"shear",
                  "DissipatesTheAreaOfTheLoop",
                  "seating 50, ramp 1000, cycles 2, amplitude 2e-3",
                  {"columns 10, layers 10", "dimension 3, columns 4, rows 4, layers 8, samples_of_way 40"},
                  {near("rows", 2, 0),
                   {"each damping_ratio", 0.05, 2 / pi},
                   near("each damping_ratio_of_heat/damping_ratio", 1, 0.02),
                   near("each amplitude", 2e-3, 1e-7),
                   near("each volumetric_strain", 0, 4e-3)},
                  "loops.csv"});
  // A dense sample fails and dilates; the normal stress stays what it should be.
  rows.push_back({"shear",
                  "ShearsADisorderedSample",
                  "columns 10, layers 10, seating 50, ramp 1000, samples_of_strain 10, strain 0.01",
                  once,
                  {{"most " + angle, 0.4, 1.5},
                   below("last volumetric_strain", -3e-4),
                   near("each normal_stress_kPa", 100, 5),
                   below("each inertial_number", 1e-3),
                   energy_balance(1e-3)}});
  // The platen of a dense sample that dilates rises above the box in which the sample was made.
  rows.push_back(
      {"shear",
       "FollowsALatticeThatDilatesFar",
       "sample hexagonal, columns 4, layers 20, rolling 0.45, samples_of_strain 20, inertial_number 5e-3, "
       "strain 0.08",
       once,
       {below("last volumetric_strain", -0.085), near("each normal_stress_kPa", 100, 20)}});
}

void add_compression(std::vector<Row> &rows) {
  // A lattice is loaded slowly, so that it is close to equilibrium all the time.
  const std::string ratio = "axial_stress_kPa/side_stress_kPa", stiffness = "axial_stress_kPa per strain",
                    slowly = ", samples_of_strain 25, ramp 400",
                    lattice = fmt::format("columns {}, layers {}, sample ", columns, layers);
  rows.push_back({"biaxial",
                  "FindsStrengthAndStiffnessOfAHexagonalLattice",
                  lattice + "hexagonal, friction 0.3, strain 9e-4, inertial_number 1e-4" + slowly,
                  schemes,
                  {near("most " + ratio, strength(0.3), 5e-3 * strength(0.3)),
                   near("last " + ratio, strength(0.3), 1e-2 * strength(0.3)),
                   near("slope:14:18 " + stiffness, 1e-3 * hexagonal_modulus(), 5e-6 * hexagonal_modulus()),
                   energy_balance(1e-3)}});
  // With suction F_a the contacts at 60 degrees carry N = R - F_a, of which R rubs; those within the rows
  // have opened before the lattice yields, and pull no longer. With T = tan(60 + phi) the axial stress is
  // root3 T side + F_a/d (T - root3).
  const double T = strength(0.3) / root3, cohesive = root3 * T * 100 + 1e-3 * 4000 / diameter * (T - root3);
  rows.push_back(
      {"biaxial",
       "FindsTheCohesionThatSuctionGivesAHexagonalLattice",
       lattice + "hexagonal, friction 0.3, strain 1.4e-3, inertial_number 1e-4, suction 4000" + slowly,
       schemes,
       {near("most axial_stress_kPa", cohesive, 1e-2 * cohesive), energy_balance(1e-3)}});
  // The suction with which a sample is made is gone in the test: the strength is that without any.
  rows.push_back(
      {"biaxial",
       "LeavesTheSuctionOfItsPreparation",
       lattice + "hexagonal, friction 0.3, strain 9e-4, inertial_number 1e-4, prepare_tensile_strength 1e5" +
           slowly,
       once,
       {near("most " + ratio, strength(0.3), 5e-3 * strength(0.3)), energy_balance(1e-3)}});
  // The upper platen moves by 4 nm in a time step, and its position is a multiple of 15 pm, the spacing of
  // floating-point numbers there. The energy error exceeds its limit if a step is no multiple of this
  // spacing, if the platen does not start at rest, or if the work of the side platen is computed from its
  // velocity.
  rows.push_back({"biaxial",
                  "BalancesTheEnergyOfASlowTest",
                  lattice + "hexagonal, friction 0, strain 2e-4, inertial_number 2e-5" + slowly,
                  once,
                  {energy_balance(5e-5)}});
  // It has yielded at the end, and vibrates.
  rows.push_back({"biaxial",
                  "HasATripleStrengthWithoutFriction",
                  lattice + "hexagonal, friction 0, strain 4e-4, inertial_number 1e-4" + slowly,
                  once,
                  {near("most " + ratio, 3, 0.1), near("mean:8 " + ratio, 3, 0.02), energy_balance(1e-3)},
                  "",
                  false});
  rows.push_back({"biaxial",
                  "HasTheStiffnessOfItsColumnsIfSquare",
                  lattice + "square, friction 0.5, strain 1e-4, inertial_number 1e-4" + slowly,
                  once,
                  {near("slope:18:25 " + stiffness, 1e-3 * square_modulus(), 1e-6 * square_modulus()),
                   near("last side_strain", 0, 1e-7), energy_balance(1e-3)},
                  "",
                  false});
  // A dense sample fails at a multiple of the side stress and dilates at the end; the side stress stays what
  // it should be.
  const std::vector<Check> dense = {near("first " + ratio, 1, 2e-3),
                                    {"most " + ratio, 2.5, 8},
                                    below("gain:5:8 volumetric_strain", -1e-4),
                                    near("each side_stress_kPa", 100, 5),
                                    below("each inertial_number", 1e-3),
                                    energy_balance(1e-3)};
  rows.push_back({"biaxial", "ShearsADisorderedSample",
                  "columns 8, layers 9, seating 50, samples_of_strain 8, ramp 1000, strain 0.005", schemes,
                  dense});
  rows.back().checks.push_back(near("last strain", 0.005, 1e-4));
  rows.push_back(
      {"triaxial", "ShearsADisorderedSample",
       "columns 4, rows 4, layers 7, k 1e7, strain 0.012, seating 50, samples_of_strain 8, ramp 1000", once,
       dense});
  rows.back().checks.push_back(near("each front_stress_kPa", 100, 5));

  const std::string in_space =
      fmt::format("columns 4, rows 4, layers {}, inertial_number 1e-4, sample ", layers3);
  // With all contacts closed.
  const FaceCentredSprings springs(7, layers3);
  const FaceCentredSprings::Response response = springs.settle();
  const double of_springs = response.force * springs.height() / std::pow(springs.width(), 2),
               expansion = response.expansion * springs.height() / springs.width();
  rows.push_back(
      {"triaxial",
       "FindsTheStiffnessOfAFaceCentredLattice",
       in_space + "face_centred, friction 0.3, strain 1.2e-4, rolling 0" + slowly,
       once,
       {near("slope:10:25 " + stiffness, 1e-3 * of_springs, 5e-6 * of_springs),
        near("slope:10:25 side_strain per strain", -expansion, 2e-2 * expansion), energy_balance(1e-3)}});
  // A face-centred lattice whose cube has its edges along the axes yields when the contacts at 45 degrees to
  // the load slide; those across it have opened. With a normal force N and friction T a contact carries (N +
  // T)/root2 along the load and (N - T)/root2 across it. Both directions across the load share the axial
  // force: the ratio of the stresses is 2 (1 + friction)/(1 - friction) (Thornton 1979). Balls at the edges
  // of the sample would roll instead; rolling friction keeps them from it.
  const double thornton = 2 * 1.3 / 0.7;
  rows.push_back({"triaxial",
                  "FindsTheStrengthOfAFaceCentredLattice",
                  in_space + "face_centred, friction 0.3, strain 8e-4" + slowly,
                  once,
                  {near("most " + ratio, thornton, 1e-2 * thornton),
                   near("last " + ratio, thornton, 1e-2 * thornton), energy_balance(5e-5)}});
  rows.push_back({"triaxial",
                  "HasTheStiffnessOfItsColumnsIfCubic",
                  in_space + "cubic, friction 0.5, strain 1e-4" + slowly,
                  once,
                  {near("slope:18:25 " + stiffness, 1e-3 * cubic_modulus(), 2e-6 * cubic_modulus()),
                   near("last side_strain", 0, 1e-7), energy_balance(1e-3)},
                  "",
                  false});
}

void add_own_weight(std::vector<Row> &rows) {
  const double weight = mass * 9.81;
  const std::string walls = "left_force_N+side_force_N", wall_friction = "left_friction_N+side_friction_N",
                    lattice = "sample hexagonal, columns 8, rolling 0, ",
                    sample = "columns 7, layers 9, k 1e7, ramp 1000, samples_of_strain 5, ";
  // Rankine: smooth walls carry a third of the hydrostatic force, since the friction angle of the lattice is
  // 30 degrees, and more by the outer balls.
  const double rankine = statics(8, 9, 0.0).walls * 67 * weight;
  rows.push_back(
      {"wall",
       "FindsTheActiveForceOfALattice",
       lattice + "layers 9, friction 0, inertial_number 1e-4, strain 2e-4, ramp 1000, samples_of_strain 10",
       schemes,
       {near("last " + walls, rankine, 5e-3 * rankine),
        near("last floor_force_N", 67 * weight, 2e-3 * 67 * weight)}});
  // Janssen, without a parameter: the lattice's ratio of the stresses is 1/3; its equilibrium has the effects
  // of its few columns besides. Rolling resistance keeps the outer balls from rolling down the walls, and
  // friction of 1e-6 between balls is none.
  const Statics janssen = statics(8, 25, 0.3);
  const double all = (12 * 8 + 13 * 7) * weight;
  rows.push_back(
      {"silo",
       "FindsTheFloorForceOfALattice",
       "sample hexagonal, columns 8, layers 25, friction 1e-6, rolling 1e-5, wall_friction 0.3, strain "
       "1e-4, ramp 1000, samples_of_strain 8",
       once,
       {near("last " + walls, janssen.walls * all, 2e-3 * all),
        near("last floor_force_N", janssen.floor * all, 2e-3 * all),
        near("last " + wall_friction + "/" + walls, 0.3, 1e-3), energy_balance(1e-3)}});
  rows.push_back({"silo",
                  "StandsOnTheFloorAloneBetweenSmoothWalls",
                  lattice + "layers 9, friction 0, wall_friction 0, ratio 1e-6, strain 1e-5, ramp 200, "
                            "samples_of_strain 1",
                  once,
                  {near("first floor_force_N", 67 * weight, 1e-5 * 67 * weight),
                   near("first left_force_N/side_force_N", 1, 1e-4)}});
  // A disordered sample fails, carried by both walls alike; the force is between those of friction angles of
  // 25 and 50 degrees.
  rows.push_back({"wall",
                  "FindsTheActiveForceOfADisorderedSample",
                  sample + "strain 5e-3",
                  once,
                  {below("ratio side_force_N", 0.5), near("last left_force_N/side_force_N", 1, 0.1),
                   near("ratio floor_force_N", 1, 0.02), energy_balance(1e-3)}});
  // Full friction of the walls, and the balance of the vertical forces.
  rows.push_back(
      {"silo",
       "MobilisesTheFrictionOfTheWalls",
       sample + "strain 1e-3, inertial_number 1e-4",
       once,
       {near("last " + wall_friction + "/" + walls, 0.3, 0.01),
        near("ratio floor_force_N+" + wall_friction, 1, 4e-3), below("ratio floor_force_N", 0.9)}});
  // The floor moves by 4e-9 m in a time step, and its position is a multiple of 2e-12 m, the spacing of
  // floating-point numbers there. If rounding changed this distance, the work computed from the velocity
  // would be wrong, and the energy error 6e-3.
  rows.push_back({"silo",
                  "BalancesTheEnergyOfASlowFloor",
                  "columns 8, layers 8, strain 1e-4, ramp 1000, samples_of_strain 5",
                  once,
                  {energy_balance(2e-4)}});
}

/// The rows of some tests, each in the engines that it is for.
std::vector<std::pair<std::string, Row>> rows_of(const std::set<std::string> &tests) {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all;
    for (auto *add : {add_oedometers, add_shear, add_compression, add_own_weight})
      add(all);
    return all;
  }();
  std::vector<std::pair<std::string, Row>> found;
  for (const Row &row : rows)
    for (const char *engine : {"liggghts", "lammps"})
      if (tests.count(row.test) == 1 && (row.in_both || engine == std::string("liggghts")))
        found.emplace_back(engine, row);
  return found;
}

class ElementTest : public ::testing::TestWithParam<std::pair<std::string, Row>> {};

TEST_P(ElementTest, Gives) {
  const auto &[engine, row] = GetParam();
  SKIP_WITHOUT_LAMMPS(engine == "lammps");
  for (const std::string &way : row.ways) {
    SCOPED_TRACE(way);
    const post::Table table = run_element_test(
        engine, row.test, with(way.empty() ? Variables{} : given(way), given(row.variables)), 1, row.file);
    for (const Check &check : row.checks) {
      const std::vector<double> values = judged(table, check.what);
      EXPECT_FALSE(values.empty()) << check.what;
      for (const double value : values)
        EXPECT_TRUE(value >= check.least && value <= check.most)
            << check.what << " is " << value << ", not from " << check.least << " to " << check.most;
    }
  }
}

std::string name_of_row(const ::testing::TestParamInfo<ElementTest::ParamType> &info) {
  return info.param.second.test + "_" + info.param.second.name + "_" + info.param.first;
}
INSTANTIATE_TEST_SUITE_P(Oedometer, ElementTest, ::testing::ValuesIn(rows_of({"oedometer"})), name_of_row);
INSTANTIATE_TEST_SUITE_P(Shear, ElementTest, ::testing::ValuesIn(rows_of({"shear"})), name_of_row);
INSTANTIATE_TEST_SUITE_P(Biaxial, ElementTest, ::testing::ValuesIn(rows_of({"biaxial"})), name_of_row);
INSTANTIATE_TEST_SUITE_P(Triaxial, ElementTest, ::testing::ValuesIn(rows_of({"triaxial"})), name_of_row);
INSTANTIATE_TEST_SUITE_P(OwnWeight, ElementTest, ::testing::ValuesIn(rows_of({"wall", "silo"})), name_of_row);

} // namespace
} // namespace drumlin::test
