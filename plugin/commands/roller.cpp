#include "commands/commands.h"

#include "commands/deck_variables.h"
#include "physics/files/roller.h"
#include "support/arguments.h"

#include <fmt/format.h>
#include <stdexcept>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

/// The roller of a file that rank 0 reads, on all ranks: only one rank needs to see the file. None if the
/// file is no roller's, which is refused. Collective.
std::optional<Roller> shared_roller(LAMMPS *lmp, const std::string &file) {
  std::string text;
  int is_roller = 0;
  if (lmp->comm->me == 0) try {
      text = roller_text(file);
      read_roller(text, file);
      is_roller = 1;
    } catch (const std::invalid_argument &error) {
      text = error.what();
    }
  MPI_Bcast(&is_roller, 1, MPI_INT, 0, lmp->world);
  auto length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, lmp->world);
  text.resize(static_cast<std::size_t>(length));
  MPI_Bcast(text.data(), length, MPI_CHAR, 0, lmp->world);
  if (is_roller != 0) return read_roller(text, file);
  DeckVariables::refuse(lmp, "drumlin/roller: " + text);
  return std::nullopt;
}

/// Words for drumlin/record.
std::string rows_of(const RollerSetting &setting, const std::vector<DerivedValue> &values) {
  std::string rows = "setting " + (setting.name.empty() ? "none" : setting.name);
  for (const DerivedValue &value : values)
    rows += fmt::format(" roller_{} {:.9g}", value.name, value.value);
  return rows;
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
    return;
  }

  const std::optional<Roller> read = shared_roller(lmp, file);
  if (!read) return;
  const Roller &roller = *read;
  double share = 1.0;
  if (per_metre) {
    if (!roller.width) {
      refuse("width of '" + file +
             "' is missing; allowed: the width of the drum, since a bed has the roller per "
             "metre of it");
      return;
    }
    share = 1.0 / *roller.width;
  }
  const auto set = [&variables](const char *name, double value) {
    variables.set_default(name, fmt::format("{:.17g}", value));
  };
  set("m2", roller.m2 * share);
  set("m3", roller.m3 * share);
  set("k23", roller.k23 * share);
  set("c23", roller.c23 * share);
  if (per_metre && !variables.value("r2")) {
    if (!roller.diameter) {
      refuse("diameter of '" + file +
             "' is missing; allowed: the diameter of the drum in the file, or its radius "
             "by -var r2");
      return;
    }
    set("r2", 0.5 * *roller.diameter);
  }
  if (!wanted) return;

  try {
    const RollerSetting &setting = setting_of(roller, *wanted, file);
    set("omega", 2.0 * roller_file::pi * setting.frequency);
    std::string omega_text = *variables.value("omega");
    for (const GivenVariable &given : given_variables()) // none of the deck's before it is declared
      if (given.name == "omega" && given.values.size() == 1) omega_text = given.values.front();
    const double omega = parse_number(omega_text);
    if (!in_range(omega, Range::positive)) {
      refuse("variable omega is '" + omega_text + "'; allowed: " + allowed_text(Range::positive));
      return;
    }
    set("Fw", setting.me_re * omega * omega * share);
    const double g = parse_number(variables.value("g").value_or(""));
    const std::vector<DerivedValue> values =
        derived_values(roller, setting, omega, std::isfinite(g) ? g : roller_file::gravity);
    variables.set_default("roller_values", rows_of(setting, values));
    std::string text =
        fmt::format("Roller '{}'{}:\n", file, setting.name.empty() ? "" : ", setting " + setting.name);
    for (const DerivedValue &value : values)
      text += fmt::format("  {:<24} {:.6g} {}\n", value.name, value.value, value.unit);
    if (roller.bond_assumed)
      text +=
          "  The bond of drum and frame is not in the file: that of inputs/rollers/Axas2020 is assumed.\n";
    engine::log_message(lmp, text);
  } catch (const std::invalid_argument &error) {
    refuse(error.what());
  }
}

} // namespace drumlin
