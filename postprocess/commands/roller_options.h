// The options --roller, --setting and --case, with the same checks and messages in all subcommands.
#pragma once

#include "chain/parameters.h"
#include "commands/command.h"
#include "files/roller.h"
#include "meter/values.h"
#include "support/options.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

struct RollerArguments : Options {
  using Options::Options;
  Text file =
      text("--roller", "FILE",
           "masses, bond, frequency and eccentric moment of the roller that the file describes, as those "
           "of inputs/rollers; other options, and what a run has noted, count more");
  Text setting = text("--setting", "NAME", "setting of the roller's exciter; needed if its file has several");
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

/// The roller, if one is given; UsageError if its file cannot be read or has no such setting.
/// Numbers that rollers do not have are told on standard error.
std::optional<GivenRoller> judged(const RollerArguments &arguments);

/// The file that is read, if there is one, for keep_apart().
std::vector<GivenPath> files_of(const RollerArguments &arguments);

/// The same as -var words for a deck, each after a blank.
std::string deck_words(const RollerArguments &arguments);

/// The size of the drum, for E_vib.
struct DrumArguments : Options {
  using Options::Options;
  Number radius = number("--drum-radius", {1e-3, 1e3, "m"},
                         "radius of the drum [m], for E_vib; not given: that of --roller");
  Number width = number("--drum-width", {1e-3, 1e3, "m"},
                        "width of the drum [m], for E_vib; not given: that of --roller");
  Number poisson =
      number("--poisson", {0.0, 0.5},
             fmt::format("Poisson's ratio of the soil [-], for E_vib; {} if not given", usual_poisson));
};

/// Size of the drum and Poisson's ratio of the soil, from the options, else from the roller's file; nothing
/// if neither has radius and width.
/// UsageError for one without the other.
std::optional<LineContact> judged(const DrumArguments &arguments, const std::optional<GivenRoller> &roller);

/// The case of Table 1 that --case names. UsageError for another name; for that of a roller of the project it
/// says which file has the roller.
ChainParameters given_case(const std::string &name, Transition transition);

} // namespace drumlin::post
