// For tests that write pages or call commands of drumlin, each in a folder of its own.
#pragma once

#include "tests/support/engine_runs.h"

namespace drumlin::test {

/// While an object of this class lives, commands find a program in place of gnuplot that writes valid but
/// empty pictures. Drawing takes most of the time of a command that writes a page.
class SketchedPictures {
public:
  SketchedPictures() {
    std::ofstream(folder_ / "gnuplot") << R"sh(#!/bin/sh
name=${2%.gp}
printf '<?xml version="1.0"?><svg></svg>' >"$name.svg"
printf '\211PNG\r\n\032\n\000\000\000\000IEND\256B`\202' >"$name.png"
if grep -q 'terminal gif' "$2"; then printf 'GIF8;' >"$name.gif"; fi
)sh";
    std::filesystem::permissions(folder_ / "gnuplot", std::filesystem::perms::owner_all);
    const char *usual = std::getenv("PATH");
    usual_ = usual == nullptr ? "/usr/bin:/bin" : usual;
    ::setenv("PATH", (folder_.path().string() + ":" + usual_).c_str(), 1);
  }
  ~SketchedPictures() { ::setenv("PATH", usual_.c_str(), 1); }
  SketchedPictures(const SketchedPictures &) = delete;
  SketchedPictures &operator=(const SketchedPictures &) = delete;

private:
  const Scratch folder_;
  std::string usual_;
};

/// Cases that judge pictures, one or more for each page, call draw() first.
class WithSketches : public ::testing::Test {
protected:
  /// From here on gnuplot draws.
  void draw() { sketched_.reset(); }

private:
  std::optional<SketchedPictures> sketched_{std::in_place};
};

class Tool : public WithSketches {
protected:
  /// Calls drumlin with words of which the first is the command.
  Outcome drumlin(std::vector<std::string> words) const {
    words.insert(words.begin(), DRUMLIN_TOOLS);
    return run_program(words, {}, folder_, 120.0);
  }
  /// Calls one command.
  Outcome drumlin(const std::string &command, std::vector<std::string> words) const {
    words.insert(words.begin(), command);
    return drumlin(std::move(words));
  }

  const Scratch scratch_;
  const std::filesystem::path folder_ = scratch_.path();
};

} // namespace drumlin::test
