#include "chain/closed_form.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

namespace drumlin::post {

namespace {

// After this number of time constants a decaying mode is below 1e-16 of its first value.
constexpr double decayed = 37.0;

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

std::array<double, most_terms + 1> inverses() {
  std::array<double, most_terms + 1> inverse{};
  for (std::size_t n = 1; n <= most_terms; ++n)
    inverse[n] = 1.0 / static_cast<double>(n);
  return inverse;
}
const std::array<double, most_terms + 1> inverse = inverses();

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

// ---- pieces ----

ChainState MotionPiece::state(double s) const {
  ChainState sum = ChainState::Zero();
  for (std::size_t n = terms; n-- > 0;)
    for (int i = 0; i < 4; ++i)
      sum[i] = sum[i] * s + coefficient[n][static_cast<std::size_t>(i)];
  return sum;
}

double MotionPiece::drum_acceleration(double s) const {
  double sum = 0.0;
  for (std::size_t n = terms; n-- > 1;)
    sum = sum * s + static_cast<double>(n) * coefficient[n][1];
  return sum / length;
}

namespace {

using Wide =
    long double; // a fast mode is split off with its cancellations in more digits than the rest of the work

struct FastMode {
  Wide root = 0;
  std::array<Wide, 4> right{}, left{};
};

// The eigenvalue of largest modulus if it is real, with its vectors. Newton from beyond all roots goes down
// to it. det(M r^2 + C r + K) = 0 has positive coefficients only, so each is known to full relative accuracy.
bool fastest_real_mode(const ChainParameters &p, double k, double c, FastMode &mode) {
  const Wide m2 = p.m2;
  const Wide m3 = p.m3;
  const Wide k23 = p.k23;
  const Wide c23 = p.c23;
  const std::array<Wide, 5> a = {k * k23, c * k23 + k * c23, m2 * k23 + c * c23 + m3 * (k + k23),
                                 m2 * c23 + m3 * (c + c23), m2 * m3};
  Wide r = -a[3] / a[4];
  if (r == 0) return false;
  bool found = false;
  for (int i = 0; i < 60 && !found; ++i) {
    Wide value = 0;
    Wide slope = 0;
    for (std::size_t n = 5; n-- > 0;) {
      slope = slope * r + value;
      value = value * r + a[n];
    }
    if (slope == 0) return false;
    const Wide next = r - value / slope;
    found = std::fabs(next - r) <= 4 * std::numeric_limits<Wide>::epsilon() * std::fabs(r);
    r = next;
    if (!(r < 0)) return false;
  }
  if (!found) return false;
  // Shape of the mode, from the frame's equation.
  const Wide scale = m3 * r * r;
  const std::array<Wide, 2> shape = {(scale + c23 * r + k23) / scale, (c23 * r + k23) / scale};
  const std::array<Wide, 2> stiff = {(k + k23) * shape[0] - k23 * shape[1], k23 * (shape[1] - shape[0])};
  mode.root = r;
  mode.right = {shape[0], r * shape[0], shape[1], r * shape[1]};
  // (r M + C) shape = -K shape / r: the right-hand side has no cancellation.
  mode.left = {-stiff[0] / r, m2 * shape[0], -stiff[1] / r, m3 * shape[1]};
  Wide product = 0;
  for (std::size_t i = 0; i < 4; ++i)
    product += mode.left[i] * mode.right[i];
  if (product == 0) return false;
  for (Wide &entry : mode.left)
    entry /= product;
  return true;
}

} // namespace

PhaseDynamics::PhaseDynamics(const ChainParameters &p, double k, double c)
    : omega_(p.omega), push_(-p.Fw / p.m2), gravity_(-p.g) {
  if (k > 0.0 && p.k23 > 0.0) {
    rest_drum_ = -(p.m2 + p.m3) * p.g / k;
    rest_frame_ = rest_drum_ - p.m3 * p.g / p.k23;
    gravity_ = 0.0;
  }
  full_ = {{{0.0, 1.0, 0.0, 0.0},
            {-(k + p.k23) / p.m2, -(c + p.c23) / p.m2, p.k23 / p.m2, p.c23 / p.m2},
            {0.0, 0.0, 0.0, 1.0},
            {p.k23 / p.m3, p.c23 / p.m3, -p.k23 / p.m3, -p.c23 / p.m3}}};
  // With positions scaled by this rate the largest sum of a row of A is the rate itself.
  const auto rate = [](double stiffness, double damping) {
    return 0.5 * damping + std::sqrt(0.25 * damping * damping + stiffness);
  };
  full_rate_ = std::max({p.omega, rate((k + 2.0 * p.k23) / p.m2, (c + 2.0 * p.c23) / p.m2),
                         rate(2.0 * p.k23 / p.m3, 2.0 * p.c23 / p.m3)});
  slow_rate_ = full_rate_;

  FastMode mode;
  if (!fastest_real_mode(p, k, c, mode)) return;
  Rows slow{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      const bool drum = i == 1;
      Wide entry = i == 0 ? (j == 1) : i == 2 ? (j == 3) : 0;
      if (i % 2 == 1) {
        const Wide kc =
            j < 2 ? (drum ? (j == 0 ? Wide(k) + p.k23 : Wide(c) + p.c23) : -(j == 0 ? p.k23 : p.c23))
                  : (drum ? -(j == 2 ? p.k23 : p.c23) : (j == 2 ? p.k23 : p.c23));
        entry = -kc / (drum ? p.m2 : p.m3);
      }
      slow[i][j] = static_cast<double>(entry - mode.root * mode.right[i] * mode.left[j]);
    }
  double slow_rate = p.omega;
  for (int pass = 0; pass < 50; ++pass) {
    double largest = p.omega;
    for (std::size_t i = 0; i < 4; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < 4; ++j)
        sum += std::fabs(slow[i][j]) * (i % 2 == j % 2 ? 1.0 : i % 2 == 0 ? slow_rate : 1.0 / slow_rate);
      largest = std::max(largest, sum);
    }
    if (largest <= slow_rate * 1.0001) break;
    slow_rate = largest;
  }
  // This saves time if the decay is much shorter than a cycle, and is accurate because the eigenvalue is then
  // far from all others.
  if (!(full_rate_ > 12.0 * slow_rate)) return;
  slow_ = slow;
  slow_rate_ = slow_rate;
  fast_ = static_cast<double>(mode.root);
  for (std::size_t i = 0; i < 4; ++i) {
    fast_right_[i] = static_cast<double>(mode.right[i]);
    fast_left_[i] = static_cast<double>(mode.left[i]);
  }
}

double PhaseDynamics::longest_piece(double since) const {
  return most_reach / (fast_ == 0.0 || since * -fast_ < decayed ? full_rate_ : slow_rate_);
}

namespace {

template <class Rows>
void next_term(const Rows &a, const std::array<double, 4> &y, double factor, std::array<double, 4> &next) {
  for (std::size_t i = 0; i < 4; ++i)
    next[i] = factor * ((a[i][0] * y[0] + a[i][1] * y[1]) + (a[i][2] * y[2] + a[i][3] * y[3]));
}

} // namespace

// Longer than other functions: it is the inner loop of maps, and both cases, with and without a fast mode,
// are written out for speed.
void PhaseDynamics::expand(MotionPiece &piece, const ChainState &from, double length, double sine,
                           double cosine) const {
  ChainState state = from;
  state[0] -= rest_drum_;
  state[2] -= rest_frame_;
  auto &y = piece.coefficient;
  piece.length = length;
  const bool split = length * full_rate_ > 1.001 * most_reach;
  piece.terms = terms_of_series(length * (split ? slow_rate_ : full_rate_));
  const double turn = omega_ * length;
  double s = sine;
  double c = cosine;
  if (!split) {
    for (std::size_t i = 0; i < 4; ++i)
      y[0][i] = state[static_cast<Eigen::Index>(i)];
    for (std::size_t n = 0; n + 1 < piece.terms; ++n) {
      const double share = inverse[n + 1];
      const double factor = length * share;
      const double gravity = n == 0 ? gravity_ : 0.0;
      std::array<double, 4> &next = y[n + 1];
      next[0] = factor * y[n][1];
      next[2] = factor * y[n][3];
      // Summed in pairs, which need not wait for one another.
      next[1] = factor * ((full_[1][0] * y[n][0] + full_[1][1] * y[n][1]) +
                          (full_[1][2] * y[n][2] + full_[1][3] * y[n][3]) + (gravity + push_ * s));
      next[3] = factor * ((full_[3][0] * y[n][0] + full_[3][1] * y[n][1]) +
                          (full_[3][2] * y[n][2] + (full_[3][3] * y[n][3] + gravity)));
      const double rise = turn * share * c;
      c = -turn * share * s;
      s = rise;
    }
    y[0][0] += rest_drum_;
    y[0][2] += rest_frame_;
    return;
  }
  // The fast mode has decayed to its forced part, a' = fast a + left (force); the others have no fast rate
  // left.
  double amount = 0.0;
  for (std::size_t i = 0; i < 4; ++i)
    amount += fast_left_[i] * state[static_cast<Eigen::Index>(i)];
  for (std::size_t i = 0; i < 4; ++i)
    y[0][i] = state[static_cast<Eigen::Index>(i)] - fast_right_[i] * amount;
  const double constant = (fast_left_[1] + fast_left_[3]) * gravity_;
  const double swing = fast_left_[1] * push_;
  const double norm = 1.0 / (fast_ * fast_ + omega_ * omega_);
  std::array<double, most_terms> forced{};
  for (std::size_t n = 0; n < piece.terms; ++n) {
    forced[n] = -swing * norm * (fast_ * s + omega_ * c) - (n == 0 ? constant / fast_ : 0.0);
    if (n + 1 == piece.terms) break;
    const double share = inverse[n + 1];
    const double factor = length * share;
    next_term(slow_, y[n], factor, y[n + 1]);
    const double gravity = n == 0 ? gravity_ : 0.0;
    const double fast_force = (n == 0 ? constant : 0.0) + swing * s;
    y[n + 1][1] += factor * (gravity + push_ * s);
    y[n + 1][3] += factor * gravity;
    for (std::size_t i = 0; i < 4; ++i)
      y[n + 1][i] -= factor * fast_right_[i] * fast_force;
    const double rise = turn * share * c;
    c = -turn * share * s;
    s = rise;
  }
  for (std::size_t n = 0; n < piece.terms; ++n)
    for (std::size_t i = 0; i < 4; ++i)
      y[n][i] += fast_right_[i] * forced[n];
  y[0][0] += rest_drum_;
  y[0][2] += rest_frame_;
}

ChainState PhaseDynamics::carry(const ChainState &difference, double time) const {
  const bool split = time * full_rate_ > 1.001 * most_reach;
  std::array<double, 4> term{};
  for (std::size_t i = 0; i < 4; ++i)
    term[i] = difference[static_cast<Eigen::Index>(i)];
  ChainState sum = ChainState::Zero();
  if (split) {
    double amount = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
      amount += fast_left_[i] * term[i];
    const double left = amount * std::exp(fast_ * time);
    for (std::size_t i = 0; i < 4; ++i) {
      term[i] -= fast_right_[i] * amount;
      sum[static_cast<Eigen::Index>(i)] = fast_right_[i] * left;
    }
  }
  const std::size_t terms = terms_of_series(time * (split ? slow_rate_ : full_rate_));
  for (std::size_t n = 0;; ++n) {
    for (std::size_t i = 0; i < 4; ++i)
      sum[static_cast<Eigen::Index>(i)] += term[i];
    if (n + 1 >= terms) break;
    std::array<double, 4> next{};
    next_term(split ? slow_ : full_, term, time * inverse[n + 1], next);
    term = next;
  }
  return sum;
}

// ---- the chain ----

ChainSolver::ChainSolver(const ChainParameters &parameters)
    : parameters_(parameters), c_(parameters.damping()) {
  if (const std::string fault = parameters.invalid(); !fault.empty()) throw std::invalid_argument(fault);
  touching_ = PhaseDynamics(parameters, parameters.k, c_);
  apart_ = PhaseDynamics(parameters, 0.0, 0.0);
}

ChainMotion ChainSolver::start(double impact_speed) const {
  const ChainParameters &p = parameters_;
  ChainMotion motion;
  const double x2 = p.g > 0.0 ? -(p.m2 + p.m3) * p.g / p.k : 0.0;
  if (impact_speed > 0.0)
    motion.state << 0.0, -impact_speed, 0.0, -impact_speed;
  else
    motion.state << x2, 0.0, p.g > 0.0 ? x2 - p.m3 * p.g / p.k23 : x2, 0.0;
  if (motion.state[0] < 0.0) return motion;
  motion.phase = ContactPhase::flight;
  if (impact_speed > 0.0 || p.Fw > 0.0) leave(motion, 0); // touching, and moving or about to be pushed down
  return motion;
}

ChainMotion ChainSolver::start_at(const ChainState &state) const {
  ChainMotion motion;
  motion.state = state;
  if (state[0] > 0.0 || (state[0] == 0.0 && state[1] >= 0.0))
    motion.phase = ContactPhase::flight;
  else if (parameters_.transition == Transition::B && law(state) <= 0.0)
    motion.phase = ContactPhase::clamped;
  else
    motion.phase = ContactPhase::contact;
  return motion;
}

double ChainSolver::force(ContactPhase phase, const ChainState &state) const {
  if (phase != ContactPhase::contact) return 0.0;
  const double value = law(state);
  return parameters_.transition == Transition::B ? std::max(0.0, value) : value;
}

// The ways out of a phase: 0 is the boundary d = 0, 1 the boundary F = 0. Each is a function that is positive
// beyond.
ChainSolver::Exit ChainSolver::first_exit(const MotionPiece &piece, int boundary) const {
  const bool by_force = parameters_.transition == Transition::B && piece.phase != ContactPhase::flight;
  const bool by_gap = piece.phase != ContactPhase::contact || parameters_.transition == Transition::A;
  std::array<double, most_terms> values{};
  Exit first;
  const auto look = [&](int index, double k, double c) {
    for (std::size_t n = 0; n < piece.terms; ++n)
      values[n] = k * piece.coefficient[n][0] + c * piece.coefficient[n][1];
    if (boundary == index) values[0] = 0.0; // the event was here: the function is zero but for rounding
    const double share = first_upcrossing(values.data(), piece.terms);
    if (share <= 1.0 && share < first.share) first = {index, share};
  };
  if (by_gap) look(0, piece.phase == ContactPhase::flight ? -1.0 : 1.0, 0.0);
  if (by_force) {
    const double sign = piece.phase == ContactPhase::contact ? 1.0 : -1.0;
    look(1, sign * parameters_.k, sign * c_);
  }
  return first;
}

PhaseChange ChainSolver::leave(ChainMotion &motion, int exit) const {
  PhaseChange change;
  change.from = motion.phase;
  if (exit == 0) motion.state[0] = 0.0;
  switch (motion.phase) {
  case ContactPhase::flight:
    change.to = ContactPhase::contact;
    change.force = -c_ * motion.state[1];
    change.saltation = -c_ / parameters_.m2;
    break;
  case ContactPhase::clamped:
    change.to = exit == 0 ? ContactPhase::flight : ContactPhase::contact;
    break;
  case ContactPhase::contact:
    if (parameters_.transition == Transition::A) {
      change.to = ContactPhase::flight;
      change.force = -c_ * motion.state[1];
      change.saltation = c_ / parameters_.m2;
    } else if (c_ > 0.0 && motion.state[0] < 0.0) {
      change.to = ContactPhase::clamped;
    } else { // without damping F = 0 and d = 0 are one
      motion.state[0] = 0.0;
      change.to = ContactPhase::flight;
      exit = 0;
    }
    break;
  }
  motion.phase = change.to;
  motion.since = 0.0;
  // With damping a make at d = 0 is not at F = 0: no exit function of B's contact is zero there.
  const bool force_next = parameters_.transition == Transition::B && change.to == ContactPhase::contact;
  motion.boundary = exit == 1 ? 1 : !force_next ? 0 : c_ == 0.0 ? 1 : -1;
  change.time = motion.time;
  change.state = motion.state;
  return change;
}

void ChainSolver::take_over(const ChainSolver &before, ChainMotion &motion, MotionObserver *observer) const {
  const bool same = before.parameters_.k == parameters_.k && before.c_ == c_;
  if (same) return;
  motion.since = 0.0;
  if (motion.boundary == 1) motion.boundary = -1; // where F was 0, it no longer is
  if (parameters_.transition == Transition::A || motion.state[0] >= 0.0) return;
  const ContactPhase phase = law(motion.state) > 0.0 ? ContactPhase::contact : ContactPhase::clamped;
  if (phase == motion.phase) return;
  const double force = (phase == ContactPhase::contact ? *this : before).law(motion.state);
  if (observer != nullptr)
    observer->change({motion.phase, phase, motion.time, motion.state, std::max(0.0, force), 0.0});
  motion.phase = phase;
  motion.boundary = -1;
}

void ChainSolver::finish_cycle(ChainMotion &motion, MotionObserver *observer) const {
  go_to(parameters_.period(), motion, observer);
  motion.time = 0.0;
  ++motion.cycle;
}

void ChainSolver::go_to(double end, ChainMotion &motion, MotionObserver *observer) const {
  constexpr int most_changes = 100'000;
  const double nothing = 1e-15 * parameters_.period();
  MotionPiece piece;
  int changes = 0;
  while (end - motion.time > nothing) {
    const PhaseDynamics &dynamics = motion.phase == ContactPhase::contact ? touching_ : apart_;
    const double left = end - motion.time;
    const double longest = dynamics.longest_piece(motion.since);
    const bool last = left <= longest;
    const double length = last ? left : longest;
    const double angle = parameters_.omega * motion.time;
    piece.phase = motion.phase;
    piece.begin = motion.time;
    dynamics.expand(piece, motion.state, length, std::sin(angle), std::cos(angle));
    const Exit exit = first_exit(piece, motion.boundary);
    piece.end = exit.index >= 0 ? exit.share : 1.0;
    if (observer != nullptr && piece.end > 0.0) observer->piece(piece, dynamics);
    motion.state = piece.state(piece.end);
    motion.boundary = -1;
    motion.since += length * piece.end;
    motion.time = exit.index < 0 && last ? end : motion.time + length * piece.end;
    if (exit.index < 0) continue;
    const PhaseChange change = leave(motion, exit.index);
    if (observer != nullptr) observer->change(change);
    if (++changes > most_changes)
      throw std::runtime_error(
          fmt::format("more than {} contacts made and broken in cycle {}", most_changes, motion.cycle + 1));
  }
}

// ---- history ----

namespace {

// Samples and events of cycles, and what is asked of each cycle.
class Recorder : public MotionObserver {
public:
  Recorder(const ChainSolver &solver, const DirectOptions &options)
      : solver_(&solver), options_(options),
        end_(static_cast<double>(options.last_point()) / static_cast<double>(options.points_per_cycle()) *
             solver.parameters().period()),
        last_row_(options.last_point() / options.points_per_sample()) {}

  /// What follows is over this section of the way.
  void enter(const ChainSolver &solver, const WaySection &section) {
    solver_ = &solver;
    section_ = &section;
  }
  void begin_cycle(long cycle) {
    start_ = static_cast<double>(cycle) * solver_->parameters().period();
    row_of_cycle_ = cycle * options_.samples_per_cycle;
    next_ = 0;
    summary_ = {static_cast<int>(cycle) + 1, start_, no_limit, -no_limit, no_limit, -no_limit, 0.0, 0, 0};
  }
  void end_cycle() {
    if (solver_->parameters().transition == Transition::B)
      summary_.F_contact_min = std::max(0.0, summary_.F_contact_min);
    summary_.contact_share = std::min(1.0, summary_.contact_share / solver_->parameters().period());
    result_.cycles.push_back(summary_);
  }

  void piece(const MotionPiece &piece, const PhaseDynamics & /*dynamics*/) override {
    ++result_.cost.steps;
    summarize(piece);
    const double period = solver_->parameters().period();
    for (; next_ < options_.samples_per_cycle && row_of_cycle_ + next_ <= last_row_; ++next_) {
      const double t = next_ * period / options_.samples_per_cycle;
      const double s = (t - piece.begin) / piece.length;
      if (s >= piece.end) break;
      row(piece.phase, t, piece.state(std::max(0.0, s)));
    }
  }
  void change(const PhaseChange &change) override {
    if (!change.make() && !change.broken()) return;
    if (start_ + change.time > end_) return;
    ++(change.make() ? summary_.makes : summary_.breaks);
    if (result_.events.size() >= DirectOptions::most_events)
      throw std::runtime_error(fmt::format("more than {} contacts made and broken up to t = {} s",
                                           DirectOptions::most_events, start_ + change.time));
    result_.events.push_back({start_ + change.time, change.make(), 0.0 - change.state[0],
                              0.0 - change.state[1], change.force + 0.0, 1, 2});
  }
  void row(ContactPhase phase, double t, const ChainState &y) {
    const ChainParameters &p = solver_->parameters();
    ChainHistory &h = result_.history;
    const double bond = p.c23 * (y[3] - y[1]) + p.k23 * (y[2] - y[0]);
    const double push = p.Fw * std::sin(p.omega * t);
    const double force = solver_->force(phase, y);
    h.time.push_back(start_ + t);
    h.x_drum.push_back(y[0]);
    h.v_drum.push_back(y[1]);
    h.a_drum.push_back((force + bond - push) / p.m2 - p.g);
    h.x_frame.push_back(y[2]);
    h.v_frame.push_back(y[3]);
    h.a_frame.push_back(-bond / p.m3 - p.g);
    h.F_contact.push_back(force);
    h.F_excitation.push_back(push);
    h.F_bond.push_back(bond);
    if (section_ != nullptr) {
      h.s.push_back(section_->place(start_ + t));
      h.pass.push_back(section_->pass);
    }
  }
  DirectResult take() { return std::move(result_); }

private:
  static constexpr double no_limit = std::numeric_limits<double>::infinity();

  // Extremes and time in contact of a piece, up to its end.
  void summarize(const MotionPiece &piece) {
    std::array<double, most_terms> a{};
    std::array<double, most_terms> F{};
    const ChainParameters &p = solver_->parameters();
    const double k = piece.phase == ContactPhase::contact ? p.k : 0.0;
    const double c = piece.phase == ContactPhase::contact ? p.damping() : 0.0;
    double power = 1.0; // of piece.end
    for (std::size_t n = 0; n < piece.terms; ++n, power *= piece.end) {
      const std::array<double, 4> &y = piece.coefficient[n];
      F[n] = -(k * y[0] + c * y[1]) * power;
      if (n + 1 < piece.terms)
        a[n] = static_cast<double>(n + 1) * piece.coefficient[n + 1][1] / piece.length * power;
    }
    widen(a, piece.terms - 1, summary_.a_drum_min, summary_.a_drum_max);
    widen(F, piece.terms, summary_.F_contact_min, summary_.F_contact_max);
    if (piece.phase == ContactPhase::contact) summary_.contact_share += piece.length * piece.end;
  }

  const ChainSolver *solver_;
  const WaySection *section_ = nullptr;
  const DirectOptions &options_;
  double end_;
  long last_row_;
  int next_ = 0;
  long row_of_cycle_ = 0;
  double start_ = 0.0;
  CycleSummary summary_;
  DirectResult result_;
};

/// The chain over a section of its way.
ChainParameters over(ChainParameters parameters, const WaySection &section) {
  if (!section.constant()) throw std::invalid_argument("k and D along the way are not constant in steps");
  parameters.k = section.k;
  parameters.D = section.D;
  return parameters;
}

DirectResult solve(const ChainParameters &parameters, const DirectOptions &options, int lead,
                   const SolverProgress &progress) {
  auto section = options.way.begin();
  auto here =
      std::make_unique<ChainSolver>(section == options.way.end() ? parameters : over(parameters, *section));
  Recorder recorder(*here, options);
  if (section != options.way.end()) recorder.enter(*here, *section);
  ChainMotion motion = here->start(options.impact_speed);
  for (int cycle = 0; cycle < lead; ++cycle)
    here->finish_cycle(motion);
  const long whole = options.last_point() / options.points_per_cycle();
  const bool part = whole == 0 || options.last_point() % options.points_per_cycle() != 0;
  for (long cycle = lead; cycle < whole + part; ++cycle) {
    recorder.begin_cycle(cycle);
    if (cycle == 0 && motion.phase == ContactPhase::contact && motion.state[0] == 0.0)
      recorder.change(
          {ContactPhase::flight, ContactPhase::contact, 0.0, motion.state, here->law(motion.state), 0.0});
    const double period = parameters.period();
    while (options.way.end() - section > 1) {
      const double end = section->end - static_cast<double>(cycle) * period;
      if (end >= period) break;
      here->go_to(end, motion, &recorder);
      auto next = std::make_unique<ChainSolver>(over(parameters, *++section));
      recorder.enter(*next, *section);
      next->take_over(*here, motion, &recorder);
      here = std::move(next);
    }
    here->finish_cycle(motion, &recorder);
    if (cycle < whole) recorder.end_cycle();
    if (progress) progress(std::min(1.0, static_cast<double>(cycle + 1) / options.cycles));
  }
  if (!part) {
    recorder.begin_cycle(whole);
    recorder.row(motion.phase, 0.0, motion.state);
  }
  return recorder.take();
}

} // namespace

DirectResult solve_closed_form(const ChainParameters &parameters, const DirectOptions &options,
                               const SolverProgress &progress) {
  if (const std::string fault = options.invalid(); !fault.empty()) throw std::invalid_argument(fault);
  return solve(parameters, options, 0, progress);
}

DirectResult solve_closed_form(const ChainParameters &parameters, int cycles, int samples_per_cycle,
                               int lead) {
  DirectOptions options;
  options.cycles = lead + cycles;
  options.samples_per_cycle = samples_per_cycle;
  return solve(parameters, options, lead, {});
}

bool closed_form_suffices(const ChainParameters &parameters, const DirectOptions &options) {
  constexpr double most_pieces = 3e6;                                 // some two seconds
  const double end = std::ceil(options.cycles) * parameters.period(); // the last cycle is followed to its end
  double pieces = 0.0;
  const auto include = [&](ChainParameters p, double duration) {
    pieces += duration / std::min(PhaseDynamics(p, p.k, p.damping()).longest_piece(),
                                  PhaseDynamics(p, 0.0, 0.0).longest_piece());
  };
  if (options.way.empty()) include(parameters, end);
  for (const WaySection &section : options.way) {
    if (!section.constant()) return false;
    include(over(parameters, section), section.end - section.begin);
  }
  return pieces <= most_pieces;
}

} // namespace drumlin::post
