// The stable region in the plane of damping ratio and w0 dt, measured with the stock engine.
#pragma once

#include "pages/acceptance.h"
#include "studies/study.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// What holds the balls of inputs/study/in.stability.
struct HeldScene {
  const char *name; ///< the deck's variable `scene`
  const char *what; ///< in words
  int contacts;     ///< that act along one direction of motion
};
const std::vector<HeldScene> &held_scenes();

/// One measured boundary beside theory.
struct MapPoint {
  const HeldScene *scene;
  std::string stepping; ///< second or stock
  double D;
  double stable;         ///< longest w0 dt that was stable
  double unstable;       ///< shortest that was not; infinite if none was
  double limit;          ///< theory: of the scene under stock stepping, of its springs under second
  double middle() const; ///< between the two
  double miss() const;   ///< middle / limit - 1
};

/// Measures what options.out/map.csv does not have yet.
std::vector<MapPoint> measure_stability_map(const StudyOptions &options);
std::vector<Acceptance> judge_stability_map(const std::vector<MapPoint> &map);

} // namespace drumlin::post
