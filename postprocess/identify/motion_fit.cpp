#include "identify/motion_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace drumlin::post {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double pi = 3.14159265358979323846;
constexpr Eigen::Index sensors = 2;

// A state: position and velocity of drum and frame, sine and cosine of the exciter's angle, and 1.
constexpr Index of_sine = 4, of_cosine = 5, of_one = 6, size = 7;
using State = Eigen::Matrix<double, size, 1>;
using Square = Eigen::Matrix<double, size, size>;

// Columns of derivatives: the first four by the state at the start of a stretch, the others by what all
// stretches share.
constexpr Index of_k = 4, of_c = 5, of_k23 = 6, of_c23 = 7, of_phase = 8, of_omega = 9, columns = 10;
using Slopes = Eigen::Matrix<double, size, columns>;
// Behind the derivatives that states have, an observation has those by offset and drift of each sensor.
constexpr Index starts = 4, shared = columns - starts, unknowns = shared + 2 * sensors;
using Shared = Eigen::Matrix<double, unknowns, 1>;

// The mechanical model with the present values.
struct Model {
  double m2, m3, g, me_re;
  double k, c, k23, c23, omega, phase; // phase at time 0
  std::array<double, sensors> offset{}, drift{};
  bool pulls = false;

  double Fw() const { return me_re * omega * omega; } // amplitude of the exciter's force [N]

  // What has to be positive in contact, for the position of the drum alone and for the force [m].
  double overlap(const State &y) const { return -y[0]; }
  double pressed(const State &y) const { return -y[0] - c / k * y[1]; }
  double indicator(const State &y) const { return pulls ? overlap(y) : std::min(overlap(y), pressed(y)); }

  template <class Matrix>
  Matrix rate(const Matrix &y, bool contact) const {
    Matrix d;
    const auto bond = (k23 * (y.row(0) - y.row(2)) + c23 * (y.row(1) - y.row(3))).eval();
    d.row(0) = y.row(1);
    d.row(1) = (-bond - Fw() * y.row(of_sine)) / m2 - g * y.row(of_one);
    if (contact) d.row(1) -= (k * y.row(0) + c * y.row(1)) / m2;
    d.row(2) = y.row(3);
    d.row(3) = bond / m3 - g * y.row(of_one);
    d.row(of_sine) = omega * y.row(of_cosine);
    d.row(of_cosine) = -omega * y.row(of_sine);
    d.row(of_one).setZero();
    return d;
  }
  // Adds the change of the rate by the change of each parameter.
  void add_sources(const State &y, bool contact, double factor, Slopes &s) const {
    if (contact) {
      s(1, of_k) -= factor * y[0] / m2;
      s(1, of_c) -= factor * y[1] / m2;
    }
    const double stretch = factor * (y[0] - y[2]), speed = factor * (y[1] - y[3]);
    s(1, of_k23) -= stretch / m2;
    s(3, of_k23) += stretch / m3;
    s(1, of_c23) -= speed / m2;
    s(3, of_c23) += speed / m3;
    s(1, of_omega) -= factor * 2.0 * me_re * omega * y[of_sine] / m2;
    s(of_sine, of_omega) += factor * y[of_cosine];
    s(of_cosine, of_omega) -= factor * y[of_sine];
  }
};

// The logger's filter for both accelerations: sections one behind another, each with its output and, of
// second order, the rate of that, all rates over the corner's angular frequency.
struct Filter {
  double corner = 0.0;         // [rad/s]; 0: no filter
  std::vector<double> damping; // of the sections of second order
  bool odd = false;            // a section of first order comes last
  std::size_t warm = 0;        // samples after which it has forgotten with what it began

  explicit operator bool() const { return corner > 0.0; }
  Index order() const { return 2 * static_cast<Index>(damping.size()) + (odd ? 1 : 0); }
  Index states() const { return sensors * order(); }
  // Where the acceleration of a sensor comes out, and where it goes in.
  Index output(Index sensor) const { return sensor * order() + order() - (odd ? 1 : 2); }
  Index input(Index sensor) const { return sensor * order() + (damping.empty() ? 0 : 1); }

  // The rate of the states, without what comes in.
  template <class Matrix>
  MatrixXd rate(const Matrix &z) const {
    MatrixXd d(z.rows(), z.cols());
    for (Index sensor = 0; sensor < sensors; ++sensor) {
      Index at = sensor * order();
      const Index first = at;
      for (const double ratio : damping) {
        d.row(at) = corner * z.row(at + 1);
        d.row(at + 1) = corner * (-z.row(at) - 2.0 * ratio * z.row(at + 1));
        if (at > first) d.row(at + 1) += corner * z.row(at - 2);
        at += 2;
      }
      if (odd) d.row(at) = -corner * z.row(at);
      if (odd && at > first) d.row(at) += corner * z.row(at - 2);
    }
    return d;
  }
  // Adds the accelerations that come in, a times the rows of speeds.
  template <class Matrix>
  void add_input(const Matrix &rates, double factor, MatrixXd &d) const {
    for (Index sensor = 0; sensor < sensors; ++sensor)
      d.row(input(sensor)) += factor * corner * rates.row(1 + 2 * sensor);
  }
};

// The filter's states and their derivatives by the columns of the slopes.
struct Filtered {
  const Filter *filter = nullptr;
  MatrixXd value, slopes;
};

// The state after a time, by the series of the exponential, with derivatives if they are asked for, and with
// the filter's states if there are any.
void advance(const Model &model, bool contact, double h, State &y, Slopes *s, Filtered *z = nullptr) {
  constexpr int most_terms = 40;
  MatrixXd z_term, z_slopes;
  if (z != nullptr) {
    z_term = z->value;
    z_slopes = z->slopes;
  }
  constexpr double small = 1e-17;
  State term = y;
  Slopes slopes;
  if (s != nullptr) slopes = *s;
  for (int n = 1; n <= most_terms; ++n) {
    const double factor = h / n;
    if (s != nullptr) {
      Slopes next = factor * model.rate(slopes, contact);
      model.add_sources(term, contact, factor, next);
      slopes = next;
      *s += slopes;
      if (z != nullptr) {
        z_slopes = (factor * z->filter->rate(z_slopes)).eval();
        z->filter->add_input(slopes, 1.0, z_slopes);
        z->slopes += z_slopes;
      }
    }
    term = (factor * model.rate(term, contact)).eval();
    y += term;
    if (z != nullptr) {
      z_term = (factor * z->filter->rate(z_term)).eval();
      z->filter->add_input(term, 1.0, z_term);
      z->value += z_term;
      if (n < most_terms && (z_term.cwiseAbs().maxCoeff() > 1e-13 * z->value.cwiseAbs().maxCoeff())) continue;
    }
    constexpr int least_terms = 8;
    if (n >= least_terms && term.cwiseAbs().maxCoeff() < small &&
        (s == nullptr || (slopes.cwiseAbs().array() <= small * (1.0 + s->cwiseAbs().array())).all()))
      break;
  }
}

// A step of fixed length, computed once: the exponential and its derivatives by the parameters.
class Step {
public:
  Step() = default;
  Step(const Model &model, bool contact, double h, const Filter &filter) {
    if (filter) {
      const Index states = filter.states();
      of_filter_.resize(states, states);
      for (Index i = 0; i < states; ++i) {
        State none = State::Zero();
        Filtered z{&filter, MatrixXd::Zero(states, 1), {}};
        z.value(i, 0) = 1.0;
        advance(model, contact, h, none, nullptr, &z);
        of_filter_.col(i) = z.value;
      }
      into_filter_.resize(states, size);
      into_filter_by_.assign(of_parameters, MatrixXd(states, size));
      for (Index i = 0; i < size; ++i) {
        State column = State::Unit(i);
        Slopes slopes = Slopes::Zero();
        Filtered z{&filter, MatrixXd::Zero(states, 1), MatrixXd::Zero(states, columns)};
        advance(model, contact, h, column, &slopes, &z);
        into_filter_.col(i) = z.value;
        for (Index p = 0; p < of_parameters; ++p)
          into_filter_by_[static_cast<std::size_t>(p)].col(i) = z.slopes.col(parameter(p));
      }
    }
    for (Index i = 0; i < size; ++i) {
      State column = State::Unit(i);
      Slopes slopes = Slopes::Zero();
      advance(model, contact, h, column, &slopes);
      all_.col(i) = column;
      for (Index p = 0; p < of_parameters; ++p)
        by_[static_cast<std::size_t>(p)].col(i) = slopes.col(parameter(p));
    }
  }
  State moved(const State &y) const { return all_ * y; }
  // To be called before y and s move.
  void move_filter(const State &y, const Slopes *s, Filtered &z) const {
    z.value = (of_filter_ * z.value + into_filter_ * y).eval();
    if (s == nullptr) return;
    z.slopes = (of_filter_ * z.slopes + into_filter_ * *s).eval();
    for (Index p = 0; p < of_parameters; ++p)
      z.slopes.col(parameter(p)) += into_filter_by_[static_cast<std::size_t>(p)] * y;
  }
  void move(const State &before, Slopes &s) const {
    // The exciter's angle depends on phase and frequency alone.
    s.topRows<of_sine>() = (all_.topLeftCorner<of_sine, of_sine>() * s.topRows<of_sine>()).eval();
    s.block<of_sine, 2>(0, of_phase) += all_.block<of_sine, 2>(0, of_sine) * s.block<2, 2>(of_sine, of_phase);
    s.block<2, 2>(of_sine, of_phase) =
        (all_.block<2, 2>(of_sine, of_sine) * s.block<2, 2>(of_sine, of_phase)).eval();
    for (Index p = 0; p < of_parameters; ++p)
      s.col(parameter(p)) += by_[static_cast<std::size_t>(p)] * before;
  }

private:
  static constexpr Index of_parameters = 5;
  static Index parameter(Index p) { return p < 4 ? of_k + p : of_omega; }
  Square all_;
  std::array<Square, of_parameters> by_;
  MatrixXd of_filter_, into_filter_;
  std::vector<MatrixXd> into_filter_by_;
};

// The time until contact begins or ends, which it does within h, by the secant in a shrinking bracket.
double event_within(const Model &model, bool contact, double h, const State &y) {
  double before = 0.0, after = h;
  const auto at = [&](double time) {
    State there = y;
    advance(model, contact, time, there, nullptr);
    return model.indicator(there) * (contact ? 1.0 : -1.0); // negative behind the event
  };
  double of_before = std::max(0.0, at(before)), of_after = at(after);
  constexpr int most_rounds = 60;
  constexpr double short_enough = 1e-14;
  for (int n = 0; n < most_rounds && after - before > short_enough; ++n) {
    double trial = before + (after - before) * of_before / (of_before - of_after);
    if (n % 3 == 2 || !(trial > before && trial < after)) trial = 0.5 * (before + after);
    const double value = at(trial);
    if (value < 0.0) {
      after = trial;
      of_after = value;
    } else {
      before = trial;
      of_before = value;
    }
    constexpr double at_event = 1e-15; // m
    if (std::fabs(value) < at_event) return value < 0.0 ? trial : std::min(after, trial + short_enough);
  }
  return after;
}

// What a small change of the state or of a parameter does behind an event, which it delays.
void pass_event(const Model &model, bool contact, const State &y, Slopes &s, Filtered *z) {
  const State before = model.rate(y, contact), after = model.rate(y, !contact);
  const bool of_force = !model.pulls && model.pressed(y) < model.overlap(y);
  const double of_v = of_force ? model.c / model.k : 0.0;
  const double speed = before[0] + of_v * before[1];
  if (speed == 0.0) return;
  Eigen::Matrix<double, 1, columns> change = s.row(0) + of_v * s.row(1);
  if (of_force) {
    change[of_k] -= model.c / (model.k * model.k) * y[1];
    change[of_c] += y[1] / model.k;
  }
  s -= (before - after) * (change / speed);
  if (z != nullptr) {
    MatrixXd jump = MatrixXd::Zero(z->value.rows(), 1);
    z->filter->add_input(before - after, 1.0, jump);
    z->slopes -= jump * (change / speed);
  }
}

// Samples from `first` to before `end` that one motion follows, and its state at the first.
struct Stretch {
  std::size_t first, end;
  Eigen::Vector4d start;
  // Extension of the bond, without its static part, and the rate of that, as first found [m, m/s].
  Eigen::Vector2d bond{0.0, 0.0};
};

// What is known of the bond and of its extension, as weights; 0: nothing.
struct BondKnowledge {
  double stiffness = 0.0, damping = 0.0;       // said
  double of_stiffness = 0.0, of_damping = 0.0; // weights of these
  double of_extension = 0.0, of_rate = 0.0;    // weights of what a stretch starts with
  double off(const Model &model) const {
    return of_stiffness * std::pow(model.k23 - stiffness, 2) + of_damping * std::pow(model.c23 - damping, 2);
  }
  // By how much a stretch starts with another extension, or rate of it, than was first found; the static part
  // of the extension goes with the present stiffness.
  static double extension_off(const Model &model, const Stretch &stretch) {
    return stretch.start[0] - stretch.start[2] - stretch.bond[0] - model.m3 * model.g / model.k23;
  }
  static double rate_off(const Stretch &stretch) {
    return stretch.start[1] - stretch.start[3] - stretch.bond[1];
  }
  double off(const Model &model, const Stretch &stretch) const {
    return of_extension * std::pow(extension_off(model, stretch), 2) +
           of_rate * std::pow(rate_off(stretch), 2);
  }
};

// So many stretches to one each.
std::vector<Stretch> joined(const std::vector<Stretch> &stretches, std::size_t together) {
  std::vector<Stretch> result;
  for (std::size_t i = 0; i < stretches.size(); i += together) {
    result.push_back(stretches[i]);
    result.back().end = stretches[std::min(i + together, stretches.size()) - 1].end;
  }
  return result;
}

// Normal equations of a stretch: of its start, and what it adds to those of the shared unknowns.
struct Equations {
  Eigen::Matrix4d own = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, starts, unknowns> mixed = Eigen::Matrix<double, starts, unknowns>::Zero();
  Eigen::Vector4d own_right = Eigen::Vector4d::Zero();
};

struct Signals {
  std::array<const std::vector<double> *, sensors> a{};
  double dt = 0.0, start = 0.0, middle = 0.0, half_length = 0.0;
  double per_cycle = 0.0;
  const std::vector<double> *wander = nullptr; // of the exciter's angle
  std::vector<double> force_share;             // of the exciter's force, if its angle wanders
  Filter filter;
  std::vector<double> drum, frame; // accelerations to start with
  std::size_t measured() const { return a[1]->empty() ? 1 : 2; }
  double wander_at(std::size_t i) const { return wander->empty() ? 0.0 : (*wander)[i]; }
  std::size_t size() const { return a[0]->size(); }
  double time(std::size_t i) const { return start + dt * static_cast<double>(i); }
};

// Derivatives of an observation by the shared unknowns.
template <class Row>
Shared observed(const Row &row, std::size_t sensor, double u) {
  Shared all = Shared::Zero();
  all.head<shared>() = row.template tail<shared>().transpose();
  const auto at = static_cast<Index>(shared + 2 * sensor);
  all[at] = 1.0;
  all[at + 1] = u;
  return all;
}

class Fit {
public:
  Fit(const Signals &signals, Model model, std::vector<Stretch> stretches, double phase_weight,
      double phase_said, const BondKnowledge &bond)
      : signals_(&signals), model_(model), stretches_(std::move(stretches)), phase_weight_(phase_weight),
        phase_said_(phase_said), bond_(bond) {}

  bool solve();
  void join(std::size_t together) { stretches_ = joined(stretches_, together); }
  const Model &model() const { return model_; }
  const std::vector<Stretch> &stretches() const { return stretches_; }
  double level(std::size_t sensor) const { return level_[sensor]; }
  double squares(std::size_t sensor) const { return squares_[sensor]; }
  std::size_t samples() const { return samples_; }
  // Of the errors of the shared unknowns; nothing if the record does not determine them.
  std::optional<MatrixXd> covariance();
  bool is_noise() const;
  // Whether the fitted phase is far outside of the interval in which the exciter's phase is known. In
  // unbroken contact a contact that pulls moves as one that does not pull, with other k and c and another
  // phase.
  bool contradicts_phase() const {
    constexpr double far = 3.0 * 3.0 * 3.84, told = 0.02; // three half widths; rad
    return std::fabs(model_.phase - phase_said_) > told && phase_cost() > far;
  }
  // What the distance from that phase adds to the sum of squares.
  double phase_cost() const { return phase_weight_ * std::pow(model_.phase - phase_said_, 2); }
  // The largest tension of the law while drum and soil overlap.
  double tension() const;

private:
  // Calls `use` for each sample with its residuals and derivatives; false if the motion cannot be followed.
  // A model with its steps between samples.
  struct Motion {
    Motion(const Signals &signals, const Model &of) : model(of) {
      const double fine = std::max(64.0 * of.omega / (2.0 * pi), 1.5 * std::sqrt(of.k / of.m2));
      steps = static_cast<int>(std::ceil(signals.dt * fine));
      h = signals.dt / steps;
      step = {Step(model, false, h, signals.filter), Step(model, true, h, signals.filter)};
    }
    Model model;
    int steps;
    double h;
    std::array<Step, 2> step;
  };
  struct Nothing {
    void operator()(const State & /*state*/) const {}
  };
  template <class Use, class See = Nothing>
  bool follow(const Motion &motion, const Stretch &stretch, bool slopes_too, const Use &use,
              const See &see = {}) const;
  bool equations();
  // The sum of weighted squares of a trial; nothing if it cannot be followed.
  std::optional<double> cost(const Model &model, const std::vector<Stretch> &stretches);
  // Weights from what is left, and the equations with them.
  bool settle_levels(bool *settled = nullptr);

  const Signals *signals_;
  Model model_;
  std::vector<Stretch> stretches_;
  double phase_weight_, phase_said_;
  BondKnowledge bond_;
  std::vector<Equations> of_stretch_;
  Eigen::Matrix<double, unknowns, unknowns> normal_;
  Shared right_;
  std::array<double, sensors> level_{1.0, 1.0}, squares_{};
  double cost_ = 0.0;
  std::size_t samples_ = 0;
};

template <class Use, class See>
bool Fit::follow(const Motion &motion, const Stretch &stretch, bool slopes_too, const Use &use,
                 const See &see) const {
  const Model &model = motion.model;
  const std::array<Step, 2> &step = motion.step;
  const double h = motion.h;
  State y;
  y << stretch.start, 0.0, 0.0, 1.0;
  Slopes s = Slopes::Zero();
  s.topLeftCorner<starts, starts>().setIdentity();
  const auto turn_to = [&](std::size_t i, double angle) {
    const double time = signals_->time(i), share = signals_->wander->empty() ? 1.0 : signals_->force_share[i];
    y[of_sine] = share * std::sin(angle);
    y[of_cosine] = share * std::cos(angle);
    s(of_sine, of_phase) = y[of_cosine];
    s(of_cosine, of_phase) = -y[of_sine];
    s(of_sine, of_omega) = time * y[of_cosine];
    s(of_cosine, of_omega) = -time * y[of_sine];
  };
  const auto angle_at = [&](std::size_t i) {
    return model.phase + model.omega * signals_->time(i) + signals_->wander_at(i);
  };
  turn_to(stretch.first, angle_at(stretch.first));
  bool contact = model.indicator(y) > 0.0;
  std::size_t events = 0;
  bool changed = false; // between the sample before and this one
  const auto u_of = [this](std::size_t i) {
    return (signals_->time(i) - signals_->middle) / signals_->half_length;
  };
  const auto most_events = static_cast<std::size_t>(
      20.0 * static_cast<double>(stretch.end - stretch.first) / signals_->per_cycle + 20.0);
  const Filter &filter = signals_->filter;
  Filtered z{&filter, {}, {}};
  Filtered *const behind = filter ? &z : nullptr;
  if (filter) { // as if the accelerations had been these for long
    z.value = MatrixXd::Zero(filter.states(), 1);
    z.slopes = MatrixXd::Zero(filter.states(), columns);
    const State rate = model.rate(y, contact);
    for (Index sensor = 0; sensor < sensors; ++sensor) {
      const Index first = sensor * filter.order();
      for (Index at = first; at < first + filter.order(); at += 2)
        z.value(at, 0) = rate[1 + 2 * sensor];
    }
  }
  const std::size_t end = std::min(stretch.end + filter.warm, signals_->size());
  for (std::size_t i = stretch.first; i < end; ++i) {
    if (!signals_->wander->empty()) turn_to(i, angle_at(i));
    const State here = y;
    see(here);
    const Slopes slopes = s;
    const bool touches = contact;
    const std::size_t events_before = events;
    if (filter && i >= stretch.first + filter.warm)
      for (std::size_t sensor = 0; sensor < sensors; ++sensor) {
        if (signals_->a[sensor]->empty()) continue;
        const Index out = filter.output(static_cast<Index>(sensor));
        const double u = u_of(i);
        const Eigen::Matrix<double, 1, columns> row = z.slopes.row(out);
        use(i, sensor,
            z.value(out, 0) + model.offset[sensor] + model.drift[sensor] * u - (*signals_->a[sensor])[i], row,
            u);
      }
    // To the next sample with the frequency of the fit, right in the middle between them.
    if (!signals_->wander->empty() && i + 1 < signals_->size())
      turn_to(i, angle_at(i) + 0.5 * (signals_->wander_at(i + 1) - signals_->wander_at(i)));
    for (int j = 0; j < motion.steps; ++j) {
      double left = h;
      State next = step[contact ? 1 : 0].moved(y);
      while ((model.indicator(next) > 0.0) != contact) {
        if (++events > most_events) return false;
        const double after = event_within(model, contact, left, y);
        advance(model, contact, after, y, slopes_too ? &s : nullptr, behind);
        if (slopes_too) pass_event(model, contact, y, s, behind);
        contact = !contact;
        left -= after;
        next = y;
        advance(model, contact, left, next, nullptr);
      }
      if (filter && left == h) step[contact ? 1 : 0].move_filter(y, slopes_too ? &s : nullptr, z);
      if (slopes_too && left == h) step[contact ? 1 : 0].move(y, s);
      if ((slopes_too || filter) && left < h) {
        next = y;
        advance(model, contact, left, next, slopes_too ? &s : nullptr, behind);
      }
      y = next;
    }
    if (!y.allFinite()) return false;
    if (filter) continue;
    // Next to an event a sample is taken for that side of it which is nearer: else the acceleration's jump
    // would hold the event between two samples while the parameters still change.
    const bool next_to_event = events > events_before || changed;
    changed = events > events_before;
    const auto at = [&](bool in_contact) {
      const double rate = model.rate(here, in_contact)[1];
      return rate + model.offset[0] + model.drift[0] * u_of(i) - (*signals_->a[0])[i];
    };
    const bool other = next_to_event && std::fabs(at(!touches)) < std::fabs(at(touches));
    const bool side = other ? !touches : touches;
    const State rate = model.rate(here, side);
    Slopes change;
    if (slopes_too) {
      change = model.rate(slopes, side);
      model.add_sources(here, side, 1.0, change);
    }
    for (std::size_t sensor = 0; sensor < sensors; ++sensor) {
      if (signals_->a[sensor]->empty()) continue;
      const auto row = static_cast<Index>(1 + 2 * sensor);
      const double u = u_of(i);
      use(i, sensor, rate[row] + model.offset[sensor] + model.drift[sensor] * u - (*signals_->a[sensor])[i],
          change.row(row), u);
    }
  }
  return true;
}

bool Fit::equations() {
  of_stretch_.assign(stretches_.size(), {});
  normal_.setZero();
  right_.setZero();
  squares_.fill(0.0);
  samples_ = 0;
  const Motion motion(*signals_, model_);
  constexpr Index all_unknowns = starts + unknowns;
  double prior = bond_.off(model_);
  for (std::size_t n = 0; n < stretches_.size(); ++n) {
    Eigen::Matrix<double, all_unknowns, all_unknowns> square;
    Eigen::Matrix<double, all_unknowns, 1> right, line;
    square.setZero();
    right.setZero();
    const bool followed =
        follow(motion, stretches_[n], true,
               [&](std::size_t, std::size_t sensor, double residual, const auto &row, double u) {
                 if (sensor == 0) ++samples_;
                 const double weight = 1.0 / (level_[sensor] * level_[sensor]);
                 line << row.template head<starts>().transpose(), observed(row, sensor, u);
                 square.noalias() += (weight * line) * line.transpose();
                 right += weight * residual * line;
                 squares_[sensor] += residual * residual;
               });
    if (!followed) return false;
    for (const bool of_rate : {false, true}) {
      const double weight = of_rate ? bond_.of_rate : bond_.of_extension;
      line.setZero();
      line[of_rate ? 1 : 0] = 1.0;
      line[of_rate ? 3 : 2] = -1.0;
      if (!of_rate) line[of_k23] = model_.m3 * model_.g / (model_.k23 * model_.k23);
      square += (weight * line) * line.transpose();
      right += weight *
               (of_rate ? BondKnowledge::rate_off(stretches_[n])
                        : BondKnowledge::extension_off(model_, stretches_[n])) *
               line;
    }
    prior += bond_.off(model_, stretches_[n]);
    of_stretch_[n] = {square.topLeftCorner<starts, starts>(), square.topRightCorner<starts, unknowns>(),
                      right.head<starts>()};
    normal_ += square.bottomRightCorner<unknowns, unknowns>();
    right_ += right.tail<unknowns>();
  }
  const Index phase = of_phase - starts;
  normal_(phase, phase) += phase_weight_;
  right_[phase] += phase_weight_ * (model_.phase - phase_said_);
  for (std::size_t sensor = 0; sensor < sensors; ++sensor)
    if (signals_->a[sensor]->empty())
      for (Index i = 0; i < 2; ++i)
        normal_(shared + 2 * static_cast<Index>(sensor) + i, shared + 2 * static_cast<Index>(sensor) + i) +=
            1.0;
  const std::pair<Index, double> of_bond[] = {{of_k23, bond_.of_stiffness}, {of_c23, bond_.of_damping}};
  for (const auto &[column, weight] : of_bond) {
    normal_(column - starts, column - starts) += weight;
    right_[column - starts] +=
        weight * (column == of_k23 ? model_.k23 - bond_.stiffness : model_.c23 - bond_.damping);
  }
  cost_ = prior + phase_weight_ * std::pow(model_.phase - phase_said_, 2);
  for (std::size_t sensor = 0; sensor < sensors; ++sensor)
    cost_ += squares_[sensor] / (level_[sensor] * level_[sensor]);
  return true;
}

std::optional<double> Fit::cost(const Model &model, const std::vector<Stretch> &stretches) {
  double sum = bond_.off(model) + phase_weight_ * std::pow(model.phase - phase_said_, 2);
  for (const Stretch &stretch : stretches)
    sum += bond_.off(model, stretch);
  const Motion motion(*signals_, model);
  for (const Stretch &stretch : stretches)
    if (!follow(motion, stretch, false,
                [&](std::size_t, std::size_t sensor, double residual, const auto &, double) {
                  sum += std::pow(residual / level_[sensor], 2);
                }))
      return std::nullopt;
  return sum;
}

bool Fit::settle_levels(bool *settled) {
  const std::array<double, sensors> before = level_;
  for (std::size_t sensor = 0; sensor < sensors; ++sensor) {
    const double freedom = static_cast<double>(samples_) -
                           static_cast<double>(starts * static_cast<Index>(stretches_.size()) + unknowns) /
                               static_cast<double>(signals_->measured());
    constexpr double least = 1e-9; // m/s2
    level_[sensor] = std::max(least, std::sqrt(squares_[sensor] / std::max(1.0, freedom)));
  }
  constexpr double same = 1e-3;
  const bool alike =
      std::fabs(level_[0] / before[0] - 1.0) < same && std::fabs(level_[1] / before[1] - 1.0) < same;
  if (settled != nullptr) *settled = alike;
  if (!alike) return equations();
  level_ = before;
  return true;
}

bool Fit::solve() {
  if (!equations() || !settle_levels()) return false;
  constexpr int most_rounds = 30;
  constexpr double first_damping = 1e-3;
  double damping = first_damping;
  for (int round = 0; round < most_rounds; ++round) {
    // Starts are eliminated stretch by stretch.
    Eigen::Matrix<double, unknowns, unknowns> reduced = normal_;
    reduced.diagonal() *= 1.0 + damping;
    Shared right = right_;
    std::vector<Eigen::LDLT<Eigen::Matrix4d>> own;
    for (const Equations &e : of_stretch_) {
      Eigen::Matrix4d square = e.own;
      square.diagonal() *= 1.0 + damping;
      own.emplace_back(square);
      reduced -= e.mixed.transpose() * own.back().solve(e.mixed);
      right -= e.mixed.transpose() * own.back().solve(e.own_right);
    }
    const Shared sizes = reduced.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Shared change = -sizes.cwiseProduct(
        (sizes.asDiagonal() * reduced * sizes.asDiagonal()).ldlt().solve(sizes.cwiseProduct(right)));
    if (!change.allFinite()) return false;
    Model model = model_;
    std::vector<Stretch> stretches = stretches_;
    double expected = -change.dot(right_);
    for (std::size_t n = 0; n < stretches.size(); ++n) {
      const Eigen::Vector4d by = -own[n].solve(of_stretch_[n].own_right + of_stretch_[n].mixed * change);
      stretches[n].start += by;
      expected -= by.dot(of_stretch_[n].own_right);
    }
    model.k += change[of_k - starts];
    model.c += change[of_c - starts];
    model.k23 += change[of_k23 - starts];
    model.c23 += change[of_c23 - starts];
    model.phase += change[of_phase - starts];
    model.omega += change[of_omega - starts];
    for (std::size_t sensor = 0; sensor < sensors; ++sensor) {
      model.offset[sensor] += change[shared + 2 * static_cast<Index>(sensor)];
      model.drift[sensor] += change[shared + 2 * static_cast<Index>(sensor) + 1];
    }
    const bool possible = model.k > 0.2 * model_.k && model.k < 5.0 * model_.k;
    const std::optional<double> found = possible ? cost(model, stretches) : std::nullopt;
    if (!found || !(*found <= cost_)) {
      damping *= 8.0;
      if (damping > 1e5) return true;
      if (expected < 1e-3) return true;
      continue;
    }
    const double gain = cost_ - *found;
    model_ = model;
    stretches_ = stretches;
    damping = std::max(1e-12, damping * 0.1);
    if (!equations()) return false;
    bool settled = false;
    if (!settle_levels(&settled)) return false;
    if (settled && gain < 1e-3) return true;
  }
  return true;
}

std::optional<MatrixXd> Fit::covariance() {
  if (!equations()) return std::nullopt;
  MatrixXd reduced = normal_;
  std::vector<Eigen::LDLT<Eigen::Matrix4d>> own;
  for (const Equations &e : of_stretch_) {
    own.emplace_back(e.own);
    reduced -= e.mixed.transpose() * own.back().solve(e.mixed);
  }
  const VectorXd sizes = reduced.diagonal().cwiseSqrt().cwiseInverse();
  if (!sizes.allFinite()) return std::nullopt;
  const Eigen::LDLT<MatrixXd> solver(sizes.asDiagonal() * reduced * sizes.asDiagonal());
  constexpr double least_pivot = 1e-11;
  if (!(solver.vectorD().minCoeff() > least_pivot)) return std::nullopt;
  const MatrixXd plain =
      sizes.asDiagonal() * solver.solve(MatrixXd::Identity(unknowns, unknowns)) * sizes.asDiagonal();
  // Residuals that are larger in some cycles, or correlated within them (sandwich estimator).
  std::vector<Shared> scores;
  const Motion motion(*signals_, model_);
  for (std::size_t n = 0; n < stretches_.size(); ++n) {
    const Eigen::Matrix<double, starts, unknowns> share = own[n].solve(of_stretch_[n].mixed);
    std::size_t cycle = 0;
    scores.emplace_back(Shared::Zero());
    const std::size_t first = stretches_[n].first + signals_->filter.warm;
    follow(motion, stretches_[n], true,
           [&](std::size_t i, std::size_t sensor, double residual, const auto &row, double u) {
             const auto now = static_cast<std::size_t>(static_cast<double>(i - first) / signals_->per_cycle);
             if (now != cycle) scores.emplace_back(Shared::Zero());
             cycle = now;
             Shared all = observed(row, sensor, u);
             all -= share.transpose() * row.template head<starts>().transpose();
             scores.back() += residual / (level_[sensor] * level_[sensor]) * all;
           });
  }
  MatrixXd middle = MatrixXd::Zero(unknowns, unknowns);
  for (const Shared &score : scores)
    middle += score * score.transpose();
  const MatrixXd of_cycles = plain * middle * plain;
  // Noise that has passed the filter is correlated from sample to sample.
  const double chance = signals_->filter ? 0.0 : 4.0 * std::sqrt(2.0 / static_cast<double>(scores.size()));
  MatrixXd result = plain;
  for (const Index i : {of_k - starts, of_c - starts})
    if (of_cycles(i, i) > (1.0 + chance) * plain(i, i)) result = of_cycles;
  return result;
}

// Whether what is left is noise: not correlated from sample to sample, nor the same in each cycle.
bool Fit::is_noise() const {
  constexpr std::size_t lags = 3, bins = 24;
  std::array<std::array<double, lags + 1>, sensors> products{};
  std::array<std::array<double, bins>, sensors> sums{}, counts{}, of_cycle{}, squares_of_cycles{};
  double last_cycle = -1.0;
  const auto close_cycle = [&] {
    for (std::size_t sensor = 0; sensor < sensors; ++sensor)
      for (std::size_t bin = 0; bin < bins; ++bin) {
        squares_of_cycles[sensor][bin] += of_cycle[sensor][bin] * of_cycle[sensor][bin];
        of_cycle[sensor][bin] = 0.0;
      }
  };
  double count = 0.0;
  std::array<double, sensors> largest{};
  const Motion motion(*signals_, model_);
  for (const Stretch &stretch : stretches_) {
    std::array<std::array<double, lags>, sensors> before{};
    follow(motion, stretch, false,
           [&](std::size_t i, std::size_t sensor, double residual, const auto &, double) {
             products[sensor][0] += residual * residual;
             largest[sensor] = std::max(largest[sensor], std::fabs(residual));
             for (std::size_t lag = 1; lag <= lags; ++lag)
               products[sensor][lag] += residual * before[sensor][lag - 1];
             std::rotate(before[sensor].begin(), before[sensor].end() - 1, before[sensor].end());
             before[sensor][0] = residual;
             double cycle = 0.0;
             const double part = std::modf(model_.omega * signals_->time(i) / (2.0 * pi), &cycle);
             const auto bin = std::min(bins - 1, static_cast<std::size_t>(std::fabs(part) * bins));
             if (cycle != last_cycle) close_cycle();
             last_cycle = cycle;
             of_cycle[sensor][bin] += residual;
             sums[sensor][bin] += residual;
             counts[sensor][bin] += 1.0;
             if (sensor == 0) count += 1.0;
           });
  }
  close_cycle();
  for (std::size_t sensor = 0; sensor < sensors; ++sensor) {
    if (!(products[sensor][0] > 0.0)) continue;
    constexpr double most = 4.5; // standard deviations
    constexpr double outlier = 6.5;
    if (largest[sensor] > outlier * std::sqrt(products[sensor][0] / count)) return false;
    const auto freedom = static_cast<double>(bins);
    if (signals_->filter) { // noise that has passed it is correlated, but not from cycle to cycle
      double pattern = 0.0;
      for (std::size_t bin = 0; bin < bins; ++bin)
        if (squares_of_cycles[sensor][bin] > 0.0)
          pattern += sums[sensor][bin] * sums[sensor][bin] / squares_of_cycles[sensor][bin];
      constexpr double together = 4.0; // neighbouring bins
      if (pattern > freedom + most * std::sqrt(2.0 * together * freedom)) return false;
      continue;
    }
    for (std::size_t lag = 1; lag <= lags; ++lag)
      if (std::fabs(products[sensor][lag]) > most / std::sqrt(count) * products[sensor][0]) return false;
    double squares = 0.0;
    for (std::size_t bin = 0; bin < bins; ++bin)
      if (counts[sensor][bin] > 0.0) squares += sums[sensor][bin] * sums[sensor][bin] / counts[sensor][bin];
    if (squares * count > (freedom + most * std::sqrt(2.0 * freedom)) * products[sensor][0]) return false;
  }
  return true;
}

double Fit::tension() const {
  double most = 0.0;
  const Motion motion(*signals_, model_);
  for (const Stretch &stretch : stretches_) {
    follow(
        motion, stretch, false, [](std::size_t, std::size_t, double, const auto &, double) {},
        [&](const State &y) {
          if (y[0] < 0.0) most = std::max(most, model_.k * y[0] + model_.c * y[1]);
        });
  }
  return most;
}

// Stretches from contact to contact, with the drum's state that the fit of single contacts gives.
std::vector<Stretch> first_stretches(const Signals &signals, const Identification &start) {
  std::vector<Stretch> stretches;
  constexpr double least_cycles_apart = 0.5;
  for (const ContactPiece &piece : start.pieces) {
    const std::size_t i = piece.run.first + piece.run.size() / 3;
    if (!stretches.empty()) {
      if (static_cast<double>(i - stretches.back().first) < least_cycles_apart * signals.per_cycle) continue;
      stretches.back().end = i;
    }
    stretches.push_back({i, signals.size(), {start.x[i], start.v[i], 0.0, 0.0}});
  }
  return stretches;
}

// Bond and motion of the frame: m3 (a3 + g) is the force of a spring and a dashpot, whose length and speed
// are integrals of measured accelerations and, of each stretch, two unknowns.
bool start_frame(const Signals &signals, Model &model, std::vector<Stretch> &stretches,
                 const BondKnowledge &bond_known) {
  const std::vector<double> &a_drum = signals.drum, &a_frame = signals.frame;
  Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  const auto rows_of = [&](const Stretch &stretch, Eigen::MatrixX2d &bond, Eigen::MatrixX2d &own,
                           VectorXd &force) {
    std::vector<double> between(stretch.end - stretch.first);
    const auto rows = static_cast<Index>(between.size());
    bond.resize(rows, 2);
    own.resize(rows, 2);
    force.resize(rows);
    for (std::size_t j = 0; j < between.size(); ++j)
      between[j] = a_drum[stretch.first + j] - a_frame[stretch.first + j];
    const Integrals way = integrals(between, {0, between.size()}, signals.dt);
    for (Index j = 0; j < rows; ++j) {
      const auto at = static_cast<std::size_t>(j);
      bond.row(j) << way.twice[at], way.once[at];
      own.row(j) << 1.0, signals.dt * static_cast<double>(j);
      force[j] = model.m3 * (a_frame[stretch.first + at] + model.g);
    }
  };
  Eigen::MatrixX2d bond, own;
  VectorXd force;
  for (const Stretch &stretch : stretches) {
    rows_of(stretch, bond, own, force);
    const Eigen::LDLT<Eigen::Matrix2d> solver(own.transpose() * own);
    const Eigen::MatrixX2d left = bond - own * solver.solve(own.transpose() * bond);
    square += left.transpose() * left;
    right += left.transpose() * force;
  }
  Eigen::Vector2d law = square.ldlt().solve(right);
  if (bond_known.of_stiffness > 0.0) law = {bond_known.stiffness, bond_known.damping};
  if (!law.allFinite() || !(law[0] > 0.0)) return false;
  model.k23 = law[0];
  model.c23 = law[1];
  for (Stretch &stretch : stretches) {
    rows_of(stretch, bond, own, force);
    const Eigen::Vector2d found =
        (own.transpose() * own).ldlt().solve(own.transpose() * (force - bond * law));
    const double speed = found[1] / model.k23; // of the drum over the frame
    stretch.start[3] = stretch.start[1] - speed;
    stretch.start[2] = stretch.start[0] - (found[0] - model.c23 * speed) / model.k23;
    stretch.bond = {stretch.start[0] - stretch.start[2] - model.m3 * model.g / model.k23, speed};
  }
  return true;
}

} // namespace

namespace {

// A fit with the covariance of its shared unknowns.
struct Solved {
  Fit fit;
  MatrixXd covariance;

  double cost() const {
    double sum = fit.phase_cost();
    for (std::size_t sensor = 0; sensor < sensors; ++sensor)
      sum += 2.0 * static_cast<double>(fit.samples()) * std::log(fit.level(sensor));
    return sum;
  }
};

std::optional<Solved> solved(Fit fit) {
  if (!fit.solve()) return std::nullopt;
  const std::optional<MatrixXd> covariance = fit.covariance();
  return covariance ? std::optional(Solved{std::move(fit), *covariance}) : std::nullopt;
}

// Joins stretches for as long as one motion follows them as well as several did.
void join_stretches(Solved &best, std::size_t together) {
  while (best.fit.stretches().size() > 1) {
    Fit trial = best.fit;
    trial.join(together);
    std::optional<Solved> longer = solved(std::move(trial));
    if (!longer) return;
    const double worse = 1.0 + 4.0 / std::sqrt(2.0 * static_cast<double>(longer->fit.samples()));
    for (std::size_t sensor = 0; sensor < sensors; ++sensor)
      if (longer->fit.level(sensor) > worse * best.fit.level(sensor)) return;
    best = std::move(*longer);
  }
}

// Whether a fit follows the record better than another of the other condition.
bool is_better(const Solved &one, const Solved &other) {
  if (one.fit.contradicts_phase() != other.fit.contradicts_phase()) return other.fit.contradicts_phase();
  const std::size_t stretches = one.fit.stretches().size(), of_other = other.fit.stretches().size();
  // The condition that joins more contacts is the better one: short stretches follow jitter, too.
  constexpr double alike = 1.25;
  if (stretches < of_other && one.fit.level(0) < alike * other.fit.level(0)) return true;
  if (stretches > of_other && other.fit.level(0) < alike * one.fit.level(0)) return false;
  return one.cost() < other.cost();
}

// The largest distance of a time of the record from equal steps [s].
double irregularity(const Record &record) {
  double most = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i)
    most = std::max(
        most, std::fabs(record.time[i] - record.time.front() - record.interval * static_cast<double>(i)));
  return most;
}

} // namespace

std::optional<MotionFit> fit_motion(const Record &record, const Identification &start,
                                    const MotionSetting &setting) {
  if (!record.omega || !record.phase || !record.Fw || !record.m2 || !record.m3 || record.a_drum.empty() ||
      record.a_frame.empty() || !(start.law.k.mean > 0.0))
    return std::nullopt;
  Signals signals;
  const std::vector<double> none;
  signals.a = {&record.a_drum, record.frame_computed ? &none : &record.a_frame};
  signals.drum = record.a_drum;
  signals.frame = record.a_frame;
  if (record.logger_filter) {
    signals.a = {&record.logged_drum, record.frame_computed ? &none : &record.logged_frame};
    signals.filter.corner = 2.0 * pi * record.logger_filter->corner;
    signals.filter.damping = record.logger_filter->sections();
    signals.filter.odd = record.logger_filter->order % 2 == 1;
    signals.filter.warm =
        static_cast<std::size_t>(std::ceil(record.logger_filter->memory() / record.interval));
  }
  signals.wander = &record.wander;
  for (std::size_t i = 0; i < record.wander.size(); ++i)
    signals.force_share.push_back(record.force_share(i));
  signals.dt = record.interval;
  signals.start = record.time.front();
  signals.middle = 0.5 * (record.time.front() + record.time.back());
  signals.half_length = 0.5 * (record.time.back() - record.time.front());
  signals.per_cycle = record.period() / record.interval;

  constexpr double usual_gravity = 9.81;
  Model model{};
  model.m2 = *record.m2;
  model.m3 = *record.m3;
  model.g = record.g.value_or(usual_gravity);
  model.me_re = *record.Fw / (*record.omega * *record.omega);
  model.omega = *record.omega;
  model.phase = *record.phase;
  model.k = start.law.k.mean;
  model.c = std::max(start.law.c.mean, 1e-3 * std::sqrt(model.k * model.m2));
  std::vector<Stretch> stretches = first_stretches(signals, start);
  if (signals.filter) { // the filter passes constants as they are
    const std::vector<double> *const before[] = {&record.a_drum, &record.a_frame};
    for (std::size_t sensor = 0; sensor < signals.measured(); ++sensor)
      model.offset[sensor] = (std::accumulate(signals.a[sensor]->begin(), signals.a[sensor]->end(), 0.0) -
                              std::accumulate(before[sensor]->begin(), before[sensor]->end(), 0.0)) /
                             static_cast<double>(record.size());
    // What the last stretches begin with is seen only when the filter has forgotten what was before.
    while (stretches.size() > 1 &&
           static_cast<double>(stretches.back().first + signals.filter.warm) + signals.per_cycle >
               static_cast<double>(signals.size())) {
      stretches.pop_back();
      stretches.back().end = signals.size();
    }
  }
  BondKnowledge bond;
  if (record.frame_computed) {
    const auto weight = [](double half_width) { return 3.84 / (half_width * half_width); };
    constexpr double exact = 1e-6, transient = 0.1; // what may still swing, of the static extension
    bond.stiffness = record.bond->stiffness;
    bond.damping = record.bond->damping;
    bond.of_stiffness = weight(std::max(exact, record.bond->tolerance) * bond.stiffness);
    bond.of_damping = weight(std::max(exact, record.bond->tolerance) * std::max(bond.damping, 1.0));
    const double extension = transient * model.m3 * model.g / bond.stiffness;
    bond.of_extension = weight(extension);
    bond.of_rate = weight(extension * std::sqrt(bond.stiffness / model.m3));
  }
  if (stretches.size() < 2 || !start_frame(signals, model, stretches, bond)) return std::nullopt;
  const double phase_weight =
      setting.phase_within ? 3.84 / std::pow(std::max(*setting.phase_within, 1e-7), 2) : 0.0;

  // The condition is found with the first contacts of a long record.
  constexpr std::size_t pilot_contacts = 80, few = 3, many = 8;
  const std::vector<Stretch> first(
      stretches.begin(),
      stretches.begin() + static_cast<std::ptrdiff_t>(std::min(pilot_contacts, stretches.size())));
  std::optional<Solved> best;
  double difference = std::numeric_limits<double>::infinity();
  double of_k_apart = 0.0, of_c_apart = 0.0; // between the two conditions
  for (const bool pulls : {false, true}) {
    model.pulls = pulls;
    std::optional<Solved> one = solved(Fit(signals, model, first, phase_weight, model.phase, bond));
    if (!one) continue;
    join_stretches(*one, few);
    if (best) {
      difference = std::fabs(one->cost() - best->cost());
      of_k_apart = one->fit.model().k - best->fit.model().k;
      of_c_apart = one->fit.model().c - best->fit.model().c;
    }
    if (!best || is_better(*one, *best)) best = std::move(one);
  }
  if (!best) return std::nullopt;
  if (first.size() < stretches.size()) {
    const std::size_t together = std::max<std::size_t>(1, (first.size() + best->fit.stretches().size() - 1) /
                                                              best->fit.stretches().size());
    best =
        solved(Fit(signals, best->fit.model(), joined(stretches, together), phase_weight, model.phase, bond));
    if (!best) return std::nullopt;
    join_stretches(*best, many);
  }
  if (best->fit.contradicts_phase()) return std::nullopt;
  MotionFit result;
  const double freedom =
      static_cast<double>(signals.measured() * best->fit.samples()) -
      static_cast<double>(starts * static_cast<Index>(best->fit.stretches().size()) + unknowns);
  const double t = t_factor(std::max(1.0, freedom));
  // The time between samples is known as well as the times are written; k goes with its square.
  const double computed = 1e-9, of_time = 2.0 * irregularity(record) / (2.0 * signals.half_length) + computed;
  const auto interval = [&](double mean, Index column) {
    const bool of_soil = column == of_k || column == of_c;
    return MeanInterval{mean, std::hypot(t * std::sqrt(best->covariance(column - starts, column - starts)),
                                         of_soil ? 2.0 * of_time * mean : 0.0)};
  };
  const Model &found = best->fit.model();
  result.k = interval(found.k, of_k);
  result.c = interval(found.c, of_c);
  result.correlation =
      best->covariance(of_k - starts, of_c - starts) * t * t / (result.k.half_width * result.c.half_width);
  result.omega = interval(found.omega, of_omega);
  result.phase = interval(found.phase, of_phase);
  result.pulls = found.pulls;
  constexpr double clear = 20.0;
  result.pull_is_clear = difference > clear;
  // If the record hardly tells A from B, the interval contains the result of both. In unbroken contact both
  // follow the same motion, with different k, c and phase.
  constexpr double certain = 5.0 * clear;
  if (difference < certain) {
    result.k.half_width = std::hypot(result.k.half_width, of_k_apart);
    result.c.half_width = std::hypot(result.c.half_width, of_c_apart);
  }
  result.bond_stiffness = found.k23;
  result.bond_damping = found.c23;
  result.tension = best->fit.tension();
  result.residual = best->fit.level(0);
  result.is_noise = best->fit.is_noise();
  const Stretch &longest =
      *std::max_element(best->fit.stretches().begin(), best->fit.stretches().end(),
                        [](const Stretch &a, const Stretch &b) { return a.end - a.first < b.end - b.first; });
  result.cycles = static_cast<double>(longest.end - longest.first) / signals.per_cycle;
  return result;
}

} // namespace drumlin::post
