#pragma once
// Looks at the set-up of a run at the engine's styles that a deck uses besides the plugin's: see
// support/other_styles.h.

#include "engine.h"

#include <string>

namespace drumlin {

/// Ends the run where run style, command, atom style or a fix of the deck does not go with the plugin, and
/// warns of fixes on no list. Every style of the plugin that acts on balls has one: the pair styles, and the
/// fixes that act without them.
class DeckCheck {
public:
  /// For a pair style, in its initialization. Collective. \param second whether its scheme is `stepping
  /// second`
  void of_pair(engine::LAMMPS *lmp, const std::string &command, bool second);
  /// For a fix, in its initialization; does nothing where a pair style of the plugin has looked. Collective.
  void of_fix(engine::LAMMPS *lmp, const LAMMPS_NS::Fix &fix);

private:
  void look(engine::LAMMPS *lmp, const std::string &command, bool second);

  std::string warned_; // the text of the last warning, which comes once
};

} // namespace drumlin
