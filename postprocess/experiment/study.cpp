#include "experiment/study.h"

#include "engine/deck_run.h"
#include "engine/places.h"
#include "support/files.h"
#include "support/usage_error.h"

#include <fmt/format.h>

#include <set>
#include <string>
#include <system_error>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Whether a file of inputs can change the results of a study: a deck or what decks include, but not a case
/// of a bed that a user has added.
bool is_deck(const fs::path &file) {
  static const std::set<std::string> others = {".csv", ".md", ".png", ".svg"},
                                     cases = {"case.base", "case.two_layers", "case.gravel", "case.loose"};
  const std::string name = file.filename().string();
  const bool of_bed = file.parent_path().filename() == "bed" && name.rfind("case.", 0) == 0;
  return others.count(file.extension().string()) == 0 && (!of_bed || cases.count(name) > 0);
}

} // namespace

void check_engine_path(const fs::path &out) {
  if (fs::absolute(out).string().find(' ') != std::string::npos)
    throw UsageError(fmt::format(
        "--out is '{}'; allowed: a path without spaces, at which the engine would split it", out.string()));
}

std::string build_line() {
  std::set<fs::path> files;
  std::error_code none; // where the plugin is not built
  for (const fs::directory_entry &entry :
       fs::directory_iterator(fs::path(plugin_library()).parent_path(), none))
    if (entry.path().extension() == ".so") files.insert(entry.path());
  for (const char *room : {"bed", "benchmarks", "chain", "soil", "study"})
    for (const fs::directory_entry &entry : fs::directory_iterator(places().inputs / room))
      if (entry.is_regular_file() && is_deck(entry.path())) files.insert(entry.path());
  std::string made_of;
  for (const fs::path &file : files)
    made_of += file.filename().string() + fingerprint(read_text(file));
  return fmt::format("plugin and decks {}\n", fingerprint(made_of));
}

ResumedFolder open_study(const StudyOptions &options, const std::string &settings) {
  return {options.out, "study", build_line() + (options.quick ? "quick\n" : "") + settings, options.fresh};
}

} // namespace drumlin::post
