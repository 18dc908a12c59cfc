#include "commands/commands.h"

#include "support/arguments.h"
#include "commands/bed_files.h"

#include <algorithm>
#include <fmt/format.h>
#include <sstream>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

/// The notes of a file, which rank 0 reads and sends to all ranks. Ends the run if there is no such file.
/// Collective.
RestartNotes shared_notes(LAMMPS *lmp, const std::string &file) {
  std::string text, fault;
  if (lmp->comm->me == 0) {
    if (!can_be_read(file))
      fault = "file is '" + file + "'; allowed: a file that can be read";
    else
      for (const auto &[name, value] : notes_of(file))
        text += fmt::format("{} {}\n", name, value);
  }
  engine::stop_on_fault(lmp, "drumlin/take", fault);
  auto length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, lmp->world);
  text.resize(static_cast<std::size_t>(length));
  MPI_Bcast(text.data(), length, MPI_CHAR, 0, lmp->world);
  std::istringstream lines(text);
  RestartNotes notes;
  for (std::string name, value; lines >> name >> value;)
    notes.emplace_back(name, value);
  return notes;
}

/// Whether two values are the same: words exactly, numbers, also those of lists, to rounding, since a value
/// may come from a formula of the deck.
bool same_value(const std::string &a, const std::string &b) {
  const std::vector<std::string> of_a = list_entries(a);
  const std::vector<std::string> of_b = list_entries(b);
  return std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                    [](const std::string &one, const std::string &other) {
                      const double x = parse_number(one);
                      const double y = parse_number(other);
                      constexpr double rounding = 1e-12;
                      return one == other || std::fabs(x - y) <= rounding * std::fabs(x);
                    });
}

/// Whether `name` is an entry of `list`, whose entries are separated by commas.
bool is_listed(const std::string &list, const std::string &name) {
  return ("," + list + ",").find("," + name + ",") != std::string::npos;
}

} // namespace

void take_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/take", narg, arg);
  const std::string file =
      in.word("file", "a file of drumlin/write_restart, drumlin/write_data or drumlin/run");
  const std::string decks =
      in.word("the list of decks", "the names of the decks that make the file, between commas");
  const std::string allow_change = in.word("the variables that may change", "names between commas, or none");
  enum class Kind { fixed, free, if_noted };
  const std::vector<std::string> kinds = {"fixed", "free", "if_noted"};
  std::vector<std::pair<std::string, Kind>> names;
  for (Kind kind = Kind::fixed; !in.empty();) {
    const std::string word = in.word("name");
    const auto found = std::find(kinds.begin(), kinds.end(), word);
    if (found != kinds.end())
      kind = static_cast<Kind>(found - kinds.begin());
    else
      names.emplace_back(word, kind);
  }
  std::string may_change;
  for (const auto &[name, kind] : names)
    if (kind == Kind::free) may_change += (may_change.empty() ? "" : ",") + name;
  if (allow_change != "none") {
    std::istringstream list(allow_change);
    for (std::string name; std::getline(list, name, ',');)
      if (!is_listed(may_change, name))
        in.fail(fmt::format("variable allow_change is '{}'; allowed: none, or names between commas out of {}",
                            allow_change, may_change));
  }

  const RestartNotes notes = shared_notes(lmp, file);
  LAMMPS_NS::Variable &variables = *lmp->input->variable;
  for (const auto &[name, kind] : names) {
    const auto note = std::find_if(notes.begin(), notes.end(),
                                   [&name = name](const auto &one) { return one.first == name; });
    if (note == notes.end()) {
      if (kind == Kind::if_noted) continue;
      in.fail(fmt::format("file is '{}', which does not note the value of {}; allowed: a complete file that "
                          "{} of this version have made",
                          file, name, decks));
    }
    std::string words[] = {name, "index", note->second};
    const char *given = variables.find(words[0].data()) >= 0 ? variables.retrieve(words[0].data()) : nullptr;
    if (given == nullptr) {
      char *pointers[] = {words[0].data(), words[1].data(), words[2].data()};
      variables.set(3, pointers);
    } else if (!same_value(given, note->second) && !(kind == Kind::free && is_listed(allow_change, name)))
      in.fail(fmt::format(
          "variable {} is '{}'; allowed: {}, with which '{}' was made; for another value {}{}", name, given,
          note->second, file, kind == Kind::if_noted ? "begin a new run" : "run " + decks + " again",
          kind == Kind::free ? ", or change it on purpose by -var allow_change " + name : ""));
  }
}

} // namespace drumlin
