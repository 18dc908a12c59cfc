#include "tests/support/page.h"
#include "tests/support/tool.h"
#include "passes/drive.h"
#include "passes/meter_map.h"
#include "passes/page.h"
#include "passes/values.h"
#include "runs/parameter_file.h"

namespace drumlin::test {
namespace {

// What the passes of a roller leave: runs made here, whose surfaces, solid fractions and meter values follow
// from closed forms, and runs that are refused.
namespace passes {

namespace fs = std::filesystem;
using namespace drumlin::post;

constexpr double r = 0.02, side = 2.0 * r; // of the discs, which stand in columns side by side, m
constexpr int columns = 150;               // from x = -3 to 3 m
constexpr double m2 = 2000.0, m3 = 1800.0, g = 9.81, frequency = 30.0, speed = 5.0 / 3.0, way = 5.0;
constexpr double w = 2.0 * M_PI * frequency, pass_time = way / speed, pause_time = 0.2;
constexpr double acceleration = 5.0, Fw = 5000.0; // m/s2, N
constexpr double exciter_power = 900.0;           // W
constexpr int steps_per_cycle = 100, rows_per_cycle = 50;

/// Ten rows of a dense layer, each disc on the one below, and rows of a lift above it, `apart` from one
/// another; in the measured part, -1 to 1 m, `taken` rows of the lift are missing, and stand at its right.
struct Bed {
  double apart = 0.05;
  int taken = 0;
  double chain_force = 0.0; ///< N, in every contact of the dense layer
};
constexpr int dense_rows = 10, lift_rows = 5;

double lift_top(const Bed &bed, int rows) { return dense_rows * side + r + (rows - 1) * bed.apart; }

/// Text dumps of balls and contacts.
std::pair<std::string, std::string> dumps_of(const Bed &bed, long step) {
  std::string balls, contacts;
  int count = 0, pairs = 0;
  const auto add = [&](int type, double x, double y) {
    balls += fmt::format("{} {} {} 3 {:.17g} {:.17g} 0 0 0 0 0 0 0 0 0 0\n", ++count, type, r, x, y);
  };
  for (int i = 0; i < columns; ++i) {
    const double x = -3.0 + (i + 0.5) * side;
    const bool measured = std::abs(x) < 1.0;
    const int rows = lift_rows - (measured ? bed.taken : x > 1.0 ? -bed.taken : 0);
    for (int j = 0; j < dense_rows; ++j) {
      add(1, x, r + j * side);
      if (j == 0) continue;
      contacts += fmt::format("{} {} 0 {} 0 0 1 0 0\n", count, count - 1, bed.chain_force);
      ++pairs;
    }
    for (int j = 0; j < rows; ++j)
      add(4, x, dense_rows * side + r + j * bed.apart);
  }
  add(4, 0.1, 1.5); // thrown up
  add(2, 0.0, 2.0); // drum and frame
  add(3, 0.0, 3.0);
  return {fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: ATOMS id type radius mass x y z "
                      "vx vy vz omegax omegay omegaz fx fy fz\n{}",
                      step, count, balls),
          fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ENTRIES\n{}\nITEM: ENTRIES f_contacts[1] "
                      "f_contacts[2] f_contacts[3] f_contacts[4] f_contacts[5] f_contacts[6] f_contacts[7] "
                      "f_contacts[8] f_contacts[9]\n{}",
                      step, pairs, contacts)};
}

/// What a run is made of.
struct DriveRun {
  bool soil_drives = false; ///< the soil gives energy to the drum, as none does
  int passes = 3;
  double end = 0.0; ///< s, of bed.csv; 0: after the last pause
  std::function<Bed(int)> bed = [](int pass) {
    // The lift is compacted by the first two passes; the third pushes a row of it aside.
    return Bed{pass == 0 ? 0.05 : pass == 1 ? 0.044 : 0.042, pass == 3 ? 1 : 0, 1000.0};
  };
  double cmv_of_pass = 30.0;
  const char *ended = "yes";
  int seed = 1;
};

class Passes : public Tool {
protected:
  static long step_of(double time) { return std::lround(time * frequency * steps_per_cycle); }

  void write_dump(const std::string &name, const Bed &bed, long step) const {
    const auto [balls, contacts] = dumps_of(bed, step);
    write_files({{folder_ / name / "dump" / fmt::format("balls_{}.dump", step), balls},
                 {folder_ / name / "dump" / fmt::format("contacts_{}.dump", step), contacts}});
  }

  fs::path write_run(const std::string &name, const DriveRun &run = {}) const {
    fs::create_directories(folder_ / name / "dump");
    const double whole = pass_time + pause_time, end = run.end > 0.0 ? run.end : run.passes * whole;
    std::string bed = "time,x_drum,v_drum,a_drum,x_frame,v_frame,a_frame,F_contact,F_excitation,F_bond,"
                      "work_excitation,s,pass,traction,torque,work_traction,work_torque\n";
    const auto rows = static_cast<int>(std::lround(end * frequency * rows_per_cycle));
    const auto pass_at = [&](double time) {
      return std::min(run.passes, static_cast<int>(time / whole + 1e-9) + 1);
    };
    double driven = 0.0, work = 0.0, place = -0.5 * way;
    for (int row = 0; row <= rows; ++row) {
      const double t = row / (frequency * rows_per_cycle);
      const int pass = pass_at(t);
      const double along = std::min(way, speed * (t - (pass - 1) * whole));
      const double s = pass % 2 == 1 ? -0.5 * way + along : 0.5 * way - along;
      work += 500.0 * pass * std::abs(s - place);
      driven += std::abs(s - place);
      place = s;
      const double second = acceleration * run.cmv_of_pass * pass / 300.0;
      const double a = acceleration * std::cos(w * t) + second * std::cos(2.0 * w * t);
      const double v = acceleration / w * std::sin(w * t) + 0.5 * second / w * std::sin(2.0 * w * t);
      const double x = -(acceleration * std::cos(w * t) + 0.25 * second * std::cos(2.0 * w * t)) / (w * w);
      const double excitation = (run.soil_drives ? Fw : -Fw) * std::sin(w * t);
      bed += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},0,0,0,{:.17g},{:.17g},0,{:.17g},{:.17g},{},{},0,"
                         "{:.17g},{:.17g}\n",
                         t, x, v, a, m2 * (a + g) + m3 * g + excitation, excitation, exciter_power * t, s,
                         pass, (pass % 2 == 1 ? 500.0 : -500.0) * pass, work, 7.0 * driven);
    }
    std::string cycles = "cycle,time,a_drum_min,a_drum_max,F_contact_min,F_contact_max,contact_share,a1_cos,"
                         "a1_sin,a2_cos,a2_sin,ah_cos,ah_sin,settlement\n0,0,0,0,0,0,1,0,0,0,0,0,0,0\n";
    for (int n = 1; n <= static_cast<int>(end * frequency + 1e-6); ++n) {
      const int pass = pass_at((n - 0.5) / frequency);
      cycles +=
          fmt::format("{},{:.17g},0,0,0,{},{},{},0,{:.17g},0,0,0,0\n", n, n / frequency, 1e5 * pass,
                      pass == 3 ? 0.75 : 1.0, acceleration, acceleration * run.cmv_of_pass * pass / 300.0);
    }
    write_files({{folder_ / name / "bed.csv", bed},
                 {folder_ / name / "cycles.csv", cycles},
                 {folder_ / name / "parameters.csv",
                  parameters_text(given(
                      "deck drive, dimension 2, measure_from -1, measure_to 1, speed {}, omega {}, Fw {}, m2 "
                      "{}, m3 {}, roller_width 2, timestep {}, layers 2, seed {}, layer_tops 0.4,0.6, "
                      "e_loosest 0.9,0.9, e_shaken 0.2,0.2, ended {}",
                      number_text(speed), number_text(w), number_text(Fw), number_text(m2), number_text(m3),
                      number_text(1.0 / (frequency * steps_per_cycle)), run.seed, run.ended))}});
    for (int pass = 0; pass <= run.passes; ++pass)
      if (pass * whole <= end + 1e-9) write_dump(name, run.bed(pass), step_of(pass * whole));
    return folder_ / name;
  }

  Outcome passes(const std::vector<std::string> &words) const { return drumlin("passes", words); }

  void refused(const std::vector<std::string> &words, const std::string &says) const {
    const Outcome outcome = passes(words);
    EXPECT_NE(outcome.status, 0) << says;
    EXPECT_TRUE(contains(outcome.output, {says}));
    expect_one_error(outcome.output, "drumlin passes: ");
    EXPECT_FALSE(fs::exists(folder_ / "run/passes.csv"));
    EXPECT_FALSE(fs::exists(folder_ / "run/passes"));
  }
};

// Surfaces are rows of equal discs, so that the lift is as thick as the tops of its discs are above those of
// the layer below. The first two passes only compact the lift; the third only pushes soil aside.
TEST_F(Passes, TellsCompactionFromPushedSoil) {
  write_run("run");
  const Outcome outcome = passes({"run"});
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  const Table table = read_table(folder_ / "run/passes.csv");
  ASSERT_EQ(table.rows(), 4u);
  const DriveRun run;
  const double disc = M_PI * r * r;
  const double h0 = lift_top(run.bed(0), lift_rows) - (dense_rows * side - r);
  for (int pass = 0; pass < 4; ++pass) {
    const Bed bed = run.bed(pass);
    const int rows = lift_rows - bed.taken;
    const double h = lift_top(bed, rows) - (dense_rows * side - r), phi = rows * disc / (side * h);
    const double phi0 = lift_rows * disc / (side * h0);
    const auto value = [&](const char *column) {
      return table.numbers(column)[static_cast<std::size_t>(pass)];
    };
    EXPECT_NEAR(value("thickness_2 [m]"), h, 1e-12) << pass;
    EXPECT_NEAR(value("solid_fraction_2 [-]"), phi, 1e-11) << pass;
    EXPECT_NEAR(value("settlement [m]"), h0 - h, 1e-12) << pass;
    EXPECT_NEAR(value("settlement_scatter [m]"), 0.0, 1e-12) << pass;
    EXPECT_NEAR(value("compaction [m]"), h0 * (1.0 - phi0 / phi), 1e-11) << pass;
    // The discs that have left the part, over the solid fraction.
    EXPECT_NEAR(value("pushed [m]"), bed.taken * disc / (side * phi), 1e-11) << pass;
    // The inside of the lift, between planes a quarter of the thickness away from its surfaces: discs that
    // these cut count with what is between.
    const double bottom = value("thickness_1 [m]"), low = bottom + 0.25 * h, high = bottom + 0.75 * h;
    double inside = 0.0;
    for (int row = 0; row < rows; ++row) {
      const auto below = [&](double height) {
        const double at = std::clamp((height - lift_top({bed.apart}, row + 1)) / r, -1.0, 1.0);
        return r * r * (0.5 * M_PI + std::asin(at) + at * std::sqrt(1.0 - at * at));
      };
      inside += below(high) - below(low);
    }
    const double inner = inside / (side * (high - low));
    EXPECT_NEAR(value("inner_solid_fraction_2 [-]"), inner, 1e-10) << pass;
    EXPECT_NEAR(value("degree_of_compaction_2 [-]"), inner * 1.2, 1e-10) << pass;
    EXPECT_NEAR(value("relative_density_2 [-]"), (0.9 - (1.0 / inner - 1.0)) / 0.7, 1e-9) << pass;
    const double rise = lift_top(bed, lift_rows + bed.taken) - lift_top(run.bed(0), lift_rows);
    EXPECT_NEAR(value("heave [m]"), rise, 1e-12) << pass;
    // A fiftieth of a radius is what lines a quarter of a radius apart may miss of an arch.
    EXPECT_NEAR(value("thickness_1 [m]"), (2 * dense_rows - 1 + 0.25 * M_PI) * r, 0.02 * r) << pass;
  }
}

TEST_F(Passes, TakesMeterValuesAndWorkCellByCell) {
  write_run("run");
  // A dump before the end of the pause, with the roller standing, is as good as one at its end.
  const long end = step_of(pass_time + pause_time);
  fs::remove(folder_ / "run/dump" / fmt::format("balls_{}.dump", end));
  write_dump("run", DriveRun().bed(1), end - 100);
  ASSERT_TRUE(passes({"run"}).ok());
  const Table table = read_table(folder_ / "run/passes.csv"), cells = read_table(folder_ / "run/way.csv");
  ASSERT_EQ(cells.rows(), 15u); // five of 0.34 m on 2 m, three passes
  for (std::size_t pass = 1; pass <= 3; ++pass) {
    const auto n = static_cast<double>(pass);
    const auto value = [&](const char *column) { return std::stod(table.text(column)[pass]); };
    const auto empty = [&](const char *column) { return table.text(column)[0].empty(); };
    EXPECT_NEAR(value("CMV [-]"), 30.0 * n, 1e-9);
    EXPECT_TRUE(empty("CMV [-]"));
    EXPECT_NEAR(value("RMV [-]"), 0.0, 1e-9);
    // From samples, with their own small error: 100 A_2 / A_1.
    EXPECT_NEAR(value("CCV [-]"), 10.0 * n, 0.05);
    EXPECT_NEAR(value("k_B [N/m]") / (m2 * w * w), 1.0, 1e-3);
    EXPECT_NEAR(value("contact_share [-]"), pass == 3 ? 0.75 : 1.0, 1e-12);
    EXPECT_NEAR(value("peak_force [N]"), 1e5 * n, 1e-6);
    EXPECT_NEAR(value("traction [N]"), 500.0 * n, 1e-9); // along the pass, forth and back
    EXPECT_NEAR(value("energy_exciter [J/m]"), exciter_power / speed, 1e-9 * exciter_power);
    EXPECT_NEAR(value("energy_traction [J/m]"), 500.0 * n + 7.0, 1e-8);
    EXPECT_EQ(table.text("mode")[pass], pass == 3 ? "partial uplift" : "continuous contact");
    for (std::size_t i = 5 * (pass - 1); i < 5 * pass; ++i) {
      EXPECT_EQ(cells.text("cycles [-]")[i], "6"); // 0.34 m at 6 km/h and 30 Hz
      EXPECT_NEAR(cells.numbers("CMV [-]")[i], 30.0 * n, 1e-9);
      EXPECT_NEAR(cells.numbers("energy_exciter [J/m]")[i], exciter_power / speed, 1e-8);
      EXPECT_NEAR(cells.numbers("energy_traction [J/m]")[i], 500.0 * n + 7.0, 1e-8);
      EXPECT_NEAR(cells.numbers("s [m]")[i], -1.0 + 0.34 * (static_cast<double>(i % 5) + 0.5), 1e-12);
    }
  }
}

TEST_F(Passes, DrawsSurfacesAndProfiles) {
  write_run("run");
  write_dump("run", {0.05, 0, 3000.0}, step_of(0.5 * pass_time)); // the drum is at 0
  ASSERT_TRUE(passes({"run", "--spacing", "0.01"}).ok());
  const Table surface = read_table(folder_ / "run/surface.csv");
  EXPECT_EQ(surface.header().back(), "pass_3 [m]");
  const std::vector<double> s = surface.numbers("s [m]"), before = surface.numbers("before [m]"),
                            after = surface.numbers("pass_2 [m]");
  ASSERT_EQ(s.size(), 600u);
  for (std::size_t i = 0; i < s.size(); ++i) {
    const double across = std::remainder(s[i] + 3.0 - 0.5 * side, side);
    EXPECT_NEAR(before[i], lift_top({0.05}, lift_rows) + std::sqrt(r * r - across * across), 1e-9);
    EXPECT_NEAR(after[i] - before[i], -4 * 0.008, 1e-12);
  }
  const Table depth = read_table(folder_ / "run/depth.csv");
  const std::vector<double> pass = depth.numbers("pass"), height = depth.numbers("height [m]");
  int dense = 0;
  for (std::size_t i = 0; i < pass.size(); ++i) {
    if (height[i] < 0.1 || height[i] > 0.3) continue; // the dense layer, away from its ends
    ++dense;
    const double stress = 1000.0 / side; // a chain of equal forces in every column
    EXPECT_NEAR(depth.numbers("solid_fraction [-]")[i], M_PI / 4.0, 0.03);
    EXPECT_NEAR(depth.numbers("coordination [-]")[i], 2.0, 1e-9);
    EXPECT_NEAR(depth.numbers("vertical_stress [Pa]")[i] / stress, pass[i] == 1.0 ? 3.0 : 1.0, 0.1);
    EXPECT_NEAR(depth.numbers("horizontal_stress [Pa]")[i], 0.0, 1e-9);
    EXPECT_EQ(depth.text("stress_of")[i], pass[i] == 1.0 ? "passing drum" : "standing roller");
  }
  EXPECT_GE(dense, 12);
}

// Spheres in a lattice so narrow that every line meets one of the top: between equal surfaces the thickness
// is the distance of their centres.
TEST_F(Passes, MeasuresInThreeDimensions) {
  constexpr double narrow = 1.4 * r, high = 0.03, depth = 20 * narrow;
  Drive drive;
  drive.flat = false;
  drive.thickness = depth;
  drive.layers = 2;
  drive.measured = {-10 * narrow, 10 * narrow};
  DumpedBed bed;
  for (int i = -15; i < 15; ++i)
    for (int k = 0; k < 20; ++k)
      for (int j = 0; j < 16; ++j) {
        post::Ball ball;
        ball.id = static_cast<long>(bed.balls.size()) + 1;
        ball.type = j >= 8 ? 4 : i < 0 ? 1 : 5; // 5: a spot of the lowest layer
        ball.radius = r;
        ball.position = {(i + 0.5) * narrow, r + j * high, (k + 0.5) * narrow - 0.5 * depth};
        bed.balls.push_back(ball);
      }
  bed.lies = lying_soil(bed.balls);
  drive.states = {bed};
  const VerticalLines lines = lines_over(drive, usual_spacing(drive));
  const LayerTops tops = layer_tops(drive, bed, lines);
  const SoilLayers soil = soil_on(drive, bed, lines, tops, drive.measured);
  const double density = 4.0 / 3.0 * M_PI * r * r * r / (narrow * narrow * high); // overlaps count twice
  EXPECT_NEAR(soil.thickness[1], 8 * high, 1e-12);
  EXPECT_NEAR(soil.solid_fraction[1], density, 1e-11);
  EXPECT_EQ(soil.solid_fraction.size(), 2U);
  EXPECT_NEAR(soil.solid_fraction[0], density, 0.1 * density);        // a half if the spot were not counted
  EXPECT_NEAR(soil.inner_solid_fraction(0), density, 0.03 * density); // planes cut the rows anywhere
  // The mean height of a sphere's top over the square that is its own, by the mean over many points.
  double arch = 0.0;
  constexpr int points = 400;
  for (int a = 0; a < points; ++a)
    for (int b = 0; b < points; ++b) {
      const double x = narrow * ((a + 0.5) / points - 0.5), z = narrow * ((b + 0.5) / points - 0.5);
      arch += std::sqrt(r * r - x * x - z * z) / (points * points);
    }
  EXPECT_NEAR(soil.surface, r + 15 * high + arch, 0.01 * r);
  for (const DepthRow &row : depth_profile(drive, bed, {}, soil.surface, 0.1)) {
    EXPECT_FALSE(row.coordination || row.vertical); // no dump of contacts
    if (row.height > 0.1 && row.height < 0.4) {
      EXPECT_NEAR(row.solid_fraction / density, 1.0, 0.02);
    }
  }
}

TEST_F(Passes, SaysWhenTheGainIsSmall) {
  EXPECT_EQ(passes_until_level({0.0, 0.5, 0.9, 0.96, 1.0}), 3);
  EXPECT_EQ(passes_until_level({0.0, 0.5, 0.9, 1.0}), std::nullopt);        // the last one makes 10 %
  EXPECT_EQ(passes_until_level({0.0, 0.97, 0.98, 1.1, 1.0}), std::nullopt); // it goes on up and down
  EXPECT_EQ(passes_until_level({1.0, 0.5, 0.02, 0.0, 0.0}), 2);
  EXPECT_EQ(passes_until_level({0.7, 0.7}), std::nullopt);
}

TEST_F(Passes, AnswersInOneSentenceOnAPage) {
  draw();
  write_run("run");
  const Outcome outcome = passes({"run", "--out", "made/out"});
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  EXPECT_FALSE(fs::exists(folder_ / "run/passes.csv"));
  const std::string answer = lines_of(outcome.output).front();
  EXPECT_TRUE(
      contains(answer, {"3 passes compact the lift", "from a solid fraction of", "degree of compaction",
                        "relative density", "after 2 passes the gain per pass is below 5 % of the total",
                        "the surface sinks by 74.0 mm", "all layers together compact by 32.5 mm",
                        "soil that is pushed out of the measured part makes 41.5 mm", "one bed"}));
  const std::string page = read_text(folder_ / "made/out/passes/index.html");
  EXPECT_TRUE(contains(page, {"may be compared with those of other runs, not with a site",
                              "3 passes compact the lift", "no dumps with the roller on the measured part",
                              "Balls of soil that lie on no other soil after pass 3, and do not count: 1."}));
  expect_sound_page(folder_ / "made/out/passes", 4);
  for (const char *name : {"passes.csv", "way.csv", "surface.csv", "depth.csv", "acceptance.csv"})
    EXPECT_TRUE(fs::exists(folder_ / "made/out" / name)) << name;
  // A relative density below 0 says what it means.
  EXPECT_EQ(answer.find("looser than the loosest packing"), std::string::npos);
  const fs::path parameters = folder_ / "run/parameters.csv";
  write_files({{parameters, std::regex_replace(read_text(parameters), std::regex("0.9,0.9"), "0.21,0.21")}});
  EXPECT_TRUE(contains(passes({"run"}).output, {"%, looser than the loosest packing of dry soil)"}));
}

TEST_F(Passes, SaysWhetherTheSurfaceRisesAndSoilLoosens) {
  DriveRun run;
  run.bed = [bed = run.bed](int pass) { return bed(3 - pass); };
  write_run("run", run);
  const std::string answer = lines_of(passes({"run"}).output).front();
  EXPECT_TRUE(contains(answer, {"3 passes loosen the lift", "the surface rises by 74.0 mm",
                                "all layers together loosen by ", "pushed into the measured part makes "}))
      << answer;
  EXPECT_TRUE(contains(read_text(folder_ / "run/passes/index.html"),
                       {"This result contradicts experience: the lift loosened under the roller. "
                        "Disregard solid fractions, degrees of compaction and settlement"}));
}

// The page says first what makes a bed loosen whatever the roller does: suction, and soil denser than shaking
// leaves it.
TEST_F(Passes, SayWhichBedsOnlyLoosen) {
  DriveRun run;
  const auto page = [&] {
    passes({"run"});
    return read_text(folder_ / "run/passes/index.html");
  };
  const fs::path parameters = write_run("run", run) / "parameters.csv";
  const std::string loose_and_dry = page();
  EXPECT_EQ(loose_and_dry.find("The soil is moist"), std::string::npos);
  EXPECT_EQ(loose_and_dry.find("the lift began at"), std::string::npos);
  write_files({{parameters, read_text(parameters) + "tensile_strength,2e4\n"}});
  EXPECT_TRUE(contains(page(), {"The soil is moist (tensile_strength 2e4): in the model suction holds"}));
  run.bed = [](int) { return Bed{0.036, 0, 1000.0}; };
  write_run("run", run);
  EXPECT_TRUE(contains(page(), {"Inside, the lift began at a solid fraction of 0.886",
                                "shaking leaves at most 0.833 of such soil"}));
}

TEST_F(Passes, OfARollerThatDoesNotVibrateHaveNoMeterValues) {
  const fs::path parameters = write_run("run") / "parameters.csv";
  write_files({{parameters, std::regex_replace(read_text(parameters), std::regex("Fw,[0-9]+"), "Fw,0")}});
  const Outcome outcome = passes({"run"});
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, {"3 passes compact the lift", "No cell has a value of CMV.",
                                        "The exciter is off (Fw is 0): there are no meter values"}));
  const Table table = read_table(folder_ / "run/passes.csv");
  for (const char *column : {"CMV [-]", "RMV [-]", "CCV [-]", "k_B [N/m]", "k [N/m]", "D [-]", "mode"})
    EXPECT_EQ(table.text(column), std::vector<std::string>(4, "")) << column;
  EXPECT_EQ(std::stod(table.text("peak_force [N]")[3]), 3e5);
}

TEST_F(Passes, ComparesASpotWithTheCellsBesideIt) {
  const fs::path parameters = write_run("run") / "parameters.csv";
  const std::string before = read_text(parameters);
  const auto note = [&](const std::string &spots) {
    write_files({{parameters, before + "spots," + spots + "\n"}});
  };
  note("none");
  EXPECT_EQ(passes({"run"}).output.find("On the spot"), std::string::npos);
  note("\"-0.9:-0.4,0.1:0.4\"");
  const std::string spot = "On the spot from 0.1 to 0.4 m, over all passes, CMV is 60, beside it 60";
  EXPECT_TRUE(contains(passes({"run"}).output, {spot, "On the spot from -0.9 to -0.4 m"}));
  EXPECT_TRUE(contains(read_text(folder_ / "run/passes/index.html"), {spot}));
}

// CMV is 30, 60 and 90 in all five cells of the three passes.
TEST_F(Passes, JudgesTheCellsByRulesOfAcceptance) {
  write_run("run");
  refused({"run", "--target", "-1"}, "--target is '-1'; allowed: ");
  refused({"run", "--coverage", "0"}, "--coverage is '0'; allowed: ");
  refused({"run", "--meter", "MDP"}, "--meter is 'MDP'; allowed: CMV, RMV, CCV, k_B");
  refused({"run", "--meter", "E_vib", "--target", "1e6"},
          "--target is '1e6'; allowed: only where cells have");
  const Outcome outcome = passes({"run", "--target", "70"});
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, {"CMV of the last pass is 90 in the mean of 5 cells", "0 %",
                                        "100 % of the cells are at or above 70"}));
  const Table table = read_table(folder_ / "run/acceptance.csv");
  EXPECT_EQ(table.text("pass"), (std::vector<std::string>{"1", "2", "3", "last"}));
  EXPECT_EQ(table.text("cells [-]"), (std::vector<std::string>(4, "5")));
  const std::vector<double> coverage = table.numbers("coverage [-]");
  EXPECT_EQ(coverage, (std::vector<double>{0.0, 0.0, 1.0, 1.0}));
  EXPECT_EQ(table.text("gain [-]")[0], "");
  EXPECT_NEAR(std::stod(table.text("gain [-]")[1]), 1.0, 1e-9);
  EXPECT_NEAR(std::stod(table.text("gain [-]")[2]), 0.5, 1e-9);
  EXPECT_TRUE(contains(read_text(folder_ / "run/passes/index.html"),
                       {"2 of 3 acceptance criteria hold", "the last pass changes the mean by less than 5 %",
                        "at least 80 % of the cells have CMV of 70 or more"}));
  // Another meter, two runs together, no target.
  DriveRun other;
  other.seed = 2;
  write_run("other", other);
  ASSERT_TRUE(passes({"run", "other", "--meter", "peak_force"}).ok());
  const Table both = read_table(folder_ / "results/passes/acceptance.csv");
  EXPECT_EQ(both.text("cells [-]").back(), "10");
  EXPECT_NEAR(both.numbers("peak_force [N]").back(), 3e5, 1e-6);
  EXPECT_EQ(both.text("coverage [-]").back(), "");
  EXPECT_FALSE(
      contains(read_text(folder_ / "results/passes/passes/index.html"), {"acceptance criteria hold"}));
}

// In place of the run, which the report of chains and beds cannot judge.
TEST_F(Passes, HaveTheirPageInAReport) {
  draw();
  write_run("run");
  const auto report = [this] { return run_program(tool_words("report run --out report"), {}, folder_); };
  well(report());
  EXPECT_TRUE(
      contains(read_text(folder_ / "report/index.html"),
               {"<a href=\"passes/run/index.html\"><img src=\"passes/run/figures/compaction_key.svg\""}));
  EXPECT_TRUE(contains(read_text(folder_ / "report/passes/run/index.html"),
                       {"3 passes compact the lift", "k_B (MN/m per m of width)"}));
  const Table table = read_table(folder_ / "report/passes/run/data/passes_table.csv");
  const std::vector<std::string> rows = table.text("quantity");
  const auto k = [&](const std::string &row) {
    const auto at = std::find(rows.begin(), rows.end(), row);
    return at == rows.end() ? 0.0
                            : std::stod(table.text("pass 1")[static_cast<std::size_t>(at - rows.begin())]);
  };
  EXPECT_NEAR(k("k of the whole drum (MN/m)"), 2.0 * k("k (MN/m per m of width)"), 0.1);  // it is 2 m wide
  EXPECT_NEAR(k("k (MN/m per m of width)"), 1e-6 * m2 * w * w, 0.01 * 1e-6 * m2 * w * w); // as it was made
  ASSERT_TRUE(passes({"run"}).ok());
  well(report());
  EXPECT_FALSE(fs::exists(folder_ / "report/passes"));
  EXPECT_TRUE(fs::exists(folder_ / "report/studies/passes/index.html"));
  EXPECT_FALSE(contains(read_text(folder_ / "report/index.html"), {"without usable parameters"}));
}

// A record that contradicts itself has no k and D, and the answer says why.
TEST_F(Passes, HaveNoStiffnessOfASoilThatDrivesTheDrum) {
  DriveRun run;
  run.soil_drives = true;
  write_run("run", run);
  const Outcome outcome = well(passes({"run"}));
  EXPECT_TRUE(printed(outcome, {"k and D of pass 1 are not identified: ", "no soil drives the drum"}));
  const Table table = read_table(folder_ / "run/passes.csv");
  for (const char *column : {"k [N/m]", "D [-]"})
    EXPECT_TRUE(table.text(column)[1].empty()) << column;
}

// A GIF has a graphic control extension for each of its pictures.
TEST_F(Passes, ShowsAPassInMotion) {
  draw();
  write_run("run");
  for (const double share : {0.2, 0.35, 0.5, 0.65, 0.8})
    write_dump("run", {0.05, 0, 3000.0}, step_of(share * pass_time));
  ASSERT_TRUE(passes({"run"}).ok());
  expect_sound_page(folder_ / "run/passes", 6);
  EXPECT_TRUE(contains(read_text(folder_ / "run/passes/index.html"),
                       {"A pass in motion", "Pass 1 in 7 pictures", "figures/animation.gif"}));
  const std::string gif = read_text(folder_ / "run/passes/figures/animation.gif");
  EXPECT_EQ(gif.substr(0, 6), "GIF89a");
  std::size_t pictures = 0;
  const std::string control("\x21\xF9\x04", 3);
  for (std::size_t at = gif.find(control); at != std::string::npos; at = gif.find(control, at + 1))
    ++pictures;
  EXPECT_EQ(pictures, 7U); // the state before, five, and that behind the pass
}

// The mean of three beds and its interval by Student's t.
TEST_F(Passes, AveragesOverSeeds) {
  for (const int seed : {1, 2, 3}) {
    DriveRun run;
    run.cmv_of_pass = 20.0 + seed;
    run.bed = [seed](int pass) { return Bed{0.05 - 1e-3 * seed * pass, 0, 0.0}; };
    run.passes = seed == 3 ? 3 : 2;
    run.seed = seed;
    write_run(fmt::format("run{}", seed), run);
  }
  const Outcome outcome = passes({"run1", "run2", "run3"});
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  const Table table = read_table(folder_ / "results/passes/passes.csv");
  ASSERT_EQ(table.rows(), 4u);
  EXPECT_EQ(table.text("runs"), (std::vector<std::string>{"3", "3", "3", "1"}));
  EXPECT_NEAR(std::stod(table.text("CMV [-]")[3]), 69.0, 1e-9);
  EXPECT_EQ(table.text("CMV_interval [-]")[3], "");
  const double t = 4.302652729911275; // of two degrees of freedom, 97.5 %
  EXPECT_NEAR(std::stod(table.text("CMV [-]")[2]), 44.0, 1e-9);
  EXPECT_NEAR(std::stod(table.text("CMV_interval [-]")[2]), t * 2.0 / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(std::stod(table.text("settlement [m]")[1]), 4 * 2e-3, 1e-12);
  EXPECT_NEAR(std::stod(table.text("settlement_interval [m]")[1]), t * 4e-3 / std::sqrt(3.0), 1e-12);
  // The gains of the three beds are about as 1, 2 and 3, so that the mean is 2 with an interval of +- 2.5.
  EXPECT_TRUE(contains(lines_of(outcome.output).front(),
                       {"2 passes change the lift", "no more than scatter", "over 3 beds: not significant"}));
  EXPECT_TRUE(fs::exists(folder_ / "results/passes/run-3/way.csv"));
  EXPECT_TRUE(fs::exists(folder_ / "results/passes/passes/index.html"));
}

// A run that was stopped keeps the passes that are finished.
TEST_F(Passes, LeavesOutAPassThatIsNotFinished) {
  DriveRun run;
  run.ended = "no";
  run.end = 2.5 * (pass_time + pause_time);
  write_run("run", run);
  const Outcome outcome = passes({"run"});
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  EXPECT_EQ(read_table(folder_ / "run/passes.csv").rows(), 3u);
  EXPECT_TRUE(contains(outcome.output, {"2 passes compact", "Pass 3 is not finished and is left out"}));
}

// A run that was killed, or that filled the disk, ends in the middle of a row, or of the dump behind a pass.
TEST_F(Passes, KeepsTheFinishedPassesOfARunThatWasKilled) {
  DriveRun run;
  run.ended = "no";
  run.end = 2.5 * (pass_time + pause_time);
  write_run("run", run);
  const std::string bed = read_text(folder_ / "run/bed.csv"), cycles = read_text(folder_ / "run/cycles.csv");
  ASSERT_TRUE(passes({"run"}).ok());
  const Table whole = read_table(folder_ / "run/passes.csv");
  // Without its line end, in its last number, in the middle, in its first number.
  for (const std::size_t less : {1U, 3U, 60U, 190U})
    for (const bool of_cycles : {false, true}) {
      const std::string &text = of_cycles ? cycles : bed;
      const std::size_t row = text.rfind('\n', text.size() - 2) + 2; // its first digit stays
      const std::size_t end = std::max(text.size() - less, row);
      write_files({{folder_ / "run/bed.csv", of_cycles ? bed : bed.substr(0, end)},
                   {folder_ / "run/cycles.csv", of_cycles ? cycles.substr(0, end) : cycles}});
      const Outcome outcome = passes({"run"});
      ASSERT_TRUE(outcome.ok()) << outcome.output << less;
      EXPECT_TRUE(contains(outcome.output, {"2 passes compact", "Pass 3 is not finished and is left out"}));
      const Table cut = read_table(folder_ / "run/passes.csv");
      ASSERT_EQ(cut.rows(), 3U);
      for (const char *column : {"settlement [m]", "CMV [-]", "CCV [-]", "k_B [N/m]", "mode"})
        EXPECT_EQ(cut.text(column), whole.text(column)) << column;
    }
  run.end = 0.0;
  write_run("run", run);
  const fs::path last =
      folder_ / "run/dump" / fmt::format("balls_{}.dump", step_of(3.0 * (pass_time + pause_time)));
  write_files({{last, read_text(last).substr(0, 5000)}});
  const Outcome outcome = passes({"run"});
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, {"2 passes compact", "Pass 3 is left out", "is cut short"}));
}

// Runs are pooled if they differ in the seed alone.
TEST_F(Passes, OfOneSceneOnBedsOfTheirOwnArePooled) {
  DriveRun second;
  second.seed = 2;
  write_run("run");
  const fs::path parameters = write_run("other", second) / "parameters.csv";
  const std::string good = read_text(parameters);
  const auto differs = [&](const std::string &row, const std::string &says) {
    write_files({{parameters, good + row}});
    refused({"run", "other"}, "FOLDER is 'other'; allowed: runs that differ in the seed of their beds alone: "
                              "here and in run " +
                                  says);
  };
  for (const char *name : {"k", "friction", "transition", "poured", "engine"})
    differs(fmt::format("{},other\n", name), fmt::format("{} is 'other' and 'unknown'", name));
  write_files({{parameters, std::regex_replace(good, std::regex("m2,2000"), "m2,2001")}});
  refused({"run", "other"}, "m2 is '2001' and '2000'");
  write_files({{parameters, std::regex_replace(good, std::regex("seed,2"), "seed,1")}});
  refused({"run", "other"}, "both are of one bed, seed 1");
  // A run of an earlier version does not note its seed, but what follows from it.
  const std::string earlier = std::regex_replace(good, std::regex("seed,2\n"), "");
  write_files({{parameters, earlier}, {folder_ / "run/parameters.csv", earlier}});
  refused({"run", "other"}, "both are of one bed, seed unknown");
  write_files({{parameters, earlier + "d50,0.04\nout,other\nranks,2\n"}});
  EXPECT_TRUE(passes({"run", "other"}).ok());
}

// Files of a run that goes on grow while they are read, and are not equally long.
TEST_F(Passes, OfARunThatGoesOnAreThoseThatAreFinished) {
  DriveRun run;
  run.ended = "no";
  write_run("run", run);
  const std::string bed = read_text(folder_ / "run/bed.csv"), cycles = read_text(folder_ / "run/cycles.csv");
  const auto begin_of = [](const std::string &text, double share) {
    return text.find('\n', static_cast<std::size_t>(share * static_cast<double>(text.size()))) + 1;
  };
  for (const double share_of_cycles : {0.75, 0.8, 0.95}) {
    const std::size_t begun = begin_of(bed, 0.8);
    write_files({{folder_ / "run/bed.csv", bed.substr(0, begun)},
                 {folder_ / "run/cycles.csv", cycles.substr(0, begin_of(cycles, share_of_cycles))}});
    std::atomic<bool> done = false;
    std::thread engine([&] {
      std::ofstream file(folder_ / "run/bed.csv", std::ios::app);
      const std::size_t most = begin_of(bed, 0.95); // of a pass that is not finished
      for (std::size_t at = begun; at < most && !done; at += 50) {
        file << bed.substr(at, std::min<std::size_t>(50, most - at)) << std::flush;
        std::this_thread::sleep_for(std::chrono::microseconds(50));
      }
    });
    const Outcome outcome = passes({"run"});
    done = true;
    engine.join();
    ASSERT_TRUE(outcome.ok()) << outcome.output;
    EXPECT_TRUE(contains(outcome.output, {"2 passes compact", "Pass 3 is not finished and is left out"}));
  }
}

TEST_F(Passes, RefusesInOneLine) {
  write_run("run");
  refused({"nowhere"}, "FOLDER is 'nowhere'; allowed: the folder of a run of inputs/bed/in.drive");
  for (const char *cell : {"0", "-1", "", "wide", "nan"})
    refused({"run", "--cell", cell}, fmt::format("--cell is '{}'; allowed: ", cell));
  refused({"run", "--cell", "0.2"}, "--cell is '0.2'; allowed: a number from 0.2222, 4 cycles");
  refused({"run", "--cell", "2.1"}, "to 2, the measured part of the way [m]");
  refused({"run", "--spacing", "1e-6"}, "--spacing is '1e-06'; allowed: a spacing of at most 1e+06 lines");
  refused({"run", "run"}, "FOLDER is 'run'; allowed: each run once");
  refused({"run", "--out", "run/bed.csv"}, "allowed: a folder that can be made and written to");
  refused({"run", "--drum-radius", "0.75"}, "--drum-width is ''; allowed: ");
  const auto without = [&](const std::string &name, const std::string &old, const std::string &text) {
    const std::string before = read_text(folder_ / "run" / name);
    std::string now = before;
    const std::size_t at = now.find(old);
    ASSERT_NE(at, std::string::npos) << old;
    write_files({{folder_ / "run" / name, now.replace(at, old.size(), text)}});
    return write_files({{folder_ / "kept", before}});
  };
  const auto restore = [&](const std::string &name) { fs::rename(folder_ / "kept", folder_ / "run" / name); };
  without("parameters.csv", "deck,drive", "deck,bed");
  refused({"run"}, "column 'deck' is 'bed'; allowed: drive, a run of inputs/bed/in.drive");
  restore("parameters.csv");
  without("parameters.csv", "measure_to,1", "measure_to,-1");
  refused({"run"}, "column 'measure_to' is '-1'; allowed: another place than measure_from");
  restore("parameters.csv");
  without("parameters.csv", "measure_to,1", "measure_to,3");
  refused({"run"}, "pass 1 does not lead from one side of the measured part");
  restore("parameters.csv");
  for (const char *spots : {"0.5", "0.5:0.5", "0.5:", "near:0.5"}) {
    without("parameters.csv", "ended,yes", fmt::format("spots,{}\nended,yes", spots));
    refused({"run"}, fmt::format("column 'spots' is '{}'; allowed: none, or FROM:TO,FROM:TO [m]", spots));
    restore("parameters.csv");
  }
  // On a periodic bed that is longer than a pass each pass has other soil.
  without("parameters.csv", "ended,yes", "direction,one\nended,yes");
  refused({"run"}, "column 'direction' is 'one'; allowed: both; or one, with passes as long as");
  restore("parameters.csv");
  without("bed.csv", "traction", "pull");
  refused({"run"}, "allowed: one that names 'traction'");
  restore("bed.csv");
  without("parameters.csv", "measure_to,1", "measure_to,3.1");
  refused({"run"}, "the measured part is '-1 to 3.1 m'; allowed: one on the soil, -3 to 3 m");
  restore("parameters.csv");
  const long end = step_of(2.0 * (pass_time + pause_time));
  const fs::path dump = folder_ / "run/dump" / fmt::format("balls_{}.dump", end);
  fs::rename(dump, folder_ / "dump");
  refused({"run"}, "a dump with the roller standing at the end of pass 2");
  fs::rename(folder_ / "dump", dump);
  write_files({{dump, read_text(dump).substr(0, 5000)}});
  refused({"run"}, "is cut short");
  fs::remove_all(folder_ / "run/dump");
  refused({"run"}, "FOLDER is 'run'; allowed: a run with dumps");
}

} // namespace passes

// Maps of meter values: means, gains and coverage of maps whose values follow by hand.
namespace along {

using namespace drumlin::post;

constexpr double cell = 0.34;

/// Cells in a row, and their values pass by pass; NaN: none.
MeterMap row_of_cells(const std::vector<std::vector<double>> &passes) {
  MeterMap map;
  map.cell = cell;
  for (std::size_t i = 0; i < passes.front().size(); ++i)
    map.places.push_back({0, cell * (static_cast<double>(i) + 0.5)});
  for (std::size_t pass = 0; pass < passes.size(); ++pass)
    for (std::size_t i = 0; i < passes[pass].size(); ++i)
      if (!std::isnan(passes[pass][i]))
        map.values.push_back({static_cast<int>(pass) + 1, i, passes[pass][i]});
  return map;
}

TEST(MeterMap, CountsCellsAsRulesOfAcceptanceDo) {
  const MeterMap map = row_of_cells({{10, 20, 30, NAN}, {20, 20, 40, 20}, {22, 21, NAN, 17}});
  AcceptanceRule rule;
  rule.target = 20.0;
  const std::vector<PassCells> rows = cells_of_passes(map, rule);
  ASSERT_EQ(rows.size(), 4u); // three passes, and the last value of each cell: 22, 21, 40, 17
  EXPECT_EQ(rows[0].cells, 3u);
  EXPECT_DOUBLE_EQ(rows[0].mean, 20.0);
  EXPECT_DOUBLE_EQ(rows[0].deviation, 10.0);
  EXPECT_DOUBLE_EQ(rows[0].variation(), 0.5);
  EXPECT_FALSE(rows[0].gain);
  EXPECT_NEAR(*rows[0].coverage, 2.0 / 3.0, 1e-15);
  EXPECT_DOUBLE_EQ(rows[1].mean, 25.0);
  EXPECT_NEAR(*rows[1].gain, 80.0 / 60.0 - 1.0, 1e-15); // of the three cells that both passes have
  EXPECT_DOUBLE_EQ(*rows[1].coverage, 1.0);             // a value at the target counts
  EXPECT_NEAR(*rows[2].gain, 60.0 / 60.0 - 1.0, 1e-15);
  EXPECT_DOUBLE_EQ(rows[3].mean, 25.0);
  EXPECT_NEAR(rows[3].deviation, std::sqrt((9.0 + 16.0 + 225.0 + 64.0) / 3.0), 1e-12);
  EXPECT_DOUBLE_EQ(*rows[3].coverage, 0.75);
  EXPECT_EQ(passes_until_gain(rows, rule), 2);
  rule.gain = 0.5;
  EXPECT_EQ(passes_until_gain(rows, rule), 1);
  EXPECT_EQ(passes_until_gain(cells_of_passes(row_of_cells({{10}, {11}}), {}), {}), std::nullopt);
  EXPECT_TRUE(contains(answer_of(map, rows, rule), {"CMV of the last pass is 25 in the mean of 4 cells",
                                                    "75 % of the cells are at or above 20"}));
  EXPECT_FALSE(cells_of_passes(map, {}).front().coverage);
  EXPECT_TRUE(
      contains(answer_of(map, cells_of_passes(map, {}), {}), {"without a target", "nothing is judged"}));
}

// Five cells of 0.34 m in two passes. The middles of the second and third lie on the spot; the fourth
// overlaps it and counts neither as on it nor as beside it. On the spot CMV is lower by 11 in the first bed
// and by 13 in the second, in the mean by 12 with a 95 % interval of +- 12.7.
TEST(MeterMap, TellsCellsOnASpotFromThoseBeside) {
  MeterMap map = row_of_cells({{30, 18, 16, 1, 28}, {32, 20, 22, 1, 30}});
  map.meter = "CMV";
  map.spots = {{0.34, 1.1}};
  EXPECT_EQ(answers_on_spots(map),
            std::vector<std::string>{"On the spot from 0.34 to 1.1 m, over all passes, CMV is 19, beside it "
                                     "30: a difference of -11 (one bed, which is one sample)."});
  const MeterMap other = row_of_cells({{31, 18, 18, 2, 31}, {31, 18, 18, 2, 31}});
  for (const MapPlace &place : other.places)
    map.places.push_back({1, place.along});
  for (const MapValue &one : other.values)
    map.values.push_back({one.pass, one.place + 5, one.value});
  EXPECT_TRUE(contains(answers_on_spots(map).front(),
                       {"CMV is 18.5, beside it 30.5: a difference of -12 ± 13 (95 %, over 2 beds: not "
                        "significant)"}));
  map.spots.push_back({1.4, 1.7}); // the last cell is now on a spot, so that only the first lies beside
  ASSERT_EQ(answers_on_spots(map).size(), 2u);
  EXPECT_TRUE(contains(answers_on_spots(map).back(), {"from 1.4 to 1.7 m", "is 30, beside it 31"}));
  map.spots = {{5.0, 6.0}};
  EXPECT_TRUE(answers_on_spots(map).empty());
}

} // namespace along

} // namespace
} // namespace drumlin::test
