// The CSV files of a chain run: chain.csv, events.csv, cycles.csv, and parameters.csv
// (runs/parameter_file.h). One reader and one writer per file, for the engine's output and for the direct
// solver's alike. Errors and numbers are as in support/csv.h.
#pragma once

#include "runs/parameter_file.h"
#include "support/csv.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace drumlin::post {

/// Columns of chain.csv that are there all together or not at all: those of every run, of one with a frame,
/// of a roller that drives, of a drum with two ends.
enum class ColumnGroup { motion, frame, way, ends };

/// Time series of a roller, one vector for each column of chain.csv, all of one length; those that a file
/// does not have are empty.
struct ChainHistory {
  std::vector<double> time;         ///< from the start of the excitation [s]
  std::vector<double> x_drum;       ///< up positive; of a run, 0 where drum and soil just touch [m]
  std::vector<double> v_drum;       ///< [m/s]
  std::vector<double> a_drum;       ///< [m/s2]
  std::vector<double> x_frame;      ///< of a run, equal to x_drum where the bond is unstretched [m]
  std::vector<double> v_frame;      ///< [m/s]
  std::vector<double> a_frame;      ///< [m/s2]
  std::vector<double> F_contact;    ///< of the soil on the drum, positive in compression [N]
  std::vector<double> F_excitation; ///< F_e, positive where it pushes the drum down [N]
  std::vector<double> F_bond;       ///< c23 (v_frame - v_drum) + k23 (x_frame - x_drum) [N]
  // Of a drum with two ends; x_drum, F_contact and so on are those of its middle and of all contacts.
  std::vector<double> theta_drum; ///< tilt about the way of travel, positive if the right end is higher [rad]
  std::vector<double> omega_drum; ///< its rate [rad/s]
  std::vector<double> theta_frame; ///< [rad]
  std::vector<double> omega_frame; ///< [rad/s]
  std::vector<double> a_left;      ///< of a sensor at the left end of the drum [m/s2]
  std::vector<double> a_right;     ///< and at the right one [m/s2]
  std::vector<double> F_left;      ///< of the contacts left of the middle, and half of one in the middle [N]
  std::vector<double> F_right;     ///< [N]
  std::vector<double> s;           ///< place along the way of a roller that drives [m]
  std::vector<double> pass;        ///< and its pass, counted from 1

  /// Number of rows.
  std::size_t size() const { return time.size(); }
  /// Whether the columns are there.
  bool has(ColumnGroup group) const {
    return group == ColumnGroup::motion || (group == ColumnGroup::frame ? !x_frame.empty()
                                            : group == ColumnGroup::way ? !s.empty()
                                                                        : !theta_drum.empty());
  }
  bool has_frame() const { return has(ColumnGroup::frame); }
};

/// A column of chain.csv.
struct HistoryColumn {
  const char *name;
  std::vector<double> ChainHistory::*values;
  int derivative; ///< of the position: 0, 1, 2 in m, m/s, m/s2; or one of those below
  ColumnGroup group = ColumnGroup::motion;
};
/// N; s; m, or the number of a pass; rad, or rad/s
constexpr int force_column = -1, time_column = -2, way_column = -3, tilt_column = -4;
constexpr std::array<HistoryColumn, 20> history_columns = {
    {{"time", &ChainHistory::time, time_column},
     {"x_drum", &ChainHistory::x_drum, 0},
     {"v_drum", &ChainHistory::v_drum, 1},
     {"a_drum", &ChainHistory::a_drum, 2},
     {"x_frame", &ChainHistory::x_frame, 0, ColumnGroup::frame},
     {"v_frame", &ChainHistory::v_frame, 1, ColumnGroup::frame},
     {"a_frame", &ChainHistory::a_frame, 2, ColumnGroup::frame},
     {"F_contact", &ChainHistory::F_contact, force_column},
     {"F_excitation", &ChainHistory::F_excitation, force_column},
     {"F_bond", &ChainHistory::F_bond, force_column, ColumnGroup::frame},
     {"theta_drum", &ChainHistory::theta_drum, tilt_column, ColumnGroup::ends},
     {"omega_drum", &ChainHistory::omega_drum, tilt_column, ColumnGroup::ends},
     {"theta_frame", &ChainHistory::theta_frame, tilt_column, ColumnGroup::ends},
     {"omega_frame", &ChainHistory::omega_frame, tilt_column, ColumnGroup::ends},
     {"a_left", &ChainHistory::a_left, 2, ColumnGroup::ends},
     {"a_right", &ChainHistory::a_right, 2, ColumnGroup::ends},
     {"F_left", &ChainHistory::F_left, force_column, ColumnGroup::ends},
     {"F_right", &ChainHistory::F_right, force_column, ColumnGroup::ends},
     {"s", &ChainHistory::s, way_column, ColumnGroup::way},
     {"pass", &ChainHistory::pass, way_column, ColumnGroup::way}}};

/// A contact made or broken: one row of events.csv.
struct ContactEvent {
  double time = 0.0;         ///< [s]
  bool make = true;          ///< made, else broken
  double overlap = 0.0;      ///< d, positive when overlapping [m]
  double overlap_rate = 0.0; ///< d' [m/s]
  double force = 0.0;        ///< just after make or just before break, positive in compression [N]
  long id_i = 1;             ///< the lower of the two particles' ids (soil)
  long id_j = 2;             ///< the higher (drum)
};

/// Extremes and contact share of one cycle of the excitation: one row of cycles.csv.
struct CycleSummary {
  int cycle = 0;              ///< counted from 1
  double time = 0.0;          ///< start of the cycle [s]
  double a_drum_min = 0.0;    ///< extremes over the cycle [m/s2]
  double a_drum_max = 0.0;    ///< [m/s2]
  double F_contact_min = 0.0; ///< extremes over the cycle, both sides of the jumps [N]
  double F_contact_max = 0.0; ///< [N]
  double contact_share = 0.0; ///< share of the cycle's time in contact [-]
  int makes = 0;              ///< contacts made in the cycle
  int breaks = 0;             ///< contacts broken in the cycle
};

/// Numeric columns of a cycles.csv by name; rows are excitation cycles in order.
struct CycleColumns {
  std::map<std::string, std::vector<double>> columns;
  std::size_t rows = 0;
  bool has(const std::string &name) const { return columns.count(name) != 0; }
  const std::vector<double> &at(const std::string &name) const { return columns.at(name); }
};

/// Reads chain.csv. The frame's four columns may be missing (all of them), so may those of the way, those of
/// two ends, and F_excitation (then zeros).
ChainHistory read_chain(const std::filesystem::path &file, CutRows cut = CutRows::refuse);
/// Reads events.csv.
std::vector<ContactEvent> read_events(const std::filesystem::path &file, CutRows cut = CutRows::refuse);
/// Reads the columns of a cycles.csv that are known; any may be missing. A last row without line end, which a
/// run that was killed or a full disk leaves, is left out.
CycleColumns read_cycle_columns(const std::filesystem::path &file);

/// The text of the files.
std::string chain_text(const ChainHistory &history);
std::string events_text(const std::vector<ContactEvent> &events);
std::string cycles_text(const std::vector<CycleSummary> &cycles);

} // namespace drumlin::post
