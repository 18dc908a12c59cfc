#pragma once
// What a contact remembers from one time step to the next, and where in its history each number is.

#include <array>
#include <cstddef>
#include <utility>

namespace drumlin {

/// What the plugin's contacts can remember.
enum class Remembered { spring, rolling_spring, stiffness, memory, force, touches };

struct RememberedNumbers {
  std::array<const char *, 3> names; ///< as LIGGGHTS has them; nullptr behind the last
  bool turns_round;                  ///< whether their signs change when the balls change places
  std::size_t count() const { return names[1] == nullptr ? 1 : 3; }
};

/// The one list of what can be remembered, in the order of `Remembered`.
constexpr std::array<RememberedNumbers, 6> remembered_numbers{{
    {{"shearx", "sheary", "shearz"}, true},                      // m, spring of friction
    {{"r_torquex_old", "r_torquey_old", "r_torquez_old"}, true}, // N m, torque of rolling resistance
    {{"tangential_stiffness"}, false}, // N/m, where it varies and a spring depends on it
    {{"law_memory"}, false},           // of a law that remembers: see physics::ContactLaw
    {{"normal_force"}, false},         // N, that acted in the step; second-order scheme only
    {{"touches"}, false},              // 1: the balls touch; 0: they do not
}};

constexpr const RememberedNumbers &numbers_of(Remembered what) {
  return remembered_numbers[static_cast<std::size_t>(what)];
}

/// Where in the history of a contact its numbers are.
class HistoryPlaces {
public:
  /// The place of the first number; below 0: it is not stored.
  int operator[](Remembered what) const { return first_[static_cast<std::size_t>(what)]; }
  /// Numbers in all.
  int count() const { return count_; }
  /// Whether the sign of a number changes when the balls change places.
  bool turns_round(int place) const {
    for (std::size_t n = 0; n < first_.size(); ++n)
      if (first_[n] >= 0 && place >= first_[n] && place < first_[n] + length(n))
        return remembered_numbers[n].turns_round;
    return false;
  }

  /// Stores it behind what is stored already.
  void add(Remembered what) {
    const auto n = static_cast<std::size_t>(what);
    first_[n] = count_;
    count_ += length(n);
  }

private:
  static int length(std::size_t n) { return static_cast<int>(remembered_numbers[n].count()); }

  std::array<int, remembered_numbers.size()> first_{-1, -1, -1, -1, -1, -1};
  int count_ = 0;
};

} // namespace drumlin
