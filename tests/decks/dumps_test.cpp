// The dumps of a bed on which a drum falls: the engine's files, and those that ./drumlin vtk makes from them
// for ParaView.
#include "tests/support/engine_runs.h"
#include "bed/dump_readers.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

constexpr int balls = 152; // with drum and frame
constexpr double width = 0.6, gravity = 9.81;
const std::vector<long> steps = {0, 250, 500, 750};

/// 150 soil balls in a box of 0.6 m, settled once for all tests, under either stepping.
class Dumps : public ::testing::Test {
protected:
  static void SetUpTestSuite() {
    scratch = std::make_unique<Scratch>();
    well(run_program(tool_words("bed --balls 150 --width 0.6 --out balls.data"), {}, scratch->path()));
    for (const std::string stepping : {"stock", "second"}) {
      well(run_deck(decks() / "in.settle",
                    given("case loose, balls balls.data, bed {}, stepping {}", stepping, stepping),
                    scratch->path()));
    }
  }
  static void TearDownTestSuite() { scratch.reset(); }

  static fs::path decks() { return fs::path(DRUMLIN_SOURCE_DIR) / "inputs/bed"; }

  static void run(const Scratch &folder, const Variables &more, int ranks = 1) {
    std::string stepping = "stock";
    for (const auto &[name, value] : more)
      if (name == "stepping") stepping = value;
    const Variables variables =
        with(more, given("bed {}, here {}", (scratch->path() / stepping).string(), decks().string()));
    well(run_deck(test_deck("dumps.in"), variables, folder.path(), ranks));
  }

  /// A run with dumps, and the files that ./drumlin vtk makes from them.
  static void run_and_convert(const Scratch &folder, int ranks) {
    run(folder, {{"dump_every", "250"}}, ranks);
    well(run_program({DRUMLIN_TOOLS, "vtk", folder.path().string()}, {}, folder.path()));
  }

  static std::unique_ptr<Scratch> scratch;
};
std::unique_ptr<Scratch> Dumps::scratch;

std::string step_file(const char *name, long step, const char *ending = "vtp") {
  return std::string(name) + "_" + std::to_string(step) + "." + ending;
}

template <class Reader>
auto opened(const fs::path &file) {
  EXPECT_TRUE(fs::exists(file)) << file;
  const auto reader = vtkSmartPointer<Reader>::New();
  reader->SetFileName(file.c_str());
  reader->Update();
  return vtkSmartPointer(reader->GetOutput());
}

/// Pairs of ids of balls that overlap, by the positions of the text dump. Drum and frame are excluded from
/// each other.
std::set<std::pair<long, long>> overlapping(const Frame &frame, const std::vector<post::Ball> &sizes) {
  std::set<std::pair<long, long>> pairs;
  for (const post::Ball &a : sizes)
    for (const post::Ball &b : sizes) {
      if (a.id >= b.id || (a.type > 1 && b.type > 1)) continue;
      const auto &x = frame.balls.at(a.id).x, &y = frame.balls.at(b.id).x;
      if (std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]) < a.radius + b.radius) pairs.emplace(a.id, b.id);
    }
  return pairs;
}

post::BedContacts contacts_of(const Scratch &folder, long step, const std::vector<post::Ball> &found) {
  return post::read_contact_dump(folder.path() / "dump" / step_file("contacts", step, "dump"), found);
}

void expect_true_dumps(const Scratch &folder) {
  const std::vector<Frame> frames = read_dump(folder / "state.dump");
  ASSERT_EQ(frames.size(), steps.size());
  for (const Frame &frame : frames) {
    const auto found = post::read_ball_dump(folder.path() / "dump" / step_file("balls", frame.step));
    ASSERT_EQ(found.size(), static_cast<std::size_t>(balls));
    for (const post::Ball &ball : found) {
      const Ball &reference = frame.balls.at(ball.id);
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_NEAR(ball.position[a], reference.x[a], 6e-8); // a float
        EXPECT_EQ(ball.velocity[a], reference.v[a]);
        EXPECT_EQ(ball.spin[a], reference.omega[a]);
        EXPECT_EQ(ball.force[a], reference.f[a]);
      }
    }
    const post::BedContacts contacts = contacts_of(folder, frame.step, found);
    std::set<std::pair<long, long>> pairs;
    for (const post::BallContact &contact : contacts.balls) {
      pairs.emplace(found[contact.i].id, found[contact.j].id);
      EXPECT_GT(contact.overlap, 0.0);
      const auto &x = frame.balls.at(found[contact.i].id).x, &y = frame.balls.at(found[contact.j].id).x;
      EXPECT_NEAR(contact.overlap,
                  found[contact.i].radius + found[contact.j].radius -
                      std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]),
                  1e-15);
    }
    EXPECT_EQ(pairs.size(), contacts.balls.size());
    EXPECT_EQ(pairs, overlapping(frame, found)) << "step " << frame.step;
    EXPECT_GT(pairs.size(), 50U);

    std::multiset<std::pair<long, double>> on_walls, beyond_walls; // ball, overlap in whole 1e-12 m
    for (const post::WallContact &contact : contacts.walls) {
      const post::Ball &ball = found[contact.i];
      on_walls.emplace(ball.id, std::round(1e12 * contact.overlap));
      const post::Vector foot = post::foot(ball, contact);
      EXPECT_NEAR(std::fabs(contact.normal[0]) > 0.5 ? std::fabs(foot[0]) - 0.5 * width : foot[1], 0.0, 6e-8);
      EXPECT_GT(contact.normal[0] * (0.0 - foot[0]) + contact.normal[1] * (1.0 - foot[1]), 0.0); // inwards
    }
    for (const post::Ball &ball : found) {
      const auto &x = frame.balls.at(ball.id).x;
      for (const double distance : {0.5 * width + x[0], 0.5 * width - x[0], x[1]})
        if (distance < ball.radius)
          beyond_walls.emplace(ball.id, std::round(1e12 * (ball.radius - distance)));
    }
    EXPECT_EQ(on_walls, beyond_walls) << "step " << frame.step;
    EXPECT_GT(on_walls.size(), 15U);
  }
}

TEST_F(Dumps, HoldEveryBallAndEveryContactOnce) {
  const Scratch folder;
  run(folder, {{"dump_every", "250"}});
  expect_true_dumps(folder);
}

TEST_F(Dumps, HoldEveryBallAndEveryContactOnceOnTwoRanks) {
  const Scratch folder;
  run(folder, {{"dump_every", "250"}}, 2);
  expect_true_dumps(folder);
}

TEST_F(Dumps, OfAGroupAreTheContactsOfItsBalls) {
  const Scratch folder;
  run(folder, given("some 1, dump_every 250"));
  for (const long step : steps) {
    const auto found = post::read_ball_dump(folder.path() / "dump" / step_file("balls", step));
    const post::BedContacts all = contacts_of(folder, step, found);
    std::multiset<std::pair<long, long>> expected, rows;
    const auto add = [](auto &pairs, long a, long b) { pairs.emplace(std::min(a, b), std::max(a, b)); };
    for (const post::BallContact &contact : all.balls)
      if (found[contact.i].id <= 3) add(expected, found[contact.i].id, found[contact.j].id);
    for (const post::WallContact &contact : all.walls)
      if (found[contact.i].id <= 3) add(expected, found[contact.i].id, 0);
    for (const std::vector<double> &row :
         post::read_text_dump(folder.path() / "dump" / step_file("some", step, "dump")).rows)
      add(rows, std::lround(row[0]), std::lround(row[1]));
    EXPECT_EQ(rows, expected) << "step " << step;
    EXPECT_GT(rows.size(), 2U);
  }
}

TEST_F(Dumps, DoNotDisturbTheRun) {
  for (const char *transition : {"A", "B"}) {
    const Scratch with, without;
    run(with, given("transition {}, dump_every 10", transition));
    run(without, {{"transition", transition}});
    EXPECT_FALSE(fs::exists(without / "dump"));
    EXPECT_EQ(read_text(with / "state.dump"), read_text(without / "state.dump")) << transition;
  }
}

TEST_F(Dumps, DoNotDisturbTheRunOnTwoRanks) {
  const Scratch with, without;
  run(with, {{"dump_every", "10"}}, 2);
  run(without, {}, 2);
  EXPECT_EQ(read_text(with / "state.dump"), read_text(without / "state.dump"));
}

TEST_F(Dumps, OfAnEarlierRunAreRemoved) {
  const Scratch folder;
  fs::create_directory(folder / "dump");
  for (const char *name : {"balls_7.vtp", "contacts_7.dump", "balls_boundingBox_7.vtr"})
    std::ofstream(folder / "dump" / name) << "old";
  run(folder, given("dump_every 50, steps 50"));
  std::set<std::string> names;
  for (const auto &entry : fs::directory_iterator(folder / "dump"))
    names.insert(entry.path().filename().string());
  EXPECT_EQ(names,
            (std::set<std::string>{"balls_0.vtp", "balls_50.vtp", "balls_boundingBox_0.vtr",
                                   "balls_boundingBox_50.vtr", "contacts_0.dump", "contacts_50.dump"}));
}

/// Largest difference between the force on a soil ball and the sum of its contact forces, as a share of the
/// largest force. Balls of which a contact is made or broken in the step are left out: under second-order
/// stepping their force includes the impulse of that event.
/// \param contacts of a step; without those of walls, balls near these are not judged
template <class Contacts>
double unexplained(const Scratch &folder, long begin, long end, bool with_walls, const Contacts &contacts) {
  using Touch = std::pair<std::size_t, std::size_t>;
  constexpr std::size_t wall = 1000;
  std::set<Touch> before;
  double most = 0.0, largest = 0.0;
  for (long step = begin; step <= end; ++step) {
    const auto found = post::read_ball_dump(folder.path() / "dump" / step_file("balls", step));
    const post::BedContacts all = contacts(step, found);
    std::vector<post::Vector> rest;
    std::vector<bool> judged;
    for (const post::Ball &ball : found) {
      rest.push_back({ball.force[0], ball.force[1] + ball.mass * gravity, 0.0});
      const double room = ball.radius + 2e-3;
      judged.push_back(ball.type == 1 && (with_walls || (std::fabs(ball.position[0]) < 0.5 * width - room &&
                                                         ball.position[1] > room)));
    }
    std::set<Touch> now;
    for (const post::BallContact &contact : all.balls) {
      now.emplace(contact.i, contact.j);
      for (std::size_t a = 0; a < 2; ++a) {
        rest[contact.i][a] -= contact.force[a];
        rest[contact.j][a] += contact.force[a];
      }
    }
    for (const post::WallContact &contact : all.walls) {
      now.emplace(contact.i, wall + (contact.normal[0] > 0.5 ? 1 : contact.normal[0] < -0.5 ? 2 : 3));
      for (std::size_t a = 0; a < 2; ++a)
        rest[contact.i][a] -= contact.force[a];
    }
    for (const auto *some : {&now, &before})
      for (const auto &[i, j] : *some)
        if (now.count({i, j}) + before.count({i, j}) == 1)
          for (const std::size_t ball : {i, j})
            if (ball < wall) judged[ball] = false;
    if (step > begin)
      for (std::size_t b = 0; b < found.size(); ++b) {
        largest = std::max(largest, std::hypot(found[b].force[0], found[b].force[1]));
        if (judged[b]) most = std::max(most, std::hypot(rest[b][0], rest[b][1]));
      }
    before = now;
  }
  return most / largest;
}

// The forces are the step's own, friction and walls included, with light dashpots and with heavy ones, which
// are solved for together (without friction: heavy dashpots across would be unstable).
TEST_F(Dumps, ForcesOfContactsAreThoseThatActedOnRanksOneAndTwo) {
  const Variables stock = {{"transition", "B"}}, A = given("transition A, stepping second"),
                  B = given("transition B, stepping second"),
                  heavy = given("transition B, stepping second, D 5, friction 0, guard off");
  for (const Variables &scene : {stock, A, B, heavy})
    for (const int ranks : {1, 2}) {
      const Scratch folder;
      // Heavy dashpots: long enough for a ball to be moved out of a contact that barely overlaps.
      const long last = scene == heavy ? 900 : 450;
      const Variables variables = with(scene, given("dump_every 1, steps {}", last));
      run(folder, variables, ranks);
      EXPECT_LT(
          unexplained(folder, 100, last, true,
                      [&folder](long step, const auto &found) { return contacts_of(folder, step, found); }),
          1e-12)
          << scene[0].second << " and " << scene.size() << " variables, ranks " << ranks;
    }
}

// The engine's compute pair/gran/local computes the forces again after the step, with the velocities of the
// dump. Its normal forces must be those of the step, and so must the friction forces of contacts that slide;
// in contacts that stick, the tangential dashpot depends on the velocities.
TEST_F(Dumps, TheEnginesOwnComputeGetsTheForcesOfTheStep) {
  const auto own = [](const Scratch &folder) {
    return [&folder](long step, const auto &) {
      post::BedContacts contacts;
      for (const std::vector<double> &row :
           post::read_text_dump(folder.path() / "dump" / step_file("own", step, "dump")).rows)
        contacts.balls.push_back({static_cast<std::size_t>(row[0]) - 1,
                                  static_cast<std::size_t>(row[1]) - 1,
                                  {},
                                  {row[2], row[3], row[4]},
                                  0.0});
      return contacts;
    };
  };
  for (const char *transition : {"A", "B"}) {
    const Scratch smooth, rough;
    const Variables often =
        given("transition {}, stepping second, own 1, dump_every 1, steps 450", transition);
    const Variables slippery = with(often, {{"friction", "0"}});
    run(smooth, slippery);
    EXPECT_LT(unexplained(smooth, 250, 450, false, own(smooth)), 5e-3) << transition;
    run(rough, often);
    EXPECT_LT(unexplained(rough, 250, 450, false, own(rough)), 2e-2) << transition;
  }
}

// Longer than other functions: it judges all collections of one run, their times, balls, contacts and fields.
void expect_true_results(const Scratch &folder) {
  const std::vector<Frame> frames = read_dump(folder / "state.dump");
  ASSERT_EQ(frames.size(), steps.size());
  const double dt = 2e-5;
  for (const char *name : {"balls", "contacts", "fields"}) {
    const std::string text = read_text(folder.path() / "vtk" / (std::string(name) + ".pvd"));
    static const std::regex entry(R"re(<DataSet timestep="([^"]*)" file="([^"]*)"/>)re");
    std::size_t n = 0;
    for (std::sregex_iterator i(text.begin(), text.end(), entry), end; i != end; ++i, ++n) {
      ASSERT_LT(n, steps.size());
      EXPECT_NEAR(std::stod((*i)[1]), static_cast<double>(steps[n]) * dt, 1e-15);
      EXPECT_EQ((*i)[2], step_file(name, steps[n], std::string(name) == "fields" ? "vti" : "vtp"));
    }
    EXPECT_EQ(n, steps.size()) << name;
  }
  std::array<double, 6> extent{};
  for (const Frame &frame : frames) {
    const auto sizes = post::read_ball_dump(folder.path() / "dump" / step_file("balls", frame.step));
    const auto pairs = overlapping(frame, sizes);
    const auto points = opened<vtkXMLPolyDataReader>(folder.path() / "vtk" / step_file("balls", frame.step));
    ASSERT_EQ(points->GetNumberOfPoints(), balls);
    vtkPointData *columns = points->GetPointData();
    for (const char *name : {"radius", "diameter", "velocity", "angular_velocity", "force", "mass", "type",
                             "id", "coordination"})
      ASSERT_NE(columns->GetArray(name), nullptr) << name;
    double soil_volume = 0.0;
    for (vtkIdType row = 0; row < balls; ++row) {
      const auto id = static_cast<long>(columns->GetArray("id")->GetTuple1(row));
      const double radius = columns->GetArray("radius")->GetTuple1(row);
      const int type = static_cast<int>(columns->GetArray("type")->GetTuple1(row));
      EXPECT_EQ(type, id == 151 ? 2 : id == 152 ? 3 : 1);
      EXPECT_GE(radius, type == 1 ? 0.016 : 0.05);
      EXPECT_LE(radius, type == 1 ? 0.024 : 0.1);
      EXPECT_EQ(columns->GetArray("diameter")->GetTuple1(row), 2.0 * radius);
      for (int a = 0; a < 3; ++a) {
        const auto c = static_cast<std::size_t>(a);
        EXPECT_EQ(columns->GetArray("velocity")->GetComponent(row, a), frame.balls.at(id).v[c]);
        EXPECT_EQ(columns->GetArray("angular_velocity")->GetComponent(row, a), frame.balls.at(id).omega[c]);
        EXPECT_EQ(columns->GetArray("force")->GetComponent(row, a), frame.balls.at(id).f[c]);
        EXPECT_NEAR(points->GetPoint(row)[a], frame.balls.at(id).x[c], 6e-8);
      }
      const auto touching = std::count_if(pairs.begin(), pairs.end(), [id](const auto &pair) {
        return pair.first == id || pair.second == id;
      });
      EXPECT_EQ(columns->GetArray("coordination")->GetTuple1(row), static_cast<double>(touching)) << id;
      if (type == 1) soil_volume += pi * radius * radius;
    }
    const auto lines =
        opened<vtkXMLPolyDataReader>(folder.path() / "vtk" / step_file("contacts", frame.step));
    vtkCellData *cells = lines->GetCellData();
    ASSERT_GT(lines->GetNumberOfCells(), static_cast<vtkIdType>(pairs.size())); // contacts with walls follow
    for (vtkIdType row = static_cast<vtkIdType>(pairs.size()); row < lines->GetNumberOfCells(); ++row)
      EXPECT_EQ(cells->GetArray("id2")->GetTuple1(row), 0.0);
    for (vtkIdType row = 0; row < static_cast<vtkIdType>(pairs.size()); ++row) {
      const std::pair<long, long> pair = {static_cast<long>(cells->GetArray("id1")->GetTuple1(row)),
                                          static_cast<long>(cells->GetArray("id2")->GetTuple1(row))};
      EXPECT_EQ(pairs.count(pair), 1U);
      for (int a = 0; a < 2; ++a) {
        EXPECT_NEAR(lines->GetPoint(2 * row)[a], frame.balls.at(pair.first).x[static_cast<std::size_t>(a)],
                    6e-8);
        EXPECT_NEAR(lines->GetPoint(2 * row + 1)[a],
                    frame.balls.at(pair.second).x[static_cast<std::size_t>(a)], 1.5e-7);
      }
      const double *f = cells->GetArray("force")->GetTuple3(row);
      EXPECT_NEAR(std::hypot(cells->GetArray("normal_force")->GetTuple1(row),
                             cells->GetArray("tangential_force")->GetTuple1(row)),
                  std::hypot(f[0], f[1], f[2]), 1e-9 * std::hypot(f[0], f[1]) + 1e-12);
      EXPECT_GT(cells->GetArray("normal_force")->GetTuple1(row), -1e-6); // B
      EXPECT_GT(cells->GetArray("overlap")->GetTuple1(row), 0.0);
    }
    const auto image =
        opened<vtkXMLImageDataReader>(folder.path() / "vtk" / step_file("fields", frame.step, "vti"));
    if (frame.step == 0) image->GetBounds(extent.data());
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_EQ(image->GetBounds()[i], extent[i]); // the same grid all the time
    const double cell_area = image->GetSpacing()[0] * image->GetSpacing()[1];
    EXPECT_EQ(image->GetDimensions()[2], 1);
    vtkCellData *fields = image->GetCellData();
    double fraction_sum = 0.0;
    for (vtkIdType cell = 0; cell < image->GetNumberOfCells(); ++cell) {
      const double fraction = fields->GetArray("solid_fraction")->GetTuple1(cell);
      EXPECT_GE(fraction, 0.0);
      EXPECT_LE(fraction, 1.0);
      fraction_sum += fraction;
      const double *fabric = fields->GetArray("fabric")->GetTuple9(cell);
      const double trace = fabric[0] + fabric[4] + fabric[8];
      EXPECT_TRUE(trace == 0.0 || std::fabs(trace - 1.0) < 1e-12) << trace;
      EXPECT_GE(fields->GetArray("coordination")->GetTuple1(cell), 0.0);
      EXPECT_LE(fields->GetArray("coordination")->GetTuple1(cell), 6.0);
    }
    EXPECT_NEAR(fraction_sum * cell_area, soil_volume, 1e-12 * soil_volume);
  }
  EXPECT_NEAR(extent[0], -0.5 * width, 1e-3);
  EXPECT_NEAR(extent[1], 0.5 * width, 1e-3);
  EXPECT_NEAR(extent[2], 0.0, 1e-3);
}

TEST_F(Dumps, BecomeTrueCollections) {
  const Scratch folder;
  run_and_convert(folder, 1);
  expect_true_results(folder);
}

TEST_F(Dumps, BecomeTrueCollectionsOnTwoRanks) {
  const Scratch folder;
  run_and_convert(folder, 2);
  expect_true_results(folder);
}

// At rest the soil bears its own weight: the vertical stress of a row of cells is the weight of what lies
// above, per width.
TEST_F(Dumps, StressOfTheBedAtRestIsItsWeight) {
  const Scratch folder;
  run_and_convert(folder, 1);
  const auto image = opened<vtkXMLImageDataReader>(folder / "vtk/fields_0.vti");
  const int columns = image->GetDimensions()[0] - 1, rows = image->GetDimensions()[1] - 1;
  const auto at = [&](const char *name, int row, int component) {
    double mean = 0.0;
    for (int column = 0; column < columns; ++column)
      mean += image->GetCellData()->GetArray(name)->GetComponent(row * columns + column, component) / columns;
    return mean;
  };
  const double height = image->GetSpacing()[1];
  ASSERT_GE(rows, 3);
  double above = 0.0;
  for (int row = rows - 1; row >= 0; --row) {
    const double own = at("bulk_density", row, 0) * gravity * height;
    if (row > 0 && row < rows - 1) {
      EXPECT_NEAR(at("stress", row, 4), above + 0.5 * own, 0.2 * (above + 0.5 * own)) << "row " << row;
    }
    above += own;
  }
  EXPECT_NEAR(above * width, 150 * gravity * pi * 4.05e-4 * 2650,
              0.05 * above * width); // mean of r^2: 4.05e-4 m2
}

} // namespace
} // namespace drumlin::test
