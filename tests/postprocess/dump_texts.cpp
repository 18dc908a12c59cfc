#include "dump_texts.h"

namespace drumlin::test {

namespace {

std::string array_text(const Array &array) {
  return "<DataArray type=\"Float64\" Name=\"" + array.name + "\" NumberOfComponents=\"" +
         std::to_string(array.components) + "\" format=\"ascii\">" + array.values + "</DataArray>\n";
}

} // namespace

std::string poly_data(int points, const std::string &places, const std::vector<Array> &point_data, int lines,
                      const std::vector<Array> &cell_data) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
                     "byte_order=\"LittleEndian\">\n<PolyData>\n"
                     "<Piece NumberOfPoints=\"" +
                     std::to_string(points) + "\" NumberOfVerts=\"0\" NumberOfLines=\"" +
                     std::to_string(lines) + "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData>\n";
  for (const Array &array : point_data)
    text += array_text(array);
  text += "</PointData>\n<CellData>\n";
  for (const Array &array : cell_data)
    text += array_text(array);
  text += "</CellData>\n<Points>\n" + array_text({"Points", 3, places}) +
          "</Points>\n<Lines>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">";
  for (int i = 0; i < 2 * lines; ++i)
    text += std::to_string(i) + " ";
  text += "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">";
  for (int i = 1; i <= lines; ++i)
    text += std::to_string(2 * i) + " ";
  return text + "</DataArray>\n</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

std::map<std::string, Array> ball_arrays() {
  return {{"id", {"id", 1, "9 2 1"}},           {"type", {"type", 1, "2 1 1"}},
          {"radius", {"radius", 1, "2 1 1"}},   {"mass", {"mass", 1, "500 20 10"}},
          {"v", {"v", 3, "0 0 0 0 6 0 3 0 0"}}, {"omega", {"omega", 3, "0 0 0 0 0 2 0 0 1"}},
          {"f", {"f", 3, "0 7 0 0 0 0 1 2 3"}}};
}
std::string ball_dump(const std::map<std::string, Array> &arrays) {
  std::vector<Array> columns;
  columns.reserve(arrays.size());
  for (const auto &named : arrays)
    columns.push_back(named.second);
  return poly_data(3, "1 3.9 0 2.8 1 0 1 1 0", columns, 0, {});
}

std::map<std::string, Array> contact_arrays() {
  return {{"id1", {"id1", 1, "2 1"}},
          {"id2", {"id2", 1, "1 9"}},
          {"force", {"force", 3, "100 30 0 0 -400 0"}},
          {"delta", {"delta", 1, "0.2 0.1"}}};
}
std::string contact_dump(const std::map<std::string, Array> &arrays) {
  std::vector<Array> columns;
  columns.reserve(arrays.size());
  for (const auto &named : arrays)
    columns.push_back(named.second);
  return poly_data(4, "2.8 1 0 1 1 0 1 1 0 1 3.9 0", {}, 2, columns);
}

} // namespace drumlin::test
