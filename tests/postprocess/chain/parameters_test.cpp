// The cases of Table 1 and the defaults are those of the decks in inputs/chain, whose text is read here.
#include "chain/parameters.h"

#include "support/files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <regex>
#include <stdexcept>
#include <string>

namespace {

using namespace drumlin::post;

/// The value of an index variable of a deck: a number, or one in the form $(NUMBER*PI).
double deck_value(const std::string &deck, const std::string &name) {
  const std::string text = read_text(std::filesystem::path(DRUMLIN_SOURCE_DIR) / "inputs/chain" / deck);
  std::smatch match;
  const std::regex line("(?:^|\n)variable +" + name + R"( +index +(?:\$\(([0-9.]+)\*PI\)|([0-9.e]+)))");
  if (!std::regex_search(text, match, line)) throw std::runtime_error(deck + " has no variable " + name);
  return match[1].matched ? std::stod(match[1]) * std::acos(-1.0) : std::stod(match[2]);
}

TEST(Table1, IsWhatTheDecksHave) {
  for (const std::string name : table1_cases) {
    const ChainParameters p = table1_case(name, Transition::A);
    EXPECT_EQ(p.k, deck_value("case." + name, "k")) << name;
    EXPECT_EQ(p.D, deck_value("case." + name, "D")) << name;
    EXPECT_DOUBLE_EQ(p.omega, deck_value("case." + name, "omega")) << name;
    EXPECT_EQ(p.transition, Transition::A);
  }
  EXPECT_THROW(table1_case("V", Transition::B), std::invalid_argument);
}

TEST(Table1, DefaultsAreThoseOfTheDeck) {
  const ChainParameters p;
  EXPECT_EQ(p.Fw, deck_value("parameters", "Fw"));
  EXPECT_EQ(p.m2, deck_value("parameters", "m2"));
  EXPECT_EQ(p.m3, deck_value("parameters", "m3"));
  EXPECT_EQ(p.k23, deck_value("parameters", "k23"));
  EXPECT_EQ(p.c23, deck_value("parameters", "c23"));
  EXPECT_EQ(p.g, deck_value("parameters", "g"));
  const ChainParameters second = table1_case("II", Transition::B);
  for (const ChainNumber &number : chain_numbers)
    EXPECT_EQ(p.*number.value, second.*number.value) << number.name;
  EXPECT_EQ(p.transition, second.transition);
}

} // namespace
