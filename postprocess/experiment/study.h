// The parts that all studies share: options, and the folder of their results.
#pragma once

#include "support/resumed.h"

#include <filesystem>
#include <string>

namespace drumlin::post {

/// Options of all studies.
struct StudyOptions {
  std::filesystem::path out; ///< folder of its results, made if missing
  bool fresh = false;        ///< discard the results of an earlier call
  bool quick = false;        ///< few points, to test that the study works; the results are not meaningful
};

/// A study as `drumlin study NAME` offers it that is no plan.
struct Study {
  const char *name;
  const char *summary; ///< for the help
  void (*run)(const StudyOptions &);
};

/// Throws UsageError for a folder that the engine would split at a space.
void check_engine_path(const std::filesystem::path &out);

/// The build of the plugin and the decks, on which results of runs depend: a line for the settings of a
/// ResumedFolder.
std::string build_line();

/// Makes the folder of a study, or opens that of an earlier call, to continue it. Throws UsageError if its
/// points are from another build of the plugin, other decks, or other settings, unless the options say
/// `fresh`, which removes them. \param settings further lines with what the results depend on
ResumedFolder open_study(const StudyOptions &options, const std::string &settings = "");

} // namespace drumlin::post
