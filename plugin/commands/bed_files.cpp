#include "commands/bed_files.h"

#include "commands/deck_variables.h"
#include "support/arguments.h"
#include "support/whole_file.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <sys/mman.h>
#include <unistd.h>
#include <unordered_set>

namespace drumlin {

namespace {

// In a restart file the notes follow the part that the engine reads:
//   drumlin restart notes
//   NAME VALUE
//   ...
//     end COUNT        number of bytes at the end of the engine's part by which the engine recognizes a
//     complete file
//   bytes COUNT      number of bytes of the engine's part
//   crc32 SUM        its checksum
// and then a copy of those last bytes, since the engine looks for them at the end of the file. In a data file
// each note is a comment of the header, which engines skip:
//   # drumlin note NAME VALUE
constexpr const char *data_note = "# drumlin note ";
constexpr const char *notes_begin = "\ndrumlin restart notes\n";

std::string notes_text(const RestartNotes &notes) {
  std::string text = notes_begin;
  for (const auto &[name, value] : notes)
    text += fmt::format("{} {}\n", name, value);
  return text;
}

/// The checksum CRC-32 of gzip and PNG. Written out, since the plugin is built with fmt as its only library.
std::uint32_t crc32(const std::string &bytes) {
  std::array<std::uint32_t, 256> of_byte{};
  for (std::uint32_t n = 0; n < of_byte.size(); ++n) {
    of_byte[n] = n;
    for (int bit = 0; bit < 8; ++bit)
      of_byte[n] = (of_byte[n] >> 1) ^ ((of_byte[n] & 1U) != 0 ? 0xedb88320U : 0U);
  }
  std::uint32_t sum = ~0U;
  for (const char c : bytes)
    sum = (sum >> 8) ^ of_byte[(sum ^ static_cast<unsigned char>(c)) & 0xffU];
  return ~sum;
}

/// The last two notes: number and checksum of these bytes.
RestartNotes checksum_notes(const std::string &bytes) {
  return {{"bytes", std::to_string(bytes.size())}, {"crc32", fmt::format("{:08x}", crc32(bytes))}};
}

std::string contents_of(const std::string &file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Notes of a restart file that is complete; none of any other file.
RestartNotes notes_of_restart(const std::string &file) {
  const std::string all = contents_of(file);
  const std::size_t begin = all.rfind(notes_begin);
  if (begin == std::string::npos) return {};
  std::istringstream lines(all.substr(begin + std::string(notes_begin).size()));
  RestartNotes notes;
  std::size_t end_mark = 0;
  for (std::string name, value; name != "crc32" && lines >> name >> value;) {
    notes.emplace_back(name, value);
    if (name == "end") end_mark = std::strtoul(value.c_str(), nullptr, 10);
  }
  if (lines.get() != '\n') return {};
  const std::string end{std::istreambuf_iterator<char>(lines), {}};
  if (end.size() != end_mark || begin < end_mark || all.compare(begin - end_mark, end_mark, end) != 0)
    return {};
  const RestartNotes last = checksum_notes(all.substr(0, begin));
  if (notes.size() < last.size() || !std::equal(last.rbegin(), last.rend(), notes.rbegin())) return {};
  return notes;
}

/// Notes in the header of a data file.
RestartNotes notes_of_data_file(const std::string &file) {
  std::ifstream in(file);
  RestartNotes notes;
  const std::string mark = data_note;
  std::string line;
  std::getline(in, line); // the title
  while (std::getline(in, line) && line.rfind("Atoms", 0) != 0) {
    if (line.rfind(mark, 0) != 0) continue;
    const std::vector<std::string> words = words_of(line.substr(mark.size()));
    if (words.size() > 1) notes.emplace_back(words[0], words[1]);
  }
  return notes;
}

/// The notes with the name of this engine as the first: engines do not read each other's restart files.
RestartNotes with_engine(const RestartNotes &notes) {
  const std::string engine = engine::name_and_version();
  RestartNotes all = {{"engine", engine.substr(0, engine.find(' '))}};
  all.insert(all.end(), notes.begin(), notes.end());
  return all;
}

} // namespace

RestartNotes read_notes(LAMMPS_NS::LAMMPS *lmp, Arguments &in) {
  RestartNotes notes;
  std::string word;
  while (!in.empty()) {
    word = in.word("a note's name");
    if (word == "values_of" || word == "groups" || word == "chosen") break;
    notes.emplace_back(word, in.word("the value of note " + word));
  }
  const DeckVariables variables(lmp);
  const auto add = [&](const std::string &name) {
    const std::string value = variables.value(name).value_or("");
    if (value.empty() || value.find_first_of(" \n") != std::string::npos)
      in.fail("keyword values_of is '" + name + "'; allowed: the names of variables that are one word");
    notes.emplace_back(name, value);
  };
  for (std::string keyword = word; !in.empty();) {
    word = in.word("a variable's name");
    if (word == "groups" || word == "chosen" || word == "values_of") {
      keyword = word;
      continue;
    }
    if (keyword == "values_of") {
      add(word);
      continue;
    }
    bool known = false;
    for (const DeclaredVariable &variable : variables.declared()) {
      if (variable.group != word) continue;
      known = true;
      if (keyword == "groups" || variable.chosen) add(variable.name);
    }
    if (!known) in.fail("keyword " + keyword, word, "a group of variables of drumlin/variable");
  }
  return notes;
}

bool is_restart_name(const std::string &file) {
  return file.find_first_of("*%") == std::string::npos && is_output_file(file);
}

void check_restart_name(LAMMPS_NS::LAMMPS *lmp, const std::string &file, const std::string &what) {
  int bad = lmp->comm->me == 0 && !is_restart_name(file) ? 1 : 0;
  MPI_Bcast(&bad, 1, MPI_INT, 0, lmp->world);
  if (bad != 0)
    lmp->error->all(FLERR, engine::error_text(fmt::format("{} is '{}', which cannot be written; allowed: {}",
                                                          what, file, restart_name_allowed)));
}

namespace {

/// A file in memory that the engine can open by its name.
class MemoryFile {
public:
  MemoryFile() : file_(memfd_create("drumlin", MFD_CLOEXEC)) {}
  ~MemoryFile() {
    if (file_ >= 0) close(file_);
  }
  MemoryFile(const MemoryFile &) = delete;
  MemoryFile &operator=(const MemoryFile &) = delete;
  std::string name() const { return fmt::format("/proc/self/fd/{}", file_); }

private:
  int file_;
};

/// Lets the engine write a file to memory, completes it on rank 0 and writes it to the disk. The engine
/// itself does not check whether its writes succeed, which they do not on a full disk.
/// \param engine_command write_restart or write_data
/// \param what command and keyword that gave the name, for the error
/// \param complete function from the bytes of the engine's file to those to be written; nothing if the
/// engine's file is incomplete
template <class Complete>
void write_checked(LAMMPS_NS::LAMMPS *lmp, const std::string &engine_command, const std::string &file,
                   const std::string &what, Complete &&complete) {
  check_restart_name(lmp, file, what);
  const MemoryFile memory;
  lmp->input->one((engine_command + " " + memory.name()).c_str());
  int failed = 0;
  if (lmp->comm->me == 0) {
    const std::optional<std::string> contents = complete(contents_of(memory.name()));
    failed = contents && write_whole_file(file, *contents) ? 0 : 1;
  }
  MPI_Bcast(&failed, 1, MPI_INT, 0, lmp->world);
  if (failed != 0)
    engine::stop(lmp, fmt::format("{} is '{}', which cannot be written; allowed: a file on a disk with room",
                                  what, file));
}

} // namespace

void write_noted_restart(LAMMPS_NS::LAMMPS *lmp, const std::string &file, const RestartNotes &notes,
                         const std::string &what) {
  write_checked(lmp, "write_restart", file, what,
                [&notes](const std::string &bytes) -> std::optional<std::string> {
                  if (bytes.empty()) return {};
                  const std::string end = bytes.substr(bytes.size() - engine::restart_end_mark);
                  RestartNotes all = with_engine(notes);
                  all.emplace_back("end", std::to_string(engine::restart_end_mark));
                  for (const auto &note : checksum_notes(bytes))
                    all.push_back(note);
                  return bytes + notes_text(all) + end;
                });
}

void write_noted_data(LAMMPS_NS::LAMMPS *lmp, const std::string &file, const RestartNotes &notes,
                      const std::string &what) {
  write_checked(lmp, "write_data", file, what, [&notes](std::string text) -> std::optional<std::string> {
    std::string header;
    for (const auto &[name, value] : notes)
      header += fmt::format("{}{} {}\n", data_note, name, value);
    const std::size_t title_end = text.find('\n');
    if (title_end == std::string::npos) return {};
    return text.insert(title_end + 1, header);
  });
}

bool can_be_read(const std::string &file) {
  std::error_code failed;
  return std::filesystem::is_regular_file(file, failed) && access(file.c_str(), R_OK) == 0;
}

RestartNotes notes_of(const std::string &file) {
  const RestartNotes notes = notes_of_restart(file);
  return notes.empty() ? notes_of_data_file(file) : notes;
}

std::string scene_file(const std::string &file) {
  std::error_code failed;
  const std::string data = file + ".data";
  return engine::reads_data_beside && std::filesystem::exists(data, failed) ? data : file;
}

bool is_text(const std::string &file) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, 256> begin{};
  in.read(begin.data(), begin.size());
  return std::find(begin.begin(), begin.begin() + in.gcount(), '\0') == begin.begin() + in.gcount();
}

std::string restart_fault(const std::string &file, const RestartNotes &notes) {
  const RestartNotes found = notes_of_restart(file);
  if (found.empty())
    return fmt::format(", which is incomplete, damaged or no restart file; allowed: a restart file of "
                       "drumlin/write or drumlin/run{}",
                       engine::reads_data_beside ? ", or a data file NAME.data in the same folder" : "");
  for (const auto &[name, value] : with_engine(notes)) {
    const auto same_name = [&name = name](const auto &note) { return note.first == name; };
    const auto note = std::find_if(found.begin(), found.end(), same_name);
    const std::string was = note == found.end() ? "nothing" : note->second;
    if (was != value)
      return fmt::format(", made with {} {}; allowed: made with {} {}", name, was, name, value);
  }
  return "";
}

namespace {

/// The bounds of the box of a data file along one axis, m.
struct Bounds {
  double low = 0.0, high = 0.0;
  /// Whether a ball may be at a coordinate, m: in the box, or at most one length of the box outside, from
  /// where the engine moves it into the box if the boundary is periodic.
  bool near(double x) const { return x >= 2.0 * low - high && x <= 2.0 * high - low; }
};

/// Reads a data file up to its first fault, if it has one, and describes that fault for an error text.
class DataFile {
public:
  explicit DataFile(const std::string &file) : in_(file) {}

  std::string fault() {
    std::getline(in_, line_); // the title
    while (next_line()) {
      const std::string word = words_.front();
      if (const std::string why = word == "Atoms"        ? atoms()
                                  : word == "Velocities" ? velocities()
                                                         : header();
          !why.empty())
        return "; allowed: " + why;
    }
    return has_atoms_ ? "" : "; allowed: a data file with atoms";
  }

private:
  /// Reads the next line that is neither empty nor a comment into words_; false at the end of the file.
  bool next_line() {
    while (std::getline(in_, line_)) {
      words_ = words_of(line_.substr(0, line_.find('#')));
      if (!words_.empty()) return true;
    }
    return false;
  }

  std::string header() {
    if (words_.size() == 2 && words_[1] == "atoms") count_ = parse_number(words_[0]);
    if (words_.size() == 3 && words_[1] == "atom" && words_[2] == "types") types_ = parse_number(words_[0]);
    const char *const axes[3][2] = {{"xlo", "xhi"}, {"ylo", "yhi"}, {"zlo", "zhi"}};
    for (std::size_t a = 0; a < 3; ++a)
      if (words_.size() == 4 && words_[2] == axes[a][0] && words_[3] == axes[a][1]) {
        box_[a] = {parse_number(words_[0]), parse_number(words_[1])};
        if (!(box_[a].high > box_[a].low) || box_[a].high - box_[a].low > largest_box)
          return fmt::format("a box with bounds in order, at most {:.0e} m apart, not with '{}'", largest_box,
                             line_);
        return "";
      }
    constexpr std::array<const char *, 3> known = {"atoms", "types",
                                                   "space"}; // of the header, last in a line
    const bool is_known = std::find(known.begin(), known.end(), words_.back()) != known.end() &&
                          std::isfinite(parse_number(words_.front()));
    if (!has_atoms_ && !is_known)
      return fmt::format("a data file with a box, atoms and their types, not with '{}'", shown());
    if (has_atoms_)
      return fmt::format("one data file, which ends behind its sections, not with '{}'", shown());
    return "";
  }

  std::string atoms() {
    if (has_atoms_) return "a data file with one section Atoms, not two";
    has_atoms_ = true;
    if (!(count_ >= 1.0)) return "a data file with atoms";
    return section("Atoms", [this](const std::vector<double> &row) { // id type diameter density x y z
      if (row.size() < 7 || !(row[2] > 0.0) || !(row[3] > 0.0)) return false;
      if (row[1] != std::floor(row[1]) || row[1] < 1.0 || row[1] > types_) return false;
      for (std::size_t a = 0; a < 3; ++a)
        if (!box_[a].near(row[4 + a])) return false;
      return ids_.insert(row[0]).second;
    });
  }

  std::string velocities() {
    std::unordered_set<double> seen;
    return section("Velocities", [this, &seen](const std::vector<double> &row) { // id vx vy vz
      return row.size() >= 4 && ids_.count(row[0]) > 0 && seen.insert(row[0]).second;
    });
  }

  /// Reads a row of numbers for each atom. The last line must have a line end: without it the file may be
  /// incomplete.
  /// \param good whether the numbers of a row, the first of which is the ID, are allowed
  template <class Good>
  std::string section(const char *name, Good &&good) {
    double rows = 0.0;
    std::vector<double> numbers;
    for (; rows < count_ && next_line(); rows += 1.0) {
      numbers.clear();
      for (const std::string &word : words_)
        numbers.push_back(parse_number(word));
      const bool finite =
          std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
      if (!finite || numbers[0] != std::floor(numbers[0]) || numbers[0] < 1.0 || numbers[0] > largest_id ||
          in_.eof() || !good(numbers))
        break;
    }
    if (rows == count_) return "";
    return fmt::format("a complete data file of balls in their box, each ID once; this one has {:.0f} of "
                       "{:.0f} good rows under {}, then '{}'",
                       rows, count_, name, shown());
  }

  /// The beginning of the present line, for an error.
  std::string shown() const {
    std::string text = line_.substr(0, 60);
    for (char &c : text)
      if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = ' ';
    return text;
  }

  static constexpr double largest_id = 2147483647.0;
  static constexpr double largest_box = 1e6; // m
  std::ifstream in_;
  std::string line_;
  std::vector<std::string> words_;
  double count_ = 0.0;
  double types_ = 0.0;
  bool has_atoms_ = false;
  std::array<Bounds, 3> box_;
  std::unordered_set<double> ids_;
};

} // namespace

std::string data_file_fault(const std::string &file) { return DataFile(file).fault(); }

} // namespace drumlin
