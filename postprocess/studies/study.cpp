#include "studies/study.h"

#include "engine/engine_run.h"
#include "support/files.h"
#include "support/range.h"
#include "support/usage_error.h"

#include <algorithm>
#include <boost/crc.hpp>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr const char *record_name = "study.txt";

/// Identifies the build of the plugin: the version, and a checksum over its libraries in order of their
/// names.
std::string record(const StudyOptions &options) {
  std::set<fs::path> libraries;
  for (const fs::directory_entry &entry : fs::directory_iterator(fs::path(plugin_library()).parent_path()))
    if (entry.path().extension() == ".so") libraries.insert(entry.path());
  boost::crc_32_type checksum;
  for (const fs::path &library : libraries) {
    const std::string bytes = read_text(library);
    checksum.process_bytes(bytes.data(), bytes.size());
  }
  return fmt::format("drumlin {} plugin {:08x}{}{}\n", DRUMLIN_VERSION, checksum.checksum(),
                     options.quick ? " quick" : "",
                     options.balls == StudyOptions().balls ? "" : fmt::format(" {} balls", options.balls));
}

/// Whether a cell is the text that a program prints for NaN.
bool is_nan(const std::string &cell) {
  const std::optional<double> number = any_number_from_text(cell);
  return number && std::isnan(*number);
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
    if (options.fresh) { // its content, not the folder itself, which may be a symbolic link
      for (const fs::directory_entry &entry : fs::directory_iterator(options.out))
        fs::remove_all(entry.path());
    } else if (read_text(file) != now)
      throw UsageError(
          fmt::format("--out is '{}', whose points are of another build or of another choice of "
                      "--quick or --balls; allowed: --fresh, which forgets them, or another folder",
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

Table finished_rows(const fs::path &file) {
  const Table table = read_table(file, CutRows::forget);
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> lines;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (std::any_of(table.row(i).begin(), table.row(i).end(), is_nan)) continue;
    rows.push_back(table.row(i));
    lines.push_back(table.line(i));
  }
  return {file, table.header(), std::move(rows), std::move(lines)};
}

StudyResults::StudyResults(fs::path file, Row columns, std::size_t keys)
    : file_(std::move(file)), columns_(std::move(columns)), keys_(keys) {
  if (!fs::exists(file_)) {
    write_files({{file_, csv_line(columns_)}});
    return;
  }
  const Table table = finished_rows(file_);
  if (table.header() != columns_)
    throw UsageError(refusal(fmt::format("the header of {}", file_.string()),
                             fmt::format("{}", fmt::join(table.header(), ",")),
                             fmt::format("{}, or --fresh, which measures again", fmt::join(columns_, ","))));
  std::string whole = csv_line(columns_);
  for (std::size_t i = 0; i < table.rows(); ++i) {
    whole += csv_line(table.row(i));
    finished_.insert(key_of(table.row(i)));
  }
  if (whole != read_text(file_)) write_files({{file_, whole}});
}

void StudyResults::add(const Row &row) {
  if (row.size() != columns_.size())
    throw std::logic_error("a row of another length than the header of " + file_.string());
  append_text(file_, csv_line(row));
  finished_.insert(key_of(row));
}

std::string seed_by_seed_note(const std::string &compared) {
  return fmt::format(
      "After the ±: half of the 95 % confidence interval over the seeds (Student's t); {}. * marks "
      "changes whose interval does not contain zero. By chance alone, one of twenty changes has it.",
      compared);
}

} // namespace drumlin::post
