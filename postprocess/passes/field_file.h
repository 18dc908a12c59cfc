// What rollers with a meter and a satellite receiver have written on a site: the table of all passes that
// compaction software exports, a row for each cell of its grid and pass. `drumlin meter --export` writes one.
//
// Its columns, as public programs that write or read it have them: Time; CellN_m, CellE_m, Elevation_m or the
// same with _FT or without unit, or Lat, Long in degrees; PassNumber or PassCount; Speed_km/h or Speed_mph,
// or Speed with the unit in each cell; ValidPos; VibeState; LastCMV, LastRMV, LastMDP and so on, or these
// names without Last; LastFreq_Hz, LastAmp_mm; '?' is a value that is not known. Others do not count.
#pragma once

#include "passes/meter_map.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// A row of the file, SI units; NaN: not known.
struct FieldRow {
  int pass = 1;
  std::size_t place = 0; ///< of FieldFile::places
  double value;          ///< of the meter
  double elevation, speed, frequency, amplitude;
};

struct FieldFile {
  std::filesystem::path file;
  std::string meter, unit;        ///< as it is called in the file; "?": the file does not tell the unit
  double cell = 0.0;              ///< m, side of a cell
  std::vector<MapPlace> places;   ///< along the longest extent of the cells, from 0
  std::vector<FieldRow> rows;     ///< by pass, then by place; one for each of both
  std::vector<std::string> notes; ///< how the file was understood and what was left out, sentences
};

/// Reads a file. std::runtime_error of one line: a column that is missing, a cell that is no number, no row
/// that is left.
/// \param meter name of a column, with or without Last and unit
/// \param cell m, side of the cells of the file's grid
FieldFile read_field_file(const std::filesystem::path &file, const std::string &meter, double cell);

/// The values of its meter. std::runtime_error of one line if there is none.
MeterMap meter_map(const FieldFile &field);

/// passes.csv of a site: a row for each pass.
std::string passes_csv(const FieldFile &field);
/// way.csv of a site: a row for each cell and pass.
std::string way_csv(const FieldFile &field);

} // namespace drumlin::post
