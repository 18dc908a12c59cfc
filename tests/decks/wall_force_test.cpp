// The reports of the walls: force, torque, stress and wear of a mesh, force on each ball, force of a wall,
// against the momentum that the balls gain.
#include "tests/support/engine_runs.h"

namespace drumlin::test {
namespace {

constexpr double dt = 2e-5, g = 9.81;
// Columns of the table that wall_force.scene prints: step, mass, momentum, force of the walls on the balls;
// then, of a mesh, its force, torque and the place of the balls' centre of mass.
constexpr std::size_t mass_column = 1, momentum = 2, force = 5, mesh_force = 8, torque = 11, place = 14;
using Table = std::vector<std::vector<double>>;

/// The lines of a run's output that are rows of its table.
Table table_of(const std::string &output, std::size_t columns) {
  Table rows;
  for (const std::string &line : lines_of(output)) {
    std::istringstream in(line);
    std::vector<double> row;
    for (double value; in >> value;)
      row.push_back(value);
    if (in.eof() && row.size() == columns) rows.push_back(row);
  }
  return rows;
}

/// The momentum that the reports of the walls add up to, less the one that the balls have gained, over the
/// sum of the absolute values of the reports' impulses: the largest of the three components. \param column of
/// the force's x, \param sign 1 if it is the force on the balls
double missing_momentum(const Table &rows, std::size_t column, double sign) {
  double worst = 0;
  const std::vector<double> &first = rows.front(), &last = rows.back();
  for (std::size_t a = 0; a < 3; ++a) {
    double given = 0, all = 0;
    for (const std::vector<double> &row : rows) {
      const double impulse = dt * row.at(column + a) * (&row == &first || &row == &last ? 0.5 : 1.0);
      given += sign * impulse;
      all += std::fabs(impulse);
    }
    if (a == 2) given -= g * first.at(mass_column) * dt * static_cast<double>(rows.size() - 1);
    const double missing = std::fabs(given - (last.at(momentum + a) - first.at(momentum + a)));
    worst = std::max(worst, all > 0 ? missing / all : missing);
  }
  return worst;
}

const Variables mesh_with_stress = given("mesh 1, surface mesh/surface/stress");

class WallForce : public BothEngines {};
INSTANTIATE_TEST_SUITE_P(Decks, WallForce, engines_and_steppings(), engine_and_stepping);

/// Heavily damped heaps, whose contacts are solved for together, and balls that come and go: with planes, a
/// moving mesh (LIGGGHTS) and the faces of a region (LAMMPS).
TEST_P(WallForce, IsTheMomentumThatTheWallsGive) {
  const bool lammps = std::get<0>(GetParam()) == "lammps";
  const Variables faces = lammps ? Variables{{"walls", "block"}} : mesh_with_stress;
  for (const Variables &law : {given("normal hooke, transition B, rolling epsd2"),
                               given("normal hooke, transition A, tangential history"),
                               given("normal hertz, transition A, rolling epsd2"),
                               given("normal hertz, transition B, tangential off")})
    for (const char *D : {"0.3", "3", "20"}) {
      if (std::get<1>(GetParam()) == "stock" && std::string(D) == "20")
        continue; // beyond its stability limit
      for (const Variables &walls : {Variables{}, faces}) {
        const Scratch folder;
        write_floor(folder / "floor.stl", 0.4, false);
        const Outcome outcome =
            well(run("wall_force", folder, with(with(law, walls), given("D {}, store yes", D))));
        const bool mesh = !lammps && !walls.empty();
        const Table rows = table_of(outcome.output, mesh ? 17 : 8);
        ASSERT_EQ(rows.size(), 3001u) << outcome.output;
        const std::string what =
            law[0].second + ' ' + law[1].second + ' ' + D + (walls.empty() ? "" : ", faces");
        EXPECT_LT(missing_momentum(rows, force, 1), 1e-12) << what;
        if (mesh) {
          EXPECT_LT(missing_momentum(rows, mesh_force, -1), 1e-12) << what;
        }
      }
    }
}

TEST(WallForceOnRanks, IsThatOnOne) {
  for (const auto &[engine, newton] :
       {std::pair("liggghts", "off"), std::pair("lammps", "off"), std::pair("lammps", "on")}) {
    const bool lammps = std::string(engine) == "lammps";
    if (lammps && !post::has_lammps()) continue;
    const Variables walls = lammps ? Variables{} : mesh_with_stress;
    Table one;
    for (const int ranks : {1, 2}) {
      const Scratch folder;
      write_floor(folder / "floor.stl", 0.4, false);
      const Outcome outcome = well(
          run_scene(engine, "wall_force", with(walls, given("newton {}, rolling epsd2, store yes", newton)),
                    folder.path(), ranks));
      const Table rows = table_of(outcome.output, lammps ? 8 : 17);
      ASSERT_EQ(rows.size(), 3001u) << outcome.output;
      EXPECT_LT(missing_momentum(rows, force, 1), 1e-12) << engine << ", ranks " << ranks;
      if (ranks == 1) one = rows;
      for (std::size_t n = 0; n < rows.size(); n += 100)
        for (std::size_t column = force; column < rows[n].size(); ++column)
          EXPECT_NEAR(rows[n][column], one[n][column], 1e-6 * (1 + std::fabs(one[n][column])))
              << engine << ", newton " << newton << ", step " << n << ", column " << column;
    }
  }
}

/// A ball on a mesh that throws it up in each period: the force on the mesh is its weight, on average over
/// whole periods.
TEST(ForceOnAMesh, IsTheWeightOfAShakenBallOnAverage) {
  constexpr std::size_t period = 2500;
  for (const char *normal : {"hooke", "hertz"})
    for (const char *D : {"5", "20", "200"}) {
      const Scratch folder;
      write_floor(folder / "floor.stl", 0.4, false);
      const Outcome outcome = well(run_scene(
          "liggghts", "wall_force",
          with(mesh_with_stress,
               given("alone 1, normal {}, D {}, amplitude 2e-3, steps 30000, store yes", normal, D)),
          folder.path()));
      const Table rows = table_of(outcome.output, 17);
      ASSERT_EQ(rows.size(), 12 * period + 1);
      double mean = 0;
      for (std::size_t n = 8 * period; n < 12 * period; ++n)
        mean += rows[n][mesh_force + 2] / static_cast<double>(4 * period);
      EXPECT_NEAR(-mean / (g * rows[0][mass_column]), 1.0, 1e-5) << normal << ", D " << D;
    }
}

/// Numbers of the last entry NAME of a VTK file of the mesh, one for each triangle.
std::vector<double> of_triangles(const std::string &text, const std::string &name) {
  std::istringstream in(text.substr(text.rfind(name + ' ') + name.size()));
  int components = 0, count = 0;
  std::string type;
  in >> components >> count >> type;
  std::vector<double> values(static_cast<std::size_t>(count));
  for (double &value : values)
    in >> value;
  return values;
}

/// One ball that slides on a mesh at rest: the torque about the origin is that of the force at the contact,
/// stress times area is the force, and the wear is Finnie's law with this force and the velocity with which
/// the engine computes forces.
TEST(ForceOnAMesh, GivesItsTorqueStressAndWear) {
  constexpr double area = 0.5 * 0.8 * 0.8, k_finnie = 1e-3;
  constexpr int steps = 600;
  for (const char *stepping : {"second", "stock"}) {
    const Scratch folder;
    write_floor(folder / "floor.stl", 0.4, false);
    const Outcome outcome = well(run_scene(
        "liggghts", "wall_force",
        with(mesh_with_stress, given("alone 1, stepping {}, D {}, amplitude 0, place move 0.2 0.15 0 wear "
                                     "finnie, steps {}, store yes",
                                     stepping, std::string(stepping) == "second" ? "200" : "5", steps)),
        folder.path()));
    const Table rows = table_of(outcome.output, 17);
    ASSERT_EQ(rows.size(), static_cast<std::size_t>(steps) + 1) << outcome.output;
    double wear = 0;
    int touching = 0;
    for (std::size_t n = 1; n < rows.size(); ++n) {
      const std::vector<double> &row = rows[n], &last = rows[n - 1];
      const double *f = row.data() + mesh_force, *x = row.data() + place;
      const double size = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
      if (size == 0) continue;
      ++touching;
      const double expected[3] = {x[1] * f[2], -x[0] * f[2], x[0] * f[1] - x[1] * f[0]};
      for (std::size_t a = 0; a < 3; ++a)
        ASSERT_NEAR(row[torque + a], expected[a], 1e-12 * size) << stepping << ", step " << n;
      // The velocity at the middle of the step: that of the step's path, but for the first two steps of the
      // contact, whose path has a position correction.
      std::array<double, 3> v{};
      for (std::size_t a = 0; a < 3; ++a) {
        const double weight = a == 2 ? g * row[mass_column] : 0;
        v.at(a) = touching == 1   ? (last[momentum + a] - 0.5 * dt * weight) / row[mass_column]
                  : touching == 2 ? (row[momentum + a] + 0.5 * dt * (f[a] + weight)) / row[mass_column]
                                  : (x[a] - last[place + a]) / dt;
        if (touching > 2) {
          // The force that changes this velocity to the one at the end of the step.
          const double from_motion = 2 / dt * (row[mass_column] * v.at(a) - row[momentum + a]) - weight;
          EXPECT_NEAR(f[a], from_motion, 1e-6 * size + 1e-6) << stepping << ", step " << n;
        }
      }
      if (v[2] > 0) continue;
      const double speed = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      const double sine = std::fabs(v[2]) / speed, cosine = std::sqrt(1 - sine * sine);
      const double E = 3 * sine > cosine ? 0.33333 * cosine * cosine : 2 * sine * cosine - 3 * sine * sine;
      wear += 2 * E * k_finnie * speed * size * dt / area;
    }
    EXPECT_GT(touching, 300) << stepping;
    const std::string file = read_text(folder / ("triangles_" + std::to_string(steps) + ".vtk"));
    const std::vector<double> normal = of_triangles(file, "normal_stress_average"),
                              worn = of_triangles(file, "wear");
    ASSERT_EQ(normal.size(), 2u);
    EXPECT_NEAR((normal[0] + normal[1]) * area / -rows.back()[mesh_force + 2], 1.0, 1e-5) << stepping;
    EXPECT_NEAR((worn[0] + worn[1]) / wear, 1.0, 1e-4) << stepping;
  }
}

} // namespace
} // namespace drumlin::test
