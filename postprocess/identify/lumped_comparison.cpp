#include "identify/lumped_comparison.h"

#include "chain/exact_solution.h"
#include "meter/cycles.h"
#include "pages/figure.h"
#include "record/chain_record.h"
#include "support/csv.h"
#include "support/statistics.h"
#include "support/units.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>

namespace drumlin::post {

namespace {

constexpr int lead = 200;        // cycles of the chain before its motion counts as steady
constexpr int lumped_count = 40; // cycles of the chain of which values are means
constexpr std::size_t drawn = 4; // cycles in the figures of motion

struct QuantityText {
  const char *name;  ///< words for a sentence of the page
  const char *label; ///< with unit, as in tables
  double scale;      ///< from SI to the label's unit
  double negligible; ///< difference that does not count, whatever the value is
};
constexpr std::array<QuantityText, cycle_quantities.size()> texts = {
    {{"the drum's peak acceleration", "peak acceleration of the drum (m/s2)", 1.0, 0.0},
     {"the peak contact force", "peak contact force (kN)", 1e-3, 0.0},
     {"the share of time in contact", "share of time in contact (-)", 1.0, 0.01},
     {"CMV", "CMV of a cycle (-)", 1.0, 1.0},
     {"the work done on the soil in a cycle", "work on the soil in a cycle (J)", 1.0, 0.0}}};

double number_of(const Record &record, const char *name) {
  const auto found = record.parameters.find(name);
  const std::optional<double> value =
      found == record.parameters.end() ? std::nullopt : any_number_from_text(found->second);
  if (!value || !std::isfinite(*value))
    throw std::runtime_error(fmt::format(
        "{}: {}", record.file.string(),
        refusal(name, found == record.parameters.end() ? "" : found->second,
                "a number in parameters.csv, or a roller by --roller, for the chain beside the record")));
  return *value;
}

ChainParameters chain_of(const Record &record, const IdentifiedRecord &found) {
  const LawEstimate &law = found.whole.law;
  if (!(law.k.mean > 0.0) || !(law.D.mean > 0.0))
    throw std::runtime_error(
        fmt::format("{}: {}", record.file.string(),
                    refusal("the law k, D", fmt::format("{:.3g}, {:.3g}", law.k.mean, law.D.mean),
                            "a record in which identification finds both above zero")));
  ChainParameters chain;
  chain.m2 = *record.m2;
  chain.m3 = *record.m3;
  chain.k = law.k.mean;
  chain.D = law.D.mean;
  chain.omega = *record.omega;
  chain.Fw = number_of(record, "Fw");
  chain.k23 = number_of(record, "k23");
  chain.c23 = number_of(record, "c23");
  chain.g = record.g.value_or(chain.g);
  const auto transition = record.parameters.find("transition");
  if (transition != record.parameters.end()) chain.transition = transition_from_name(transition->second);
  if (const std::string invalid = chain.invalid(); !invalid.empty())
    throw std::runtime_error(fmt::format("{}: {}", record.file.string(), invalid));
  return chain;
}

/// The drum's position from the origin of the law, at which spring and dashpot would have no force at rest.
/// Each contact has its own origin; samples whose force is too small to be fitted have that of the nearest
/// sample that is fitted. NaN out of contact [m].
std::vector<double> position_from_origin(const Record &record, const Identification &whole) {
  const std::vector<double> force = soil_force(record);
  const std::vector<double> &x = record.x_drum.empty() ? whole.x : record.x_drum;
  const double none = std::nan("");
  std::vector<double> position(force.size(), none);
  std::vector<std::size_t> fitted;
  for (std::size_t i = 0; i < force.size(); ++i)
    if (std::isfinite(whole.fitted[i])) fitted.push_back(i);
  std::size_t next = 0; // the first fitted sample that is not before sample i
  for (std::size_t i = 0; i < force.size() && !fitted.empty(); ++i) {
    while (next < fitted.size() && fitted[next] < i)
      ++next;
    const bool after = next < fitted.size() && (next == 0 || fitted[next] - i <= i - fitted[next - 1]);
    const std::size_t near = after ? fitted[next] : fitted[next - 1];
    const double origin =
        x[near] + (whole.fitted[near] + whole.law.c.mean * whole.v[near]) / whole.law.k.mean;
    if (force[i] > 0.0) position[i] = x[i] - origin;
  }
  return position;
}

/// Peak acceleration, peak force and the other compared values of each whole cycle of a record.
std::vector<CycleValues> values_of(const Record &record) {
  const MeterRecord meter = meter_cycles(record);
  const double per_cycle = record.period() / record.interval;
  std::vector<CycleValues> values;
  for (std::size_t i = 0; i < meter.cycles.size(); ++i) {
    const MeterCycle &cycle = meter.cycles[i];
    const auto begin = static_cast<std::ptrdiff_t>(std::lround(static_cast<double>(i) * per_cycle));
    const auto end = static_cast<std::ptrdiff_t>(std::lround(static_cast<double>(i + 1) * per_cycle));
    const double cmv = compaction_meter_value(
        {std::abs(cycle.acceleration[basic_order]), std::abs(cycle.acceleration[double_order]), 0.0});
    values.push_back({*std::max_element(record.a_drum.begin() + begin, record.a_drum.begin() + end),
                      cycle.peak_force.value_or(0.0), cycle.contact_share.value_or(0.0), cmv,
                      cycle.energy.value_or(0.0)});
  }
  return values;
}

MeanInterval mean_from(const std::vector<CycleValues> &cycles, std::size_t first, std::size_t quantity) {
  std::vector<double> values;
  for (std::size_t i = first; i < cycles.size(); ++i)
    values.push_back(cycles[i][quantity]);
  return mean_interval(values);
}

/// How far a mean of the steady chain changes if k or D is at an end of its interval.
CycleValues reach_of(const ChainParameters &chain, const LawEstimate &law, int samples,
                     const CycleValues &middle) {
  CycleValues squares{};
  const auto add = [&](double ChainParameters::*parameter, double half_width) {
    CycleValues largest{};
    for (const double side : {-1.0, 1.0}) {
      ChainParameters other = chain;
      // An interval may reach below zero: the chain's lower end is then a tenth of the estimate.
      other.*parameter = std::max(0.1 * chain.*parameter, chain.*parameter + side * half_width);
      const std::vector<CycleValues> cycles =
          values_of(chain_record(other, solve_chain(other, lumped_count, samples, lead).history));
      for (std::size_t q = 0; q < largest.size(); ++q)
        largest[q] = std::max(largest[q], std::fabs(mean_from(cycles, 0, q).mean - middle[q]));
    }
    for (std::size_t q = 0; q < largest.size(); ++q)
      squares[q] += largest[q] * largest[q];
  };
  add(&ChainParameters::k, law.k.half_width);
  add(&ChainParameters::D, law.D.half_width);
  for (double &value : squares)
    value = std::sqrt(value);
  return squares;
}

/// The part of the chain's steady motion, a whole number of cycles from its beginning, that lies closest to
/// the record's last cycles: a motion of period 2 would else be drawn in the other cycle.
ChainHistory closest_part(const Record &record, const ChainHistory &steady, std::size_t samples) {
  const std::size_t length = std::min(record.size(), steady.size());
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t shift = 0; shift < 4 && shift * samples + length <= steady.size(); ++shift) {
    double squares = 0.0;
    for (std::size_t i = length - std::min(length, drawn * samples); i < length; ++i)
      squares += std::pow(record.a_drum[i] - steady.a_drum[shift * samples + i], 2);
    if (squares < least) {
      least = squares;
      best = shift;
    }
  }
  const auto part = [&](const std::vector<double> &all) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(best * samples);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(length));
  };
  ChainHistory history;
  history.time.assign(record.time.begin(), record.time.begin() + static_cast<std::ptrdiff_t>(length));
  history.x_drum = part(steady.x_drum);
  history.v_drum = part(steady.v_drum);
  history.a_drum = part(steady.a_drum);
  history.F_contact = part(steady.F_contact);
  history.F_excitation = part(steady.F_excitation);
  return history;
}

/// Downward change of the drum's mean position from the first to the last cycle that counts, per cycle [m].
double settlement_of(const Record &record, std::size_t first, std::size_t cycles) {
  if (record.x_drum.empty() || cycles < first + 2) return 0.0;
  const double per_cycle = record.period() / record.interval;
  const auto mean = [&](std::size_t cycle) {
    const auto begin = static_cast<std::size_t>(std::lround(static_cast<double>(cycle) * per_cycle));
    const auto end = static_cast<std::size_t>(std::lround(static_cast<double>(cycle + 1) * per_cycle));
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i)
      sum += record.x_drum[i];
    return sum / static_cast<double>(end - begin);
  };
  return (mean(first) - mean(cycles - 1)) / static_cast<double>(cycles - 1 - first);
}

/// A quantity over all records: the differences record by record if there are several.
ComparedQuantity together(const std::vector<LumpedComparison> &records, std::size_t q) {
  if (records.size() == 1) return records.front().quantities[q];
  std::vector<double> measured, lumped, differences;
  for (const LumpedComparison &one : records) {
    measured.push_back(one.quantities[q].record.mean);
    lumped.push_back(one.quantities[q].lumped);
    differences.push_back(one.quantities[q].difference.mean);
  }
  return {mean_interval(measured), mean_interval(lumped).mean, mean_interval(differences)};
}

/// Whether the interval of a difference does not contain zero, and the difference is large enough to count:
/// the decay of the motion from rest, and rounding, make differences, too.
bool beyond_scatter(const ComparedQuantity &value, std::size_t q) {
  // Of the chain's value. Work is summed over samples, of which none is at the instant at which the drum
  // lands.
  const double share = q == static_cast<std::size_t>(CycleQuantity::work) ? 0.05 : 0.01;
  return value.difference.significant() &&
         std::fabs(value.difference.mean) > std::max(share * std::fabs(value.lumped), texts.at(q).negligible);
}

/// A difference and its interval in per cent of the chain's value, or in the unit of the label where the
/// chain's value is almost zero. The CMV of the chain, for example, is zero if contact is never lost. \param
/// sign whether the text has the sign of the difference
std::string difference_text(const ComparedQuantity &value, std::size_t q, bool sign) {
  const bool relative = std::fabs(value.lumped) > texts.at(q).negligible;
  const double scale = relative ? 100.0 / std::fabs(value.lumped) : texts.at(q).scale;
  const double mean = scale * value.difference.mean;
  return fmt::format("{} ± {:.2g}{}",
                     sign ? fmt::format("{:+.3g}", mean) : fmt::format("{:.3g}", std::fabs(mean)),
                     scale * value.difference.half_width, relative ? " %" : "");
}

/// What a difference beyond scatter says of the soil.
std::string reason(CycleQuantity quantity, bool larger) {
  switch (quantity) {
  case CycleQuantity::acceleration:
    return larger ? "the soil stiffens as the drum presses more balls"
                  : "the soil yields below the drum and limits the force that stops it";
  case CycleQuantity::force:
    return larger ? "the stiffness of the soil grows with the force, since more balls carry it"
                  : "the soil yields below the drum: friction limits its force, which grows without limit in "
                    "a spring";
  case CycleQuantity::contact:
    return larger ? "the soil follows the drum a little and is soft at small forces, so that contact begins "
                    "early and ends late"
                  : "soil that was pressed down stays down when the drum leaves, while a spring comes up "
                    "with it";
  case CycleQuantity::cmv:
    return larger ? "the force is less linear than a spring that can lose contact: CMV grows with the "
                    "curvature of its loop"
                  : "the motion is closer to a harmonic one than on a spring and a dashpot that can lose "
                    "contact";
  case CycleQuantity::work:
    return larger ? "friction between the balls takes work that does not depend on the rate, beside that of "
                    "a dashpot"
                  : "the loop of the soil is narrower than that of a dashpot with the same D";
  }
  throw std::logic_error("a quantity without words");
}

PageFigure motion_figure(const LumpedComparison &one, int number) {
  constexpr const char *name = "chain_and_bed";
  PageFigure figure = page_figure(
      fmt::format("Fig. {}", number),
      "The record's last four cycles and, over them, the chain with the k and D that were identified in it, "
      "in its steady motion. Left: acceleration of the drum. Right: contact force over the position of the "
      "drum, from the origin of the law, which was found for each contact of the record.",
      {name, "Chain and record over each other", {}, 2}, 3.0);
  CurveTable data("cycles,drum position (mm),drum acceleration (m/s2),contact force (kN)");
  const double per_cycle = one.record.period() / one.record.interval;
  const std::size_t length = one.lumped.size();
  const std::size_t begin = length - std::min(length, static_cast<std::size_t>(drawn * per_cycle));
  const double none = std::nan("");
  const std::vector<double> force = soil_force(one.record);
  for (std::size_t i = begin; i < length; ++i)
    data.row("record", {static_cast<double>(i) / per_cycle, 1e3 * one.position[i], one.record.a_drum[i],
                        1e-3 * force[i]});
  for (std::size_t i = begin; i < length; ++i)
    data.row("chain", {static_cast<double>(i) / per_cycle,
                       one.lumped.F_contact[i] > 0.0 ? 1e3 * one.lumped.x_drum[i] : none,
                       one.lumped.a_drum[i], 1e-3 * one.lumped.F_contact[i]});
  Panel left{"Acceleration", "cycles", "drum acceleration (m/s2)", {}};
  left.tight_x = true;
  left.curves = {curve(name, "record", "$2", "4", CurveStyle::condition_b),
                 curve(name, "chain", "$2", "4", CurveStyle::condition_a)};
  Panel right{"Loop",
              "drum position (mm)",
              "contact force (kN)",
              {curve(name, "record", "$3", "5", CurveStyle::dots_up),
               curve(name, "chain", "$3", "5", CurveStyle::condition_a)}};
  figure.figure.panels = {left, right};
  figure.csv = data.text();
  return figure;
}

PageFigure cycle_figure(const LumpedComparison &one, int number) {
  constexpr const char *name = "cycle_by_cycle";
  PageFigure figure = page_figure(fmt::format("Fig. {}", number),
                                  fmt::format("The same for each cycle of the record; line: mean of {} "
                                              "cycles of the chain. Cycles from {} on count.",
                                              one.lumped_cycles.size(), one.first + 1),
                                  {name, "Cycle by cycle", {}, 2});
  CurveTable data("cycle,acceleration,force,contact,CMV,work");
  const auto rows = [&](const char *curve_name, double cycle, const CycleValues &values) {
    std::array<double, cycle_quantities.size()> shown{};
    for (std::size_t q = 0; q < shown.size(); ++q)
      shown[q] = texts[q].scale * values[q];
    data.row(curve_name, {cycle, shown[0], shown[1], shown[2], shown[3], shown[4]});
  };
  for (std::size_t i = 0; i < one.record_cycles.size(); ++i)
    rows("record", static_cast<double>(i + 1), one.record_cycles[i]);
  CycleValues lumped{};
  for (std::size_t q = 0; q < lumped.size(); ++q)
    lumped[q] = one.quantities[q].lumped;
  for (const double end : {0.5, 0.5 + static_cast<double>(one.record_cycles.size())})
    rows("chain", end, lumped);
  for (const CycleQuantity quantity :
       {CycleQuantity::acceleration, CycleQuantity::force, CycleQuantity::contact, CycleQuantity::cmv}) {
    const auto q = static_cast<std::size_t>(quantity);
    Panel panel{"", "cycle", texts.at(q).label, {}};
    const std::string column = std::to_string(q + 3);
    panel.curves = {curve(name, "record", "$2", column, CurveStyle::measured_b),
                    curve(name, "chain", "$2", column, CurveStyle::condition_a)};
    figure.figure.panels.push_back(panel);
  }
  figure.csv = data.text();
  return figure;
}

PageTable comparison_table(const std::vector<LumpedComparison> &records) {
  PageTable table("chain_and_record", "Chain and record",
                  "quantity | record | chain | difference | beyond scatter");
  for (const CycleQuantity quantity : cycle_quantities) {
    const auto q = static_cast<std::size_t>(quantity);
    const ComparedQuantity value = together(records, q);
    const double scale = texts.at(q).scale;
    table.add({texts.at(q).label,
               fmt::format("{:.4g} ± {:.2g}", scale * value.record.mean, scale * value.record.half_width),
               fmt::format("{:.4g}", scale * value.lumped), difference_text(value, q, true),
               beyond_scatter(value, q) ? "yes" : "no"});
  }
  table.notes = {records.size() == 1
                     ? "After the ±: half of a 95 % confidence interval, over the cycles that count; that of "
                       "the difference contains the intervals of k and D, too."
                     : fmt::format("Means over {} records, each beside a chain with its own k and D; after "
                                   "the ±: half of the 95 % confidence interval over the records.",
                                   records.size()),
                 "Work on the soil in a cycle is the area of the force loop."};
  return table;
}

} // namespace

void require_comparable(const Record &record) {
  if (!record.of_run)
    throw std::runtime_error(refusal("--compare", record.file.string(),
                                     "the record of a run: a measured one has no positions of the drum, and "
                                     "its phase, which the chain's would have to follow, has an error"));
  if (record.a_drum.empty() || soil_force(record).empty() || record.F_excitation.empty())
    throw std::runtime_error(fmt::format("{}: {}", record.file.string(),
                                         refusal("the record", "without samples of drum, force or excitation",
                                                 "one with a_drum, F_contact and F_excitation")));
  for (const char *name : {"Fw", "k23", "c23"})
    number_of(record, name);
}

LumpedComparison compare_lumped(const Record &record, const IdentifiedRecord &found) {
  require_comparable(record);
  LumpedComparison result;
  result.chain = chain_of(record, found);
  result.record = record;
  result.position = position_from_origin(record, found.whole);
  result.r2 = found.whole.law.r2;
  const auto samples = static_cast<int>(std::lround(record.period() / record.interval));
  const int cycles = std::max(lumped_count, static_cast<int>(record.cycles()) + 5);
  const ChainHistory steady = solve_chain(result.chain, cycles, samples, lead).history;
  result.lumped = chain_record(result.chain, closest_part(record, steady, static_cast<std::size_t>(samples)));
  result.record_cycles = values_of(record);
  result.lumped_cycles = values_of(chain_record(result.chain, steady));
  // The second half of the cycles is compared, and one cycle more if that is an odd number: the motion may
  // repeat only after two cycles, and on soft soil high and low peaks alternate while the motion from rest
  // decays. An odd number would count one kind more often.
  const std::size_t all = result.record_cycles.size();
  result.first = all / 2;
  if ((all - result.first) % 2 == 1 && result.first > 0) --result.first;
  result.settlement = settlement_of(record, result.first, all);
  CycleValues middle{};
  for (std::size_t q = 0; q < middle.size(); ++q)
    middle[q] = mean_from(result.lumped_cycles, 0, q).mean;
  const CycleValues reach = reach_of(result.chain, found.whole.law, samples, middle);
  for (std::size_t q = 0; q < middle.size(); ++q) {
    const MeanInterval mean = mean_from(result.record_cycles, result.first, q);
    result.quantities[q] = {mean, middle[q], {mean.mean - middle[q], std::hypot(mean.half_width, reach[q])}};
  }
  return result;
}

bool LumpedComparison::differs(CycleQuantity quantity) const {
  return beyond_scatter(of(quantity), static_cast<std::size_t>(quantity));
}

std::vector<std::string> lumped_answer(const std::vector<LumpedComparison> &records) {
  std::vector<std::string> lines, same;
  for (const CycleQuantity quantity : cycle_quantities) {
    const auto q = static_cast<std::size_t>(quantity);
    const ComparedQuantity value = together(records, q);
    const bool larger = value.difference.mean > 0.0;
    if (!beyond_scatter(value, q))
      same.emplace_back(texts.at(q).name);
    else
      lines.push_back(fmt::format(
          "Against the chain with the same k and D, {} of the record is {} by {}, probably because {}.",
          texts.at(q).name, larger ? "larger" : "smaller", difference_text(value, q, false),
          reason(quantity, larger)));
  }
  if (!same.empty()) lines.push_back(fmt::format("No difference beyond scatter: {}.", fmt::join(same, ", ")));
  double r2 = 0.0, settlement = 0.0;
  for (const LumpedComparison &one : records) {
    r2 += one.r2 / static_cast<double>(records.size());
    settlement += one.settlement / static_cast<double>(records.size());
  }
  lines.push_back(fmt::format("Spring and dashpot explain {:.0f} % of the variance of the contact force; the "
                              "rest is what a lumped soil cannot follow.",
                              100.0 * r2));
  lines.push_back(fmt::format("The drum {} by {:.2g} mm per cycle, and the cycles of the record differ from "
                              "each other; the chain's soil neither settles nor changes.",
                              settlement >= 0.0 ? "sinks" : "rises", 1e3 * std::fabs(settlement)));
  return lines;
}

void add_lumped_comparison(Page &page, const std::vector<LumpedComparison> &records, int number) {
  for (const std::string &line : lumped_answer(records))
    page.paragraph(line);
  page.figure(motion_figure(records.front(), number));
  page.table(comparison_table(records));
  page.figure(cycle_figure(records.front(), number + 1));
}

} // namespace drumlin::post
