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
