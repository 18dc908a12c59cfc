// A study in a scratch folder, run as a user runs it.
#pragma once

#include "support/process.h"

#include <filesystem>
#include <string>

namespace drumlin::test {

class ScratchStudy {
public:
  explicit ScratchStudy(std::string name);
  ~ScratchStudy();
  ScratchStudy(const ScratchStudy &) = delete;
  ScratchStudy &operator=(const ScratchStudy &) = delete;

  /// `drumlin study NAME --quick --out out`, from the scratch folder.
  post::Outcome run() const;
  std::filesystem::path out() const { return folder_ / "out"; }

private:
  std::string name_;
  std::filesystem::path folder_;
};

/// The one file of a folder whose name begins and ends as given, with a fingerprint between.
std::filesystem::path made_file(const std::filesystem::path &folder, const std::string &begin,
                                const std::string &end);

/// Removes every second row of a file and cuts the last one short, as if the study had been killed.
void interrupt(const std::filesystem::path &file);

} // namespace drumlin::test
