#include "calibration/soil_tests.h"

#include "bed/element_results.h"
#include "engine/deck_run.h"
#include "experiment/quantity.h"
#include "experiment/scene.h"
#include "support/csv.h"
#include "support/files.h"
#include "support/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr double default_frequency = 20.0; ///< Hz, of in.bed
constexpr int step_digits = 6;             ///< of time steps
constexpr const char *pour_friction = "pour_friction";
constexpr std::array law_names = {"k", "D", "friction", "rolling"}; ///< of the soil's contacts

/// The value that fixed variables or a point give a variable; empty if it is the deck's default.
std::string value_of(const CalibrationTask &task, const std::vector<double> &point, const std::string &name) {
  for (std::size_t i = 0; i < task.vary.size(); ++i)
    if (task.vary[i].name == name) return number_text(point[i]);
  return task.fixed_value(name).value_or("");
}

/// The values of several variables, without those that are the deck's defaults.
template <class Names>
Variables values_of(const CalibrationTask &task, const std::vector<double> &point, const Names &names) {
  Variables values;
  for (const char *name : names)
    if (std::string value = value_of(task, point, name); !value.empty()) values.emplace_back(name, value);
  return values;
}

/// k [N/m] or D of the contacts at a point; that of case.gravel if nothing else is given.
double number_of(const CalibrationTask &task, const std::vector<double> &point, const std::string &name,
                 double gravel) {
  const std::string value = value_of(task, point, name);
  return value.empty() ? gravel : number_from_text(value);
}

/// Time step [s] for discs of a smallest radius of 16 mm: a sixteenth of an undamped contact of two of them,
/// which takes pi sqrt(m/(2 k)). The longest stable step of the stepping `stock` is in proportion to sqrt(1 +
/// D^2) - D: with more damping than gravel has the step is shorter in this proportion.
double time_step(const CalibrationTask &task, const std::vector<double> &point) {
  constexpr double gravel_k = 1e9, gravel_D = 0.3, steps = 16.0;
  const double mass = pi * 0.016 * 0.016 * soil_density;
  const auto stable = [](double D) { return std::sqrt(1.0 + D * D) - D; };
  const double damped = stable(number_of(task, point, "D", gravel_D)) / stable(gravel_D);
  return pi * std::sqrt(0.5 * mass / number_of(task, point, "k", gravel_k)) / steps * std::min(1.0, damped);
}

/// steps_per_cycle of in.bed, in multiples of 250.
int steps_per_cycle(double step, double frequency) {
  return 250 * static_cast<int>(std::ceil(1.0 / (frequency * step) / 250.0));
}

} // namespace

PackingOptions packing_of(const CalibrationTask &task) {
  PackingOptions packing;
  packing.balls = task.balls;
  packing.width *= std::sqrt(task.balls / 2500.0); // as deep in relation to the width as the default bed
  return packing;
}

bool measures(const CalibrationTask &task, SoilTest test) {
  return std::any_of(task.targets.begin(), task.targets.end(),
                     [test](const auto &target) { return soil_quantity(target.name).test == test; });
}

/// A point of the search together with the bed of one seed.
struct SoilTests::Point {
  const Evaluation &evaluation;
  int seed;
  Variables law; ///< variables of the contact law that differ from the deck's defaults
  double step;   ///< of time [s]
  Scene scene;   ///< the roller on its bed
};

SoilTests::SoilTests(CalibrationTask task, fs::path out) : task_(std::move(task)), out_(std::move(out)) {}

SoilTests::Point SoilTests::point_of(const Evaluation &evaluation, int seed) const {
  Point point{evaluation,
              seed,
              values_of(task_, evaluation.point, law_names),
              time_step(task_, evaluation.point),
              {fmt::format("evaluation {}", evaluation.number), "bed/in.bed", SoilBed{packing_of(task_)}}};
  const auto set = [&point](Scope scope, const Variables &variables) {
    for (const auto &[name, value] : variables)
      point.scene.settings.push_back({scope, name, value});
  };
  // The soil settles with the contacts that it keeps: a change of k afterwards would wedge it between its
  // walls, or loosen it.
  set(Scope::all, joined(point.law, {{"case", "gravel"}, {"dt", number_text(point.step, step_digits)}}));
  set(Scope::settle, values_of(task_, evaluation.point, std::array{pour_friction}));
  set(Scope::placed, values_of(task_, evaluation.point, std::array{"m2", "m3", "r2", "r3", "k23", "c23"}));
  const double omega = number_of(task_, evaluation.point, "omega", 2.0 * pi * default_frequency);
  // Forces that are unbalanced at a ratio of 1, a ball's weight, are a ten-thousandth of the roller's weight.
  set(Scope::run,
      joined(values_of(task_, evaluation.point, std::array{"omega", "Fw"}),
             {{"balance", "10"},
              {"cycles", std::to_string(task_.cycles)},
              {"samples_per_cycle", "250"},
              {"steps_per_cycle", std::to_string(steps_per_cycle(point.step, omega / (2.0 * pi)))}}));
  return point;
}

std::vector<double> SoilTests::measure(const Evaluation &evaluation, int seed) const {
  const Point point = point_of(evaluation, seed);
  std::map<std::string, double> found;
  // The plate comes before the roller, which uses up the settled soil.
  if (measures(task_, SoilTest::plate)) found.merge(plate(point));
  if (measures(task_, SoilTest::roller)) found.merge(roller(point));
  if (measures(task_, SoilTest::biaxial)) found.merge(biaxial(point));

  std::vector<double> values;
  for (const CalibrationTarget &target : task_.targets)
    values.push_back(found.at(target.name));
  return values;
}

fs::path SoilTests::record(const Evaluation &evaluation, int seed) const {
  const Point point = point_of(evaluation, seed);
  const fs::path folder = fs::absolute(out_ / "records");
  fs::path place = folder / placed_name(point.scene, seed);
  if (!fs::exists(place)) {
    make_output_folder(folder);
    FolderInProgress draft(place);
    const std::unique_ptr<DeckRun> run = run_roller(point);
    for (const char *file : {"bed.csv", "cycles.csv", "parameters.csv"})
      fs::copy_file(run->file(file), draft.path() / file);
    draft.publish();
  }
  return place;
}

std::unique_ptr<DeckRun> SoilTests::run_roller(const Point &point) const {
  std::unique_ptr<DeckRun> run = run_scene(point.scene, point.seed, out_, Soil::used_up);
  // It would be one file of megabytes for each point and seed.
  fs::remove(placed_roller(point.scene, point.seed, out_, Soil::used_up));
  return run;
}

std::map<std::string, double> SoilTests::roller(const Point &point) const {
  const std::unique_ptr<DeckRun> run = run_roller(point);
  std::vector<Quantity> quantities;
  for (const SoilQuantity &quantity : soil_quantities)
    if (quantity.test == SoilTest::roller) quantities.push_back(*named_quantity(quantity.name));
  const std::vector<double> values = measured(quantities, run->file(""), 1.0);
  std::map<std::string, double> found;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (!std::isfinite(values[i]))
      throw SceneFault(
          "identify finds no k and D in the record of the roller: contact is too short or missing");
    found[quantities[i].name] = values[i];
  }
  return found;
}

std::map<std::string, double> SoilTests::plate(const Point &point) const {
  constexpr double width = 0.3; // m, the deck's default
  constexpr double mega = 1e6;
  const fs::path soil = settled_soil(point.scene, point.seed, out_);
  Variables variables = point.law;
  variables.insert(variables.end(), {{"bed", soil.string()},
                                     {"plate_width", number_text(width)},
                                     {"dt", number_text(point.step, step_digits)}});
  const DeckRun run("soil/in.plate", variables);
  run.must_succeed();
  if (!measures(task_, SoilTest::roller)) fs::remove(soil);
  const PlateResult result = plate_result(read_plate(run.file("plate.csv")), width);
  return {{"E_v1", mega * result.first_modulus}, {"E_v2", mega * result.second_modulus}};
}

std::map<std::string, double> SoilTests::biaxial(const Point &point) const {
  Variables variables = point.law;
  variables.emplace_back("seed", std::to_string(point.seed));
  if (const std::string friction = value_of(task_, point.evaluation.point, pour_friction); !friction.empty())
    variables.emplace_back("prepare_friction", friction);
  const DeckRun run("soil/in.biaxial", variables);
  run.must_succeed();
  return {{"friction_angle", strength_of(read_compression(run.file("biaxial.csv"))).peak.angle()}};
}

std::string case_text(const CalibrationTask &task, const std::vector<double> &point,
                      const std::vector<std::string> &heading) {
  std::string text;
  for (const std::string &line : heading)
    text += "# " + line + "\n";
  text += "\n";
  const auto set = [&text](const std::string &name, const std::string &value) {
    text += fmt::format("variable {:<15} index {}\n", name, value);
  };
  set("dimension", "2");
  for (const auto &[name, value] : values_of(task, point, law_names))
    set(name, value);
  for (const auto &[name, value] :
       values_of(task, point, std::array{pour_friction, "m2", "m3", "r2", "r3", "k23", "c23"}))
    set(name, value);
  const double step = time_step(task, point);
  set("dt_of_16mm", number_text(step, step_digits));
  set("steps_at_20_Hz", fmt::format("{}", steps_per_cycle(step, default_frequency) / 250));
  return text;
}

} // namespace drumlin::post
