// The values that the report judges runs of the paper's cases by, of inputs/chain/reference_values.csv:
// steady states, compaction meter values, restitutions of single impacts, and velocity errors that are known
// for a number of steps per cycle. Each has its source.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// One reference value of a case and a transition.
struct ReferenceValue {
  std::string case_name;  ///< "I" to "IV", or "D=0.2" of an impact
  std::string transition; ///< "A" or "B"
  std::string quantity;
  std::string unit; ///< of low, high and tolerance; empty for a pure number
  /// As given, in `unit`; equal unless the reference gives a range.
  std::string low_text, high_text;
  double low = 0.0, high = 0.0;
  double tolerance = 0.0; ///< how far outside [low, high] a value may lie and still agree; NaN: not judged
  std::string source;

  int decimals() const; ///< digits given after the point
};

/// Every value, in the order of the file.
const std::vector<ReferenceValue> &reference_values();

/// The value of a case, a transition and a quantity, if there is one.
const ReferenceValue *reference_value(const std::string &case_name, const std::string &transition,
                                      const std::string &quantity);

} // namespace drumlin::post
