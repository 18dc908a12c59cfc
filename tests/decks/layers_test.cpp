// Beds of layers, and of a given grading.
#include "tests/support/engine_runs.h"
#include "bed/dump_readers.h"
#include "engine/deck_run.h"
#include "runs/parameter_file.h"

namespace drumlin::test {
namespace {

// Beds of layers: the contacts of each layer, of layers with each other and with walls, in closed form; and
// small beds that are made and settled layer by layer.
namespace layers {

constexpr double radius = 0.05, box_top = 1.0; // m

/// A ball of a data file.
struct Placed {
  int type;
  std::array<double, 3> x, v, omega;
};

void write_balls(const std::filesystem::path &file, const std::vector<Placed> &balls, int types) {
  std::string atoms, velocities;
  for (std::size_t n = 0; n < balls.size(); ++n) {
    const auto &[type, x, v, w] = balls[n];
    atoms +=
        fmt::format("{} {} {} 1000 {:.17g} {:.17g} {:.17g}\n", n + 1, type, 2.0 * radius, x[0], x[1], x[2]);
    velocities += fmt::format("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", n + 1, v[0], v[1], v[2],
                              w[0], w[1], w[2]);
  }
  write_text(
      file,
      fmt::format(
          "balls\n\n{} atoms\n{} atom types\n\n-2 2 xlo xhi\n0 {} ylo yhi\n-0.1 0.1 zlo zhi\n\nAtoms\n\n{}\n"
          "Velocities\n\n{}",
          balls.size(), types, box_top, atoms, velocities));
}

/// The law of a layer, and that between two of them, as the page drumlin/layers has it.
struct Law {
  double k, D, friction, rolling, suction;
};
Law between(const Law &a, const Law &b) {
  return {2.0 * a.k * b.k / (a.k + b.k), 0.5 * (a.D + b.D), std::fmin(a.friction, b.friction),
          std::fmin(a.rolling, b.rolling), std::fmin(a.suction, b.suction)};
}
const std::array<Law, 3> laws = {
    {{1e6, 0.3, 0.5, 0.1, 20.0}, {4e6, 0.1, 0.8, 0.05, 10.0}, {3e5, 0.2, 0.3, 0.2, 5.0}}};

/// Type of the balls of layer n, from 0.
int type_of(std::size_t layer) { return layer == 0 ? 1 : static_cast<int>(layer) + 3; }

/// Engine and dimension.
class Layers : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
protected:
  void SetUp() override { SKIP_WITHOUT_LAMMPS(std::get<0>(GetParam()) == "lammps"); }

  /// Runs layers.scene with these balls.
  static Outcome run_scene(const Scratch &folder, const std::vector<Placed> &balls, const Variables &more,
                           int ranks = 1) {
    write_balls(folder / "balls", balls, static_cast<int>(laws.size()) + 2);
    Variables variables = more; // the engine takes the first of a name
    std::array<std::string, 5> lists;
    for (const Law &law : laws) {
      const std::array<double, 5> values = {law.k, law.D, law.friction, law.rolling, law.suction};
      for (std::size_t n = 0; n < lists.size(); ++n)
        lists[n] += (lists[n].empty() ? "" : ",") + number(values[n]);
    }
    const auto &[engine, dimension] = GetParam();
    variables = with(
        variables, given("k {}, D {}, friction {}, rolling {}, suction {}, dimension {}, balls {}", lists[0],
                         lists[1], lists[2], lists[3], lists[4], dimension, (folder / "balls").string()));
    return test::run_scene(engine, "layers", variables, folder.path(), ranks);
  }
  /// The last state of layers.scene with these balls.
  static std::map<long, Ball> last_state(const std::vector<Placed> &balls, const Variables &more,
                                         int ranks = 1) {
    const Scratch folder;
    well(run_scene(folder, balls, more, ranks));
    return read_dump(folder / "balls.txt").back().balls;
  }
};
INSTANTIATE_TEST_SUITE_P(
    Decks, Layers, ::testing::Combine(::testing::Values("liggghts", "lammps"), ::testing::Values("2", "3")),
    [](const auto &test) { return std::get<0>(test.param) + "_" + std::get<1>(test.param) + "D"; });

/// Columns of a square lattice of two layers each: the layers from below, in any order.
constexpr std::array<std::array<std::size_t, 2>, 4> columns = {{{0, 1}, {1, 0}, {2, 1}, {0, 0}}};
constexpr std::size_t lower = 3, all = 7; ///< balls of the lower layer of a column, and of the column
std::vector<Placed> lattice() {
  std::vector<Placed> balls;
  for (std::size_t c = 0; c < columns.size(); ++c)
    for (std::size_t n = 0; n < all; ++n)
      balls.push_back(
          {type_of(columns[c][n < lower ? 0 : 1]),
           {-1.0 + 0.5 * static_cast<double>(c), (2.0 * static_cast<double>(n) + 1.0) * radius, 0.0},
           {},
           {}});
  return balls;
}

// Each contact of a column is a spring that carries the weight of the balls above it, and between balls also
// the suction, and the springs of a column are in series.
TEST_P(Layers, OfALatticeSettleAsSpringsInSeries) {
  const std::vector<Placed> balls = lattice();
  const std::map<long, Ball> rest = last_state(balls, {{"drag", "300"}});
  ASSERT_EQ(rest.size(), balls.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    double settlement = 0.0;
    for (std::size_t n = 0; n < all; ++n) {
      const Law &own = laws[columns[c][n < lower ? 0 : 1]];
      const Law &below =
          n == 0 ? own : laws[columns[c][n - 1 < lower ? 0 : 1]]; // the floor has the law of the ball
      const double weight = static_cast<double>(all - n) * 9.81;  // balls of 1 kg
      settlement += (weight + (n == 0 ? 0.0 : between(own, below).suction)) / between(own, below).k;
      const std::size_t id = c * all + n;
      EXPECT_NEAR(balls[id].x[1] - rest.at(static_cast<long>(id) + 1).x[1], settlement, 1e-6 * settlement)
          << "column " << c << ", ball " << n;
    }
  }
}

TEST_P(Layers, OfALatticeAreTheSameOnRanksOneAndTwo) {
  const std::map<long, Ball> one = last_state(lattice(), {{"drag", "300"}}),
                             two = last_state(lattice(), {{"drag", "300"}}, 2);
  ASSERT_EQ(one.size(), two.size());
  for (const auto &[id, ball] : one)
    EXPECT_EQ(ball.x, two.at(id).x) << id;
}

TEST_P(Layers, WithoutBallsOrWithTooManyNumbersAreRefused) {
  const auto refusal = [](const std::vector<Placed> &balls, const Variables &more, const std::string &says) {
    const Scratch folder;
    const Outcome outcome = run_scene(folder, balls, more);
    EXPECT_NE(outcome.status, 0);
    EXPECT_TRUE(printed(outcome, "ERROR: drumlin/layers: " + says));
    EXPECT_EQ(outcome.output.find("ERROR"), outcome.output.rfind("ERROR")) << outcome.output;
  };
  std::vector<Placed> without = lattice();
  for (Placed &ball : without)
    if (ball.type == 4) ball.type = 1;
  refusal(without, {}, "layer 2 has '0' balls; allowed: at least one ball of type 4");
  const std::string lists = "one number, or 3 separated by commas, one for each layer, the lowest first";
  refusal(lattice(), {{"k", "1e6,1e6,1e6,1e6"}}, "keyword k is '1e6,1e6,1e6,1e6'; allowed: " + lists);
  refusal(lattice(), {{"friction", "0.5,0.4"}}, "keyword friction is '0.5,0.4'; allowed: " + lists);
  refusal(lattice(), {{"D", "0.5,-1,0"}}, "keyword D is '0.5,-1,0'; allowed: a finite number >= 0");
}

// Pairs of balls of all layers and of the drum (type 2): one approaches and slides, the other rolls. Force
// and torque in closed form.
TEST_P(Layers, HaveTheLawsOfThePageWithEachOtherAndWithTheDrum) {
  constexpr double overlap = 1e-4, approach = 0.1, slip = 100.0, spin = 1e9, lever = radius - 0.5 * overlap;
  struct Pair {
    int a, b;
    Law law;
  };
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < laws.size(); ++a) {
    for (std::size_t b = a; b < laws.size(); ++b)
      pairs.push_back({type_of(a), type_of(b), a == b ? laws[a] : between(laws[a], laws[b])});
    pairs.push_back({2, type_of(a), laws[a]}); // without suction
    pairs.back().law.suction = 0.0;
  }
  std::vector<Placed> balls;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const double x = -1.8 + 0.3 * static_cast<double>(n), d = 2.0 * radius - overlap;
    balls.push_back({pairs[n].a, {x, 0.2, 0.0}, {slip, approach, 0.0}, {}});
    balls.push_back({pairs[n].b, {x, 0.2 + d, 0.0}, {}, {}});
    balls.push_back({pairs[n].a, {x, 0.6, 0.0}, {}, {0.0, 0.0, spin}});
    balls.push_back({pairs[n].b, {x, 0.6 + d, 0.0}, {}, {0.0, 0.0, -spin}});
  }
  const std::map<long, Ball> state = last_state(balls, {{"g", "0"}});
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const Law &law = pairs[n].law;
    const std::string what = fmt::format("types {} and {}", pairs[n].a, pairs[n].b);
    const Ball &slides = state.at(4 * static_cast<long>(n) + 1),
               &rolls = state.at(4 * static_cast<long>(n) + 3);
    const double normal =
        law.k * overlap + 2.0 * law.D * std::sqrt(law.k * 0.5) * approach; // m_eff of 1 kg each
    EXPECT_NEAR(-slides.f[1], normal - law.suction, 1e-3 * normal) << what;
    EXPECT_NEAR(-slides.f[0], law.friction * normal, 1e-3 * normal) << what;
    EXPECT_NEAR(std::fabs(slides.torque[2]), lever * law.friction * normal, 2e-3 * lever * normal) << what;
    EXPECT_NEAR(-rolls.f[1], law.k * overlap - law.suction, 1e-3 * law.k * overlap) << what;
    EXPECT_NEAR(-rolls.torque[2], law.rolling * 0.5 * radius * law.k * overlap,
                2e-3 * law.rolling * radius * law.k * overlap)
        << what;
  }
}

/// Balls of a data file of drumlin/write: type, diameter, place and height of the centre.
struct Settled {
  int type;
  double size, x, y;
};
std::vector<Settled> settled_balls(const std::filesystem::path &file) {
  const std::string text = read_text(file);
  std::istringstream lines(text.substr(text.find("Atoms")));
  std::vector<Settled> balls;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && line.rfind("Velocities", 0) != 0) {
    std::istringstream row(line);
    Settled ball{};
    int id = 0;
    double density = 0.0;
    if (row >> id >> ball.type >> ball.size >> density >> ball.x >> ball.y) balls.push_back(ball);
  }
  return balls;
}

/// The tops of the layers that the file notes.
std::vector<double> noted_tops(const std::filesystem::path &file) {
  const std::string text = read_text(file), note = "# drumlin note layer_tops ";
  std::istringstream list(text.substr(text.find(note) + note.size()));
  std::vector<double> tops;
  for (double top = 0.0; list >> top; list.ignore(1))
    tops.push_back(top);
  return tops;
}

/// A soft subgrade of 110 balls in the plane, 70 in three dimensions, and a base course of 60 or 50, as
/// ./drumlin bed and in.settle make them.
class LayeredBed : public Layers {
protected:
  static constexpr double largest = 0.048; // m, diameter
  static constexpr std::array<double, 2> thickness = {0.2, 0.1};

  static Outcome settle(const Scratch &folder, const Variables &more, int ranks = 1,
                        const std::vector<std::string> &more_words = {}) {
    const auto &[engine, dimension] = GetParam();
    std::vector<std::string> words = tool_words("bed --width 0.8 --layer 0.2 --layer 0.1 --out balls");
    if (dimension == "3")
      words = tool_words("bed --width 0.3 --depth 0.15 --layer 0.2 --layer 0.1 --out balls");
    words.insert(words.end(), more_words.begin(), more_words.end());
    well(run_program(words, {}, folder.path()));
    const bool flat = dimension == "2";
    const Variables variables = with(more, {{"case", flat ? "gravel" : "gravel3d"},
                                            {"k", flat ? "1e8,1e9" : "4e6,4e7"},
                                            {"friction", "0.5,0.8"},
                                            {"pour_friction", "0.5,0.1"},
                                            {"pour_k", flat ? "1e8" : "4e6"}, // soft, to take fewer steps
                                            {"pour_dt", flat ? "2e-5" : "1.25e-5"},
                                            {"fall", "0.3"},
                                            {"ratio", "1"},
                                            {"balls", "balls"},
                                            {"bed", "soil"}});
    return run_deck(bed_deck(engine == "lammps" ? "in.settle.lammps" : "in.settle"), variables, folder.path(),
                    ranks);
  }
  static std::filesystem::path bed_deck(const std::string &name) {
    return std::filesystem::path(DRUMLIN_SOURCE_DIR) / "inputs/bed" / name;
  }
};
INSTANTIATE_TEST_SUITE_P(Decks, LayeredBed,
                         ::testing::Combine(::testing::Values("liggghts", "lammps"),
                                            ::testing::Values("2", "3")),
                         [](const auto &test) {
                           return std::get<0>(test.param) + "_" + std::get<1>(test.param) + "D";
                         });

// When the bed has settled the surface of each layer is where it was asked for within half of the largest
// ball, and no ball lies farther than one diameter of the largest one on the other side of the boundary.
TEST_P(LayeredBed, SettlesLayerByLayer) {
  const Scratch folder;
  well(settle(folder, {}));
  const std::vector<double> tops = noted_tops(folder / "soil.data");
  ASSERT_EQ(tops.size(), 2u);
  EXPECT_NEAR(tops[0], thickness[0], 0.5 * largest);
  EXPECT_NEAR(tops[1] - tops[0], thickness[1], 0.5 * largest);
  std::map<int, std::size_t> counts;
  for (const auto &[type, size, x, y] : settled_balls(folder / "soil.data")) {
    ++counts[type];
    if (type == 1)
      EXPECT_LT(y, tops[0] + largest);
    else
      EXPECT_GT(y, tops[0] - largest);
  }
  EXPECT_EQ(counts.size(), 2u);
  EXPECT_GT(counts[1], 40u);
  EXPECT_GT(counts[4], 20u);
}

// A soft spot is a part of the lowest layer: it falls and settles with it, where it was asked for, and has
// the number of k that stands behind those of the layers.
TEST_P(LayeredBed, HasASpotInItsLowestLayer) {
  const auto &[engine, dimension] = GetParam();
  if (dimension == "3") return;
  const Scratch folder;
  const std::vector<std::string> spot = {"--spot", "-0.1:0.15"};
  EXPECT_TRUE(printed(
      settle(folder, {}, 1, spot),
      "variable pour_friction is '0.5,0.1'; allowed: one number, or 3 separated by commas, one for each "
      "layer, the lowest first, and then one for each spot"));
  well(settle(folder, given("k 1e8,1e9,1e7, friction 0.5,0.8,0.4, pour_friction 0.5,0.1,0.5"), 1, spot));
  const std::string text = read_text(folder / "soil.data");
  for (const char *note : {"layers 2\n", "spots -0.1:0.15\n", "k 1e8,1e9,1e7\n"})
    EXPECT_TRUE(contains(text, std::string("# drumlin note ") + note)) << note;
  const std::vector<double> tops = noted_tops(folder / "soil.data");
  ASSERT_EQ(tops.size(), 2u);
  std::map<int, int> inside, outside;
  for (const auto &[type, size, x, y] : settled_balls(folder / "soil.data")) {
    const bool in_spot = x > -0.1 && x < 0.15;
    ++(in_spot ? inside : outside)[type];
    if (type == 5) {
      EXPECT_LT(y, tops[0] + largest);
      EXPECT_GT(x, -0.1 - 2.0 * largest);
      EXPECT_LT(x, 0.15 + 2.0 * largest);
    }
  }
  EXPECT_GT(inside[5], 20);
  EXPECT_GT(outside[1], 40);
  EXPECT_LT(outside[5], inside[5] / 4);
  EXPECT_LT(inside[1], inside[5] / 4);
}

// Layers that were asked for by their density: in.settle pours them with the friction that the balls' file
// notes, and refuses another one. The denser layer has the smaller void ratio.
TEST_P(LayeredBed, IsPouredForItsRelativeDensity) {
  const auto &[engine, dimension] = GetParam();
  if (dimension == "3") return;
  const Scratch folder;
  write_text(folder / "density.csv",
             "share,friction,rolling,void_ratio,solid_fraction,relative_density,compaction,coordination,"
             "dimension,spread,made\n1,0.8,0.45,0.29,0.775,0,0.94,3,2,0.2,poured\n"
             "1,0.8,0.45,0.21,0.826,1,1,4,2,0.2,shaken\n0,0,0,0.19,0.84,1.25,1.02,4,2,0.2,frictionless\n");
  well(run_program(tool_words("bed --width 1 --layer 0.3 --layer 0.3 --packings density.csv "
                              "--relative-density 0 --relative-density 1.25 --out balls"),
                   {}, folder.path()));
  const Variables variables = given("pour_k 1e8, pour_dt 1.8e-5, balls balls, bed soil");
  const std::filesystem::path deck = bed_deck(engine == "lammps" ? "in.settle.lammps" : "in.settle");
  EXPECT_TRUE(printed(run_deck(deck, with(variables, {{"pour_friction", "0.3"}}), folder.path()),
                      "variable pour_friction is '0.3'; allowed: 0.8,0, with which 'balls' was made"));
  EXPECT_TRUE(printed(run_deck(deck, with(variables, {{"friction", "0.5"}}), folder.path()),
                      "variable friction is '0.5'; allowed: 0.8,0.8, of the soil whose loosest and densest "
                      "packing balls notes"));
  const Outcome settled = run_deck(deck, variables, folder.path());
  well(settled);
  EXPECT_TRUE(settled.says(" where 0 was asked for\n")) << settled.output;
  EXPECT_TRUE(settled.says(" where 1.25 was asked for\n"));
  const std::string text = read_text(folder / "soil.data");
  for (const char *note : {"seed 1\n", "packings_friction 0.8,0.8\n", "poured 1e8/0.3/0.8,0/0.45,0/0\n",
                           "relative_density 0,1.25\n", "e_loosest 0.29,0.29\n", "e_shaken 0.21,0.21\n",
                           "pour_friction 0.8,0\n", "pour_rolling 0.45,0\n"})
    EXPECT_TRUE(contains(text, std::string("# drumlin note ") + note)) << note;
  // Both layers have the thickness that was asked for when their void ratios differ as their areas do.
  const std::vector<double> tops = noted_tops(folder / "soil.data");
  std::map<int, double> area;
  for (const auto &[type, size, x, y] : settled_balls(folder / "soil.data"))
    area[type] += 0.25 * pi * size * size;
  ASSERT_EQ(tops.size(), 2u);
  const double looser = (tops[0] / area[1]) / ((tops[1] - tops[0]) / area[4]);
  EXPECT_GT(looser, 1.03); // 1.29/1.19 = 1.08 without scatter and walls
  EXPECT_LT(looser, 1.13);
}

// The tool makes the packings of a sieve curve itself, once, and a bed made with them has the density asked
// for.
TEST(BedOfASieveCurve, GetsTheDensityAskedFor_ByNight) {
  const Scratch folder;
  const std::vector<std::string> words =
      tool_words("bed --sieve 20-60 --cut 20 --out balls.data --balls 800 --width 2 --relative-density 0.5");
  const Outcome made = run_program(words, {}, folder.path(), 1800.0);
  well(made);
  EXPECT_TRUE(made.says("LIGGGHTS pours 15 samples of ")) << made.output;
  const post::Table packings = post::read_table(folder / "balls_packings.csv");
  const std::vector<double> voids = packings.numbers("void_ratio"), share = packings.numbers("share");
  ASSERT_EQ(packings.rows(), 6u); // the last one is that which shaking leaves
  EXPECT_LT(voids[5], voids[4] - 0.02);
  EXPECT_GT(voids[5], voids[0]);
  for (std::size_t n = 1; n < 5; ++n) {
    EXPECT_GT(share[n], share[n - 1]);
    EXPECT_GT(voids[n], voids[n - 1] + 0.005);
  }
  EXPECT_LT(voids.front(), 0.21); // random close packing of discs of several sizes: below 0.19 of equal ones
  EXPECT_GT(voids.front(), 2.0 * std::sqrt(3.0) / pi - 1.0); // the densest lattice of equal discs: 0.103
  const std::string first = read_text(folder / "balls.data");
  const Outcome again = run_program(words, {}, folder.path());
  well(again);
  EXPECT_TRUE(again.says("Layer 1: packings of balls_packings.csv\n")) << again.output;
  EXPECT_TRUE(read_text(folder / "balls.data") == first);
  const Outcome settled =
      run_deck(post::input_file("bed/in.settle"), given("balls balls.data, bed soil.restart"), folder.path());
  well(settled);
  EXPECT_TRUE(settled.says(" where 0.5 was asked for\n")) << settled.output;
  EXPECT_FALSE(settled.says("WARNING: drumlin/density")) << settled.output;
}

/// Number of balls of an absorbing boundary times the dashpot of each, kg/s, as the log of the fix has it; 0
/// if there is no such fix.
double dashpots(const std::string &log, const std::string &id) {
  const std::string name = "fix boundary/absorb " + id + ": ";
  const std::size_t line = log.find(name);
  double balls = 0.0, spring = 0.0, dashpot = 0.0;
  if (line == std::string::npos) return 0.0;
  EXPECT_EQ(std::sscanf(log.c_str() + line + name.size(), "%lf balls, each with normal k = %lf N/m, c = %lf",
                        &balls, &spring, &dashpot),
            3);
  return balls * dashpot;
}

// A roller on a bed of layers, hardly settled: the decks hand on the lists, floor and sides have the
// impedance of their layers, and a run that is stopped continues bit for bit.
TEST_P(LayeredBed, CarriesARollerAndContinuesWhereItStopped) {
  const auto &[engine, dimension] = GetParam();
  if (dimension == "3") return;
  const Scratch folder;
  well(settle(folder, given("fall 0.01, ratio 1e9, case two_layers")));
  const std::string ending = engine == "lammps" ? ".lammps" : "";
  const Variables roller = given("r2 0.1, r3 0.05, m2 1000, m3 500");
  const Variables placing = with(roller, given("bed soil, start roller, sink 0, ratio 1e9"));
  well(run_deck(bed_deck("in.place" + ending), placing, folder.path()));
  const auto shake = [&, lammps = engine == "lammps"](Variables variables) {
    // A frequency so high that the steps are short.
    variables =
        with(variables, given("cycles 2, omega 1e5, Fw 1, balance 1e30, start roller, boundary absorb"));
    if (lammps) variables.emplace_back("rest", "0");
    return run_deck(bed_deck("in.bed" + ending), variables, folder.path());
  };
  const Outcome whole = well(shake({{"out", "whole"}}));
  EXPECT_TRUE(printed(shake(given("out parts, time_limit 1e-3")), "continue from "));
  well(shake(given("out parts, start parts/stopped.restart")));
  EXPECT_EQ(read_text(folder / "whole/bed.csv"), read_text(folder / "parts/bed.csv"));
  std::map<std::string, std::string> made = post::read_parameters(folder / "whole/parameters.csv");
  EXPECT_EQ(made["k"], "1e8,1e9");
  EXPECT_EQ(made["friction"], "0.5,0.8");
  EXPECT_EQ(made["layers"], "2");
  const std::vector<double> tops = noted_tops(folder / "soil.data");
  ASSERT_EQ(tops.size(), 2u);
  // The impedance of gravel with k = 1e9 N/m is 2150 kg/m3 times 450 m/s; that of the subgrade has the root
  // of a tenth of this k.
  const double gravel = 2150.0 * 450.0, subgrade = gravel * std::sqrt(0.1);
  EXPECT_NEAR(dashpots(whole.output, "ground_floor"), subgrade * 0.8, 1e-5 * subgrade);
  const std::array<double, 2> sides = {subgrade * tops[0],
                                       gravel * (std::stod(made["side_height"]) - tops[0])};
  for (std::size_t n = 0; n < sides.size(); ++n) { // so loose a bed has layers without a ball at a side
    const double left = dashpots(whole.output, fmt::format("ground_left_{}", n + 1)),
                 right = dashpots(whole.output, fmt::format("ground_right_{}", n + 1));
    EXPECT_NEAR(std::fmax(left, right), sides[n], 1e-5 * sides[n]) << n;
    EXPECT_TRUE(left == 0.0 || right == 0.0 || std::fabs(left - right) < 1e-5 * sides[n]) << n;
  }
}

} // namespace layers

// The decks of the bed on balls of a given grading: the files note it, and the time steps follow the smallest
// ball.
namespace grading {

namespace fs = std::filesystem;

fs::path deck(const char *name) { return fs::path(DRUMLIN_SOURCE_DIR) / "inputs/bed" / name; }

/// A scene of the decks from balls to a cycle of excitation, hardly settled; its parameters.csv.
std::map<std::string, std::string> parameters_of(const Scratch &folder, const std::vector<std::string> &sizes,
                                                 const std::string &case_name, const char *last_deck) {
  std::vector<std::string> words = tool_words("bed --balls 40 --width 0.4 --out balls");
  words.insert(words.end(), sizes.begin(), sizes.end());
  well(run_program(words, {}, folder.path()));
  well(run_deck(deck("in.settle"), given("case {}, balls balls, bed soil, fall 0.01, ratio 1e9", case_name),
                folder.path()));
  well(run_deck(deck("in.place"),
                given("case {}, bed soil, start roller, sink 0, ratio 1e9, r2 0.1, r3 0.05, m2 1000, m3 500",
                      case_name),
                folder.path()));
  // A cycle of 20 Hz, from which the number of steps follows.
  well(run_deck(deck(last_deck), given("start roller, out B, cycles 1, Fw 1, balance 1e30"), folder.path()));
  return post::read_parameters(folder / "B/parameters.csv");
}

/// Time steps at 20 Hz in half of an undamped oscillation of two of the smallest balls on each other: closed
/// form.
double steps_in_contact(double mass, double k, double steps_per_cycle) {
  constexpr double pi = 3.141592653589793;
  return pi * std::sqrt(0.5 * mass / k) * 20.0 * steps_per_cycle;
}

TEST(GradedBedDecks, NoteTheGradingAndFollowTheSmallestDisc) {
  const Scratch folder;
  std::map<std::string, std::string> made =
      parameters_of(folder, {"--sieve", "WMM", "--cut", "14"}, "gravel", "in.bed");
  EXPECT_EQ(made["grading"], "WMM_from_14mm");
  EXPECT_EQ(made["r_min"], "0.007");
  EXPECT_EQ(made["r_max"], "0.0265");
  EXPECT_NEAR(std::stod(made["d50"]), 0.0276, 0.002);
  EXPECT_NEAR(std::stod(made["C_u"]), 1.9, 0.2);
  const auto disc = [](double r) { return 3.141592653589793 * r * r * 2650.0; };
  const double steps = std::stod(made["steps_per_cycle"]);
  EXPECT_EQ(std::fmod(steps, 250.0), 0.0);
  EXPECT_NEAR(steps_in_contact(disc(0.007), 1e9, steps), steps_in_contact(disc(0.016), 1e9, 8000), 0.3);
}

TEST(GradedBedDecks, FollowTheSmallestSphere) {
  const Scratch folder;
  std::map<std::string, std::string> made =
      parameters_of(folder, {"--sieve", "WMM", "--cut", "20", "--depth", "0.08"}, "gravel3d", "in.bed3d");
  const auto sphere = [](double r) { return 4.0 / 3.0 * 3.141592653589793 * r * r * r * 2650.0; };
  const double steps = std::stod(made["steps_per_cycle"]);
  EXPECT_NEAR(steps_in_contact(sphere(0.010), 4e7, steps), steps_in_contact(sphere(0.016), 4e7, 12500), 0.3);
}

TEST(GradedBedDecks, KeepTheStepsOfGravel) {
  const Scratch folder;
  std::map<std::string, std::string> made = parameters_of(folder, {}, "gravel", "in.bed");
  EXPECT_EQ(made["steps_per_cycle"], "8000");
  EXPECT_EQ(made["grading"], "uniform");
}

// The base course has about as many steps in a contact, which is unloaded with the stiffness k yield.
TEST(GradedBedDecks, HaveStepsForContactsOfTheBaseCourseThatAreUnloaded) {
  const Scratch folder;
  std::map<std::string, std::string> made = parameters_of(folder, {}, "base", "in.bed");
  const double k2 = std::stod(made["k"]) * std::stod(made["yield"]),
               mass = 3.141592653589793 * 2.56e-4 * 2650;
  EXPECT_NEAR(steps_in_contact(mass, k2, std::stod(made["steps_per_cycle"])),
              steps_in_contact(mass, 1e9, 8000), 0.5);
}

} // namespace grading

// A bed below a drum in the middle of the box, on a border of two ranks, and aside, where a rank has no ball.
// It is one row of balls: the motion of more is chaotic, so that rounding grows to the size of a radius.
TEST(BedOnRanks, HasEveryBallWhereItIsOnOne) {
  constexpr double radius = 0.02; // m, the deck's default
  for (const char *centre : {"0", "0.8"}) {
    std::vector<post::TextDump> one;
    for (const int ranks : {1, 2}) {
      const Scratch scratch;
      well(run_deck(post::input_file("study/in.small_bed"),
                    given("rows 1, drum_mass 100, settling 6000, centre {}, out out", centre), scratch.path(),
                    ranks));
      const post::TextDump last = post::read_text_dumps(scratch / "out/last.dump").back();
      if (ranks == 1) {
        one = {last};
        continue;
      }
      ASSERT_EQ(last.rows.size(), one.front().rows.size());
      for (std::size_t i = 0; i < last.rows.size(); ++i)
        for (const char *column : {"id", "x", "z"})
          EXPECT_NEAR(last.rows[i][last.column(column)], one.front().rows[i][last.column(column)],
                      1e-3 * radius)
              << column;
    }
  }
}

} // namespace
} // namespace drumlin::test
