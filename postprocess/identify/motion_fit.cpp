#include "identify/motion_fit.h"

#include "chain/linear_algebra.h"
#include "record/both_ends.h"
#include "record/excitation.h"
#include "support/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

namespace drumlin::post {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A length and its rate, or a stiffness and a damping.
using Pair = std::array<double, 2>;
// Contacts that act: bit j set, contact j does.
using Set = unsigned;

// Numbers of a matrix, column behind column. States and their derivatives are followed in plain loops:
// expressions of matrices would take most of the time of compiling this file, and of the tests under the
// sanitizers.
template <Index rows, Index cols = 1>
struct Numbers {
  std::array<double, static_cast<std::size_t>(rows *cols)> all{};

  double &operator()(Index row, Index col = 0) { return all[static_cast<std::size_t>(col * rows + row)]; }
  double operator()(Index row, Index col = 0) const {
    return all[static_cast<std::size_t>(col * rows + row)];
  }
  double &operator[](Index row) { return (*this)(row); }
  double operator[](Index row) const { return (*this)(row); }
  double *column(Index col) { return all.data() + col * rows; }
  const double *column(Index col) const { return all.data() + col * rows; }
  double largest() const {
    double most = 0.0;
    for (const double value : all)
      most = std::max(most, std::fabs(value));
    return most;
  }
};

// Adds A x.
template <Index rows, Index inner>
void add_product(const Numbers<rows, inner> &A, const double *x, double *sum) {
  for (Index j = 0; j < inner; ++j)
    for (Index i = 0; i < rows; ++i)
      sum[i] += A(i, j) * x[j];
}

// Sums over the springs or dashpots of the bond of drum and frame, over that of themselves: of their places,
// and of the squares of these.
struct BondPlaces {
  double first = 0.0, second = 0.0;
};

// Samples from `first` to before `end` that one motion follows, and its state at the first.
template <int starts>
struct StretchOf {
  std::size_t first, end;
  Numbers<starts> start;
  // Extension of the bond, without its static part, and the rate of that, as first found [m, m/s]; and of its
  // turn [rad, rad/s].
  Pair bond{}, turn{};
};

// The mechanical model with the present values: of a drum on one contact, or on one below each half, where
// drum and frame tilt, too.
template <int contact_count>
struct ModelOf {
  static constexpr int contacts = contact_count;
  static constexpr bool tilts = contacts > 1;
  static constexpr std::size_t sensors = contacts + 1; // the last one is that of the frame

  // A state: position and velocity of drum and frame, the same of their tilts, sine and cosine of the
  // exciter's angle, and 1.
  static constexpr Index starts = tilts ? 8 : 4;
  static constexpr Index of_sine = starts, of_cosine = starts + 1, of_one = starts + 2, size = starts + 3;
  using State = Numbers<size>;
  using Start = Numbers<starts>;
  using Stretch = StretchOf<starts>;

  // Columns of derivatives: the first by the state at the start of a stretch, the others by what all
  // stretches share.
  static constexpr Index of_k(Index contact) { return starts + 2 * contact; }
  static constexpr Index of_c(Index contact) { return of_k(contact) + 1; }
  static constexpr Index of_k23 = starts + 2 * contacts, of_c23 = of_k23 + 1, of_force = of_k23 + 2,
                         of_omega = of_k23 + 3, of_phase = of_k23 + 4, columns = of_k23 + 5;
  using Slopes = Numbers<size, columns>;
  // Behind the derivatives that states have, an observation has those by offset and drift of each sensor.
  static constexpr Index shared = columns - starts, unknowns = shared + 2 * static_cast<Index>(sensors);

  double m2, m3, g, me_re;
  std::array<double, contacts> k, c;
  double k23, c23, omega, phase; // phase at time 0
  std::array<double, sensors> offset{}, drift{};
  bool pulls = false;
  // Of a drum that tilts: inertia of drum and frame, places of contacts, exciter and sensors, bond.
  double I2 = 0.0, I3 = 0.0;
  std::array<double, contacts> place{}, sensor{};
  double exciter = 0.0;
  BondPlaces spring{}, dashpot{};

  double force = 1.0; // of the exciter, over that which is said

  double Fw() const { return force * me_re * omega * omega; } // amplitude of the exciter's force [N]

  // The drum's position and velocity at a contact, of a state or a derivative of it.
  double position(const double *y, std::size_t contact) const {
    if constexpr (tilts) return y[0] + place[contact] * y[4];
    return y[0];
  }
  double velocity(const double *y, std::size_t contact) const {
    if constexpr (tilts) return y[1] + place[contact] * y[5];
    return y[1];
  }
  // The acceleration that a sensor feels, from the rate of a state.
  double felt(const double *rate, std::size_t at) const {
    if constexpr (tilts) return at + 1 < sensors ? rate[1] + sensor[at] * rate[5] : rate[3];
    return rate[1 + 2 * at];
  }

  // What has to be positive in contact, for the position of the drum alone and for the force [m].
  double overlap(const State &y, std::size_t contact) const { return -position(y.column(0), contact); }
  double pressed(const State &y, std::size_t contact) const {
    return overlap(y, contact) - c[contact] / k[contact] * velocity(y.column(0), contact);
  }
  double indicator(const State &y, std::size_t contact) const {
    return pulls ? overlap(y, contact) : std::min(overlap(y, contact), pressed(y, contact));
  }
  Set acting(const State &y) const {
    Set set = 0;
    for (std::size_t contact = 0; contact < contacts; ++contact)
      if (indicator(y, contact) > 0.0) set |= 1U << contact;
    return set;
  }

  template <Index cols>
  Numbers<size, cols> rate(const Numbers<size, cols> &y, Set acting) const {
    Numbers<size, cols> d;
    for (Index column = 0; column < cols; ++column)
      put_rate(y.column(column), acting, d.column(column));
    return d;
  }
  void put_rate(const double *y, Set acting, double *d) const {
    double bond = k23 * (y[0] - y[2]) + c23 * (y[1] - y[3]);
    if constexpr (tilts) {
      const double turn = y[4] - y[6], turning = y[5] - y[7];
      bond += k23 * spring.first * turn + c23 * dashpot.first * turning;
      const double moment = k23 * (spring.first * (y[0] - y[2]) + spring.second * turn) +
                            c23 * (dashpot.first * (y[1] - y[3]) + dashpot.second * turning);
      d[4] = y[5];
      d[5] = (-moment - exciter * Fw() * y[of_sine]) / I2;
      d[6] = y[7];
      d[7] = moment / I3;
    }
    d[0] = y[1];
    d[1] = (-bond - Fw() * y[of_sine]) / m2 - g * y[of_one];
    for (std::size_t j = 0; j < contacts; ++j) {
      if (((acting >> j) & 1U) == 0) continue;
      const double pull = k[j] * position(y, j) + c[j] * velocity(y, j);
      d[1] -= pull / m2;
      if constexpr (tilts) d[5] -= place[j] / I2 * pull;
    }
    d[2] = y[3];
    d[3] = bond / m3 - g * y[of_one];
    d[of_sine] = omega * y[of_cosine];
    d[of_cosine] = -omega * y[of_sine];
    d[of_one] = 0.0;
  }
  // Adds the change of the rate by the change of each parameter.
  void add_sources(const State &y, Set acting, double factor, Slopes &s) const {
    for (std::size_t j = 0; j < contacts; ++j) {
      if (((acting >> j) & 1U) == 0) continue;
      const auto of = static_cast<Index>(j);
      const double by_k = factor * position(y.column(0), j), by_c = factor * velocity(y.column(0), j);
      s(1, of_k(of)) -= by_k / m2;
      s(1, of_c(of)) -= by_c / m2;
      if constexpr (tilts) {
        s(5, of_k(of)) -= place[j] / I2 * by_k;
        s(5, of_c(of)) -= place[j] / I2 * by_c;
      }
    }
    double stretch = factor * (y[0] - y[2]), speed = factor * (y[1] - y[3]);
    if constexpr (tilts) {
      const double turn = factor * (y[4] - y[6]), turning = factor * (y[5] - y[7]);
      const double of_spring = spring.first * stretch + spring.second * turn;
      const double of_dashpot = dashpot.first * speed + dashpot.second * turning;
      s(5, of_k23) -= of_spring / I2;
      s(7, of_k23) += of_spring / I3;
      s(5, of_c23) -= of_dashpot / I2;
      s(7, of_c23) += of_dashpot / I3;
      s(5, of_omega) -= factor * exciter * 2.0 * Fw() / omega * y[of_sine] / I2;
      s(5, of_force) -= factor * exciter * Fw() / force * y[of_sine] / I2;
      stretch += spring.first * turn;
      speed += dashpot.first * turning;
    }
    s(1, of_k23) -= stretch / m2;
    s(3, of_k23) += stretch / m3;
    s(1, of_c23) -= speed / m2;
    s(3, of_c23) += speed / m3;
    s(1, of_omega) -= factor * 2.0 * Fw() / omega * y[of_sine] / m2;
    s(1, of_force) -= factor * Fw() / force * y[of_sine] / m2;
    s(of_sine, of_omega) += factor * y[of_cosine];
    s(of_cosine, of_omega) -= factor * y[of_sine];
  }
};

// The logger's filter for all accelerations: sections one behind another, each with its output and, of
// second order, the rate of that, all rates over the corner's angular frequency.
struct Filter {
  double corner = 0.0;         // [rad/s]; 0: no filter
  std::vector<double> damping; // of the sections of second order
  bool odd = false;            // a section of first order comes last
  std::size_t warm = 0;        // samples after which it has forgotten with what it began
  Index sensors = 2;

  explicit operator bool() const { return corner > 0.0; }
  Index order() const { return 2 * static_cast<Index>(damping.size()) + (odd ? 1 : 0); }
  Index states() const { return sensors * order(); }
  // Where the acceleration of a sensor comes out, and where it goes in.
  Index output(Index sensor) const { return sensor * order() + order() - (odd ? 1 : 2); }
  Index input(Index sensor) const { return sensor * order() + (damping.empty() ? 0 : 1); }

  // The rate of the states, without what comes in.
  MatrixXd rate(const MatrixXd &z) const {
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
  // Adds the accelerations that come in, from the rates of states.
  template <class Model, Index cols>
  void add_input(const Model &model, const Numbers<Model::size, cols> &rates, MatrixXd &d) const {
    for (Index sensor = 0; sensor < sensors; ++sensor)
      for (Index column = 0; column < cols; ++column)
        d(input(sensor), column) +=
            corner * model.felt(rates.column(column), static_cast<std::size_t>(sensor));
  }
};

// The filter's states and their derivatives by the columns of the slopes.
struct Filtered {
  const Filter *filter = nullptr;
  MatrixXd value, slopes;
};

// The state after a time, by the series of the exponential, with derivatives if they are asked for, and with
// the filter's states if there are any.
template <class Model>
void advance(const Model &model, Set acting, double h, typename Model::State &y, typename Model::Slopes *s,
             Filtered *z = nullptr) {
  constexpr int least_terms = 8, most_terms = 40;
  constexpr double small = 1e-17, small_of_filter = 1e-13;
  MatrixXd z_term, z_slopes;
  if (z != nullptr) {
    z_term = z->value;
    z_slopes = z->slopes;
  }
  typename Model::State term = y;
  typename Model::Slopes slopes;
  if (s != nullptr) slopes = *s;
  for (int n = 1; n <= most_terms; ++n) {
    const double factor = h / n;
    bool done = n >= least_terms;
    if (s != nullptr) {
      slopes = model.rate(slopes, acting);
      for (double &value : slopes.all)
        value *= factor;
      model.add_sources(term, acting, factor, slopes);
      for (std::size_t i = 0; i < slopes.all.size(); ++i) {
        s->all[i] += slopes.all[i];
        done = done && std::fabs(slopes.all[i]) <= small * (1.0 + std::fabs(s->all[i]));
      }
      if (z != nullptr) {
        z_slopes = factor * z->filter->rate(z_slopes);
        z->filter->add_input(model, slopes, z_slopes);
        z->slopes += z_slopes;
      }
    }
    term = model.rate(term, acting);
    for (Index i = 0; i < Model::size; ++i) {
      term[i] *= factor;
      y[i] += term[i];
    }
    if (z != nullptr) {
      z_term = factor * z->filter->rate(z_term);
      z->filter->add_input(model, term, z_term);
      z->value += z_term;
      done = done && z_term.cwiseAbs().maxCoeff() <= small_of_filter * z->value.cwiseAbs().maxCoeff();
    }
    if (done && term.largest() < small) break;
  }
}

// A step of fixed length, computed once: the exponential and its derivatives by the parameters.
template <class Model>
class Step {
public:
  using State = typename Model::State;
  using Slopes = typename Model::Slopes;
  Step() = default;
  Step(const Model &model, Set acting, double h, const Filter &filter) {
    if (filter) {
      const Index states = filter.states();
      of_filter_.resize(states, states);
      for (Index i = 0; i < states; ++i) {
        State none;
        Filtered z{&filter, MatrixXd::Zero(states, 1), {}};
        z.value(i, 0) = 1.0;
        advance(model, acting, h, none, nullptr, &z);
        of_filter_.col(i) = z.value.col(0);
      }
      into_filter_.resize(states, size);
      into_filter_by_.assign(of_parameters, MatrixXd(states, size));
      for (Index i = 0; i < size; ++i) {
        State column;
        column[i] = 1.0;
        Slopes slopes;
        Filtered z{&filter, MatrixXd::Zero(states, 1), MatrixXd::Zero(states, columns)};
        advance(model, acting, h, column, &slopes, &z);
        into_filter_.col(i) = z.value.col(0);
        for (Index p = 0; p < of_parameters; ++p)
          into_filter_by_[static_cast<std::size_t>(p)].col(i) = z.slopes.col(parameter(p));
      }
    }
    for (Index i = 0; i < size; ++i) {
      State column;
      column[i] = 1.0;
      Slopes slopes;
      advance(model, acting, h, column, &slopes);
      std::copy_n(column.column(0), size, all_.column(i));
      for (Index p = 0; p < of_parameters; ++p)
        std::copy_n(slopes.column(parameter(p)), size, by_[static_cast<std::size_t>(p)].column(i));
    }
  }
  State moved(const State &y) const {
    State next;
    add_product(all_, y.column(0), next.column(0));
    return next;
  }
  // To be called before y and s move.
  void move_filter(const State &y, const Slopes *s, Filtered &z) const {
    using Eigen::Map;
    const Map<const VectorXd> state(y.column(0), size);
    z.value = of_filter_ * z.value;
    z.value.col(0) += into_filter_ * state;
    if (s == nullptr) return;
    z.slopes = of_filter_ * z.slopes;
    z.slopes += into_filter_ * Map<const MatrixXd>(s->column(0), size, columns);
    for (Index p = 0; p < of_parameters; ++p)
      z.slopes.col(parameter(p)) += into_filter_by_[static_cast<std::size_t>(p)] * state;
  }
  void move(const State &before, Slopes &s) const {
    Slopes next;
    for (Index column = 0; column < columns; ++column) {
      const bool of_angle = column == of_phase || column == Model::of_omega; // the exciter's alone
      const double *const from = s.column(column);
      double *const to = next.column(column);
      for (Index j = 0; j < (of_angle ? size - 1 : of_sine); ++j)
        for (Index i = 0; i < size; ++i)
          to[i] += all_(i, j) * from[j];
    }
    s = next;
    for (Index p = 0; p < of_parameters; ++p)
      add_product(by_[static_cast<std::size_t>(p)], before.column(0), s.column(parameter(p)));
  }

private:
  static constexpr Index size = Model::size, columns = Model::columns, of_sine = Model::of_sine,
                         of_phase = Model::of_phase;
  // All but the phase: stiffness and damping of contacts and bond, force and frequency.
  static constexpr Index of_parameters = Model::shared - 1;
  static Index parameter(Index p) { return Model::starts + p; }
  Numbers<size, size> all_;
  std::array<Numbers<size, size>, of_parameters> by_;
  MatrixXd of_filter_, into_filter_;
  std::vector<MatrixXd> into_filter_by_;
};

// The time until a contact begins or ends, which it does within h, by the secant in a shrinking bracket.
template <class Model>
double event_within(const Model &model, std::size_t contact, Set acting, double h,
                    const typename Model::State &y) {
  const bool acts = ((acting >> contact) & 1U) != 0;
  double before = 0.0, after = h;
  const auto at = [&](double time) {
    typename Model::State there = y;
    advance(model, acting, time, there, nullptr);
    return model.indicator(there, contact) * (acts ? 1.0 : -1.0); // negative behind the event
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
template <class Model>
void pass_event(const Model &model, std::size_t contact, Set acting, const typename Model::State &y,
                typename Model::Slopes &s, Filtered *z) {
  const typename Model::State before = model.rate(y, acting), after = model.rate(y, acting ^ (1U << contact));
  const bool of_force = !model.pulls && model.pressed(y, contact) < model.overlap(y, contact);
  const double of_v = of_force ? model.c[contact] / model.k[contact] : 0.0;
  const double speed =
      model.position(before.column(0), contact) + of_v * model.velocity(before.column(0), contact);
  if (speed == 0.0) return;
  typename Model::State jump;
  for (Index i = 0; i < Model::size; ++i)
    jump[i] = before[i] - after[i];
  MatrixXd filter_jump;
  if (z != nullptr) {
    filter_jump = MatrixXd::Zero(z->value.rows(), 1);
    z->filter->add_input(model, jump, filter_jump);
  }
  for (Index column = 0; column < Model::columns; ++column) {
    double *const of = s.column(column);
    double change = model.position(of, contact) + of_v * model.velocity(of, contact);
    if (of_force) {
      const double k = model.k[contact], v = model.velocity(y.column(0), contact);
      if (column == Model::of_k(static_cast<Index>(contact))) change -= model.c[contact] / (k * k) * v;
      if (column == Model::of_c(static_cast<Index>(contact))) change += v / k;
    }
    for (Index i = 0; i < Model::size; ++i)
      of[i] -= jump[i] * change / speed;
    if (z != nullptr) z->slopes.col(column) -= change / speed * filter_jump.col(0);
  }
}

// What is known besides the record, as weights; 0: nothing.
struct Known {
  double stiffness = 0.0, damping = 0.0;       // said
  double of_stiffness = 0.0, of_damping = 0.0; // weights of these
  double of_extension = 0.0, of_rate = 0.0;    // weights of what a stretch starts with
  double of_turn = 0.0, of_turning = 0.0;      // and of how the frame is tilted against the drum there
  double phase = 0.0, of_phase = 0.0;          // of the exciter at time 0, said, and its weight
  double of_force = 0.0;                       // weight of the exciter's force over that said
  // What the distance from that phase adds to the sum of squares.
  template <class Model>
  double phase_off(const Model &model) const {
    return of_phase * std::pow(model.phase - phase, 2);
  }
  template <class Model>
  double off(const Model &model) const {
    return phase_off(model) + of_force * std::pow(model.force - 1.0, 2) +
           of_stiffness * std::pow(model.k23 - stiffness, 2) + of_damping * std::pow(model.c23 - damping, 2);
  }
  // By how much a stretch starts with another extension, or rate of it, than was first found; the static part
  // of the extension goes with the present stiffness.
  template <class Model>
  static double extension_off(const Model &model, const typename Model::Stretch &stretch) {
    return stretch.start[0] - stretch.start[2] - stretch.bond[0] - model.m3 * model.g / model.k23;
  }
  template <class Stretch>
  static double rate_off(const Stretch &stretch) {
    return stretch.start[1] - stretch.start[3] - stretch.bond[1];
  }
  // The same of the turn and its rate, which have no static part.
  template <class Stretch>
  static double turn_off(const Stretch &stretch, std::size_t of_rate) {
    return stretch.start.all[4 + of_rate] - stretch.start.all[6 + of_rate] - stretch.turn[of_rate];
  }
  template <class Model>
  double off(const Model &model, const typename Model::Stretch &stretch) const {
    double sum =
        of_extension * std::pow(extension_off(model, stretch), 2) + of_rate * std::pow(rate_off(stretch), 2);
    if constexpr (Model::tilts)
      sum += of_turn * std::pow(turn_off(stretch, 0), 2) + of_turning * std::pow(turn_off(stretch, 1), 2);
    return sum;
  }
};

// So many stretches to one each.
template <class Stretch>
std::vector<Stretch> joined(const std::vector<Stretch> &stretches, std::size_t together) {
  std::vector<Stretch> result;
  for (std::size_t i = 0; i < stretches.size(); i += together) {
    result.push_back(stretches[i]);
    result.back().end = stretches[std::min(i + together, stretches.size()) - 1].end;
  }
  return result;
}

struct Signals {
  std::vector<const std::vector<double> *> a; // of the drum's sensors, then of the frame's if it has one
  double dt = 0.0, start = 0.0, middle = 0.0, half_length = 0.0;
  double per_cycle = 0.0;
  const std::vector<double> *wander = nullptr; // of the exciter's angle
  std::vector<double> force_share;             // of the exciter's force, if its angle wanders
  Filter filter;
  std::vector<double> drum, frame;           // accelerations to start with
  std::vector<double> turn_drum, turn_frame; // of the tilts [rad/s2]
  std::size_t measured() const { return a.size() - (a.back() == nullptr ? 1 : 0); }
  double wander_at(std::size_t i) const { return wander->empty() ? 0.0 : (*wander)[i]; }
  std::size_t size() const { return a[0]->size(); }
  double time(std::size_t i) const { return start + dt * static_cast<double>(i); }
};

// A sample of a sensor as one motion has it: what that leaves, and its derivatives by what states depend on.
struct Observation {
  std::size_t sample, sensor;
  double residual;
  const double *slopes; // none if they were not asked for
  double u;             // time from the middle of the record over half its length
};
using Observe = std::function<void(const Observation &)>;

template <class Model>
class Fit {
public:
  using State = typename Model::State;
  using Slopes = typename Model::Slopes;
  using Stretch = typename Model::Stretch;
  static constexpr Index starts = Model::starts, unknowns = Model::unknowns, columns = Model::columns,
                         shared = Model::shared;
  static constexpr std::size_t sensors = Model::sensors;

  Fit(const Signals &signals, Model model, std::vector<Stretch> stretches, const Known &known)
      : signals_(&signals), model_(model), stretches_(std::move(stretches)), known_(known) {}

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
    return std::fabs(model_.phase - known_.phase) > told && known_.phase_off(model_) > far;
  }
  // Twice the logarithm of one over the likelihood, and the number of starts twice (Akaike 1974).
  double cost() const {
    double sum =
        known_.off(model_) + 2.0 * static_cast<double>(starts) * static_cast<double>(stretches_.size());
    for (std::size_t sensor = 0; sensor < sensors; ++sensor)
      sum += 2.0 * static_cast<double>(samples_) * std::log(level_[sensor]);
    return sum;
  }
  // The largest tension of the law while drum and soil overlap.
  double tension() const;
  // The share of samples in which a contact does not act, of that which is lost least.
  double least_lost() const;

private:
  // Derivatives of an observation by the start of its stretch and by what all stretches share.
  using Line = std::array<double, static_cast<std::size_t>(starts + unknowns)>;
  // Normal equations of a stretch: of its start, and what it adds to those of the shared unknowns.
  struct Equations {
    MatrixXd own, mixed;
    VectorXd own_right;
  };
  static Line line_of(const Observation &seen) {
    Line line{};
    std::copy_n(seen.slopes, columns, line.begin());
    line[static_cast<std::size_t>(columns) + 2 * seen.sensor] = 1.0;
    line[static_cast<std::size_t>(columns) + 2 * seen.sensor + 1] = seen.u;
    return line;
  }
  // A model with its steps between samples.
  struct Motion {
    Motion(const Signals &signals, const Model &of) : model(of) {
      double fine = 64.0 * of.omega / (2.0 * pi);
      for (std::size_t j = 0; j < Model::contacts; ++j)
        fine = std::max(fine, 1.5 * std::sqrt(of.k[j] / of.m2));
      steps = static_cast<int>(std::ceil(signals.dt * fine));
      h = signals.dt / steps;
      for (Set acting = 0; acting < step.size(); ++acting)
        step[acting] = Step<Model>(model, acting, h, signals.filter);
    }
    Model model;
    int steps;
    double h;
    std::array<Step<Model>, 1U << Model::contacts> step;
  };
  // Calls `observe` for each sample of each sensor, and `see` for the state at each; false if the motion
  // cannot be followed.
  bool follow(const Motion &motion, const Stretch &stretch, bool slopes_too, const Observe &observe,
              const std::function<void(const State &)> &see = {}) const;
  static std::array<double, sensors> ones() {
    std::array<double, sensors> values;
    values.fill(1.0);
    return values;
  }
  bool equations();
  // The sum of weighted squares of a trial; nothing if it cannot be followed.
  std::optional<double> cost(const Model &model, const std::vector<Stretch> &stretches);
  // Weights from what is left, and the equations with them.
  bool settle_levels(bool *settled = nullptr);

  const Signals *signals_;
  Model model_;
  std::vector<Stretch> stretches_;
  Known known_;
  std::vector<Equations> of_stretch_;
  MatrixXd normal_;
  VectorXd right_;
  std::array<double, sensors> level_ = ones(), squares_{};
  double cost_ = 0.0;
  std::size_t samples_ = 0;
};

template <class Model>
bool Fit<Model>::follow(const Motion &motion, const Stretch &stretch, bool slopes_too, const Observe &observe,
                        const std::function<void(const State &)> &see) const {
  const Model &model = motion.model;
  const auto &step = motion.step;
  constexpr Index of_sine = Model::of_sine, of_cosine = Model::of_cosine, of_phase = Model::of_phase,
                  of_omega = Model::of_omega;
  const double h = motion.h;
  State y;
  std::copy_n(stretch.start.column(0), starts, y.column(0));
  y[Model::of_one] = 1.0;
  Slopes s;
  for (Index i = 0; i < starts; ++i)
    s(i, i) = 1.0;
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
  Set acting = model.acting(y);
  std::size_t events = 0;
  Set changed = 0; // between the sample before and this one
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
    const State rate = model.rate(y, acting);
    for (Index sensor = 0; sensor < filter.sensors; ++sensor) {
      const Index first = sensor * filter.order();
      for (Index at = first; at < first + filter.order(); at += 2)
        z.value(at, 0) = model.felt(rate.column(0), static_cast<std::size_t>(sensor));
    }
  }
  std::array<double, static_cast<std::size_t>(columns)> row{};
  const std::size_t end = std::min(stretch.end + filter.warm, signals_->size());
  for (std::size_t i = stretch.first; i < end; ++i) {
    if (!signals_->wander->empty()) turn_to(i, angle_at(i));
    const State here = y;
    if (see) see(here);
    const Slopes slopes = s;
    const Set touches = acting;
    Set turned = 0; // between this sample and the next one
    if (filter && i >= stretch.first + filter.warm)
      for (std::size_t sensor = 0; sensor < sensors; ++sensor) {
        if (signals_->a[sensor] == nullptr) continue;
        const Index out = filter.output(static_cast<Index>(sensor));
        const double u = u_of(i);
        for (Index column = 0; column < columns; ++column)
          row[static_cast<std::size_t>(column)] = z.slopes(out, column);
        observe({i, sensor,
                 z.value(out, 0) + model.offset[sensor] + model.drift[sensor] * u - (*signals_->a[sensor])[i],
                 row.data(), u});
      }
    // To the next sample with the frequency of the fit, right in the middle between them.
    if (!signals_->wander->empty() && i + 1 < signals_->size())
      turn_to(i, angle_at(i) + 0.5 * (signals_->wander_at(i + 1) - signals_->wander_at(i)));
    for (int j = 0; j < motion.steps; ++j) {
      double left = h;
      State next = step[acting].moved(y);
      for (Set crossed = model.acting(next) ^ acting; crossed != 0; crossed = model.acting(next) ^ acting) {
        if (++events > most_events) return false;
        double after = left;
        std::size_t first = 0;
        for (std::size_t contact = 0; contact < Model::contacts; ++contact) {
          if (((crossed >> contact) & 1U) == 0) continue;
          const double time = event_within(model, contact, acting, left, y);
          if (time > after) continue;
          after = time;
          first = contact;
        }
        advance(model, acting, after, y, slopes_too ? &s : nullptr, behind);
        if (slopes_too) pass_event(model, first, acting, y, s, behind);
        acting ^= 1U << first;
        turned |= 1U << first;
        left -= after;
        next = y;
        advance(model, acting, left, next, nullptr);
      }
      if (filter && left == h) step[acting].move_filter(y, slopes_too ? &s : nullptr, z);
      if (slopes_too && left == h) step[acting].move(y, s);
      if ((slopes_too || filter) && left < h) {
        next = y;
        advance(model, acting, left, next, slopes_too ? &s : nullptr, behind);
      }
      y = next;
    }
    if (!std::isfinite(y.largest())) return false;
    if (filter) continue;
    // Next to an event a sample is taken for that side of it which is nearer: else the acceleration's jump
    // would hold the event between two samples while the parameters still change. By chance alone no side is
    // nearer: a choice among noise would make motions with more events fit better.
    const double chance = 9.0 * level_[0] * level_[0];
    const Set near = turned | changed;
    changed = turned;
    const auto left_with = [&](Set set) {
      const State rate = model.rate(here, set);
      double squares = 0.0;
      for (std::size_t sensor = 0; sensor + 1 < sensors; ++sensor)
        squares += std::pow(model.felt(rate.column(0), sensor) + model.offset[sensor] +
                                model.drift[sensor] * u_of(i) - (*signals_->a[sensor])[i],
                            2);
      return squares;
    };
    Set side = touches;
    if (near != 0) {
      double least = left_with(touches);
      for (Set flipped = 1; flipped <= near; ++flipped) {
        if ((flipped & near) != flipped) continue;
        const double squares = left_with(touches ^ flipped);
        if (!(squares + chance < least)) continue;
        least = squares;
        side = touches ^ flipped;
      }
    }
    const State rate = model.rate(here, side);
    Slopes change;
    if (slopes_too) {
      change = model.rate(slopes, side);
      model.add_sources(here, side, 1.0, change);
    }
    for (std::size_t sensor = 0; sensor < sensors; ++sensor) {
      if (signals_->a[sensor] == nullptr) continue;
      const double u = u_of(i);
      for (Index column = 0; slopes_too && column < columns; ++column)
        row[static_cast<std::size_t>(column)] = model.felt(change.column(column), sensor);
      observe({i, sensor,
               model.felt(rate.column(0), sensor) + model.offset[sensor] + model.drift[sensor] * u -
                   (*signals_->a[sensor])[i],
               row.data(), u});
    }
  }
  return true;
}

template <class Model>
bool Fit<Model>::equations() {
  of_stretch_.resize(stretches_.size());
  normal_ = MatrixXd::Zero(unknowns, unknowns);
  right_ = VectorXd::Zero(unknowns);
  squares_.fill(0.0);
  samples_ = 0;
  const Motion motion(*signals_, model_);
  constexpr Index all_unknowns = starts + unknowns;
  double prior = known_.off(model_);
  for (std::size_t n = 0; n < stretches_.size(); ++n) {
    Numbers<all_unknowns, all_unknowns> square;
    Numbers<all_unknowns> right;
    const auto add = [&](const Line &line, double weight, double residual) {
      for (Index j = 0; j < all_unknowns; ++j) {
        const double weighted = weight * line[static_cast<std::size_t>(j)];
        right[j] += weighted * residual;
        for (Index i = 0; i < all_unknowns; ++i)
          square(i, j) += weighted * line[static_cast<std::size_t>(i)];
      }
    };
    const bool followed = follow(motion, stretches_[n], true, [&](const Observation &seen) {
      if (seen.sensor == 0) ++samples_;
      add(line_of(seen), 1.0 / (level_[seen.sensor] * level_[seen.sensor]), seen.residual);
      squares_[seen.sensor] += seen.residual * seen.residual;
    });
    if (!followed) return false;
    for (const std::size_t of_rate : {std::size_t{0}, std::size_t{1}}) {
      if constexpr (Model::tilts) {
        Line line{};
        line[4 + of_rate] = 1.0;
        line[6 + of_rate] = -1.0;
        add(line, of_rate == 1 ? known_.of_turning : known_.of_turn, Known::turn_off(stretches_[n], of_rate));
      }
      Line line{};
      line[of_rate] = 1.0;
      line[2 + of_rate] = -1.0;
      if (of_rate == 0) line[Model::of_k23] = model_.m3 * model_.g / (model_.k23 * model_.k23);
      add(line, of_rate == 1 ? known_.of_rate : known_.of_extension,
          of_rate == 1 ? Known::rate_off(stretches_[n]) : Known::extension_off(model_, stretches_[n]));
    }
    prior += known_.off(model_, stretches_[n]);
    const Eigen::Map<const MatrixXd> all(square.column(0), all_unknowns, all_unknowns);
    const Eigen::Map<const VectorXd> all_right(right.column(0), all_unknowns);
    of_stretch_[n] = {all.topLeftCorner(starts, starts), all.topRightCorner(starts, unknowns),
                      all_right.head(starts)};
    normal_ += all.bottomRightCorner(unknowns, unknowns);
    right_ += all_right.tail(unknowns);
  }
  for (std::size_t sensor = 0; sensor < sensors; ++sensor)
    if (signals_->a[sensor] == nullptr)
      for (Index i = 0; i < 2; ++i)
        normal_(shared + 2 * static_cast<Index>(sensor) + i, shared + 2 * static_cast<Index>(sensor) + i) +=
            1.0;
  const auto add_known = [&](Index column, double weight, double off) {
    normal_(column - starts, column - starts) += weight;
    right_[column - starts] += weight * off;
  };
  add_known(Model::of_k23, known_.of_stiffness, model_.k23 - known_.stiffness);
  add_known(Model::of_c23, known_.of_damping, model_.c23 - known_.damping);
  add_known(Model::of_force, known_.of_force, model_.force - 1.0);
  add_known(Model::of_phase, known_.of_phase, model_.phase - known_.phase);
  cost_ = prior;
  for (std::size_t sensor = 0; sensor < sensors; ++sensor)
    cost_ += squares_[sensor] / (level_[sensor] * level_[sensor]);
  return true;
}

template <class Model>
std::optional<double> Fit<Model>::cost(const Model &model, const std::vector<Stretch> &stretches) {
  double sum = known_.off(model);
  for (const Stretch &stretch : stretches)
    sum += known_.off(model, stretch);
  const Motion motion(*signals_, model);
  for (const Stretch &stretch : stretches)
    if (!follow(motion, stretch, false,
                [&](const Observation &seen) { sum += std::pow(seen.residual / level_[seen.sensor], 2); }))
      return std::nullopt;
  return sum;
}

template <class Model>
bool Fit<Model>::settle_levels(bool *settled) {
  const std::array<double, sensors> before = level_;
  for (std::size_t sensor = 0; sensor < sensors; ++sensor) {
    const double freedom = static_cast<double>(samples_) -
                           static_cast<double>(starts * static_cast<Index>(stretches_.size()) + unknowns) /
                               static_cast<double>(signals_->measured());
    constexpr double least = 1e-9; // m/s2
    level_[sensor] = std::max(least, std::sqrt(squares_[sensor] / std::max(1.0, freedom)));
  }
  constexpr double same = 1e-3;
  bool alike = true;
  for (std::size_t sensor = 0; sensor < sensors; ++sensor)
    alike = alike && std::fabs(level_[sensor] / before[sensor] - 1.0) < same;
  if (settled != nullptr) *settled = alike;
  if (!alike) return equations();
  level_ = before;
  return true;
}

template <class Model>
bool Fit<Model>::solve() {
  if (!equations() || !settle_levels()) return false;
  constexpr int most_rounds = 30;
  constexpr double first_damping = 1e-3;
  double damping = first_damping;
  for (int round = 0; round < most_rounds; ++round) {
    // Starts are eliminated stretch by stretch.
    MatrixXd reduced = normal_;
    reduced.diagonal() *= 1.0 + damping;
    VectorXd right = right_;
    std::vector<SymmetricSystem> own;
    for (const Equations &e : of_stretch_) {
      MatrixXd square = e.own;
      square.diagonal() *= 1.0 + damping;
      own.emplace_back(square);
      own.back().eliminate(e.mixed, e.own_right, reduced, right);
    }
    const VectorXd change = -SymmetricSystem(reduced).solution(right);
    if (!change.allFinite()) return false;
    Model model = model_;
    std::vector<Stretch> stretches = stretches_;
    double expected = -change.dot(right_);
    for (std::size_t n = 0; n < stretches.size(); ++n) {
      const Equations &e = of_stretch_[n];
      const VectorXd by = -own[n].solution(e.own_right + e.mixed * change);
      for (Index i = 0; i < starts; ++i)
        stretches[n].start[i] += by[i];
      expected -= by.dot(e.own_right);
    }
    bool possible = true;
    for (std::size_t j = 0; j < Model::contacts; ++j) {
      model.k[j] += change[Model::of_k(static_cast<Index>(j)) - starts];
      model.c[j] += change[Model::of_c(static_cast<Index>(j)) - starts];
      possible = possible && model.k[j] > 0.2 * model_.k[j] && model.k[j] < 5.0 * model_.k[j];
    }
    model.k23 += change[Model::of_k23 - starts];
    model.c23 += change[Model::of_c23 - starts];
    model.force += change[Model::of_force - starts];
    model.phase += change[Model::of_phase - starts];
    model.omega += change[Model::of_omega - starts];
    for (std::size_t sensor = 0; sensor < sensors; ++sensor) {
      model.offset[sensor] += change[shared + 2 * static_cast<Index>(sensor)];
      model.drift[sensor] += change[shared + 2 * static_cast<Index>(sensor) + 1];
    }
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

template <class Model>
std::optional<MatrixXd> Fit<Model>::covariance() {
  if (!equations()) return std::nullopt;
  MatrixXd reduced = normal_;
  VectorXd right = right_;
  std::vector<MatrixXd> shares; // of what all stretches share in the starts
  for (const Equations &e : of_stretch_)
    shares.push_back(SymmetricSystem(e.own).eliminate(e.mixed, e.own_right, reduced, right));
  const SymmetricSystem solver(reduced);
  constexpr double least_pivot = 1e-11;
  if (!(solver.least_pivot() > least_pivot)) return std::nullopt;
  const MatrixXd plain = solver.inverse();
  // Residuals that are larger in some cycles, or correlated within them (sandwich estimator).
  std::vector<VectorXd> scores;
  const Motion motion(*signals_, model_);
  for (std::size_t n = 0; n < stretches_.size(); ++n) {
    std::size_t cycle = 0;
    scores.emplace_back(VectorXd::Zero(unknowns));
    const std::size_t first = stretches_[n].first + signals_->filter.warm;
    follow(motion, stretches_[n], true, [&](const Observation &seen) {
      const auto now =
          static_cast<std::size_t>(static_cast<double>(seen.sample - first) / signals_->per_cycle);
      if (now != cycle) scores.emplace_back(VectorXd::Zero(unknowns));
      cycle = now;
      const Line line = line_of(seen);
      const double weighted = seen.residual / (level_[seen.sensor] * level_[seen.sensor]);
      for (Index i = 0; i < unknowns; ++i) {
        double all = line[static_cast<std::size_t>(starts + i)];
        for (Index j = 0; j < starts; ++j)
          all -= shares[n](j, i) * line[static_cast<std::size_t>(j)];
        scores.back()[i] += weighted * all;
      }
    });
  }
  MatrixXd middle = MatrixXd::Zero(unknowns, unknowns);
  for (const VectorXd &score : scores)
    middle += score * score.transpose();
  const MatrixXd of_cycles = plain * middle * plain;
  // Noise that has passed the filter is correlated from sample to sample.
  const double chance = signals_->filter ? 0.0 : 4.0 * std::sqrt(2.0 / static_cast<double>(scores.size()));
  MatrixXd result = plain;
  for (Index i = 0; i < 2 * Model::contacts; ++i)
    if (of_cycles(i, i) > (1.0 + chance) * plain(i, i)) result = of_cycles;
  return result;
}

// Whether what is left is noise: not correlated from sample to sample, nor the same in each cycle.
template <class Model>
bool Fit<Model>::is_noise() const {
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
    follow(motion, stretch, false, [&](const Observation &seen) {
      const std::size_t sensor = seen.sensor;
      const double residual = seen.residual;
      products[sensor][0] += residual * residual;
      largest[sensor] = std::max(largest[sensor], std::fabs(residual));
      for (std::size_t lag = 1; lag <= lags; ++lag)
        products[sensor][lag] += residual * before[sensor][lag - 1];
      std::rotate(before[sensor].begin(), before[sensor].end() - 1, before[sensor].end());
      before[sensor][0] = residual;
      double cycle = 0.0;
      const double part = std::modf(model_.omega * signals_->time(seen.sample) / (2.0 * pi), &cycle);
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

template <class Model>
double Fit<Model>::least_lost() const {
  std::array<double, Model::contacts> lost{};
  const Motion motion(*signals_, model_);
  for (const Stretch &stretch : stretches_)
    follow(
        motion, stretch, false, [](const Observation & /*seen*/) {},
        [&](const State &y) {
          for (std::size_t j = 0; j < Model::contacts; ++j)
            if (!(model_.indicator(y, j) > 0.0)) lost[j] += 1.0 / static_cast<double>(samples_);
        });
  return *std::min_element(lost.begin(), lost.end());
}

template <class Model>
double Fit<Model>::tension() const {
  double most = 0.0;
  const Motion motion(*signals_, model_);
  for (const Stretch &stretch : stretches_) {
    follow(
        motion, stretch, false, [](const Observation & /*seen*/) {},
        [&](const State &y) {
          for (std::size_t j = 0; j < Model::contacts; ++j)
            if (const double x = model_.position(y.column(0), j); x < 0.0)
              most = std::max(most, model_.k[j] * x + model_.c[j] * model_.velocity(y.column(0), j));
        });
  }
  return most;
}

using OneContact = ModelOf<1>;
using TwoContacts = ModelOf<2>;

// Stretches from contact to contact, with the drum's state that the fit of single contacts gives.
std::vector<OneContact::Stretch> first_stretches(const Signals &signals, const Identification &start) {
  std::vector<OneContact::Stretch> stretches;
  constexpr double least_cycles_apart = 0.5;
  for (const ContactPiece &piece : start.pieces) {
    const std::size_t i = piece.run.first + piece.run.size() / 3;
    if (!stretches.empty()) {
      if (static_cast<double>(i - stretches.back().first) < least_cycles_apart * signals.per_cycle) continue;
      stretches.back().end = i;
    }
    stretches.push_back({i, signals.size(), {{start.x[i], start.v[i], 0.0, 0.0}}});
  }
  return stretches;
}

// Position and velocity at a contact at a sample, integrated from the nearest one of this contact; nothing if
// that is more than a cycle away.
std::optional<Pair> state_at(std::size_t sample, const Identification &contact, const std::vector<double> &a,
                             const Signals &signals) {
  const auto known = [&](std::size_t i) { return i < contact.x.size() && std::isfinite(contact.x[i]); };
  for (std::size_t off = 0; static_cast<double>(off) <= signals.per_cycle; ++off) {
    const double time = signals.dt * static_cast<double>(off);
    if (known(sample + off)) {
      const std::size_t at = sample + off;
      const Integrals way = integrals(a, {sample, at + 1}, signals.dt);
      const double v = contact.v[at] - way.once.back();
      return Pair{contact.x[at] - time * v - way.twice.back(), v};
    }
    if (off <= sample && known(sample - off)) {
      const std::size_t at = sample - off;
      const Integrals way = integrals(a, {at, sample + 1}, signals.dt);
      return Pair{contact.x[at] + time * contact.v[at] + way.twice.back(), contact.v[at] + way.once.back()};
    }
  }
  return std::nullopt;
}

// The same of a drum on two contacts.
std::vector<TwoContacts::Stretch>
first_stretches(const Signals &signals, const std::array<HalfStart, 2> &halves, const TwoContacts &model) {
  std::vector<TwoContacts::Stretch> stretches;
  constexpr double least_cycles_apart = 0.5;
  const double apart = model.place[1] - model.place[0];
  for (const ContactPiece &piece : halves[0].contact.pieces) {
    const std::size_t i = piece.run.first + piece.run.size() / 3;
    if (!stretches.empty() &&
        static_cast<double>(i - stretches.back().first) < least_cycles_apart * signals.per_cycle)
      continue;
    std::array<Pair, 2> ends;
    bool known = true;
    for (std::size_t j = 0; j < ends.size(); ++j) {
      const auto end = state_at(i, halves[j].contact, halves[j].acceleration, signals);
      known = known && end;
      if (end) ends[j] = *end;
    }
    if (!known) continue;
    if (!stretches.empty()) stretches.back().end = i;
    TwoContacts::Stretch stretch{i, signals.size(), {}};
    for (std::size_t of = 0; of < 2; ++of) { // position and velocity, of the middle and of the tilt
      stretch.start.all[of] = (model.place[1] * ends[0][of] - model.place[0] * ends[1][of]) / apart;
      stretch.start.all[4 + of] = (ends[1][of] - ends[0][of]) / apart;
    }
    stretches.push_back(stretch);
  }
  return stretches;
}

// m (a + g) of a mass is the force of a spring and a dashpot, whose length and speed are integrals of the
// accelerations of foot and mass and, of each stretch, two unknowns.
class BondRows {
public:
  BondRows(const std::vector<double> &foot, const std::vector<double> &mass, double m, double g,
           const SampleRun &run, double dt) {
    std::vector<double> between(run.size());
    for (std::size_t j = 0; j < between.size(); ++j)
      between[j] = foot[run.first + j] - mass[run.first + j];
    const Integrals way = integrals(between, {0, between.size()}, dt);
    for (std::size_t j = 0; j < between.size(); ++j) {
      const std::array<double, 5> row = {way.twice[j], way.once[j], m * (mass[run.first + j] + g), 1.0,
                                         dt * static_cast<double>(j)};
      for (Index a = 0; a < 5; ++a)
        for (Index b = 0; b < 5; ++b)
          products_(a, b) += row[static_cast<std::size_t>(a)] * row[static_cast<std::size_t>(b)];
    }
  }
  // Adds the normal equations of stiffness and damping.
  void add(MatrixXd &square, VectorXd &right) const {
    MatrixXd left = products_.topLeftCorner(3, 3);
    VectorXd none = VectorXd::Zero(3);
    SymmetricSystem(products_.bottomRightCorner(2, 2))
        .eliminate(products_.bottomLeftCorner(2, 3), VectorXd::Zero(2), left, none);
    square += left.topLeftCorner(2, 2);
    right += left.block(0, 2, 2, 1);
  }
  // Extension and its rate at the first sample.
  Pair start(const Pair &law) const {
    const VectorXd found = SymmetricSystem(products_.bottomRightCorner(2, 2))
                               .solution(products_.block(3, 2, 2, 1) - law[0] * products_.block(3, 0, 2, 1) -
                                         law[1] * products_.block(3, 1, 2, 1));
    const double speed = found[1] / law[0];
    return {(found[0] - law[1] * speed) / law[0], speed};
  }

private:
  MatrixXd products_ = MatrixXd::Zero(5, 5); // of length, speed, force and the rows of the two unknowns
};

// Bond and motion of the frame.
template <class Model>
bool start_frame(const Signals &signals, Model &model, std::vector<typename Model::Stretch> &stretches,
                 const Known &known) {
  const auto rows_of = [&](const auto &stretch) {
    return BondRows(signals.drum, signals.frame, model.m3, model.g, {stretch.first, stretch.end}, signals.dt);
  };
  Pair law = {known.stiffness, known.damping};
  if (!(known.of_stiffness > 0.0)) {
    MatrixXd square = MatrixXd::Zero(2, 2);
    VectorXd right = VectorXd::Zero(2);
    for (const auto &stretch : stretches)
      rows_of(stretch).add(square, right);
    const VectorXd found = SymmetricSystem(square).solution(right);
    law = {found[0], found[1]};
  }
  if (!std::isfinite(law[1]) || !(law[0] > 0.0) || !std::isfinite(law[0])) return false;
  model.k23 = law[0];
  model.c23 = law[1];
  const double extension = model.m3 * model.g / model.k23;
  for (auto &stretch : stretches) {
    Pair bond = rows_of(stretch).start(law);
    if constexpr (Model::tilts) {
      // A bond whose sides differ is turned by the weight that it carries.
      const BondPlaces &spring = model.spring;
      const double whole = extension / (1.0 - spring.first * spring.first / spring.second);
      bond[0] += whole - extension;
      stretch.turn = BondRows(signals.turn_drum, signals.turn_frame, model.I3, 0.0,
                              {stretch.first, stretch.end}, signals.dt)
                         .start({law[0] * spring.second, law[1] * model.dashpot.second});
      stretch.turn[0] -= spring.first / spring.second * whole;
      for (std::size_t of = 0; of < 2; ++of)
        stretch.start.all[6 + of] = stretch.start.all[4 + of] - stretch.turn[of];
    }
    for (std::size_t of = 0; of < 2; ++of)
      stretch.start.all[2 + of] = stretch.start.all[of] - bond[of];
    stretch.bond = {bond[0] - extension, bond[1]};
  }
  return true;
}

} // namespace

namespace {

// A fit with the covariance of its shared unknowns.
template <class Model>
struct Solved {
  Fit<Model> fit;
  MatrixXd covariance;
};

template <class Model>
std::optional<Solved<Model>> solved(Fit<Model> fit) {
  if (!fit.solve()) return std::nullopt;
  const std::optional<MatrixXd> covariance = fit.covariance();
  return covariance ? std::optional(Solved<Model>{std::move(fit), *covariance}) : std::nullopt;
}

// What fits that follow a record say together, each by its likelihood.
template <class Model>
class Average {
public:
  // \param cost twice the logarithm of one over the likelihood
  void add(const Solved<Model> &one, double cost) {
    const Model &model = one.fit.model();
    VectorXd values(Model::shared);
    for (Index j = 0; j < Model::contacts; ++j) {
      values[Model::of_k(j) - Model::starts] = model.k[static_cast<std::size_t>(j)];
      values[Model::of_c(j) - Model::starts] = model.c[static_cast<std::size_t>(j)];
    }
    values.tail(5) << model.k23, model.c23, model.force, model.omega, model.phase;
    values_.push_back(values);
    covariances_.push_back(one.covariance.topLeftCorner(Model::shared, Model::shared));
    costs_.push_back(cost);
  }
  // Mean and covariance of the shared unknowns but those of sensors.
  std::pair<VectorXd, MatrixXd> of(bool is_noise) const {
    const double least = *std::min_element(costs_.begin(), costs_.end());
    // Where more than noise is left, neighbouring samples are not independent.
    const double alike = is_noise ? 1.0 : 10.0;
    double all = 0.0;
    VectorXd mean = VectorXd::Zero(Model::shared);
    MatrixXd covariance = MatrixXd::Zero(Model::shared, Model::shared);
    for (std::size_t i = 0; i < costs_.size(); ++i) {
      const double weight = std::exp(-0.5 * (costs_[i] - least) / alike);
      const VectorXd off = values_[i] - values_[0]; // so that large values lose no digits
      all += weight;
      mean += weight * off;
      covariance += weight * (covariances_[i] + off * off.transpose());
    }
    mean /= all;
    return {values_[0] + mean, covariance / all - mean * mean.transpose()};
  }

private:
  std::vector<VectorXd> values_;
  std::vector<MatrixXd> covariances_;
  std::vector<double> costs_;
};

// Joins stretches for as long as one motion follows them as well as several did.
template <class Model>
void join_stretches(Solved<Model> &best, std::size_t together) {
  while (best.fit.stretches().size() > 1) {
    Fit<Model> trial = best.fit;
    trial.join(together);
    std::optional<Solved<Model>> longer = solved(std::move(trial));
    if (!longer) return;
    const double worse = 1.0 + 4.0 / std::sqrt(2.0 * static_cast<double>(longer->fit.samples()));
    for (std::size_t sensor = 0; sensor < Model::sensors; ++sensor)
      if (longer->fit.level(sensor) > worse * best.fit.level(sensor)) return;
    best = std::move(*longer);
  }
}

// Whether a fit follows the record better than another of the other condition.
template <class Model>
bool is_better(const Solved<Model> &one, const Solved<Model> &other) {
  if (one.fit.contradicts_phase() != other.fit.contradicts_phase()) return other.fit.contradicts_phase();
  const std::size_t stretches = one.fit.stretches().size(), of_other = other.fit.stretches().size();
  // The condition that joins more contacts is the better one: short stretches follow jitter, too.
  constexpr double alike = 1.25;
  if (stretches < of_other && one.fit.level(0) < alike * other.fit.level(0)) return true;
  if (stretches > of_other && other.fit.level(0) < alike * one.fit.level(0)) return false;
  return one.fit.cost() < other.fit.cost();
}

// The largest distance of a time of the record from equal steps [s].
double irregularity(const Record &record) {
  double most = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i)
    most = std::max(
        most, std::fabs(record.time[i] - record.time.front() - record.interval * static_cast<double>(i)));
  return most;
}

// Signals of a record of these sensors, and as logged behind a filter.
Signals signals_from(const Record &record, std::vector<const std::vector<double> *> of_drum,
                     const std::vector<double> &of_frame) {
  Signals signals;
  signals.a = std::move(of_drum);
  signals.a.push_back(record.frame_computed ? nullptr : &of_frame);
  signals.drum = record.a_drum;
  signals.frame = record.a_frame;
  signals.filter.sensors = static_cast<Index>(signals.a.size());
  if (record.logger_filter) {
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
  return signals;
}

// What the record says of machine and exciter.
template <class Model>
Model model_from(const Record &record) {
  constexpr double usual_gravity = 9.81;
  Model model{};
  model.m2 = *record.m2;
  model.m3 = *record.m3;
  model.g = record.g.value_or(usual_gravity);
  model.me_re = *record.Fw / (*record.omega * *record.omega);
  model.omega = *record.omega;
  model.phase = *record.phase;
  return model;
}

double weight_of(double half_width) { return 3.84 / (half_width * half_width); }

// What is known besides the record: of the exciter, and of the bond if the frame's motion is not measured.
Known known_of(const Record &record, double m3, double g, const MotionSetting &setting) {
  constexpr double exact = 1e-6, exact_force = 1e-10;
  constexpr double transient = 0.1; // what may still swing, of the static extension
  Known known;
  known.phase = *record.phase;
  if (setting.phase_within) known.of_phase = weight_of(std::max(*setting.phase_within, exact));
  known.of_force = weight_of(std::max(setting.force_within, exact_force));
  if (!record.frame_computed) return known;
  known.stiffness = record.bond->stiffness;
  known.damping = record.bond->damping;
  known.of_stiffness = weight_of(std::max(exact, record.bond->tolerance) * known.stiffness);
  known.of_damping = weight_of(std::max(exact, record.bond->tolerance) * std::max(known.damping, 1.0));
  const double extension = transient * m3 * g / known.stiffness;
  known.of_extension = weight_of(extension);
  known.of_rate = weight_of(extension * std::sqrt(known.stiffness / m3));
  return known;
}

bool complete(const Record &record) {
  return record.omega && record.phase && record.Fw && record.m2 && record.m3 && !record.a_drum.empty() &&
         !record.a_frame.empty();
}

// The fit with another phase, which is held, and the other k and c with which unbroken contact then has the
// same motion: k + i omega c = -F / X, of force and position at the exciter's frequency.
template <class Model>
std::optional<Solved<Model>> with_phase(const Solved<Model> &from, const Signals &signals, Known known,
                                        double phase, bool pulls) {
  constexpr double held = 1e-4; // rad
  const Model &before = from.fit.model();
  Model model = before;
  model.pulls = pulls;
  model.phase = phase;
  std::array<double, Model::contacts> down{}; // by how much each contact rests lower
  for (std::size_t j = 0; j < Model::contacts; ++j) {
    double share = 1.0, of_weight = 1.0;
    if constexpr (Model::tilts) {
      const double other = model.place[1 - j], apart = model.place[j] - other;
      share = (model.exciter - other) / apart;
      of_weight = -other / apart;
    }
    std::complex<double> a;
    for (std::size_t i = 0; i < signals.size(); ++i)
      a += (signals.drum[i] + (Model::tilts ? model.place[j] * signals.turn_drum[i] : 0.0)) *
           std::polar(2.0 / static_cast<double>(signals.size()),
                      -model.omega * signals.time(i) - signals.wander_at(i));
    const std::complex<double> force = std::complex<double>(0.0, -share * model.Fw()) *
                                       (std::polar(1.0, phase) - std::polar(1.0, before.phase));
    const std::complex<double> change = force * model.omega * model.omega / a;
    constexpr double least = 0.2;
    model.k[j] = std::max(least * before.k[j], before.k[j] + change.real());
    model.c[j] = std::max(least * before.c[j], before.c[j] + change.imag() / model.omega);
    down[j] = of_weight * (model.m2 + model.m3) * model.g * (1.0 / model.k[j] - 1.0 / before.k[j]);
  }
  std::vector<typename Model::Stretch> stretches = from.fit.stretches();
  for (typename Model::Stretch &stretch : stretches) {
    double middle = down[0];
    if constexpr (Model::tilts) {
      const double apart = model.place[1] - model.place[0];
      middle = (model.place[1] * down[0] - model.place[0] * down[1]) / apart;
      for (const Index tilt : {4, 6})
        stretch.start[tilt] -= (down[1] - down[0]) / apart;
    }
    for (const Index height : {0, 2})
      stretch.start[height] -= middle;
  }
  known.phase = phase;
  known.of_phase = weight_of(held);
  return solved(Fit<Model>(signals, model, std::move(stretches), known));
}

// Follows a record from these stretches.
template <class Model>
std::optional<MotionFit> follow_record(const Record &record, const Signals &signals, Model model,
                                       std::vector<typename Model::Stretch> stretches, const Known &known) {
  if (stretches.size() < 2 || !start_frame(signals, model, stretches, known)) return std::nullopt;

  // The condition is found with the first contacts of a long record.
  constexpr std::size_t pilot_contacts = 80, few = 3, many = 8;
  const std::vector<typename Model::Stretch> first(
      stretches.begin(),
      stretches.begin() + static_cast<std::ptrdiff_t>(std::min(pilot_contacts, stretches.size())));
  std::optional<Solved<Model>> best, other;
  for (const bool pulls : {false, true}) {
    model.pulls = pulls;
    std::optional<Solved<Model>> one = solved(Fit<Model>(signals, model, first, known));
    if (!one) continue;
    join_stretches(*one, few);
    if (best && !is_better(*one, *best)) std::swap(one, best);
    other = std::exchange(best, std::move(one));
  }
  if (!best) return std::nullopt;
  double difference = other ? std::fabs(other->fit.cost() - best->fit.cost()) : // between A and B
                          std::numeric_limits<double>::infinity();
  constexpr double clear = 20.0, certain = 5.0 * clear;
  if (!(difference < certain)) other.reset();
  if (first.size() < stretches.size())
    for (std::optional<Solved<Model>> *one : {&best, &other}) {
      if (!*one) continue;
      const std::size_t parts = (*one)->fit.stretches().size();
      const std::size_t together = std::max<std::size_t>(1, (first.size() + parts - 1) / parts);
      *one = solved(Fit<Model>(signals, (*one)->fit.model(), joined(stretches, together), known));
      if (*one) join_stretches(**one, many);
    }
  if (!best) return std::nullopt;
  // In contact that is hardly ever lost a phase fits as well as another, with other k and c, up to that at
  // which contact would be lost. A fit that ends there takes its phase for well known.
  Average<Model> average;
  average.add(*best, best->fit.cost());
  if (other) average.add(*other, other->fit.cost());
  constexpr double hardly = 0.06;
  if (known.of_phase > 0.0 && known.of_phase < weight_of(1e-4) && best->fit.least_lost() < hardly) {
    const double within = std::sqrt(3.84 / known.of_phase);
    constexpr int steps = 2;
    constexpr double most = 1.05, no_tension = 1.0; // N
    const double much_tension = 0.1 * (model.m2 + model.m3) * model.g;
    std::array<double, 2> of_condition; // of B and A, the least cost
    of_condition.fill(std::numeric_limits<double>::infinity());
    for (int step = -steps; step <= steps; ++step) {
      double tension = 0.0;
      for (const bool pulls : {true, false}) { // without tension B moves as A does
        if (!pulls && tension > much_tension) continue;
        if (pulls || tension > no_tension)
          other = with_phase(*best, signals, known, known.phase + most * within * step / steps, pulls);
        if (!other) continue;
        if (pulls) tension = other->fit.tension();
        const double cost = other->fit.cost() + known.phase_off(other->fit.model());
        average.add(*other, cost);
        of_condition[pulls ? 1 : 0] = std::min(of_condition[pulls ? 1 : 0], cost);
      }
    }
    difference = std::fabs(of_condition[0] - of_condition[1]);
  }
  if (best->fit.contradicts_phase()) return std::nullopt;
  MotionFit result;
  const double freedom =
      static_cast<double>(signals.measured() * best->fit.samples()) -
      static_cast<double>(Model::starts * static_cast<Index>(best->fit.stretches().size()) + Model::unknowns);
  const double t = t_factor(std::max(1.0, freedom));
  // The time between samples is known as well as the times are written; k goes with its square.
  const double computed = 1e-9, of_time = 2.0 * irregularity(record) / (2.0 * signals.half_length) + computed;
  const bool is_noise = best->fit.is_noise();
  const auto [values, covariance] = average.of(is_noise);
  const auto interval = [&, values = values, covariance = covariance](Index column) {
    const bool of_soil = column < Model::of_k23;
    const Index at = column - Model::starts;
    return MeanInterval{values[at], std::hypot(t * std::sqrt(covariance(at, at)),
                                               of_soil ? 2.0 * of_time * values[at] : 0.0)};
  };
  const Model &found = best->fit.model();
  const auto correlation = [&, covariance = covariance](Index one, const MeanInterval &of_one, Index another,
                                                        const MeanInterval &of_another) {
    return covariance(one - Model::starts, another - Model::starts) * t * t /
           (of_one.half_width * of_another.half_width);
  };
  for (Index j = 0; j < Model::contacts; ++j) {
    ContactFit contact{interval(Model::of_k(j)), interval(Model::of_c(j))};
    contact.correlation = correlation(Model::of_k(j), contact.k, Model::of_c(j), contact.c);
    result.contacts.push_back(contact);
  }
  if constexpr (Model::contacts == 2)
    result.k_together =
        correlation(Model::of_k(0), result.contacts[0].k, Model::of_k(1), result.contacts[1].k);
  result.omega = interval(Model::of_omega);
  result.phase = interval(Model::of_phase);
  result.force = interval(Model::of_force);
  result.pulls = found.pulls;
  result.pull_is_clear = difference > (is_noise ? clear : certain);
  result.bond_stiffness = found.k23;
  result.bond_damping = found.c23;
  result.tension = best->fit.tension();
  result.residual = best->fit.level(0);
  result.is_noise = is_noise;
  result.cost = best->fit.cost();
  const typename Model::Stretch &longest =
      *std::max_element(best->fit.stretches().begin(), best->fit.stretches().end(),
                        [](const auto &a, const auto &b) { return a.end - a.first < b.end - b.first; });
  result.cycles = static_cast<double>(longest.end - longest.first) / signals.per_cycle;
  return result;
}

} // namespace

namespace {

// The same from these contacts or, if they are far off, from a softer or harder soil. If no motion follows
// the record to its noise, the exciter's force may be another than is said.
template <class Model>
std::optional<MotionFit> search(const Record &record, const Signals &signals, const Model &model,
                                const std::vector<typename Model::Stretch> &stretches, Known known,
                                const MotionSetting &setting) {
  if (!setting.search) return follow_record(record, signals, model, stretches, known);
  std::optional<MotionFit> best;
  for (const bool any_force : {false, true}) {
    if (any_force) known.of_force = std::min(known.of_force, weight_of(machine_agreement));
    for (const double factor : {1.0, 0.75, 1.35}) {
      Model other = model;
      for (double &k : other.k)
        k *= factor;
      std::vector<typename Model::Stretch> starts = stretches;
      for (typename Model::Stretch &stretch : starts)
        for (const Index height : {Index(0), Index(Model::tilts ? 4 : 0)})
          stretch.start[height] =
              stretches[static_cast<std::size_t>(&stretch - starts.data())].start[height] / factor;
      std::optional<MotionFit> fit = follow_record(record, signals, other, std::move(starts), known);
      if (fit) fit->any_force = any_force;
      if (fit && fit->is_noise) return fit;
      if (fit && (!best || fit->cost < best->cost)) best = std::move(fit);
    }
  }
  return best;
}

} // namespace

std::optional<MotionFit> fit_motion(const Record &record, const Identification &start,
                                    const MotionSetting &setting) {
  if (!complete(record) || !(start.law.k.mean > 0.0)) return std::nullopt;
  const bool logged = record.logger_filter.has_value();
  const Signals signals = signals_from(record, {logged ? &record.logged_drum : &record.a_drum},
                                       logged ? record.logged_frame : record.a_frame);
  auto model = model_from<OneContact>(record);
  model.k = {start.law.k.mean};
  model.c = {std::max(start.law.c.mean, 1e-3 * std::sqrt(model.k[0] * model.m2))};
  std::vector<OneContact::Stretch> stretches = first_stretches(signals, start);
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
  return search(record, signals, model, stretches, known_of(record, model.m3, model.g, setting), setting);
}

std::optional<MotionFit> fit_motion(const Record &record, const std::array<HalfStart, 2> &halves,
                                    const MotionSetting &setting) {
  if (!complete(record) || !record.ends) return std::nullopt;
  Signals signals = signals_from(record, {&record.a_left, &record.a_right}, record.a_frame);
  const TwoEnds &ends = *record.ends;
  auto model = model_from<TwoContacts>(record);
  for (std::size_t j = 0; j < halves.size(); ++j) {
    const LawEstimate &law = halves[j].contact.law;
    if (!(law.k.mean > 0.0)) return std::nullopt;
    model.k[j] = law.k.mean;
    model.c[j] = std::max(law.c.mean, 1e-3 * std::sqrt(model.k[j] * model.m2));
    model.place[j] = ends.contacts[j].y;
  }
  model.force = setting.force;
  model.sensor = {-ends.sensor, ends.sensor};
  model.I2 = ends.drum_inertia;
  model.I3 = ends.frame_inertia;
  model.exciter = ends.exciter;
  const auto places = [&ends](double AxleLink::*value) {
    double all = 0.0;
    BondPlaces sums;
    for (const AxleLink &bond : ends.bonds) {
      all += bond.*value;
      sums.first += bond.*value * bond.y;
      sums.second += bond.*value * bond.y * bond.y;
    }
    return all > 0.0 ? BondPlaces{sums.first / all, sums.second / all} : BondPlaces{};
  };
  model.spring = places(&AxleLink::k);
  model.dashpot = places(&AxleLink::c);
  signals.turn_drum = drum_tilt(record);
  signals.turn_frame = frame_tilt(record);
  Known known = known_of(record, model.m3, model.g, setting);
  // How the frame is tilted against the drum is computed: it may be off by as much as it moves.
  double squares = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i)
    squares += std::pow(signals.turn_drum[i] - signals.turn_frame[i], 2);
  const double omega2 = model.omega * model.omega;
  const double turn = std::sqrt(squares / static_cast<double>(record.size())) / omega2 +
                      std::fabs(model.spring.first) / model.spring.second * model.me_re / model.m2;
  known.of_turn = weight_of(turn);
  known.of_turning = weight_of(turn * model.omega);
  return search(record, signals, model, first_stretches(signals, halves, model), known, setting);
}

} // namespace drumlin::post
