#include "lab/stability/bed.h"

#include "bed/dump_readers.h"
#include "support/csv.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace {

constexpr double radius = 0.02; // m, of a soil ball: the deck's default
constexpr double infinite = std::numeric_limits<double>::infinity();

Extreme bed_row(const std::string &name, const Variables &variables, int ranks = 1) {
  Extreme row;
  row.group = "A small bed";
  row.name = name;
  row.deck = "study/in.small_bed";
  row.variables = variables;
  row.ranks = ranks;
  row.limit = 300.0;
  row.expected = "all balls there; the floor carries the weight; momentum changes by the impulse; no energy "
                 "left (the largest relative miss)";
  row.allowed = 1e-3;
  row.error = [](const DeckRun &run) {
    return balance_error(read_balance(run.must_succeed().file("balance.csv")), radius);
  };
  return row;
}

/// The same bed on several ranks and on one.
Extreme ranks_row(const std::string &name, const Variables &variables, int ranks) {
  Extreme row = bed_row(name, variables, ranks);
  row.expected = "every ball where it is on one rank (largest distance over the radius)";
  row.allowed = 1e-3;
  row.error = [variables](const DeckRun &run) {
    const DeckRun alone("study/in.small_bed", variables);
    return picture_distance(read_picture(run.must_succeed().file("last.dump")),
                            read_picture(alone.must_succeed().file("last.dump"))) /
           radius;
  };
  return row;
}

} // namespace

std::vector<BedState> read_balance(const std::filesystem::path &file) {
  const Table table = read_table(file);
  std::vector<BedState> states(table.rows());
  const std::pair<const char *, double BedState::*> columns[] = {
      {"time_s", &BedState::time},          {"balls", &BedState::balls},
      {"weight_N", &BedState::weight},      {"floor_force_N", &BedState::floor_force},
      {"momentum_Ns", &BedState::momentum}, {"kinetic_energy_J", &BedState::kinetic_energy}};
  for (const auto &[name, value] : columns) {
    const std::vector<double> numbers = table.numbers(name);
    for (std::size_t n = 0; n < states.size(); ++n)
      states[n].*value = numbers[n];
  }
  return states;
}

double balance_error(const std::vector<BedState> &states, double length) {
  if (states.size() < 2) throw std::runtime_error("balance.csv has fewer than two rows");
  const BedState &first = states.front();
  const BedState &last = states.back();
  double force = 0.0;
  double impulse = 0.0;
  double energy = 0.0;
  bool sound = true;
  for (std::size_t n = 0; n < states.size(); ++n) {
    const BedState &now = states[n];
    sound = sound && now.balls == first.balls && std::isfinite(now.floor_force) &&
            std::isfinite(now.momentum) && std::isfinite(now.kinetic_energy);
    force += now.floor_force / static_cast<double>(states.size());
    energy = std::max(energy, now.kinetic_energy);
    if (n > 0)
      impulse += (0.5 * (now.floor_force + states[n - 1].floor_force) - first.weight) *
                 (now.time - states[n - 1].time);
  }
  if (!sound) return infinite;
  const double weight_impulse = first.weight * (last.time - first.time);
  return std::max({std::fabs(force / first.weight - 1.0),
                   std::fabs(last.momentum - first.momentum - impulse) / weight_impulse,
                   energy / (first.weight * length)});
}

BedPicture read_picture(const std::filesystem::path &file) {
  const std::vector<TextDump> dumps = read_text_dumps(file);
  if (dumps.empty()) throw std::runtime_error(file.string() + ": holds no step");
  const TextDump &last = dumps.back();
  const std::size_t id = last.column("id"), x = last.column("x"), z = last.column("z");
  BedPicture picture;
  for (const std::vector<double> &row : last.rows)
    picture[std::lround(row[id])] = {row[x], row[z]};
  return picture;
}

double picture_distance(const BedPicture &a, const BedPicture &b) {
  if (a.empty() || a.size() != b.size()) return infinite;
  double most = 0.0;
  for (const auto &[id, place] : a) {
    const auto other = b.find(id);
    if (other == b.end()) return infinite;
    const double distance = std::hypot(place[0] - other->second[0], place[1] - other->second[1]);
    most = std::isfinite(distance) ? std::max(most, distance) : infinite;
  }
  return most;
}

void add_bed_rows(std::vector<Extreme> &rows, bool quick) {
  // One row of balls: the motion of more is chaotic, so that rounding errors, which depend on the number of
  // ranks, grow to the size of a radius.
  const auto on_ranks = [&](int ranks, const std::string &settling) {
    const Variables drum = {{"rows", "1"}, {"drum_mass", "100"}, {"settling", settling}};
    Variables aside = drum;
    aside.emplace_back("centre", "0.8");
    rows.push_back(ranks_row(fmt::format("the drum on a rank border; {} ranks", ranks), drum, ranks));
    rows.push_back(ranks_row(fmt::format("ranks without balls; {} ranks", ranks), aside, ranks));
  };
  if (quick) {
    rows.push_back(bed_row("no drum; 8 columns of two balls",
                           {{"columns", "8"}, {"rows", "2"}, {"settling", "60000"}, {"steps", "1000"}}));
    on_ranks(2, "6000");
    return;
  }
  rows.push_back(bed_row("no drum", {}));
  const auto with_drum = [&](const std::string &name, const Variables &more) {
    Variables variables = {{"drum_mass", "100"},
                           {"settling", "600000"}}; // with friction 10 it swings for seconds
    variables.insert(variables.end(), more.begin(), more.end());
    rows.push_back(bed_row(name, variables));
  };
  with_drum("a drum of 100 kg", {});
  with_drum("friction 0", {{"friction", "0"}});
  with_drum("friction 10", {{"friction", "10"}});
  with_drum("radii 1:30", {{"drum_radius", "0.6"}});
  with_drum("D = 10", {{"D", "10"}});
  Extreme heavy = bed_row("a drum 2e4 times heavier than a soil ball",
                          {{"drum_mass", "1776"}, {"settling", "400000"}, {"D", "2"}});
  heavy.allowed = 1e-2; // it still rocks a little
  rows.push_back(heavy);
  for (const int ranks : {2, 4})
    on_ranks(ranks, "60000");
}

} // namespace drumlin::post
