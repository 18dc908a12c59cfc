// The reference values are complete, and the closed form gives the restitutions that the reference gives as
// numbers.
#include "chain/analysis.h"
#include "report/chain/reference_values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace drumlin::post;

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

} // namespace
