// Polynomials in s, 0 <= s <= 1, that are pieces of a motion: power series of the exponential of a matrix,
// cut off where the remainder is below the rounding error. Bernstein's coefficients are bounds of a
// polynomial, so that no root is overlooked.
#pragma once

#include <array>
#include <cstddef>

namespace drumlin::post {

/// Upper limit of the number of terms of a power series.
constexpr std::size_t most_terms = 33;
/// A piece is so long that the norm of the matrix times the length, its reach, is at most this: the series
/// then has no cancellation that costs a digit.
constexpr double most_reach = 3.5;
/// The number of terms after which those of a series of this reach are below 1e-18 of its sum.
std::size_t terms_of_series(double reach);

/// The first s in [0, 1] where a polynomial that is not positive at s = 0 becomes positive; 2 if it does not.
/// Coefficients of s^0, s^1, ..., at most `most_terms`. No crossing is missed: an interval is discarded only
/// if the Bernstein coefficients show that the polynomial is not positive in it, or if it is shorter than
/// 1e-13.
double first_upcrossing(const double *coefficients, std::size_t terms);

/// The largest value of a polynomial for s in [0, 1], or `known` if that is larger.
double largest_value(const double *coefficients, std::size_t terms, double known);

/// Widens `min` to `max` by the values of a polynomial of `terms` terms over 0 <= s <= 1, whose coefficients
/// change their sign.
void widen(std::array<double, most_terms> &coefficients, std::size_t terms, double &min, double &max);

} // namespace drumlin::post
