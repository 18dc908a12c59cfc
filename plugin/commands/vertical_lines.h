#pragma once
// Vertical lines through the box, on which the height of the surface of a bed is measured.

#include "support/arguments.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <limits>
#include <vector>

namespace drumlin {

/// The middles of equal intervals of one side of the box.
struct Positions {
  double low;     ///< m, lower end of the side
  double spacing; ///< m, length of an interval
  int count;
  bool periodic;

  double at(int n) const {
    return low + (static_cast<double>(n) + 0.5) * spacing; // beyond the box for a periodic image
  }
  /// Number of the first one that is not below a coordinate; negative below the box.
  int first_from(double coordinate) const {
    const auto n = static_cast<int>(std::ceil((coordinate - low) / spacing - 0.5));
    return periodic ? n : std::max(n, 0);
  }
  bool holds(int n) const { return periodic || n < count; }
  /// Number n brought back into the box, if it lies beyond a periodic side.
  int image(int n) const { return ((n % count) + count) % count; }
};

/// Vertical lines through the box, and the highest point at which each meets a ball of a group.
class VerticalLines {
public:
  VerticalLines(LAMMPS_NS::LAMMPS *engine, Arguments &in, double spacing)
      : engine_(engine), x_(positions(in, 0, spacing)),
        z_(engine->domain->dimension == 2 ? Positions{-0.5 * spacing, spacing, 1, false}
                                          : positions(in, 2, spacing)) {
    if (static_cast<double>(x_.count) * z_.count > most_lines)
      in.fail("keyword spacing", fmt::format("{:g}", spacing),
              fmt::format("a spacing of at most {:g} lines in the box", most_lines));
  }

  /// Mean of the highest points of the balls for which counts(i) is true, over those lines that meet one and
  /// are at least `beyond` away from `middle` along x. NaN if there is none. Collective.
  template <class Counts>
  double mean_height(const Counts &counts, double middle = 0.0, double beyond = 0.0) const {
    constexpr double none = -std::numeric_limits<double>::max();
    std::vector<double> mine(index(x_.count, 0), none);
    const LAMMPS_NS::Atom &atom = *engine_->atom;
    for (int i = 0; i < atom.nlocal; ++i)
      if (counts(i)) raise(atom.x[i], atom.radius[i], mine);
    std::vector<double> highest(mine.size());
    MPI_Allreduce(mine.data(), highest.data(), static_cast<int>(mine.size()), MPI_DOUBLE, MPI_MAX,
                  engine_->world);
    double sum = 0.0;
    double lines = 0.0;
    for (int n = 0; n < x_.count; ++n) {
      if (std::fabs(x_.at(n) - middle) < beyond) continue;
      for (int m = 0; m < z_.count; ++m) {
        const double height = highest[index(n, m)];
        if (height == none) continue;
        sum += height;
        lines += 1.0;
      }
    }
    return lines > 0.0 ? sum / lines : std::numeric_limits<double>::quiet_NaN();
  }

private:
  static constexpr double most_lines = 1e7;

  /// Where the height of a line is stored.
  std::size_t index(int n, int m) const {
    return static_cast<std::size_t>(n) * static_cast<std::size_t>(z_.count) + static_cast<std::size_t>(m);
  }

  Positions positions(Arguments &in, int axis, double spacing) const {
    const LAMMPS_NS::Domain &domain = *engine_->domain;
    const double length = domain.boxhi[axis] - domain.boxlo[axis];
    const double count = std::max(1.0, std::round(length / spacing));
    if (count > most_lines)
      in.fail("keyword spacing", fmt::format("{:g}", spacing),
              fmt::format("a spacing of at most {:g} lines in the box", most_lines));
    return {domain.boxlo[axis], length / count, static_cast<int>(count), domain.periodicity[axis] != 0};
  }

  /// Raises the heights of all lines that meet a ball to its upper surface.
  void raise(const double *centre, double radius, std::vector<double> &heights) const {
    for (int n = x_.first_from(centre[0] - radius); x_.holds(n); ++n) {
      const double across = x_.at(n) - centre[0];
      const double left = radius * radius - across * across; // m2, of the section at this x, a disc
      if (across > radius) break;
      if (left < 0.0) continue;
      const double section = std::sqrt(left);
      for (int m = z_.first_from(centre[2] - section); z_.holds(m); ++m) {
        const double along = z_.at(m) - centre[2];
        if (along > section) break;
        const double rise = std::sqrt(std::max(0.0, left - along * along));
        double &height = heights[index(x_.image(n), z_.image(m))];
        height = std::max(height, centre[1] + rise);
      }
    }
  }

  LAMMPS_NS::LAMMPS *engine_;
  Positions x_, z_;
};

} // namespace drumlin
