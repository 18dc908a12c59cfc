// A run of the chain as the record of a roller.
#pragma once

#include "record/chain_record.h"

namespace drumlin::test {

/// The record that reading the run's chain.csv and parameters.csv would give, without F_contact.
inline post::Record record_of(const post::ChainParameters &parameters, const post::ChainHistory &history) {
  post::Record record = post::chain_record(parameters, history);
  record.F_contact.clear();
  return record;
}

} // namespace drumlin::test
