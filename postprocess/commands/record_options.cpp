#include "commands/record_options.h"

#include "chain/parameters.h"
#include "commands/text_options.h"
#include "record/excitation.h"
#include "support/options.h"
#include "support/usage_error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace {

constexpr double pi = 3.14159265358979323846;

/// An option that is a number of the record.
struct RecordNumber {
  const char *name;
  std::optional<std::string> RecordArguments::*text;
  Range range;
  const char *help;
};

constexpr std::array<RecordNumber, 10> record_numbers = {
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
      "of accelerometers that pass no constant, of first order [Hz]: what they take is given back"}}};

// What a roller's data say where the command line does not. With another frequency the force follows from the
// eccentric moment; the force of a case without one stays the same.
void add_case(const std::string &name, RecordOptions &options) {
  NamedChain chain;
  try {
    chain = named_chain(name, Transition::B);
  } catch (const std::invalid_argument &error) {
    throw UsageError(fmt::format("--{}", error.what()));
  }
  const ChainParameters &p = chain.parameters;
  if (!options.omega) options.omega = p.omega;
  if (!options.m2) options.m2 = p.m2;
  if (!options.m3) options.m3 = p.m3;
  if (options.Fw || options.me_re) return;
  if (chain.me_re)
    options.me_re = chain.me_re;
  else
    options.Fw = p.Fw;
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
                  "NAME=HEADER:UNIT, where HEADER may be the column's number; NAME is "
                  "time, x_drum, v_drum, a_drum (up positive), the same with frame, F_contact (compression "
                  "positive) or "
                  "F_excitation (down positive); a '-' before the unit turns the sign")
      ->type_name("NAME=HEADER:UNIT")
      ->expected(1)
      ->take_all()
      ->group("Measured records");
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
      fmt::format("roller whose frequency, eccentric moment and masses count where no option gives them: {}",
                  fmt::join(chain_cases, ", ")))
      ->group("Measured records");
  const auto of_file = [&command](const char *name, std::optional<std::string> &into, const char *help) {
    text_option(&command, name, "WORD", into, help)->group("Measured records");
  };
  of_file("--separator", arguments.separator,
          "what stands between cells: comma, semicolon, tab, bar or blank; found if not given");
  of_file("--decimal", arguments.decimal, "decimal sign: point or comma; found if not given");
  of_file("--piece", arguments.piece,
          "which piece of a file with gaps or blank cells, counted from 1; the longest if not given");
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
  const std::vector<std::string> of_run = {"chain.csv", "bed.csv", "cycles.csv", "parameters.csv"};
  std::vector<GivenPath> files;
  for (const std::filesystem::path &path : paths_of(arguments)) {
    const bool folder = std::filesystem::is_directory(path);
    if (folder || std::find(of_run.begin(), of_run.end(), path.filename()) != of_run.end())
      for (const GivenPath &file : files_in("RECORD", folder ? path : path.parent_path(), of_run))
        files.push_back(file);
    else
      files.push_back({"RECORD", path});
  }
  return files;
}

Record judged(const RecordArguments &arguments) {
  RecordOptions options;
  const std::vector<std::filesystem::path> paths = paths_of(arguments);
  if (arguments.separator)
    options.format.separator =
        sign_of("--separator", *arguments.separator,
                {{"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"bar", '|'}, {"blank", ' '}});
  if (arguments.decimal)
    options.format.decimal = sign_of("--decimal", *arguments.decimal, {{"point", '.'}, {"comma", ','}});
  if (options.format.separator == ',' && options.format.decimal == ',')
    throw UsageError(refusal("--decimal", *arguments.decimal, "not the sign between cells"));
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
  if (arguments.chain_case) add_case(*arguments.chain_case, options);
  const std::optional<double> low_pass = std::exchange(options.low_pass, std::nullopt);
  Record record = read_record(paths, options);
  settle_excitation(record, options);
  if (low_pass) filter_signals(record, *low_pass);
  return record;
}

} // namespace drumlin::post
