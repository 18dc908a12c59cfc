// Acceptance criteria for the results of a study.
#pragma once

#include "pages/table.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// An acceptance criterion with its bound, the measured value, and whether the value meets it.
struct Acceptance {
  std::string criterion, measured;
  bool holds;
};

/// The table of all criteria on a study's page, and data/acceptance.csv.
PageTable acceptance_table(const std::vector<Acceptance> &criteria);

/// "7 of 8 acceptance criteria hold.", with the criteria that do not.
std::string acceptance_words(const std::vector<Acceptance> &criteria);

} // namespace drumlin::post
