// Element tests of soil: biaxial and triaxial compression, soil under its own weight.
#include "tests/support/engine_runs.h"
#include "bed/dump_readers.h"
#include "support/statistics.h"

namespace drumlin::test {
namespace {

// The biaxial and the triaxial test: regular lattices against their strength and stiffness in closed form,
// the forces on the plates against sums over the contacts of a cut, disordered samples in both engines.
namespace compression {

void expect_energy_balance(const post::Table &rows, double limit) {
  for (const double error : rows.numbers("energy_error"))
    EXPECT_LT(std::fabs(error), limit);
}

post::Table run_test(const std::string &engine, const std::string &test, const Variables &variables) {
  post::Table rows = run_element_test(engine, test, variables);
  expect_energy_balance(rows, 1e-3);
  return rows;
}

post::Table run_biaxial(const std::string &engine, const Variables &variables) {
  return run_test(engine, "biaxial", variables);
}

post::Table run_triaxial(const std::string &engine, const Variables &variables) {
  return run_test(engine, "triaxial", variables);
}

constexpr double diameter = 0.04, kn = 1e9, kt = 2.0 / 7.0 * kn; // m, N/m; the deck's
constexpr int columns = 6, layers = 7;
const double root3 = std::sqrt(3.0);

/// A lattice that is loaded slowly, so that it is close to equilibrium all the time.
Variables lattice(const std::string &sample, const std::string &friction, const std::string &strain,
                  const std::string &stepping = "stock") {
  return given("sample {}, stepping {}, friction {}, columns {}, layers {}, samples_of_strain 25, "
               "inertial_number 1e-4, ramp 400, strain {}",
               sample, stepping, friction, columns, layers, strain);
}

/// Axial stress over side stress of each row.
std::vector<double> ratios(const post::Table &table) {
  const std::vector<double> axial = table.numbers("axial_stress_kPa"),
                            side = table.numbers("side_stress_kPa");
  std::vector<double> values;
  for (std::size_t n = 0; n < axial.size(); ++n)
    values.push_back(axial[n] / side[n]);
  return values;
}

/// Change of the axial stress over that of the strain between two rows, Pa.
double modulus(const post::Table &table, std::size_t from, std::size_t to) {
  const std::vector<double> axial = table.numbers("axial_stress_kPa"), strain = table.numbers("strain");
  return 1e3 * (axial[to] - axial[from]) / (strain[to] - strain[from]);
}

class Biaxial : public InEngine {};
class Triaxial : public InEngine {};

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

TEST_P(Biaxial, FindsStrengthAndStiffnessOfAHexagonalLattice) {
  for (const std::string stepping : {"stock", "second"}) {
    SCOPED_TRACE(stepping);
    const post::Table rows = run_biaxial(GetParam(), lattice("hexagonal", "0.3", "9e-4", stepping));
    const std::vector<double> ratio = ratios(rows);
    const double highest = *std::max_element(ratio.begin(), ratio.end());
    EXPECT_NEAR(highest, strength(0.3), 5e-3 * highest);
    EXPECT_NEAR(ratio.back(), strength(0.3), 1e-2 * highest);
    EXPECT_NEAR(modulus(rows, 14, 18), hexagonal_modulus(), 5e-3 * hexagonal_modulus());
  }
}

// With suction F_a the contacts at 60 degrees carry N = R - F_a, of which R rubs; those within the rows have
// opened before the lattice yields, and pull no longer. With T = tan(60 + phi) the axial stress is
// root3 T side + F_a/d (T - root3).
TEST_P(Biaxial, FindsTheCohesionThatSuctionGivesAHexagonalLattice) {
  constexpr double side = 100.0, suction = 4000.0; // kPa, N/m
  const double T = std::tan(pi / 3 + std::atan(0.3));
  const double expected = root3 * T * side + 1e-3 * suction / diameter * (T - root3);
  for (const std::string stepping : {"stock", "second"}) {
    const Variables wet =
        with(lattice("hexagonal", "0.3", "1.4e-3", stepping), {{"suction", number(suction)}});
    const std::vector<double> axial = run_biaxial(GetParam(), wet).numbers("axial_stress_kPa");
    EXPECT_NEAR(*std::max_element(axial.begin(), axial.end()), expected, 1e-2 * expected) << stepping;
  }
}

// The suction with which a sample is made is gone in the test: the strength is that without any.
TEST_P(Biaxial, LeavesTheSuctionOfItsPreparation) {
  const std::vector<double> ratio = ratios(run_biaxial(
      GetParam(), with(lattice("hexagonal", "0.3", "9e-4"), {{"prepare_tensile_strength", "1e5"}})));
  const double highest = *std::max_element(ratio.begin(), ratio.end());
  EXPECT_NEAR(highest, strength(0.3), 5e-3 * highest);
}

// The upper platen moves by 4 nm in a time step, and its position is a multiple of 15 pm, the spacing of
// floating-point numbers there. The limit of the energy error is exceeded if the distance of a step is not a
// multiple of this spacing, if the platen is not at rest before it is accelerated, or if the work of the side
// platen is computed from its velocity.
TEST_P(Biaxial, BalancesTheEnergyOfASlowTest) {
  Variables slow = lattice("hexagonal", "0", "2e-4");
  slow.insert(slow.begin(), {"inertial_number", "2e-5"});
  expect_energy_balance(run_biaxial(GetParam(), slow), 5e-5);
}

TEST(BiaxialLattice, HasATripleStrengthWithoutFriction) {
  const std::vector<double> ratio = ratios(run_biaxial("liggghts", lattice("hexagonal", "0", "4e-4")));
  EXPECT_NEAR(*std::max_element(ratio.begin(), ratio.end()), 3, 0.1);
  EXPECT_NEAR(std::accumulate(ratio.end() - 8, ratio.end(), 0.0) / 8, 3,
              0.02); // it has yielded, and vibrates
}

TEST(BiaxialLattice, HasTheStiffnessOfItsColumnsIfSquare) {
  const post::Table rows = run_biaxial("liggghts", lattice("square", "0.5", "1e-4"));
  EXPECT_NEAR(modulus(rows, 18, 25), square_modulus(), 1e-3 * square_modulus());
  EXPECT_NEAR(rows.numbers("side_strain").back(), 0, 1e-7);
}

const Variables small =
    given("columns 8, layers 9, seating 50, samples_of_strain 8, ramp 1000, strain 0.005");

// A dense sample fails at a multiple of the side stress and dilates at the end; the side stress stays what it
// should be.
void expect_shear_of_a_dense_sample(const post::Table &rows) {
  const std::vector<double> ratio = ratios(rows);
  EXPECT_NEAR(ratio.front(), 1, 2e-3);
  const double highest = *std::max_element(ratio.begin(), ratio.end());
  EXPECT_GT(highest, 2.5);
  EXPECT_LT(highest, 8);
  const std::vector<double> volumetric = rows.numbers("volumetric_strain");
  EXPECT_LT(volumetric.back(), volumetric[volumetric.size() - 4] - 1e-4);
  for (const char *side : {"side_stress_kPa", "front_stress_kPa"})
    if (rows.has(side)) {
      for (const double stress : rows.numbers(side))
        EXPECT_NEAR(stress, 100, 5) << side;
    }
  for (const double number : rows.numbers("inertial_number"))
    EXPECT_LT(number, 1e-3);
}

TEST_P(Biaxial, ShearsADisorderedSample) {
  for (const std::string stepping : {"stock", "second"}) {
    SCOPED_TRACE(stepping);
    const Variables variables = with(small, {{"stepping", stepping}});
    const post::Table rows = run_biaxial(GetParam(), variables);
    expect_shear_of_a_dense_sample(rows);
    EXPECT_NEAR(rows.numbers("strain").back(), 0.005, 1e-4);
  }
}

// Much too fast a test throws the side platen off the sample.
TEST_P(Biaxial, EndsWhenAPlatenIsOffTheSample) {
  const Variables fast = given(
      "sample hexagonal, columns 4, layers 5, seating 1, side 1, ratio 0.1, strain 0.9, inertial_number 1");
  EXPECT_TRUE(contains(error_of([&] { run_biaxial(GetParam(), fast); }),
                       "ERROR: drumlin/check: variable inertial_number is '1'; allowed: a finite number "
                       "below 1, with which a platen left the sample"));
}

/// A force between balls i and j, or on ball i by a plate j.
struct Contact {
  long i, j;
  std::array<double, 3> force; // on i
};

/// Sum of the forces in direction `axis` on the balls beyond a cut across it by those before the cut.
double force_through_cut(const std::vector<Contact> &contacts,
                         const std::map<long, std::array<double, 3>> &places, std::size_t axis, double cut) {
  double sum = 0.0;
  for (const Contact &contact : contacts) {
    const bool i_beyond = places.at(contact.i)[axis] > cut, j_beyond = places.at(contact.j)[axis] > cut;
    if (i_beyond != j_beyond) sum += (i_beyond ? 1.0 : -1.0) * contact.force[axis];
  }
  return sum;
}

/// At rest the contacts of any cut through the sample carry what the plates on both sides of it do.
/// \param scale N, side stress times the area of a plate
void expect_equilibrium(const std::string &deck, const Variables &more, std::size_t dimension, double scale) {
  const Scratch scratch;
  const std::string soil = chain_deck("../soil").string();
  post::write_files({{scratch / "in.contacts", "include " + soil + "/in." + deck + "\ninclude " +
                                                   test_deck("compression_contacts.in").string() + "\n"}});
  const Variables variables = with(
      given("here {}, seating 50, samples_of_strain 1, ramp 200, strain 1e-5, inertial_number 1e-5", soil),
      more);
  well(run_deck(scratch / "in.contacts", variables, scratch.path()));
  std::map<long, std::array<double, 3>> places;
  std::vector<long> plates; // left, side, base, top, and in space back, front
  std::array<double, 3> lowest{1.0, 1.0, 1.0}, highest{};
  for (const std::vector<double> &row : post::read_text_dump(scratch / "balls.dump").rows) {
    const long id = std::lround(row[0]);
    places[id] = {row[2], row[3], row[4]};
    if (std::lround(row[1]) == 2)
      plates.push_back(id);
    else
      for (std::size_t axis = 0; axis < dimension; ++axis) {
        lowest[axis] = std::min(lowest[axis], places[id][axis]);
        highest[axis] = std::max(highest[axis], places[id][axis]);
      }
  }
  ASSERT_EQ(plates.size(), 2 * dimension);
  std::sort(plates.begin(), plates.end());
  std::vector<Contact> contacts;
  for (const std::vector<double> &row : post::read_text_dump(scratch / "contacts.dump").rows)
    contacts.push_back({std::lround(row[0]), std::lround(row[1]), {row[2], row[3], row[4]}});
  const post::Table table = post::read_table(scratch / "plates.csv");
  for (std::size_t n = 0; n < plates.size(); ++n) {
    const char *const name = std::array{"left", "side", "base", "top", "back", "front"}[n];
    const std::size_t axis = n / 2;
    double sum = 0.0;
    for (const Contact &contact : contacts)
      if (contact.i == plates[n] || contact.j == plates[n])
        sum += (contact.i == plates[n] ? 1.0 : -1.0) * contact.force[axis];
    const double force = table.numbers(name).front();
    EXPECT_NEAR(sum, force, 1e-5 * scale) << name;
    for (const double share : {0.2, 0.4, 0.6, 0.8}) {
      const double cut = lowest[axis] + share * (highest[axis] - lowest[axis]);
      EXPECT_NEAR(force_through_cut(contacts, places, axis, cut), std::fabs(force), 2e-3 * scale)
          << name << ", cut at " << cut;
    }
  }
}

TEST(BiaxialEquilibrium, TheForcesOnThePlatesGoThroughEveryCut) {
  expect_equilibrium("biaxial", given("columns 8, layers 9"), 2, 100e3 * 8 * diameter);
}

TEST(TriaxialEquilibrium, TheForcesOnThePlatesGoThroughEveryCut) {
  expect_equilibrium("triaxial", given("columns 4, rows 4, layers 6"), 3, 100e3 * std::pow(6 * diameter, 2));
}

// A user changes the stress path by defining the force on the side platens (variable push_side) in the deck.
// With a force that keeps the mean stress constant, stresses are as wanted and energy is balanced.
TEST(StressPath, OfAConstantMeanStressIsKeptAndBalanced) {
  const std::string soil = chain_deck("../soil").string();
  for (const std::string test : {"biaxial", "triaxial"}) {
    const double sides = test == "biaxial" ? 1.0 : 2.0;
    const std::string push =
        fmt::format("-({}e3*v_side-f_on_top[3]/(v_width*v_depth))/{}*", sides + 1.0, sides);
    std::string deck = post::read_text(soil + "/in." + test);
    const std::size_t place = deck.rfind("include");
    std::string words = fmt::format("variable push_side equal {}v_height*v_depth\n", push);
    if (sides > 1.0) words += fmt::format("variable push_front equal {}v_width*v_height\n", push);
    deck.insert(place, words);
    const Scratch scratch;
    post::write_files({{scratch / "in.path", deck}});
    const std::string layers_of_test = sides > 1.0 ? "5" : "7";
    well(run_deck(scratch / "in.path",
                  given("here {}, sample {}, columns 4, layers {}, samples_of_strain 4, ramp 400, "
                        "inertial_number 1e-4, strain 1e-4",
                        soil, sides > 1.0 ? "face_centred" : "hexagonal", layers_of_test),
                  scratch.path()));
    const post::Table rows = post::read_table(scratch / (test + ".csv"));
    const std::vector<double> axial = rows.numbers("axial_stress_kPa"),
                              side = rows.numbers("side_stress_kPa");
    for (std::size_t n = 0; n < axial.size(); ++n)
      EXPECT_NEAR((axial[n] + sides * side[n]) / (sides + 1.0), 100.0, 0.1) << test;
    EXPECT_GT(axial.back(), 120.0) << test;
    expect_energy_balance(rows, 1e-2); // 0.2 with the work of a constant side stress
  }
}

/// Stiffness of the contacts of the triaxial test, N/m, and layers of its lattices.
constexpr double kn3 = 4e7, kt3 = 2.0 / 7.0 * kn3;
constexpr int layers3 = 5;

Variables lattice_in_space(const std::string &sample, const std::string &friction,
                           const std::string &strain) {
  Variables variables = lattice(sample, friction, strain);
  for (auto &[name, value] : variables) {
    if (name == "columns") value = "4";
    if (name == "layers") value = std::to_string(layers3);
  }
  variables.emplace_back("rows", "4");
  return variables;
}

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

// With all contacts closed.
TEST_P(Triaxial, FindsTheStiffnessOfAFaceCentredLattice) {
  const Variables variables = with(lattice_in_space("face_centred", "0.3", "1.2e-4"), {{"rolling", "0"}});
  const post::Table rows = run_triaxial(GetParam(), variables);
  const FaceCentredSprings springs(7, layers3);
  const FaceCentredSprings::Response response = springs.settle();
  const double expected = response.force * springs.height() / std::pow(springs.width(), 2);
  EXPECT_NEAR(modulus(rows, 10, 25), expected, 5e-3 * expected);
  const std::vector<double> strain = rows.numbers("strain"), side = rows.numbers("side_strain");
  const double expansion = response.expansion * springs.height() / springs.width();
  EXPECT_NEAR((side[10] - side[25]) / (strain[25] - strain[10]), expansion, 2e-2 * expansion);
}

/// A face-centred lattice whose cube has its edges along the axes yields when the contacts at 45 degrees to
/// the load slide; those across it have opened. With a normal force N and friction T a contact carries (N +
/// T)/root2 along the load and (N - T)/root2 across it. Both directions across the load share the axial
/// force: the ratio of the stresses is 2 (1 + friction)/(1 - friction) (Thornton 1979). Balls at the edges of
/// the sample would roll instead; rolling friction keeps them from it.
TEST_P(Triaxial, FindsTheStrengthOfAFaceCentredLattice) {
  const post::Table rows = run_triaxial(GetParam(), lattice_in_space("face_centred", "0.3", "8e-4"));
  expect_energy_balance(rows, 5e-5);
  const std::vector<double> ratio = ratios(rows);
  const double strength = 2 * 1.3 / 0.7;
  EXPECT_NEAR(*std::max_element(ratio.begin(), ratio.end()), strength, 1e-2 * strength);
  EXPECT_NEAR(ratio.back(), strength, 1e-2 * strength);
}

// Columns under the load, each with a contact less than layers, and those with the plates; heights and widths
// are between centres.
TEST(TriaxialLattice, HasTheStiffnessOfItsColumnsIfCubic) {
  const post::Table rows = run_triaxial("liggghts", lattice_in_space("cubic", "0.5", "1e-4"));
  const double expected = 16.0 / 9.0 * kn3 / (layers3 + 1) * (layers3 - 1) / diameter;
  EXPECT_NEAR(modulus(rows, 18, 25), expected, 2e-3 * expected);
  EXPECT_NEAR(rows.numbers("side_strain").back(), 0, 1e-7);
}

TEST_P(Triaxial, ShearsADisorderedSample) {
  Variables variables = small;
  variables = with(given("columns 4, rows 4, layers 7, k 1e7, strain 0.012"), variables);
  expect_shear_of_a_dense_sample(run_triaxial(GetParam(), variables));
}

INSTANTIATE_TEST_SUITE_P(Engines, Triaxial, ::testing::Values("liggghts", "lammps"));
INSTANTIATE_TEST_SUITE_P(Engines, Biaxial, ::testing::Values("liggghts", "lammps"));

} // namespace compression

// Tests of soil under its own weight: a hexagonal lattice without friction between its balls against the
// equilibrium of its balls, behind a smooth wall and in a silo; Janssen's and Rankine's theory; the angle of
// repose with and without friction; disordered samples in both engines.
namespace own_weight {

/// Forces of a hexagonal lattice on walls and floor over its weight.
struct Statics {
  double walls = 0.0; ///< normal force on both walls
  double floor = 0.0;
};

/// Equilibrium of the balls of a lattice, row by row from above, if the balls of a row are apart and have no
/// friction between each other, so that all forces are normal ones in contacts at 60 degrees, and the outer
/// balls of every second row, the longer ones, slide down the walls. The lowest row is a shorter one. A
/// contact of a ball inside passes on the force from above in its direction and half of the ball's weight.
/// \param columns balls in a longer row
Statics statics(int columns, int layers, double wall_friction) {
  const double sine = std::sqrt(0.75), cosine = 0.5;
  // To the right and to the left down, of each ball of a row; weights are 1. Outside of the outer balls there
  // is none.
  std::vector<double> right, left;
  double walls = 0.0, weight = 0.0;
  for (int row = layers; row > 0; --row) {
    const bool longer = row % 2 == 0;
    const int balls = longer ? columns : columns - 1;
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

/// A run of an element test, and what follows from its CSV file.
class WeightRun {
public:
  WeightRun(const std::string &engine, const std::string &name, const Variables &variables)
      : table_(run_element_test(engine, name, variables)) {}

  double last(const std::string &column) const { return table_.numbers(column).back(); }
  double first(const std::string &column) const { return table_.numbers(column).front(); }
  std::vector<double> side_force() const { return table_.numbers("side_force_N"); }
  double walls() const { return last("left_force_N") + last("side_force_N"); }
  double wall_friction() const { return last("left_friction_N") + last("side_friction_N"); }
  /// Expects that the absolute energy error of each row of the CSV file is below a bound.
  /// \param bound largest error that is allowed, relative to the largest work up to that row
  void expect_energy_balance(double bound = 1e-3) const {
    for (const double error : table_.numbers("energy_error"))
      EXPECT_LT(std::fabs(error), bound);
  }

private:
  post::Table table_;
};

double ball_weight() { return 2650 * pi * 0.02 * 0.02 * 9.81; } // N, the decks' balls

class OwnWeight : public InEngine {};

Variables lattice(int layers, Variables more) {
  more = with(more, given("sample hexagonal, columns 8, layers {}", layers));
  return more;
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
}

// Rankine: smooth walls carry a third of the hydrostatic force, since the friction angle of the lattice is 30
// degrees, and more by the outer balls.
TEST_P(OwnWeight, FindsTheActiveForceOfALattice) {
  for (const std::string stepping : {"stock", "second"}) {
    SCOPED_TRACE(stepping);
    const WeightRun run(GetParam(), "wall",
                        lattice(9, given("friction 0, rolling 0, stepping {}, inertial_number 1e-4, strain "
                                         "2e-4, ramp 1000, samples_of_strain 10",
                                         stepping)));
    const double exact = statics(8, 9, 0.0).walls * 67 * ball_weight();
    EXPECT_NEAR(run.walls(), exact, 5e-3 * exact);
    EXPECT_NEAR(run.last("floor_force_N"), 67 * ball_weight(), 2e-3 * 67 * ball_weight());
  }
}

// Janssen, without a parameter: the lattice's ratio of the stresses is 1/3; its equilibrium has the effects
// of its few columns besides. Rolling resistance keeps the outer balls from rolling down the walls, and
// friction of 1e-6 between balls is none.
TEST_P(OwnWeight, FindsTheFloorForceOfALatticeInASilo) {
  const WeightRun run(GetParam(), "silo",
                      lattice(25, given("friction 1e-6, rolling 1e-5, wall_friction 0.3, strain 1e-4, ramp "
                                        "1000, samples_of_strain 8")));
  const Statics exact = statics(8, 25, 0.3);
  const double balls = 12 * 8 + 13 * 7, weight = balls * ball_weight();
  EXPECT_NEAR(run.walls(), exact.walls * weight, 2e-3 * weight);
  EXPECT_NEAR(run.last("floor_force_N"), exact.floor * weight, 2e-3 * weight);
  EXPECT_NEAR(run.wall_friction(), 0.3 * run.walls(), 1e-3 * run.walls());
  const double height = 25 * std::sqrt(3.0) * 0.02, width = 8 * 0.04, x = 2 * 0.3 / 3 * height / width;
  EXPECT_NEAR(exact.floor, (1 - std::exp(-x)) / x, 0.02) << "the lattice is too small for Janssen's theory";
  run.expect_energy_balance();
}

TEST_P(OwnWeight, StandsOnTheFloorAloneBetweenSmoothWalls) {
  const WeightRun run(GetParam(), "silo",
                      lattice(9, given("friction 0, rolling 0, wall_friction 0, ratio 1e-6, strain 1e-5, "
                                       "ramp 200, samples_of_strain 1")));
  EXPECT_NEAR(run.first("floor_force_N"), 67 * ball_weight(), 1e-5 * 67 * ball_weight());
  EXPECT_NEAR(run.first("left_force_N"), run.first("side_force_N"), 1e-4 * run.first("side_force_N"));
}

/// The default value of a variable in an input file: VALUE of the line `variable NAME index VALUE`, or of the
/// line `NAME VALUE` of a table.
std::string default_of(const std::string &file, const std::string &name) {
  std::istringstream lines(read_text(chain_deck(file)));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string command, variable, style, value;
    words >> command >> variable >> style >> value;
    if (command == "variable" && variable == name && style == "index") return value;
    if (command == name) return variable;
  }
  return "none in " + file;
}

// By default the element tests of strength are made with the friction and rolling friction of the bed's soil.
TEST(DefaultContacts, AreThoseOfTheBed) {
  for (const std::string deck : {"own_weight", "compression", "in.shear", "in.density"})
    for (const std::string name : {"friction", "rolling"})
      EXPECT_EQ(default_of("../soil/" + deck, name), default_of("../bed/variables", name)) << deck;
}

const Variables disordered = given("columns 7, layers 9, k 1e7, ramp 1000");

// A disordered sample fails, carried by both walls alike; the force is between those of friction angles of 25
// and 50 degrees.
TEST_P(OwnWeight, FindsTheActiveForceOfADisorderedSample) {
  const Variables variables = with(disordered, given("strain 5e-3, samples_of_strain 5"));
  const WeightRun run(GetParam(), "wall", variables);
  EXPECT_GT(run.first("side_force_N"), 2 * run.last("side_force_N"));
  EXPECT_NEAR(run.last("left_force_N"), run.last("side_force_N"), 0.1 * run.last("side_force_N"));
  EXPECT_NEAR(run.last("floor_force_N"), run.first("floor_force_N"), 0.02 * run.first("floor_force_N"));
  run.expect_energy_balance();
}

// A vertical cut: the wall moves away from the soil, which stands by its cohesion or follows the wall. A cut
// can be as high as 4 c/gamma tan(45 + phi/2). With the cohesion c that biaxial tests give, half of Rumpf's
// strength times tan(phi), this is 4 times the height of the sample for the larger suction, and 0.2 times
// for the smaller one.
TEST_P(OwnWeight, StandsAsAVerticalCutByItsSuction) {
  const auto force_behind = [](const std::string &suction) {
    const Variables variables =
        with(disordered, given("strain 0.1, samples_of_strain 10, suction {}", suction));
    const WeightRun run(GetParam(), "wall", variables);
    run.expect_energy_balance();
    return run.side_force();
  };
  const std::vector<double> stands = force_behind("200"), falls = force_behind("10");
  for (std::size_t row = 5; row < stands.size(); ++row) {
    EXPECT_DOUBLE_EQ(stands[row], 0.0) << row;
    EXPECT_GT(falls[row], 0.02 * falls.front()) << row;
  }
}

// Full friction of the walls, and the balance of the vertical forces.
TEST_P(OwnWeight, MobilisesTheFrictionOfTheWallsOfASilo) {
  const Variables variables =
      with(disordered, given("strain 1e-3, samples_of_strain 5, inertial_number 1e-4"));
  const WeightRun run(GetParam(), "silo", variables);
  EXPECT_NEAR(run.wall_friction(), 0.3 * run.walls(), 0.01 * run.walls());
  EXPECT_NEAR(run.last("floor_force_N") + run.wall_friction(),
              run.first("floor_force_N") + run.first("left_friction_N") + run.first("side_friction_N"),
              5e-3 * run.first("floor_force_N"));
  EXPECT_LT(run.last("floor_force_N"), 0.9 * run.first("floor_force_N"));
}

// The floor moves by 4e-9 m in a time step, and its position is a multiple of 2e-12 m, the spacing of
// floating-point numbers there. If rounding changed this distance, the work computed from the velocity would
// be wrong, and the energy error 6e-3.
TEST_P(OwnWeight, BalancesTheEnergyOfASlowFloor) {
  const WeightRun run(GetParam(), "silo",
                      given("columns 8, layers 8, strain 1e-4, ramp 1000, samples_of_strain 5"));
  run.expect_energy_balance(2e-4);
}

INSTANTIATE_TEST_SUITE_P(Engines, OwnWeight, ::testing::Values("liggghts", "lammps"));

/// A heap that is left when the wall has gone.
struct Heap {
  double angle = 0.0;      ///< degrees
  double wall_force = 0.0; ///< N, at the end
  double energy_error = 0.0;
};

/// The heap of 105 balls, coarse, soft and fast, with ten times the inertial number of the default.
Heap heap(const std::string &engine, const Variables &variables) {
  const Scratch scratch;
  Variables all = variables; // the engine takes the first of a name
  all = with(all, given("columns 8, layers 14, samples_of_strain 30, inertial_number 8e-3, k 1e6, out out"));
  well(run_deck(chain_deck(std::string("../soil/in.repose") + (engine == "lammps" ? ".lammps" : "")), all,
                scratch.path()));
  const post::Table surface = post::read_table(scratch / "out/surface.csv"),
                    rows = post::read_table(scratch / "out/repose.csv");
  const std::vector<double> x = surface.numbers("x_m"), height = surface.numbers("height_m");
  std::vector<double> x_of_slope, slope;
  Heap result;
  for (std::size_t n = 0; n < x.size(); ++n) {
    if (height[n] < 0.04) continue; // a ball: the floor before the wall
    x_of_slope.push_back(x[n]);
    slope.push_back(height[n]);
  }
  result.angle = -180 / pi * std::atan(post::fit_line(x_of_slope, slope).slope.mean);
  result.wall_force = rows.numbers("side_force_N").back();
  result.energy_error = rows.numbers("energy_error").back();
  return result;
}

// Balls without friction on a smooth floor lie level, within a ball over the length of the surface, and press
// on the wall.
TEST(Repose, IsLevelWithoutFriction) {
  const Heap level = heap("liggghts", given("friction 0, rolling 0, floor plate, layers 12, strain 0.8"));
  const double length = 0.39 + 0.8 * 0.34; // m, between the walls at the end
  EXPECT_LT(std::fabs(level.angle), 180 / pi * 0.04 / length);
  EXPECT_GT(level.wall_force, 0);
}

// The slope stands without the wall, and is not steeper than friction allows: atan 0.8 = 39 degrees, and a
// few degrees for so few balls.
TEST(Repose, GrowsWithFriction) {
  const Heap smooth = heap("liggghts", given("friction 0.2, rolling 0.05")), rough = heap("liggghts", {});
  for (const Heap &one : {rough, smooth}) {
    EXPECT_EQ(one.wall_force, 0);
    EXPECT_LT(std::fabs(one.energy_error), 1e-3);
    EXPECT_GT(one.angle, 10);
    EXPECT_LT(one.angle, 45);
  }
  EXPECT_GT(rough.angle, smooth.angle + 3);
  if (!post::has_lammps()) return;
  const Heap in_lammps = heap("lammps", {});
  EXPECT_EQ(in_lammps.wall_force, 0);
  EXPECT_NEAR(in_lammps.angle, rough.angle, 10);
}

} // namespace own_weight

} // namespace
} // namespace drumlin::test
