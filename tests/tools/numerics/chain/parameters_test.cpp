// Parameters of the chain and the published values of its cases.
#include "chain/analysis.h"
#include "chain/parameters.h"
#include "files/roller.h"
#include "report/chain/reference_values.h"
#include "support/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <regex>
#include <stdexcept>
#include <string>

namespace {

using namespace drumlin::post;

// The cases and the defaults are those of the decks in inputs/chain, whose text is read here; those of
// rollers agree with the data sheets of the machines.
namespace parameters {

/// The value of an index variable of a deck, or the default of a declared one: a number, or the number of
/// $(NUMBER*PI) times pi.
double deck_value(const std::string &deck, const std::string &name) {
  const std::string text = read_text(std::filesystem::path(DRUMLIN_SOURCE_DIR) / "inputs/chain" / deck);
  std::smatch match;
  const std::regex line("(?:^|\n)(?:variable +)?" + name +
                        R"( +(?:index +)?(?:\$\(([0-9.]+)\*PI\)|([0-9.e]+)))");
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
  EXPECT_EQ(p.Fw, deck_value("variables", "Fw"));
  EXPECT_EQ(p.m2, deck_value("variables", "m2"));
  EXPECT_EQ(p.m3, deck_value("variables", "m3"));
  EXPECT_EQ(p.k23, deck_value("variables", "k23"));
  EXPECT_EQ(p.c23, deck_value("variables", "c23"));
  EXPECT_EQ(p.g, deck_value("variables", "g"));
  const ChainParameters second = table1_case("II", Transition::B);
  for (const ChainNumber &number : chain_numbers)
    EXPECT_EQ(p.*number.value, second.*number.value) << number.name;
  EXPECT_EQ(p.transition, second.transition);
}

// What the data sheets of the machines say, besides what is in their files.
struct Sheet {
  const char *machine, *setting;
  double frequency;   // Hz
  double force;       // centrifugal force, kN
  double force_digit; // half a unit of its last digit, kN
  double amplitude;   // nominal, mm
  double amplitude_digit;
  double load; // on the drum: static linear load times width, kg
};
constexpr std::array<Sheet, 7> sheets = {
    {{"BW120", "63Hz", 63.0, 36.0, 0.5, 0.50, 0.005, 11.3 * 120.0},
     {"BW120", "67Hz", 67.0, 41.0, 0.5, 0.50, 0.005, 11.3 * 120.0},
     {"CA3500", "high", 31.0, 280.0, 0.5, 1.9, 0.05, 36.0 * 213.0},
     {"CA3500", "low", 34.0, 170.0, 0.5, 0.9, 0.05, 36.0 * 213.0},
     {"CA6500", "high", 29.0, 360.0, 0.5, 2.1, 0.05, 65.0 * 213.0},
     {"CA6500", "low", 30.0, 150.0, 0.5, 0.8, 0.05, 65.0 * 213.0},
     {"Axas2020", "29Hz", 29.0, 242.7, 0.05, 7.31 / 3.96207, 1e-3, 72.02e3 / 9.81}}};

TEST(Rollers, AgreeWithTheirDataSheets) {
  for (const Sheet &sheet : sheets) {
    SCOPED_TRACE(std::string(sheet.machine) + " " + sheet.setting);
    const std::string file =
        (std::filesystem::path(DRUMLIN_SOURCE_DIR) / "inputs/rollers" / sheet.machine).string();
    const drumlin::Roller roller = drumlin::read_roller(file);
    const drumlin::RollerSetting &setting = drumlin::setting_of(roller, sheet.setting, file);
    ChainParameters p = table1_case("II", Transition::B);
    set_machine(p, roller, setting);
    EXPECT_NEAR(1.0 / p.period(), sheet.frequency, 1e-9);
    EXPECT_NEAR(p.Fw / 1e3, sheet.force, sheet.force_digit);
    EXPECT_NEAR(1e3 * setting.me_re / p.m2, sheet.amplitude, sheet.amplitude_digit);
    EXPECT_NEAR(p.m2 + p.m3, sheet.load, 1.0);
    EXPECT_EQ(p.k23, roller.k23);
    EXPECT_EQ(p.c23, roller.c23);
    EXPECT_EQ(p.k, 1e8); // the soil stays
    EXPECT_EQ(p.invalid(), "");
  }
}

} // namespace parameters

// The reference values are complete, and the closed form gives the restitutions that the reference gives as
// numbers.
namespace reference {

TEST(ReferenceValues, HaveSevenForEveryCaseAndTransitionAndThreeMeterValues) {
  for (const char *name : {"I", "II", "III", "IV"})
    for (const char *transition : {"A", "B"}) {
      const auto count = std::count_if(
          reference_values().begin(), reference_values().end(), [&](const ReferenceValue &value) {
            return value.case_name == name && value.transition == transition &&
                   value.quantity != "meter value CMV" && !std::isnan(value.tolerance);
          });
      EXPECT_EQ(count, 7) << name << transition;
    }
  EXPECT_EQ(reference_values().size(), 8u * 7u + 3u + 7u + 30u); // restitutions, velocity errors
}

TEST(ReferenceValues, HaveUnitToleranceAndSource) {
  for (const ReferenceValue &value : reference_values()) {
    EXPECT_LE(value.low, value.high);
    EXPECT_FALSE(value.tolerance < 0.0);
    EXPECT_FALSE(value.source.empty());
  }
}

TEST(Restitution, ClosedFormGivesTheNumbersGiven) {
  std::size_t given = 0;
  for (const ReferenceValue &reference : reference_values()) {
    if (reference.quantity != "restitution") continue;
    ++given;
    const double D = std::stod(reference.case_name.substr(2)); // "D=0.2"
    EXPECT_NEAR(closed_form_restitution(reference.transition, D), reference.low, 0.5e-6)
        << reference.transition << " " << reference.case_name;
  }
  EXPECT_EQ(given, 7U);
}

TEST(Restitution, OfBIsContinuousAtItsBranches) {
  for (const double D : {1.0 / std::sqrt(2.0), 1.0}) {
    const double step = 1e-6;
    EXPECT_NEAR(closed_form_restitution("B", D - step), closed_form_restitution("B", D), 2 * step);
    EXPECT_NEAR(closed_form_restitution("B", D + step), closed_form_restitution("B", D), 2 * step);
  }
  EXPECT_DOUBLE_EQ(closed_form_restitution("A", 0.0), 1.0);
  EXPECT_DOUBLE_EQ(closed_form_restitution("B", 0.0), 1.0);
  EXPECT_DOUBLE_EQ(closed_form_restitution("A", 1.0), 0.0);
}

TEST(VelocityErrors, AreFoundForTheTablesStepsOnly) {
  const auto known = [](const char *name, int steps, const char *stepping) {
    return reference_value(
        name, "B", "velocity error at " + std::to_string(steps) + " steps, " + stepping + " stepping");
  };
  ASSERT_NE(known("II", 1600, "second"), nullptr);
  EXPECT_EQ(known("II", 1600, "second")->low, 6.5e-6);
  ASSERT_NE(known("II", 200, "stock"), nullptr);
  EXPECT_EQ(known("II", 200, "stock")->low, 1.8e-2);
  EXPECT_EQ(known("II", 2000, "second"), nullptr);
  EXPECT_EQ(known("III", 200, "stock"), nullptr);
}

} // namespace reference

} // namespace
