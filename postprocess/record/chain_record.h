// A solution of the chain as the record of a roller.
#pragma once

#include "chain/parameters.h"
#include "record/record.h"
#include "runs/chain_files.h"

namespace drumlin::post {

/// The record of a roller of which everything is measured.
/// \param every 1: all samples of the history; 2: each second one, and so on
Record chain_record(const ChainParameters &parameters, const ChainHistory &history, int every = 1);

} // namespace drumlin::post
