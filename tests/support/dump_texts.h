// Dumps of a bed as text, written by hand.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace drumlin::test {

/// One array of a VTK file.
struct Array {
  std::string name;
  int components;
  std::string values;
};

/// A VTK file of points.
std::string point_data(int points, const std::string &places, const std::vector<Array> &arrays);

/// Two soil balls side by side, id 1 and 2, and the drum, id 9, above the first; not in order.
std::map<std::string, Array> ball_arrays();
std::string ball_dump(const std::map<std::string, Array> &arrays = ball_arrays(),
                      const std::string &places = "1 3.9 0 2.8 1 0 1 1 0");

/// Ball 2 on 1 named by the higher id first, the drum on 1, and 1 on the floor.
const std::string contact_rows = "2 1 100 30 0 1 0 0 0.2\n1 9 0 -400 0 0 -1 0 0.1\n1 0 5 430 0 0 1 0 0.05\n";
std::string contact_dump(const std::string &rows = contact_rows);

} // namespace drumlin::test
