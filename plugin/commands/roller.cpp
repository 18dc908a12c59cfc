#include "commands/commands.h"

#include "commands/deck_variables.h"
#include "physics/files/roller.h"
#include "support/arguments.h"

#include <cstdio>
#include <fmt/format.h>
#include <stdexcept>
#include <utility>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

/// The roller of a file that rank 0 reads, on all ranks: only one rank needs to see the file. None if the
/// file is no roller's, which is refused. Collective.
std::optional<Roller> shared_roller(LAMMPS *lmp, const std::string &file) {
  std::string text, fault;
  if (lmp->comm->me == 0) try {
      text = roller_text(file);
      for (const std::string &warning : read_roller(text, file).warnings)
        fmt::print(stderr, "WARNING: drumlin/roller: {}\n", warning);
    } catch (const std::invalid_argument &error) {
      fault = error.what();
    }
  fault = engine::from_rank_0(lmp, fault);
  text = engine::from_rank_0(lmp, text);
  if (fault.empty()) return read_roller(text, file);
  DeckVariables::refuse(lmp, "drumlin/roller: " + fault);
  return std::nullopt;
}

/// Words for drumlin/record.
std::string rows_of(const Roller &roller, const RollerSetting &setting,
                    const std::vector<DerivedValue> &values) {
  std::string rows = "setting " + (setting.name.empty() ? "none" : setting.name);
  for (const DerivedValue &value : values)
    rows += fmt::format(" roller_{} {:.9g}", value.name, value.value);
  return rows + (roller.bond_assumed ? " roller_bond_assumed yes" : "");
}

/// What the command prints.
std::string text_of(const Roller &roller, const std::string &title, const std::vector<DerivedValue> &values) {
  std::string text =
      fmt::format("Roller {}:\n  drum {:.6g} kg, frame {:.6g} kg", title, roller.m2, roller.m3);
  if (roller.width) text += fmt::format(", width {:.6g} m", *roller.width);
  if (roller.diameter) text += fmt::format(", diameter {:.6g} m", *roller.diameter);
  text += "\n";
  for (const DerivedValue &value : values)
    text += fmt::format("  {:<24} {:.6g} {}\n", value.name, value.value, value.unit == "-" ? "" : value.unit);
  if (roller.bond_assumed)
    text += "  The file has no bond: frequency and damping ratio of the frame are assumed, as of Axas2020.\n";
  return text;
}

/// A value that the command line or the deck has given already; none if it is no number.
std::optional<double> given_number(const DeckVariables &variables, const std::string &name) {
  std::string text = variables.value(name).value_or("");
  for (const GivenVariable &given : given_variables()) // none of the deck's before it is declared
    if (given.name == name && given.values.size() == 1) text = given.values.front();
  const double value = parse_number(text);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

} // namespace

void roller_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/roller", narg, arg);
  const std::string file = in.word("roller", "a roller file");
  const bool per_metre = in.choice("what the values are of", {"whole", "per_metre"}) == 1;
  std::optional<std::string> wanted;
  if (!in.empty()) {
    in.choice("word behind it", {"setting"});
    wanted = in.word("setting", "the name of a setting, or none");
    if (*wanted == "none") wanted->clear();
    if (*wanted == "any") wanted.reset();
  }
  in.expect_end("FILE, whole or per_metre, and setting NAME");
  const auto refuse = [lmp](const std::string &fault) {
    DeckVariables::refuse(lmp, "drumlin/roller: " + fault);
  };
  DeckVariables variables(lmp);
  if (!variables.fault().empty()) return; // drumlin/variables will tell it
  if (file == "none") {
    if (wanted && !wanted->empty())
      refuse("setting is '" + *wanted + "'; allowed: none, since no roller is given");
    variables.set_default("roller_values", "setting none");
    return;
  }

  const std::optional<Roller> read = shared_roller(lmp, file);
  if (!read) return;
  Roller roller = *read;
  double share = 1.0;
  if (per_metre) {
    if (!roller.width) {
      refuse("width of '" + file +
             "' is missing; allowed: the width of the drum, since a bed has the roller per metre of it");
      return;
    }
    share = 1.0 / *roller.width;
  }
  // A file other than the one that in.place has used must describe the same roller.
  for (const auto &[noted, noted_file] : variables.taken().notes) {
    if (noted != "roller" || noted_file == file || noted_file == "none") continue;
    for (const auto &[name, value] : {std::pair("m2", &Roller::m2), std::pair("m3", &Roller::m3),
                                      std::pair("k23", &Roller::k23), std::pair("c23", &Roller::c23)})
      if (const std::string of_file = fmt::format("{:.17g}", roller.*value * share),
          was = variables.value(name).value_or(of_file);
          !same_value(was, of_file)) {
        refuse(fmt::format(
            "roller is '{}', whose {} is {}; allowed: a file of the roller with which '{}' was made, "
            "{}, as '{}' was",
            file, name, of_file, variables.taken().file, was, noted_file));
        return;
      }
  }
  // The derived values are computed from the values of the run, which may replace some of the file's.
  for (const auto &[name, value] : {std::pair("m2", &Roller::m2), std::pair("m3", &Roller::m3),
                                    std::pair("k23", &Roller::k23), std::pair("c23", &Roller::c23)}) {
    variables.set_default(name, fmt::format("{:.17g}", roller.*value * share));
    if (const std::optional<double> given = given_number(variables, name)) roller.*value = *given / share;
  }
  if (given_number(variables, "k23").value_or(0.0) != read->k23 * share) roller.bond_assumed = false;
  if (const std::optional<double> r2 = given_number(variables, "r2"); r2 && per_metre)
    roller.diameter = 2.0 * *r2;
  if (per_metre && !roller.diameter) {
    refuse("diameter of '" + file +
           "' is missing; allowed: the diameter of the drum in the file, or its radius by -var r2");
    return;
  }
  if (per_metre) variables.set_default("r2", fmt::format("{:.17g}", 0.5 * *roller.diameter));
  const double g = given_number(variables, "g").value_or(roller_file::gravity);
  if (!wanted) {
    engine::log_message(lmp, text_of(roller, "'" + file + "'", derived_values(roller, nullptr, 0.0, g)));
    return;
  }

  try {
    const RollerSetting &setting = setting_of(roller, *wanted, file);
    variables.set_default("omega", fmt::format("{:.17g}", 2.0 * roller_file::pi * setting.frequency));
    const double omega = given_number(variables, "omega").value_or(0.0);
    if (!in_range(omega, Range::positive)) {
      if (!variables.open()) // else its declaration will tell it
        refuse("variable omega is '" + *variables.value("omega") +
               "'; allowed: " + allowed_text(Range::positive));
      return;
    }
    variables.set_default("Fw", fmt::format("{:.17g}", setting.me_re * omega * omega * share));
    RollerSetting used = setting;
    if (const std::optional<double> Fw = given_number(variables, "Fw"))
      used.me_re = *Fw / (omega * omega * share);
    const std::vector<DerivedValue> values = derived_values(roller, &used, omega, g);
    variables.set_default("roller_values", rows_of(roller, setting, values));
    const std::string of_setting = setting.name.empty() ? "" : ", setting " + setting.name;
    engine::log_message(lmp, text_of(roller, "'" + file + "'" + of_setting, values));
  } catch (const std::invalid_argument &error) {
    refuse(error.what());
  }
}

} // namespace drumlin
