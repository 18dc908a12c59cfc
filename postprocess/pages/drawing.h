// Small drawings of the models that pages are about, as inline SVG.
#pragma once

#include <string>

namespace drumlin::post {

/// The models of this project.
enum class Drawing {
  chain,     ///< fixed soil, drum and frame, joined by contact and suspension
  bed,       ///< drum and frame on a bed of balls
  drive,     ///< drum and frame that drive over a bed of balls
  confined,  ///< one ball confined between two walls
  oedometer, ///< a sample between two plates, loaded from above
  sphere,    ///< a sphere that strikes a plane
  biaxial,   ///< a sample between four plates, under a side stress
  triaxial,  ///< a sample between six plates, under a side stress
  plate,     ///< a plate under a stress on a bed of balls
  shear,     ///< a sample between two plates, of which the upper one moves sideways
  repose,    ///< soil on a floor from which a wall moves away
  silo,      ///< soil between two walls, whose floor moves down
  wall,      ///< soil behind a wall that moves outward
  two_ends   ///< drum and frame that tilt, seen along the way of travel
};

/// <figure class="scene"> with the drawing, its text alternative and a caption.
std::string drawing_html(Drawing model);

} // namespace drumlin::post
