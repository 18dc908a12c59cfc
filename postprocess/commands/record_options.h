// A record on a command line: the file, and how a measured one is read. One rule and one kind of message for
// all subcommands that take a record.
#pragma once

#include "commands/roller_options.h"
#include "meter/along_way.h"
#include "record/record.h"
#include "support/options.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace drumlin::post {

/// The options as given. Numbers stay text until all are judged.
struct RecordArguments {
  std::vector<std::string> records;
  std::vector<std::string> columns, delays;
  std::optional<std::string> separator, decimal, piece;
  /// The roller, or the case of Table 1, whose frequency, force and masses count where none is given.
  RollerArguments roller;
  std::optional<std::string> chain_case;
  std::optional<std::string> sampling_rate, frequency, phase, Fw, me_re, m2, m3, low_pass, pulse_angle,
      corner_frequency, k23, c23, logger_low_pass;
  std::optional<std::string> bond_tolerance; ///< of identify alone
  bool guess = false;         ///< what the columns are, where no name is known: of meter --show
  double exciter_shift = 0.0; ///< from where the roller's file has the exciter [m]
};

/// Adds RECORD, --column and so on; `arguments` must outlive the app.
void add_record_options(CLI::App &command, RecordArguments &arguments);

/// The part of the way that counts of a record with places, as given.
struct WayArguments {
  std::optional<std::string> from, to, pass;
};

/// Adds --from-place, --to-place and --of-pass; `arguments` must outlive the app.
void add_way_options(CLI::App &command, WayArguments &arguments);

/// UsageError for numbers that cannot be used.
WayRange judged(const WayArguments &arguments);

/// The length of a window given in metres, such as 0.5m [m]; nothing for a text without that unit.
std::optional<double> window_length(const std::string &text);

/// The files that make up the record: of a run all from which it may be read.
std::vector<GivenPath> files_of(const RecordArguments &arguments);

/// Reads the record that was asked for; UsageError for options that cannot be used, std::runtime_error for a
/// file that cannot.
Record judged(const RecordArguments &arguments);

/// The text of a parameters.csv beside results: the record, the numbers of the machine that counted, and what
/// followed from a roller's file.
std::string settings_of(const Record &record);

} // namespace drumlin::post
