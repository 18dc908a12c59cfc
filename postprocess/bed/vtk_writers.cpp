#include "bed/vtk_writers.h"

#include "bed/vtk_messages.h"
#include "support/csv.h"
#include "support/files.h"

#include <fmt/format.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataWriter.h>

#include <array>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <type_traits>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr auto itself = [](const auto &value) { return value; };

template <class Array, class Values, class Part>
void add_array(vtkFieldData *data, const char *name, int components, const Values &values, const Part &part) {
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  vtkIdType row = 0;
  for (const auto &value : values) {
    part(value,
         [&array, row](int component, auto number) { array->SetTypedComponent(row, component, number); });
    ++row;
  }
  data->AddArray(array);
}

/// An array of numbers, each got from a value by part(value).
template <class Values, class Part>
void add_numbers(vtkFieldData *data, const char *name, const Values &values, const Part &part) {
  add_array<vtkDoubleArray>(data, name, 1, values,
                            [&part](const auto &value, const auto &set) { set(0, part(value)); });
}
template <class Values, class Part>
void add_whole(vtkFieldData *data, const char *name, const Values &values, const Part &part) {
  add_array<vtkIntArray>(data, name, 1, values, [&part](const auto &value, const auto &set) {
    set(0, static_cast<int>(part(value)));
  });
}
/// The same for vectors and tensors.
template <class Values, class Part>
void add_components(vtkFieldData *data, const char *name, const Values &values, const Part &part) {
  using Components = std::decay_t<decltype(part(values.front()))>;
  constexpr std::size_t components = std::tuple_size_v<Components>;
  add_array<vtkDoubleArray>(data, name, static_cast<int>(components), values,
                            [&part](const auto &value, const auto &set) {
                              const Components numbers = part(value);
                              for (std::size_t c = 0; c < components; ++c)
                                set(static_cast<int>(c), numbers[c]);
                            });
}

template <class Writer, class Data>
void write(const fs::path &file, Data *data) {
  const VtkMessages messages;
  vtkNew<Writer> writer;
  writer->SetInputData(data);
  // Appended data, VTK's default, is not read by the ParaView of Debian 12 with today's libexpat.
  writer->SetDataModeToBinary();
  // To memory first: VTK crashes if it writes to a file on a full disk.
  writer->WriteToOutputStringOn();
  if (writer->Write() != 1 || !messages.first().empty())
    throw std::runtime_error(fmt::format("{}: cannot be written (VTK: {})", file.string(), messages.first()));
  write_files({{file, writer->GetOutputString()}});
}

} // namespace

void write_ball_points(const fs::path &file, const std::vector<Ball> &balls, const ContactSums &sums,
                       const StepValues &values) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> vertices;
  for (const Ball &ball : balls) {
    const vtkIdType point = points->InsertNextPoint(ball.position.data());
    vertices->InsertNextCell(1, &point);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetVerts(vertices);
  vtkPointData *columns = data->GetPointData();
  add_numbers(columns, "radius", balls, [](const Ball &ball) { return ball.radius; });
  add_numbers(columns, "diameter", balls, [](const Ball &ball) { return 2.0 * ball.radius; });
  add_components(columns, "velocity", balls, [](const Ball &ball) { return ball.velocity; });
  add_components(columns, "angular_velocity", balls, [](const Ball &ball) { return ball.spin; });
  add_components(columns, "force", balls, [](const Ball &ball) { return ball.force; });
  add_numbers(columns, "mass", balls, [](const Ball &ball) { return ball.mass; });
  add_whole(columns, "type", balls, [](const Ball &ball) { return ball.type; });
  add_whole(columns, "id", balls, [](const Ball &ball) { return ball.id; });
  if (!sums.coordination.empty()) add_whole(columns, "coordination", sums.coordination, itself);
  if (!sums.pressure.empty()) add_numbers(columns, "pressure", sums.pressure, itself);
  for (const auto &[name, value] : values)
    add_numbers(data->GetFieldData(), name.c_str(), std::array<double, 1>{value}, itself);
  write<vtkXMLPolyDataWriter>(file, data.Get());
}

void write_contact_lines(const fs::path &file, const std::vector<Ball> &balls, const BedContacts &contacts) {
  struct Line {
    Vector from, to, force;
    ForceParts parts;
    double overlap;
    long id1, id2;
  };
  std::vector<Line> lines;
  lines.reserve(contacts.balls.size() + contacts.walls.size());
  for (const BallContact &contact : contacts.balls) {
    const Ball &i = balls[contact.i];
    const Vector &x = i.position, &l = contact.branch;
    lines.push_back({x,
                     {x[0] - l[0], x[1] - l[1], x[2] - l[2]},
                     contact.force,
                     force_parts(contact),
                     contact.overlap,
                     i.id,
                     balls[contact.j].id});
  }
  for (const WallContact &contact : contacts.walls) {
    const Ball &i = balls[contact.i];
    lines.push_back(
        {i.position, foot(i, contact), contact.force, force_parts(contact), contact.overlap, i.id, 0});
  }
  vtkNew<vtkPoints> points; // two of its own for every line: cell data can become point data
  vtkNew<vtkCellArray> cells;
  for (const Line &line : lines) {
    const std::array<vtkIdType, 2> ends = {points->InsertNextPoint(line.from.data()),
                                           points->InsertNextPoint(line.to.data())};
    cells->InsertNextCell(2, ends.data());
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  vtkCellData *columns = data->GetCellData();
  add_components(columns, "force", lines, [](const Line &line) { return line.force; });
  add_numbers(columns, "normal_force", lines, [](const Line &line) { return line.parts.normal; });
  add_numbers(columns, "tangential_force", lines, [](const Line &line) { return line.parts.tangential; });
  add_numbers(columns, "overlap", lines, [](const Line &line) { return line.overlap; });
  add_whole(columns, "id1", lines, [](const Line &line) { return line.id1; });
  add_whole(columns, "id2", lines, [](const Line &line) { return line.id2; });
  write<vtkXMLPolyDataWriter>(file, data.Get());
}

void write_field_image(const fs::path &file, const FieldGrid &grid, const BedFields &fields,
                       const std::vector<LayerPackings> &packings) {
  std::array<int, 3> points{};
  for (std::size_t a = 0; a < 3; ++a) // a flat grid is a sheet in z = 0
    points[a] = grid.flat && a == 2 ? 1 : static_cast<int>(grid.cells[a]) + 1;
  vtkNew<vtkImageData> data;
  data->SetDimensions(points.data());
  data->SetOrigin(grid.origin.data());
  data->SetSpacing(grid.sides.data());
  vtkCellData *columns = data->GetCellData();
  add_numbers(columns, "solid_fraction", fields.solid_fraction, itself);
  add_numbers(columns, "bulk_density", fields.bulk_density, itself);
  add_components(columns, "velocity", fields.velocity, itself);
  add_numbers(columns, "coordination", fields.coordination, itself);
  add_components(columns, "stress", fields.stress, itself);
  add_numbers(columns, "pressure", fields.pressure, itself);
  add_components(columns, "fabric", fields.fabric, itself);
  if (!packings.empty()) {
    std::vector<double> relative, compaction;
    for (std::size_t cell = 0; cell < grid.size(); ++cell) {
      const std::size_t row = cell / grid.cells[0] % grid.cells[1]; // y is up
      const double height = grid.origin[1] + (static_cast<double>(row) + 0.5) * grid.sides[1];
      const LayerPackings &layer = layer_at(packings, height);
      const double solid = fields.solid_fraction[cell];
      const bool any = solid > 0.0;
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      relative.push_back(any ? layer.relative_density(solid) : none);
      compaction.push_back(any ? layer.compaction(solid) : none);
    }
    add_numbers(columns, "relative_density", relative, itself);
    add_numbers(columns, "compaction", compaction, itself);
  }
  write<vtkXMLImageDataWriter>(file, data.Get());
}

std::string collection_text(const std::vector<std::pair<double, std::string>> &files) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (const auto &[time, name] : files)
    text += fmt::format("    <DataSet timestep=\"{}\" file=\"{}\"/>\n", number_text(time), name);
  return text + "  </Collection>\n</VTKFile>\n";
}

} // namespace drumlin::post
