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

/// A VTK file of points and lines between neighbours in them.
std::string poly_data(int points, const std::string &places, const std::vector<Array> &point_data, int lines,
                      const std::vector<Array> &cell_data);

/// Two soil balls beside each other, id 1 and 2, and the drum, id 9, above the first; not in order.
std::map<std::string, Array> ball_arrays();
std::string ball_dump(const std::map<std::string, Array> &arrays = ball_arrays());

/// Ball 2 on 1 named by the higher id first, and the drum on 1.
std::map<std::string, Array> contact_arrays();
std::string contact_dump(const std::map<std::string, Array> &arrays = contact_arrays());

} // namespace drumlin::test
