// Calibration with closed forms in the place of beds: the parameters that were put in must be found again.
#include "tests/support/chain_record.h"
#include "tests/support/engine_runs.h"
#include "calibration/calibration.h"
#include "calibration/evaluations.h"
#include "chain/exact_solution.h"
#include "engine/deck_run.h"
#include "identify/identified_record.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

// A normal random number that belongs to a seed and, if it is given, to a point.
double scatter(unsigned replicate, int seed, std::size_t target, double point = 0.0) {
  std::seed_seq all{replicate, static_cast<unsigned>(seed), static_cast<unsigned>(target),
                    static_cast<unsigned>(std::hash<double>{}(point))};
  std::mt19937_64 engine(all);
  return std::normal_distribution<double>()(engine);
}

// Targets that are powers of k and D: k_lumped = 0.05 k^0.9 D^0.1, D_lumped = 0.8 D^0.7 k^-0.05.
double lumped_k(double k, double D) { return 0.05 * std::pow(k, 0.9) * std::pow(D, 0.1); }
double lumped_D(double k, double D) { return 0.8 * std::pow(D, 0.7) * std::pow(k, -0.05); }

constexpr double true_k = 4e8, true_D = 0.25;

post::CalibrationTask two_of_two(int seeds) {
  post::CalibrationTask task;
  task.vary = {{"k", 1e8, 1e10}, {"D", 0.05, 0.8}};
  task.targets = {{"k", lumped_k(true_k, true_D), 0.05}, {"D", lumped_D(true_k, true_D), 0.05}};
  task.seeds = seeds;
  return task;
}

// The powers with a scatter of the seeds' beds of 10 %, and one of 2 % from point to point, as a chaotic bed
// has it.
post::MeasureSeed scattered(unsigned replicate, double of_seeds = 0.1, double of_points = 0.02) {
  return [=](const post::Evaluation &evaluation, int seed) {
    const double k = evaluation.point[0], D = evaluation.point[1];
    const auto factor = [&](std::size_t target) {
      return std::exp(of_seeds * scatter(replicate, seed, target) +
                      of_points * scatter(replicate, seed, target, k * D));
    };
    return std::vector<double>{lumped_k(k, D) * factor(0), lumped_D(k, D) * factor(1)};
  };
}

TEST(PointSearch, FindsTheSmallestValueAndContinues) {
  const auto value = [](const std::vector<double> &at) {
    return 10.0 * (std::pow(at[0] - 0.3, 2) + std::pow(at[1] - 0.7, 2));
  };
  std::vector<post::SearchPoint> known;
  for (int call = 0; call < 5; ++call) { // each continues with the points of those before
    post::PointSearch search(2, 0.001, known);
    for (int round = 0; round < 4; ++round) {
      const std::vector<double> first = search.next(), second = search.next();
      search.give({value(first), value(second)});
      known.push_back({first, value(first)});
      known.push_back({second, value(second)});
    }
  }
  double best = 1.0;
  for (const post::SearchPoint &point : known)
    best = std::min(best, point.value);
  EXPECT_LT(best, 1e-2);
}

TEST(SlopesOfTargets, IsThatOfPowersExactly) {
  post::CalibrationTask task = two_of_two(3);
  std::vector<post::Evaluation> evaluations;
  const auto add = [&](const std::vector<double> &point) {
    post::Evaluation one;
    one.number = static_cast<int>(evaluations.size()) + 1;
    one.point = point;
    for (int seed = 1; seed <= task.seeds; ++seed) {
      const double factor = 1.0 + 0.1 * (seed - 2); // of a seed's bed
      one.seeds.push_back(
          {seed, {factor * lumped_k(point[0], point[1]), factor * lumped_D(point[0], point[1])}, {}});
    }
    evaluations.push_back(one);
  };
  add({5e8, 0.2});
  for (const std::vector<double> &point : post::slope_points(task, {5e8, 0.2}))
    add(point);
  ASSERT_EQ(evaluations.size(), 5u);
  const post::Sensitivity found = post::sensitivity_at(task, evaluations, evaluations.front());
  const double slopes[2][2] = {{0.9, 0.1}, {-0.05, 0.7}};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      EXPECT_NEAR(found.slopes[i][j].mean, slopes[i][j], 1e-9);
  // The correlation of the inverse of the normal matrix of these slopes.
  const double a = 0.9 * 0.9 + 0.05 * 0.05, b = 0.9 * 0.1 - 0.05 * 0.7, c = 0.1 * 0.1 + 0.7 * 0.7;
  EXPECT_NEAR(found.correlation[0][1], -b / std::sqrt(a * c), 1e-9);
  // Seeds whose beds are stiffer by a factor need parameters that are smaller: the solution of the two
  // powers.
  const double off = std::log(0.9 * 1.1) / 3.0, det = 0.9 * 0.7 + 0.1 * 0.05;
  EXPECT_NEAR(std::log(found.parameters[0].value / true_k), -off * (0.7 - 0.1) / det, 1e-9);
  EXPECT_NEAR(std::log(found.parameters[1].value / true_D), -off * (0.9 + 0.05) / det, 1e-9);
  EXPECT_TRUE(found.identified());
}

TEST(Calibration, FindsParametersAgainWithinTheirIntervals) {
  constexpr unsigned replicates = 40;
  const post::CalibrationTask task = two_of_two(5);
  int within_k = 0, within_D = 0;
  for (unsigned replicate = 1; replicate <= replicates; ++replicate) {
    const Scratch scratch;
    const post::Calibration found = post::calibrate(task, {20, 1}, scratch.path(), scattered(replicate));
    ASSERT_TRUE(found.sensitivity.identified()) << replicate;
    const auto holds = [](const post::ParameterEstimate &one, double truth) {
      return one.low <= truth && truth <= one.high;
    };
    within_k += holds(found.sensitivity.parameters[0], true_k) ? 1 : 0;
    within_D += holds(found.sensitivity.parameters[1], true_D) ? 1 : 0;
    EXPECT_LT(found.best.objective(task), 0.5) << replicate;
  }
  // Of 40 intervals of 95 %, 38 hold the truth on average, and fewer than 34 with a probability of 0.3 %.
  EXPECT_GE(within_k, 34);
  EXPECT_GE(within_D, 34);
}

TEST(Calibration, FindsTheLumpedSoilThatIdentifySeesInAChain) {
  // The contact below the drum is 0.1 times as stiff as those of the balls, and as much damped; a seed's by 3
  // % more or less.
  const auto measure = [](const post::Evaluation &evaluation, int seed) {
    post::ChainParameters chain;
    chain.k = 0.1 * evaluation.point[0] * std::exp(0.03 * scatter(1, seed, 0));
    chain.D = evaluation.point[1] * std::exp(0.03 * scatter(1, seed, 1));
    const post::ChainHistory history = post::solve_chain(chain, 12, 200).history;
    const post::LawEstimate law = post::identify_record(record_of(chain, history), {}).whole.law;
    return std::vector<double>{law.k.mean, law.D.mean};
  };
  post::CalibrationTask task;
  task.vary = {{"k", 1e8, 1e10}, {"D", 0.05, 0.8}};
  task.targets = {{"k", 2e7, 0.05}, {"D", 0.2, 0.05}};
  task.seeds = 3;
  const Scratch scratch;
  const post::Calibration found = post::calibrate(task, {8, 1}, scratch.path(), measure);
  ASSERT_TRUE(found.sensitivity.identified());
  const post::ParameterEstimate &k = found.sensitivity.parameters[0], &D = found.sensitivity.parameters[1];
  EXPECT_TRUE(k.low < 2e8 && 2e8 < k.high) << k.low << " to " << k.high;
  EXPECT_TRUE(D.low < 0.2 && 0.2 < D.high) << D.low << " to " << D.high;
  EXPECT_NEAR(found.sensitivity.slopes[0][0].mean, 1.0, 1e-2);
  EXPECT_NEAR(found.sensitivity.slopes[1][1].mean, 1.0, 1e-2);
}

TEST(Calibration, SaysWhichParameterHasNoEffect) {
  post::CalibrationTask task = two_of_two(5);
  task.vary[1] = {"rolling", 0.1, 1.0};
  const auto measure = [](const post::Evaluation &evaluation, int seed) {
    const double k = evaluation.point[0], other = evaluation.point[1];
    return std::vector<double>{lumped_k(k, true_D) * std::exp(0.02 * scatter(7, seed, 0, k * other)),
                               lumped_D(k, true_D) * std::exp(0.02 * scatter(7, seed, 1, k * other))};
  };
  const Scratch scratch;
  const post::Sensitivity found = post::calibrate(task, {15, 1}, scratch.path(), measure).sensitivity;
  EXPECT_EQ(found.parameters[0].unidentified, "");
  EXPECT_TRUE(contains(found.parameters[1].unidentified, "every slope contains zero"));
}

TEST(Calibration, SaysWhichParametersCannotBeToldApart) {
  const post::CalibrationTask task = two_of_two(5); // both targets follow the product k D
  const auto measure = [](const post::Evaluation &evaluation, int seed) {
    const double product = evaluation.point[0] * evaluation.point[1];
    return std::vector<double>{product * std::exp(0.02 * scatter(3, seed, 0, evaluation.point[0])),
                               1e-9 * product * std::exp(0.02 * scatter(3, seed, 1, evaluation.point[1]))};
  };
  const Scratch scratch;
  const post::Sensitivity found = post::calibrate(task, {15, 1}, scratch.path(), measure).sensitivity;
  for (const post::ParameterEstimate &one : found.parameters)
    EXPECT_TRUE(contains(one.unidentified, "is correlated with"));
}

TEST(Calibration, ContinuesWithoutMeasuringAgain) {
  const post::CalibrationTask task = two_of_two(3);
  const Scratch scratch;
  std::atomic<int> calls = 0;
  const post::MeasureSeed counted = [&calls, inner = scattered(1)](const post::Evaluation &evaluation,
                                                                   int seed) {
    ++calls;
    return inner(evaluation, seed);
  };
  const post::Calibration whole = post::calibrate(task, {9, 4}, scratch.path(), counted);
  EXPECT_EQ(calls, static_cast<int>(whole.evaluations.size()) * task.seeds);
  const fs::path file = scratch / post::evaluations_name;
  const std::string text = post::read_text(file);
  calls = 0;
  const post::Calibration again = post::calibrate(task, {9, 4}, scratch.path(), counted);
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(again.best.point, whole.best.point);
  EXPECT_EQ(again.sensitivity.parameters[0].low, whole.sensitivity.parameters[0].low);
  EXPECT_EQ(post::read_text(file), text);

  // Killed while it wrote the fourth row: the first evaluation is finished, the second one is not.
  std::size_t end = 0;
  for (int line = 0; line < 5; ++line)
    end = text.find('\n', end) + 1;
  post::write_files({{file, text.substr(0, end - 5)}});
  calls = 0;
  const post::Calibration rest = post::calibrate(task, {9, 4}, scratch.path(), counted);
  EXPECT_EQ(calls, static_cast<int>(rest.evaluations.size()) * task.seeds - 3);
  EXPECT_EQ(rest.evaluations.front().point, whole.evaluations.front().point);
}

/// The text of evaluations.csv after a calibration that begins with `text`.
std::string continued(const post::CalibrationTask &task, const post::CalibrationEffort &effort,
                      const post::MeasureSeed &measure, const std::string &text) {
  const Scratch scratch;
  const fs::path file = scratch / post::evaluations_name;
  post::write_files({{file, text}});
  post::calibrate(task, effort, scratch.path(), measure);
  return post::read_text(file);
}

// Interrupted after any row, or within one, with points of which some fail, and with several points at a
// time, of which an interruption leaves any.
TEST(Calibration, ContinuedGivesWhatOneWithoutInterruptionGives) {
  const post::CalibrationTask task = two_of_two(2);
  const post::MeasureSeed measure = [inner = scattered(6)](const post::Evaluation &evaluation, int seed) {
    if (evaluation.point[0] > 3e9) throw post::SceneFault("no contact");
    return inner(evaluation, seed);
  };
  for (const post::CalibrationEffort &effort :
       {post::CalibrationEffort{9, 1, 1}, post::CalibrationEffort{9, 4, 2}}) {
    const std::string whole = continued(task, effort, measure, "");
    EXPECT_TRUE(contains(whole, "no contact"));
    std::vector<std::size_t> ends; // of the lines
    for (std::size_t end = whole.find('\n'); end != std::string::npos; end = whole.find('\n', end + 1))
      ends.push_back(end + 1);
    ASSERT_GT(ends.size(), 26U);
    for (std::size_t line = 0; line + 1 < ends.size(); ++line) {
      EXPECT_EQ(continued(task, effort, measure, whole.substr(0, ends[line])), whole) << line;
      EXPECT_EQ(continued(task, effort, measure, whole.substr(0, ends[line] + 9)), whole) << line;
      // Of the points that were measured at the same time, only the last seed of the last has arrived.
      const std::size_t at_once = 2 * static_cast<std::size_t>(effort.at_once);
      if (line % at_once != 0 || line + at_once > 2 * 9) continue;
      const std::string last =
          whole.substr(ends[line + at_once - 1], ends[line + at_once] - ends[line + at_once - 1]);
      EXPECT_EQ(continued(task, effort, measure, whole.substr(0, ends[line]) + last), whole) << line;
    }
  }
}

TEST(Calibration, SaysThatEvaluationsAreOfAnotherSearch) {
  const post::CalibrationTask task = two_of_two(2);
  const std::string two_at_once = continued(task, {8, 1, 4}, scattered(6), "");
  testing::internal::CaptureStdout();
  continued(task, {12, 1, 1}, scattered(6), two_at_once);
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_TRUE(contains(said, "the evaluations that are there are of another search"));
}

// A full disk, or an engine that was killed: the calibration ends, and continues as if it had not happened.
TEST(Calibration, EndsWithAFailureThatMayPass) {
  const post::CalibrationTask task = two_of_two(2);
  const std::string whole = continued(task, {9, 1}, scattered(8), "");
  for (const int jobs : {1, 3}) {
    const Scratch scratch;
    std::atomic<int> calls = 0;
    const post::MeasureSeed passing = [&calls, inner = scattered(8)](const post::Evaluation &evaluation,
                                                                     int seed) {
      if (++calls == 7) throw std::runtime_error("exit status 137");
      return inner(evaluation, seed);
    };
    EXPECT_EQ(error_of([&] {
                post::calibrate(task, {9, jobs}, scratch.path(), passing);
              }),
              "exit status 137");
    EXPECT_FALSE(contains(post::read_text(scratch / post::evaluations_name), "137"));
    post::calibrate(task, {9, jobs}, scratch.path(), passing);
    EXPECT_EQ(post::read_text(scratch / post::evaluations_name), whole);
  }
}

TEST(Calibration, RefusesRowsOfNoCalibration) {
  const post::CalibrationTask task = two_of_two(2);
  const std::string header = "evaluation,seed,stage,k,D,measured k,measured D,failure\n";
  const std::string row = "1,1,search,1e9,0.2,1e6,0.2,\n";
  for (const auto &[rows, message] : std::vector<std::pair<std::string, std::string>>{
           {row + row, "line 3, column 'evaluation,seed' is '1,1'; allowed: each once, or --fresh"},
           {row + "1,2,search,2e9,0.2,1e6,0.2,\n",
            "line 3, column 'evaluation' is '1'; allowed: one stage and one point"},
           {row + "1,3,search,1e9,0.2,1e6,0.2,\n",
            "line 3, column 'seed' is '3'; allowed: a whole number from 1 to 2"},
           {"0,1,search,1e9,0.2,1e6,0.2,\n",
            "line 2, column 'evaluation' is '0'; allowed: a whole number from 1"},
           {"1,1,search,1e9,0.2,1e6,-0.2,\n",
            "line 2, column 'measured D' is '-0.2'; allowed: a number above 0"},
           {"1,1,search,1e9,0.2,,0.2,\n", "line 2, column 'measured k' is ''; allowed: a finite number"},
           {"1,1,start,1e9,0.2,1e6,0.2,\n",
            "line 2, column 'stage' is 'start'; allowed: search, slopes, estimate"}}) {
    const std::string text = header + rows;
    EXPECT_TRUE(contains(error_of([&] { continued(task, {3, 1}, scattered(8), text); }), message));
  }
}

TEST(Calibration, GivesParametersWithinTheirIntervals) {
  const post::CalibrationTask task = two_of_two(2);
  post::Calibration found;
  found.best.point = {9e8, 0.2};
  found.sensitivity.parameters = {{9.2e8, 8.5e8, 1e9, {}}, {0.21, 0.15, 0.3, {}}};
  EXPECT_EQ(post::found_point(task, found), found.best.point);
  found.best.point[0] = 1.095e9;
  EXPECT_EQ(post::found_point(task, found), (std::vector<double>{9.2e8, 0.21}));
  found.sensitivity.parameters[1] = {1.5, 1.1, 2.0, {}}; // beyond the range of D
  EXPECT_EQ(error_of([&] {
              post::found_point(task, found);
            }).find("--vary is 'D=0.05:0.8'; allowed: a range with 1.5, "),
            0U);
}

TEST(Calibration, SearchesOnWherePointsFail) {
  const post::CalibrationTask task = two_of_two(3);
  const post::MeasureSeed failing = [inner = scattered(2)](const post::Evaluation &evaluation, int seed) {
    if (evaluation.point[0] > 2e9 && seed == 2) throw post::SceneFault("no contact");
    std::vector<double> values = inner(evaluation, seed);
    if (evaluation.point[1] > 0.6) values[1] = -0.1; // which has no logarithm
    return values;
  };
  const Scratch scratch;
  const post::Calibration found = post::calibrate(task, {25, 1}, scratch.path(), failing);
  std::size_t failed = 0;
  for (const post::Evaluation &one : found.evaluations)
    if (!one.failure().empty()) ++failed;
  EXPECT_GT(failed, 0u);
  EXPECT_LT(found.best.objective(task), 1.0);

  const Scratch empty;
  EXPECT_EQ(error_of([&] {
              post::calibrate(task, {25, 1}, empty.path(),
                              [](const post::Evaluation &, int) -> std::vector<double> {
                                throw post::SceneFault("no contact");
                              });
            }),
            "none of 4 evaluations succeeded; the last one: no contact");
}

TEST(Calibration, WidensIntervalsForTargetsThatScatterToo) {
  post::CalibrationTask task = two_of_two(5);
  const post::MeasureSeed steady = scattered(4, 0.1, 0.0); // no scatter from point to point
  const Scratch scratch;
  const post::Calibration exact = post::calibrate(task, {12, 1}, scratch.path(), steady);
  task.target_beds = 1;
  const post::Calibration one_bed = post::calibrate(task, {12, 1}, scratch.path(), steady);
  for (std::size_t j = 0; j < 2; ++j) {
    const post::ParameterEstimate &narrow = exact.sensitivity.parameters[j],
                                  &wide = one_bed.sensitivity.parameters[j];
    EXPECT_NEAR(std::log(wide.high / wide.low), std::sqrt(6.0) * std::log(narrow.high / narrow.low), 1e-9);
  }
}

// Counts the confidence intervals of k and of D that contain the known values, in 20 sets of calibrating
// beds, each of which is calibrated to 4 other beds that have the known values, one after the other. The
// intervals of one set are not independent.
std::array<long, 2> held_intervals(double of_seeds, double of_points) {
  constexpr int beds = 4;
  constexpr unsigned sets = 20;
  const std::vector<double> known = {true_k, true_D};
  std::array<long, 2> held{};
  for (unsigned set = 1; set <= sets; ++set) {
    const Scratch scratch;
    const post::MeasureSeed measure = scattered(set, of_seeds, of_points);
    post::CalibrationTask task = two_of_two(5);
    task.target_beds = 1;
    for (int bed = 1; bed <= beds; ++bed) {
      const std::vector<double> values = measure({0, post::Stage::search, known, {}}, task.seeds + bed);
      for (std::size_t i = 0; i < values.size(); ++i)
        task.targets[i].value = values[i];
      const post::Calibration found = post::calibrate(task, {12, 1}, scratch.path(), measure);
      for (std::size_t j = 0; j < held.size(); ++j) {
        const post::ParameterEstimate &one = found.sensitivity.parameters[j];
        held.at(j) += one.low <= known[j] && known[j] <= one.high ? 1 : 0;
      }
    }
  }
  return held;
}

// Intervals of 95 % confidence contain the known value in 95 % of the cases: in 76 of 80 on average.
constexpr long enough = 68;

// The bed of a record scatters as much as each calibrating bed. Intervals that left this out would contain
// the known value in three of four cases only.
TEST(Recovery, FindsTheKnownParametersOfSingleBeds) {
  const std::array<long, 2> held = held_intervals(0.1, 0.02);
  EXPECT_GE(held[0], enough);
  EXPECT_GE(held[1], enough);
}

// If each point has a scatter of its own, a fit averages it, and scatters less than the single bed of the
// record.
TEST(Recovery, FindsTheKnownParametersOfBedsWhosePackingIsAnotherAtEachPoint) {
  const std::array<long, 2> held = held_intervals(0.0, 0.1);
  EXPECT_GE(held[0], enough);
  EXPECT_GE(held[1], enough);
}

} // namespace
} // namespace drumlin::test
