#include "contact/deck_check.h"

#include "contact/contact_source.h"
#include "support/other_styles.h"

#include <fmt/format.h>

using LAMMPS_NS::Fix;

namespace {

// A private member: the word of the command that the engine carries out. C++ allows an explicit instantiation
// to name it as a template argument; the friend function of the instance gives access to it.
template <auto Member>
struct InputAccess {
  friend auto &command_of(LAMMPS_NS::Input &input) { return input.*Member; }
};
auto &command_of(LAMMPS_NS::Input &input);
template struct InputAccess<&LAMMPS_NS::Input::command>;

} // namespace

namespace drumlin {
namespace {

void refuse(const engine::LAMMPS *lmp, const std::string &command, const std::string &fault) {
  lmp->error->all(FLERR, engine::error_text(command + ": " + fault));
}

/// Commands and run styles in which forces are computed, and balls are moved, otherwise than by velocity
/// Verlet.
void check_run(const engine::LAMMPS *lmp, const std::string &command) {
  const char *word = command_of(*lmp->input);
  const std::string present = word == nullptr ? "" : word;
  if (lmp->update->whichflag == 2 || has_name(refused_commands, present))
    refuse(lmp, command,
           "command is '" + present + "', which does not move balls in time by their forces; allowed: run");
  const std::string style = lmp->update->integrate_style;
  if (!has_name(right_run_styles, without_suffix(style)))
    refuse(lmp, command,
           "run_style is '" + style + "', in which its forces do not act as they should; allowed: verlet");
}

bool atom_style_is_right(const engine::LAMMPS *lmp) {
  for (const char *style : {"sphere", "granular"})
    if (lmp->atom->style_match(style) != nullptr) return true;
  return false;
}

const char *allowed_text(const OtherFixes &fixes) {
  return fixes.stock == Verdict::right ? "stepping stock, or no such fix" : "no such fix";
}

bool is_own(const Fix &fix) { return has_name(other_fixes[0].names, fix.style); }

/// Whether a style is of no interest to a deck: the engine's and the plugin's helpers, which decks do not
/// name.
bool is_internal(std::string_view style) {
  constexpr std::string_view own = "drumlin/";
  return style.substr(0, own.size()) == own ||
         style.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_/") == style.npos;
}

} // namespace

void DeckCheck::of_pair(engine::LAMMPS *lmp, const std::string &command, bool second) {
  if (lmp->update->whichflag == 0) return; // not a run: a command that needs the engine's lists
  if (!lmp->atom->radius_flag)
    refuse(lmp, command,
           std::string("atom_style is '") + lmp->atom->atom_style +
               "', which has no radius; allowed: sphere");
  if (std::string(lmp->force->pair_style) == "hybrid/scaled")
    refuse(lmp, command,
           "pair_style is 'hybrid/scaled', which changes forces of contacts after they were computed; "
           "allowed: hybrid or hybrid/overlay");
  look(lmp, command, second);
}

void DeckCheck::of_fix(engine::LAMMPS *lmp, const Fix &fix) {
  if (lmp->update->whichflag == 0 || contact_source(lmp) != nullptr) return;
  for (const Fix *first : engine::fixes(lmp->modify)) {
    if (!is_own(*first)) continue;
    if (first == &fix) look(lmp, std::string("fix ") + fix.style, false);
    return;
  }
}

void DeckCheck::look(engine::LAMMPS *lmp, const std::string &command, bool second) {
  if (!lmp->atom->rmass_flag)
    refuse(lmp, command,
           std::string("atom_style is '") + lmp->atom->atom_style +
               "', whose balls have no mass of their own; allowed: sphere");
  const double per_force = lmp->force->ftm2v;
  if (per_force != 1.0)
    refuse(
        lmp, command,
        fmt::format("units is '{}', in which a force is not a mass times an acceleration; allowed: si, cgs, "
                    "micro, nano or lj",
                    lmp->update->unit_style));
  check_run(lmp, command);
  // Without the closing command drumlin/variables the faults of declared variables have not been reported.
  char open[] = "drumlin_open";
  LAMMPS_NS::Variable &variables = *lmp->input->variable;
  if (const char *value = variables.find(open) < 0 ? nullptr : variables.retrieve(open);
      value != nullptr && std::string(value) == "yes")
    refuse(lmp, "drumlin/variable",
           "command drumlin/variables is missing; allowed: behind the last drumlin/variable, before a run");
  std::string untried, growing;
  bool guarded = false;
  const auto add = [](std::string &names, const std::string &name) {
    names += (names.empty() ? "" : ", ") + name;
  };
  if (!atom_style_is_right(lmp)) add(untried, std::string("atom_style ") + lmp->atom->atom_style);
  for (const Fix *fix : engine::fixes(lmp->modify)) {
    if (is_internal(fix->style)) continue;
    const std::string name = std::string("fix ") + fix->id + " (" + fix->style + ")";
    const OtherFixes *fixes = other_fixes_with(fix->style);
    const Verdict verdict = fixes == nullptr ? Verdict::untried : second ? fixes->second : fixes->stock;
    if (verdict == Verdict::untried) add(untried, name);
    if (verdict == Verdict::refused)
      refuse(lmp, command,
             fmt::format("stepping is '{}' and {} {}; allowed: {}", second ? "second" : "stock", name,
                         fixes->what, allowed_text(*fixes)));
    if (without_suffix(fix->style) == "adapt") add(growing, name);
    guarded = guarded || std::string(fix->style) == "guard";
  }
  if (!untried.empty())
    untried = fmt::format("{}: it has not been tried beside {}; taken for granted: these add forces of their "
                          "own at most, after those of contacts and before the end of the step, and change "
                          "no position, velocity, mass, radius, type, group, box or time step",
                          command, untried);
  if (!growing.empty() && !guarded)
    add(untried, fmt::format("{}: {} may let balls grow, and there is no fix guard, which finds contacts "
                             "that the neighbour list then misses",
                             command, growing));
  if (untried.empty() || untried == warned_) return;
  warned_ = untried;
  if (lmp->comm->me == 0) lmp->error->warning(FLERR, engine::error_text(untried));
}

} // namespace drumlin
