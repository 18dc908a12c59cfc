// A run of the chain as the record of a roller.
#pragma once

#include "chain/parameters.h"
#include "chain/run_files.h"
#include "record/record.h"

namespace drumlin::test {

/// The record that reading the run's chain.csv and parameters.csv would give, without F_contact.
inline post::Record record_of(const post::ChainParameters &parameters, const post::ChainHistory &history) {
  post::Record record;
  record.file = "chain.csv";
  record.time = history.time;
  record.interval = (history.time.back() - history.time.front()) / static_cast<double>(history.size() - 1);
  record.x_drum = history.x_drum;
  record.v_drum = history.v_drum;
  record.a_drum = history.a_drum;
  record.x_frame = history.x_frame;
  record.v_frame = history.v_frame;
  record.a_frame = history.a_frame;
  record.F_excitation = history.F_excitation;
  record.omega = parameters.omega;
  record.phase = 0.0;
  record.Fw = parameters.Fw;
  record.m2 = parameters.m2;
  record.m3 = parameters.m3;
  record.g = parameters.g;
  return record;
}

} // namespace drumlin::test
