#include "report/draft.h"

#include <stdexcept>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "support/usage_error.h"

namespace drumlin::post {

namespace fs = std::filesystem;

fs::path checked_place(const fs::path &out, const ReportFolders &folders) {
  fs::path place = fs::absolute(out).lexically_normal();
  if (!place.has_filename()) place = place.parent_path();
  const auto refuse = [&out](const std::string &why) {
    throw UsageError(
        fmt::format("--out = '{}' {}; allowed are new folders and earlier reports", out.string(), why));
  };
  if (fs::exists(place)) {
    if (!fs::is_directory(place)) refuse("is not a folder");
    if (!fs::is_empty(place) && !fs::is_regular_file(place / summary_file)) refuse("holds other files");
    const std::string inside = fs::canonical(place).string() + "/";
    for (const std::vector<fs::path> *all : {&folders.runs, &folders.studies})
      for (const fs::path &folder : *all)
        if ((fs::canonical(folder).string() + "/").rfind(inside, 0) == 0)
          refuse("holds the folder " + folder.string() + " that is to be reported on");
  }
  try {
    make_output_folder(place.parent_path());
  } catch (const std::runtime_error &error) {
    throw UsageError(fmt::format("--out = '{}': {}", out.string(), error.what()));
  }
  return place;
}

Draft::Draft(const fs::path &place) : place_(place), folder_(place.parent_path(), prefix_after_rescue()) {
  fs::create_directories(folder() / "figures");
  fs::create_directories(folder() / "data");
}

void Draft::publish() {
  const fs::path old = place_.parent_path() / own_name(prefix("old"));
  const bool replaces = fs::exists(place_);
  if (replaces) fs::rename(place_, old);
  std::error_code error;
  fs::rename(folder(), place_, error);
  if (error) {
    if (replaces) fs::rename(old, place_);
    throw std::runtime_error(
        fmt::format("cannot move the report to {}: {}", place_.string(), error.message()));
  }
  std::error_code ignored;
  fs::remove_all(old, ignored);
}

std::string Draft::prefix(const char *what) const {
  return fmt::format(".{}.{}-", place_.filename().string(), what);
}

/// A process killed between the two renames of publish() leaves the earlier report under its other name.
std::string Draft::prefix_after_rescue() const {
  const fs::path earlier = leftover(place_.parent_path(), prefix("old"));
  if (!earlier.empty() && !fs::exists(place_)) fs::rename(earlier, place_);
  remove_leftovers(place_.parent_path(), prefix("old"));
  return prefix("new");
}

} // namespace drumlin::post
