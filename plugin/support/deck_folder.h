#pragma once
// The variable `here` of decks: the folder of the deck.

#include "engine.h"

#include <string>

namespace drumlin {

/// Folder of a deck. If the deck is a symbolic link, the folder of the file that it points to, since the
/// files that the deck includes are there. The engine splits its input at blanks: if the path of the folder
/// has blanks and the path to it from the working directory has none, the latter is returned.
std::string folder_of_deck(const std::string &deck);

/// Defines the variable `here` as the folder of the deck that -in names, so that `include ${here}/FILE` works
/// from any working directory; "." for a deck from standard input. A value given by `-var here FOLDER` is
/// kept.
void define_deck_folder(engine::LAMMPS *lmp);

} // namespace drumlin
