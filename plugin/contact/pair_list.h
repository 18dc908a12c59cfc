#pragma once
// Finds the balls that touch, among the pairs of a neighbour list.

#include "contact/ball_rows.h"
#include "engine.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace drumlin {

/// A pair of balls of a neighbour list.
struct Pair {
  int i, j;
  int place; ///< position of j among the neighbours of i
};

/// Which pairs find_touching() has found.
struct Found {
  int count = 0;
  std::uint64_t changed = 0; ///< bit n: the contact of the n-th of them begins or ends
};

namespace detail {

/// For each set of four pairs, as a sum of 1, 2, 4 and 8: its members, one after the other, and for each set
/// of pairs among them, where they stand in that order, as a sum of 1 for the first place, 2 for the second,
/// and so on.
struct Members {
  std::int32_t at[16][4];
  int count[16];
  std::uint8_t places[16][16];
};
constexpr Members members_of_sets() {
  Members all{};
  for (int set = 0; set < 16; ++set)
    for (int member = 0; member < 4; ++member)
      if ((set >> member & 1) != 0) {
        const int place = all.count[set]++;
        all.at[set][place] = member;
        for (int some = 0; some < 16; ++some)
          if ((some >> member & 1) != 0)
            all.places[set][some] = static_cast<std::uint8_t>(all.places[set][some] | 1 << place);
      }
  return all;
}
inline constexpr Members members = members_of_sets();

using TwoFlags = std::int64_t __attribute__((vector_size(16)));

} // namespace detail

/// Finds the pairs from number `first` to before `end` that touch, and if `remembers` also those that touched
/// a step ago. It tests four pairs at a time. No branch depends on whether balls touch: the processor would
/// often predict it wrongly, which takes more time than the test itself.
/// \param first, end multiples of 4
/// \param touched for every four pairs, which of them touched a step ago; afterwards, which of them touch now
/// \param found gets the numbers of the pairs that were found, 64 at most; must have room for four more
template <bool remembers>
DRUMLIN_FOR_THIS_PROCESSOR Found find_touching(const BallRows::Place *places, const Pair *pairs, int first,
                                               int end, std::uint8_t *touched, std::int32_t *found) {
  int count = 0;
  std::uint64_t changed = 0;
  for (int n = first; n < end; n += 4) {
    Four apart[4];
    for (int c = 0; c < 4; ++c) {
      Four here, there;
      std::memcpy(&here, &places[pairs[n + c].i], sizeof here);
      std::memcpy(&there, &places[pairs[n + c].j], sizeof there);
      apart[c] = there + here * Four{-1.0, -1.0, -1.0, 1.0}; // x_j - x_i, and the sum of the radii
    }
    Columns d;
    turn(d, apart[0], apart[1], apart[2], apart[3]);
    const Four squared = d.column[0] * d.column[0] + d.column[1] * d.column[1] + d.column[2] * d.column[2];
    const detail::FourFlags touches = (squared < d.column[3] * d.column[3]) & detail::FourFlags{1, 2, 4, 8};
    const detail::TwoFlags two =
        __builtin_shufflevector(touches, touches, 0, 1) | __builtin_shufflevector(touches, touches, 2, 3);
    const int now = static_cast<int>(two[0] | two[1]);
    int set = now;
    if constexpr (remembers) {
      const int before = touched[n / 4];
      touched[n / 4] = static_cast<std::uint8_t>(now);
      set |= before;
      changed |= std::uint64_t{detail::members.places[set][now ^ before]} << count;
    }
    for (int c = 0; c < 4; ++c)
      found[count + c] = n + detail::members.at[set][c];
    count += detail::members.count[set];
  }
  return {count, changed};
}

/// The pairs of a neighbour list one after the other, and which of them touch.
class PairList {
public:
  /// Takes the pairs of the engine's list over if that has been built anew. \param touched function of i and
  /// the place of j in its list: whether the balls touched a step ago
  template <class Touched>
  void follow(const LAMMPS_NS::NeighList &list, const LAMMPS_NS::Neighbor &neighbor, int balls,
              const Touched &touched) {
    if (neighbor.ago != 0 && neighbor.lastcall == built_) return;
    built_ = neighbor.lastcall;
    pairs_.clear();
    touched_.clear();
    for (int ii = 0; ii < list.inum; ++ii) {
      const int i = list.ilist[ii];
      for (int place = 0; place < list.numneigh[i]; ++place) {
        add({i, engine::neighbour_index(list.firstneigh[i][place]), place}, touched(i, place));
      }
    }
    while (pairs_.size() % 4 != 0)
      add({balls, balls, 0}, false); // two balls that do not touch: see BallRows
  }
  /// To be called when contacts were computed without this list.
  void forget() { built_ = -1; }

  const std::vector<Pair> &pairs() const { return pairs_; }
  /// \returns the pairs first to end that touch: see above
  template <bool remembers>
  Found find(const BallRows &rows, int first, int end, std::int32_t *found) {
    return find_touching<remembers>(rows.places(), pairs_.data(), first, end, touched_.data(), found);
  }
  bool touches(int pair) const { return (touched_[static_cast<std::size_t>(pair / 4)] >> pair % 4 & 1) != 0; }

private:
  void add(const Pair &pair, bool touched) {
    const std::size_t c = pairs_.size() % 4;
    if (c == 0) touched_.push_back(0);
    if (touched) touched_.back() = static_cast<std::uint8_t>(touched_.back() | 1U << c);
    pairs_.push_back(pair);
  }

  engine::bigint built_ = -1; // step in which the engine's list was built
  std::vector<Pair> pairs_;
  std::vector<std::uint8_t> touched_;
};

} // namespace drumlin
