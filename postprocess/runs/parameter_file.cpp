#include "runs/parameter_file.h"

#include "support/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>

namespace drumlin::post {

namespace {
constexpr const char *parameters_header = "name,value";
} // namespace

std::map<std::string, std::string> read_parameters(const std::filesystem::path &file) {
  const Table table = read_table(file);
  const std::vector<std::string> names = table.text("name");
  const std::vector<std::string> values = table.text("value");
  std::map<std::string, std::string> parameters;
  for (std::size_t i = 0; i < table.rows(); ++i)
    if (!parameters.emplace(names[i], values[i]).second)
      csv_refusal(file, table.line(i), "name", names[i], "each name once");
  return parameters;
}

std::string parameters_text(const std::vector<std::pair<std::string, std::string>> &parameters) {
  std::string text = fmt::format("{}\n", parameters_header);
  for (const auto &[name, value] : parameters)
    text += fmt::format("{},{}\n", csv_cell(name), csv_cell(value));
  return text;
}

namespace {
/// What tells one bed from another; runs of earlier versions do not note the seed.
const std::set<std::string> of_bed = {"seed", "balls", "d50", "C_u", "layer_tops", "drum_depth"};
const std::set<std::string> of_run = {
    "timestep",       "dt",    "side_height", "ranks",        "command",
    "plugin",         "out",   "start",       "bed",          "ended",
    "roller",         "guard", "time_limit",  "allow_change", "dumps_per_pass",
    "dumps_per_cycle"};
} // namespace

bool varies_with_seed(const std::string &name) { return of_bed.count(name) + of_run.count(name) > 0; }

std::string no_samples(const std::map<std::string, std::string> &run,
                       const std::map<std::string, std::string> &other) {
  const auto value = [](const std::map<std::string, std::string> &of, const std::string &name) {
    const auto found = of.find(name);
    return found == of.end() ? "unknown" : found->second;
  };
  std::map<std::string, std::string> names = run;
  names.insert(other.begin(), other.end());
  for (const auto &[name, text] : names)
    if (!varies_with_seed(name) && value(run, name) != value(other, name))
      return fmt::format("{} is '{}' and '{}'", name, value(run, name), value(other, name));
  const bool same = std::all_of(of_bed.begin(), of_bed.end(), [&](const std::string &name) {
    return value(run, name) == value(other, name);
  });
  const std::string seed = value(run, "seed");
  return same || (seed != "unknown" && seed == value(other, "seed"))
             ? fmt::format("both are of one bed, seed {}", seed)
             : "";
}

std::string roller_words(const std::map<std::string, std::string> &parameters) {
  const auto text = [&parameters](const std::string &name) {
    const auto found = parameters.find(name);
    return found == parameters.end() || found->second == "none" ? std::string() : found->second;
  };
  if (text("roller").empty()) return {};
  const auto number = [&text](const std::string &name, double scale, const char *unit) {
    const std::optional<double> value = any_number_from_text(text("roller_" + name));
    return value ? fmt::format("{:.4g}{}", scale * *value, unit) : std::string();
  };
  std::string words = "The roller is that of " + text("roller");
  if (!text("setting").empty()) words += ", setting " + text("setting");
  const char *between = ": ";
  const auto add = [&](const char *name, const std::string &value, const std::string &behind = "") {
    if (value.empty()) return;
    words += between + fmt::format(fmt::runtime(name), value) + behind;
    between = ", ";
  };
  const auto per_metre = [&number](const char *name) {
    const std::string value = number(name, 1e-3, " kN/m");
    return value.empty() ? value : " (" + value + ")";
  };
  add("{}", number("frequency", 1.0, " Hz"));
  add("eccentric moment {}", number("eccentric_moment", 1.0, " kg m"));
  add("exciter force {}", number("exciter_force", 1e-3, " kN"), per_metre("exciter_force_per_metre"));
  add("nominal amplitude {}", number("nominal_amplitude", 1e3, " mm"));
  add("static load {}", number("static_load", 1e-3, " kN"), per_metre("static_load_per_metre"));
  add("frame on its bond {}", number("frame_frequency", 1.0, " Hz"),
      text("roller_bond_assumed") == "yes" ? ", a bond that is assumed" : "");
  return words + ".";
}

} // namespace drumlin::post
