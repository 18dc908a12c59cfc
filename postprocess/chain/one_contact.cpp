#include "chain/one_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace drumlin::post {

namespace {

// After this number of time constants a decaying mode is below 1e-16 of its first value.
constexpr double decayed = 37.0;

std::array<double, most_terms + 1> inverses() {
  std::array<double, most_terms + 1> inverse{};
  for (std::size_t n = 1; n <= most_terms; ++n)
    inverse[n] = 1.0 / static_cast<double>(n);
  return inverse;
}
const std::array<double, most_terms + 1> inverse = inverses();

} // namespace

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

// The fastest decay of the motion, if it does not oscillate, with its vectors: the root r of largest size of
// det(M r^2 + C r + K) = 0, by Newton's iteration from beyond all roots. All coefficients are sums of
// positive terms, so that nothing is lost to rounding.
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
    : k_(k), c_(c), omega_(p.omega), push_(-p.Fw / p.m2), gravity_(-p.g) {
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

void PhaseDynamics::law(const MotionPiece &piece, std::array<double, most_terms> &values) const {
  for (std::size_t n = 0; n < piece.terms; ++n)
    values[n] = k_ * piece.coefficient[n][0] + c_ * piece.coefficient[n][1];
}

// ---- the chain ----

OneContact::OneContact(const ChainParameters &parameters)
    : parameters_(parameters), c_(parameters.damping()) {
  if (const std::string fault = parameters.invalid(); !fault.empty()) throw std::invalid_argument(fault);
  touching_ = PhaseDynamics(parameters, parameters.k, c_);
  apart_ = PhaseDynamics(parameters, 0.0, 0.0);
}

ChainState OneContact::at_rest() const {
  const ChainParameters &p = parameters_;
  if (p.g == 0.0) return ChainState::Zero();
  const double x2 = -(p.m2 + p.m3) * p.g / p.k;
  return {x2, 0.0, x2 - p.m3 * p.g / p.k23, 0.0};
}

void OneContact::drive_over(const WaySection &section) {
  if (!section.constant()) throw std::invalid_argument("k and D along the way are not constant in steps");
  ChainParameters there = parameters_;
  there.k = section.k;
  there.D = section.D;
  *this = OneContact(there);
  section_ = section;
}

void OneContact::record(ChainHistory &h, const PhaseDynamics & /*dynamics*/, std::uint32_t acting,
                        const ChainState &y, double sine, double /*time*/, double /*since*/) const {
  const ChainParameters &p = parameters_;
  const double bond = p.c23 * (y[3] - y[1]) + p.k23 * (y[2] - y[0]);
  const double push = p.Fw * sine;
  const double contact = acting != 0 ? force(y) : 0.0;
  h.x_drum.push_back(y[0]);
  h.v_drum.push_back(y[1]);
  h.a_drum.push_back((contact + bond - push) / p.m2 - p.g);
  h.x_frame.push_back(y[2]);
  h.v_frame.push_back(y[3]);
  h.a_frame.push_back(-bond / p.m3 - p.g);
  h.F_contact.push_back(contact);
  h.F_excitation.push_back(push);
  h.F_bond.push_back(bond);
}

template class SolverOf<OneContact>;

} // namespace drumlin::post
