#include "studies/study.h"

#include "support/files.h"
#include "support/usage_error.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr const char *record_name = "study.txt";

/// FNV-1a, 64 bits: tells builds apart, no more.
std::uint64_t fingerprint(const std::string &bytes) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char byte : bytes)
    hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211u;
  return hash;
}

std::string record(const StudyOptions &options) {
  fs::path plugin = plugin_library();
  std::uint64_t hash = 0;
  for (const fs::directory_entry &entry : fs::directory_iterator(plugin.parent_path()))
    if (entry.path().extension() == ".so") hash ^= fingerprint(read_text(entry.path()));
  return fmt::format("drumlin {} plugin {:016x}{}\n", DRUMLIN_VERSION, hash, options.quick ? " quick" : "");
}

std::vector<std::string> split(const std::string &line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');)
    cells.push_back(cell);
  if (!line.empty() && line.back() == ',') cells.emplace_back();
  return cells;
}

/// Whether a cell holds what C prints for a number that is none.
bool is_nan(const std::string &cell) {
  char *end = nullptr;
  return !cell.empty() && std::isnan(std::strtod(cell.c_str(), &end)) && *end == '\0';
}

std::string joined(const std::vector<std::string> &cells) {
  return fmt::format("{}\n", fmt::join(cells, ","));
}

} // namespace

void check_engine_path(const fs::path &out) {
  if (fs::absolute(out).string().find(' ') != std::string::npos)
    throw UsageError(fmt::format(
        "--out is '{}'; allowed: a path without spaces, at which the engine would split it", out.string()));
}

void open_study(const StudyOptions &options) {
  const fs::path file = options.out / record_name;
  const std::string now = record(options);
  if (fs::exists(file)) {
    if (options.fresh) { // what is in it, not the folder: it may be a symbolic link
      for (const fs::directory_entry &entry : fs::directory_iterator(options.out))
        fs::remove_all(entry.path());
    } else if (read_text(file) != now)
      throw UsageError(fmt::format("the points in '{}' are of another build or of another choice of --quick; "
                                   "allowed: --fresh, which forgets them, or another --out",
                                   options.out.string()));
  } else if (fs::exists(options.out) && !fs::is_empty(options.out)) {
    throw UsageError(fmt::format("--out is '{}', which holds files but no study; allowed: a folder that is "
                                 "new, empty or of an earlier call",
                                 options.out.string()));
  }
  try {
    make_output_folder(options.out);
  } catch (const std::runtime_error &fault) {
    throw UsageError(fmt::format("--out is '{}': {}", options.out.string(), fault.what()));
  }
  write_files({{file, now}});
}

StudyResults::StudyResults(fs::path file, Row columns, std::size_t keys)
    : file_(std::move(file)), columns_(std::move(columns)), keys_(keys) {
  if (!fs::exists(file_)) {
    write_files({{file_, joined(columns_)}});
    return;
  }
  const std::string text = read_text(file_);
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  if (split(line) != columns_)
    throw UsageError(
        fmt::format("{} has other columns than this version writes; allowed: --fresh", file_.string()));
  std::string whole = joined(columns_);
  while (std::getline(in, line)) {
    Row row = split(line);
    if (in.eof() || row.size() != columns_.size()) continue; // without its line end it was cut short
    if (std::any_of(row.begin(), row.end(), is_nan)) continue;
    whole += line + '\n';
    places_[Row(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(keys_))] = rows_.size();
    rows_.push_back(std::move(row));
  }
  if (whole != text) write_files({{file_, whole}});
}

const StudyResults::Row *StudyResults::find(const Row &key) const {
  const auto place = places_.find(key);
  return place == places_.end() ? nullptr : &rows_[place->second];
}

void StudyResults::add(const Row &row) {
  if (row.size() != columns_.size())
    throw std::logic_error("a row of another length than the header of " + file_.string());
  append_text(file_, joined(row));
  places_[Row(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(keys_))] = rows_.size();
  rows_.push_back(row);
}

std::size_t StudyResults::column(const std::string &name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  if (found == columns_.end()) throw std::logic_error("no column " + name + " in " + file_.string());
  return static_cast<std::size_t>(found - columns_.begin());
}

double StudyResults::number(const Row &row, const std::string &name) const {
  const std::string &cell = text(row, name);
  char *end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  if (*end != '\0')
    throw UsageError(fmt::format("{}: {} is '{}'; allowed: a number, or --fresh, which measures again",
                                 file_.string(), name, cell));
  return value;
}

void StudyProgress::found() { ++found_; }

void StudyProgress::measured(const std::string &what) {
  ++measured_;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  const std::size_t done = found_ + measured_;
  const double left =
      seconds / static_cast<double>(measured_) * static_cast<double>(total_ - std::min(done, total_));
  fmt::print("[{:{}}/{}] {}, about {:.0f} s left\n", done, fmt::formatted_size("{}", total_), total_, what,
             left);
  std::fflush(stdout);
}

} // namespace drumlin::post
