// The density of the layers of a bed, beside the one asked for.
#include "commands/commands.h"
#include "commands/deck_variables.h"
#include "commands/vertical_lines.h"

#include "support/arguments.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

constexpr const char *of_loosest = "keyword scale, loosest", *of_densest = "keyword scale, densest",
                     *of_asked = "keyword scale, asked for";
constexpr const char *one_each = "unknown, or a number for each layer, separated by commas";
/// So much a layer may differ in relative density from what was asked for without a warning, three times the
/// scatter of single layers (inputs/study/density).
constexpr double expected_scatter = 0.25;

/// Area of a disc, or volume of a sphere, of radius 1 to the left of x.
double content_left_of(double x, bool flat) {
  constexpr double pi = 3.14159265358979323846;
  const double at = std::max(-1.0, std::min(x, 1.0));
  return flat ? pi - std::acos(at) + at * std::sqrt(1.0 - at * at)
              : pi / 3.0 * (1.0 + at) * (1.0 + at) * (2.0 - at);
}

struct Interval {
  double from, to; ///< m
  double length() const { return to - from; }

  /// Without a margin at both ends, which is at most a quarter of the length.
  Interval inner(double margin) const {
    const double left_out = std::min(margin, 0.25 * length());
    return {from + left_out, to - left_out};
  }
  /// The share of a ball that lies in it.
  double share(double centre, double radius, bool flat) const {
    return (content_left_of((to - centre) / radius, flat) - content_left_of((from - centre) / radius, flat)) /
           content_left_of(1.0, flat);
  }
};

/// The soil of a bed. Its types are those of drumlin/layers: 1 is the lowest layer, 4 the second, 5 the
/// third; types behind those of the layers are spots of the lowest.
class Soil {
public:
  Soil(LAMMPS *engine, int groupbit, int layers) : engine_(engine), bit_(groupbit), layers_(layers) {
    double mine[3] = {0.0, 0.0, -std::numeric_limits<double>::infinity()};
    for_balls([&](int i) {
      const double r = engine_->atom->radius[i];
      mine[0] += 2.0 * r;
      mine[1] += 1.0;
      mine[2] = std::max(mine[2], -r);
    });
    double sums[2];
    MPI_Allreduce(mine, sums, 2, MPI_DOUBLE, MPI_SUM, engine_->world);
    MPI_Allreduce(mine + 2, &smallest_, 1, MPI_DOUBLE, MPI_MAX, engine_->world);
    smallest_ = -smallest_;
    count_ = sums[1];
    mean_diameter_ = sums[0] / sums[1];
  }

  double count() const { return count_; }
  double smallest_radius() const { return smallest_; }

  /// Mean height of the surface of a layer, counted from 0, and all below it, m.
  double top(const VerticalLines &lines, int layer) const {
    return lines.mean_height([&](int i) { return counts(i) && layer_of(i) <= layer; });
  }

  /// The share of solids inside of a layer: two mean diameters away from its surfaces and from walls. A ball
  /// that is cut there counts with its share.
  double solid_fraction(Interval heights) const {
    const LAMMPS_NS::Domain &box = *engine_->domain;
    const LAMMPS_NS::Atom &atom = *engine_->atom;
    const bool flat = box.dimension == 2;
    const bool walled = box.periodicity[0] == 0;
    const Interval inside = heights.inner(2.0 * mean_diameter_);
    const Interval whole = {box.boxlo[0], box.boxhi[0]};
    const Interval along = walled ? whole.inner(2.0 * mean_diameter_) : whole;
    double mine = 0.0;
    for_balls([&](int i) {
      const double r = atom.radius[i];
      const double content = content_left_of(1.0, flat) * (flat ? r * r : r * r * r);
      mine +=
          content * inside.share(atom.x[i][1], r, flat) * (walled ? along.share(atom.x[i][0], r, flat) : 1.0);
    });
    double solids = 0.0;
    MPI_Allreduce(&mine, &solids, 1, MPI_DOUBLE, MPI_SUM, engine_->world);
    const double thickness = flat ? 1.0 : box.boxhi[2] - box.boxlo[2];
    return solids / (inside.length() * along.length() * thickness);
  }

private:
  bool counts(int i) const { return (engine_->atom->mask[i] & bit_) != 0; }
  int layer_of(int i) const {
    const int type = engine_->atom->type[i];
    const int layer = type == 1 ? 0 : type - 3;
    return layer < layers_ ? layer : 0;
  }
  template <class Visit>
  void for_balls(const Visit &visit) const {
    for (int i = 0; i < engine_->atom->nlocal; ++i)
      if (counts(i)) visit(i);
  }

  LAMMPS *engine_;
  int bit_, layers_;
  double count_ = 0.0, smallest_ = 0.0, mean_diameter_ = 0.0;
};

/// The numbers of a text, one for each layer, separated by commas; none if the text is `unknown`.
std::vector<double> known(const Arguments &in, const std::string &what, const std::string &text,
                          const Range &range, int layers) {
  if (text == "unknown") return {};
  std::vector<double> numbers = list_numbers(in, what, text, range);
  if (numbers.size() != static_cast<std::size_t>(layers))
    in.fail(what, text, fmt::format("{}, and the bed has {} of them", one_each, layers));
  return numbers;
}

} // namespace

void density_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/density", narg, arg);
  const std::string name = in.word("variable", "the name of a variable");
  const int group = in.group("group", lmp->group);
  constexpr int most_layers = 100;
  int layers = 1;
  std::string loosest_text = "unknown", densest_text = "unknown", asked_text = "unknown";
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "layers")
      layers = static_cast<int>(in.integer("keyword layers", 1, most_layers));
    else if (keyword == "scale") {
      loosest_text = in.word(of_loosest, one_each);
      densest_text = in.word(of_densest, one_each);
      asked_text = in.word(of_asked, one_each);
    } else
      in.fail("keyword", keyword, "layers or scale");
  }
  const std::vector<double> loosest = known(in, of_loosest, loosest_text, Range::positive, layers),
                            densest = known(in, of_densest, densest_text, Range::positive, layers),
                            asked = known(in, of_asked, asked_text, Range::any, layers);
  const bool has_scale = !loosest.empty() && !densest.empty();
  for (std::size_t n = 0; has_scale && n < loosest.size(); ++n)
    if (!(densest[n] < loosest[n]))
      in.fail(of_densest, densest_text,
              fmt::format("void ratios below those of the loosest, {}", loosest_text));
  if (lmp->domain->box_exist == 0)
    in.fail("simulation box is missing; allowed: the command after create_box or read_data");
  const Soil soil(lmp, engine::group_bit(group), layers);
  if (soil.count() == 0.0) in.fail("group", lmp->group->names[group], "one with balls");
  const VerticalLines lines(lmp, in, 0.25 * soil.smallest_radius());
  std::string tops;
  double below = lmp->domain->boxlo[1];
  for (int layer = 0; layer < layers; ++layer) {
    const auto n = static_cast<std::size_t>(layer);
    const double top = soil.top(lines, layer);
    if (!(top > below))
      in.fail("keyword layers", fmt::format("{}", layers),
              fmt::format("a bed of so many layers, each with balls above the one below: layer {} has none",
                          layer + 1));
    const double phi = soil.solid_fraction({below, top});
    std::string line =
        fmt::format("layer {}, {:.3f} to {:.3f} m: solid fraction {:.4f} inside", layer + 1, below, top, phi);
    std::string warning;
    if (has_scale) {
      const double found = (loosest[n] - (1.0 / phi - 1.0)) / (loosest[n] - densest[n]);
      line += fmt::format(", relative density {:.2f}", found);
      if (!asked.empty()) {
        line += fmt::format(" where {:g} was asked for", asked[n]);
        if (std::fabs(found - asked[n]) > expected_scatter)
          warning =
              fmt::format("WARNING: drumlin/density: layer {} is {} than asked for, by {:.2f} of "
                          "relative density: soil that is tipped moist (pour_tensile_strength) gets looser; "
                          "else take another --seed, or packings of its own grading and contacts\n",
                          layer + 1, found > asked[n] ? "denser" : "looser", std::fabs(found - asked[n]));
      }
    }
    engine::log_message(lmp, fmt::format("drumlin/density: {}\n{}", line, warning));
    tops += fmt::format("{}{:.17g}", layer == 0 ? "" : ",", top);
    below = top;
  }
  DeckVariables(lmp).set(name, tops);
}

} // namespace drumlin
