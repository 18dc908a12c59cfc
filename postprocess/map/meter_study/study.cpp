#include "map/meter_study/study.h"

#include "chain/closed_form.h"
#include "engine/places.h"
#include "files/roller.h"
#include "identify/identified_record.h"
#include "map/meter_study/results.h"
#include "meter/values.h"
#include "record/chain_record.h"
#include "support/progress.h"
#include "support/resumed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::post {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int lead = 200;  // cycles before the record, in which the motion settles
constexpr int cycles = 40; // of the record
// So many samples because the sum of the energy over samples is inexact where the drum lands.
constexpr int samples_per_cycle = 1000;

/// The same as a real roller has it: both accelerations have white noise of 1 % of their standard deviation,
/// and the phase of the exciter is off by half a degree.
Record measured_record(Record record, std::uint64_t seed) {
  constexpr double share = 0.01;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (std::vector<double> *signal : {&record.a_drum, &record.a_frame}) {
    const auto n = static_cast<double>(signal->size());
    double mean = 0.0;
    double square = 0.0;
    for (const double value : *signal)
      mean += value / n;
    for (const double value : *signal)
      square += (value - mean) * (value - mean) / n;
    for (double &value : *signal)
      value += share * std::sqrt(square) * normal(random);
  }
  for (std::size_t i = 0; i < record.size(); ++i)
    record.F_excitation[i] = *record.Fw * std::sin(*record.omega * record.time[i] + 0.5 * pi / 180.0);
  return record;
}

FoundStiffness found_in(const Record &record, const RecordSetting &setting) {
  try {
    const MeanInterval k = identify_record(record, setting).whole.law.k;
    return {k.mean, k.half_width};
  } catch (const std::runtime_error &) {
    return {};
  }
}

SoilPoint measure(const std::string &roller, double k, std::uint64_t seed) {
  const SoilMachine machine = soil_machine(roller);
  ChainParameters p = machine.chain;
  p.k = k;
  const ChainHistory history = solve_closed_form(p, cycles, samples_per_cycle, lead).history;
  MeterOptions options;
  options.window = cycles;
  if (machine.diameter && machine.width) {
    options.drum_radius = 0.5 * *machine.diameter;
    options.drum_width = machine.width;
  }
  const MeterWindow w = meter_windows(meter_cycles(chain_record(p, history, 1)), options).back();
  const double none = std::nan("");
  SoilPoint point;
  point.roller = roller;
  point.k = k;
  point.mode = mode_names[static_cast<std::size_t>(w.mode)];
  point.cmv = w.cmv.value_or(none);
  point.rmv = w.rmv.value_or(none);
  point.k_B = w.k_B.value_or(none);
  point.k_1 = w.k_1.value_or(none);
  point.c_1 = w.c_1.value_or(none);
  point.E_vib = w.E_vib.value_or(none);
  point.energy = w.energy.value_or(none);
  point.peak_force = w.peak_force.value_or(none);
  point.contact_share = w.contact_share.value_or(none);
  constexpr int every = 4; // which is enough for identification
  const Record record = chain_record(p, history, every);
  RecordSetting setting;
  setting.window = cycles;
  point.exact = found_in(record, setting);
  setting.accelerations_only = true;
  setting.phase_within = pi / 180.0;
  point.measured = found_in(measured_record(record, seed), setting);
  return point;
}

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
  constexpr double softest = 1e6; // N/m
  constexpr double stiffest = 200e6;
  const int count = quick ? 8 : 41;
  const std::vector<SoilRoller> rollers(quick ? soil_rollers.end() - 1 : soil_rollers.begin(),
                                        soil_rollers.end());
  ResumedTable results(out / "records.csv", soil_points());
  TimedProgress progress;
  std::size_t done = 0;
  for (const SoilRoller &roller : rollers)
    for (int i = 0; i < count; ++i) {
      ++done;
      const double k = softest * std::pow(stiffest / softest, static_cast<double>(i) / (count - 1));
      SoilPoint point;
      point.roller = roller.name;
      point.k = k;
      if (results.has(soil_points().key(point))) continue;
      results.add(soil_points().cells(measure(roller.name, k, done)));
      progress.tell("{} of {} records", done, rollers.size() * static_cast<std::size_t>(count));
    }
  results.finish();
  std::vector<SoilPoint> rows = read_points(results.file(), soil_points());
  std::sort(rows.begin(), rows.end(), [](const SoilPoint &a, const SoilPoint &b) { return a.k < b.k; });
  write_soil_page(out, rows);
  fmt::print("{}\n", (out / "index.html").string());
}

} // namespace drumlin::post
