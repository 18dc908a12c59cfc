// Names of run folders reach gnuplot scripts: they must stay text there.
#include "gnuplot.h"

#include <gtest/gtest.h>

namespace {

using namespace drumlin::post;

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
  EXPECT_NE(script.find("\\\"; system(\\\"touch"), std::string::npos);
  EXPECT_NE(script.find("\"b\\\\\""), std::string::npos);
  EXPECT_EQ(script.find('`'), std::string::npos); // gnuplot runs what stands between backquotes
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
  EXPECT_NE(script.find("[kind in \"png\"]"), std::string::npos);
  EXPECT_NE(script.find("with vectors nohead lw 2.5"), std::string::npos);
  // What the picture sets does not reach the next panel.
  const std::size_t set = script.find("set size ratio -1");
  ASSERT_NE(set, std::string::npos);
  EXPECT_LT(set, script.find("set size noratio"));
  EXPECT_LT(script.find("set colorbox"), script.find("unset colorbox"));
  figure.only_png = false;
  EXPECT_NE(gnuplot_script(figure).find("[kind in \"svg png\"]"), std::string::npos);
}

TEST(Size, OfPanelsInRows) {
  Figure figure;
  figure.panels.resize(3);
  figure.columns = 2;
  figure.panel_width = 100;
  figure.panel_height = 50;
  EXPECT_EQ(figure_width(figure), 200);
  EXPECT_EQ(figure_height(figure), 140);
}

} // namespace
