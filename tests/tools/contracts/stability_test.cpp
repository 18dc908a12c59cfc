// `drumlin study stability --quick`: the acceptance criteria are met, and an interrupted call continues to
// the same result.
#include "tests/support/page.h"
#include "tests/support/scratch_study.h"

#include "lab/stability/map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

/// The rows of a file as text, in order of their keys.
template <class Row>
std::vector<std::vector<std::string>> cells_of(const fs::path &file, const post::CsvSchema<Row> &schema) {
  std::vector<std::vector<std::string>> cells;
  for (const Row &row : post::read_points(file, schema))
    cells.push_back(schema.cells(row));
  std::sort(cells.begin(), cells.end());
  return cells;
}

TEST(StabilityStudy, ContinuesWhereItWasInterrupted) {
  const ScratchStudy study("stability");
  const fs::path out = study.out();
  study.run();
  const auto map = cells_of(out / "map.csv", post::map_rows());
  EXPECT_EQ(map.size(), 18u);
  interrupt(out / "map.csv");
  fs::remove(out / "index.html");
  const post::Outcome rest = study.run();
  EXPECT_LT(std::count(rest.output.begin(), rest.output.end(), '\n'), 40) << "nothing is measured twice";
  EXPECT_EQ(cells_of(out / "map.csv", post::map_rows()), map);
  expect_sound_page(out, 1);

  // The boundaries by theory: 2 and 1.414 for the springs; stock 2 (sqrt(1 + D^2) - D) for one contact.
  for (const post::MapRow &row : post::read_points(out / "map.csv", post::map_rows())) {
    const double n = row.scene == "one" ? 1.0 : 2.0; // two walls in `two` and `hertz_two`
    const double damped = row.stepping == "stock" ? row.D : 0.0;
    const double limit = 2.0 / (n * damped + std::sqrt(n * n * damped * damped + n));
    EXPECT_NEAR(row.stable, limit, 0.01 * limit) << row.scene << ' ' << row.stepping << ' ' << row.D;
  }
}

} // namespace
} // namespace drumlin::test
