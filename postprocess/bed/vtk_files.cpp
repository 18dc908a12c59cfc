#include "bed/vtk_files.h"

#include "bed/text_dump.h"
#include "support/csv.h"
#include "support/files.h"

#include <fmt/format.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
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
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
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

/// Whether a file begins as XML does, or has not even begun, and the end of a VTK file is missing.
bool is_cut_short(const fs::path &file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = in.tellg();
  constexpr std::streamoff tail = 64; // blanks and line ends may follow the end
  in.seekg(0);
  const int first = in.peek();
  in.clear();
  in.seekg(std::max<std::streamoff>(0, size - tail));
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return (size == 0 || first == '<') && text.find("</VTKFile>") == std::string::npos;
}

vtkSmartPointer<vtkPolyData> read_poly_data(const fs::path &file) {
  std::error_code code;
  if (!fs::is_regular_file(file, code)) fail(file, "is not a file");
  if (is_cut_short(file))
    throw CutShort(fmt::format("{}: is cut short: its end </VTKFile> is missing", file.string()));
  const Complaints complaints;
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  if (const std::string fault = complaints.first(); !fault.empty() || reader->GetErrorCode() != 0)
    fail(file, fmt::format("is no whole VTK file of points and lines (VTK: {})",
                           fault.empty() ? "no reason given" : fault));
  return reader->GetOutput();
}

/// One quantity of a dump: finite numbers of so many components for each row.
class Column {
public:
  Column(std::vector<double> values, std::size_t components)
      : values_(std::move(values)), components_(components) {}

  double number(std::size_t row) const { return values_[row * components_]; }
  long whole(std::size_t row) const { return std::lround(number(row)); }
  Vector vector(std::size_t row) const {
    const double *first = &values_[row * components_];
    return {first[0], first[1], first[2]};
  }

private:
  std::vector<double> values_;
  std::size_t components_;
};

/// A dump of balls, or of contacts as text, whichever engine wrote it.
class Dump {
public:
  explicit Dump(const fs::path &file) : file_(file) {
    if (file.extension() == ".dump") {
      text_ = read_text_dump(file);
      rows_ = text_.rows.size();
      return;
    }
    vtk_ = read_poly_data(file);
    rows_ = static_cast<std::size_t>(vtk_->GetNumberOfPoints());
  }

  std::size_t rows() const { return rows_; }

  /// \param name of the array in VTK's files \param in_text the names of its components in a text dump
  Column column(const char *name, const std::vector<std::string> &in_text) const {
    std::vector<double> values;
    values.reserve(rows_ * in_text.size());
    if (vtk_ != nullptr)
      from_vtk(name, in_text.size(), values);
    else
      from_text(in_text, values);
    for (const double value : values)
      if (!std::isfinite(value))
        fail(file_, fmt::format("array '{}' holds {}, expected finite numbers", name, value));
    return {values, in_text.size()};
  }

  /// Of the balls.
  Column positions() const {
    if (vtk_ == nullptr) return column("position", {"x", "y", "z"});
    std::vector<double> values(3 * rows_);
    for (std::size_t row = 0; row < rows_; ++row) {
      vtk_->GetPoint(static_cast<vtkIdType>(row), &values[3 * row]);
      for (std::size_t a = 0; a < 3; ++a)
        if (!std::isfinite(values[3 * row + a]))
          fail(file_, fmt::format("a ball is at {}", values[3 * row + a]));
    }
    return {values, 3};
  }

private:
  void from_vtk(const char *name, std::size_t components, std::vector<double> &values) const {
    vtkDataArray *array = vtk_->GetPointData()->GetArray(name);
    if (array == nullptr || array->GetNumberOfComponents() != static_cast<int>(components) ||
        array->GetNumberOfTuples() != static_cast<vtkIdType>(rows_))
      fail(file_, fmt::format("array '{}' with {} rows of {} numbers is missing; expected a dump as "
                              "inputs/bed/dumps makes it",
                              name, rows_, components));
    for (std::size_t row = 0; row < rows_; ++row)
      for (std::size_t c = 0; c < components; ++c)
        values.push_back(array->GetComponent(static_cast<vtkIdType>(row), static_cast<int>(c)));
  }

  void from_text(const std::vector<std::string> &names, std::vector<double> &values) const {
    std::vector<std::size_t> places;
    for (const std::string &name : names) {
      const auto found = std::find(text_.names.begin(), text_.names.end(), name);
      if (found == text_.names.end())
        fail(file_,
             fmt::format("column '{}' is missing; expected a dump as inputs/bed/dumps makes it", name));
      places.push_back(static_cast<std::size_t>(found - text_.names.begin()));
    }
    for (const std::vector<double> &row : text_.rows)
      for (const std::size_t place : places)
        values.push_back(row[place]);
  }

  fs::path file_;
  std::size_t rows_ = 0;
  TextDump text_;
  vtkSmartPointer<vtkPolyData> vtk_; // nullptr: a text dump
};

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
  const Complaints complaints;
  vtkNew<Writer> writer;
  writer->SetInputData(data);
  // Appended data, VTK's default, is not read by the ParaView of Debian 12 with today's libexpat.
  writer->SetDataModeToBinary();
  // Into memory first: on a full disk VTK's own writing to a file ends in a crash.
  writer->WriteToOutputStringOn();
  if (writer->Write() != 1 || !complaints.first().empty())
    fail(file, fmt::format("cannot be written (VTK: {})", complaints.first()));
  write_files({{file, writer->GetOutputString()}});
}

} // namespace

std::map<long, StepDump> dumped_steps(const fs::path &dumps) {
  static const std::regex pattern(R"(balls_(\d{1,18})\.(vtp|dump))");
  std::map<long, StepDump> steps;
  std::error_code code;
  for (const fs::directory_entry &entry : fs::directory_iterator(dumps, code)) {
    const std::string name = entry.path().filename().string();
    std::smatch match;
    if (!std::regex_match(name, match, pattern)) continue;
    const fs::path contacts = dumps / fmt::format("contacts_{}.dump", match[1].str());
    steps[std::stol(match[1])] = {entry.path(), fs::exists(contacts) ? contacts : fs::path()};
  }
  return steps;
}

std::vector<Ball> read_ball_dump(const fs::path &file) {
  const Dump dump(file);
  if (dump.rows() == 0) fail(file, "holds no balls");
  const Column id = dump.column("id", {"id"}), type = dump.column("type", {"type"}),
               radius = dump.column("radius", {"radius"}), mass = dump.column("mass", {"mass"}),
               velocity = dump.column("v", {"vx", "vy", "vz"}),
               spin = dump.column("omega", {"omegax", "omegay", "omegaz"}),
               force = dump.column("f", {"fx", "fy", "fz"}), position = dump.positions();
  std::vector<Ball> balls(dump.rows());
  std::size_t row = 0;
  for (Ball &ball : balls) {
    ball = {id.whole(row),        static_cast<int>(type.whole(row)),
            radius.number(row),   mass.number(row),
            position.vector(row), velocity.vector(row),
            spin.vector(row),     force.vector(row)};
    if (!(ball.radius > 0.0))
      fail(file, fmt::format("the radius of ball {} is {}, expected > 0", ball.id, ball.radius));
    ++row;
  }
  std::sort(balls.begin(), balls.end(), [](const Ball &a, const Ball &b) { return a.id < b.id; });
  const auto twice = std::adjacent_find(balls.begin(), balls.end(),
                                        [](const Ball &a, const Ball &b) { return a.id == b.id; });
  if (twice != balls.end()) fail(file, fmt::format("there are two balls with the id {}", twice->id));
  return balls;
}

BedContacts read_contact_dump(const fs::path &file, const std::vector<Ball> &balls) {
  const Dump dump(file);
  BedContacts contacts;
  if (dump.rows() == 0) return contacts;
  const auto name = [](int number) { return fmt::format("f_contacts[{}]", number); };
  const Column id1 = dump.column("id1", {name(1)}), id2 = dump.column("id2", {name(2)}),
               force = dump.column("force", {name(3), name(4), name(5)}),
               normal = dump.column("normal", {name(6), name(7), name(8)}),
               overlap = dump.column("overlap", {name(9)});
  std::unordered_map<long, std::size_t> places;
  for (std::size_t place = 0; place < balls.size(); ++place)
    places[balls[place].id] = place;
  const auto place_of = [&](long id) {
    const auto found = places.find(id);
    if (found == places.end())
      fail(file, fmt::format("a contact of ball {}, which the dump of the balls does not have", id));
    return found->second;
  };
  for (std::size_t row = 0; row < dump.rows(); ++row) {
    const std::size_t i = place_of(id1.whole(row));
    if (id2.whole(row) == 0) {
      contacts.walls.push_back({i, force.vector(row), normal.vector(row), overlap.number(row)});
      continue;
    }
    BallContact contact{i, place_of(id2.whole(row)), normal.vector(row), force.vector(row),
                        overlap.number(row)};
    if (contact.i > contact.j) { // a ball of the other rank came first
      std::swap(contact.i, contact.j);
      for (Vector *vector : {&contact.branch, &contact.force})
        for (double &component : *vector)
          component = 0.0 - component; // no -0
    }
    const double distance = balls[contact.i].radius + balls[contact.j].radius - contact.overlap;
    for (double &component : contact.branch)
      component *= distance;
    contacts.balls.push_back(contact);
  }
  const auto order = [](const BallContact &a, const BallContact &b) {
    return std::tie(a.i, a.j) < std::tie(b.i, b.j);
  };
  std::sort(contacts.balls.begin(), contacts.balls.end(), order);
  const auto twice =
      std::adjacent_find(contacts.balls.begin(), contacts.balls.end(),
                         [&order](const BallContact &a, const BallContact &b) { return !order(a, b); });
  if (twice != contacts.balls.end())
    fail(file, fmt::format("the contact of balls {} and {} is there twice", balls[twice->i].id,
                           balls[twice->j].id));
  std::sort(contacts.walls.begin(), contacts.walls.end(), [](const WallContact &a, const WallContact &b) {
    return std::tie(a.i, a.normal) < std::tie(b.i, b.normal);
  });
  return contacts;
}

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
