#include "fixes/bed_files.h"

#include "fixes/arguments.h"
#include "fixes/output_file.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <sstream>
#include <zlib.h>

namespace drumlin {

namespace fs = std::filesystem;

namespace {

// The notes stand behind what the engine reads, which is as many bytes as their last line says:
//   drumlin restart notes
//   NAME VALUE
//   ...
//   end COUNT of bytes, by which the engine knows that a file is whole
//   bytes COUNT
//   crc32 SUM of these bytes
// and those of the end again.
constexpr const char *notes_begin = "\ndrumlin restart notes\n";
constexpr std::streamoff longest_notes = 4096;

std::string notes_text(const RestartNotes &notes) {
  std::string text = notes_begin;
  for (const auto &[name, value] : notes)
    text += fmt::format("{} {}\n", name, value);
  return text;
}

/// What the last two notes say of the first so many bytes of a file.
RestartNotes sum_notes(const std::string &file, std::uintmax_t bytes) {
  std::ifstream in(file, std::ios::binary);
  std::vector<char> buffer(std::size_t{1} << 20);
  uLong sum = crc32(0, nullptr, 0);
  for (std::uintmax_t left = bytes; left > 0 && in;) {
    in.read(buffer.data(), static_cast<std::streamsize>(std::min<std::uintmax_t>(left, buffer.size())));
    const auto count = static_cast<uInt>(in.gcount());
    sum = crc32(sum, reinterpret_cast<const Bytef *>(buffer.data()), count);
    left -= count;
  }
  return {{"bytes", std::to_string(bytes)}, {"crc32", fmt::format("{:08x}", sum)}};
}

std::string last_bytes(const std::string &file, std::streamoff count) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(-count, std::ios::end);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Notes of a whole file; none of another.
RestartNotes notes_of(const std::string &file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) return {};
  const std::streamoff size = in.tellg();
  const std::streamoff from = std::max<std::streamoff>(0, size - longest_notes);
  in.seekg(from);
  const std::string tail{std::istreambuf_iterator<char>(in), {}};
  const std::size_t begin = tail.rfind(notes_begin);
  if (begin == std::string::npos) return {};
  std::istringstream lines(tail.substr(begin + std::string(notes_begin).size()));
  RestartNotes notes;
  std::size_t end_mark = 0;
  for (std::string name, value; name != "crc32" && lines >> name >> value;) {
    notes.emplace_back(name, value);
    if (name == "end") end_mark = std::strtoul(value.c_str(), nullptr, 10);
  }
  if (lines.get() != '\n') return {};
  const std::string end{std::istreambuf_iterator<char>(lines), {}};
  if (end.size() != end_mark || begin < end_mark || tail.compare(begin - end_mark, end_mark, end) != 0)
    return {};
  const RestartNotes last = sum_notes(file, static_cast<std::uintmax_t>(from) + begin);
  if (notes.size() < last.size() || !std::equal(last.rbegin(), last.rend(), notes.rbegin())) return {};
  return notes;
}

/// Engines do not read each other's restart files.
RestartNotes with_engine(const RestartNotes &notes) {
  const std::string engine = engine::name_and_version();
  RestartNotes all = {{"engine", engine.substr(0, engine.find(' '))}};
  all.insert(all.end(), notes.begin(), notes.end());
  return all;
}

/// Whether a line is at least so many numbers and nothing else.
bool is_numbers(const std::string &line, std::size_t least) {
  std::istringstream words(line);
  std::size_t count = 0;
  for (std::string word; words >> word; ++count)
    if (!std::isfinite(parse_number(word))) return false;
  return count >= least;
}

} // namespace

RestartNotes read_notes(Arguments &in) {
  RestartNotes notes;
  while (!in.empty()) {
    const std::string name = in.word("a note's name");
    notes.emplace_back(name, in.word("the value of note " + name));
  }
  return notes;
}

bool is_restart_name(const std::string &file) {
  return file.find_first_of("*%") == std::string::npos && OutputFile::writable(file);
}

void check_restart_name(LAMMPS_NS::LAMMPS *lmp, const std::string &file, const std::string &command) {
  int bad = lmp->comm->me == 0 && !is_restart_name(file) ? 1 : 0;
  MPI_Bcast(&bad, 1, MPI_INT, 0, lmp->world);
  if (bad != 0)
    lmp->error->all(
        FLERR,
        fmt::format("{}: cannot write '{}'; allowed: {}", command, file, restart_name_allowed).c_str());
}

void write_noted_restart(LAMMPS_NS::LAMMPS *lmp, const std::string &file, const RestartNotes &notes,
                         const std::string &command) {
  check_restart_name(lmp, file, command);
  const std::string unfinished = file + ".unfinished";
  lmp->input->one(("write_restart " + unfinished).c_str());
  int failed = 0;
  if (lmp->comm->me == 0) {
    std::error_code code;
    const std::uintmax_t bytes = fs::file_size(unfinished, code);
    if (!code) {
      const std::string end = last_bytes(unfinished, engine::restart_end_mark);
      std::ofstream out(unfinished, std::ios::binary | std::ios::app);
      RestartNotes all = with_engine(notes);
      all.emplace_back("end", std::to_string(engine::restart_end_mark));
      for (const auto &note : sum_notes(unfinished, bytes))
        all.push_back(note);
      out << notes_text(all) << end << std::flush;
      failed = !out;
    }
    if (!code) fs::rename(unfinished, file, code);
    failed = failed != 0 || code;
  }
  MPI_Bcast(&failed, 1, MPI_INT, 0, lmp->world);
  if (failed != 0)
    lmp->error->all(
        FLERR,
        fmt::format("{}: cannot write '{}'; allowed: a file on a disk with room", command, file).c_str());
}

std::string restart_fault(const std::string &file, const RestartNotes &notes) {
  const RestartNotes found = notes_of(file);
  if (found.empty())
    return fmt::format("; allowed: a whole restart file of drumlin/write_restart or drumlin/run{}, and this "
                       "one is cut short, damaged or none",
                       engine::beside_restart);
  for (const auto &[name, value] : with_engine(notes)) {
    const auto same_name = [&name = name](const auto &note) { return note.first == name; };
    const auto note = std::find_if(found.begin(), found.end(), same_name);
    const std::string was = note == found.end() ? "nothing" : note->second;
    if (was != value)
      return fmt::format(", made with {} {}; allowed: made with {} {}", name, was, name, value);
  }
  return "";
}

std::string data_file_fault(const std::string &file) {
  constexpr std::size_t least_numbers[] = {7, 4}; // id type diameter density x y z; id vx vy vz
  const std::string sections[] = {"Atoms", "Velocities"};
  std::ifstream in(file);
  std::string line;
  std::getline(in, line); // the title
  double atoms = 0.0;
  bool found = false;
  std::vector<std::string> words;
  while (std::getline(in, line)) {
    std::istringstream text(line);
    words.assign(std::istream_iterator<std::string>(text), {});
    if (words.size() == 2 && words[1] == "atoms") atoms = parse_number(words[0]);
    if (words.empty()) continue;
    const auto *const section = std::find(std::begin(sections), std::end(sections), words[0]);
    if (section == std::end(sections)) continue;
    found = found || section == std::begin(sections);
    std::getline(in, line); // blank
    double rows = 0.0;
    while (rows < atoms && std::getline(in, line) &&
           is_numbers(line, least_numbers[section - std::begin(sections)]))
      rows += 1.0;
    if (!(rows == atoms) || in.eof())
      return fmt::format("; allowed: a whole data file, and this one has {:.0f} of {:.0f} rows under {}",
                         rows, atoms, *section);
  }
  return found && atoms > 0.0 ? "" : "; allowed: a data file with atoms";
}

} // namespace drumlin
