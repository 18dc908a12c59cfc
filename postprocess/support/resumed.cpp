#include "support/resumed.h"

#include "support/units.h"
#include "support/usage_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr const char *again = "or --fresh, which measures again";

/// Whether a name is that of a file that write_files() had not finished when it was killed.
bool is_unfinished(const fs::path &file) {
  static const std::regex name(".*\\.tmp\\.[0-9]+\\.[0-9]+");
  return std::regex_match(file.filename().string(), name);
}

/// Whether no other files than such and parts of the results are in a folder.
bool has_no_others(const fs::path &folder) {
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(),
                     [](const fs::directory_entry &entry) {
                       return is_unfinished(entry.path()) || entry.path().filename() == parts_name;
                     });
}

/// The first line of each of two texts in which they differ; empty where one has no further line.
std::pair<std::string, std::string> first_difference(const std::string &one, const std::string &other) {
  std::istringstream first(one), second(other);
  std::string a, b;
  do {
    if (!std::getline(first, a)) a.clear();
    if (!std::getline(second, b)) b.clear();
  } while (a == b && (first || second));
  return {a, b};
}

/// Whether a cell is the text that a program prints for NaN.
bool is_nan(const std::string &cell) {
  const std::optional<double> number = any_number_from_text(cell);
  return number && std::isnan(*number);
}

} // namespace

ResumedFolder::ResumedFolder(const fs::path &out, const std::string &kind, const std::string &settings,
                             bool fresh) {
  try {
    make_output_folder(out);
  } catch (const std::runtime_error &fault) {
    throw UsageError(fmt::format("--out is '{}': {}", out.string(), fault.what()));
  }
  lock_ = lock_output_folder(out);
  const fs::path file = out / settings_name;
  const std::string now = fmt::format("drumlin {} {}\n{}", DRUMLIN_VERSION, kind, settings);
  const bool earlier = fs::exists(file);
  if (!earlier && !has_no_others(out))
    throw UsageError(refusal(
        "--out", out.string(),
        fmt::format("a folder that is new, empty or of an earlier {}: this one has other files", kind)));
  if (const std::string before = earlier && !fresh ? read_text(file) : now; before != now) {
    const auto [was, is] = first_difference(before, now);
    throw UsageError(
        refusal("--out", out.string(),
                fmt::format("the folder of a {} with the same settings and the same build (its {} has '{}', "
                            "this call '{}'), --fresh, which forgets its results, or another folder",
                            kind, settings_name, shown(was), shown(is))));
  }
  std::vector<fs::path> removed;
  if (fresh) { // the content, not the folder itself, which may be a symbolic link; the settings last, in case
               // of a kill
    for (const fs::directory_entry &entry : fs::directory_iterator(out))
      if (entry.path() != file) removed.push_back(entry.path());
  } else {
    for (const fs::directory_entry &entry : fs::recursive_directory_iterator(out))
      if (is_unfinished(entry.path())) removed.push_back(entry.path());
  }
  for (const fs::path &path : removed)
    fs::remove_all(path);
  if (!earlier || fresh) write_files({{file, now}});
}

Table finished_rows(const fs::path &file) {
  if (read_text(file).find('\n') == std::string::npos) return {file, {}, {}, {}};
  const Table table = read_table(file, CutRows::last);
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> lines;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (std::any_of(table.row(i).begin(), table.row(i).end(), is_nan)) continue;
    rows.push_back(table.row(i));
    lines.push_back(table.line(i));
  }
  return {file, table.header(), std::move(rows), std::move(lines)};
}

namespace {

[[noreturn]] void refuse_row(const Table &table, std::size_t row, std::size_t keys, const char *allowed) {
  const auto first = [keys](const std::vector<std::string> &cells) {
    return fmt::format("{}",
                       fmt::join(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(keys), ","));
  };
  csv_refusal(table.file(), table.line(row), first(table.header()), first(table.row(row)),
              fmt::format("{}, {}", allowed, again));
}

} // namespace

void refuse_double(const Table &table, std::size_t row, std::size_t keys) {
  refuse_row(table, row, keys, "each once");
}

ResumedTable::ResumedTable(fs::path file, Row columns, std::size_t keys)
    : file_(std::move(file)), columns_(std::move(columns)), keys_(keys) {
  const std::string header = csv_line(columns_);
  const std::string text = fs::exists(file_) ? read_text(file_) : "";
  if (text.size() < header.size() &&
      header.compare(0, text.size(), text) == 0) { // an interruption cut the header
    write_files({{file_, header}});
    return;
  }
  const Table table = finished_rows(file_);
  if (table.header() != columns_)
    throw UsageError(
        refusal(fmt::format("the header of {}", file_.string()),
                table.header().empty() ? text : fmt::format("{}", fmt::join(table.header(), ",")),
                fmt::format("{}, {}", fmt::join(columns_, ","), again)));
  std::string whole = header;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const Row &row = table.row(i);
    whole += csv_line(row);
    bool &finished = places_[{row.begin(), row.begin() + static_cast<std::ptrdiff_t>(keys_)}].finished;
    if (finished) refuse_double(table, i, keys_);
    finished = true;
  }
  if (whole != text) write_files({{file_, whole}});
}

bool ResumedTable::has(const Row &key) {
  Place &place = places_[key];
  if (place.asked == 0) place.asked = ++asked_;
  return place.finished;
}

void ResumedTable::add(const std::vector<Row> &rows) {
  std::string text;
  for (const Row &row : rows) {
    if (row.size() != columns_.size())
      throw std::logic_error("a row of another length than the header of " + file_.string());
    text += csv_line(row);
  }
  append_text(file_, text);
  for (const Row &row : rows)
    places_[{row.begin(), row.begin() + static_cast<std::ptrdiff_t>(keys_)}].finished = true;
}

void ResumedTable::finish() {
  const Table table = finished_rows(file_);
  std::vector<std::pair<std::size_t, std::size_t>> order; // place and row
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const Row &row = table.row(i);
    const auto found = places_.find({row.begin(), row.begin() + static_cast<std::ptrdiff_t>(keys_)});
    if (found == places_.end() || found->second.asked == 0) refuse_row(table, i, keys_, "a row of this call");
    order.emplace_back(found->second.asked, i);
  }
  if (std::is_sorted(order.begin(), order.end())) return;
  std::sort(order.begin(), order.end());
  std::string text = csv_line(columns_);
  for (const auto &[place, row] : order)
    text += csv_line(table.row(row));
  write_files({{file_, text}});
}

std::string fingerprint(std::string_view text) {
  std::uint64_t value = 14695981039346656037U; // FNV-1a
  for (const char letter : text)
    value = (value ^ static_cast<unsigned char>(letter)) * 1099511628211U;
  return fmt::format("{:016x}", value);
}

} // namespace drumlin::post
