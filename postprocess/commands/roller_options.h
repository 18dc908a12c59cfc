// The options --roller, --setting and --case, with the same checks and messages in all subcommands.
#pragma once

#include "chain/parameters.h"
#include "files/roller.h"
#include "meter/values.h"
#include "support/options.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace drumlin::post {

/// The options as given.
struct RollerArguments {
  std::optional<std::string> file, setting;
  bool is_first = true; ///< of several readings of the file: warnings of it are told
};

/// A roller at one of its settings.
struct GivenRoller {
  std::string file;
  Roller machine;
  RollerSetting setting;

  /// What follows from the file: rows for parameters.csv, the file and the name of the setting first.
  std::vector<std::pair<std::string, std::string>> rows(double g) const;
  /// The same in lines to print.
  std::vector<std::string> lines(double g) const;
};

/// Adds --roller and --setting; `arguments` must outlive the app. \param group of the help
void add_roller_options(CLI::App &command, RollerArguments &arguments, const char *group);

/// The roller, if one is given; UsageError if its file cannot be read or has no such setting.
/// Numbers that rollers do not have are told on standard error.
std::optional<GivenRoller> judged(const RollerArguments &arguments);

/// The file that is read, if there is one, for keep_apart().
std::vector<GivenPath> files_of(const RollerArguments &arguments);

/// The same as -var words for a deck, each after a blank.
std::string deck_words(const RollerArguments &arguments);

/// The size of the drum as given, for E_vib.
struct DrumArguments {
  std::optional<std::string> radius, width, poisson;
};

/// Adds --drum-radius, --drum-width and --poisson; `arguments` must outlive the app.
void add_drum_options(CLI::App &command, DrumArguments &arguments);

/// Size of the drum and Poisson's ratio of the soil, from the options, else from the roller's file; nothing
/// if neither has radius and width.
/// UsageError for one without the other.
std::optional<LineContact> judged(const DrumArguments &arguments, const std::optional<GivenRoller> &roller);

/// The case of Table 1 that --case names. UsageError for another name; for that of a roller of the project it
/// says which file has the roller.
ChainParameters given_case(const std::string &name, Transition transition);

} // namespace drumlin::post
