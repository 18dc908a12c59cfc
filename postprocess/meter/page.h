// The files of meter values: CSV tables for machines, and a page with plots.
#pragma once

#include "meter/both_ends.h"
#include "meter/values.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// Meter values of a record with what they were made from.
struct MeterResult {
  Record record;
  MeterRecord cycles;
  MeterOptions options;
  std::vector<MeterWindow> windows;
  std::optional<BothEnds> ends{}; ///< of a record of both ends of the drum
};

/// meter.csv: a row for each window, units in the header, an empty cell where a value cannot be computed. A
/// record of both ends has more columns behind these: k_1 of a meter at either end, k_1 and c_1 below each
/// half.
std::string meter_csv(const MeterResult &result);

/// What the values come from and how exact that is, as a sentence.
std::string source_words(const MeterResult &result);

/// Of which width the forces are, and what that means for E_vib and stiffnesses; empty if there is nothing to
/// say.
std::string width_words(const MeterResult &result);

/// Over which length of the way the last window averages the soil, see averaging_words() of a record; empty
/// if the roller does not drive.
std::string averaging_words(const MeterResult &result);

/// How a record was understood: how its files are written, what its columns are, its pieces, rate and length.
std::vector<std::string> reading_words(const Record &record);

/// The last window in one line: mode, CMV with its bound, RMV and the other values that there are.
std::string answer_line(const MeterResult &result);

/// Writes a page index.html that shows what was read: reading_words(), and the first second of each signal.
void write_reading_page(const std::filesystem::path &folder, const Record &record);

/// Writes a page index.html with plots (values along the record, spectrum, loop) and their data into a folder
/// that exists.
void write_meter_page(const std::filesystem::path &folder, const MeterResult &result);

} // namespace drumlin::post
