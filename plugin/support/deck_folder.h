#pragma once
// The variable `here` of decks.

#include "engine.h"

#include <string>

namespace drumlin {

/// Folder of a deck; of the file that a link leads to, for a deck that is a link: its includes lie there. The engine splits its input at
/// blanks, so of a folder whose path has some the path from the working directory is taken if that has none.
std::string folder_of_deck(const std::string &deck);

/// Folder of the deck named by -in, so that a deck finds its includes from any working directory (`${here}`);
/// "." for a deck from standard input. A value given by -var stays.
void define_here(engine::LAMMPS *lmp);

} // namespace drumlin
