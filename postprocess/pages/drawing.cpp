#include "pages/drawing.h"

#include "pages/html.h"

#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace drumlin::post {

namespace {

std::string line(double x0, double y0, double x1, double y1) {
  return fmt::format("M{:g} {:g} L{:g} {:g} ", x0, y0, x1, y1);
}

/// Upright spring of six windings from (x, top) to (x, bottom).
std::string spring(double x, double top, double bottom) {
  constexpr int corners = 12;
  const double straight = 0.15 * (bottom - top);
  std::string path = fmt::format("M{:g} {:g} V{:g} ", x, top, top + straight);
  for (int i = 1; i < corners; ++i)
    path += fmt::format("L{:g} {:g} ", x + (i % 2 == 0 ? -9.0 : 9.0),
                        top + straight + (bottom - top - 2.0 * straight) * i / corners);
  return path + fmt::format("L{:g} {:g} V{:g} ", x, bottom - straight, bottom);
}

/// Upright dashpot from (x, top) to (x, bottom).
std::string dashpot(double x, double top, double bottom) {
  const double middle = 0.5 * (top + bottom);
  return line(x, top, x, middle - 2.0) + line(x - 8.0, middle - 2.0, x + 8.0, middle - 2.0) +
         fmt::format("M{0:g} {1:g} V{2:g} H{3:g} V{1:g} ", x - 12.0, middle - 12.0, middle + 10.0, x + 12.0) +
         line(x, middle + 10.0, x, bottom);
}

/// Ground line with hatching below it.
std::string ground(double x0, double x1, double y) {
  std::string path = line(x0, y, x1, y);
  for (int n = 0; x0 + 6.0 + 12.0 * n <= x1; ++n) {
    const double x = x0 + 6.0 + 12.0 * n;
    path += line(x, y, x - 8.0, y + 10.0);
  }
  return path;
}

/// Upright arrow that ends at (x, tip).
std::string arrow(double x, double from, double tip) {
  const double head = tip > from ? -9.0 : 9.0;
  return line(x, from, x, tip) +
         fmt::format("M{:g} {:g} L{:g} {:g} L{:g} {:g} ", x - 5.0, tip + head, x, tip, x + 5.0, tip + head);
}

std::string strokes(const std::string &path, double width = 1.8, const char *color = "#1a1a1a") {
  return fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\" stroke-linejoin=\"round\"/>\n", path,
      color, width);
}

std::string text(double x, double y, const std::string &words, const char *anchor = "start",
                 const char *color = "#1a1a1a") {
  return fmt::format("<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n", x, y, anchor,
                     color, html_escaped(words));
}

std::string disc(double x, double y, double radius, const char *fill) {
  return fmt::format(
      "<circle cx=\"{:g}\" cy=\"{:g}\" r=\"{:g}\" fill=\"{}\" stroke=\"#1a1a1a\" stroke-width=\"1.2\"/>\n", x,
      y, radius, fill);
}

std::string box(double x, double y, double width, double height, const char *fill) {
  return fmt::format("<rect x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" rx=\"4\" fill=\"{}\" "
                     "stroke=\"#1a1a1a\" stroke-width=\"1.8\"/>\n",
                     x, y, width, height, fill);
}

constexpr const char *steel = "#dce6f0";
constexpr const char *sand = "#f0e4cc";
constexpr const char *red = "#b03a00";

/// Frame, suspension and drum with its exciter; the drum touches y = 215.
std::string roller() {
  return box(60, 12, 130, 44, steel) + text(125, 39, "frame m₃", "middle") +
         strokes(spring(100, 56, 122) + dashpot(150, 56, 122)) + text(180, 93, "k₂₃, c₂₃ suspension") +
         disc(125, 165, 50, steel) + text(125, 170, "drum m₂", "middle") +
         strokes(arrow(192, 165, 135) + arrow(192, 165, 195), 2.4, red) +
         text(203, 170, "Fw sin ωt", "start", red);
}

std::string chain_drawing() {
  return roller() + strokes(line(85, 217, 165, 217), 3.0) +
         strokes(spring(105, 217, 280) + dashpot(150, 217, 280) + ground(60, 195, 280)) +
         text(180, 243, "k, D contact,") + text(180, 259, "condition A or B") +
         text(203, 292, "soil, fixed") + strokes(arrow(285, 20, 55)) + text(293, 42, "g");
}

/// Rows of soil balls of slightly different sizes between x = 17 and 251, the first row at height `top`.
std::string soil(double top) {
  std::string s;
  constexpr double radius = 9.0;
  const double height = radius * std::sqrt(3.0);
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 13 - row % 2; ++column) {
      const double x = 17.0 + radius + 2.0 * radius * column + (row % 2 == 0 ? 0.0 : radius);
      s += disc(x, top + height * row, radius - 0.5 * (row * 5 + column * 3 % 4 % 3) / 5.0, sand);
    }
  return s;
}

std::string bed_drawing() {
  return roller() + soil(225) +
         strokes(line(17, 205, 17, 297) + line(251, 205, 251, 297) + ground(17, 251, 297)) +
         text(262, 262, "soil balls") + strokes(arrow(285, 20, 55)) + text(293, 42, "g");
}

std::string drive_drawing() {
  return bed_drawing() + strokes("M200 34 H240 M231 29 L240 34 L231 39", 2.4, red) +
         text(220, 24, "v", "middle", red);
}

std::string oedometer_drawing() {
  return strokes(arrow(70, 25, 58) + arrow(134, 25, 58) + arrow(198, 25, 58), 2.4, red) +
         text(134, 17, "stress", "middle", red) + box(17, 60, 234, 16, steel) + text(262, 73, "platen") +
         soil(86) + strokes(line(17, 80, 17, 158) + line(251, 80, 251, 158) + ground(17, 251, 158)) +
         text(262, 122, "soil balls");
}

std::string biaxial_drawing() {
  std::string side; // arrows of the side stress
  for (const double y : {95.0, 120.0, 145.0})
    side += line(290, y, 272, y) + fmt::format("M281 {:g} L272 {:g} L281 {:g} ", y - 5.0, y, y + 5.0);
  return strokes(arrow(134, 25, 58), 2.4, red) + text(145, 40, "moved slowly", "start", red) +
         box(12, 60, 244, 16, steel) + soil(86) + box(253, 80, 14, 78, steel) + strokes(side, 2.4, red) +
         text(294, 116, "side", "start", red) + text(294, 132, "stress", "start", red) +
         strokes(line(17, 80, 17, 158) + ground(17, 251, 158));
}

std::string plate_drawing() {
  return strokes(arrow(110, 25, 55) + arrow(134, 25, 55) + arrow(158, 25, 55), 2.4, red) +
         text(134, 17, "stress", "middle", red) + box(90, 58, 88, 14, steel) + text(190, 70, "plate") +
         soil(82) + strokes(line(17, 62, 17, 154) + line(251, 62, 251, 154) + ground(17, 251, 154)) +
         text(262, 119, "soil balls");
}

std::string shear_drawing() {
  return oedometer_drawing() + strokes(line(262, 50, 312, 50) + "M303 45 L312 50 L303 55 ", 2.4, red) +
         text(262, 40, "moved slowly", "start", red);
}

/// Soil between two walls on a floor, without the arrow of the plate that moves.
std::string between_walls() {
  return soil(86) + box(5, 60, 12, 98, steel) + box(251, 60, 12, 98, steel) + strokes(ground(17, 251, 158));
}

std::string wall_drawing() {
  return between_walls() + strokes(line(270, 100, 312, 100) + "M303 95 L312 100 L303 105 ", 2.4, red) +
         text(270, 90, "moved slowly", "start", red);
}

std::string silo_drawing() {
  return between_walls() + strokes(arrow(290, 130, 168), 2.4, red) + text(270, 120, "floor", "start", red);
}

std::string repose_drawing() {
  std::string heap;
  for (int row = 0; row < 5; ++row)
    for (int n = 0; n < 9 - 2 * row; ++n)
      heap += disc(28 + 20 * n + 10 * (row % 2), 148 - 17.5 * row, 10, sand);
  return heap + box(5, 50, 12, 108, steel) + box(251, 50, 12, 108, steel) + strokes(ground(17, 251, 158)) +
         strokes(line(270, 100, 312, 100) + "M303 95 L312 100 L303 105 ", 2.4, red) +
         text(262, 90, "moved away", "start", red);
}

std::string held_drawing() {
  const auto wall = [](double x, double side) {
    std::string path = line(x, 30, x, 130);
    for (int n = 0; n < 8; ++n) { // from y = 36 to 120
      const double y = 36.0 + 12.0 * n;
      path += line(x, y, x + side * 10.0, y - 8.0);
    }
    return path;
  };
  return strokes(wall(90, -1) + wall(210, 1)) + disc(150, 80, 61.5, steel) + text(150, 78, "ball", "middle") +
         text(150, 96, "mass m", "middle") + text(18, 160, "each contact: stiffness k, damping ratio D,") +
         text(18, 178, "ω₀ = √(k/m); step dt");
}

std::string sphere_drawing() {
  return strokes(ground(30, 300, 140)) + disc(150, 88, 50, steel) + strokes(arrow(60, 40, 75), 2.4, red) +
         text(70, 62, "vₙ", "start", red) + strokes("M60 40 L95 40 M86 35 L95 40 L86 45 ", 2.4, red) +
         text(101, 45, "vₜ", "start", red) +
         strokes("M128 62 A 34 34 0 0 1 172 62 M161 60 L172 62 L169 51 ") + text(150, 92, "ω", "middle") +
         text(216, 120, "μ, e, contact law");
}

std::string two_ends_drawing() {
  std::string below;
  for (const double x : {68.0, 180.0})
    below += spring(x, 200, 272) + dashpot(x + 32.0, 200, 272);
  return box(50, 12, 180, 40, steel) + text(140, 37, "frame m₃", "middle") +
         strokes(spring(84, 52, 112) + spring(196, 52, 112)) + text(250, 86, "k₂₃, c₂₃") +
         box(40, 112, 200, 88, steel) + text(140, 136, "drum m₂", "middle") +
         strokes(arrow(128, 170, 144) + arrow(128, 170, 196), 2.4, red) +
         text(140, 175, "Fw sin ωt", "start", red) + disc(48, 120, 5, red) + disc(232, 120, 5, red) +
         text(250, 125, "sensors") + strokes("M262 178 A 130 130 0 0 0 262 142 M256 151 L262 142 L269 150 ") +
         text(274, 165, "tilt") + strokes(below + ground(40, 262, 272)) +
         text(84, 300, "left half", "middle") + text(196, 300, "right half", "middle");
}

/// A drawing with its words.
struct Scene {
  const char *title, *caption;
  std::string (*drawing)();
  double height = 180;
};

/// In the order of Drawing.
const std::array<Scene, 14> scenes = {{
    {"The chain of soil, drum and frame",
     "The model: frame and drum move up and down only. The contact with the soil is a spring and a "
     "dashpot that act while drum and soil overlap.",
     chain_drawing, 310},
    {"Drum and frame on a bed of balls",
     "The model: frame and drum move up and down only, on soil of balls in a box. Every contact is a spring "
     "and a dashpot, with friction.",
     bed_drawing, 310},
    {"Drum and frame that drive over a bed of balls",
     "The model: frame and drum drive along the way and move up and down, on soil of balls in a box. Every "
     "contact is a spring and a dashpot, with friction.",
     drive_drawing, 310},
    {"A ball confined between two walls",
     "The model of the stability map: one ball in contact with one, two or four walls.", held_drawing, 190},
    {"A sample of soil between two plates",
     "The model: a sample of soil balls that cannot expand sideways, under a platen with a given stress.",
     oedometer_drawing},
    {"A sphere that strikes a plane",
     "The model: a sphere with a velocity and a spin strikes a plane or another sphere.", sphere_drawing,
     160},
    {"A sample of soil between four plates",
     "The model: a sample of soil balls between smooth plates. The right one carries a given "
     "stress, the upper one is moved.",
     biaxial_drawing},
    {"A sample of soil between six plates",
     "The model: a sample of soil balls between smooth plates, of which the drawing shows four. The "
     "right one and the one in front carry the same given stress, the upper one is moved.",
     biaxial_drawing},
    {"A plate on a bed of balls",
     "The model: a rigid plate with a given stress moves vertically on soil balls between two walls.",
     plate_drawing},
    {"A sample of soil that is sheared between two plates",
     "The model: a sample of soil balls, periodic sideways, between rough plates. The platen "
     "carries a given stress and is moved sideways.",
     shear_drawing},
    {"Half a heap of soil",
     "The model: soil balls on a floor of balls, between smooth walls. The right wall moves away slowly.",
     repose_drawing},
    {"Soil between two rough walls",
     "The model: soil balls under gravity between two rough walls, whose floor moves down slowly.",
     silo_drawing},
    {"Soil behind a wall that moves outward",
     "The model: soil balls under gravity between two smooth walls, of which the right one moves "
     "outward slowly.",
     wall_drawing},
    {"A drum with two ends",
     "The model, seen along the way of travel: frame and drum move up and down and tilt. Each contact is "
     "made and broken by itself.",
     two_ends_drawing, 310},
}};

} // namespace

std::string drawing_html(Drawing model) {
  const Scene &scene = scenes.at(static_cast<std::size_t>(model));
  return fmt::format("<figure class=\"scene\">\n<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 340 "
                     "{:g}\" role=\"img\" aria-label=\"{}\" font-size=\"14\">\n"
                     "{}</svg>\n<figcaption>{}</figcaption>\n</figure>\n",
                     scene.height, scene.title, scene.drawing(), html_escaped(scene.caption));
}

} // namespace drumlin::post
