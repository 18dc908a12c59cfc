#pragma once
// Keywords of `model hooke/transition` for pairs and walls: parsed and checked here, then handed to the
// engine's settings as the switches that the models registered. (The engine's own parser reads past a missing
// value, takes any text as a number and names neither the command nor what is allowed.)

#include "error.h"

#include <string>
#include <vector>

namespace drumlin {

/// The settings as words in the form that the engine's settings parser reads.
class ModelSettings {
public:
  /// \param command for error texts, e.g. "pair_style gran model hooke/transition"
  /// \param rolls with rolling resistance the keyword `torsionTorque on|off` is allowed
  ModelSettings(LAMMPS_NS::Error *error, const std::string &command, bool rolls, int narg, char **arg);

  int size() const { return static_cast<int>(pointers_.size()); }
  char **words() { return pointers_.data(); }
  /// Whether a switch has a value.
  bool has(const std::string &name, const std::string &value) const {
    for (std::size_t n = 0; n + 1 < words_.size(); ++n)
      if (words_[n] == name && words_[n + 1] == value) return true;
    return false;
  }

private:
  std::vector<std::string> words_;
  std::vector<char *> pointers_;
};

} // namespace drumlin
