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
  int balls = 2500;          ///< of the complete bed, in a study whose beds are scaled
  int jobs = 1;              ///< runs at the same time, in a study that does not time them against each other
};

/// A study as `drumlin study NAME` offers it.
struct Study {
  const char *name;
  const char *summary; ///< for the help
  void (*run)(const StudyOptions &);
  bool parallel = false; ///< its runs may share the machine
  bool scaled = false;   ///< its beds may have another number of balls
};

/// Throws UsageError for a folder that the engine would split at a space.
void check_engine_path(const std::filesystem::path &out);

/// The build of the plugin and the decks, on which results of runs depend: a line for the settings of a ResumedFolder.
std::string build_line();

/// Makes the folder of a study, or opens that of an earlier call, to continue it. Throws UsageError if its points are from another
/// build of the plugin, other decks, or another choice of `quick` or `balls`, unless the options say `fresh`, which removes them.
ResumedFolder open_study(const StudyOptions &options);

/// The note below a table of means and changes over seeds, as written in pages: MEAN ± HALF WIDTH, * for a significant
/// change. \param compared what a change compares, in words
std::string seed_by_seed_note(const std::string &compared);

} // namespace drumlin::post
