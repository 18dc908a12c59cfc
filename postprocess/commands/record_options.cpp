#include "commands/record_options.h"

#include "chain/parameters.h"
#include "commands/text_options.h"
#include "record/excitation.h"
#include "runs/parameter_file.h"
#include "support/csv.h"
#include "support/options.h"
#include "support/constants.h"
#include "support/usage_error.h"

#include <CLI/CLI.hpp>
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

/// An option that is a number of the record.
struct RecordNumber {
  const char *name;
  std::optional<std::string> RecordArguments::*text;
  Range range;
  const char *help;
};

constexpr std::array<RecordNumber, 12> record_numbers = {
    {{"--sampling-rate",
      &RecordArguments::sampling_rate,
      {1e-3, 1e9, "Hz"},
      "samples per second [Hz], for a file without times or with times of few digits"},
     {"--frequency", &RecordArguments::frequency, {1e-3, 1e6, "Hz"}, "of the excitation [Hz]"},
     {"--phase",
      &RecordArguments::phase,
      {-360.0, 360.0, "degrees"},
      "of the excitation at time 0 [degrees]: F_e = Fw sin(2 pi frequency t + phase), positive down"},
     {"--Fw", &RecordArguments::Fw, {1e-9, 1e15, "N"}, "amplitude of the excitation force [N]"},
     {"--me-re",
      &RecordArguments::me_re,
      {1e-9, 1e12, "kg m"},
      "eccentric moment m_e r_e [kg m] instead: Fw = m_e r_e (2 pi frequency)^2"},
     {"--m2", &RecordArguments::m2, {1e-6, 1e12, "kg"}, "mass of the drum [kg]"},
     {"--m3", &RecordArguments::m3, {1e-6, 1e12, "kg"}, "mass of the frame on the drum [kg]"},
     {"--low-pass",
      &RecordArguments::low_pass,
      {1e-3, 1e9, "Hz"},
      "cut-off frequency of a filter without phase shift for all columns [Hz]"},
     {"--pulse-angle",
      &RecordArguments::pulse_angle,
      {-360.0, 360.0, "degrees"},
      "angle of the exciter at which the column pulse rises [degrees], 0 if not given: F_e = Fw "
      "sin(angle)"},
     {"--corner-frequency",
      &RecordArguments::corner_frequency,
      {1e-4, 1e4, "Hz"},
      "of accelerometers that pass no constant, of first order [Hz]: what they take is given back"},
     {"--k23",
      &RecordArguments::k23,
      {1e-3, 1e15, "N/m"},
      "stiffness of the bond of drum and frame [N/m]; a record without the frame's acceleration needs it"},
     {"--c23", &RecordArguments::c23, {0.0, 1e12, "N s/m"}, "damping of the bond [N s/m]"}}};

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
std::optional<KnownBond> bond_of(std::optional<double> k23, std::optional<double> c23,
                                 const std::optional<GivenRoller> &roller,
                                 const std::optional<std::string> &chain_case, const RecordOptions &options) {
  if (!options.m3) return std::nullopt;
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
  } else if (chain_case) {
    const ChainParameters p = given_case(*chain_case, Transition::B);
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

void add_record_options(CLI::App &command, RecordArguments &arguments) {
  command
      .add_option(
          "RECORD", arguments.records,
          "folder of a run, its chain.csv, bed.csv or cycles.csv, or a measured file; several measured files "
          "continue one another")
      ->required();
  command
      .add_option("--column", arguments.columns,
                  "where a signal stands in a measured file, and in which unit: NAME=HEADER or "
                  "NAME=HEADER:UNIT, where HEADER may be the column's number; NAME is time, x_drum, v_drum, "
                  "a_drum (up positive), the same with frame, a_left and a_right at both "
                  "ends of the drum, F_contact (compression positive) or F_excitation (down positive); a '-' "
                  "before the unit turns the sign")
      ->type_name("NAME=HEADER:UNIT")
      ->expected(1)
      ->take_all()
      ->group("Measured records");
  add_roller_options(command, arguments.roller, "Measured records");
  command
      .add_option(
          "--delay", arguments.delays,
          "by how much a signal comes later than the time of its row says: 'a_frame=0.5ms'; may be given "
          "several times")
      ->type_name("SIGNAL=TIME")
      ->expected(1)
      ->take_all()
      ->group("Measured records");
  text_option(
      &command, "--case", "NAME", arguments.chain_case,
      fmt::format("case of the paper's Table 1 instead of a roller: {}", fmt::join(table1_cases, ", ")))
      ->group("Measured records");
  const auto of_file = [&command](const char *name, std::optional<std::string> &into, const char *help) {
    text_option(&command, name, "WORD", into, help)->group("Measured records");
  };
  of_file("--separator", arguments.separator,
          "what stands between cells: comma, semicolon, tab, bar or blank; found if not given");
  of_file("--decimal", arguments.decimal, "decimal sign: point or comma; found if not given");
  text_option(
      &command, "--logger-low-pass", "HZ,ORDER", arguments.logger_low_pass,
      "the low-pass filter of the logger: corner frequency [Hz] and order of a Butterworth filter, such "
      "as 200,4; what it has taken is given back, and identify fits what it lets pass")
      ->group("Measured records");
  of_file(
      "--piece", arguments.piece,
      "which piece of a file that gaps, blank cells, or an exciter that is off or changes divide, counted "
      "from 1; the longest if not given");
  for (const RecordNumber &number : record_numbers)
    text_option(&command, number.name, "NUMBER", arguments.*number.text, number.help)
        ->group("Measured records");
}

namespace {

std::vector<std::filesystem::path> paths_of(const RecordArguments &arguments) {
  std::vector<std::filesystem::path> paths;
  for (const std::string &text : arguments.records)
    paths.push_back(path_option("RECORD", text));
  return paths;
}

/// The sign that a word names.
char sign_of(const char *option, const std::string &text,
             std::initializer_list<std::pair<const char *, char>> words) {
  std::vector<const char *> names;
  for (const auto &[name, sign] : words) {
    if (text == name || text == std::string(1, sign)) return sign;
    names.push_back(name);
  }
  throw UsageError(refusal(option, text, fmt::format("{}", fmt::join(names, ", "))));
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
        sign_of("--separator", *arguments.separator,
                {{"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"bar", '|'}, {"blank", ' '}});
  if (arguments.decimal)
    options.format.decimal = sign_of("--decimal", *arguments.decimal, {{"point", '.'}, {"comma", ','}});
  constexpr int most_pieces = 1000000;
  if (arguments.piece) options.piece = count_option("--piece", *arguments.piece, 1, most_pieces);
  for (const std::string &text : arguments.columns)
    try {
      if (!options.columns.insert(column_from_text(text)).second)
        throw std::invalid_argument("each signal once");
    } catch (const std::invalid_argument &allowed) {
      throw UsageError(refusal("--column", text, allowed.what()));
    }
  const auto number = [&arguments](std::size_t i) -> std::optional<double> {
    const RecordNumber &option = record_numbers[i];
    const std::optional<std::string> &text = arguments.*option.text;
    return text ? std::optional(number_option(option.name, *text, option.range)) : std::nullopt;
  };
  options.sampling_rate = number(0);
  if (const auto frequency = number(1)) options.omega = 2.0 * pi * *frequency;
  if (const auto phase = number(2)) options.phase = *phase * pi / 180.0;
  options.Fw = number(3);
  options.me_re = number(4);
  options.m2 = number(5);
  options.m3 = number(6);
  options.low_pass = number(7);
  options.corner = number(9);
  if (options.corner && options.omega && 2.0 * pi * *options.corner > 0.5 * *options.omega)
    throw UsageError(refusal("--corner-frequency", *arguments.corner_frequency,
                             "up to half the frequency of the excitation [Hz]"));
  if (arguments.logger_low_pass) try {
      options.logger_filter = logger_filter_from_text(*arguments.logger_low_pass);
    } catch (const std::invalid_argument &allowed) {
      throw UsageError(refusal("--logger-low-pass", *arguments.logger_low_pass, allowed.what()));
    }
  for (const std::string &text : arguments.delays)
    try {
      if (!options.delays.insert(delay_from_text(text)).second)
        throw std::invalid_argument("each signal once");
    } catch (const std::invalid_argument &allowed) {
      throw UsageError(refusal("--delay", text, allowed.what()));
    }
  if (const auto angle = number(8)) {
    if (options.columns.count("pulse") == 0)
      throw UsageError(refusal("--pulse-angle", *arguments.pulse_angle, "only with --column pulse=HEADER"));
    options.pulse_angle = *angle * pi / 180.0;
  }
  if (options.Fw && options.me_re)
    throw UsageError(refusal("--me-re", *arguments.me_re, "not together with --Fw, which follows from it"));
  if (arguments.chain_case && arguments.roller.file)
    throw UsageError(refusal("--case", *arguments.chain_case, "without --roller, which has another machine"));
  std::optional<GivenRoller> roller = judged(arguments.roller);
  if (arguments.chain_case) add_case(*arguments.chain_case, noted_of(paths), options);
  if (roller) add_roller(*roller, noted_of(paths), options);
  options.bond = bond_of(number(10), number(11), roller, arguments.chain_case, options);
  if (arguments.bond_tolerance) {
    constexpr Range range{0.0, 100.0, "%"};
    const double tolerance = 0.01 * number_option("--bond-tolerance", *arguments.bond_tolerance, range);
    if (options.bond) options.bond->tolerance = tolerance;
  }
  if (roller) options.ends = ends_of(*roller, arguments.exciter_shift);
  const std::optional<double> low_pass = std::exchange(options.low_pass, std::nullopt);
  Record record = read_record(paths, options);
  if (options.logger_filter && (record.pieces.empty() || !options.omega || record.excitation_read))
    throw UsageError(
        refusal("--logger-low-pass", *arguments.logger_low_pass,
                "only for a measured record without F_excitation, with --frequency or --roller"));
  settle_excitation(record, options);
  if (arguments.bond_tolerance && !record.frame_computed)
    throw UsageError(refusal("--bond-tolerance", *arguments.bond_tolerance,
                             "only for a measured record without the frame's acceleration"));
  if (low_pass) filter_signals(record, *low_pass);
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

void add_way_options(CLI::App &command, WayArguments &arguments) {
  text_option(&command, "--from-place", "NUMBER", arguments.from,
              "only the way from this place on [m], of a roller that drives (column s of the run)");
  text_option(&command, "--to-place", "NUMBER", arguments.to,
              "only the way up to this place [m], of a roller that drives");
  text_option(&command, "--of-pass", "COUNT", arguments.pass,
              "only this pass of a roller that drives, counted from 1; the last one if not given");
}

WayRange judged(const WayArguments &arguments) {
  constexpr Range range{-1e6, 1e6, "m"};
  WayRange way;
  if (arguments.from) way.from = number_option("--from-place", *arguments.from, range);
  if (arguments.to) way.to = number_option("--to-place", *arguments.to, range);
  if (way.from && way.to && !(*way.from < *way.to))
    throw UsageError(refusal("--to-place", *arguments.to, "a place beyond --from-place"));
  constexpr int most = 65535;
  if (arguments.pass) way.pass = count_option("--of-pass", *arguments.pass, 1, most);
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
