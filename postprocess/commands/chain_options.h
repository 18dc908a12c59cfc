// Options that describe the chain: --case, --transition, --roller and the options that replace single values.
// All subcommands that need a chain read them here, with the same checks and messages.
#pragma once

#include "chain/parameters.h"
#include "commands/command.h"
#include "files/roller.h"
#include "meter/values.h"
#include "support/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstddef>
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

/// The numbers of the chain; not given: the roller's or the case's.
struct ChainNumberArguments : Options {
  explicit ChainNumberArguments(Command &of);
  /// As in chain_numbers, and --frequency in place of --omega.
  std::array<Number, 10> all = {
      of_chain(0), of_chain(1),
      of_chain(2), number("--frequency", {1e-6, 1e8, "Hz"}, "the same in Hz, instead"),
      of_chain(3), of_chain(4),
      of_chain(5), of_chain(6),
      of_chain(7), of_chain(8)};

private:
  Number of_chain(std::size_t number_of_chain) const;
};

struct ChainArguments : Options {
  using Options::Options;
  static constexpr const char *group = "Instead of the case's values";
  Text chain_case = text("--case", "TEXT",
                         fmt::format("case of the paper's Table 1, with --roller of its soil alone: {}",
                                     fmt::join(table1_cases, ", ")),
                         "II");
  Text transition = text("--transition", "TEXT", "transition condition of the contact: A or B", "B");
  RollerArguments roller{command(), group}; ///< all values but k, D and g
  ChainNumberArguments numbers{command()};

  /// The option that was given for one of chain_numbers: of omega, --omega or --frequency; none if neither
  /// was.
  const Number *given(const std::string &name) const;
};

/// The chain that was asked for.
struct AskedChain {
  ChainParameters parameters;
  std::optional<double> me_re; ///< eccentric moment [kg m] from which Fw follows; none: Fw is given
  /// With the values that single options put in place of its own.
  std::optional<GivenRoller> roller;
};

/// What is wrong with the frequency [rad/s] of the excitation, said of the option that a user gave it with.
std::string frequency_refusal(const ChainArguments &arguments, double omega, const std::string &allowed);

/// The chain; UsageError if it cannot be computed. The force of a roller's exciter follows from the frequency
/// by its eccentric moment, unless --Fw is given.
AskedChain judged_chain(const ChainArguments &arguments);
/// The same as -var words for in.chain, each after a blank.
std::string deck_words(const ChainArguments &arguments);

} // namespace drumlin::post
