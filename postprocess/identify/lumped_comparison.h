// A record of a roller beside the lumped chain with the k and D that were identified in it: where a linear
// spring and dashpot do what the soil did, and where they cannot.
#pragma once

#include "chain/parameters.h"
#include "identify/identified_record.h"
#include "pages/page.h"
#include "record/record.h"
#include "support/statistics.h"

#include <array>
#include <string>
#include <vector>

namespace drumlin::post {

/// The quantities of a cycle that are compared.
enum class CycleQuantity { acceleration, force, contact, cmv, work };
constexpr std::array<CycleQuantity, 5> cycle_quantities = {CycleQuantity::acceleration, CycleQuantity::force,
                                                           CycleQuantity::contact, CycleQuantity::cmv,
                                                           CycleQuantity::work};

/// Values of one cycle, in the order of `cycle_quantities`: largest upward acceleration of the drum [m/s2],
/// largest contact force [N], share of time in contact [-], 300 A_2/A_1 of the drum's acceleration [-], and
/// work that the drum does on the soil [J], which is the area of the loop of contact force over position.
using CycleValues = std::array<double, cycle_quantities.size()>;

/// A quantity of record and chain.
struct ComparedQuantity {
  MeanInterval record; ///< mean over the cycles that count, with its 95 % confidence interval
  double lumped; ///< mean over as many cycles of the chain's steady motion as LumpedComparison::lumped_cycles
                 ///< has
  MeanInterval difference; ///< record minus chain; its interval contains those of k and D, too
};

/// A record, the chain beside it, and what was compared.
struct LumpedComparison {
  ChainParameters chain;
  Record record;
  Record lumped;                ///< the chain's last cycles, as many as the record's, and at the same times
  std::vector<double> position; ///< of the drum from the origin of the law; NaN out of contact [m]
  double r2 = 0.0;              ///< share of the variance of the force in contact that the law explains
  double settlement = 0.0;      ///< of the mean position of the drum, per cycle [m]
  std::size_t first = 0; ///< cycles of the record that count: from this one, counted from 0, to the last
  std::vector<CycleValues> record_cycles; ///< all of them
  std::vector<CycleValues> lumped_cycles; ///< of the chain's steady motion
  std::array<ComparedQuantity, cycle_quantities.size()> quantities;

  const ComparedQuantity &of(CycleQuantity quantity) const {
    return quantities.at(static_cast<std::size_t>(quantity));
  }
  /// Whether record and chain differ beyond scatter: the interval of the difference does not contain zero,
  /// and it is above 1 % of the chain's value (work: 5 %; CMV: above 1, too; contact: above 0.01, too).
  bool differs(CycleQuantity quantity) const;
};

/// Checks that a record is that of a run and has what compare_lumped() needs besides the identified k and D:
/// samples of the drum's acceleration, of the contact force and of the exciter's force, and Fw, k23 and c23
/// in its parameters.csv. Call it before the identification, which takes longer. Throws std::runtime_error,
/// with a message of one line, if something is missing.
void require_comparable(const Record &record);

/// Solves the chain of the record's roller with the identified k and D, in closed form, until its motion is
/// steady, and compares it with the record. Of the record, the second half of the cycles is compared, as in
/// other figures of beds, and one cycle more if that is an odd number. Throws std::runtime_error, with a
/// message of one line, if require_comparable() refuses the record, or if the identified k or D is not above
/// zero.
LumpedComparison compare_lumped(const Record &record, const IdentifiedRecord &found);

/// In words: which quantities differ beyond scatter, and what of the record a spring and a dashpot cannot do.
/// One or several records of the same roller and soil; from two on, scatter is that over the records.
std::vector<std::string> lumped_answer(const std::vector<LumpedComparison> &records);

/// Adds figures of the first record and a table of all to a page. Figures are numbered from `number`.
void add_lumped_comparison(Page &page, const std::vector<LumpedComparison> &records, int number);

} // namespace drumlin::post
