// What a study judges: promises about what it measures.
#pragma once

#include "pages/table.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// A promise with its bound, what was measured of it, and whether it is kept.
struct Promise {
  std::string promise, measured;
  bool holds;
};

/// data/promises.csv and the table on the study's page.
ReportTable promise_table(const std::vector<Promise> &promises);

} // namespace drumlin::post
