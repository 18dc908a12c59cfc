// The variables that a deck declares, by tables and by lines `drumlin/variable`. No engine is run for it.
#pragma once

#include "files/variable_table.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace drumlin::post {

/// A variable as a deck declares it; texts as in the deck.
using DeckVariable = VariableLine;

/// The variables that a deck and the files that it includes declare, in this order. An `if` whose
/// condition the values decide is followed, others are ignored. \param given values of -var, which decide
/// what is included and are the defaults shown
std::vector<DeckVariable> deck_variables(const std::filesystem::path &deck,
                                         std::map<std::string, std::string> given);

/// A table of the variables by group: name, default, unit, range and meaning. \param width in columns
std::string variables_text(const std::vector<DeckVariable> &variables, std::size_t width);

} // namespace drumlin::post
