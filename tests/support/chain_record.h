// A run of the chain: as the record of a roller, and how far two runs are apart.
#pragma once

#include "tests/support/prelude.h"
#include "record/chain_record.h"

namespace drumlin::test {

/// The record that reading the run's chain.csv and parameters.csv would give, without F_contact.
inline post::Record record_of(const post::ChainParameters &parameters, const post::ChainHistory &history) {
  post::Record record = post::chain_record(parameters, history);
  record.F_contact.clear();
  return record;
}

/// Largest magnitude of a value.
inline double largest(const std::vector<double> &values) {
  double most = 0.0;
  for (const double value : values)
    most = std::max(most, std::fabs(value));
  return most;
}

/// Largest difference of the first `rows` values of two columns, over the largest value of the second.
inline double relative(const std::vector<double> &a, const std::vector<double> &b, std::size_t rows) {
  double most = 0.0, scale = 0.0;
  for (std::size_t n = 0; n < rows; ++n) {
    most = std::max(most, std::fabs(a.at(n) - b.at(n)));
    scale = std::max(scale, std::fabs(b.at(n)));
  }
  return most / scale;
}

/// The same of all their values, which must be as many.
inline double relative(const std::vector<double> &a, const std::vector<double> &b) {
  EXPECT_EQ(a.size(), b.size());
  return relative(a, b, std::min(a.size(), b.size()));
}

} // namespace drumlin::test
