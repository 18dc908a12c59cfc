#include "tests/support/dump_texts.h"

#include <algorithm>

namespace drumlin::test {

namespace {

std::string array_text(const Array &array) {
  return "<DataArray type=\"Float64\" Name=\"" + array.name + "\" NumberOfComponents=\"" +
         std::to_string(array.components) + "\" format=\"ascii\">" + array.values + "</DataArray>\n";
}

} // namespace

std::string point_data(int points, const std::string &places, const std::vector<Array> &arrays) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<PolyData>\n"
      "<Piece NumberOfPoints=\"" +
      std::to_string(points) +
      "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData>\n";
  for (const Array &array : arrays)
    text += array_text(array);
  return text + "</PointData>\n<Points>\n" + array_text({"Points", 3, places}) +
         "</Points>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

std::map<std::string, Array> ball_arrays() {
  return {{"id", {"id", 1, "9 2 1"}},           {"type", {"type", 1, "2 1 1"}},
          {"radius", {"radius", 1, "2 1 1"}},   {"mass", {"mass", 1, "500 20 10"}},
          {"v", {"v", 3, "0 0 0 0 6 0 3 0 0"}}, {"omega", {"omega", 3, "0 0 0 0 0 2 0 0 1"}},
          {"f", {"f", 3, "0 7 0 0 0 0 1 2 3"}}};
}
std::string ball_dump(const std::map<std::string, Array> &arrays, const std::string &places) {
  std::vector<Array> columns;
  columns.reserve(arrays.size());
  for (const auto &named : arrays)
    columns.push_back(named.second);
  return point_data(3, places, columns);
}

std::string contact_dump(const std::string &rows) {
  std::string text = "ITEM: TIMESTEP\n200\nITEM: NUMBER OF ENTRIES\n" +
                     std::to_string(std::count(rows.begin(), rows.end(), '\n')) + "\nITEM: ENTRIES";
  for (int n = 1; n <= 9; ++n)
    text += " f_contacts[" + std::to_string(n) + "]";
  return text + " \n" + rows;
}

} // namespace drumlin::test
