#include "record/chain_record.h"

namespace drumlin::post {

Record chain_record(const ChainParameters &parameters, const ChainHistory &history, int every) {
  Record record;
  record.file = "chain.csv";
  record.of_run = true;
  record.known_origin = true;
  record.interval =
      every * (history.time.back() - history.time.front()) / static_cast<double>(history.size() - 1);
  for (const HistoryColumn &column : history_columns) {
    const std::vector<double> &all = history.*column.values;
    for (std::size_t i = 0; i < all.size(); i += static_cast<std::size_t>(every))
      (record.*column.values).push_back(all[i]);
  }
  record.omega = parameters.omega;
  record.phase = 0.0;
  record.Fw = parameters.Fw;
  record.m2 = parameters.m2;
  record.m3 = parameters.m3;
  record.g = parameters.g;
  return record;
}

} // namespace drumlin::post
