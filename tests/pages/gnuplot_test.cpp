// Names of run folders reach gnuplot scripts: they must stay text there.
#include "pages/gnuplot.h"

#include "pages/figure_data.h"
#include "support/files.h"
#include "support/process.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"
#include "tests/support/page.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace drumlin::post;
using namespace drumlin::test;
namespace fs = std::filesystem;

TEST(Script, KeepsHostileNamesAsText) {
  Figure figure;
  figure.name = "f";
  figure.title = "t";
  Panel panel;
  panel.x_label = "x (m)";
  panel.y_label = "y (m)";
  panel.x_ticks = {"a\"; system(\"touch /tmp/x\") #", "b\\", "`date`"};
  figure.panels = {panel};
  const std::string script = gnuplot_script(figure);
  EXPECT_TRUE(contains(script, {"\\\"; system(\\\"touch", "\"b\\\\\""}));
  EXPECT_EQ(script.find('`'), std::string::npos); // gnuplot runs what is between backquotes
}

/// What gnuplot draws of names along an axis, as the texts of the SVG.
TEST(Script, DrawsHostileNamesAsTheyAre) {
  const Scratch scratch;
  const fs::path folder = scratch / "100% {}";
  fs::create_directories(folder);
  std::ofstream(folder / "it's.csv") << "curve,x,y\n\"it's\",1,2\n\"it's\",2,3\n";
  Figure figure;
  figure.name = "f";
  figure.title = "100% {t}";
  Panel panel;
  panel.title = "%s {a}_b^c @d";
  panel.x_label = "x (m)";
  panel.y_label = "y (m)";
  panel.x_ticks = {
      "100%", "%s%n", "{}", "a_b^c", "a\"b", "it's", "a\\nb", "x y", "c\x01", "\xff", std::string(300, 'w')};
  panel.curves = {{"it's.csv", of_curve("it's", "$2"), "3", "%d_{}", CurveStyle::plain}};
  figure.panels = {panel, panel};
  render(find_gnuplot(), folder, figure);
  const std::string svg = read_text(folder / "f.svg");
  EXPECT_TRUE(contains(svg, {"100%", "%s%n", "{}", "a_b^c", "a\"b", "it's", "a\\nb", "x y", ">c<",
                             "%s {a}_b^c @d", "%d_{}", "100% {t}"}));
  EXPECT_TRUE(drumlin::test::parse(svg).well_formed);
  EXPECT_FALSE(fs::exists(folder / program_output_file));
}

// On a full disk gnuplot leaves a part of a picture and ends with 0.
TEST(Picture, ThatIsCutShortIsAnError) {
  const Scratch scratch;
  const fs::path &folder = scratch.path();
  std::ofstream(folder / "f.csv") << "x,y\n1,2\n2,3\n";
  Figure figure;
  figure.name = "f";
  figure.panels = {Panel()};
  figure.panels[0].curves = {{"f.csv", "1", "2", "", CurveStyle::plain}};
  for (const char *cut : {"f.svg", "f.png"}) {
    const fs::path half = folder / "half-gnuplot";
    std::ofstream(half) << fmt::format("#!/bin/sh\n'{}' \"$@\" && truncate -s -9 {}\n",
                                       find_gnuplot().string(), cut);
    fs::permissions(half, fs::perms::owner_all);
    EXPECT_NO_THROW(render(find_gnuplot(), folder, figure));
    EXPECT_TRUE(is_whole_picture(folder / cut));
    EXPECT_EQ(error_of([&] { render(half, folder, figure); }),
              (folder / cut).string() + " is cut short; allowed: a disk with room for what gnuplot draws");
    EXPECT_FALSE(is_whole_picture(folder / cut));
  }
}

// Records of zeros or constants have such figures: gnuplot takes a panel without points for an error.
TEST(Pictures, AreDrawnOfConstantsAndWithoutPoints) {
  const fs::path folder = fs::path(::testing::TempDir()) / "constants";
  fs::create_directories(folder);
  write_files({{folder / "f.csv", "x,missing,zero,constant\n1,,0,3\n1,,0,3\n1,,0,3\n"}});
  const auto panel = [](const std::string &x, const std::string &y, bool log) {
    Panel one;
    one.curves = {{"f.csv", x, y, "a curve", CurveStyle::plain}};
    one.log_y = log;
    one.tight_x = true;
    return one;
  };
  Figure figure;
  figure.name = "f";
  figure.columns = 3;
  figure.panels = {panel("1", "2", false), panel("1", "3", true),  panel("2", "1", false),
                   panel("1", "3", false), panel("1", "4", false), panel("1", "4", true)};
  figure.panels[3].y_range = "[0:*]";
  figure.panels[4].x_range = "[0:*]";
  render(find_gnuplot(), folder, figure);
  for (const char *picture : {"f.svg", "f.png"})
    EXPECT_TRUE(is_whole_picture(folder / picture)) << picture;
  const std::string script = read_text(folder / "f.gp"), note = "no values to draw";
  std::size_t notes = 0;
  for (std::size_t at = script.find(note); at != std::string::npos; at = script.find(note, at + 1))
    ++notes;
  EXPECT_EQ(notes, 3U) << script;
  // Other errors of gnuplot stay errors.
  figure.panels[0].curves[0].data = "no such file.csv";
  EXPECT_THROW(render(find_gnuplot(), folder, figure), std::runtime_error);
  fs::remove_all(folder);
}

TEST(Script, HasNoRangeWithoutExtent) {
  EXPECT_EQ(axis_range(-1.0, 2.5), "[-1:2.5]");
  EXPECT_EQ(axis_range(1.0, 1.0), "");
  EXPECT_EQ(axis_range(1.0, 1.0 + 1e-9), "");
  EXPECT_EQ(axis_range(1.0, 0.0), "");
  EXPECT_EQ(axis_range(0.0, std::numeric_limits<double>::infinity()), "");
  EXPECT_EQ(axis_range(std::nan(""), 1.0), "");
}

TEST(Script, DrawsPicturesToScaleAndOnlyAsPixels) {
  Figure figure;
  figure.name = "f";
  figure.only_png = true;
  Panel picture;
  picture.equal_scales = true;
  picture.color_label = "speed (m/s)";
  picture.curves = {{"f.csv", "1", "2:3:4", "", CurveStyle::discs},
                    {"f.csv", "1", "2:5:6", "", CurveStyle::segments}};
  picture.curves.back().width = 2.5;
  figure.panels = {picture, Panel()};
  const std::string script = gnuplot_script(figure);
  EXPECT_TRUE(contains(script, {"[kind in \"png\"]", "with vectors nohead lw 2.5"}));
  // What the picture sets does not reach the next panel.
  const std::size_t set = script.find("set size ratio -1");
  ASSERT_NE(set, std::string::npos);
  EXPECT_LT(set, script.find("set size noratio"));
  EXPECT_LT(script.find("set colorbox"), script.find("unset colorbox"));
  figure.only_png = false;
  EXPECT_TRUE(contains(gnuplot_script(figure), "[kind in \"svg png\"]"));
}

TEST(Size, OfPanelsInRows) {
  Figure figure;
  figure.panels.resize(3);
  figure.columns = 2;
  const int row = 430;
  const int title = 40;
  EXPECT_EQ(figure_height(figure), 2 * row + title);
  // All figures are of one width.
  const int width = figure_width(figure);
  for (const int columns : {1, 3}) {
    figure.columns = columns;
    EXPECT_EQ(figure_width(figure), width);
  }
  EXPECT_EQ(figure_height(figure), row + title);
  figure.panels.resize(1);
  EXPECT_EQ(figure_height(figure), row);
  figure.half = true;
  EXPECT_EQ(2 * figure_width(figure), width);
  figure.panels[0].equal_scales = true;
  EXPECT_EQ(figure_height(figure), row);
  figure.half = false;
  EXPECT_GT(figure_height(figure), row);
}

// Names too long for one line below the axes would be written across the axis label.
TEST(Legend, HasTheRowsThatItsNamesNeed) {
  Figure figure;
  figure.name = "f";
  Panel panel;
  for (const char *name : {"A DEM", "B DEM", "A reference", "B reference"})
    panel.curves.push_back({"f.csv", "1", "2", name, CurveStyle::plain});
  figure.panels = {panel};
  EXPECT_TRUE(contains(gnuplot_script(figure), "set key maxrows 1 "));
  figure.half = true;
  EXPECT_TRUE(contains(gnuplot_script(figure), "set key maxrows 2 "));
  for (Curve &curve : figure.panels[0].curves)
    curve.title.clear();
  EXPECT_TRUE(contains(gnuplot_script(figure), "set key maxrows 1 "));
}

/// Heights, px from the top, at which a text stands in an SVG file of gnuplot's.
std::vector<double> heights_of(const std::string &svg, const std::string &text) {
  std::vector<double> heights;
  for (const char *end : {"</tspan>", "</text>"}) {
    const std::string whole = ">" + text + end;
    for (std::size_t at = svg.find(whole); at != std::string::npos; at = svg.find(whole, at + 1))
      heights.push_back(std::stod(svg.substr(svg.find(',', svg.rfind("translate(", at)) + 1)));
  }
  return heights;
}

// gnuplot thinks that letters are wider in SVG files than they are.
TEST(Legend, IsBelowTheAxisLabelInSvgFiles) {
  const Scratch scratch;
  const fs::path &folder = scratch.path();
  write_files({{folder / "f.csv", "x,y\n0,-1e6\n1,2e6\n"}});
  for (const int columns : {1, 2, 3})
    for (const char *longest : {"A", "dissipated", "work of the exciter", "the energy of the drum alone"}) {
      Figure figure;
      figure.name = "f";
      figure.title = "title";
      figure.columns = columns;
      Panel panel;
      panel.x_label = "below axes";
      for (const char *name : {longest, "dissipated", "potential", "error"})
        panel.curves.push_back({"f.csv", "1", "2", name, CurveStyle::plain});
      figure.panels.assign(static_cast<std::size_t>(columns), panel);
      render(find_gnuplot(), folder, figure);
      const std::string svg = read_text(folder / "f.svg");
      const std::vector<double> labels = heights_of(svg, "below axes");
      ASSERT_EQ(labels.size(), figure.panels.size());
      for (const char *name : {longest, "potential", "error"})
        for (const double height : heights_of(svg, name)) {
          EXPECT_GT(height, labels.front() + 15.0) << columns << " columns, " << longest << ": " << name;
          EXPECT_LT(height, figure_height(figure)) << columns << " columns, " << longest << ": " << name;
        }
      EXPECT_EQ(heights_of(svg, "error").size(), figure.panels.size());
    }
}

} // namespace
