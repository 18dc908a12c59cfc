#include "commands/commands.h"

#include "physics/files/roller.h"
#include "support/arguments.h"

#include <fmt/format.h>
#include <stdexcept>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

/// The text of a file on rank 0, on all ranks: only one rank needs to see the file. Ends the run if the file
/// is no roller's. Collective.
Roller shared_roller(LAMMPS *lmp, const std::string &file) {
  std::string fault, text;
  if (lmp->comm->me == 0) try {
      text = roller_text(file);
      read_roller(text, file);
    } catch (const std::invalid_argument &error) {
      fault = error.what();
    }
  engine::stop_on_fault(lmp, "drumlin/roller", fault);
  auto length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, lmp->world);
  text.resize(static_cast<std::size_t>(length));
  MPI_Bcast(text.data(), length, MPI_CHAR, 0, lmp->world);
  return read_roller(text, file);
}

/// Variables of a deck: those that the command line or the deck has set keep their values.
class Variables {
public:
  explicit Variables(LAMMPS *lmp) : variables_(*lmp->input->variable) {}

  std::optional<std::string> value(std::string name) {
    if (variables_.find(name.data()) < 0) return std::nullopt;
    const char *text = variables_.retrieve(name.data());
    return text == nullptr ? std::nullopt : std::optional<std::string>(text);
  }
  void set(std::string name, std::string value) {
    std::string style = "index";
    char *words[] = {name.data(), style.data(), value.data()};
    if (variables_.find(name.data()) < 0) variables_.set(3, words);
  }
  void set(const std::string &name, double value) { set(name, fmt::format("{:.17g}", value)); }

private:
  LAMMPS_NS::Variable &variables_;
};

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
  if (file == "none") {
    if (wanted && !wanted->empty()) in.fail("setting", *wanted, "none, since no roller is given");
    return;
  }

  const Roller roller = shared_roller(lmp, file);
  double share = 1.0;
  if (per_metre) {
    if (!roller.width)
      in.fail("width of '" + file +
              "' is missing; allowed: the width of the drum, since a bed has the roller "
              "per metre of it");
    share = 1.0 / *roller.width;
  }
  Variables variables(lmp);
  variables.set("m2", roller.m2 * share);
  variables.set("m3", roller.m3 * share);
  variables.set("k23", roller.k23 * share);
  variables.set("c23", roller.c23 * share);
  if (per_metre && !variables.value("r2")) {
    if (!roller.diameter)
      in.fail("diameter of '" + file +
              "' is missing; allowed: the diameter of the drum in the file, or its "
              "radius by -var r2");
    variables.set("r2", 0.5 * *roller.diameter);
  }
  if (!wanted) return;

  try {
    const RollerSetting &setting = setting_of(roller, *wanted, file);
    variables.set("omega", 2.0 * roller_file::pi * setting.frequency);
    const std::string omega_text = *variables.value("omega");
    const double omega = parse_number(omega_text);
    if (!in_range(omega, Range::positive))
      in.fail("variable omega", omega_text, allowed_text(Range::positive));
    variables.set("Fw", setting.me_re * omega * omega * share);
    const double g = parse_number(variables.value("g").value_or(""));
    const std::vector<DerivedValue> values =
        derived_values(roller, setting, omega, std::isfinite(g) ? g : roller_file::gravity);
    variables.set("roller_values", rows_of(setting, values));
    std::string text =
        fmt::format("Roller '{}'{}:\n", file, setting.name.empty() ? "" : ", setting " + setting.name);
    for (const DerivedValue &value : values)
      text += fmt::format("  {:<24} {:.6g} {}\n", value.name, value.value, value.unit);
    if (roller.bond_assumed)
      text +=
          "  The bond of drum and frame is not in the file: that of inputs/rollers/Axas2020 is assumed.\n";
    engine::log_message(lmp, text);
  } catch (const std::invalid_argument &error) {
    in.fail(error.what());
  }
}

} // namespace drumlin
