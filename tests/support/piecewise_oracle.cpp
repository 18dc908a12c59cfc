#include "tests/support/piecewise_oracle.h"

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

namespace drumlin::test {

namespace {

using Real = long double;
using Vector = Eigen::Matrix<Real, 7, 1>; // x2, v2, x3, v3 (scaled), sin(w t), cos(w t), 1
using Matrix = Eigen::Matrix<Real, 7, 7>;
using Row = Eigen::Matrix<Real, 1, 7>;

enum class Mode { touching, apart, silent }; // force acts; no overlap; overlap without force (B)

// A condition row * z > 0 that ends a mode; its rate is row * A * z.
struct Ending {
  Row row;
  Mode next;
  bool event;
};

class Oracle {
public:
  Oracle(const post::ChainParameters &p, int cycles, int samples, double speed)
      : p_(p), b_(p.transition == post::Transition::B), cycles_(cycles), samples_(samples) {
    const Real c = 2.0L * p.D * std::sqrt(Real(p.m2) * p.k);
    c_ = c;
    const Real w0 = std::sqrt(Real(p.k) / p.m2);
    const Real push = std::max({Real(p.g), Real(p.Fw) / p.m2, Real(speed) * w0, Real(1e-6L)});
    const Real v = push / (w0 * (1 + 2 * Real(p.D)));
    scale_ << v / w0, v, v / w0, v, 1, 1, 1;
    touching_ = matrix(p.k, c);
    loose_ = matrix(0, 0);
    overlap_ = Row::Zero();
    overlap_(0) = -scale_(0);
    law_ = Row::Zero();
    law_(0) = -p.k * scale_(0);
    law_(1) = -c * scale_(1);

    Real step = period() / std::max(2000, samples);
    Real fastest = std::sqrt(p.k23 * (1 / Real(p.m2) + 1 / Real(p.m3)));
    if (p.c23 * (1 / Real(p.m2) + 1 / Real(p.m3)) > 2 * fastest) fastest = 0;
    if (p.D < 1) fastest = std::max(fastest, w0);
    if (fastest > 0) step = std::min(step, 0.05L / fastest);
    per_sample_ = static_cast<long>(std::ceil(period() / samples / step - 1e-9L));
    step_ = period() / (Real(samples) * Real(per_sample_));
    touching_step_ = (touching_ * step_).exp();
    loose_step_ = (loose_ * step_).exp();

    const Real rest = p.g > 0 ? -(Real(p.m2) + p.m3) * p.g / p.k : 0;
    Vector z = Vector::Zero();
    if (speed > 0) {
      z(1) = z(3) = -speed;
    } else {
      z(0) = rest;
      z(2) = p.g > 0 ? rest - Real(p.m3) * p.g / p.k23 : rest;
    }
    z = z.cwiseQuotient(scale_);
    z_ = z;
    at(0);
    mode_ = Mode::touching;
    if (speed > 0 || (rest == 0 && p.Fw > 0))
      log(true, law_ * z_);
    else if (rest == 0)
      mode_ = Mode::apart;
  }

  OracleResult run() {
    open_cycle();
    sample();
    const long steps = static_cast<long>(cycles_) * samples_ * per_sample_;
    for (long i = 0; i < steps; ++i) {
      const Real to = Real(i + 1) * step_;
      bool whole = true;
      while (to != t_) {
        const Real left = to - t_;
        Vector end = whole ? Vector(step_matrix() * z_) : Vector(moved(z_, left));
        Real when = left;
        const Ending *ending = first_ending(z_, end, left, when);
        if (ending != nullptr) {
          finish(*ending, when);
          whole = false;
          continue;
        }
        touch_time_ += mode_ == Mode::touching ? left : 0;
        z_ = end;
        at(to);
        break;
      }
      at(to);
      extremes();
      if ((i + 1) % per_sample_ == 0) sample();
      if ((i + 1) % (per_sample_ * samples_) == 0) {
        close_cycle();
        open_cycle();
      }
    }
    return result_;
  }

private:
  Real period() const { return 2.0L * std::acos(-1.0L) / p_.omega; }
  const Matrix &generator() const { return mode_ == Mode::touching ? touching_ : loose_; }
  const Matrix &step_matrix() const { return mode_ == Mode::touching ? touching_step_ : loose_step_; }
  Vector moved(const Vector &z, Real by) const { return (generator() * by).exp() * z; }

  Matrix matrix(Real k, Real c) const {
    Matrix a = Matrix::Zero();
    a(0, 1) = a(2, 3) = 1;
    a.row(1) << -(k + p_.k23) / p_.m2, -(c + p_.c23) / p_.m2, p_.k23 / p_.m2, p_.c23 / p_.m2, -p_.Fw / p_.m2,
        0, -p_.g;
    a.row(3) << p_.k23 / p_.m3, p_.c23 / p_.m3, -p_.k23 / p_.m3, -p_.c23 / p_.m3, 0, 0, -p_.g;
    a(4, 5) = p_.omega;
    a(5, 4) = -p_.omega;
    return scale_.cwiseInverse().asDiagonal() * a * scale_.asDiagonal();
  }

  // Sets the time, and the forcing to what it is then.
  void at(Real t) {
    t_ = t;
    z_(4) = std::sin(p_.omega * t);
    z_(5) = std::cos(p_.omega * t);
    z_(6) = 1;
  }

  std::vector<Ending> endings() const {
    switch (mode_) {
    case Mode::apart:
      return {{overlap_, Mode::touching, true}};
    case Mode::silent:
      return {{-overlap_, Mode::apart, false}, {law_, Mode::touching, true}};
    case Mode::touching:
      break;
    }
    if (!b_ || c_ == 0) return {{-overlap_, Mode::apart, true}};
    return {{-law_, Mode::silent, true}};
  }

  // Root of row z(t) between lo and hi, where it has different signs: Newton kept inside a shrinking bracket.
  Real root(const Row &row, const Vector &z, Real lo, Real hi) const {
    const Row rate = row * generator();
    const bool rising = row * moved(z, hi) > 0;
    Real t = 0.5L * (lo + hi);
    for (int i = 0; i < 200 && hi - lo > 1e-19L * hi; ++i) {
      const Vector there = moved(z, t);
      const Real value = row * there;
      ((value > 0) == rising ? hi : lo) = t;
      const Real newton = t - value / Real(rate * there);
      const Real previous = t;
      t = newton > lo && newton < hi ? newton : 0.5L * (lo + hi);
      if (std::fabs(t - previous) <= 1e-18L * hi) break;
    }
    return t;
  }

  const Ending *first_ending(const Vector &start, const Vector &end, Real length, Real &when) {
    current_ = endings();
    const Ending *found = nullptr;
    for (const Ending &ending : current_) {
      const Row rate = ending.row * generator();
      const Real e0 = ending.row * start;
      const Real e1 = ending.row * end;
      const Real r0 = rate * start;
      const Real r1 = rate * end;
      Real from = 0;
      Real to = length;
      if (e1 > 0) {
        if (e0 >= 0 && r0 < 0) // just began here, and turns within the step
          from = r1 > 0 ? root(rate, start, 0, length) : length;
        else if (e0 >= 0 && r1 <= 0)
          continue;
      } else if (r0 > 0 && r1 < 0) { // a turn inside: does it reach over zero?
        to = root(rate, start, 0, length);
        if (!(ending.row * moved(start, to) > 0) || e0 > 0) continue;
      } else {
        continue;
      }
      if (from >= to) continue;
      const Real t = e0 >= 0 && r0 >= 0 && from == 0 ? 0 : root(ending.row, start, from, to);
      if (found == nullptr || t < when) {
        found = &ending;
        when = t;
      }
    }
    return found;
  }

  void finish(const Ending &ending, Real after) {
    z_ = moved(z_, after);
    touch_time_ += mode_ == Mode::touching ? after : 0;
    at(t_ + after);
    extremes();
    const Mode last = mode_;
    mode_ = ending.next;
    if (mode_ == Mode::apart || last == Mode::apart) z_(0) = 0;
    if (ending.event) log(mode_ == Mode::touching, !b_ || last == Mode::apart ? Real(law_ * z_) : 0);
    extremes();
    if (result_.events.size() > 1000000) throw std::runtime_error("the oracle met too many events");
  }

  void log(bool make, Real force) {
    result_.events.push_back(
        {double(t_), make, double(overlap_ * z_), double(-z_(1) * scale_(1)), double(force), 1, 2});
    ++(make ? makes_ : breaks_);
  }

  double force() const { return mode_ == Mode::touching ? double(law_ * z_) : 0.0; }
  double acceleration() const { return double(Real(generator().row(1) * z_) * scale_(1)); }

  void extremes() {
    cycle_.a_drum_min = std::min(cycle_.a_drum_min, acceleration());
    cycle_.a_drum_max = std::max(cycle_.a_drum_max, acceleration());
    cycle_.F_contact_min = std::min(cycle_.F_contact_min, force());
    cycle_.F_contact_max = std::max(cycle_.F_contact_max, force());
  }

  void open_cycle() {
    const double infinity = std::numeric_limits<double>::infinity();
    cycle_ = {int(result_.cycles.size()) + 1, double(t_), infinity, -infinity, infinity, -infinity, 0, 0, 0};
    if (t_ > 0) makes_ = breaks_ = 0;
    touch_time_ = 0;
    extremes();
  }

  void close_cycle() {
    cycle_.contact_share = double(touch_time_ / period());
    cycle_.makes = makes_;
    cycle_.breaks = breaks_;
    result_.cycles.push_back(cycle_);
  }

  void sample() {
    result_.time.push_back(double(t_));
    result_.x_drum.push_back(double(z_(0) * scale_(0)));
    result_.v_drum.push_back(double(z_(1) * scale_(1)));
    result_.a_drum.push_back(acceleration());
    result_.x_frame.push_back(double(z_(2) * scale_(2)));
    result_.v_frame.push_back(double(z_(3) * scale_(3)));
    result_.F_contact.push_back(force());
  }

  post::ChainParameters p_;
  bool b_;
  int cycles_;
  int samples_;
  Real c_ = 0;
  Vector scale_;
  Matrix touching_, loose_, touching_step_, loose_step_;
  Row overlap_, law_;
  long per_sample_ = 1;
  Real step_ = 0;
  Real t_ = 0;
  Vector z_;
  Mode mode_ = Mode::touching;
  std::vector<Ending> current_;
  Real touch_time_ = 0;
  int makes_ = 0;
  int breaks_ = 0;
  post::CycleSummary cycle_;
  OracleResult result_;
};

} // namespace

OracleResult exact_pieces(const post::ChainParameters &parameters, int cycles, int samples_per_cycle,
                          double impact_speed) {
  return Oracle(parameters, cycles, samples_per_cycle, impact_speed).run();
}

} // namespace drumlin::test
