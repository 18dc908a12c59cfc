#include "passes/drive.h"

#include "bed/dump_readers.h"
#include "runs/parameter_file.h"
#include "support/csv.h"
#include "support/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

using Steps = std::map<long, StepDump>;
using Parameters = std::map<std::string, std::string>;

/// By this much a roller that stands may be off its place, m: the places of bed.csv are exact, those of a
/// roller that drives through the end of its way are not.
constexpr double standing = 1e-3;

double number_of(const fs::path &folder, const Parameters &parameters, const char *name, const Range &range) {
  const auto found = parameters.find(name);
  const fs::path file = folder / "parameters.csv";
  if (found == parameters.end())
    csv_fault(file, 0, name, "is missing; allowed: a run of inputs/bed/in.drive");
  const std::optional<double> value = any_number_from_text(found->second);
  if (!value || !range.holds(*value)) csv_refusal(file, 0, name, found->second, range.words());
  return *value;
}

void check_deck(const fs::path &folder, const Parameters &parameters) {
  const auto deck = parameters.find("deck");
  if (deck == parameters.end() || deck->second != "drive")
    csv_refusal(folder / "parameters.csv", 0, "deck", deck == parameters.end() ? "" : deck->second,
                "drive, a run of inputs/bed/in.drive");
}

/// The spots that parameters.csv notes as "FROM:TO,FROM:TO" [m].
std::vector<WayPart> noted_spots(const fs::path &folder, const Parameters &parameters) {
  const auto noted = parameters.find("spots");
  if (noted == parameters.end() || noted->second == "none") return {};
  std::vector<WayPart> spots;
  std::istringstream texts(noted->second);
  for (std::string text; std::getline(texts, text, ',');) {
    const std::size_t colon = std::min(text.find(':'), text.size());
    const std::optional<double> from = any_number_from_text(text.substr(0, colon)),
                                to = any_number_from_text(text.substr(std::min(colon + 1, text.size())));
    if (!from || !to || !(*from < *to))
      csv_refusal(folder / "parameters.csv", 0, "spots", noted->second, "none, or FROM:TO,FROM:TO [m]");
    spots.push_back({*from, *to});
  }
  return spots;
}

/// The passes that the roller has driven to their ends.
class Passes {
public:
  Passes(Drive &drive, Steps steps, double timestep, bool ended)
      : drive_(drive), steps_(std::move(steps)), timestep_(timestep), ended_(ended) {}

  void read() {
    if (steps_.empty())
      throw std::runtime_error(
          refusal("FOLDER", drive_.folder.string(),
                  "a run with dumps, dump/balls_STEP.vtp or .dump, at step 0 and at the end of each pass"));
    const long before = steps_.begin()->first;
    if (std::abs(drive_.history.s[row_at(before)] - drive_.history.s.front()) > standing) missing(0, 0);
    drive_.states.push_back(read_dumped_bed(drive_.folder, before));
    check_soil();
    for (const auto &[first, last] : ranges())
      if (!add(first, last)) break;
    if (drive_.passes.empty())
      csv_fault(drive_.folder / "bed.csv", 0, "pass", "has no pass that is finished; allowed: one or more");
  }

private:
  std::size_t row_at(long step) const {
    const double place =
        (static_cast<double>(step) * timestep_ - drive_.record.time.front()) / drive_.record.interval;
    return static_cast<std::size_t>(
        std::clamp(std::round(place), 0.0, static_cast<double>(drive_.history.size() - 1)));
  }
  long step_of(std::size_t row) const { return std::lround(drive_.history.time[row] / timestep_); }

  [[noreturn]] void missing(std::size_t pass, long step) const {
    throw std::runtime_error(fmt::format(
        "{}: a dump with the roller standing {} (step {}) is missing; allowed: dumps at step 0 and at the "
        "end of each pass",
        (drive_.folder / "dump").string(),
        pass == 0 ? "before the first pass" : fmt::format("at the end of pass {}", pass), step));
  }

  /// First and last row of each pass.
  std::vector<std::pair<std::size_t, std::size_t>> ranges() const {
    const std::vector<double> &pass = drive_.history.pass;
    std::vector<std::pair<std::size_t, std::size_t>> found;
    for (std::size_t row = 0; row < pass.size(); ++row) {
      const double wanted = static_cast<double>(found.size());
      if (pass[row] == wanted && !found.empty())
        found.back().second = row;
      else if (pass[row] == wanted + 1.0)
        found.emplace_back(row, row);
      else
        csv_refusal(drive_.folder / "bed.csv", 0, "pass", fmt::format("{:g}", pass[row]),
                    "passes counted from 1, none left out");
    }
    return found;
  }

  /// Adds a pass; false if it is the last of a run that was stopped in it.
  bool add(std::size_t first, std::size_t last) {
    const std::vector<double> &s = drive_.history.s;
    const std::size_t number = drive_.passes.size() + 1;
    const bool stopped = last + 1 == s.size() && !ended_;
    DrivenPass pass;
    pass.first = first;
    pass.last = last;
    const auto inside = [&](std::size_t row) { return drive_.measured.holds(s[row]); };
    pass.enters = first;
    while (pass.enters <= last && !inside(pass.enters))
      ++pass.enters;
    pass.leaves = last;
    while (pass.leaves > first && !inside(pass.leaves))
      --pass.leaves;
    const bool driven = std::abs(s[last] - s[first]) >= drive_.measured.length() && pass.enters > first &&
                        pass.leaves < last && pass.enters < pass.leaves;
    // The instant at which the next pass begins belongs to both.
    const std::size_t next = std::min(last + 1, s.size() - 1);
    const long end = step_of(next), begin = drive_.states.back().step;
    const auto after = steps_.upper_bound(end);
    const long step = after == steps_.begin() ? -1 : std::prev(after)->first;
    const bool dumped =
        step > begin && (row_at(step) == next || std::abs(s[row_at(step)] - s[last]) <= standing);
    if (!driven || !dumped) {
      if (!stopped && driven) missing(number, end);
      if (!stopped)
        csv_fault(drive_.folder / "bed.csv", 0, "s",
                  fmt::format("pass {} does not lead from one side of the measured part, {:g} to {:g} m, to "
                              "the other; allowed: passes over all of it",
                              number, drive_.measured.from, drive_.measured.to));
      drive_.notes.push_back(fmt::format(
          "Pass {} is not finished and is left out: the run was stopped in it, or goes on.", number));
      return false;
    }
    for (auto at = steps_.lower_bound(begin); at != steps_.end() && at->first <= step; ++at)
      if (!at->second.contacts.empty()) pass.dumps.push_back(at->first);
    for (auto at = steps_.upper_bound(begin); at != steps_.end() && at->first <= step; ++at)
      if (inside(row_at(at->first)) && !at->second.contacts.empty()) pass.passing.push_back(at->first);
    try {
      drive_.states.push_back(read_dumped_bed(drive_.folder, step));
    } catch (const CutShort &fault) {
      if (ended_ || std::next(steps_.find(step)) != steps_.end()) throw;
      drive_.notes.push_back(
          fmt::format("Pass {} is left out: the run was stopped while it wrote the bed behind it ({}).",
                      number, fault.what()));
      return false;
    }
    drive_.passes.push_back(std::move(pass));
    check_place();
    return true;
  }

  /// Refuses a measured part that reaches beyond the soil.
  void check_soil() const {
    const WayPart &measured = drive_.measured;
    Bounds soil;
    for (const Ball &ball : drive_.states.front().balls)
      if (is_soil(ball.type)) soil.add(ball);
    if (soil.empty() || measured.from < soil.low[0] || measured.to > soil.high[0])
      throw std::runtime_error(fmt::format(
          "{}: the measured part is '{:g} to {:g} m'; allowed: one on the soil, {:.4g} to {:.4g} m",
          (drive_.folder / "parameters.csv").string(), measured.from, measured.to, soil.low[0],
          soil.high[0]));
  }

  /// Refuses passes that lead over other soil than the first one: in one direction only, on a periodic bed
  /// that is longer than a pass. After a pass over all of such a bed the roller is where it began.
  void check_place() const {
    const auto direction = drive_.record.parameters.find("direction");
    if (direction == drive_.record.parameters.end() || direction->second != "one") return;
    for (const Ball &ball : drive_.states.back().balls)
      if (ball.type == frame_type && drive_.history.pass.back() > 1.0 &&
          std::abs(ball.position[0] - drive_.history.s.front()) > standing)
        csv_refusal(drive_.folder / "parameters.csv", 0, "direction", direction->second,
                    "both; or one, with passes as long as the periodic bed, so that all lead over the same "
                    "soil");
  }

  Drive &drive_;
  Steps steps_;
  double timestep_;
  bool ended_;
};

} // namespace

std::vector<bool> lying_soil(const std::vector<Ball> &balls) {
  std::vector<std::size_t> soil; // along the way
  double largest = 0.0;
  for (std::size_t b = 0; b < balls.size(); ++b)
    if (is_soil(balls[b].type)) {
      soil.push_back(b);
      largest = std::max(largest, balls[b].radius);
    }
  const auto along = [&](std::size_t b) { return balls[b].position[0]; };
  std::sort(soil.begin(), soil.end(), [&](std::size_t a, std::size_t b) { return along(a) < along(b); });
  std::vector<bool> lies(balls.size(), false);
  std::vector<std::size_t> found; // places in `soil` whose neighbours are to be looked at
  const auto take = [&](std::size_t place) {
    lies[soil[place]] = true;
    found.push_back(place);
  };
  for (std::size_t place = 0; place < soil.size(); ++place)
    if (const Ball &ball = balls[soil[place]]; ball.position[1] <= 2.0 * ball.radius) take(place);
  const double reach = 3.0 * largest;
  while (!found.empty()) {
    const Ball &ball = balls[soil[found.back()]];
    const double x = ball.position[0];
    found.pop_back();
    const auto first = std::lower_bound(soil.begin(), soil.end(), x - reach,
                                        [&](std::size_t b, double low) { return along(b) < low; });
    for (auto place = static_cast<std::size_t>(first - soil.begin());
         place < soil.size() && along(soil[place]) <= x + reach; ++place) {
      const Ball &other = balls[soil[place]];
      if (lies[soil[place]]) continue;
      const double distance = std::hypot(other.position[0] - x, other.position[1] - ball.position[1],
                                         other.position[2] - ball.position[2]);
      if (distance <= ball.radius + other.radius + std::min(ball.radius, other.radius)) take(place);
    }
  }
  return lies;
}

DumpedBed read_dumped_bed(const fs::path &folder, long step) {
  const Steps steps = dumped_steps(folder / "dump");
  const StepDump &dump = steps.at(step);
  DumpedBed state;
  state.step = step;
  state.balls = read_ball_dump(dump.balls);
  state.lies = lying_soil(state.balls);
  if (!dump.contacts.empty()) state.contacts = read_contact_dump(dump.contacts, state.balls);
  return state;
}

Drive read_drive(const fs::path &folder) {
  for (const char *name : {"parameters.csv", "bed.csv"})
    if (!fs::is_regular_file(folder / name))
      throw std::runtime_error(refusal("FOLDER", folder.string(),
                                       "the folder of a run of inputs/bed/in.drive, with parameters.csv, "
                                       "bed.csv and dump"));
  Drive drive;
  drive.folder = folder;
  const Parameters parameters = read_parameters(folder / "parameters.csv");
  check_deck(folder, parameters);
  constexpr double far = 1e6;
  const auto number = [&](const char *name, const Range &range) {
    return number_of(folder, parameters, name, range);
  };
  const double from = number("measure_from", {-far, far, "m"}), to = number("measure_to", {-far, far, "m"});
  drive.measured = {std::min(from, to), std::max(from, to)};
  if (from == to)
    csv_refusal(folder / "parameters.csv", 0, "measure_to", parameters.at("measure_to"),
                "another place than measure_from");
  drive.speed = number("speed", {0.0, 1e3, "m/s", false, true});
  const double timestep = number("timestep", {0.0, 1.0, "s", false, true});
  drive.timestep = timestep;
  drive.record = read_record(folder);
  const auto ended_row = parameters.find("ended");
  const bool ended = ended_row != parameters.end() && ended_row->second == "yes";
  // A run that goes on may have written further rows meanwhile.
  drive.history = read_drive_history(folder / "bed.csv", drive.record.size() + (ended ? 1 : 0));
  if (drive.record.size() != drive.history.size())
    csv_fault(folder / "bed.csv", 0, {},
              fmt::format("has {} rows with a place and {} with a motion; allowed: the same number",
                          drive.history.size(), drive.record.size()));
  Passes(drive, dumped_steps(folder / "dump"), timestep, ended).read();
  const std::vector<Ball> &balls = drive.states.front().balls;
  const auto dimension = parameters.find("dimension");
  drive.flat = dimension == parameters.end() ? in_a_plane(balls) : dimension->second != "3";
  if (!drive.flat) drive.thickness = number("thickness", {0.0, far, "m", false, true});
  constexpr double most = 1000.0;
  drive.layers =
      parameters.count("layers") == 0 ? 1 : static_cast<int>(number("layers", {1.0, most, "layers of soil"}));
  drive.spots = noted_spots(folder, parameters);
  return drive;
}

} // namespace drumlin::post
