#include "bed/coarse_graining.h"

#include "support/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace drumlin::post {

namespace {

/// How a position along one axis is shared by two cells, which are the same cell at the edge.
struct Pair {
  std::array<std::size_t, 2> cell;
  std::array<double, 2> share;
};

/// Calls visit(cell, share) for the cells that share a position.
template <class Visit>
void share_out(const FieldGrid &grid, const Vector &place, const Visit &visit) {
  const std::size_t axes = grid.flat ? 2 : 3;
  std::array<Pair, 3> pairs;
  pairs.fill({{0, 0}, {1.0, 0.0}});
  for (std::size_t a = 0; a < axes; ++a) {
    const double cells = static_cast<double>(grid.cells[a]);
    const double along = (place[a] - grid.origin[a]) / grid.sides[a];
    if (!(along >= 0.0 && along <= cells)) return;
    const double from_first = std::max(0.0, along - 0.5);
    const double lower = std::floor(from_first);
    const auto cell = static_cast<std::size_t>(lower);
    pairs[a] = {{cell, std::min(cell + 1, grid.cells[a] - 1)},
                {1.0 - (from_first - lower), from_first - lower}};
  }
  for (std::size_t z = 0; z < 2; ++z)
    for (std::size_t y = 0; y < 2; ++y)
      for (std::size_t x = 0; x < 2; ++x) {
        const double share = pairs[0].share[x] * pairs[1].share[y] * pairs[2].share[z];
        if (share > 0.0)
          visit((pairs[2].cell[z] * grid.cells[1] + pairs[1].cell[y]) * grid.cells[0] + pairs[0].cell[x],
                share);
      }
}

/// Adds factor a_i b_j.
void add_product(Tensor &sum, double factor, const Vector &a, const Vector &b) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      sum[3 * i + j] += factor * a[i] * b[j];
}

template <class Values>
void divide(Values &values, double by) {
  for (double &value : values)
    value = by > 0.0 ? value / by : 0.0;
}

double volume(const Ball &ball, bool flat) {
  const double r = ball.radius;
  return flat ? pi * r * r : 4.0 / 3.0 * pi * r * r * r;
}

/// Parts of a force along a vector of any length, and across it.
ForceParts parts_along(const Vector &l, const Vector &f) {
  const double length = std::hypot(l[0], l[1], l[2]);
  if (length == 0.0) return {};
  const double normal = (f[0] * l[0] + f[1] * l[1] + f[2] * l[2]) / length;
  const double per_length = normal / length;
  return {normal, std::hypot(f[0] - per_length * l[0], f[1] - per_length * l[1], f[2] - per_length * l[2])};
}

std::vector<BallContact> among_soil(const std::vector<Ball> &balls,
                                    const std::vector<BallContact> &contacts) {
  std::vector<BallContact> soil;
  std::copy_if(contacts.begin(), contacts.end(), std::back_inserter(soil),
               [&balls](const BallContact &contact) {
                 return is_soil(balls[contact.i].type) && is_soil(balls[contact.j].type);
               });
  return soil;
}

} // namespace

bool in_a_plane(const std::vector<Ball> &balls) {
  return std::all_of(balls.begin(), balls.end(), [](const Ball &ball) { return ball.position[2] == 0.0; });
}

std::vector<int> coordination(std::size_t balls, const std::vector<BallContact> &contacts) {
  std::vector<int> counts(balls, 0);
  for (const BallContact &contact : contacts) {
    ++counts[contact.i];
    ++counts[contact.j];
  }
  return counts;
}

std::vector<double> ball_pressures(const std::vector<Ball> &balls, const BedContacts &contacts) {
  std::vector<double> pressures(balls.size(), 0.0);
  for (const BallContact &contact : contacts.balls) {
    const double normal =
        force_parts(contact)
            .normal; // for either ball -f . r = normal force times distance from its centre to the contact
    for (const std::size_t b : {contact.i, contact.j})
      pressures[b] += normal * (balls[b].radius - 0.5 * contact.overlap);
  }
  for (const WallContact &contact : contacts.walls)
    pressures[contact.i] += force_parts(contact).normal * (balls[contact.i].radius - contact.overlap);
  const bool flat = in_a_plane(balls);
  for (std::size_t b = 0; b < balls.size(); ++b)
    pressures[b] /= (flat ? 2.0 : 3.0) * volume(balls[b], flat);
  return pressures;
}

Vector foot(const Ball &ball, const WallContact &contact) {
  const double arm = ball.radius - contact.overlap;
  const Vector &x = ball.position, &n = contact.normal;
  return {x[0] - arm * n[0], x[1] - arm * n[1], x[2] - arm * n[2]};
}

ForceParts force_parts(const BallContact &contact) { return parts_along(contact.branch, contact.force); }

ForceParts force_parts(const WallContact &contact) { return parts_along(contact.normal, contact.force); }

void Bounds::add(const Ball &ball) {
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = std::min(low[a], ball.position[a] - ball.radius);
    high[a] = std::max(high[a], ball.position[a] + ball.radius);
  }
}

FieldGrid fitted_grid(const Bounds &bounds, double side, bool flat) {
  FieldGrid grid;
  grid.flat = flat;
  grid.origin = bounds.low;
  if (flat) grid.origin[2] = 0.0;
  double size = 1.0;
  for (std::size_t a = 0; a < (flat ? 2U : 3U); ++a) {
    const double extent = bounds.high[a] - bounds.low[a];
    const double cells = std::max(1.0, std::round(extent / side));
    size *= cells;
    if (!(size <= largest_grid))
      throw std::invalid_argument(
          fmt::format("the grid would have more than {:g} cells of {} m", largest_grid, side));
    grid.cells[a] = static_cast<std::size_t>(cells);
    grid.sides[a] = extent / cells;
  }
  return grid;
}

BedFields coarse_grained(const std::vector<Ball> &balls, const std::vector<BallContact> &contacts,
                         const FieldGrid &grid) {
  BedFields fields;
  const std::size_t size = grid.size();
  fields.solid_fraction.resize(size);
  fields.bulk_density.resize(size);
  fields.velocity.resize(size);
  fields.coordination.resize(size);
  fields.stress.resize(size);
  fields.pressure.resize(size);
  fields.fabric.resize(size);
  std::vector<double> ball_shares(size), contact_shares(size);

  const std::vector<BallContact> soil_contacts = among_soil(balls, contacts);
  const std::vector<int> counts = coordination(balls.size(), soil_contacts);
  for (std::size_t b = 0; b < balls.size(); ++b) {
    const Ball &ball = balls[b];
    if (!is_soil(ball.type)) continue;
    share_out(grid, ball.position, [&](std::size_t cell, double share) {
      ball_shares[cell] += share;
      fields.solid_fraction[cell] += share * volume(ball, grid.flat);
      fields.bulk_density[cell] += share * ball.mass;
      fields.coordination[cell] += share * counts[b];
      for (std::size_t a = 0; a < 3; ++a)
        fields.velocity[cell][a] += share * ball.mass * ball.velocity[a];
    });
  }
  for (const BallContact &contact : soil_contacts) {
    const Ball &i = balls[contact.i];
    const Vector &l = contact.branch;
    const double length = std::hypot(l[0], l[1], l[2]);
    if (length == 0.0) continue;
    const double to_middle =
        (i.radius - 0.5 * contact.overlap) / length; // from the centre of i, as a share of l
    Vector place, normal;
    for (std::size_t a = 0; a < 3; ++a) {
      place[a] = i.position[a] - to_middle * l[a];
      normal[a] = l[a] / length;
    }
    share_out(grid, place, [&](std::size_t cell, double share) {
      contact_shares[cell] += share;
      add_product(fields.stress[cell], share, contact.force, l);
      add_product(fields.fabric[cell], share, normal, normal);
    });
  }
  for (std::size_t cell = 0; cell < size; ++cell) {
    divide(fields.velocity[cell], fields.bulk_density[cell]);
    divide(fields.fabric[cell], contact_shares[cell]);
    fields.coordination[cell] = ball_shares[cell] > 0.0 ? fields.coordination[cell] / ball_shares[cell] : 0.0;
    fields.solid_fraction[cell] /= grid.cell_volume();
    fields.bulk_density[cell] /= grid.cell_volume();
    Tensor &stress = fields.stress[cell];
    divide(stress, grid.cell_volume());
    fields.pressure[cell] =
        grid.flat ? (stress[0] + stress[4]) / 2.0 : (stress[0] + stress[4] + stress[8]) / 3.0;
  }
  return fields;
}

} // namespace drumlin::post
