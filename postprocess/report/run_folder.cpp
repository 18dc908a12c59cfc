#include "report/run_folder.h"

#include "report/soil/element_tests.h"
#include "support/files.h"
#include "support/text.h"
#include "support/usage_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace drumlin::post {

namespace fs = std::filesystem;

fs::path checked_place(const fs::path &out, const ReportFolders &folders) {
  fs::path place = fs::absolute(out).lexically_normal();
  if (!place.has_filename()) place = place.parent_path();
  const auto refuse = [&out](const std::string &why) {
    throw UsageError(
        fmt::format("--out is '{}': {}; allowed: a new folder or an earlier report", out.string(), why));
  };
  if (fs::exists(place)) {
    if (!fs::is_directory(place)) refuse("is not a folder");
    if (!fs::is_empty(place) && !fs::is_regular_file(place / summary_file)) refuse("holds other files");
    const std::string inside = fs::canonical(place).string() + "/";
    for (const fs::path &folder : folders.all()) {
      if ((fs::canonical(folder).string() + "/").rfind(inside, 0) == 0)
        refuse("holds the folder " + folder.string() + " that is to be reported on");
      for (const fs::directory_entry &entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && fs::canonical(entry.path()).string().rfind(inside, 0) == 0)
          refuse("holds the file " + entry.path().string() + " that is to be reported on");
    }
  }
  try {
    make_output_folder(place.parent_path());
  } catch (const std::runtime_error &error) {
    throw UsageError(fmt::format("--out is '{}': {}", out.string(), error.what()));
  }
  return place;
}

namespace {

/// The page of ./drumlin passes in the folder of its tables.
bool is_passes_page(const fs::path &folder) {
  return folder.filename() == "passes" && fs::is_regular_file(folder.parent_path() / "passes.csv") &&
         fs::is_regular_file(folder / "index.html");
}

// A study; a map or the passes of a run, which have a page of their own, too.
bool is_study_folder(const fs::path &folder) {
  return ((fs::is_regular_file(folder / "study.txt") || fs::is_regular_file(folder / "regimes.csv")) &&
          fs::is_regular_file(folder / "index.html")) ||
         is_passes_page(folder);
}

/// The history file of a run: chain.csv, or bed.csv of a bed.
fs::path record_of(const fs::path &folder) {
  const fs::path bed = folder / "bed.csv";
  const fs::path chain = folder / "chain.csv";
  return !fs::is_regular_file(chain) && fs::is_regular_file(bed) ? bed : chain;
}

/// Not that of a roller that drives and has a page of its passes, which tells more.
bool is_run_folder(const fs::path &folder) {
  return fs::is_regular_file(record_of(folder)) && !is_passes_page(folder / "passes");
}

/// The list to which a folder belongs; nullptr: none.
std::vector<fs::path> *list_of(const fs::path &folder, ReportFolders &found) {
  if (is_study_folder(folder)) return &found.studies;
  if (is_run_folder(folder)) return &found.runs;
  for (const ElementTest &test : element_tests())
    if (fs::is_regular_file(folder / test.csv())) return &found.element_tests[test.name];
  return nullptr;
}

/// Whether a folder has what an interrupted call of a tool leaves.
bool is_unfinished(const fs::path &folder) {
  const std::string name = folder.filename().string();
  return name.front() == '.' || name.rfind("unfinished.", 0) == 0;
}

/// A run that was cut before it wrote a table; nothing if the folder is none.
std::optional<LeftOut> cut_at_start(const fs::path &folder) {
  const fs::path file = folder / "parameters.csv";
  if (!fs::is_regular_file(file) || is_passes_page(folder / "passes")) return std::nullopt;
  try {
    const std::map<std::string, std::string> parameters = read_parameters(file);
    if (parameters.count("ended") != 0)
      if (const std::string why = why_cut(parameters); !why.empty()) return LeftOut{folder, why, true};
  } catch (const std::runtime_error &) { // a file of that name which is something else
  }
  return std::nullopt;
}

/// Sets `value` to a parameter; adds its name to `absent` if the run does not have it.
void take(const Run &run, const std::string &name, double &value, std::vector<std::string> &absent) {
  if (const std::optional<double> given = run.number(name))
    value = *given;
  else
    absent.push_back(name);
}

void check_parameters(const Run &run, const std::string &complaint) {
  if (!complaint.empty())
    throw std::runtime_error(fmt::format("{}: {}", (run.folder / "parameters.csv").string(), complaint));
}

/// Sets the transition. Returns whether no parameter is absent.
bool take_transition(Run &run, Transition &transition, std::vector<std::string> absent) {
  if (!run.parameters.count("transition")) absent.emplace_back("transition");
  if (!absent.empty()) {
    run.missing.push_back(fmt::format(
        "parameters.csv lacks {}: the run is not compared with reference values or the reference solution.",
        fmt::join(absent, ", ")));
    return false;
  }
  try {
    transition = transition_from_name(run.parameters.at("transition"));
  } catch (const std::invalid_argument &error) {
    check_parameters(run, error.what());
  }
  return true;
}

/// Fills Run::at_case: whether each parameter is the named case's.
void compare_with_case(Run &run) {
  if (std::find(table1_cases.begin(), table1_cases.end(), run.case_name) == table1_cases.end()) {
    run.not_at_case =
        run.case_name.empty() ? "no case is named" : "case '" + run.case_name + "' has no reference";
    return;
  }
  const ChainParameters known = table1_case(run.case_name, run.chain.transition);
  for (const ChainNumber &number : chain_numbers) {
    const double value = run.chain.*number.value, expected = known.*number.value;
    if (std::abs(value - expected) > 1.0e-6 * std::abs(expected)) {
      run.not_at_case =
          fmt::format("{} = {:g}, case {} has {:g}", number.name, value, run.case_name, expected);
      return;
    }
  }
  run.at_case = true;
}

/// The run of a bed with the contacts of its uppermost layer, which the drum is on: in a bed of layers k and
/// D are lists, the lowest layer first, and behind the layers the spots.
Run of_top_layer(Run run) {
  const std::string spots = run.text("spots", "none");
  const auto behind = spots == "none" ? 0 : std::count(spots.begin(), spots.end(), ',') + 1;
  for (const char *name : {"k", "D"})
    if (const auto found = run.parameters.find(name); found != run.parameters.end()) {
      std::string &list = found->second;
      for (auto spot = behind; spot > 0 && list.find(',') != std::string::npos; --spot)
        list.erase(list.rfind(','));
      list.erase(0, list.rfind(',') + 1);
    }
  return run;
}

/// Fills Run::chain. Returns whether no parameter is absent.
/// \param contact the run from which k and D are taken; nullptr: each contact has its own
bool take_chain(Run &run, const Run *contact) {
  std::vector<std::string> absent;
  ChainParameters &p = run.chain;
  for (const auto &[name, value, range, help] : chain_numbers) {
    const bool of_contact = value == &ChainParameters::k || value == &ChainParameters::D;
    if (!of_contact || contact != nullptr) take(of_contact ? *contact : run, name, p.*value, absent);
  }
  if (!take_transition(run, p.transition, absent)) return false;
  check_parameters(run, p.invalid());
  return true;
}

/// Fills Run::complete and Run::samples_per_cycle.
void count_cycles(Run &run) {
  if (run.history.size() < 3) return;
  const double period = run.chain.period();
  const double rows = static_cast<double>(run.history.size() - 1);
  const double step = (run.history.time.back() - run.history.time.front()) / rows;
  constexpr double most_per_cycle = 1.0e6; // as of exact solutions
  const double samples = std::min(std::round(period / step), most_per_cycle);
  if (!(samples >= 1.0) || !(run.history.time.back() / period < 2.0 * rows))
    throw std::runtime_error(fmt::format(
        "{}: {} rows over {:g} s with omega = {:g} rad/s; allowed is a row or more per cycle",
        record_of(run.folder).string(), run.history.size(), run.history.time.back(), run.chain.omega));
  run.complete = complete_cycles(run.history.time.back(), period);
  run.samples_per_cycle = static_cast<int>(samples);
  if (const std::optional<double> asked = run.number("cycles"); asked && run.complete < *asked)
    run.missing.push_back(fmt::format("a partial run, {} of {:g} cycles: it was stopped, or is not done yet.",
                                      run.complete, *asked));
}

/// Whether the run's contacts are linear, as far as it says. If not it is not compared.
bool has_linear_contacts(Run &run) {
  const std::string law = run.text("contact_law", "hooke/transition");
  if (law == "hooke/transition") return true;
  run.missing.push_back(fmt::format("contacts have the law {}: the run is not compared with reference values "
                                    "or the reference solution, which are of linear ones.",
                                    law));
  return false;
}

void read_chain_parameters(Run &run) {
  if (!has_linear_contacts(run)) return;
  if (run.text("way", "none") != "none") {
    run.missing.emplace_back("the roller drives, over soil that may change: the run is not compared with "
                             "reference values or the reference solution, which are of a chain that stands.");
    return;
  }
  const bool ends = run.history.has(ColumnGroup::ends);
  if (!take_chain(run, ends ? nullptr : &run)) return;
  if (ends) {
    run.kind = RunKind::ends;
    count_cycles(run);
    return;
  }
  run.kind = RunKind::chain;
  run.case_name = run.text("case", "");
  if (const std::optional<double> speed = run.number("impact_speed")) run.impact_speed = *speed;
  compare_with_case(run);
  count_cycles(run);
}

/// A bed must have all parameters, since its deck writes them.
void read_bed_parameters(Run &run) {
  const std::string deck = run.text("deck", "");
  if (deck == "drive") {
    run.missing.emplace_back("the roller drives: ./drumlin passes tells what its passes leave.");
    return;
  }
  if (deck != "bed") {
    run.missing.emplace_back("no run of inputs/bed/in.bed: its steady motion is not judged.");
    return;
  }
  const Run top = of_top_layer(run);
  if (!take_chain(run, &top))
    throw std::runtime_error(fmt::format("{}: {}", run.folder.string(), run.missing.back()));
  run.kind = RunKind::bed;
  run.case_name = run.text("case", "");
  count_cycles(run);
}

void read_impact_parameters(Run &run) {
  if (!has_linear_contacts(run)) return;
  std::vector<std::string> absent;
  ImpactParameters &p = run.impact;
  take(run, "k", p.stiffness, absent);
  take(run, "D", p.damping_ratio, absent);
  take(run, "m2", p.mass, absent);
  take(run, "speed", p.speed, absent);
  if (!take_transition(run, p.transition, absent)) return;
  for (const auto &[name, value] :
       {std::pair{"k", p.stiffness}, std::pair{"m2", p.mass}, std::pair{"speed", p.speed}})
    if (value <= 0.0)
      check_parameters(run, fmt::format("{} is {:g}; allowed is a number above 0", name, value));
  if (p.damping_ratio < 0.0)
    check_parameters(run, fmt::format("D is {:g}; allowed is a number of 0 or more", p.damping_ratio));
  run.kind = RunKind::impact;
}

/// Fills Run::parameters. Without parameters.csv, which a bed must have, says so in Run::missing.
void read_parameter_texts(Run &run, bool bed) {
  const fs::path file = run.folder / "parameters.csv";
  if (!bed && !fs::is_regular_file(file)) {
    run.missing.emplace_back("parameters.csv is missing: the run is not compared with reference values or "
                             "the reference solution.");
    return;
  }
  for (const auto &[name, value] : read_parameters(file))
    run.parameters.emplace(valid_utf8(name), valid_utf8(value));
  run.cut = why_cut(run.parameters);
  run.parameters.erase("ended");
  if (!run.cut.empty()) run.missing.push_back(fmt::format("not judged: {}.", run.cut));
}

/// Takes the parameters over, by the kind of run.
void read_parameter_values(Run &run, bool bed) {
  const std::string deck = run.text("deck", "");
  const bool impact = deck == "impact" || (deck.empty() && run.parameters.count("speed") != 0);
  if (bed)
    read_bed_parameters(run);
  else if (!run.parameters.empty() && impact)
    read_impact_parameters(run);
  else if (!run.parameters.empty())
    read_chain_parameters(run);
  const std::string engine = run.text("engine", "");
  run.direct = engine.find("CVODE") != std::string::npos || engine.find("direct") != std::string::npos ||
               deck == "exact" || deck == "direct" || run.parameters.count("solver") != 0;
}

void read_event_file(Run &run) {
  const fs::path file = run.folder / "events.csv";
  run.has_events = fs::is_regular_file(file);
  if (run.has_events)
    run.events = read_events(file, run.cut_rows());
  else
    run.missing.emplace_back("events.csv is missing: there is no table of events, and jumps, force at make "
                             "and share of time in contact are taken from samples.");
}

void read_cycle_file(Run &run) {
  const fs::path file = run.folder / "cycles.csv";
  if (run.kind == RunKind::ends) return; // it says nothing of the ends
  if (!fs::is_regular_file(file)) {
    if (run.kind == RunKind::chain)
      run.missing.emplace_back("cycles.csv is missing: extremes and meter values are taken from samples and "
                               "events, and there is no energy balance.");
    return;
  }
  run.cycles = read_cycle_columns(file);
  if (!run.cycles->has("a_drum_min") || !run.cycles->has("F_contact_max"))
    run.missing.emplace_back(
        "cycles.csv lacks a_drum_min ... F_contact_max: extremes are taken from samples and events.");
  if (!run.cycles->has("a1_cos"))
    run.missing.emplace_back(
        "cycles.csv lacks a1_cos ... ah_sin: meter values are taken from samples and events.");
  if (!run.cycles->has("work_excitation"))
    run.missing.emplace_back("cycles.csv lacks the energies: there is no energy balance.");
}

/// Fills Run::steps_per_cycle and Run::timestep.
void take_steps(Run &run) {
  if (const std::optional<double> steps = run.number("steps_per_cycle")) {
    if (!(*steps >= 0.0 && *steps <= std::numeric_limits<int>::max()))
      check_parameters(run,
                       fmt::format("steps_per_cycle is {:g}; allowed is a whole number above 0", *steps));
    run.steps_per_cycle = static_cast<int>(std::lround(*steps));
  }
  if (const std::optional<double> step = run.number("timestep")) run.timestep = *step;
  if (run.timestep <= 0.0 && run.steps_per_cycle > 0 && run.kind == RunKind::chain)
    run.timestep = run.chain.period() / run.steps_per_cycle;
}

} // namespace

std::optional<double> Run::number(const std::string &parameter) const {
  const auto found = parameters.find(parameter);
  if (found == parameters.end() || found->second.empty()) return std::nullopt;
  try {
    return number_from_text(found->second);
  } catch (const std::invalid_argument &) {
    throw std::runtime_error(fmt::format("{}: {} is '{}', not a number", (folder / "parameters.csv").string(),
                                         parameter, found->second));
  }
}

std::string Run::text(const std::string &parameter, const std::string &fallback) const {
  const auto found = parameters.find(parameter);
  return found == parameters.end() || found->second.empty() ? fallback : found->second;
}

std::vector<fs::path> ReportFolders::all() const {
  std::vector<fs::path> folders = runs;
  folders.insert(folders.end(), studies.begin(), studies.end());
  for (const auto &[name, of_test] : element_tests)
    folders.insert(folders.end(), of_test.begin(), of_test.end());
  return folders;
}

std::string why_cut(const std::map<std::string, std::string> &parameters) {
  const auto found = parameters.find("ended");
  if (found == parameters.end())
    return "its parameters.csv does not say whether it has ended, as of a run by drumlin 0.2 or earlier, or "
           "by a deck without drumlin/outputs";
  if (found->second == "yes") return {};
  if (found->second == "no") return "it was killed, or is still running";
  return "it was cut: " + found->second;
}

std::string files_of_runs() {
  std::vector<std::string> files = {"chain.csv", "bed.csv"};
  for (const ElementTest &test : element_tests())
    files.push_back(test.csv());
  return fmt::format("{} or {}", fmt::join(files.begin(), files.end() - 1, ", "), files.back());
}

ReportFolders find_report_folders(const std::vector<fs::path> &arguments) {
  ReportFolders folders;
  std::set<fs::path> seen;
  const auto take = [&](std::vector<fs::path> &list, std::vector<fs::path> &into) {
    std::sort(list.begin(), list.end());
    for (const fs::path &folder : list)
      if (seen.insert(fs::canonical(folder)).second) into.push_back(folder);
  };
  for (const fs::path &argument : arguments) {
    if (!fs::is_directory(argument))
      throw UsageError(
          fmt::format("'{}' is no folder; allowed are run folders (with {}), studies and parents of them",
                      argument.string(), files_of_runs()));
    ReportFolders found;
    std::vector<LeftOut> earlier_reports;
    if (std::vector<fs::path> *own = list_of(argument, found))
      own->push_back(argument);
    else
      for (fs::recursive_directory_iterator entry(argument, fs::directory_options::skip_permission_denied),
           end;
           entry != end; ++entry) {
        if (!entry->is_directory()) continue;
        if (is_unfinished(entry->path())) {
          entry.disable_recursion_pending();
          continue;
        }
        if (fs::is_regular_file(entry->path() / summary_file)) {
          entry.disable_recursion_pending();
          earlier_reports.push_back({entry->path(), "it is an earlier report"});
          continue;
        }
        std::vector<fs::path> *list = list_of(entry->path(), found);
        if (list == &found.studies) entry.disable_recursion_pending();
        if (list != nullptr)
          list->push_back(entry->path());
        else if (std::optional<LeftOut> cut = cut_at_start(entry->path()))
          found.left_out.push_back(std::move(*cut));
      }
    if (found.all().empty() && found.left_out.empty())
      if (std::optional<LeftOut> cut = cut_at_start(argument)) found.left_out.push_back(std::move(*cut));
    if (found.all().empty() && found.left_out.empty())
      throw UsageError(fmt::format("'{}' has neither {} nor a study in it or below it; allowed are run "
                                   "folders, studies and parents of them",
                                   argument.string(), files_of_runs()));
    take(found.runs, folders.runs);
    take(found.studies, folders.studies);
    for (auto &[name, of_test] : found.element_tests)
      take(of_test, folders.element_tests[name]);
    found.left_out.insert(found.left_out.end(), earlier_reports.begin(), earlier_reports.end());
    for (LeftOut &folder : found.left_out)
      if (seen.insert(fs::canonical(folder.folder)).second) folders.left_out.push_back(std::move(folder));
  }
  return folders;
}

Run read_run(const fs::path &folder) {
  Run run;
  run.folder = folder;
  const fs::path record = record_of(folder);
  const bool bed = record.filename() == "bed.csv";
  read_parameter_texts(run, bed);
  run.history = read_chain(record, run.cut_rows());
  if (run.history.size() < 3)
    throw std::runtime_error(
        fmt::format("{}: {} rows; allowed are 3 or more", record.string(), run.history.size()));
  read_event_file(run);
  read_parameter_values(run, bed);
  read_cycle_file(run);
  take_steps(run);
  if (run.kind == RunKind::chain && !run.history.has_frame())
    run.missing.emplace_back("chain.csv has no frame: there is no contact force from measured motion.");
  return run;
}

void name_runs(std::vector<Run> &runs) {
  // Try names of one path part, then of two, and so on, until all differ.
  std::vector<std::vector<std::string>> parts(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (const fs::path &part : fs::canonical(runs[i].folder))
      parts[i].push_back(part.string());
  for (std::size_t length = 1; length < 64; ++length) {
    std::map<std::string, int> uses;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      std::string tail;
      for (std::size_t j = parts[i].size() - std::min(length, parts[i].size()); j < parts[i].size(); ++j)
        tail += (tail.empty() || tail == "/" ? "" : "/") + parts[i][j];
      runs[i].name = valid_utf8(tail);
      ++uses[tail];
    }
    if (std::all_of(uses.begin(), uses.end(), [](const auto &use) { return use.second == 1; })) return;
  }
}

std::string last_cycles_words(const std::vector<int> &counts) {
  if (counts.empty()) return "the last cycles";
  const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
  if (*most == 1) return "the last cycle";
  return *least == *most ? fmt::format("the last {} cycles", *most)
                         : fmt::format("the last {} to {} cycles", *least, *most);
}

} // namespace drumlin::post
