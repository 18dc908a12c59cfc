// A record on a command line: the file, and how a measured one is read. One rule and one kind of message for
// all subcommands that take a record.
#pragma once

#include "commands/chain_options.h"
#include "meter/along_way.h"
#include "record/record.h"
#include "support/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

struct RecordArguments : Options {
  explicit RecordArguments(Command &of);
  Texts records =
      words("RECORD", "TEXT",
            "folder of a run, its chain.csv, bed.csv or cycles.csv, or a measured file; several measured "
            "files continue one another");
  Texts columns =
      texts("--column", "NAME=HEADER:UNIT",
            "where a signal stands in a measured file, and in which unit: NAME=HEADER or "
            "NAME=HEADER:UNIT, where HEADER may be the column's number; NAME is time, x_drum, v_drum, "
            "a_drum (up positive), the same with frame, a_left and a_right at both "
            "ends of the drum, F_contact (compression positive) or F_excitation (down positive); a '-' "
            "before the unit turns the sign");
  /// The roller, or the case of Table 1, whose frequency, force and masses count where none is given.
  RollerArguments roller;
  Texts delays =
      texts("--delay", "SIGNAL=TIME",
            "by how much a signal comes later than the time of its row says: 'a_frame=0.5ms'; may be given "
            "several times");
  Text chain_case =
      text("--case", "NAME",
           fmt::format("case of the paper's Table 1 instead of a roller: {}", fmt::join(table1_cases, ", ")));
  Text separator = text("--separator", "WORD",
                        "what stands between cells: comma, semicolon, tab, bar or blank; found if not given");
  Text decimal = text("--decimal", "WORD", "decimal sign: point or comma; found if not given");
  Text logger_low_pass =
      text("--logger-low-pass", "HZ,ORDER",
           "the low-pass filter of the logger: corner frequency [Hz] and order of a Butterworth filter, such "
           "as 200,4; what it has taken is given back, and identify fits what it lets pass");
  Count piece =
      count("--piece", 1, 1'000'000,
            "which piece of a file that gaps, blank cells, or an exciter that is off or changes divide, "
            "counted from 1; the longest if not given",
            "", "WORD");
  Number sampling_rate =
      number("--sampling-rate", {1e-3, 1e9, "Hz"},
             "samples per second [Hz], for a file without times or with times of few digits");
  Number frequency = number("--frequency", {1e-3, 1e6, "Hz"}, "of the excitation [Hz]");
  Number phase =
      number("--phase", {-360.0, 360.0, "degrees"},
             "of the excitation at time 0 [degrees]: F_e = Fw sin(2 pi frequency t + phase), positive down");
  Number Fw = number("--Fw", {1e-9, 1e15, "N"}, "amplitude of the excitation force [N]");
  Number me_re = number("--me-re", {1e-9, 1e12, "kg m"},
                        "eccentric moment m_e r_e [kg m] instead: Fw = m_e r_e (2 pi frequency)^2");
  Number m2 = number("--m2", {1e-6, 1e12, "kg"}, "mass of the drum [kg]");
  Number m3 = number("--m3", {1e-6, 1e12, "kg"}, "mass of the frame on the drum [kg]");
  Number low_pass = number("--low-pass", {1e-3, 1e9, "Hz"},
                           "cut-off frequency of a filter without phase shift for all columns [Hz]");
  Number pulse_angle =
      number("--pulse-angle", {-360.0, 360.0, "degrees"},
             "angle of the exciter at which the column pulse rises [degrees], 0 if not given: F_e = Fw "
             "sin(angle)");
  Number corner_frequency =
      number("--corner-frequency", {1e-4, 1e4, "Hz"},
             "of accelerometers that pass no constant, of first order [Hz]: what they take is given back");
  Number k23 = number(
      "--k23", {1e-3, 1e15, "N/m"},
      "stiffness of the bond of drum and frame [N/m]; a record without the frame's acceleration needs it");
  Number c23 = number("--c23", {0.0, 1e12, "N s/m"}, "damping of the bond [N s/m]");
  std::optional<Number> bond_tolerance; ///< an option of identify alone [%]
  bool guess = false;                   ///< what the columns are, where no name is known: of meter --show
  double exciter_shift = 0.0; ///< place of the exciter along the axle less that of the roller's file [m]
};

/// Options that take a part of the way, of a record that has the place of the roller in each row.
struct WayArguments : Options {
  using Options::Options;
  Number from = number("--from-place", {-1e6, 1e6, "m"},
                       "only the way from this place on [m], of a roller that drives (column s of the run)");
  Number to =
      number("--to-place", {-1e6, 1e6, "m"}, "only the way up to this place [m], of a roller that drives");
  Count pass = count("--of-pass", 1, 65535,
                     "only this pass of a roller that drives, counted from 1; the last one if not given");
};

/// UsageError for numbers that cannot be used.
WayRange judged(const WayArguments &arguments);

/// The length of a window given in metres, such as 0.5m [m]; nothing for a text without that unit.
std::optional<double> window_length(const std::string &text);

/// The files that make up the record: of a run all from which it may be read.
std::vector<GivenPath> files_of(const RecordArguments &arguments);

/// Reads the record that was asked for; UsageError for options that cannot be used, std::runtime_error for a
/// file that cannot.
Record judged(const RecordArguments &arguments);

/// The text of a parameters.csv beside results: the record, the numbers of the machine that counted, and what
/// followed from a roller's file.
std::string settings_of(const Record &record);

} // namespace drumlin::post
