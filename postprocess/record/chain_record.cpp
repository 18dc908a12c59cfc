#include "record/chain_record.h"

namespace drumlin::post {

Record chain_record(const ChainParameters &parameters, const ChainHistory &history, int every) {
  Record record;
  record.file = "chain.csv"; // x_drum counts from where drum and soil touch
  record.interval =
      every * (history.time.back() - history.time.front()) / static_cast<double>(history.size() - 1);
  const auto some_of = [every](const std::vector<double> &all) {
    std::vector<double> some;
    for (std::size_t i = 0; i < all.size(); i += static_cast<std::size_t>(every))
      some.push_back(all[i]);
    return some;
  };
  record.time = some_of(history.time);
  record.x_drum = some_of(history.x_drum);
  record.v_drum = some_of(history.v_drum);
  record.a_drum = some_of(history.a_drum);
  record.x_frame = some_of(history.x_frame);
  record.v_frame = some_of(history.v_frame);
  record.a_frame = some_of(history.a_frame);
  record.F_contact = some_of(history.F_contact);
  record.F_excitation = some_of(history.F_excitation);
  record.omega = parameters.omega;
  record.phase = 0.0;
  record.Fw = parameters.Fw;
  record.m2 = parameters.m2;
  record.m3 = parameters.m3;
  record.g = parameters.g;
  return record;
}

} // namespace drumlin::post
