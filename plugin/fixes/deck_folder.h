#pragma once
// The variable `here` of decks.

#include "engine.h"

namespace drumlin {

/// Folder of the deck named by -in, so that a deck finds its includes from any working directory (`${here}`);
/// "." for a deck from standard input. A value given by -var stays.
void define_here(engine::LAMMPS *lmp);

} // namespace drumlin
