#pragma once
// Drum or frame as one body: a group of balls with its centre of mass on an axis.

#include "engine.h"
#include "fixes/roller_state.h"

#include <array>

namespace drumlin {

/// A group of balls and the origin of its coordinate along the axis.
struct RollerBody {
  int groupbit = 0;        ///< 0: there is no such body
  double mass = 0.0;       ///< kg; locate() updates it
  double origin = 0.0;     ///< m, coordinate along the axis where x = 0
  bool has_origin = false; ///< otherwise locate() takes the position that it finds as the origin

  /// Sets x and v of `motion` to those of the centre of mass. Ends the run if one of them is not finite.
  /// Collective.
  /// \param name of the body, for the error
  /// \param stretch m, of the spring that holds the body: if the origin is not yet known, it is set to the
  /// position without stretch
  void locate(engine::LAMMPS *lmp, const std::array<double, 3> &axis, const char *name, double stretch,
              BodyMotion &motion);
};

} // namespace drumlin
