#pragma once
// Keywords of `model hooke/transition` for pairs and walls: parsed and checked here, then handed to the
// engine's settings as the switches that the models registered. (The engine's own parser reads past a missing
// value, takes any text as a number and names neither the command nor what is allowed.)

#include "error.h"

#include <string>
#include <vector>

namespace drumlin {

/// The models beside the normal one.
struct Companions {
  bool tangential_spring;
  bool rolling;
};

/// Words that the engine's settings parser gets, in its form.
class ModelSettings {
public:
  /// \param command for error texts, e.g. "pair_style gran model hooke/transition"
  /// \param companions a rolling model takes `torsionTorque on|off`; the normal model is told of the
  /// tangential spring
  ModelSettings(LAMMPS_NS::Error *error, const std::string &command, const Companions &companions, int narg,
                char **arg);

  int size() const { return static_cast<int>(pointers_.size()); }
  char **words() { return pointers_.data(); }

private:
  std::vector<std::string> words_;
  std::vector<char *> pointers_;
};

} // namespace drumlin
