// Run folders with the files that the decks write, made without an engine, dumps written by hand, studies in
// a scratch folder, and ways to damage a file.
#pragma once

#include "tests/support/prelude.h"
#include "chain/parameters.h"
#include "support/process.h"

namespace drumlin::test {

/// A run folder whose files are the direct solution of a case of Table 1.
void write_chain_run(const std::filesystem::path &folder, const std::string &case_name,
                     post::Transition transition, int cycles,
                     const std::string &command = "drumlin run in.chain");

/// An impact, from the closed form.
void write_impact_run(const std::filesystem::path &folder, post::Transition transition, double damping_ratio);

constexpr int rows_per_cycle = 8; ///< of write_bed_run()
constexpr double period = 0.05;   ///< of its excitation, s

/// A run of a bed, with numbers that are easy to check by hand. Of six cycles the last four are steady.
void write_bed_run(const std::filesystem::path &folder, post::Transition transition, int cycles = 6,
                   const std::string &friction = "0.5");

/// Its dumps, of steps 0, 200 (row 2, 2 kN), 700 (row 7, 7 kN) and 800 (row 8, 0 kN).
void write_bed_dumps(const std::filesystem::path &folder);

/// One array of a VTK file.
struct Array {
  std::string name;
  int components;
  std::string values;
};

/// A VTK file of points.
std::string point_data(int points, const std::string &places, const std::vector<Array> &arrays);

/// Two soil balls side by side, id 1 and 2, and the drum, id 9, above the first; not in order.
std::map<std::string, Array> ball_arrays();
std::string ball_dump(const std::map<std::string, Array> &arrays = ball_arrays(),
                      const std::string &places = "1 3.9 0 2.8 1 0 1 1 0");

/// Ball 2 on 1 named by the higher id first, the drum on 1, and 1 on the floor.
const std::string contact_rows = "2 1 100 30 0 1 0 0 0.2\n1 9 0 -400 0 0 -1 0 0.1\n1 0 5 430 0 0 1 0 0.05\n";
std::string contact_dump(const std::string &rows = contact_rows);

class ScratchStudy {
public:
  explicit ScratchStudy(std::string name);
  ~ScratchStudy();
  ScratchStudy(const ScratchStudy &) = delete;
  ScratchStudy &operator=(const ScratchStudy &) = delete;

  /// `drumlin study NAME --quick --out out`, from the scratch folder.
  post::Outcome run() const;
  std::filesystem::path out() const { return folder_ / "out"; }

private:
  std::string name_;
  std::filesystem::path folder_;
};

/// The one file of a folder whose name begins and ends as given, with a fingerprint between.
std::filesystem::path made_file(const std::filesystem::path &folder, const std::string &begin,
                                const std::string &end);

/// Removes every second row of a file and cuts the last one short, as if the study had been killed.
void interrupt(const std::filesystem::path &file);

/// Random choices that are the same on every machine, unlike those of the distributions of the standard
/// library.
class Choice {
public:
  explicit Choice(unsigned seed) : bits_(seed) {}
  /// 0 to count - 1; 0 if count is 0.
  std::size_t below(std::size_t count) { return count == 0 ? 0 : bits_() % count; }
  template <class Values>
  const auto &of(const Values &values) {
    return values[below(values.size())];
  }

private:
  std::mt19937_64 bits_;
};

/// The text with one fault, of a kind and at a place that are chosen at random.
std::string damaged(const std::string &text, Choice &choice);

} // namespace drumlin::test
