// Coarse-grained fields of a bed: lattices and columns whose fields are known, and quantities that must be
// conserved in any bed.
#include "tests/support/prelude.h"
#include "bed/coarse_graining.h"

namespace drumlin::test {
namespace {

using post::Ball;
using post::BallContact;
using post::BedFields;
using post::Bounds;
using post::FieldGrid;
using post::Vector;

constexpr double pi = 3.141592653589793;

/// A contact between the centres of two balls.
BallContact between(const std::vector<Ball> &balls, std::size_t i, std::size_t j, const Vector &force,
                    double overlap = 0.0) {
  const Vector &to = balls[i].position, &from = balls[j].position;
  return {i, j, {to[0] - from[0], to[1] - from[1], to[2] - from[2]}, force, overlap};
}

struct Bed {
  std::vector<Ball> balls;
  std::vector<BallContact> contacts;
};

Ball ball_at(const Vector &place, double radius) {
  Ball ball;
  ball.position = place;
  ball.radius = radius;
  ball.mass = 3.0;
  return ball;
}

/// N balls along each axis that just touch, and push each other with one force along the normals.
Bed lattice(std::size_t n, double radius, double force, bool flat) {
  Bed bed;
  const double a = 2.0 * radius;
  const std::size_t nz = flat ? 1 : n;
  const auto at = [n](std::size_t x, std::size_t y, std::size_t z) { return (z * n + y) * n + x; };
  for (std::size_t z = 0; z < nz; ++z)
    for (std::size_t y = 0; y < n; ++y)
      for (std::size_t x = 0; x < n; ++x) {
        const auto middle = [a](std::size_t i) { return a * (static_cast<double>(i) + 0.5); };
        bed.balls.push_back(ball_at({middle(x), middle(y), flat ? 0.0 : middle(z)}, radius));
        const std::size_t here = at(x, y, z);
        // the force on the ball with the lower coordinate points down the axis
        if (x + 1 < n) bed.contacts.push_back({here, at(x + 1, y, z), {-a, 0, 0}, {-force, 0, 0}, 0.0});
        if (y + 1 < n) bed.contacts.push_back({here, at(x, y + 1, z), {0, -a, 0}, {0, -force, 0}, 0.0});
        if (z + 1 < nz) bed.contacts.push_back({here, at(x, y, z + 1), {0, 0, -a}, {0, 0, -force}, 0.0});
      }
  return bed;
}

FieldGrid grid_of(const std::vector<Ball> &balls, double side, bool flat) {
  Bounds bounds;
  for (const Ball &ball : balls)
    bounds.add(ball);
  return post::fitted_grid(bounds, side, flat);
}

TEST(BedFields, OfASquareLatticeOfDiscs) {
  const double r = 0.02, force = 50.0;
  const Bed bed = lattice(20, r, force, true);
  const FieldGrid grid = grid_of(bed.balls, 8.0 * r, true);
  ASSERT_EQ(grid.cells, (std::array<std::size_t, 3>{5, 5, 1}));
  const BedFields fields = post::coarse_grained(bed.balls, bed.contacts, grid);
  for (std::size_t cell = 0; cell < grid.size(); ++cell) { // the same up to the edge
    EXPECT_NEAR(fields.solid_fraction[cell], pi / 4.0, 1e-12) << cell;
    EXPECT_NEAR(fields.bulk_density[cell], 3.0 / (4.0 * r * r), 1e-8) << cell;
  }
  const std::size_t inside = 2 * 5 + 2;
  EXPECT_NEAR(fields.coordination[inside], 4.0, 1e-12);
  const double a = 2.0 * r; // per metre out of the plane a contact bears force / a
  const post::Tensor stress = {force / a, 0, 0, 0, force / a, 0, 0, 0, 0},
                     fabric = {0.5, 0, 0, 0, 0.5, 0, 0, 0, 0};
  for (std::size_t c = 0; c < 9; ++c) {
    EXPECT_NEAR(fields.stress[inside][c], stress[c], 1e-9) << c;
    EXPECT_NEAR(fields.fabric[inside][c], fabric[c], 1e-12) << c;
  }
  EXPECT_NEAR(fields.pressure[inside], force / a, 1e-9);
}

TEST(BedFields, OfACubicLatticeOfSpheres) {
  const double r = 0.02, force = 50.0;
  const Bed bed = lattice(9, r, force, false);
  const FieldGrid grid = grid_of(bed.balls, 6.0 * r, false);
  ASSERT_EQ(grid.size(), 27U);
  const BedFields fields = post::coarse_grained(bed.balls, bed.contacts, grid);
  for (const double fraction : fields.solid_fraction)
    EXPECT_NEAR(fraction, pi / 6.0, 1e-12);
  const double a = 2.0 * r;
  for (std::size_t c = 0; c < 9; ++c) {
    EXPECT_NEAR(fields.stress[13][c], c % 4 == 0 ? force / (a * a) : 0.0, 1e-7) << c;
    EXPECT_NEAR(fields.fabric[13][c], c % 4 == 0 ? 1.0 / 3.0 : 0.0, 1e-12) << c;
  }
  EXPECT_NEAR(fields.pressure[13], force / (a * a), 1e-7);
  EXPECT_NEAR(fields.coordination[13], 6.0, 1e-12);
}

// A column of N discs under its own weight: at the height y the weight of what is above passes, (N - y/2r) m
// g, on a width of 2r.
TEST(BedFields, StressInAColumnIsTheWeightAbove) {
  const double r = 0.05, g = 9.81;
  const std::size_t n = 24;
  Bed bed;
  for (std::size_t k = 0; k < n; ++k)
    bed.balls.push_back(ball_at({0.3, r * (2.0 * static_cast<double>(k) + 1.0), 0.0}, r));
  const double weight = bed.balls[0].mass * g;
  for (std::size_t k = 0; k + 1 < n; ++k) // named with the upper ball first: the force on it points up
    bed.contacts.push_back(between(bed.balls, k + 1, k, {0.0, weight * static_cast<double>(n - 1 - k), 0.0}));
  const FieldGrid grid = grid_of(bed.balls, 8.0 * r, true); // six cells above each other, one ball wide
  ASSERT_EQ(grid.cells, (std::array<std::size_t, 3>{1, 6, 1}));
  const BedFields fields = post::coarse_grained(bed.balls, bed.contacts, grid);
  double integral = 0.0;
  for (std::size_t cell = 0; cell < 6; ++cell) {
    const double y = grid.sides[1] * (static_cast<double>(cell) + 0.5);
    const double expected = (static_cast<double>(n) - y / (2.0 * r)) * weight / (2.0 * r);
    if (cell > 0 && cell < 5) {
      EXPECT_NEAR(fields.stress[cell][4], expected, 1e-9 * expected) << cell;
    }
    integral += fields.stress[cell][4] * grid.cell_volume();
    for (const std::size_t c : {0U, 1U, 3U})
      EXPECT_EQ(fields.stress[cell][c], 0.0);
  }
  const double sum = weight * 2.0 * r * static_cast<double>(n * (n - 1)) / 2.0; // of f l
  EXPECT_NEAR(integral, sum, 1e-12 * sum);
}

/// Balls and contacts at random, among them a drum, a frame, and forces of any direction.
Bed random_bed(bool flat) {
  std::mt19937 bits(7);
  const auto number = [&bits](double low, double high) {
    return low + (high - low) * static_cast<double>(bits()) / 4294967296.0;
  };
  Bed bed;
  for (long id = 1; id <= 300; ++id) {
    Ball ball =
        ball_at({number(-1.0, 1.0), number(0.0, 0.5), flat ? 0.0 : number(2.0, 3.0)}, number(0.01, 0.03));
    ball.id = id;
    ball.mass = number(1.0, 5.0);
    for (double &component : ball.velocity)
      component = number(-1.0, 1.0);
    if (id == 100) ball.type = post::drum_type;
    if (id == 200) ball.type = post::frame_type;
    bed.balls.push_back(ball);
  }
  for (std::size_t i = 0; i + 1 < bed.balls.size(); ++i)
    bed.contacts.push_back(between(
        bed.balls, i, i + 1, {number(-9.0, 9.0), number(-9.0, 9.0), flat ? 0.0 : number(-9.0, 9.0)}, 1e-4));
  return bed;
}

TEST(BedFields, SumsOverTheCellsAreSumsOverTheSoil) {
  for (const bool flat : {true, false}) {
    const Bed bed = random_bed(flat);
    const FieldGrid grid = grid_of(bed.balls, 0.13, flat);
    const BedFields fields = post::coarse_grained(bed.balls, bed.contacts, grid);
    double volume = 0.0, mass = 0.0;
    Vector momentum{};
    post::Tensor force_branch{};
    const auto is_soil = [&bed](std::size_t i) { return bed.balls[i].type == post::soil_type; };
    for (const Ball &ball : bed.balls) {
      if (ball.type != post::soil_type) continue;
      volume += flat ? pi * std::pow(ball.radius, 2) : 4.0 / 3.0 * pi * std::pow(ball.radius, 3);
      mass += ball.mass;
      for (std::size_t a = 0; a < 3; ++a)
        momentum[a] += ball.mass * ball.velocity[a];
    }
    std::size_t left_out = 0;
    for (const BallContact &contact : bed.contacts) {
      if (!is_soil(contact.i) || !is_soil(contact.j)) {
        ++left_out;
        continue;
      }
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          force_branch[3 * i + j] +=
              contact.force[i] * (bed.balls[contact.i].position[j] - bed.balls[contact.j].position[j]);
    }
    ASSERT_EQ(left_out, 4U);
    double found_volume = 0.0, found_mass = 0.0;
    Vector found_momentum{};
    post::Tensor found{};
    for (std::size_t cell = 0; cell < grid.size(); ++cell) {
      const double v = grid.cell_volume();
      found_volume += fields.solid_fraction[cell] * v;
      found_mass += fields.bulk_density[cell] * v;
      for (std::size_t a = 0; a < 3; ++a)
        found_momentum[a] += fields.bulk_density[cell] * fields.velocity[cell][a] * v;
      for (std::size_t c = 0; c < 9; ++c)
        found[c] += fields.stress[cell][c] * v;
    }
    EXPECT_NEAR(found_volume, volume, 1e-12 * volume);
    EXPECT_NEAR(found_mass, mass, 1e-12 * mass);
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_NEAR(found_momentum[a], momentum[a], 1e-12 * mass);
    for (std::size_t c = 0; c < 9; ++c)
      EXPECT_NEAR(found[c], force_branch[c], 1e-10) << c;
  }
}

TEST(BedFields, ABallAloneIsSharedByItsFourCells) {
  const FieldGrid grid = post::fitted_grid({{0, 0, 0}, {4, 4, 0}}, 1.0, true);
  const auto fraction = [&grid](double x, double y) {
    return post::coarse_grained({ball_at({x, y, 0.0}, 1.0 / std::sqrt(pi))}, {}, grid).solid_fraction;
  };
  const std::vector<double> shared =
      fraction(1.75, 2.6); // a quarter of the way from the cell 1 to 2, a tenth from 2 to 3
  EXPECT_NEAR(shared[2 * 4 + 1], 0.75 * 0.9, 1e-14);
  EXPECT_NEAR(shared[2 * 4 + 2], 0.25 * 0.9, 1e-14);
  EXPECT_NEAR(shared[3 * 4 + 1], 0.75 * 0.1, 1e-14);
  EXPECT_NEAR(shared[3 * 4 + 2], 0.25 * 0.1, 1e-14);
  EXPECT_DOUBLE_EQ(fraction(0.1, 0.2)[0], 1.0); // all to the last one at the edge
  EXPECT_DOUBLE_EQ(fraction(4.0, 4.0)[15], 1.0);
  for (const double value : fraction(4.01, 2.0)) // outside
    EXPECT_EQ(value, 0.0);
}

// The contact of a small and a large ball is where they touch, not halfway between the centres.
TEST(BedFields, AContactIsAtTheMiddleOfItsOverlap) {
  const std::vector<Ball> balls = {ball_at({2.5, 0.5, 0.0}, 0.5), ball_at({0.5, 0.5, 0.0}, 1.6)};
  const FieldGrid grid = post::fitted_grid({{0, 0, 0}, {4, 1, 0}}, 1.0, true);
  const BedFields fields = post::coarse_grained(balls, {between(balls, 0, 1, {7.0, 3.0, 0.0}, 0.1)}, grid);
  const double place = 0.5 + 1.6 - 0.05; // 2.05: 0.45 from the middle of cell 2, 0.55 from that of cell 1
  EXPECT_NEAR(fields.stress[2][0], 7.0 * 2.0 * (place - 1.5), 1e-13);
  EXPECT_NEAR(fields.stress[1][0], 7.0 * 2.0 * (2.5 - place), 1e-13);
  EXPECT_NEAR(fields.stress[2][3], 3.0 * 2.0 * (place - 1.5), 1e-13); // f_y l_x
  EXPECT_EQ(fields.stress[2][1], 0.0);                                // f_x l_y
  EXPECT_EQ(fields.stress[0][0], 0.0);
}

TEST(BedFields, VelocityIsTheMeanByMass) {
  std::vector<Ball> balls = {ball_at({0.5, 0.5, 0.0}, 0.1), ball_at({0.5, 0.5, 0.0}, 0.1)};
  balls[0].mass = 1.0;
  balls[0].velocity = {4.0, 0.0, 0.0};
  balls[1].mass = 3.0;
  balls[1].velocity = {0.0, 8.0, 0.0};
  const FieldGrid grid = post::fitted_grid({{0, 0, 0}, {2, 1, 0}}, 1.0, true);
  const BedFields fields = post::coarse_grained(balls, {}, grid);
  EXPECT_EQ(fields.velocity[0], (Vector{1.0, 6.0, 0.0}));
  EXPECT_EQ(fields.velocity[1], (Vector{0.0, 0.0, 0.0})); // nothing there
}

TEST(Contacts, AreCountedForBothBallsAndTheirForceHasTwoParts) {
  const std::vector<Ball> balls = {ball_at({3.0, 4.0, 0.0}, 2.6), ball_at({0.0, 0.0, 0.0}, 2.6),
                                   ball_at({0, 9, 0}, 1.0)};
  const BallContact contact =
      between(balls, 0, 1, {3.0 * 2.0 - 4.0, 4.0 * 2.0 + 3.0, 0.0}, 0.2); // 10 along, 5 across
  EXPECT_NEAR(post::force_parts(contact).normal, 10.0, 1e-14);
  EXPECT_NEAR(post::force_parts(contact).tangential, 5.0, 1e-14);
  BallContact pulls = contact;
  pulls.force = {-3.0, -4.0, 0.0};
  EXPECT_NEAR(post::force_parts(pulls).normal, -5.0, 1e-14);
  EXPECT_NEAR(post::force_parts(pulls).tangential, 0.0, 1e-14);
  EXPECT_EQ(post::coordination(3, {contact, between(balls, 0, 2, {})}), (std::vector<int>{2, 1, 1}));
}

// By hand: -f . r of a contact is its normal force times the distance from the centre to the middle of the
// overlap.
TEST(BallPressure, OfTwoBallsAndAFloor) {
  for (const bool flat : {true, false}) {
    const double z = flat ? 0.0 : 1.0, d = flat ? 2.0 : 3.0;
    const std::vector<Ball> balls = {ball_at({0.0, 0.0, z}, 2.0), ball_at({1.74, 2.32, z}, 1.0)}; // 2.9 apart
    const double volume0 = flat ? 4.0 * pi : 32.0 / 3.0 * pi, volume1 = flat ? pi : 4.0 / 3.0 * pi;
    const Vector force = {-0.6 * 10.0 + 0.8 * 5.0, -0.8 * 10.0 - 0.6 * 5.0,
                          0.0}; // on the first: 10 along, 5 across
    const BallContact contact = between(balls, 0, 1, force, 0.1);
    const std::vector<double> pressed = post::ball_pressures(balls, {{contact}, {}});
    EXPECT_NEAR(pressed[0], 10.0 * 1.95 / (d * volume0), 1e-14);
    EXPECT_NEAR(pressed[1], 10.0 * 0.95 / (d * volume1), 1e-14);
    BallContact pulls = contact;
    for (double &component : pulls.force)
      component = -component;
    EXPECT_NEAR(post::ball_pressures(balls, {{pulls}, {}})[1], -10.0 * 0.95 / (d * volume1), 1e-14);
    const post::WallContact floor = {0, {3.0, 30.0, 0.0}, {0.0, 1.0, 0.0}, 0.25};
    EXPECT_NEAR(post::ball_pressures(balls, {{}, {floor}})[0], 30.0 * 1.75 / (d * volume0), 1e-14);
  }
}

// A ball in a column carries the weight of the balls above at its top, and at its foot also its own.
TEST(BallPressure, OfAColumnUnderGravityGrowsWithDepth) {
  const double radius = 0.02, density = 2600.0, gravity = 9.81;
  const std::size_t n = 7;
  for (const bool flat : {true, false}) {
    post::BedContacts contacts;
    std::vector<Ball> balls; // from the floor up
    for (std::size_t b = 0; b < n; ++b)
      balls.push_back(
          ball_at({0.0, (2.0 * static_cast<double>(b) + 1.0) * radius, flat ? 0.0 : 1.0}, radius));
    const double volume = flat ? pi * radius * radius : 4.0 / 3.0 * pi * radius * radius * radius;
    const double weight = density * volume * gravity;
    for (std::size_t b = 0; b + 1 < n; ++b)
      contacts.balls.push_back(
          between(balls, b, b + 1, {0.0, -weight * static_cast<double>(n - 1 - b), 0.0}));
    contacts.walls.push_back({0, {0.0, weight * static_cast<double>(n), 0.0}, {0.0, 1.0, 0.0}, 0.0});
    const std::vector<double> found = post::ball_pressures(balls, contacts);
    for (std::size_t b = 0; b < n;
         ++b) { // only the vertical stress, density gravity depth at the centre, times 2 r area / V
      const double depth = (2.0 * static_cast<double>(n - b) - 1.0) * radius;
      EXPECT_NEAR(found[b], density * gravity * depth / (flat ? 2.0 : 3.0), 1e-10) << b;
    }
  }
}

TEST(FieldGrid, FitsWholeCellsIntoTheBounds) {
  const FieldGrid grid = post::fitted_grid({{-1.0, 0.5, -3.0}, {1.1, 1.4, 3.0}}, 0.4, true);
  EXPECT_EQ(grid.cells, (std::array<std::size_t, 3>{5, 2, 1}));
  EXPECT_DOUBLE_EQ(grid.sides[0], 0.42);
  EXPECT_DOUBLE_EQ(grid.sides[1], 0.45);
  EXPECT_DOUBLE_EQ(grid.cell_volume(), 0.42 * 0.45); // 1 m thick
  EXPECT_EQ(grid.origin, (Vector{-1.0, 0.5, 0.0}));
  EXPECT_EQ(post::fitted_grid({{0, 0, 0}, {1, 1, 1}}, 50.0, false).size(), 1U);
  EXPECT_EQ(post::fitted_grid({{0, 0, 0}, {1, 2, 3}}, 0.1, false).cells,
            (std::array<std::size_t, 3>{10, 20, 30}));
  for (const double tiny : {1e-4, 1e-200, 1e-320})
    EXPECT_THROW(post::fitted_grid({{0, 0, 0}, {1, 1, 1}}, tiny, true), std::invalid_argument) << tiny;
}

} // namespace
} // namespace drumlin::test
