#include "bed/dump_readers.h"

#include "bed/vtk_messages.h"
#include "support/csv.h"
#include "support/units.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <sstream>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path &file, const std::string &what) {
  throw std::runtime_error(fmt::format("{}: {}", file.string(), what));
}

bool begins(const std::string &line, const char *words) { return line.rfind(words, 0) == 0; }

/// The numbers of a line. They need not be finite: a run that is unstable dumps infinity.
std::vector<double> numbers_of(const fs::path &file, std::string_view line) {
  constexpr std::string_view blanks = " \t\r";
  std::vector<double> numbers;
  for (std::size_t at = line.find_first_not_of(blanks); at < line.size();) {
    const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
    const std::string_view word = line.substr(at, end - at);
    const std::optional<double> number = any_number_from_text(word);
    if (!number) fail(file, refusal("a number", word, "one in decimal digits"));
    numbers.push_back(*number);
    at = line.find_first_not_of(blanks, end);
  }
  return numbers;
}

/// Reads a text dump step by step.
class TextDumpSteps {
public:
  explicit TextDumpSteps(fs::path file);
  /// Reads the next step; false at the end of the file.
  bool next(TextDump &dump);

private:
  bool read_line();
  /// The number that the next line holds.
  double read_number();
  /// Reads up to the names of the columns; returns the number of rows that the header announces.
  std::size_t read_header(TextDump &dump);
  void read_rows(TextDump &dump, std::size_t announced);
  [[noreturn]] void fail_before_rows() const;

  fs::path file_;
  std::ifstream in_;
  std::string line_;
  bool whole_line_ = false; // line_ ended with a line end
  bool pending_ = false;    // line_ is the first of the next step
};

TextDumpSteps::TextDumpSteps(fs::path file) : file_(std::move(file)), in_(file_) {
  if (!in_) fail(file_, "cannot be read");
  if (!read_line()) fail_before_rows();
  if (!begins(line_, "ITEM: ") && (whole_line_ || !begins("ITEM: ", line_.c_str())))
    fail(file_, "is no text dump of LAMMPS; allowed: one as inputs/bed/dumps.on makes it");
  pending_ = true;
}

void TextDumpSteps::fail_before_rows() const {
  throw CutShort(fmt::format("{}: is cut short: it ends before its rows begin", file_.string()));
}

bool TextDumpSteps::read_line() {
  if (!std::getline(in_, line_)) return false;
  whole_line_ = !in_.eof();
  return true;
}

double TextDumpSteps::read_number() {
  if (!read_line() || !whole_line_) fail_before_rows();
  const std::vector<double> numbers = numbers_of(file_, line_);
  if (numbers.size() != 1) fail(file_, refusal("a line of the header", line_, "one number"));
  return numbers.front();
}

std::size_t TextDumpSteps::read_header(TextDump &dump) {
  std::size_t announced = 0;
  bool has_step = false, has_count = false;
  while (true) {
    if (!pending_ && !read_line()) fail_before_rows();
    pending_ = false;
    if (!whole_line_) fail_before_rows();
    if (begins(line_, "ITEM: TIMESTEP")) {
      if (has_step) break; // the step before has no rows
      dump.step = std::lround(read_number());
      has_step = true;
    } else if (begins(line_, "ITEM: NUMBER OF ")) {
      const double number = read_number();
      if (!(number >= 0.0)) fail(file_, refusal("the number of rows", line_, "0 or more"));
      announced = static_cast<std::size_t>(number);
      has_count = true;
    } else if (begins(line_, "ITEM: ATOMS ") || begins(line_, "ITEM: ENTRIES ")) {
      std::istringstream words(line_);
      std::string word;
      words >> word >> word; // ITEM: ATOMS
      dump.names.assign(std::istream_iterator<std::string>(words), {});
      break;
    } // any other line belongs to the box, the units or the time
  }
  if (!has_step || !has_count || dump.names.empty())
    fail(file_, "is no text dump of LAMMPS; allowed: one as inputs/bed/dumps.on makes it");
  return announced;
}

void TextDumpSteps::read_rows(TextDump &dump, std::size_t announced) {
  while (read_line() && whole_line_) { // without its line end the last row may lack digits
    pending_ = begins(line_, "ITEM: ");
    if (pending_) break;
    dump.rows.push_back(numbers_of(file_, line_));
    if (dump.rows.back().size() != dump.names.size())
      fail(file_, fmt::format("row {} has {} numbers; allowed: {}", dump.rows.size(), dump.rows.back().size(),
                              dump.names.size()));
  }
  if (dump.rows.size() == announced) return;
  if (dump.rows.size() < announced && !pending_)
    throw CutShort(fmt::format("{}: is cut short: it has {} rows; allowed: {}", file_.string(),
                               dump.rows.size(), announced));
  fail(file_, fmt::format("has {} rows; allowed: {}", dump.rows.size(), announced));
}

bool TextDumpSteps::next(TextDump &dump) {
  if (!pending_) return false;
  dump = TextDump();
  dump.file = file_;
  read_rows(dump, read_header(dump));
  return true;
}

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
  const VtkMessages messages;
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  if (const std::string fault = messages.first(); !fault.empty() || reader->GetErrorCode() != 0)
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
        fail(file_, fmt::format("array '{}' holds {}; allowed: finite numbers", name, value));
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
      fail(file_, fmt::format("array '{}' with {} rows of {} numbers is missing; allowed: a dump as "
                              "inputs/bed/dumps.on makes it",
                              name, rows_, components));
    for (std::size_t row = 0; row < rows_; ++row)
      for (std::size_t c = 0; c < components; ++c)
        values.push_back(array->GetComponent(static_cast<vtkIdType>(row), static_cast<int>(c)));
  }

  void from_text(const std::vector<std::string> &names, std::vector<double> &values) const {
    std::vector<std::size_t> columns;
    columns.reserve(names.size());
    for (const std::string &name : names)
      columns.push_back(text_.column(name));
    for (const std::vector<double> &row : text_.rows)
      for (const std::size_t column : columns)
        values.push_back(row[column]);
  }

  fs::path file_;
  std::size_t rows_ = 0;
  TextDump text_;
  vtkSmartPointer<vtkPolyData> vtk_; // nullptr: a text dump
};

} // namespace

std::size_t TextDump::column(const std::string &name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    fail(file,
         fmt::format("column '{}' is missing; it has {}; allowed: a dump as the project's decks make it",
                     name, fmt::join(names, " ")));
  return static_cast<std::size_t>(found - names.begin());
}

std::vector<TextDump> read_text_dumps(const fs::path &file) {
  TextDumpSteps steps(file);
  std::vector<TextDump> dumps(1);
  while (steps.next(dumps.back()))
    dumps.emplace_back();
  dumps.pop_back();
  return dumps;
}

TextDump read_text_dump(const fs::path &file) {
  TextDumpSteps steps(file);
  TextDump dump;
  steps.next(dump);
  if (TextDump more; steps.next(more)) fail(file, "holds more than one step; allowed: one");
  return dump;
}

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
      fail(file, fmt::format("the radius of ball {} is '{}'; allowed: > 0", ball.id, ball.radius));
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

} // namespace drumlin::post
