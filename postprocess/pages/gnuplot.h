// Figures by gnuplot, which is run as a process: writes a script and makes SVG and PNG files from it.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Styles of a curve. Each has a dash or a marker of its own as well as a colour of its own (palette of Okabe
/// and Ito), so that curves can be told apart in a black and white print.
enum class CurveStyle {
  condition_a, ///< dashed line, vermilion
  condition_b, ///< solid line, blue
  direct_a,    ///< open circles, black: reference solution under A
  direct_b,    ///< open triangles, black: reference solution under B
  direct_line, ///< thin dotted black line
  measured_a,  ///< filled circles, vermilion
  measured_b,  ///< filled squares, blue
  plain,       ///< solid line, black
  spread,   ///< bars from low to high with a square at the middle, blue; y names three columns, e.g. "3:4:5"
  limit,    ///< thin dash-dotted line, grey: a tolerance or a bound
  series_1, ///< series_1 to series_6: lines with markers, each with a dash, a marker and a colour of its own
  series_2,
  series_3,
  series_4,
  series_5,
  series_6,
  line_1, ///< line_1 to line_5: lines, each with a dash and a colour of its own
  line_2,
  line_3,
  line_4,
  line_5,
  discs,   ///< filled circles, radius in units of the axes; y names ordinate, radius and colour: "4:5:6"
  discs_1, ///< discs_1 to discs_4: the same with a thicker edge in a colour of its own
  discs_2,
  discs_3,
  discs_4,
  circles, ///< the same as outlines, black; y names ordinate and radius
  cells,   ///< rectangles coloured by value; y: ordinate, left, right, bottom, top, value, as "2:3:4:5:6:7"
  area_1,  ///< area_1 to area_9: rectangles as `cells`, without value, of a colour and a hatch or grey each
  area_2,
  area_3,
  area_4,
  area_5,
  area_6,
  area_7,
  area_8,
  area_9,
  dots_up,     ///< small filled circles, blue
  dots_down,   ///< small open circles, vermilion
  mark_1,      ///< small filled circles, black: points of a boundary
  mark_2,      ///< small open squares, black
  run_differs, ///< thick crosses, purple
  band,        ///< a pale area between two values, blue; y names both, "4:5"
  segments,    ///< black line segments of Curve::width; y names ordinate and the extents along both axes
};

/// One curve of a panel, read from a CSV file with one header line.
struct Curve {
  std::string data;  ///< data file, relative to the script's folder
  std::string x;     ///< gnuplot expression or column number, e.g. "1" or "(column(1)*1e3)"
  std::string y;     ///< the same for the ordinate
  std::string title; ///< legend text; empty: not in the legend
  CurveStyle style = CurveStyle::plain;
  int every = 1;      ///< markers only: use every n-th row
  int offset = 0;     ///< first row used
  double width = 1.0; ///< of segments, pt
};

/// One set of axes.
struct Panel {
  std::string title;
  std::string x_label; ///< with unit
  std::string y_label; ///< with unit
  std::vector<Curve> curves;
  bool log_y = false;
  bool tight_x = false;     ///< the axis ends where the data end, as a time axis does
  std::string x_range = {}; ///< as gnuplot writes it, e.g. "[-0.1:*]"; empty: the range of the data
  std::vector<std::string> x_ticks = {}; ///< names at x = 1, 2, ... instead of numbers
  bool log_x = false;
  std::string y_range = {};     ///< as x_range
  bool equal_scales = false;    ///< a picture: a metre is as long on the vertical as on the horizontal axis
  std::string color_label = {}; ///< of the colour box of discs, with unit; empty: no colour box
  std::string color_range = {}; ///< as x_range
  bool color_whole = false;     ///< one colour per whole number
  bool whole_x = false, whole_y = false; ///< numbers at whole steps only, as of passes
  bool plain_numbers = false; ///< a logarithmic axis x has 1, 2, 5, 10, ... instead of powers of ten
  bool plain_y = false;       ///< and so has a logarithmic axis y

  /// Adds a curve with another text in the legend than its own; empty: not in the legend.
  void add(Curve curve, std::string legend) {
    curve.title = std::move(legend);
    curves.push_back(std::move(curve));
  }
};

/// A figure: panels in rows of `columns`. All figures have one width, rows of panels one height, and the
/// legend is below each panel, outside of the axes.
struct Figure {
  std::string name;  ///< file stem of script, SVG and PNG
  std::string title; ///< printed above the panels when there is more than one
  std::vector<Panel> panels;
  int columns = 1;   ///< 1 to 3
  bool half = false; ///< half as wide as the others, and as high as a row of graphs: two stand side by side
  bool only_png = false; ///< no SVG, which would take many MB with thousands of circles
  /// An animation in place of a graph: the titles of its pictures, one of its only panel for each; curves
  /// take rows of the picture `frame`, counted from 1. Written are a GIF and a PNG of the middle picture.
  std::vector<std::string> frames = {};
  int height = 0; ///< px; 0: the usual one
};

/// "[low:high]" with six digits, for Panel::x_range and similar; empty, which stands for the range of the
/// data, unless low < high and both are finite.
std::string axis_range(double low, double high);

/// Size of the whole figure in CSS pixels.
int figure_width(const Figure &figure);
int figure_height(const Figure &figure);

/// Full path of the gnuplot program. Throws std::runtime_error naming the Debian package if there is none.
std::filesystem::path find_gnuplot();

/// How the file ends that a page shows: ".svg", ".png" or ".gif".
const char *shown_ending(const Figure &figure);

/// The gnuplot script of a figure. Run in a folder, it writes NAME.png and the file that a page shows there.
std::string gnuplot_script(const Figure &figure);

/// Whether a PNG, GIF or SVG file has the beginning and the end of its format. gnuplot ends with status 0
/// even if the disk is full and the picture is cut short.
bool is_whole_picture(const std::filesystem::path &file);

/// Writes folder/NAME.gp and runs it in that folder. Axes without any value to draw get a note. Throws
/// std::runtime_error with gnuplot's message if gnuplot fails, or if a picture is cut short.
void render(const std::filesystem::path &gnuplot, const std::filesystem::path &folder, const Figure &figure);

} // namespace drumlin::post
