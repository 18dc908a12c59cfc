// Reports of made-up runs of element tests.
#pragma once

#include "report/report.h"
#include "support/files.h"
#include "support/usage_error.h"
#include "tests/support/checks.h"
#include "tests/support/page.h"
#include "tests/support/tool.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace drumlin::test {

/// A folder for the runs, and the report of them.
class ElementReport : public WithSketches {
protected:
  /// Writes a run. \param parameters lines "name,value" \param ended their last row
  void write_run(const std::string &folder, const std::string &csv, const std::string &text,
                 const std::string &parameters, const std::string &ended = "ended,yes\n") const {
    std::filesystem::create_directories(root / folder);
    post::write_files({{root / folder / csv, text},
                       {root / folder / "parameters.csv", "name,value\n" + parameters + ended}});
  }

  /// Writes the report of a folder in `root` and returns the text of its first page.
  std::string report(const std::string &folder) const {
    post::ReportOptions options;
    options.folders = {root / folder};
    options.out = root / "report";
    return post::read_text(post::write_report(options).page);
  }

  /// The text of the page of a kind of test, after a report that must link to it.
  std::string sound_page(const std::string &folder, const std::string &kind, std::size_t images) const {
    EXPECT_TRUE(contains(report(folder), kind + "/index.html"));
    expect_sound_page(root / "report" / kind, images);
    return post::read_text(root / "report" / kind / "index.html");
  }

  /// The data behind a table of the page of a kind of test.
  std::string data(const std::string &kind, const std::string &table) const {
    return post::read_text(root / "report" / kind / "data" / (table + ".csv"));
  }

  /// Expects that a run whose file has this text is refused, with `says` and the name of the file in the
  /// message.
  void expect_refused(const std::string &csv, const std::string &text, const std::string &says) const {
    write_run("refused", csv, text, "");
    EXPECT_TRUE(contains(error_of<post::UsageError>([&] { report("refused"); }), {says, csv}));
    EXPECT_FALSE(std::filesystem::exists(root / "report"));
  }

private:
  Scratch scratch;

protected:
  const std::filesystem::path root = scratch.path();
};

} // namespace drumlin::test
