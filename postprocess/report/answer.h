// The answer that a report opens with: what was run and what it says, in a few sentences with the tables'
// numbers.
#pragma once

#include "pages/html.h"
#include "report/bed/measures.h"
#include "report/chain/measures.h"

#include <vector>

namespace drumlin::post {

/// The opening paragraph, and its verdict.
struct Answer {
  std::vector<Sentence> sentences;
  Verdict verdict = Verdict::none;

  /// Adds the other's sentences. A bad verdict stays bad, and any verdict replaces none.
  void add(const Answer &other);
};

/// On chains and single impacts: what was run, agreement with the reference values, difference between
/// conditions A and B, error against the reference solution, agreement of the engines. Good if every check
/// agrees and the engines do. Empty without runs.
Answer chain_answer(const ReportResults &results);

/// On beds: what was run, settlement, state of the bed, forces and their scatter, energy error. Bad if the
/// energy error is large, never good. Empty without groups.
Answer bed_answer(const std::vector<BedGroup> &groups);

/// Whether a bed run's energy error is small enough to be marked as good.
bool energy_is_good(const BedMeasures &measures);

} // namespace drumlin::post
