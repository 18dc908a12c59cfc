#include "vtk_files.h"

#include "chain_csv.h"

#include <fmt/format.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringOutputWindow.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <unordered_map>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path &file, const std::string &what) {
  throw std::runtime_error(fmt::format("{}: {}", file.string(), what));
}

/// While it lives, VTK's complaints come here instead of the screen.
class Complaints {
public:
  Complaints() : before_(vtkOutputWindow::GetInstance()), verbosity_(vtkLogger::GetCurrentVerbosityCutoff()) {
    vtkOutputWindow::SetInstance(window_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~Complaints() {
    vtkLogger::SetStderrVerbosity(verbosity_);
    vtkOutputWindow::SetInstance(before_);
  }
  Complaints(const Complaints &) = delete;
  Complaints &operator=(const Complaints &) = delete;

  /// The first one as one line, without where in VTK it arose; empty if there is none.
  std::string first() const {
    std::string text = window_->GetOutput();
    const std::size_t colon = text.find("): "); // "ERROR: In file, line n\nvtkClass (address): text"
    if (colon != std::string::npos) text.erase(0, colon + 3);
    text.erase(std::min(text.find_first_of("\r\n"), text.size()));
    return text;
  }

private:
  vtkNew<vtkStringOutputWindow> window_;
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkLogger::Verbosity verbosity_;
};

vtkSmartPointer<vtkPolyData> read_poly_data(const fs::path &file) {
  std::error_code code;
  if (!fs::is_regular_file(file, code)) fail(file, "is not a file");
  const Complaints complaints;
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  if (const std::string fault = complaints.first(); !fault.empty() || reader->GetErrorCode() != 0)
    fail(file, fmt::format("is no whole VTK file of points and lines (VTK: {})",
                           fault.empty() ? "no reason given" : fault));
  return reader->GetOutput();
}

/// One array of a file: finite numbers of so many components.
class Column {
public:
  Column(const fs::path &file, vtkDataSetAttributes *data, const char *name, int components, vtkIdType rows)
      : array_(data->GetArray(name)) {
    if (array_ == nullptr || array_->GetNumberOfComponents() != components ||
        array_->GetNumberOfTuples() != rows)
      fail(file, fmt::format("array '{}' with {} rows of {} numbers is missing; expected a dump as "
                             "inputs/bed/dumps makes it",
                             name, rows, components));
    for (vtkIdType row = 0; row < rows; ++row)
      for (int c = 0; c < components; ++c)
        if (!std::isfinite(array_->GetComponent(row, c)))
          fail(file, fmt::format("array '{}' holds {}, expected finite numbers", name,
                                 array_->GetComponent(row, c)));
  }

  double number(vtkIdType row) const { return array_->GetComponent(row, 0); }
  long whole(vtkIdType row) const { return std::lround(number(row)); }
  Vector vector(vtkIdType row) const {
    return {array_->GetComponent(row, 0), array_->GetComponent(row, 1), array_->GetComponent(row, 2)};
  }

private:
  vtkDataArray *array_;
};

template <class Array, class Values, class Part>
void add_array(vtkDataSetAttributes *data, const char *name, int components, const Values &values,
               const Part &part) {
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
void add_numbers(vtkDataSetAttributes *data, const char *name, const Values &values, const Part &part) {
  add_array<vtkDoubleArray>(data, name, 1, values,
                            [&part](const auto &value, const auto &set) { set(0, part(value)); });
}
template <class Values, class Part>
void add_whole(vtkDataSetAttributes *data, const char *name, const Values &values, const Part &part) {
  add_array<vtkIntArray>(data, name, 1, values, [&part](const auto &value, const auto &set) {
    set(0, static_cast<int>(part(value)));
  });
}
/// The same for vectors and tensors.
template <class Values, class Part>
void add_components(vtkDataSetAttributes *data, const char *name, const Values &values, const Part &part) {
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
  const Complaints complaints;
  vtkNew<Writer> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputData(data);
  if (writer->Write() != 1 || !complaints.first().empty())
    fail(file, fmt::format("cannot be written (VTK: {})", complaints.first()));
}

constexpr auto itself = [](const auto &value) { return value; };

} // namespace

std::map<long, bool> dumped_steps(const fs::path &dumps) {
  static const std::regex pattern(R"(balls_(\d{1,18})\.vtp)");
  std::map<long, bool> steps;
  std::error_code code;
  for (const fs::directory_entry &entry : fs::directory_iterator(dumps, code)) {
    const std::string name = entry.path().filename().string();
    std::smatch match;
    if (std::regex_match(name, match, pattern))
      steps[std::stol(match[1])] = fs::exists(dumps / fmt::format("contacts_{}.vtp", match[1].str()));
  }
  return steps;
}

std::vector<Ball> read_ball_dump(const fs::path &file) {
  const vtkSmartPointer<vtkPolyData> data = read_poly_data(file);
  const vtkIdType rows = data->GetNumberOfPoints();
  if (rows == 0) fail(file, "holds no balls");
  vtkPointData *columns = data->GetPointData();
  const Column id(file, columns, "id", 1, rows), type(file, columns, "type", 1, rows),
      radius(file, columns, "radius", 1, rows), mass(file, columns, "mass", 1, rows),
      velocity(file, columns, "v", 3, rows), spin(file, columns, "omega", 3, rows),
      force(file, columns, "f", 3, rows);
  std::vector<Ball> balls(static_cast<std::size_t>(rows));
  vtkIdType row = 0;
  for (Ball &ball : balls) {
    ball = {id.whole(row),
            static_cast<int>(type.whole(row)),
            radius.number(row),
            mass.number(row),
            {},
            velocity.vector(row),
            spin.vector(row),
            force.vector(row)};
    data->GetPoint(row, ball.position.data());
    if (!(ball.radius > 0.0))
      fail(file, fmt::format("the radius of ball {} is {}, expected > 0", ball.id, ball.radius));
    for (const double coordinate : ball.position)
      if (!std::isfinite(coordinate)) fail(file, fmt::format("ball {} is at {}", ball.id, coordinate));
    ++row;
  }
  std::sort(balls.begin(), balls.end(), [](const Ball &a, const Ball &b) { return a.id < b.id; });
  const auto twice = std::adjacent_find(balls.begin(), balls.end(),
                                        [](const Ball &a, const Ball &b) { return a.id == b.id; });
  if (twice != balls.end()) fail(file, fmt::format("there are two balls with the id {}", twice->id));
  return balls;
}

std::vector<BallContact> read_contact_dump(const fs::path &file, const std::vector<Ball> &balls) {
  const vtkSmartPointer<vtkPolyData> data = read_poly_data(file);
  const vtkIdType rows = data->GetNumberOfCells();
  std::vector<BallContact> contacts;
  if (rows == 0) return contacts;
  vtkCellData *columns = data->GetCellData();
  const Column id1(file, columns, "id1", 1, rows), id2(file, columns, "id2", 1, rows),
      force(file, columns, "force", 3, rows), overlap(file, columns, "delta", 1, rows);
  std::unordered_map<long, std::size_t> places;
  for (std::size_t place = 0; place < balls.size(); ++place)
    places[balls[place].id] = place;
  const auto place_of = [&](long id) {
    const auto found = places.find(id);
    if (found == places.end())
      fail(file, fmt::format("a contact of ball {}, which the dump of the balls does not have", id));
    return found->second;
  };
  for (vtkIdType row = 0; row < rows; ++row) {
    BallContact contact{place_of(id1.whole(row)), place_of(id2.whole(row)), force.vector(row),
                        overlap.number(row)};
    if (contact.i > contact.j) { // a ball of the other rank came first
      std::swap(contact.i, contact.j);
      for (double &component : contact.force)
        component = -component;
    }
    contacts.push_back(contact);
  }
  const auto order = [](const BallContact &a, const BallContact &b) {
    return std::tie(a.i, a.j) < std::tie(b.i, b.j);
  };
  std::sort(contacts.begin(), contacts.end(), order);
  const auto twice =
      std::adjacent_find(contacts.begin(), contacts.end(),
                         [&order](const BallContact &a, const BallContact &b) { return !order(a, b); });
  if (twice != contacts.end())
    fail(file, fmt::format("the contact of balls {} and {} is there twice", balls[twice->i].id,
                           balls[twice->j].id));
  return contacts;
}

void write_ball_points(const fs::path &file, const std::vector<Ball> &balls,
                       const std::vector<int> &coordination) {
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
  if (!coordination.empty()) add_whole(columns, "coordination", coordination, itself);
  write<vtkXMLPolyDataWriter>(file, data.Get());
}

void write_contact_lines(const fs::path &file, const std::vector<Ball> &balls,
                         const std::vector<BallContact> &contacts) {
  vtkNew<vtkPoints> points; // two of its own for every line: cell data can become point data
  vtkNew<vtkCellArray> lines;
  for (const BallContact &contact : contacts) {
    const std::array<vtkIdType, 2> ends = {points->InsertNextPoint(balls[contact.i].position.data()),
                                           points->InsertNextPoint(balls[contact.j].position.data())};
    lines->InsertNextCell(2, ends.data());
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(lines);
  vtkCellData *columns = data->GetCellData();
  add_components(columns, "force", contacts, [](const BallContact &contact) { return contact.force; });
  add_numbers(columns, "normal_force", contacts,
              [&balls](const BallContact &contact) { return force_parts(balls, contact).normal; });
  add_numbers(columns, "tangential_force", contacts,
              [&balls](const BallContact &contact) { return force_parts(balls, contact).tangential; });
  add_numbers(columns, "overlap", contacts, [](const BallContact &contact) { return contact.overlap; });
  add_whole(columns, "id1", contacts, [&balls](const BallContact &contact) { return balls[contact.i].id; });
  add_whole(columns, "id2", contacts, [&balls](const BallContact &contact) { return balls[contact.j].id; });
  write<vtkXMLPolyDataWriter>(file, data.Get());
}

void write_field_image(const fs::path &file, const FieldGrid &grid, const BedFields &fields) {
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
