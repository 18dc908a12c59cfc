#include "commands/commands.h"

#include "commands/bed_files.h"
#include "commands/deck_variables.h"
#include "support/arguments.h"

#include <algorithm>
#include <fmt/format.h>
#include <sstream>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

/// The notes of a file, which rank 0 reads and sends to all ranks; none if there is no such file, which is
/// refused. Collective.
RestartNotes shared_notes(LAMMPS *lmp, const std::string &file) {
  std::string text, fault;
  if (lmp->comm->me == 0) {
    if (!can_be_read(file)) fault = "drumlin/take: file is '" + file + "'; allowed: a file that can be read";
    for (const auto &[name, value] : fault.empty() ? notes_of(file) : RestartNotes())
      text += fmt::format("{} {}\n", name, value);
  }
  fault = engine::from_rank_0(lmp, fault);
  if (!fault.empty()) DeckVariables::refuse(lmp, fault);
  std::istringstream lines(engine::from_rank_0(lmp, text));
  RestartNotes notes;
  for (std::string name, value; lines >> name >> value;)
    notes.emplace_back(name, value);
  return notes;
}

} // namespace

void take_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/take", narg, arg);
  TakenNotes taken;
  taken.file = in.word("file", "a file of drumlin/write or drumlin/run");
  taken.decks = in.word("the list of decks", "the names of the decks that make the file, between commas");
  if (const std::string change = in.word("the variables that may change", "names between commas, or none");
      change != "none")
    taken.change = list_entries(change);
  std::vector<std::string> except;
  std::vector<std::string> only;
  std::vector<std::string> *const lists[] = {&taken.fixed, &taken.free,     &except,
                                             &only,        &taken.standard, &taken.later};
  const std::vector<std::string> keywords = {"fixed", "free", "except", "only", "default", "later"};
  std::vector<std::string> *list = nullptr;
  while (!in.empty()) {
    const std::string word = in.word("word");
    const auto keyword = std::find(keywords.begin(), keywords.end(), word);
    if (keyword != keywords.end())
      list = lists[keyword - keywords.begin()];
    else if (list != nullptr)
      list->push_back(word);
    else
      in.fail("keyword", word, join_choices(keywords));
  }
  DeckVariables variables(lmp);
  if (!variables.fault().empty()) return; // drumlin/variables will tell it
  taken.notes = shared_notes(lmp, taken.file);
  if (taken.notes.empty() && !(taken.fixed.empty() && taken.free.empty()))
    DeckVariables::refuse(lmp, "drumlin/take: file is '" + taken.file +
                                   "', which notes no values; allowed: a file that " + taken.decks +
                                   " of this version have made");
  for (const char *own : {"engine", "end", "bytes", "crc32"})
    except.push_back(own);
  taken.notes.erase(std::remove_if(taken.notes.begin(), taken.notes.end(),
                                   [&](const auto &note) {
                                     return is_in(except, note.first) ||
                                            (!only.empty() && !is_in(only, note.first));
                                   }),
                    taken.notes.end());
  variables.take(taken);
  for (const auto &[name, value] : taken.notes)
    variables.set_default(name, value);
}

} // namespace drumlin
