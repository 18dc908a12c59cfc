#include "vtk_command.h"

#include "bed_fields.h"
#include "chain_csv.h"
#include "options.h"
#include "output_files.h"
#include "timed_progress.h"
#include "vtk_files.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Side of a cell of the fields in mean diameters of the soil balls, unless the user gives one: some nine balls in a cell.
constexpr double default_cell = 3.0;

/// Sides of cells that are not absurd, m.
constexpr Range cell_range = {1e-9, 1e9, "m"};

struct Arguments {
  std::string folder;
  std::optional<std::string> out, cell;
};

/// What the command writes, as names from the folder of the results.
constexpr std::array<const char *, 3> collections = {"balls.pvd", "contacts.pvd", "fields.pvd"};

bool is_ours(const std::string &name) {
  static const std::regex pattern(R"((balls|contacts)(_\d+\.vtp|\.pvd)|fields(_\d+\.vti|\.pvd))");
  return std::regex_match(name, pattern);
}

/// Time step of the run, s.
double time_step(const fs::path &folder) {
  const fs::path file = folder / "parameters.csv";
  const std::map<std::string, std::string> parameters = read_parameters(file);
  const auto found = parameters.find("timestep");
  if (found == parameters.end())
    throw std::runtime_error(
        fmt::format("{}: has no 'timestep'; expected the time step of the run in s", file.string()));
  double dt = 0.0;
  try {
    dt = number_from_text(found->second);
  } catch (const std::invalid_argument &) {
  }
  if (dt <= 0.0)
    throw std::runtime_error(
        fmt::format("{}: timestep is '{}', expected a number > 0 in s", file.string(), found->second));
  return dt;
}

/// Results under way, in a folder inside that of the results.
class Workshop {
public:
  explicit Workshop(const fs::path &out) : out_(out) {}
  ~Workshop() {
    folder_.reset();
    std::error_code ignored;
    if (made_) fs::remove(out_, ignored); // if nothing was put there
  }
  Workshop(const Workshop &) = delete;
  Workshop &operator=(const Workshop &) = delete;

  fs::path operator/(const std::string &name) const { return folder_->path() / name; }

  /// Moves the files to the results, and removes those of an earlier call which these do not replace.
  void hand_over(const std::vector<std::string> &names) const {
    for (const std::string &name : names)
      check_output_file(out_ / name); // all of them, before the first is replaced
    for (const std::string &name : names)
      replace_file(*this / name, out_ / name);
    const std::set<std::string> fresh(names.begin(), names.end());
    for (const fs::directory_entry &entry : fs::directory_iterator(out_)) {
      const std::string name = entry.path().filename().string();
      if (is_ours(name) && fresh.count(name) == 0 && fs::is_regular_file(entry.symlink_status()))
        fs::remove(entry.path());
    }
  }

private:
  fs::path out_;
  bool made_ = fs::create_directories(out_);
  std::optional<TemporaryFolder> folder_{std::in_place, out_, "unfinished."};
};

/// What is the same for all steps.
struct Bed {
  Bounds soil;
  double mean_diameter = 0.0; ///< of the soil balls of the first step, m
  bool flat = true;           ///< all balls stay in z = 0
};

/// Reads all steps once. Takes those out whose dump was cut short, as by a run that was stopped or is still going on, and says so.
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
      fmt::print("step {} left out: {}\n", step->first, fault.what());
      step = steps.erase(step);
      continue;
    }
    bed.flat = bed.flat && in_a_plane(balls);
    for (const Ball &ball : balls) {
      if (ball.type != soil_type) continue;
      bed.soil.add(ball);
      diameters += 2.0 * ball.radius;
      soil += 1.0;
    }
    if (soil == 0.0)
      throw std::runtime_error(
          fmt::format("{}: holds no soil balls (type {})", file.string(), int{soil_type}));
    if (bed.mean_diameter == 0.0) bed.mean_diameter = diameters / soil;
    progress.tell("{} of {} steps read", ++done, all);
    ++step;
  }
  if (steps.empty()) throw std::runtime_error("the dumps of all steps are cut short");
  return bed;
}

/// The contacts of a step; none if there is no dump of them, or one that was cut short, which is said.
std::optional<BedContacts> contacts_of(const StepDump &dump, long step, const std::vector<Ball> &balls) {
  if (dump.contacts.empty()) return std::nullopt;
  try {
    return read_contact_dump(dump.contacts, balls);
  } catch (const CutShort &fault) {
    fmt::print("contacts of step {} left out: {}\n", step, fault.what());
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

/// Refuses folders whose files are not an earlier result: the names are those of the dumps.
void check_out(const fs::path &out) {
  if (!fs::is_directory(out) || fs::exists(out / collections[0])) return;
  for (const fs::directory_entry &entry : fs::directory_iterator(out))
    if (is_ours(entry.path().filename().string()))
      throw UsageError(
          fmt::format("--out is '{}': has {}, but no {}; allowed: a new folder or that of an earlier result",
                      out.string(), entry.path().filename().string(), collections[0]));
}

FieldGrid grid_for(const Arguments &arguments, const Bed &bed) {
  double side = default_cell * bed.mean_diameter;
  if (arguments.cell) side = number_option("--cell", *arguments.cell, cell_range);
  try {
    return fitted_grid(bed.soil, side, bed.flat);
  } catch (const std::invalid_argument &fault) {
    throw UsageError(fmt::format("--cell is '{:g}': {}; allowed: larger cells", side, fault.what()));
  }
}

void run(const Arguments &arguments) {
  if (arguments.cell) number_option("--cell", *arguments.cell, cell_range);
  const fs::path folder = path_option("DIR", arguments.folder);
  const fs::path out = output_folder_option("--out", arguments.out.value_or((folder / "vtk").string()));
  std::map<long, StepDump> steps = dumped_steps(folder / "dump");
  if (steps.empty())
    throw UsageError(refusal("DIR", folder.string(),
                             "the folder of a bed run with dumps, with dump/balls_STEP.vtp or .dump"));
  std::optional<Bed> bed;
  double dt = 0.0;
  try {
    dt = time_step(folder);
    check_out(out);
    bed = survey(steps);
  } catch (const UsageError &) {
    throw;
  } catch (const std::runtime_error &fault) {
    throw UsageError(fault.what());
  }
  const FieldGrid grid = grid_for(arguments, *bed);

  std::vector<std::string> names;
  std::array<std::vector<std::pair<double, std::string>>, 3> series; // as in `collections`
  try {
    const Workshop workshop(out);
    TimedProgress progress;
    std::size_t done = 0;
    for (const auto &[step, dump] : steps) {
      const auto add = [&, step = step](std::size_t collection, const std::string &name) {
        names.push_back(name);
        series[collection].emplace_back(static_cast<double>(step) * dt, name);
        return workshop / name;
      };
      const std::vector<Ball> balls = read_ball_dump(dump.balls);
      const fs::path ball_file = add(0, fmt::format("balls_{}.vtp", step));
      if (const std::optional<BedContacts> contacts = contacts_of(dump, step, balls)) {
        write_ball_points(ball_file, balls, coordination(balls.size(), contacts->balls));
        write_contact_lines(add(1, fmt::format("contacts_{}.vtp", step)), balls, *contacts);
        write_field_image(add(2, fmt::format("fields_{}.vti", step)), grid,
                          coarse_grained(balls, contacts->balls, grid));
      } else {
        write_ball_points(ball_file, balls, {});
      }
      progress.tell("{} of {} steps written", ++done, steps.size());
    }
    std::vector<FileText> texts;
    for (std::size_t i = 0; i < collections.size(); ++i)
      if (!series[i].empty()) {
        names.emplace_back(collections[i]);
        texts.emplace_back(workshop / collections[i], collection_text(series[i]));
      }
    write_files(texts);
    workshop.hand_over(names);
  } catch (const fs::filesystem_error &fault) {
    throw UsageError(fmt::format("--out is '{}': {}; allowed: a folder that can be made and written to",
                                 out.string(), fault.code().message()));
  } catch (const std::runtime_error &fault) {
    throw UsageError(fault.what());
  }
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

} // namespace

void add_vtk_command(CLI::App &app, Session &) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App *vtk = app.add_subcommand("vtk", "Balls, contacts and coarse-grained fields of a bed run as time "
                                            "series for ParaView: balls.pvd, contacts.pvd, "
                                            "fields.pvd, from the dumps of a run with dumps.");
  vtk->add_option("dir", arguments->folder, "folder of the run, with dump/ and parameters.csv")
      ->type_name("DIR")
      ->required();
  const auto optional = [vtk](const char *name, std::optional<std::string> &value, const std::string &help) {
    return vtk->add_option_function<std::string>(
        name, [&value](const std::string &text) { value = text; }, help);
  };
  optional("--out", arguments->out, "folder for the results, made if missing; DIR/vtk if not given")
      ->type_name("DIR");
  optional("--cell", arguments->cell,
           fmt::format("side of the cells of the fields [m], fitted to the bed; {:g} mean diameters "
                       "of the soil balls if not given",
                       default_cell))
      ->type_name("NUMBER");
  vtk->callback([arguments] { run(*arguments); });
}

} // namespace drumlin::post
