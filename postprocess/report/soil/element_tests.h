// The element tests of soil that the report has pages for.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace drumlin::post {

/// Writes a page into a folder: index.html, figures and data. Throws std::runtime_error.
using PageWriter = std::function<void(const std::filesystem::path &out)>;

/// A kind of element test.
struct ElementTest {
  std::string name;  ///< of the folder of its page
  std::string title; ///< of its page
  /// Reads the runs in the given folders, at least one. Throws std::runtime_error for a file that cannot be
  /// read.
  PageWriter (*read)(const std::vector<std::filesystem::path> &folders);

  /// The file by which the folder of a run is recognised.
  std::string csv() const { return name + ".csv"; }
};

/// All kinds, in the order in which the report links their pages.
std::vector<ElementTest> element_tests();

} // namespace drumlin::post
