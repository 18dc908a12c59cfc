#pragma once
// What the loop over contacts reads of each ball, in rows of four numbers. A row is loaded with one
// instruction, and four rows are turned into four columns by instructions that need no memory.

#include "engine.h"
#include "physics/scheme/contact_block.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace drumlin {

/// Four numbers that one instruction loads, adds or multiplies, where the processor can.
using Four = double __attribute__((vector_size(32)));

/// The columns of four rows: column[0] has the first number of each.
struct Columns {
  Four column[4];
};

/// Turns four rows into columns.
[[gnu::always_inline]] inline void turn(Columns &to, const Four &a, const Four &b, const Four &c,
                                        const Four &d) {
  const Four ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Four ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Four cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Four cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  to.column[0] = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  to.column[1] = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  to.column[2] = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  to.column[3] = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

/// Reads four rows of four numbers, at the addresses `row(0)` to `row(3)`, and stores them by columns: the
/// first numbers of all rows, then the second ones, and so on. The addresses need not be multiples of 32
/// bytes.
template <class Row>
[[gnu::always_inline]] inline void load_columns(Columns &to, const Row &row) {
  Four a, b, c, d;
  std::memcpy(&a, row(0), sizeof a);
  std::memcpy(&b, row(1), sizeof b);
  std::memcpy(&c, row(2), sizeof c);
  std::memcpy(&d, row(3), sizeof d);
  turn(to, a, b, c, d);
}

/// Places and motion of owned balls and ghosts in a step.
class BallRows {
public:
  struct alignas(32) Place {
    double x[3], radius;
  };
  struct alignas(64) Motion {
    double v[3], mass, omega[3], type;
  };

  /// Copies them from the engine. \param mass function of a ball's index: its mass, kg, below 0 if it is
  /// frozen
  template <class Mass>
  void fill(const LAMMPS_NS::Atom &atom, const Mass &mass) {
    const int balls = atom.nlocal + atom.nghost;
    if (static_cast<std::size_t>(balls) >= places_.size()) {
      places_.resize(static_cast<std::size_t>(atom.nmax) + 1);
      motions_.resize(static_cast<std::size_t>(atom.nmax) + 1);
    }
    const double *x = atom.x[0], *v = atom.v[0], *omega = atom.omega[0];
    Place *place = places_.data();
    Motion *motion = motions_.data();
    for (int i = 0; i < balls; ++i, ++place, ++motion, x += 3, v += 3, omega += 3) {
      *place = {{x[0], x[1], x[2]}, atom.radius[i]};
      *motion = {
          {v[0], v[1], v[2]}, mass(i), {omega[0], omega[1], omega[2]}, static_cast<double>(atom.type[i])};
    }
    places_[static_cast<std::size_t>(balls)] = {{0.0, 0.0, 0.0}, 0.0}; // touches nothing, not even itself
  }

  const Place *places() const { return places_.data(); }
  const Motion *motions() const { return motions_.data(); }

private:
  std::vector<Place> places_;
  std::vector<Motion> motions_;
};

/// A contact of a block.
struct BlockContact {
  int i, j;        ///< j < 0: a wall
  int pair;        ///< its number in the list of pairs
  bool touches;    ///< false in the step in which the contact ends
  double *history; ///< numbers that the engine stores for the contact, such as the tangential spring; nullptr
                   ///< without any
};

namespace detail {

using FourFlags = std::int64_t __attribute__((vector_size(32)));

inline void store(physics::Numbers &numbers, int n, const Four &four) {
  std::memcpy(numbers.at + n, &four, sizeof four);
}

/// Stores the differences `one` - `other` of the first three columns, the components of vectors.
[[gnu::always_inline]] inline void store_difference(physics::Vectors &to, int n, const Columns &one,
                                                    const Columns &other) {
  store(to.x, n, one.column[0] - other.column[0]);
  store(to.y, n, one.column[1] - other.column[1]);
  store(to.z, n, one.column[2] - other.column[2]);
}
[[gnu::always_inline]] inline void store_vectors(physics::Vectors &to, int n, const Columns &from) {
  store(to.x, n, from.column[0]);
  store(to.y, n, from.column[1]);
  store(to.z, n, from.column[2]);
}

} // namespace detail

/// Writes the motion of the balls of `count` contacts to a block. Writes to the three contacts behind them,
/// too.
/// \param before rows of four numbers, for the second-order scheme: velocity at the start of the step, m/s,
/// and the sum of sqrt(c)/m, which is zero unless `counted` \returns whether all contacts have the same two
/// types of balls
template <bool stepped, class Engine>
DRUMLIN_FOR_THIS_PROCESSOR bool read_balls(physics::ContactBlock &b, const BallRows &rows,
                                           BlockContact *contacts, int count, const double *before,
                                           bool counted) {
  for (int n = count; n % 4 != 0; ++n)
    contacts[n] = contacts[count - 1];
  const BallRows::Place *const places = rows.places();
  const BallRows::Motion *const motions = rows.motions();
  physics::Numbers mi, mj;
  const double type_i = count > 0 ? motions[contacts[0].i].type : 0.0;
  const double type_j = count > 0 ? motions[contacts[0].j].type : 0.0;
  detail::FourFlags others{};
  for (int n = 0; n < count; n += 4) {
    const BlockContact *const four = contacts + n;
    Columns i, j;
    load_columns(i, [&](int c) { return &places[four[c].i]; });
    load_columns(j, [&](int c) { return &places[four[c].j]; });
    detail::store_difference(b.separation, n, i, j);
    detail::store(b.ri, n, i.column[3]);
    detail::store(b.rj, n, j.column[3]);
    load_columns(i, [&](int c) { return motions[four[c].i].v; });
    load_columns(j, [&](int c) { return motions[four[c].j].v; });
    detail::store_difference(b.velocity, n, i, j);
    detail::store(mi, n, i.column[3]);
    detail::store(mj, n, j.column[3]);
    load_columns(i, [&](int c) { return motions[four[c].i].omega; });
    load_columns(j, [&](int c) { return motions[four[c].j].omega; });
    detail::store_vectors(b.wi, n, i);
    detail::store_vectors(b.wj, n, j);
    others |= (i.column[3] != type_i) | (j.column[3] != type_j);
    if constexpr (stepped) {
      load_columns(i, [&](int c) { return before + static_cast<std::ptrdiff_t>(four[c].i) * 4; });
      load_columns(j, [&](int c) { return before + static_cast<std::ptrdiff_t>(four[c].j) * 4; });
      detail::store_difference(b.velocity_before, n, i, j);
      detail::store(b.damping_over_mass, n, counted ? i.column[3] + j.column[3] : Four{});
    }
  }
  DRUMLIN_INDEPENDENT_CONTACTS
  for (int n = 0; n < count; ++n) {
    b.squared[n] = physics::dot(b.separation[n], b.separation[n]);
    const double one = mi[n], other = mj[n];
    const double both = Engine::effective_mass(std::fabs(one), std::fabs(other));
    b.m_eff[n] = other < 0.0 ? std::fabs(one) : one < 0.0 ? other : both;
  }
  return (others[0] | others[1] | others[2] | others[3]) == 0;
}

} // namespace drumlin
