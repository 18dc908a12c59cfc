#include "commands/record_options.h"

#include "chain/parameters.h"
#include "record/excitation.h"
#include "runs/parameter_file.h"
#include "support/csv.h"
#include "support/options.h"
#include "support/units.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace {

/// Files of a run from which its record may be read.
constexpr std::array<const char *, 3> run_files = {"chain.csv", "bed.csv", "cycles.csv"};

using Noted = std::map<std::string, std::string>;

/// What parameters.csv of a run notes; nothing of a measured record.
Noted noted_of(const std::vector<std::filesystem::path> &paths) {
  const std::filesystem::path &path = paths.front();
  const bool folder = std::filesystem::is_directory(path);
  if (!folder && std::find(run_files.begin(), run_files.end(), path.filename()) == run_files.end()) return {};
  const std::filesystem::path file = (folder ? path : path.parent_path()) / "parameters.csv";
  return std::filesystem::is_regular_file(file) ? read_parameters(file) : Noted();
}

/// Takes a value of a case or of a roller's file where neither command line nor run have it; whether it did.
bool take(std::optional<double> &given, double value, const Noted &noted, const char *name) {
  const auto found = noted.find(name);
  if (given || (found != noted.end() && !found->second.empty())) return false;
  given = value;
  return true;
}

void add_case(const std::string &name, const Noted &noted, RecordOptions &options) {
  const ChainParameters p = given_case(name, Transition::B);
  take(options.omega, p.omega, noted, "omega");
  take(options.m2, p.m2, noted, "m2");
  take(options.m3, p.m3, noted, "m3");
  if (!options.me_re) take(options.Fw, p.Fw, noted, "Fw");
}

/// A tolerance of the file is that of its own value. With another frequency the force follows from the
/// eccentric moment.
void add_roller(GivenRoller &roller, const Noted &noted, RecordOptions &options) {
  Roller &machine = roller.machine;
  RollerSetting &setting = roller.setting;
  MachineTolerances &tolerances = options.tolerances;
  tolerances.exciter = machine.exciter_tolerance;
  take(options.omega, 2.0 * pi * setting.frequency, noted, "omega");
  if (take(options.m2, machine.m2, noted, "m2")) tolerances.m2 = machine.m2_tolerance;
  if (take(options.m3, machine.m3, noted, "m3")) tolerances.m3 = machine.m3_tolerance;
  if (!options.Fw && take(options.me_re, setting.me_re, noted, "Fw"))
    tolerances.me_re = machine.me_re_tolerance;
  // What follows from the file is told with the values that count.
  if (options.omega) setting.frequency = *options.omega / (2.0 * pi);
  machine.m2 = options.m2.value_or(machine.m2);
  machine.m3 = options.m3.value_or(machine.m3);
  setting.me_re = options.me_re.value_or(setting.me_re);
  if (options.Fw) setting.me_re = *options.Fw / std::pow(2.0 * pi * setting.frequency, 2);
}

/// The bond of the roller's file or of the case, of which options replace single values; with neither the
/// usual one for the frame's mass, which half its size may be missing from.
std::optional<KnownBond> bond_of(const RecordArguments &arguments, const std::optional<GivenRoller> &roller,
                                 const RecordOptions &options) {
  if (!options.m3) return std::nullopt;
  const std::optional<double> &k23 = arguments.k23.value(), &c23 = arguments.c23.value();
  constexpr double of_assumed = 0.5;
  const double m3 = *options.m3, omega3 = 2.0 * pi * roller_file::assumed_frame_frequency;
  KnownBond bond;
  bond.stiffness = k23.value_or(m3 * omega3 * omega3);
  bond.damping = 2.0 * roller_file::assumed_frame_damping * std::sqrt(bond.stiffness * m3);
  bond.tolerance = of_assumed;
  if (roller) {
    const Roller &machine = roller->machine;
    bond = {machine.k23, machine.c23,
            machine.bond_tolerance.value_or(machine.bond_assumed ? of_assumed : 0.0)};
  } else if (arguments.chain_case) {
    const ChainParameters p = given_case(*arguments.chain_case, Transition::B);
    bond = {p.k23, p.c23, 0.0};
  }
  if (k23 && c23) bond.tolerance = 0.0;
  bond.stiffness = k23.value_or(bond.stiffness);
  bond.damping = c23.value_or(bond.damping);
  return bond;
}

/// How the roller tilts, if its file says it.
std::optional<TwoEnds> ends_of(const GivenRoller &roller, double exciter_shift) {
  const Roller &machine = roller.machine;
  if (!machine.width || !machine.drum_inertia || !machine.frame_inertia) return std::nullopt;
  ChainParameters chain;
  chain.m2 = machine.m2;
  chain.m3 = machine.m3;
  chain.k23 = machine.k23;
  chain.c23 = machine.c23;
  TwoEnds ends = two_ends(chain, machine);
  ends.contacts = equal_contacts(2, *machine.width, 0.0, 0.0);
  ends.exciter += exciter_shift;
  return ends;
}

} // namespace

RecordArguments::RecordArguments(Command &of)
    : Options(of, "Measured records"), roller(of, "Measured records") {
  not_with(Fw, {&me_re}, "not together with --Fw, which follows from it");
  not_with(roller.file, {&chain_case}, "without --roller, which has another machine");
}

namespace {

std::vector<std::filesystem::path> paths_of(const RecordArguments &arguments) {
  std::vector<std::filesystem::path> paths;
  for (const std::string &text : arguments.records)
    paths.push_back(path_option("RECORD", text));
  return paths;
}

/// The sign that a word names.
char sign_of(const Text &option, std::initializer_list<std::pair<const char *, char>> words) {
  std::vector<const char *> names;
  for (const auto &[name, sign] : words) {
    if (*option == name || *option == std::string(1, sign)) return sign;
    names.push_back(name);
  }
  throw option.refused(fmt::format("{}", fmt::join(names, ", ")));
}

/// Inserts what the texts of an option say. \param from_text throws std::invalid_argument with what is
/// allowed
template <class FromText, class Container>
void insert_each(const Texts &option, const FromText &from_text, Container &into) {
  for (const std::string &text : option)
    try {
      if (!into.insert(from_text(text)).second) throw std::invalid_argument("each signal once");
    } catch (const std::invalid_argument &allowed) {
      throw option.refused(text, allowed.what());
    }
}

} // namespace

std::vector<GivenPath> files_of(const RecordArguments &arguments) {
  std::vector<std::string> of_run(run_files.begin(), run_files.end());
  of_run.emplace_back("parameters.csv");
  std::vector<GivenPath> files;
  for (const std::filesystem::path &path : paths_of(arguments)) {
    const bool folder = std::filesystem::is_directory(path);
    if (folder || std::find(of_run.begin(), of_run.end(), path.filename()) != of_run.end())
      for (const GivenPath &file : files_in("RECORD", folder ? path : path.parent_path(), of_run))
        files.push_back(file);
    else
      files.push_back({"RECORD", path});
  }
  for (const GivenPath &file : files_of(arguments.roller))
    files.push_back(file);
  return files;
}

Record judged(const RecordArguments &arguments) {
  RecordOptions options;
  options.guess = arguments.guess;
  const std::vector<std::filesystem::path> paths = paths_of(arguments);
  if (arguments.separator)
    options.format.separator =
        sign_of(arguments.separator,
                {{"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"bar", '|'}, {"blank", ' '}});
  if (arguments.decimal)
    options.format.decimal = sign_of(arguments.decimal, {{"point", '.'}, {"comma", ','}});
  if (arguments.piece) options.piece = *arguments.piece;
  insert_each(arguments.columns, column_from_text, options.columns);
  insert_each(arguments.delays, delay_from_text, options.delays);
  options.sampling_rate = arguments.sampling_rate.value();
  if (arguments.frequency) options.omega = 2.0 * pi * *arguments.frequency;
  if (arguments.phase) options.phase = *arguments.phase * pi / 180.0;
  options.Fw = arguments.Fw.value();
  options.me_re = arguments.me_re.value();
  options.m2 = arguments.m2.value();
  options.m3 = arguments.m3.value();
  options.corner = arguments.corner_frequency.value();
  if (options.corner && options.omega && 2.0 * pi * *options.corner > 0.5 * *options.omega)
    throw arguments.corner_frequency.refused("up to half the frequency of the excitation [Hz]");
  if (arguments.logger_low_pass) try {
      options.logger_filter = logger_filter_from_text(*arguments.logger_low_pass);
    } catch (const std::invalid_argument &allowed) {
      throw arguments.logger_low_pass.refused(allowed.what());
    }
  if (arguments.pulse_angle) {
    if (options.columns.count("pulse") == 0)
      throw arguments.pulse_angle.refused("only with --column pulse=HEADER");
    options.pulse_angle = *arguments.pulse_angle * pi / 180.0;
  }
  std::optional<GivenRoller> roller = judged(arguments.roller);
  if (arguments.chain_case) add_case(*arguments.chain_case, noted_of(paths), options);
  if (roller) add_roller(*roller, noted_of(paths), options);
  options.bond = bond_of(arguments, roller, options);
  const bool of_tolerance = arguments.bond_tolerance && arguments.bond_tolerance->given();
  if (of_tolerance && options.bond) options.bond->tolerance = 0.01 * **arguments.bond_tolerance;
  if (roller) options.ends = ends_of(*roller, arguments.exciter_shift);
  Record record = read_record(paths, options);
  if (options.logger_filter && (record.pieces.empty() || !options.omega || record.excitation_read))
    throw arguments.logger_low_pass.refused(
        "only for a measured record without F_excitation, with --frequency or --roller");
  settle_excitation(record, options);
  if (of_tolerance && !record.frame_computed)
    throw arguments.bond_tolerance->refused("only for a measured record without the frame's acceleration");
  if (arguments.low_pass) filter_signals(record, *arguments.low_pass);
  if (roller) {
    record.parameters.emplace("k23", number_text(options.bond->stiffness));
    record.parameters.emplace("c23", number_text(options.bond->damping));
    if (record.Fw) record.parameters.emplace("Fw", number_text(*record.Fw));
    const double g = record.g.value_or(ChainParameters().g);
    for (const auto &[name, value] : roller->rows(g))
      record.parameters.emplace(name, value);
    const std::vector<std::string> lines = roller->lines(g);
    record.notes.insert(record.notes.begin(), lines.begin(), lines.end());
  }
  return record;
}

WayRange judged(const WayArguments &arguments) {
  const WayRange way{arguments.from.value(), arguments.to.value(), arguments.pass.value()};
  if (way.from && way.to && !(*way.from < *way.to)) throw arguments.to.refused("a place beyond --from-place");
  return way;
}

std::optional<double> window_length(const std::string &text) {
  if (text.empty() || text.back() != 'm') return std::nullopt;
  return number_option("--window", text.substr(0, text.size() - 1), {1e-6, 1e6, "m"});
}

std::string settings_of(const Record &record) {
  std::vector<std::pair<std::string, std::string>> values = {{"record", record.file.string()}};
  for (const auto &[name, value] :
       {std::pair{"omega", record.omega}, std::pair{"phase", record.phase}, std::pair{"Fw", record.Fw},
        std::pair{"m2", record.m2}, std::pair{"m3", record.m3}, std::pair{"g", record.g}})
    if (value) values.emplace_back(name, number_text(*value));
  for (const auto &[name, value] : record.parameters)
    if (name == "k23" || name == "c23" || name == "setting" || name.rfind("roller", 0) == 0)
      values.emplace_back(name, value);
  return parameters_text(values);
}

} // namespace drumlin::post
