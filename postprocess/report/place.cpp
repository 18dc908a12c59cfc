#include "report/place.h"

#include <stdexcept>

#include <fmt/format.h>

#include "support/files.h"
#include "support/usage_error.h"

namespace drumlin::post {

namespace fs = std::filesystem;

fs::path checked_place(const fs::path &out, const ReportFolders &folders) {
  fs::path place = fs::absolute(out).lexically_normal();
  if (!place.has_filename()) place = place.parent_path();
  const auto refuse = [&out](const std::string &why) {
    throw UsageError(
        fmt::format("--out is '{}': {}; allowed: a new folder or an earlier report", out.string(), why));
  };
  if (fs::exists(place)) {
    if (!fs::is_directory(place)) refuse("is not a folder");
    if (!fs::is_empty(place) && !fs::is_regular_file(place / summary_file)) refuse("holds other files");
    const std::string inside = fs::canonical(place).string() + "/";
    for (const fs::path &folder : folders.all()) {
      if ((fs::canonical(folder).string() + "/").rfind(inside, 0) == 0)
        refuse("holds the folder " + folder.string() + " that is to be reported on");
      for (const fs::directory_entry &entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && fs::canonical(entry.path()).string().rfind(inside, 0) == 0)
          refuse("holds the file " + entry.path().string() + " that is to be reported on");
    }
  }
  try {
    make_output_folder(place.parent_path());
  } catch (const std::runtime_error &error) {
    throw UsageError(fmt::format("--out is '{}': {}", out.string(), error.what()));
  }
  return place;
}

} // namespace drumlin::post
