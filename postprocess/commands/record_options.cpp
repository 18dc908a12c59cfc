#include "commands/record_options.h"

#include "chain/parameters.h"
#include "commands/text_options.h"
#include "support/options.h"
#include "support/usage_error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <stdexcept>

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

constexpr std::array<RecordNumber, 8> record_numbers = {
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
      "cut-off frequency of a filter without phase shift for all columns [Hz]"}}};

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
          "RECORD", arguments.record,
          "folder of a run, its chain.csv, bed.csv or cycles.csv, or a measured CSV file with a header line")
      ->required();
  command
      .add_option("--column", arguments.columns,
                  "where a signal stands in a measured file, and in which unit: NAME=HEADER or "
                  "NAME=HEADER:UNIT; NAME is "
                  "time, x_drum, v_drum, a_drum (up positive), the same with frame, F_contact (compression "
                  "positive) or "
                  "F_excitation (down positive); a '-' before the unit turns the sign")
      ->type_name("NAME=HEADER:UNIT")
      ->expected(1)
      ->take_all()
      ->group("Measured records");
  text_option(
      &command, "--case", "NAME", arguments.chain_case,
      fmt::format("roller whose frequency, eccentric moment and masses count where no option gives them: {}",
                  fmt::join(chain_cases, ", ")))
      ->group("Measured records");
  for (const RecordNumber &number : record_numbers)
    text_option(&command, number.name, "NUMBER", arguments.*number.text, number.help)
        ->group("Measured records");
}

std::vector<GivenPath> files_of(const RecordArguments &arguments) {
  const std::vector<std::string> of_run = {"chain.csv", "bed.csv", "cycles.csv", "parameters.csv"};
  const std::filesystem::path path = path_option("RECORD", arguments.record);
  const bool folder = std::filesystem::is_directory(path);
  if (!folder && std::find(of_run.begin(), of_run.end(), path.filename()) == of_run.end())
    return {{"RECORD", path}};
  return files_in("RECORD", folder ? path : path.parent_path(), of_run);
}

Record judged(const RecordArguments &arguments) {
  RecordOptions options;
  const std::filesystem::path path = path_option("RECORD", arguments.record);
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
  if (options.Fw && options.me_re)
    throw UsageError(refusal("--me-re", *arguments.me_re, "not together with --Fw, which follows from it"));
  if (arguments.chain_case) add_case(*arguments.chain_case, options);
  return read_record(path, options);
}

} // namespace drumlin::post
