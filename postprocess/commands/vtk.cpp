#include "commands/commands.h"

#include "bed/coarse_graining.h"
#include "bed/dump_readers.h"
#include "bed/vtk_writers.h"
#include "commands/command.h"
#include "runs/bed_files.h"
#include "runs/chain_files.h"
#include "support/files.h"
#include "support/options.h"
#include "support/units.h"
#include "support/progress.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <regex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Side of a cell of the fields in mean diameters of the soil balls, unless the user gives one: some nine
/// balls in a cell.
constexpr double default_cell = 3.0;

struct VtkArguments : Options {
  using Options::Options;
  Text folder = text("dir", "DIR", "folder of the run, with dump/ and parameters.csv", required);
  ResultPath out = result_folder("--out", "folder for the results, made if missing; DIR/vtk if not given");
  Number cell =
      number("--cell", {1e-9, 1e9, "m"},
             fmt::format("side of the cells of the fields [m], fitted to the bed; {:g} mean diameters "
                         "of the soil balls if not given",
                         default_cell));
};

/// The collections that the command writes, relative to the folder of the results.
constexpr std::array<const char *, 3> collections = {"balls.pvd", "contacts.pvd", "fields.pvd"};
/// Ranges over all steps that a picture needs, for postprocess/paraview/bed.py.
constexpr const char *scene_name = "scene.json";

std::string balls_name(long step) { return fmt::format("balls_{}.vtp", step); }
std::string contacts_name(long step) { return fmt::format("contacts_{}.vtp", step); }
std::string fields_name(long step) { return fmt::format("fields_{}.vti", step); }

bool is_ours(const std::string &name) {
  static const std::regex pattern(R"((balls|contacts)(_\d+\.vtp|\.pvd)|fields(_\d+\.vti|\.pvd)|scene\.json)");
  return std::regex_match(name, pattern);
}

/// The parameters of the run.
struct RunParameters {
  double dt = 0.0; ///< time step, s
  std::optional<double> omega,
      F_drive; ///< of the excitation: angular frequency, rad/s, and amplitude, N; where the run has one
  std::vector<LayerPackings> packings; ///< of the layers; empty: not known
  std::optional<DriveHistory> drive;   ///< of a roller that drives: where it is in which pass
};

RunParameters run_parameters(const fs::path &folder) {
  const fs::path file = folder / "parameters.csv";
  const std::map<std::string, std::string> parameters = read_parameters(file);
  const auto number = [&](const char *name, double least, const char *expected) -> std::optional<double> {
    const auto found = parameters.find(name);
    if (found == parameters.end()) return std::nullopt;
    try {
      if (const double value = number_from_text(found->second); value >= least) return value;
    } catch (const std::invalid_argument &) {
    }
    throw std::runtime_error(fmt::format("{}: {}", file.string(), refusal(name, found->second, expected)));
  };
  constexpr double positive = std::numeric_limits<double>::min();
  const std::optional<double> dt = number("timestep", positive, "a number > 0 in s");
  if (!dt)
    throw std::runtime_error(fmt::format(
        "{}: has no 'timestep'; allowed: files with the time step of the run in s", file.string()));
  std::optional<DriveHistory> drive;
  const auto deck = parameters.find("deck");
  if (deck != parameters.end() && deck->second == "drive" && fs::is_regular_file(folder / "bed.csv"))
    drive = read_drive_history(folder / "bed.csv", std::numeric_limits<std::size_t>::max());
  return {*dt, number("omega", positive, "a number > 0 in rad/s"), number("Fw", 0.0, "a number >= 0 in N"),
          noted_packings(parameters), std::move(drive)};
}

/// Place and pass of a roller that drives, in the row of its history that is next to a time; a dump that the
/// run wrote after its last row has neither.
void add_place(double time, const DriveHistory &drive, StepValues &values) {
  if (drive.size() < 2) return;
  const double interval = drive.time[1] - drive.time[0];
  const auto after = std::lower_bound(drive.time.begin(), drive.time.end(), time - 0.5 * interval);
  if (after == drive.time.end() || *after > time + 0.5 * interval) return;
  const auto row = static_cast<std::size_t>(after - drive.time.begin());
  values.emplace_back("s", drive.s[row]);
  values.emplace_back("pass_number", drive.pass[row]);
}

/// The phase of the excitation at a time, place and pass of a roller that drives, and the vertical forces on
/// the drum, named as in bed.csv.
StepValues values_of_step(double time, const RunParameters &run, const std::vector<Ball> &balls,
                          const std::optional<BedContacts> &contacts) {
  StepValues values;
  if (run.omega) {
    const double turns = std::round(1e9 * *run.omega * time / (2.0 * pi)) /
                         1e9; // rounded, so that the end of a cycle does not count as 359.99999 degrees
    values.emplace_back("cycle", std::floor(turns) + 1.0);
    values.emplace_back("phase", 360.0 * (turns - std::floor(turns)));
    if (run.F_drive) values.emplace_back("F_excitation", *run.F_drive * std::sin(2.0 * pi * turns));
  }
  if (run.drive) add_place(time, *run.drive, values);
  if (!contacts) return values;
  double on_drum = 0.0;
  for (const BallContact &contact : contacts->balls) {
    if (balls[contact.i].type == drum_type) on_drum += contact.force[1];
    if (balls[contact.j].type == drum_type) on_drum -= contact.force[1];
  }
  for (const WallContact &contact : contacts->walls)
    if (balls[contact.i].type == drum_type) on_drum += contact.force[1];
  values.emplace_back("F_contact", on_drum);
  return values;
}

/// Range of an array over all steps. For colour scales there is a quantile in addition to the largest value,
/// so that a single fast ball does not set the scale: in each step 99 % of the values do not exceed the
/// step's quantile, and this is the largest of these.
class Sizes {
public:
  void add(const std::string &array, std::vector<double> values) {
    if (values.empty()) return;
    auto &[quantile, largest] = sizes_[array];
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    quantile = std::max(quantile, *place);
    largest = std::max(largest, *std::max_element(place, values.end()));
  }
  nlohmann::json json() const {
    nlohmann::json all = nlohmann::json::object();
    for (const auto &[array, size] : sizes_)
      all[array] = {{"quantile_99", size.first}, {"largest", size.second}};
    return all;
  }

private:
  std::map<std::string, std::pair<double, double>> sizes_;
};

double magnitude(const Vector &vector) { return std::hypot(vector[0], vector[1], vector[2]); }

/// Adds the values of the soil balls and of all contacts.
void add_sizes(Sizes &sizes, const std::vector<Ball> &balls, const ContactSums &sums,
               const std::optional<BedContacts> &contacts) {
  const auto of_soil = [&](const char *array, const auto &value) {
    std::vector<double> values;
    for (std::size_t b = 0; b < balls.size(); ++b)
      if (is_soil(balls[b].type)) values.push_back(value(b));
    sizes.add(array, std::move(values));
  };
  of_soil("velocity", [&](std::size_t b) { return magnitude(balls[b].velocity); });
  of_soil("angular_velocity", [&](std::size_t b) { return magnitude(balls[b].spin); });
  if (!contacts) return;
  of_soil("coordination", [&](std::size_t b) { return static_cast<double>(sums.coordination[b]); });
  of_soil("pressure", [&](std::size_t b) { return sums.pressure[b]; });
  std::vector<double> forces;
  for (const BallContact &contact : contacts->balls)
    forces.push_back(force_parts(contact).normal);
  for (const WallContact &contact : contacts->walls)
    forces.push_back(force_parts(contact).normal);
  sizes.add("normal_force", std::move(forces));
}

/// Values that are the same for all steps.
struct Bed {
  Bounds soil, all;
  double mean_diameter = 0.0; ///< of the soil balls of the first step, m
  bool flat = true;           ///< all balls stay in z = 0
};

/// Reads all steps once. Removes steps whose dump is incomplete, since the run was stopped or is still
/// running, and prints which they are.
Bed survey(std::map<long, StepDump> &steps) {
  Bed bed;
  TimedProgress progress;
  const std::size_t all = steps.size();
  std::size_t done = 0;
  for (auto step = steps.begin(); step != steps.end();) {
    const fs::path &file = step->second.balls;
    double diameters = 0.0, soil = 0.0;
    std::vector<Ball> balls;
    try {
      balls = read_ball_dump(file);
    } catch (const CutShort &fault) {
      if (all == 1) throw;
      print_progress(fmt::format("step {} left out: {}", step->first, fault.what()));
      step = steps.erase(step);
      continue;
    }
    bed.flat = bed.flat && in_a_plane(balls);
    for (const Ball &ball : balls) {
      bed.all.add(ball);
      if (!is_soil(ball.type)) continue;
      bed.soil.add(ball);
      diameters += 2.0 * ball.radius;
      soil += 1.0;
    }
    if (soil == 0.0)
      throw std::runtime_error(fmt::format("{}: holds no soil balls; allowed: dumps with balls of type {}",
                                           file.string(), int{soil_type}));
    if (bed.mean_diameter == 0.0) bed.mean_diameter = diameters / soil;
    progress.tell("{} of {} steps read", ++done, all);
    ++step;
  }
  if (steps.empty()) throw std::runtime_error("the dumps of all steps are cut short");
  return bed;
}

/// The contacts of a step; none if there is no dump of them, or if it is incomplete, which is printed.
std::optional<BedContacts> contacts_of(const StepDump &dump, long step, const std::vector<Ball> &balls) {
  if (dump.contacts.empty()) return std::nullopt;
  try {
    return read_contact_dump(dump.contacts, balls);
  } catch (const CutShort &fault) {
    print_progress(fmt::format("contacts of step {} left out: {}", step, fault.what()));
    return std::nullopt;
  }
}

/// One sentence on steps that a run with dumps at equal distances would have had; empty if none is missing.
std::string missing_steps(const std::map<long, StepDump> &steps) {
  long distance = std::numeric_limits<long>::max();
  for (auto step = steps.begin(); step != steps.end() && std::next(step) != steps.end(); ++step)
    distance = std::min(distance, std::next(step)->first - step->first);
  long missing = 0, first = -1;
  for (auto step = steps.begin(); step != steps.end() && std::next(step) != steps.end(); ++step) {
    const long gap = std::next(step)->first - step->first;
    if (gap % distance != 0) return {}; // not at equal distances
    if (gap > distance && first < 0) first = step->first + distance;
    missing += gap / distance - 1;
  }
  if (missing == 0) return {};
  return fmt::format("{} step{} of the dumps every {} {} missing, from step {} on", missing,
                     missing == 1 ? "" : "s", distance, missing == 1 ? "is" : "are", first);
}

/// The names and times of the files of each of the `collections`.
using Series = std::array<std::vector<std::pair<double, std::string>>, collections.size()>;

void print_summary(const fs::path &out, const std::map<long, StepDump> &steps, const Series &series,
                   const FieldGrid &grid) {
  for (std::size_t i = 0; i < collections.size(); ++i)
    if (!series[i].empty())
      fmt::print("{}: {} steps, {:g} to {:g} s\n", (out / collections[i]).string(), series[i].size(),
                 series[i].front().first, series[i].back().first);
  if (series[1].size() < series[0].size())
    fmt::print("no contacts and no fields where the dump of the contacts is missing: {} of {} steps\n",
               series[0].size() - series[1].size(), series[0].size());
  if (const std::string missing = missing_steps(steps); !missing.empty()) fmt::print("{}\n", missing);
  if (!series[2].empty())
    fmt::print("fields on {} cells of {:.3g} m by {:.3g} m\n", grid.size(), grid.sides[0], grid.sides[1]);
}

/// Refuses folders whose files are not an earlier result: the names are those of the dumps.
void check_out(const fs::path &out) {
  if (!fs::is_directory(out) || fs::exists(out / collections[0])) return;
  for (const fs::directory_entry &entry : fs::directory_iterator(out))
    if (is_ours(entry.path().filename().string()))
      throw UsageError(
          fmt::format("--out is '{}': has {}, but no {}; allowed: a new folder or that of an earlier result",
                      out.string(), entry.path().filename().string(), collections[0]));
}

/// Refuses a folder in which the results would replace a file of the run.
void keep_run(const fs::path &folder, const fs::path &out, const std::map<long, StepDump> &steps) {
  std::vector<GivenPath> read = {{"DIR", folder / "parameters.csv"}};
  std::vector<std::string> written = {collections.begin(), collections.end()};
  written.emplace_back(scene_name);
  for (const auto &[step, dump] : steps) {
    read.push_back({"DIR", dump.balls});
    if (!dump.contacts.empty()) read.push_back({"DIR", dump.contacts});
    written.insert(written.end(), {balls_name(step), contacts_name(step), fields_name(step)});
  }
  keep_apart(read, files_in("--out", out, written));
}

/// The parameters of the run, and the values that are the same for all its steps; incomplete steps are
/// removed from `steps`. UsageError for files that cannot be used.
std::pair<RunParameters, Bed> read_run(const fs::path &folder, const fs::path &out,
                                       std::map<long, StepDump> &steps) {
  try {
    const RunParameters parameters = run_parameters(folder);
    check_out(out);
    return {parameters, survey(steps)};
  } catch (const UsageError &) {
    throw;
  } catch (const std::runtime_error &fault) {
    throw UsageError(fault.what());
  }
}

FieldGrid grid_for(const Number &cell, const Bed &bed) {
  const double side = cell.value_or(default_cell * bed.mean_diameter);
  try {
    return fitted_grid(bed.soil, side, bed.flat);
  } catch (const std::invalid_argument &fault) {
    throw UsageError(fmt::format("--cell is '{:g}': {}; allowed: larger cells", side, fault.what()));
  }
}

/// Times, s, and vertical forces of the soil on the drum, N, of the steps whose contacts are known.
using DrumForces = std::vector<std::pair<double, double>>;

std::string scene_text(const Bed &bed, const RunParameters &run, const Sizes &sizes,
                       const DrumForces &forces) {
  const auto corners = [](const Bounds &bounds) { return nlohmann::json{bounds.low, bounds.high}; };
  nlohmann::json scene = {{"dimension", bed.flat ? 2 : 3}, {"mean_diameter", bed.mean_diameter},
                          {"bounds", corners(bed.all)},    {"soil_bounds", corners(bed.soil)},
                          {"sizes", sizes.json()},         {"force_on_drum", forces}};
  if (run.omega) scene["period"] = 2.0 * pi / *run.omega;
  return scene.dump(1) + "\n";
}

void run(const VtkArguments &arguments) {
  const fs::path folder = path_option("DIR", *arguments.folder);
  const fs::path out =
      arguments.out ? *arguments.out : output_folder_option("--out", (folder / "vtk").string());
  std::map<long, StepDump> steps = dumped_steps(folder / "dump");
  if (steps.empty())
    throw UsageError(refusal("DIR", folder.string(),
                             "the folder of a bed run with dumps, with dump/balls_STEP.vtp or .dump"));
  const auto [parameters, bed] = read_run(folder, out, steps);
  keep_run(folder, out, steps);
  const FieldGrid grid = grid_for(arguments.cell, bed);

  std::vector<std::string> names;
  Series series;
  Sizes sizes;
  DrumForces forces;
  try {
    FilesInProgress files(out);
    TimedProgress progress;
    std::size_t done = 0;
    for (const auto &[step, dump] : steps) {
      const double time = static_cast<double>(step) * parameters.dt;
      const auto add = [&](std::size_t collection, const std::string &name) {
        names.push_back(name);
        series[collection].emplace_back(time, name);
        return files / name;
      };
      const std::vector<Ball> balls = read_ball_dump(dump.balls);
      const std::optional<BedContacts> contacts = contacts_of(dump, step, balls);
      ContactSums sums;
      if (contacts) sums = {coordination(balls.size(), contacts->balls), ball_pressures(balls, *contacts)};
      const StepValues values = values_of_step(time, parameters, balls, contacts);
      if (contacts) forces.emplace_back(time, values.back().second);
      write_ball_points(add(0, balls_name(step)), balls, sums, values);
      add_sizes(sizes, balls, sums, contacts);
      if (contacts) {
        write_contact_lines(add(1, contacts_name(step)), balls, *contacts);
        write_field_image(add(2, fields_name(step)), grid, coarse_grained(balls, contacts->balls, grid),
                          parameters.packings);
      }
      progress.tell("{} of {} steps written", ++done, steps.size());
    }
    std::vector<FileText> texts;
    for (std::size_t i = 0; i < collections.size(); ++i)
      if (!series[i].empty()) {
        names.emplace_back(collections[i]);
        texts.emplace_back(files / collections[i], collection_text(series[i]));
      }
    names.emplace_back(scene_name);
    texts.emplace_back(files / scene_name, scene_text(bed, parameters, sizes, forces));
    write_files(texts);
    files.publish(names, is_ours);
  } catch (const fs::filesystem_error &fault) {
    throw UsageError(fmt::format("--out is '{}': {}; allowed: a folder that can be made and written to",
                                 out.string(), fault.code().message()));
  } catch (const std::runtime_error &fault) {
    throw UsageError(fault.what());
  }
  print_summary(out, steps, series, grid);
}

} // namespace

void add_vtk_command(CLI::App &app, Session &session) {
  add_command<VtkArguments>(app, session, "vtk",
                            "Balls, contacts and coarse-grained fields of a bed run as time "
                            "series for ParaView: balls.pvd, contacts.pvd, "
                            "fields.pvd, from the dumps of a run with dumps.",
                            run);
}

} // namespace drumlin::post
