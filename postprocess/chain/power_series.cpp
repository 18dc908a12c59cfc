#include "chain/power_series.h"

#include <algorithm>
#include <cmath>

namespace drumlin::post {

namespace {

// reach[n]: if norm times length is at most this, the terms from n on are below 1e-18 of the sum.
std::array<double, most_terms + 1> reaches() {
  std::array<double, most_terms + 1> reach{};
  double factorial = 1.0;
  for (std::size_t n = 1; n <= most_terms; ++n) {
    factorial *= static_cast<double>(n);
    reach[n] = std::pow(1e-18 * factorial, 1.0 / static_cast<double>(n));
  }
  return reach;
}
const std::array<double, most_terms + 1> reach_of_terms = reaches();

// bernstein[n][j][i] = C(i, j) / C(n, j): from the coefficients of powers to those of Bernstein's polynomials
// of degree n.
struct BernsteinWeights {
  std::array<std::array<std::array<double, most_terms>, most_terms>, most_terms> of_degree{};
  BernsteinWeights() {
    std::array<std::array<double, most_terms>, most_terms> choose{};
    for (std::size_t n = 0; n < most_terms; ++n) {
      choose[n][0] = 1.0;
      for (std::size_t k = 1; k <= n; ++k)
        choose[n][k] = choose[n - 1][k - 1] + (k < n ? choose[n - 1][k] : 0.0);
    }
    for (std::size_t n = 0; n < most_terms; ++n)
      for (std::size_t i = 0; i <= n; ++i)
        for (std::size_t j = 0; j <= i; ++j)
          of_degree[n][j][i] = choose[i][j] / choose[n][j];
  }
};
const BernsteinWeights bernstein;

struct Polynomial {
  const double *a;
  std::size_t terms;

  double at(double s) const {
    double value = 0.0;
    for (std::size_t n = terms; n-- > 0;)
      value = value * s + a[n];
    return value;
  }
  void with_slope(double s, double &value, double &slope) const {
    value = slope = 0.0;
    for (std::size_t n = terms; n-- > 0;) {
      slope = slope * s + value;
      value = value * s + a[n];
    }
  }
};

// The one root between lo, where the polynomial is negative, and hi, where it is positive: Newton, kept
// inside the bracket. A step that rounding makes zero leads to an end of the bracket; it ends the search and
// is not replaced by a bisection.
double bracketed_root(const Polynomial &p, double lo, double hi) {
  constexpr double smallest = 4e-16; // s counts from 0 to 1
  double s = 0.5 * (lo + hi);
  double last = hi - lo;
  for (int i = 0; i < 100; ++i) {
    double value = 0.0;
    double slope = 0.0;
    p.with_slope(s, value, slope);
    if (value == 0.0) return s;
    (value > 0.0 ? hi : lo) = s;
    double next = s - value / slope;
    if (std::fabs(next - s) <= smallest) return s;
    if (!(next > lo && next < hi) || std::fabs(next - s) > 0.5 * last) next = 0.5 * (lo + hi);
    last = std::fabs(next - s);
    if (last <= smallest) return next;
    s = next;
  }
  return s;
}

using Control = std::array<double, most_terms>;

// De Casteljau's halving of the interval of a polynomial.
struct Halves {
  Control left{}, right{};
  Halves(const Control &whole, std::size_t last) : right(whole) {
    left[0] = right[0];
    for (std::size_t level = 1; level <= last; ++level) {
      for (std::size_t i = 0; i + level <= last; ++i)
        right[i] = 0.5 * (right[i] + right[i + 1]);
      left[level] = right[0];
    }
  }
};

double first_in(const Polynomial &p, const Control &b, double lo, double hi) {
  const std::size_t last = p.terms - 1;
  int changes = 0;
  double sign = 0.0;
  bool first_negative = false;
  for (std::size_t i = 0; i <= last; ++i) {
    if (b[i] == 0.0) continue;
    if (sign == 0.0)
      first_negative = b[i] < 0.0;
    else if ((b[i] > 0.0) != (sign > 0.0))
      ++changes;
    sign = b[i];
  }
  if (sign == 0.0 || (changes == 0 && first_negative)) return 2.0;
  if (b[0] > 0.0 || !first_negative) return lo; // positive from here on
  if (changes == 1 && b[last] > 0.0) return bracketed_root(p, lo, hi);
  if (hi - lo < 1e-13) return b[last] > 0.0 ? hi : 2.0;
  const Halves halves(b, last);
  const double middle = 0.5 * (lo + hi);
  const double found = first_in(p, halves.left, lo, middle);
  return found <= 1.0 ? found : first_in(p, halves.right, middle, hi);
}

// The largest value of a polynomial, or `known`; differences below `rounding` do not count.
double largest_in(const Control &b, std::size_t last, double known, double rounding) {
  known = std::max({known, b[0], b[last]});
  const auto *const end = b.begin() + static_cast<std::ptrdiff_t>(last) + 1;
  if (*std::max_element(b.begin(), end) <= known + rounding) return known;
  const Halves halves(b, last);
  return largest_in(halves.right, last, largest_in(halves.left, last, known, rounding), rounding);
}

// Bernstein's coefficients of the first `terms` terms.
Control control_points(const double *coefficients, std::size_t terms) {
  Control b{};
  const auto &weights = bernstein.of_degree[terms - 1];
  for (std::size_t j = 0; j < terms; ++j)
    for (std::size_t i = j; i < terms; ++i)
      b[i] += weights[j][i] * coefficients[j];
  return b;
}

// Whether the first `few` terms, with a bound of the others, show that the polynomial is negative. Their
// number is known to the compiler, which makes this several times faster than control_points().
template <std::size_t few>
bool stays_below(const double *coefficients, std::size_t terms) {
  if (terms <= few) return false;
  double rest = 0.0;
  for (std::size_t n = few; n < terms; ++n)
    rest += std::fabs(coefficients[n]);
  if (rest >= -coefficients[0]) return false; // the value at s = 0 is one of the bounds
  const auto &weights = bernstein.of_degree[few - 1];
  std::array<double, few> b{};
  for (std::size_t j = 0; j < few; ++j)
    for (std::size_t i = 0; i < few; ++i) // the weights of i < j are zero
      b[i] += weights[j][i] * coefficients[j];
  return *std::max_element(b.begin(), b.end()) + rest < 0.0;
}

} // namespace

std::size_t terms_of_series(double reach) {
  std::size_t terms = 6;
  while (terms < most_terms && reach_of_terms[terms] < reach)
    ++terms;
  return terms;
}

double first_upcrossing(const double *coefficients, std::size_t terms) {
  if (coefficients[0] > 0.0) return 0.0;
  // Most pieces stay well below zero, which the first terms show, with a bound of the others. Eight suffice
  // for a slow motion; while a heavily damped part of it decays, as many as sixteen are needed.
  if (stays_below<8>(coefficients, terms) || stays_below<16>(coefficients, terms)) return 2.0;
  return first_in({coefficients, terms}, control_points(coefficients, terms), 0.0, 1.0);
}

double largest_value(const double *coefficients, std::size_t terms, double known) {
  double size = 0.0;
  for (std::size_t n = 0; n < terms; ++n)
    size += std::fabs(coefficients[n]);
  if (coefficients[0] + (size - std::fabs(coefficients[0])) <= known) return known;
  return largest_in(control_points(coefficients, terms), terms - 1, known, 1e-15 * size);
}

void widen(std::array<double, most_terms> &coefficients, std::size_t terms, double &min, double &max) {
  max = largest_value(coefficients.data(), terms, max);
  for (double &coefficient : coefficients)
    coefficient = 0.0 - coefficient;
  min = -largest_value(coefficients.data(), terms, -min);
}

} // namespace drumlin::post
