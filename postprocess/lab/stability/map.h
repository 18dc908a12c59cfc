// The stable region in the plane of damping ratio and w0 dt, measured with the stock engine.
#pragma once

#include "experiment/study.h"
#include "pages/acceptance.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// How the balls of inputs/study/in.stability are confined, and by which contact law.
struct HeldScene {
  const char *name;  ///< in tables
  const char *what;  ///< in words
  const char *walls; ///< the deck's variable `scene`
  int contacts;      ///< that act along one direction of motion
  bool hertz;        ///< the Hertz law, else the linear law
  bool quick;        ///< measured with --quick, too
};
const std::vector<HeldScene> &held_scenes();

/// One measured stability limit and the theoretical one.
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

/// One row of map.csv. The first three name the point.
struct MapRow {
  std::string scene, stepping;
  double D = 0.0;
  double stable = 0.0, unstable = 0.0, limit = 0.0; ///< w0 dt, as in MapPoint
  std::string single = {};                          ///< whether there is one boundary: yes or no
};

const CsvSchema<MapRow> &map_rows();

/// Measures the points that options.out/map.csv does not have yet; returns all points.
std::vector<MapPoint> measure_stability_map(const StudyOptions &options);
std::vector<Acceptance> judge_stability_map(const std::vector<MapPoint> &map);

} // namespace drumlin::post
