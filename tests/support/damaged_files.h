// Ways to damage a file: cut, shuffled, swapped, with absurd numbers, with the line ends of another system.
#pragma once

#include <cstddef>
#include <random>
#include <string>

namespace drumlin::test {

/// Random choices that are the same on every machine, unlike those of the distributions of the standard
/// library.
class Choice {
public:
  explicit Choice(unsigned seed) : bits_(seed) {}
  /// 0 to count - 1; 0 if count is 0.
  std::size_t below(std::size_t count) { return count == 0 ? 0 : bits_() % count; }
  template <class Values>
  const auto &of(const Values &values) {
    return values[below(values.size())];
  }

private:
  std::mt19937_64 bits_;
};

/// The text with one fault, of a kind and at a place that are chosen at random.
std::string damaged(const std::string &text, Choice &choice);

} // namespace drumlin::test
