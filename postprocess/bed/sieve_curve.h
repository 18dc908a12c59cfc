// Grain size distributions as a laboratory gives them: the share of the mass that passes each sieve.
//
// Between two sieves the curve is a straight line over the logarithm of the size, as it is drawn in soil
// mechanics. Sizes are openings of sieves, and diameters of balls: a ball passes a sieve that is not smaller.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::post {

/// One sieve of an analysis.
struct Sieve {
  double size;    ///< m, opening
  double passing; ///< share of the mass that passes, 0 to 1
};

/// What is wrong with a list of sieves: the row (from 0), which of its two values, and, as what(), what is
/// allowed.
class SieveFault : public std::invalid_argument {
public:
  enum class Value { size, passing };
  SieveFault(std::size_t faulty_row, Value faulty_value, const std::string &allowed)
      : std::invalid_argument(allowed), row(faulty_row), value(faulty_value) {}
  std::size_t row;
  Value value;
};

/// A grain size distribution.
class SieveCurve {
public:
  static constexpr double smallest_size = 1e-9; ///< m, of a sieve
  static constexpr double largest_size = 1e3;   ///< m

  /// \param sieves sizes rise, shares do not fall, and the last one is 1, so that the largest grain is known.
  /// Sieves that nothing passes, and sieves that everything passes, are left out except for the ones next to
  /// the grains. Throws SieveFault, and std::invalid_argument without sieves.
  explicit SieveCurve(std::vector<Sieve> sieves);

  const std::vector<Sieve> &sieves() const { return sieves_; }
  /// Size of the finest grains that the curve tells of, m. If some mass passes this sieve it has finer
  /// grains, of unknown size.
  double smallest() const { return sieves_.front().size; }
  /// Size of the largest grain, m.
  double largest() const { return sieves_.back().size; }

  /// Share of the mass that passes a sieve of this size; below smallest() the share at smallest().
  double passing(double size) const;
  /// The size that this share (0 to 1) of the mass passes, the smallest one where there are several; at least
  /// smallest().
  double size(double passing) const;

  /// The curve of the coarser grains alone, when all that are finer than `size` are taken away.
  /// \param size from smallest() to less than largest(); else std::invalid_argument
  SieveCurve coarser_than(double size) const;

private:
  std::vector<Sieve> sieves_;
};

/// The curve of "SMALLEST-LARGEST", sizes in mm such as 32-48: the same mass in equal intervals of ln(size)
/// between them. Nothing if the text is not of this form, or its sizes are not two that rise.
std::optional<SieveCurve> curve_between(const std::string &text);

/// Reads a table as a laboratory writes it (MeasuredTable), a row for each sieve, the finest or the coarsest
/// first: a column `size`, in mm if it has no unit, and one of
/// - `passing`, in %;
/// - `individual retained`, the mass or share in % that stays on each sieve;
/// - `cumulative retained`, what stays on it and on all coarser ones;
/// - `retained`, the same as `individual retained`, refused if it could be cumulative.
/// A row of size 0 is the pan; without it the rest of 100 % is finer than all. Capitals do not matter, and
/// "% passing" is "passing (%)".
/// Throws std::runtime_error that names file, line, column, value and what is allowed.
SieveCurve read_sieve_file(const std::filesystem::path &file);

/// The numbers of balls of each size that have the masses of a curve: between two sieves the mass in an
/// interval d ln(size) is the same for all sizes, so that the number in it goes with size^-n. In two
/// dimensions balls are discs of one thickness, n = 2; in three, n = 3. All have one density.
class BallNumbers {
public:
  /// \param curve no mass passes its smallest sieve, as coarser_than() makes it; else std::invalid_argument
  /// \param dimensions 2 or 3
  BallNumbers(const SieveCurve &curve, int dimensions);

  /// Share of all balls that are not larger than `size`.
  double share_finer(double size) const;
  /// The size that this share (0 to 1) of all balls does not exceed.
  double size(double share) const;
  /// Mean over all balls of size^n: the size, to the power of n, of the ball of mean mass.
  double mean_power() const { return mean_power_; }

private:
  double power(double size) const; ///< size^-n

  int dimensions_;
  std::vector<double> sizes_;  ///< of the sieves
  std::vector<double> shares_; ///< of all balls that are finer than each sieve
  double mean_power_;
};

/// Balls sorted by size, as sieves would do it.
class Sieving {
public:
  /// \param sizes diameters, m, at least one
  /// \param dimensions 2 or 3: mass goes with the second or third power of the size
  Sieving(std::vector<double> sizes, int dimensions);

  /// Share of the mass that passes a sieve of this size.
  double passing(double size) const;
  /// The smallest size that at least this share (0 to 1) of the mass passes.
  double size(double passing) const;
  const std::vector<double> &sizes() const { return sizes_; } ///< rising

private:
  std::vector<double> sizes_;
  std::vector<double> passing_; ///< share of the mass of this ball and all before it
};

/// The sizes by which soil mechanics describes a distribution, m: d10 is the size that 10 % of the mass pass.
struct GrainSizes {
  double d10, d30, d50, d60;
  /// Coefficient of uniformity C_u = d60 / d10.
  double uniformity() const { return d60 / d10; }
  /// Coefficient of curvature C_c = d30^2 / (d60 d10).
  double curvature() const { return d30 * d30 / (d60 * d10); }
};

/// Of a SieveCurve or a Sieving.
template <class Distribution>
GrainSizes grain_sizes(const Distribution &of) {
  return {of.size(0.1), of.size(0.3), of.size(0.5), of.size(0.6)};
}

} // namespace drumlin::post
