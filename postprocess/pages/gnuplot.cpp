#include "pages/gnuplot.h"

#include "support/files.h"
#include "support/process.h"
#include "support/text.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// The part of gnuplot's plot command after `using x:y`, for each style in its order.
constexpr std::array<const char *, 43> styles = {{
    "with lines lw 2.4 dt (12,6) lc rgb '#D55E00'",                            // condition_a
    "with lines lw 2.2 dt solid lc rgb '#0072B2'",                             // condition_b
    "with points pt 6 ps 0.75 lw 1.1 lc rgb '#000000'",                        // direct_a
    "with points pt 8 ps 0.75 lw 1.1 lc rgb '#000000'",                        // direct_b
    "with lines lw 1.2 dt (3,7) lc rgb '#000000'",                             // direct_line
    "with points pt 7 ps 1.1 lc rgb '#D55E00'",                                // measured_a
    "with points pt 5 ps 1.1 lc rgb '#0072B2'",                                // measured_b
    "with lines lw 1.6 dt solid lc rgb '#000000'",                             // plain
    "with yerrorbars pt 5 ps 0.9 lw 1.6 lc rgb '#0072B2'",                     // spread
    "with lines lw 1.2 dt (24,8,4,8) lc rgb '#666666'",                        // limit
    "with linespoints lw 2.0 dt solid pt 7 ps 0.7 lc rgb '#0072B2'",           // series_1
    "with linespoints lw 1.6 dt (20,10) pt 6 ps 1.4 lc rgb '#D55E00'",         // series_2
    "with linespoints lw 2.0 dt (4,8) pt 5 ps 0.7 lc rgb '#009E73'",           // series_3
    "with linespoints lw 1.6 dt (24,8,4,8) pt 4 ps 1.4 lc rgb '#CC79A7'",      // series_4
    "with linespoints lw 1.0 dt solid pt 8 ps 1.9 lc rgb '#000000'",           // series_5
    "with linespoints lw 1.6 dt (24,8,4,8,4,8) pt 12 ps 1.4 lc rgb '#E69F00'", // series_6
    "with lines lw 2.2 dt solid lc rgb '#0072B2'",                             // line_1
    "with lines lw 2.2 dt (12,6) lc rgb '#D55E00'",                            // line_2
    "with lines lw 2.0 dt (4,5) lc rgb '#009E73'",                             // line_3
    "with lines lw 2.0 dt (18,5,4,5) lc rgb '#CC79A7'",                        // line_4
    "with lines lw 1.2 dt solid lc rgb '#000000'",                             // line_5
    "with circles lc palette fill solid border lc rgb '#777777'",              // discs
    "with circles lc palette lw 2 fill solid border lc rgb '#737373'",         // discs_1
    "with circles lc palette lw 2 fill solid border lc rgb '#008C66'",         // discs_2
    "with circles lc palette lw 2 fill solid border lc rgb '#B34D99'",         // discs_3
    "with circles lc palette lw 2 fill solid border lc rgb '#40A6E6'",         // discs_4
    "with circles lc rgb '#000000' lw 1.6 fill empty border",                  // circles
    "with boxxyerror lc palette fill solid noborder",                          // cells
    "with boxxyerror lc rgb '#eef6fb' fill solid noborder",                    // area_1
    "with boxxyerror lc rgb '#56B4E9' fill pattern 4 noborder",                // area_2
    "with boxxyerror lc rgb '#F0C75E' fill solid noborder",                    // area_3
    "with boxxyerror lc rgb '#009E73' fill pattern 2 noborder",                // area_4
    "with boxxyerror lc rgb '#8A3B00' fill solid noborder",                    // area_5
    "with boxxyerror lc rgb '#000000' fill pattern 6 noborder",                // area_6
    "with boxxyerror lc rgb '#CC79A7' fill solid noborder",                    // area_7
    "with boxxyerror lc rgb '#0072B2' fill pattern 5 noborder",                // area_8
    "with boxxyerror lc rgb '#bbbbbb' fill solid noborder",                    // area_9
    "with points pt 7 ps 0.22 lc rgb '#0072B2'",                               // dots_up
    "with points pt 6 ps 0.5 lw 0.6 lc rgb '#D55E00'",                         // dots_down
    "with points pt 7 ps 0.4 lc rgb '#000000'",                                // mark_1
    "with points pt 4 ps 0.5 lw 0.9 lc rgb '#000000'",                         // mark_2
    "with points pt 2 ps 1.3 lw 3 lc rgb '#CC79A7'",                           // run_differs
    "with filledcurves lc rgb '#0072B2' fill transparent solid 0.15 noborder", // band
}};

std::string style_words(const Curve &curve) {
  static_assert(styles.size() == static_cast<std::size_t>(CurveStyle::segments));
  return curve.style == CurveStyle::segments
             ? fmt::format("with vectors nohead lw {:.3g} lc rgb '#000000'", curve.width)
             : styles[static_cast<std::size_t>(curve.style)];
}

/// Text as a gnuplot string in double quotes. Names of run folders can hold any character; control characters
/// other than the line end are left out, since XML forbids them in the SVG file.
std::string gnuplot_string(const std::string &text) {
  std::string out = "\"";
  for (const char c : valid_utf8(text)) {
    if (c == '\n') {
      out += "\\n";
      continue;
    }
    if (static_cast<unsigned char>(c) < 0x20) continue;
    if (c == '"' || c == '\\') out += '\\';
    out += c == '`' ? '\'' : c; // gnuplot runs text between backquotes as a command
  }
  return out + "\"";
}

/// The label of a tic. gnuplot reads it as a format for the tic's number, so % has to be doubled.
std::string tic_label(const std::string &name) {
  constexpr std::size_t most = 40; // letters; a longer label would leave no room for the graph
  std::string label;
  for (const char c : shortened(valid_utf8(name), most))
    label += c == '%' ? "%%" : std::string(1, c);
  return label;
}

/// Letters of the longest tic label that is a name; 0 if the tics are numbers.
std::size_t longest_tic(const Panel &panel) {
  std::size_t longest = 0;
  for (const std::string &name : panel.x_ticks)
    longest = std::max(longest, tic_label(name).size());
  return longest;
}

/// Height of an upright tic label, in lines of text.
double tic_lines(const Panel &panel) {
  constexpr double line_per_letter = 0.45; // a letter's width over the height of a line
  return line_per_letter * static_cast<double>(longest_tic(panel));
}

/// Numbers on a logarithmic axis, x or y, for any range of it from 1e-3 to 1e4.
std::string plain_log_tics(char axis) {
  std::string s = fmt::format("  set {}tics (", axis);
  for (int power = -3; power < 4; ++power)
    for (const int digit : {1, 2, 5})
      s += fmt::format("{}{}e{}", s.back() == '(' ? "" : ", ", digit, power);
  return s + ")\n";
}

std::string x_axis_script(const Panel &panel) {
  std::string s;
  if (panel.x_ticks.empty()) {
    s += fmt::format("  set xtics {} norotate\n  set autoscale x\n", panel.whole_x ? "1" : "autofreq");
    if (panel.log_x && panel.plain_numbers) s += plain_log_tics('x');
    s += panel.tight_x ? "  set autoscale xfix\n  set offsets 0, 0, 0, 0\n"
                       : "  set offsets graph 0.04, graph 0.04, 0, 0\n";
    if (!panel.x_range.empty())
      s += fmt::format("  set xrange {}\n  set offsets 0, 0, 0, 0\n", panel.x_range);
    return s;
  }
  s += "  set xtics rotate by 90 right noenhanced (";
  for (std::size_t i = 0; i < panel.x_ticks.size(); ++i)
    s += fmt::format("{}{} {}", i == 0 ? "" : ", ", gnuplot_string(tic_label(panel.x_ticks[i])), i + 1);
  return s + fmt::format(")\n  set xrange [0.5:{}]\n", static_cast<double>(panel.x_ticks.size()) + 0.5);
}

std::string color_script(const Panel &panel) {
  if (panel.color_label.empty()) return {};
  return fmt::format("  set colorbox\n  set rmargin 8.5\n  set cblabel {}\n  set cbrange {}\n",
                     gnuplot_string(panel.color_label),
                     panel.color_range.empty() ? "[*:*]" : panel.color_range) +
         (panel.color_whole ? "  set palette defined (0 '#ffffff', 1 '#faeed5', 2 '#f3d9a0', 3 '#d3e8f5', 4 "
                              "'#9dcdea', 5 '#5ba9d6', 6 '#0072B2') maxcolors 7\n  set cbtics 1\n"
                            : "  set palette defined (0 '#fffdf5', 1 '#f6d78b', 2 '#E69F00', 3 '#D55E00')\n"
                              "  set cbtics autofreq\n");
}

std::string curve_script(const Curve &curve) {
  std::string every;
  if (curve.every > 1 || curve.offset > 0) every = fmt::format(" every {}::{}", curve.every, curve.offset);
  const std::string title =
      curve.title.empty() ? "notitle" : fmt::format("title {} noenhanced", gnuplot_string(curve.title));
  return fmt::format("{} skip 1{} using {}:{} {} {}", gnuplot_string(curve.data), every, curve.x, curve.y,
                     style_words(curve), title);
}

/// The legend of a panel, below its axes.
struct Legend {
  int rows = 1;
  /// Letters by which gnuplot is to make each column wider than its names. It thinks that letters are wider
  /// in SVG files than they are, and would need more rows there, which would lie on the axis label.
  int wider_png = 0, wider_svg = 0;
};

/// \param width of the panel, px. Keys have columns as wide as the longest name.
Legend legend_of(const Panel &panel, int width) {
  constexpr double letter = 8.8, letter_svg = 10.5; // px; the latter in gnuplot's reckoning
  constexpr double sample = 6.0, sample_svg = 5.6;  // letters that line sample and gap take
  constexpr double margins = 90.0;                  // px, left and right of the axes
  std::size_t longest = 0;
  int names = 0;
  for (const Curve &curve : panel.curves) {
    if (curve.title.empty()) continue;
    longest = std::max(longest, curve.title.size());
    ++names;
  }
  const auto letters = static_cast<double>(longest);
  const int per_row = std::max(1, static_cast<int>((width - margins) / (letter * (letters + sample))));
  Legend legend;
  legend.rows = std::max(1, (names + per_row - 1) / per_row);
  legend.wider_png = legend.rows > 1 ? 0 : -2;
  const double column = letter * (letters + sample) / letter_svg; // letters of gnuplot's in SVG
  legend.wider_svg =
      std::min(legend.wider_png, static_cast<int>(std::floor(column - (letters + sample_svg))));
  return legend;
}

/// \param width of the panel in px
/// \param is_empty whether it has no point to draw, which gnuplot takes for an error: the axes get a note
/// instead
std::string panel_script(const Panel &panel, int width, bool is_empty) {
  std::string s;
  s += panel.title.empty() ? "  unset title\n"
                           : fmt::format("  set title {} noenhanced\n", gnuplot_string(panel.title));
  s += fmt::format("  set xlabel {}\n  set ylabel {}\n", gnuplot_string(panel.x_label),
                   gnuplot_string(panel.y_label));
  s += "  unset logscale\n";
  s += panel.log_x ? "  set logscale x\n" : "";
  s += panel.log_x && !panel.plain_numbers ? "  set format x '10^{%T}'\n" : "  set format x '%g'\n";
  s += panel.log_y ? "  set logscale y\n" : "";
  s += panel.log_y && !panel.plain_y ? "  set format y '10^{%T}'\n" : "  set format y '%g'\n";
  s += fmt::format("  set yrange {}\n", panel.y_range.empty() ? "[*:*]" : panel.y_range);
  const Legend legend = legend_of(panel, width);
  const double tics_and_label = panel.x_ticks.empty() ? 4.0 : 2.0; // lines of text
  const double row = 1.4;
  s += fmt::format("  set bmargin {}\n  set key maxrows {} width (kind eq \"svg\" ? {} : {})\n",
                   tics_and_label + row * legend.rows + tic_lines(panel), legend.rows, legend.wider_svg,
                   legend.wider_png);
  s += x_axis_script(panel);
  s += panel.whole_y ? "  set ytics 1\n" : "  set ytics autofreq\n";
  if (panel.log_y && panel.plain_y) s += plain_log_tics('y');
  if (panel.equal_scales) s += "  set size ratio -1\n";
  s += color_script(panel);
  if (is_empty) {
    s += "  unset logscale\n  set label 1 \"no values to draw\" at graph 0.5, graph 0.5 center\n"
         "  set autoscale x\n  plot [0:1] [0:1] 2 notitle\n  unset label 1\n";
  } else {
    s += "  plot ";
    for (std::size_t i = 0; i < panel.curves.size(); ++i)
      s += (i == 0 ? "" : ", \\\n       ") + curve_script(panel.curves[i]);
    s += "\n";
  }
  if (panel.equal_scales) s += "  set size noratio\n";
  if (!panel.color_label.empty()) s += "  unset colorbox\n  set rmargin -1\n";
  return s;
}

int columns_of(const Figure &figure) {
  return std::clamp(figure.columns, 1, std::max(1, static_cast<int>(figure.panels.size())));
}

int rows_of(const Figure &figure) {
  const int columns = columns_of(figure);
  return (static_cast<int>(figure.panels.size()) + columns - 1) / columns;
}

/// What the terminals have in common.
constexpr const char *settings = "set encoding utf8\n"
                                 "set datafile separator comma\n"
                                 "set datafile missing ''\n"
                                 "set grid lc rgb '#dddddd' lt 1 lw 0.6\n"
                                 "set border lw 1.0\n"
                                 "set tics nomirror out\n"
                                 "set xzeroaxis lt 1 lw 0.8 dt solid lc rgb '#999999'\n"
                                 "set key bmargin center horizontal Left reverse samplen 2.5\n";

/// The pictures of an animation, one after the other into a GIF, then the middle one into a PNG.
std::string animation_script(const Figure &figure, bool is_empty) {
  const int width = figure_width(figure), height = figure_height(figure);
  std::string titles;
  for (const std::string &title : figure.frames)
    titles += (titles.empty() ? "" : ", ") + gnuplot_string(title);
  const std::size_t count = figure.frames.size();
  std::string s = fmt::format("array titles[{}] = [{}]\n", count, titles);
  const std::string picture = "  set label 9 titles[frame] at graph 0.0, graph 1.03 front noenhanced\n" +
                              panel_script(figure.panels.front(), width, is_empty);
  const std::string size =
      fmt::format("size {},{} enhanced font 'DejaVu Sans,11' background '#ffffff'", width, height);
  s += fmt::format("kind = \"gif\"\nset terminal gif animate delay 12 loop 0 {}\nset output \"{}.gif\"\n"
                   "do for [frame=1:{}] {{\n{}}}\nunset output\n",
                   size, figure.name, count, picture);
  s += fmt::format("kind = \"png\"\nset terminal pngcairo {}\nset output \"{}.png\"\nframe = {}\n{}"
                   "unset output\n",
                   size, figure.name, (count + 1) / 2, picture);
  return s;
}

/// \param is_empty of each panel, see panel_script()
std::string figure_script(const Figure &figure, const std::vector<bool> &is_empty) {
  const int rows = rows_of(figure);
  const int columns = columns_of(figure);
  const bool many = figure.panels.size() > 1;
  const int width = figure_width(figure);
  const int height = figure_height(figure);
  std::string s =
      fmt::format("# {}\n# Run in this folder: gnuplot {}.gp\n{}", figure.title, figure.name, settings);
  if (!figure.frames.empty()) return s + animation_script(figure, is_empty.front());
  s += fmt::format("do for [kind in \"{4}\"] {{\n"
                   "  if (kind eq \"svg\") {{ set terminal svg size {0},{1} enhanced rounded font 'DejaVu "
                   "Sans,Helvetica,Arial,15' background '#ffffff' }}\n"
                   "  else {{ set terminal pngcairo size {2},{3} enhanced rounded fontscale 1.5 linewidth "
                   "1.5 pointscale 1.5 font 'DejaVu Sans,11.5' background '#ffffff' }}\n",
                   width, height, width * 3 / 2, height * 3 / 2, figure.only_png ? "png" : "svg png");
  s += fmt::format("  set output \"{}.\".kind\n", figure.name);
  if (many)
    s += fmt::format("  set multiplot layout {},{} title {} noenhanced\n", rows, columns,
                     gnuplot_string(figure.title));
  for (std::size_t n = 0; n < figure.panels.size(); ++n)
    s += panel_script(figure.panels[n], width / columns, is_empty[n]);
  if (many) s += "  unset multiplot\n";
  return s + "  unset output\n}\n";
}

/// Runs a script in a folder.
Outcome run_gnuplot(const fs::path &gnuplot, const fs::path &folder, const std::string &script) {
  // --default-settings: a .gnuplot file of the user must not change the report.
  constexpr double limit = 600.0; // s: the largest pictures take some ten
  Outcome outcome = run_program({gnuplot.string(), "--default-settings", script}, {}, folder, limit);
  std::error_code ignored;
  fs::remove(folder / program_output_file, ignored);
  return outcome;
}

/// Whether gnuplot has ended because a panel has no point: all its values are missing, or not positive on a
/// logarithmic axis.
bool found_no_point(const Outcome &outcome) {
  return !outcome.ok() && !outcome.timed_out && !outcome.says("Cannot find or open file") &&
         (outcome.says("y value undefined!") || outcome.says("range is invalid"));
}

/// Those panels in which gnuplot finds no point.
std::vector<bool> empty_panels(const fs::path &gnuplot, const fs::path &folder, const Figure &figure) {
  std::vector<bool> is_empty;
  const std::string name = figure.name + "_panel.gp";
  for (const Panel &panel : figure.panels) {
    write_files({{folder / name,
                  fmt::format("{}set terminal dumb\nset output '/dev/null'\nkind = 'svg'\nframe = 1\n{}",
                              settings, panel_script(panel, figure_width(figure), false))}});
    is_empty.push_back(found_no_point(run_gnuplot(gnuplot, folder, name)));
  }
  std::error_code ignored;
  fs::remove(folder / name, ignored);
  return is_empty;
}

} // namespace

fs::path find_gnuplot() {
  const fs::path file = program_file("gnuplot");
  if (file.empty())
    throw std::runtime_error("the program gnuplot is not on PATH; install the Debian package gnuplot-nox");
  return fs::absolute(file);
}

std::string axis_range(double low, double high) {
  const std::string from = fmt::format("{:.6g}", low);
  const std::string to = fmt::format("{:.6g}", high);
  return std::isfinite(low) && std::isfinite(high) && low < high && from != to
             ? fmt::format("[{}:{}]", from, to)
             : "";
}

int figure_width(const Figure &figure) {
  const int width = figure.half ? 540 : 1080;
  return width / columns_of(figure) * columns_of(figure);
}

int figure_height(const Figure &figure) {
  if (figure.height > 0) return figure.height;
  constexpr int graph = 430;
  constexpr int picture = 680;
  constexpr double line = 17.0; // px, of tic labels
  constexpr double usual = 6.0; // lines of tic labels for which a graph has room
  int panel_height = graph;
  for (const Panel &panel : figure.panels) {
    const double more = std::max(0.0, tic_lines(panel) - usual) * line;
    panel_height =
        std::max(panel_height, panel.equal_scales && !figure.half ? picture : graph + static_cast<int>(more));
  }
  return rows_of(figure) * panel_height + (figure.panels.size() > 1 ? 40 : 0);
}

const char *shown_ending(const Figure &figure) {
  return !figure.frames.empty() ? ".gif" : figure.only_png ? ".png" : ".svg";
}

std::string gnuplot_script(const Figure &figure) {
  return figure_script(figure, std::vector<bool>(figure.panels.size()));
}

bool is_whole_picture(const fs::path &file) {
  using namespace std::string_view_literals;
  std::ifstream in(file, std::ios::binary);
  const std::string all(std::istreambuf_iterator<char>(in), {});
  const bool png = file.extension() == ".png", gif = file.extension() == ".gif";
  const std::string_view begin = png ? "\x89PNG\r\n\x1a\n"sv : gif ? "GIF8"sv : "<?xml"sv;
  const std::string_view end = png ? "\0\0\0\0IEND\xae\x42\x60\x82"sv : gif ? ";"sv : "</svg>"sv;
  std::string_view rest = all;
  if (!png && !gif) rest = rest.substr(0, rest.find_last_not_of(" \r\n") + 1);
  return rest.size() >= begin.size() + end.size() && rest.substr(0, begin.size()) == begin &&
         rest.substr(rest.size() - end.size()) == end;
}

void render(const fs::path &gnuplot, const fs::path &folder, const Figure &figure) {
  const fs::path script = folder / (figure.name + ".gp");
  write_files({{script, gnuplot_script(figure)}});
  Outcome outcome = run_gnuplot(gnuplot, folder, script.filename());
  if (found_no_point(outcome)) {
    write_files({{script, figure_script(figure, empty_panels(gnuplot, folder, figure))}});
    outcome = run_gnuplot(gnuplot, folder, script.filename());
  }
  if (!outcome.ok())
    throw std::runtime_error(fmt::format("gnuplot failed on {}: {}", script.string(), outcome.output));
  for (const char *kind : {shown_ending(figure), ".png"}) {
    const fs::path picture = folder / (figure.name + kind);
    if (!is_whole_picture(picture))
      throw std::runtime_error(
          fmt::format("{} is cut short; allowed: a disk with room for what gnuplot draws", picture.string()));
  }
}

} // namespace drumlin::post
