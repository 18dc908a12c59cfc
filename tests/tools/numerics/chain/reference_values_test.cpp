// The reference values are complete, and the closed form gives the restitutions that the reference gives as
// numbers.
#include "chain/reference_values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace drumlin::post;

TEST(ReferenceValues, HaveSevenForEveryCaseAndTransitionAndThreeMeterValues) {
  for (const char *name : {"I", "II", "III", "IV"})
    for (const char *transition : {"A", "B"}) {
      const auto count = std::count_if(reference_values().begin(), reference_values().end(),
                                       [&](const ReferenceValue &value) {
                                         return value.case_name == name && value.transition == transition &&
                                                value.quantity != ReferenceQuantity::compaction_meter_value;
                                       });
      EXPECT_EQ(count, 7) << name << transition;
    }
  EXPECT_EQ(reference_values().size(), 8u * 7u + 3u);
}

TEST(ReferenceValues, HaveUnitToleranceAndSource) {
  for (const ReferenceValue &value : reference_values()) {
    EXPECT_LE(value.low, value.high);
    EXPECT_GE(value.tolerance, 0.0);
    EXPECT_FALSE(value.source.empty());
    EXPECT_GT(value.scale, 0.0);
  }
}

TEST(Restitution, ClosedFormGivesTheNumbersGiven) {
  ASSERT_EQ(reference_restitutions().size(), 7u);
  for (const ReferenceRestitution &reference : reference_restitutions())
    EXPECT_NEAR(closed_form_restitution(reference.transition, reference.damping_ratio), reference.restitution,
                0.5e-6)
        << reference.transition << " D = " << reference.damping_ratio;
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
  EXPECT_DOUBLE_EQ(reference_velocity_error("II", 1600).value(), 6.5e-6);
  EXPECT_DOUBLE_EQ(reference_stock_velocity_error("II", 200).value(), 1.8e-2);
  EXPECT_FALSE(reference_velocity_error("II", 2000));
  EXPECT_FALSE(reference_stock_velocity_error("III", 200));
}

} // namespace
