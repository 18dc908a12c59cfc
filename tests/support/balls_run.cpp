#include "tests/support/balls_run.h"
#include "tests/support/checks.h"

#include <fstream>
#include <initializer_list>
#include <iterator>

namespace drumlin::test {

std::vector<double> BallsRun::series(long id, std::array<double, 3> Ball::*part, std::size_t axis) const {
  std::vector<double> values;
  for (const Frame &frame : frames)
    values.push_back((frame.balls.at(id).*part)[axis]);
  return values;
}

BallsRun run_balls(const Variables &variables, int ranks) {
  const Scratch scratch;
  write_floor(scratch / "floor.stl", 1.5, true);
  const Outcome outcome = well(run_deck(test_deck("balls.in"), variables, scratch.path(), ranks));
  std::ifstream in(scratch / "reaction.txt");
  return {read_dump(scratch / "state.dump"),
          post::read_events(scratch / "events.csv"),
          {std::istream_iterator<double>(in), {}},
          outcome.output};
}

void write_floor(const std::filesystem::path &file, double half_width, bool single) {
  std::ofstream out(file);
  const double w = half_width;
  const auto facet = [&](std::initializer_list<std::array<double, 2>> corners) {
    out << "facet normal 0 0 1\nouter loop\n";
    for (const auto &corner : corners)
      out << "vertex " << corner[0] << ' ' << corner[1] << " 0\n";
    out << "endloop\nendfacet\n";
  };
  out << "solid floor\n";
  if (single) {
    facet({{-w, -w}, {w, -w}, {0, w}});
  } else {
    facet({{-w, -w}, {w, -w}, {w, w}});
    facet({{-w, -w}, {w, w}, {-w, w}});
  }
  out << "endsolid floor\n";
}

std::string vector_text(double x, double y, double z) {
  return number(x) + ' ' + number(y) + ' ' + number(z);
}

} // namespace drumlin::test
