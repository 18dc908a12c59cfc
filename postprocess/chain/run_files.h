// The CSV files of a chain run: chain.csv, events.csv, cycles.csv, parameters.csv. One reader and one writer
// per file, for the engine's output and for the direct solver's alike.
//
// Readers find columns by the names in the header line and throw std::runtime_error with file, line, column
// and what was found. Writers put the whole text into a temporary file beside the target and rename it, so
// that no reader ever meets a file half written. Numbers have 17 digits and come back bit for bit.
#pragma once

#include "chain/parameters.h"
#include "support/files.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Time series of a chain, one vector per column of chain.csv, all of one length (the frame's may be empty).
struct ChainHistory {
  std::vector<double> time;         ///< from the start of the excitation [s]
  std::vector<double> x_drum;       ///< 0 where drum and soil just touch, up positive [m]
  std::vector<double> v_drum;       ///< [m/s]
  std::vector<double> a_drum;       ///< [m/s2]
  std::vector<double> x_frame;      ///< equals x_drum where the bond is unstretched [m]; empty if no frame
  std::vector<double> v_frame;      ///< [m/s]; empty if no frame
  std::vector<double> a_frame;      ///< [m/s2]; empty if no frame
  std::vector<double> F_contact;    ///< positive in compression [N]
  std::vector<double> F_excitation; ///< F_e, positive pushes the drum down [N]; zeros if the file has none
  std::vector<double> F_bond; ///< c23 (v_frame - v_drum) + k23 (x_frame - x_drum) [N]; empty if no frame

  /// Number of rows.
  std::size_t size() const { return time.size(); }
  /// Whether the frame's columns are there.
  bool has_frame() const { return !x_frame.empty(); }
};

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

/// What one cycle of the excitation did: one row of cycles.csv.
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

/// A small CSV table, all cells as text. RFC 4180 quotes are taken off: a quoted cell may hold commas,
/// doubled quotes and line ends.
class Table {
public:
  Table(std::filesystem::path file, std::vector<std::string> header,
        std::vector<std::vector<std::string>> rows, std::vector<std::size_t> lines);

  const std::filesystem::path &file() const { return file_; }
  const std::vector<std::string> &header() const { return header_; }
  std::size_t rows() const { return rows_.size(); }
  /// Line of the file where a row (counted from 0) starts, counted from 1.
  std::size_t line(std::size_t row) const { return lines_.at(row); }
  /// Whether the header names `column`.
  bool has(std::string_view column) const;
  /// Cells of the column as text.
  std::vector<std::string> text(std::string_view column) const;
  /// Cells of the column as finite numbers.
  std::vector<double> numbers(std::string_view column) const;
  /// Cells of the column as whole numbers.
  std::vector<long> integers(std::string_view column) const;

private:
  std::size_t index_of(std::string_view column) const;

  std::filesystem::path file_;
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
  std::vector<std::size_t> lines_; // where each row starts in the file
};

/// Reads any CSV file with a header line and as many cells in every row as names in the header.
Table read_table(const std::filesystem::path &file);

/// Reads chain.csv. The frame's four columns may be missing (all of them), so may F_excitation (then zeros).
ChainHistory read_chain(const std::filesystem::path &file);
/// Reads events.csv.
std::vector<ContactEvent> read_events(const std::filesystem::path &file);
/// Reads cycles.csv; makes and breaks may be missing (then 0).
std::vector<CycleSummary> read_cycles(const std::filesystem::path &file);
/// Reads parameters.csv, header name,value.
std::map<std::string, std::string> read_parameters(const std::filesystem::path &file);

/// The text of the files.
std::string chain_text(const ChainHistory &history);
std::string events_text(const std::vector<ContactEvent> &events);
std::string cycles_text(const std::vector<CycleSummary> &cycles);
std::string parameters_text(const std::vector<std::pair<std::string, std::string>> &parameters);

/// The chain's parameters by the names that decks, commands and parameters.csv give them, as text.
std::vector<std::pair<std::string, std::string>> parameter_values(const ChainParameters &parameters);

void write_chain(const std::filesystem::path &file, const ChainHistory &history);
void write_events(const std::filesystem::path &file, const std::vector<ContactEvent> &events);
void write_cycles(const std::filesystem::path &file, const std::vector<CycleSummary> &cycles);
void write_parameters(const std::filesystem::path &file,
                      const std::vector<std::pair<std::string, std::string>> &parameters);

/// One cell of CSV: `text` itself, or quoted if it holds a comma, a quote or a line end.
std::string csv_cell(std::string_view text);

/// The number that `text` holds, all of it and nothing else, finite; else std::invalid_argument.
double number_from_text(std::string_view text);

/// The number with 17 digits, which come back bit for bit.
std::string number_text(double value);

} // namespace drumlin::post
