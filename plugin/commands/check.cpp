#include "commands/commands.h"

#include "support/arguments.h"
#include "commands/bed_files.h"
#include "support/whole_file.h"

#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

struct Engine : LAMMPS_NS::Pointers {
  explicit Engine(LAMMPS *engine) : Pointers(engine) {}
  LAMMPS_NS::Error *errors() { return error; }
  int rank() { return comm->me; }
  MPI_Comm ranks() { return world; }
};

/// Whether output files can be written into a folder, which is there or can be made.
bool can_be_folder(const std::string &folder) {
  namespace fs = std::filesystem;
  if (folder.find_first_of("*%") != std::string::npos || !is_output_folder(folder)) return false;
  std::error_code code;
  fs::path there = fs::absolute(folder, code);
  while (!fs::exists(there, code) && there.has_relative_path())
    there = there.parent_path();
  return fs::is_directory(there, code) && access(there.c_str(), W_OK | X_OK) == 0;
}

bool whole_number(const std::string &text, double &value) {
  value = parse_number(text);
  return std::isfinite(value) && value == std::floor(value) && std::fabs(value) < 1e15;
}

} // namespace

void check_command(LAMMPS *lmp, int narg, char **arg) {
  Engine engine(lmp);
  Arguments in(engine.errors(), "drumlin/check", narg, arg);
  const std::string name = in.word("the variable's name");
  const std::string value = in.word("the value of variable " + name);
  constexpr const char *rules = "one_of, positive, non_negative, finite, integer, multiple_of, directory, "
                                "output_folder, file, data_file, restart, restart_name or one_rank";
  const std::string rule = in.word("the rule for variable " + name, rules);
  const auto reject = [&](const std::string &allowed) {
    in.fail("variable " + name + " is '" + value + "'; allowed: " + allowed);
  };

  if (rule == "one_of") {
    std::vector<std::string> choices;
    while (!in.empty())
      choices.push_back(in.word("choice"));
    bool found = false;
    for (const std::string &choice : choices)
      found = found || choice == value;
    if (choices.empty())
      in.fail("rule one_of for variable " + name + " has no choice; allowed: at least one word");
    if (!found) reject(join_choices(choices));
  } else if (rule == "positive" || rule == "non_negative" || rule == "finite") {
    const Range range = rule == "positive" ? Range::positive
                        : rule == "finite" ? Range::any
                                           : Range::non_negative;
    // Beyond these bounds products of quantities leave the range of a double.
    constexpr double smallest = 1e-30;
    constexpr double largest = 1e30;
    const double number = parse_number(value);
    const double size = std::fabs(number);
    if (!in_range(number, range) || size > largest || (size != 0.0 && size < smallest))
      reject(std::string(allowed_text(range)) +
             (std::isfinite(number) && in_range(number, range) ? ", between 1e-30 and 1e30 in size" : ""));
  } else if (rule == "integer") {
    const auto lowest = in.integer("rule integer, lowest", INT_MIN);
    const auto highest = in.integer("rule integer, highest", lowest);
    double number = 0.0;
    if (!whole_number(value, number) || number < static_cast<double>(lowest) ||
        number > static_cast<double>(highest))
      reject(fmt::format("a whole number from {} to {}", lowest, highest));
  } else if (rule == "multiple_of") {
    const std::string other = in.word("rule multiple_of, the other variable's name");
    const std::string other_value = in.word("rule multiple_of, the other variable's value");
    double a = 0.0;
    double b = 0.0;
    if (!whole_number(value, a) || !whole_number(other_value, b) || b <= 0.0 || a <= 0.0 ||
        std::fmod(a, b) != 0.0)
      reject(fmt::format("a multiple of {}, which is {}", other, other_value));
  } else if (rule == "directory" || rule == "output_folder") {
    int bad = 0;
    if (engine.rank() == 0) {
      std::error_code failed;
      bad = !can_be_folder(value);
      if (!bad && rule == "directory")
        bad = !std::filesystem::create_directories(value, failed) && !std::filesystem::is_directory(value);
    }
    MPI_Bcast(&bad, 1, MPI_INT, 0, engine.ranks());
    if (bad)
      reject("a folder that can be made or written, without * and % in its path, and not /, /dev, /proc or "
             "/sys");
  } else if (rule == "file") {
    std::string maker;
    while (!in.empty())
      maker += (maker.empty() ? "" : " ") + in.word("command that makes the file");
    int bad = 0;
    if (engine.rank() == 0) {
      std::error_code failed;
      bad = !std::filesystem::is_regular_file(value, failed) || access(value.c_str(), R_OK) != 0;
    }
    MPI_Bcast(&bad, 1, MPI_INT, 0, engine.ranks());
    if (bad) reject("a file that can be read" + (maker.empty() ? "" : ", which '" + maker + "' makes"));
  } else if (rule == "restart_name") {
    int bad = engine.rank() == 0 && !is_restart_name(value) ? 1 : 0;
    MPI_Bcast(&bad, 1, MPI_INT, 0, engine.ranks());
    if (bad) reject(restart_name_allowed);
  } else if (rule == "one_rank") {
    int ranks = 0;
    MPI_Comm_size(engine.ranks(), &ranks);
    if (ranks > 1)
      in.fail(fmt::format("variable {} is '{}' on {} ranks; allowed: one rank", name, value, ranks));
  } else if (rule == "data_file" || rule == "restart") {
    const RestartNotes notes = rule == "restart" ? read_notes(lmp, in) : RestartNotes{};
    std::string fault;
    if (engine.rank() == 0) fault = rule == "restart" ? restart_fault(value, notes) : data_file_fault(value);
    if (!fault.empty()) fault = "variable " + name + " is '" + value + "'" + fault;
    engine::end_if(lmp, "drumlin/check", fault);
  } else {
    in.fail("unknown rule '" + rule + "' for variable " + name + "; allowed: " + rules);
  }
  if (!in.empty())
    in.fail("variable " + name + ": '" + in.peek() + "' is left over; allowed: one value and one rule");
}

} // namespace drumlin
