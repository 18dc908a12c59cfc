#include "map/meter_study.h"

#include "engine/places.h"
#include "files/roller.h"
#include "map/course.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace {

/// The rollers of the study: case of Table 1, or MACHINE-SETTING of a file in inputs/rollers, and title.
constexpr std::array<std::pair<const char *, const char *>, 9> soil_rollers = {
    {{"II", "paper, 20 Hz"},
     {"III", "paper, 40 Hz"},
     {"BW120-63Hz", "BW 120, 63 Hz"},
     {"BW120-67Hz", "BW 120, 67 Hz"},
     {"CA3500-high", "CA3500, high amplitude"},
     {"CA3500-low", "CA3500, low amplitude"},
     {"CA6500-high", "CA6500, high amplitude"},
     {"CA6500-low", "CA6500, low amplitude"},
     {"Axas2020-29Hz", "Axas 2020, 29 Hz"}}};

} // namespace

SoilMachine soil_machine(const std::string &roller) {
  const std::size_t dash = roller.find('-');
  if (dash == std::string::npos) return {table1_case(roller, Transition::B), {}, {}};
  const std::string file = (places().inputs / "rollers" / roller.substr(0, dash)).string();
  const Roller machine = read_roller(file);
  SoilMachine soil = {table1_case("II", Transition::B), machine.width, machine.diameter};
  set_machine(soil.chain, machine, setting_of(machine, roller.substr(dash + 1), file));
  return soil;
}

void run_meter_study(const std::filesystem::path &out, bool quick) {
  const MapAxis axis = {"k", 1e6, 200e6, quick ? 8 : 41, true};
  std::vector<CourseChain> chains;
  std::vector<CourseRoller> rollers;
  for (const auto &[name, title] : soil_rollers) {
    if (quick && name != std::string(soil_rollers.back().first)) continue;
    const SoilMachine machine = soil_machine(name);
    CourseChain chain;
    chain.roller = name;
    chain.chain = [machine](double k) {
      ChainParameters p = machine.chain;
      p.k = k;
      return p;
    };
    if (machine.diameter && machine.width)
      chain.setting.drum = {0.5 * *machine.diameter, *machine.width, usual_poisson};
    chains.push_back(std::move(chain));
    rollers.push_back({name, title});
  }
  constexpr int threads = 2;
  const std::vector<CoursePoint> points = course_points(out / "records.csv", axis, chains, threads);
  write_soil_page(out, rollers, axis, points);
  fmt::print("{}\n", (out / "index.html").string());
}

} // namespace drumlin::post
