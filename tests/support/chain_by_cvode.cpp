#include "tests/support/chain_by_cvode.h"
#include "runs/chain_files.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

namespace drumlin::test {

using post::ChainHistory, post::ChainParameters, post::ContactEvent, post::CycleSummary, post::ExactOptions,
    post::ExactSolution, post::Transition, post::WaySection;

namespace {

// SUNDIALS 6 has both names for its numbers, later ones only this, earlier ones only realtype.
static_assert(std::is_same_v<sunrealtype, double>, "SUNDIALS must be built in double precision");

constexpr double no_limit = std::numeric_limits<double>::infinity();

// Position and velocity of the drum, position and velocity of the frame.
enum Component : std::size_t { x_drum, v_drum, x_frame, v_frame };
using State = std::array<double, 4>;

// The smooth pieces of the motion. `clamped` is condition B's overlap without force: d > 0, k d + c d' <= 0.
enum class Phase { contact, free, clamped };

// A way out of a phase: `value` is negative inside the phase and crosses zero upwards on leaving it.
struct Exit {
  double value = -1.0;
  double rate = 0.0;
};

// Which exits a phase has, in the order of Exits. `gap` closes a contact of A or opens one from a free drum;
// `force` breaks or re-makes a contact of B; `apart` is the end of an overlap without force.
constexpr std::size_t max_exits = 2;
using Exits = std::array<Exit, max_exits>;

// Stiffness and damping of the contact at a time, and their rates of change while the roller drives.
struct Soil {
  double k = 0.0, c = 0.0;           // N/m, N s/m
  double k_rate = 0.0, c_rate = 0.0; // per second
};

class Chain {
public:
  explicit Chain(const ChainParameters &parameters, const std::vector<WaySection> &way = {})
      : p_(parameters), standing_{p_.k, p_.damping(), 0.0, 0.0} {
    // k and D are linear within a section, so that their extremes are at its ends.
    for (const WaySection &section : way)
      for (const double t : {section.begin, section.end}) {
        section_ = &section;
        met_.push_back(soil(t));
      }
    if (way.empty()) met_.push_back(standing_);
    section_ = way.empty() ? nullptr : &way.front();
  }

  const ChainParameters &parameters() const { return p_; }

  // The roller now drives over this section of its way.
  void enter(const WaySection &section) { section_ = &section; }
  const WaySection *section() const { return section_; }

  Soil soil(double t) const {
    if (section_ == nullptr) return standing_;
    const double k = section_->k + section_->k_rate * (t - section_->begin);
    const double D = section_->D + section_->D_rate * (t - section_->begin);
    const double critical = 2.0 * std::sqrt(p_.m2 * k); // c = 2 D sqrt(m2 k)
    return {k, critical * D, section_->k_rate,
            critical * (section_->D_rate + 0.5 * D * section_->k_rate / k)};
  }

  double excitation(double t) const { return p_.Fw * std::sin(p_.omega * t); }
  double bond(const State &y) const {
    return p_.c23 * (y[v_frame] - y[v_drum]) + p_.k23 * (y[x_frame] - y[x_drum]);
  }
  // k d + c d', whether it acts or not.
  double law(double t, const State &y) const {
    const Soil at = soil(t);
    return -(at.k * y[x_drum] + at.c * y[v_drum]);
  }
  // Its rate, from y' at the same time.
  double law_rate(double t, const State &y, const State &rate) const {
    const Soil at = soil(t);
    return -(at.k * rate[x_drum] + at.c * rate[v_drum]) - (at.k_rate * y[x_drum] + at.c_rate * y[v_drum]);
  }
  double contact_force(Phase phase, double t, const State &y) const {
    return phase == Phase::contact ? law(t, y) : 0.0;
  }

  // The contact force for output files. Near the end of a contact under condition B the force is zero within
  // rounding errors; a negative value there is written as zero.
  double recorded_force(Phase phase, double t, const State &y) const {
    const double force = contact_force(phase, t, y);
    return p_.transition == Transition::B ? std::max(0.0, force) : force;
  }

  // y' = f(t, y)
  State derivative(Phase phase, double t, const State &y) const {
    const double bond_force = bond(y);
    return {y[v_drum], (contact_force(phase, t, y) + bond_force - excitation(t)) / p_.m2 - p_.g, y[v_frame],
            -bond_force / p_.m3 - p_.g};
  }

  // The row of df/dy that belongs to the drum's (m = m2, sign +) or the frame's acceleration (m3, sign -).
  State drum_row(Phase phase, double t) const {
    const Soil at = phase == Phase::contact ? soil(t) : Soil();
    return {-(at.k + p_.k23) / p_.m2, -(at.c + p_.c23) / p_.m2, p_.k23 / p_.m2, p_.c23 / p_.m2};
  }
  State frame_row() const { return {p_.k23 / p_.m3, p_.c23 / p_.m3, -p_.k23 / p_.m3, -p_.c23 / p_.m3}; }

  // Rate of the drum's acceleration, from y' at the same time.
  double drum_jerk(Phase phase, double t, const State &y, const State &rate) const {
    const State row = drum_row(phase, t);
    const Soil at = phase == Phase::contact ? soil(t) : Soil();
    double jerk = -p_.omega * p_.Fw * std::cos(p_.omega * t) / p_.m2 -
                  (at.k_rate * y[x_drum] + at.c_rate * y[v_drum]) / p_.m2;
    for (std::size_t i = 0; i < row.size(); ++i)
      jerk += row[i] * rate[i];
    return jerk;
  }

  std::size_t exit_count(Phase phase) const { return phase == Phase::clamped ? 2 : 1; }

  Exits exits(Phase phase, double t, const State &y) const {
    const State rate = derivative(phase, t, y);
    const double force = law(t, y);
    const double force_rate = law_rate(t, y, rate);
    const Exit overlap_begins = {-y[x_drum], -y[v_drum]};
    const Exit overlap_ends = {y[x_drum], y[v_drum]};
    const Exit force_begins = {force, force_rate};
    const Exit force_ends = {-force, -force_rate};
    switch (phase) {
    case Phase::contact:
      return {p_.transition == Transition::A ? overlap_ends : force_ends, Exit{}};
    case Phase::free:
      return {overlap_begins, Exit{}};
    case Phase::clamped:
      break;
    }
    return {overlap_ends, force_begins};
  }

  // Whether the fastest decay of the phase is so much faster than the motion that BDF needs fewer steps than
  // Adams. Adams' steps are limited by the decay rate (to a few tenths of its inverse), BDF's at tight
  // tolerances by accuracy (some thousand steps per radian of the motion), so that the two cost the same at a
  // ratio of the rates near 10^2 to 10^3.
  bool stiff(Phase phase, double t) const { return stiff(rates(phase == Phase::contact ? soil(t) : Soil())); }

  double largest_stiffness() const {
    return std::max_element(met_.begin(), met_.end(),
                            [](const Soil &one, const Soil &other) { return one.k < other.k; })
        ->k;
  }
  double largest_damping() const {
    return std::max_element(met_.begin(), met_.end(),
                            [](const Soil &one, const Soil &other) { return one.c < other.c; })
        ->c;
  }

private:
  struct Rates {
    double decay = 0.0;  // of the fastest overdamped pair, 1/s
    double motion = 0.0; // fastest oscillation or excitation, rad/s
  };
  static bool stiff(const Rates &found) {
    constexpr double bdf_pays = 300.0;
    return found.decay > bdf_pays * found.motion;
  }
  Rates rates(const Soil &soil) const {
    Rates rates = {0.0, p_.omega};
    const auto include = [&rates](double k, double c, double m) {
      const double beta = 0.5 * c / m;
      const double square = k / m;
      if (beta * beta > square)
        rates.decay = std::max(rates.decay, beta + std::sqrt(beta * beta - square));
      else
        rates.motion = std::max(rates.motion, std::sqrt(square));
    };
    include(soil.k, soil.c, p_.m2);
    include(p_.k23, p_.c23, p_.m2 * p_.m3 / (p_.m2 + p_.m3));
    return rates;
  }

  ChainParameters p_;
  Soil standing_;                       // where it does not drive
  const WaySection *section_ = nullptr; // where it drives
  std::vector<Soil> met_;
};

// Absolute tolerances far below each component's contribution to the forces: a relative tolerance alone could
// not be met where a component passes through zero.
State absolute_tolerances(const Chain &chain, double impact_speed, double rtol) {
  const ChainParameters &p = chain.parameters();
  const double k = chain.largest_stiffness();
  const double c = chain.largest_damping();
  const double root = std::sqrt(p.m2 * k);
  double force = std::max({p.Fw, (p.m2 + p.m3) * p.g, impact_speed * root});
  if (force <= 0.0) force = 1.0;
  const double part = 1e-2 * rtol * force;
  return {part / k, part * std::min(1.0 / (c + root), p.omega / k),
          part / std::max({p.k23, p.c23 * p.omega, p.m3 * p.omega * p.omega}),
          part / std::max({p.c23, p.k23 / p.omega, p.m3 * p.omega})};
}

// ---- CVODE

// SUNDIALS frees some things by their value, some by a pointer to it.
template <auto free>
struct Free {
  template <class Thing>
  void operator()(Thing *thing) const {
    if constexpr (std::is_invocable_v<decltype(free), Thing *>)
      free(thing);
    else
      free(&thing);
  }
};
template <class Thing, auto free>
using Pointer = std::unique_ptr<std::remove_pointer_t<Thing>, Free<free>>;
using ContextPointer = Pointer<SUNContext, SUNContext_Free>;
using VectorPointer = Pointer<N_Vector, N_VDestroy>;
using MatrixPointer = Pointer<SUNMatrix, SUNMatDestroy>;
using LinearSolverPointer = Pointer<SUNLinearSolver, SUNLinSolFree>;
using IntegratorPointer = Pointer<void *, CVodeFree>;

State state_of(N_Vector vector) {
  const double *data = N_VGetArrayPointer(vector);
  return {data[0], data[1], data[2], data[3]};
}

void put_state(const State &state, N_Vector vector) {
  std::copy(state.begin(), state.end(), N_VGetArrayPointer(vector));
}

// Where a step of the integrator ended.
struct Reached {
  double elapsed = 0.0;                     // since the start of the piece
  bool at_end = false;                      // at the stop time
  std::array<bool, max_exits> leaving = {}; // the exits that CVODE found crossed here
};

// One method of CVODE for one chain, started again for every smooth piece. Time runs from 0 within a piece,
// so that events are located to the rounding of the piece's length rather than of the whole run's.
class Integrator {
public:
  Integrator(SUNContext context, const Chain &chain, double impact_speed, double rtol, bool bdf)
      : chain_(chain), state_(N_VNew_Serial(4, context)), tolerance_(N_VNew_Serial(4, context)),
        dense_(N_VNew_Serial(4, context)), matrix_(SUNDenseMatrix(4, 4, context)),
        linear_(SUNLinSol_Dense(state_.get(), matrix_.get(), context)),
        memory_(CVodeCreate(bdf ? CV_BDF : CV_ADAMS, context)) {
    if (!state_ || !tolerance_ || !dense_ || !matrix_ || !linear_ || !memory_)
      throw std::runtime_error("CVODE could not be set up");
    put_state({0.0, 0.0, 0.0, 0.0}, state_.get());
    put_state(absolute_tolerances(chain, impact_speed, rtol), tolerance_.get());
    void *memory = memory_.get();
    check(CVodeInit(memory, &Integrator::right_hand_side, 0.0, state_.get()), "CVodeInit");
#if SUNDIALS_VERSION_MAJOR >= 7
    check(SUNContext_PushErrHandler(context, &Integrator::note_error, this), "SUNContext_PushErrHandler");
#else
    check(CVodeSetErrHandlerFn(memory, &Integrator::note_error, this), "CVodeSetErrHandlerFn");
#endif
    check(CVodeSetUserData(memory, this), "CVodeSetUserData");
    check(CVodeSVtolerances(memory, rtol, tolerance_.get()), "CVodeSVtolerances");
    check(CVodeSetLinearSolver(memory, linear_.get(), matrix_.get()), "CVodeSetLinearSolver");
    check(CVodeSetJacFn(memory, &Integrator::jacobian), "CVodeSetJacFn");
    // The pieces are linear: with the matrix always fresh one Newton iteration is exact.
    check(CVodeSetDeltaGammaMaxLSetup(memory, 0.0), "CVodeSetDeltaGammaMaxLSetup");
    check(CVodeSetMaxNumSteps(memory, -1), "CVodeSetMaxNumSteps");
    check(CVodeSetMaxErrTestFails(memory, 20), "CVodeSetMaxErrTestFails");
    check(CVodeSetMaxStep(memory, chain.parameters().period() / 40.0), "CVodeSetMaxStep");
    check(CVodeSetNoInactiveRootWarn(memory), "CVodeSetNoInactiveRootWarn");
  }

  // Starts a piece at time t0 that lasts no longer than `length`.
  void start(Phase phase, double t0, const State &state, double length) {
    phase_ = phase;
    t0_ = t0;
    length_ = length;
    put_state(state, state_.get());
    void *memory = memory_.get();
    check(CVodeReInit(memory, 0.0, state_.get()), "CVodeReInit");
    const std::size_t exits = chain_.exit_count(phase);
    check(CVodeRootInit(memory, static_cast<int>(exits), &Integrator::root_functions), "CVodeRootInit");
    // Exits count upwards only: at the start of a piece the function that fired last is zero up to rounding
    // and on its way down.
    std::array<int, max_exits> direction = {1, 1};
    check(CVodeSetRootDirection(memory, direction.data()), "CVodeSetRootDirection");
    check(CVodeSetStopTime(memory, length), "CVodeSetStopTime");
  }

  // Continues by one step, or less if a root lies within it.
  Reached step() {
    Reached reached;
    const int flag = CVode(memory_.get(), length_, state_.get(), &reached.elapsed, CV_ONE_STEP);
    check(flag, "CVode");
    reached.at_end = flag == CV_TSTOP_RETURN;
    if (flag == CV_ROOT_RETURN) {
      std::array<int, max_exits> found = {};
      check(CVodeGetRootInfo(memory_.get(), found.data()), "CVodeGetRootInfo");
      for (std::size_t i = 0; i < chain_.exit_count(phase_); ++i)
        reached.leaving[i] = found[i] > 0;
    }
    return reached;
  }

  // The state where step() ended.
  State state() const { return state_of(state_.get()); }

  // The state at any time within the last step.
  State state_at(double elapsed) {
    check(CVodeGetDky(memory_.get(), elapsed, 0, dense_.get()), "CVodeGetDky");
    return state_of(dense_.get());
  }

  // Steps in the piece so far.
  long steps() const {
    long steps = 0;
    CVodeGetNumSteps(memory_.get(), &steps);
    return steps;
  }

private:
  static int right_hand_side(sunrealtype elapsed, N_Vector y, N_Vector rate, void *user) {
    const auto &self = *static_cast<Integrator *>(user);
    put_state(self.chain_.derivative(self.phase_, self.t0_ + elapsed, state_of(y)), rate);
    return 0;
  }

  static int jacobian(sunrealtype elapsed, N_Vector /*y*/, N_Vector /*rate*/, SUNMatrix matrix, void *user,
                      N_Vector /*work1*/, N_Vector /*work2*/, N_Vector /*work3*/) {
    const auto &self = *static_cast<Integrator *>(user);
    const std::array<State, 4> rows = {{{0.0, 1.0, 0.0, 0.0},
                                        self.chain_.drum_row(self.phase_, self.t0_ + elapsed),
                                        {0.0, 0.0, 0.0, 1.0},
                                        self.chain_.frame_row()}};
    for (std::size_t column = 0; column < 4; ++column) {
      double *entries = SUNDenseMatrix_Column(matrix, static_cast<sunindextype>(column));
      for (std::size_t row = 0; row < 4; ++row)
        entries[row] = rows[row][column];
    }
    return 0;
  }

  static int root_functions(sunrealtype elapsed, N_Vector y, sunrealtype *values, void *user) {
    const auto &self = *static_cast<Integrator *>(user);
    const State state = state_of(y);
    const Exits exits = self.chain_.exits(self.phase_, self.t0_ + elapsed, state);
    for (std::size_t i = 0; i < self.chain_.exit_count(self.phase_); ++i)
      values[i] = exits[i].value;
    return 0;
  }

#if SUNDIALS_VERSION_MAJOR >= 7
  static void note_error(int /*line*/, const char * /*function*/, const char * /*file*/, const char *message,
                         SUNErrCode /*code*/, void *user, SUNContext /*context*/) {
    if (message != nullptr) static_cast<Integrator *>(user)->message_ = message;
  }
#else
  static void note_error(int code, const char * /*module*/, const char * /*function*/, char *message,
                         void *user) {
    if (code < 0) static_cast<Integrator *>(user)->message_ = message;
  }
#endif

  void check(int flag, const char *function) const {
    if (flag >= 0) return;
    std::string text = fmt::format("CVODE failed at t = {} s: {} returned {}", t0_, function, flag);
    if (!message_.empty()) text += ": " + message_;
    std::replace(text.begin(), text.end(), '\n', ' ');
    throw std::runtime_error(text);
  }

  const Chain &chain_;
  Phase phase_ = Phase::contact;
  double t0_ = 0.0;
  double length_ = 0.0;
  std::string message_;
  VectorPointer state_;
  VectorPointer tolerance_;
  VectorPointer dense_;
  MatrixPointer matrix_;
  LinearSolverPointer linear_;
  IntegratorPointer memory_;
};

// ---- what is recorded

// Smallest and largest value of a smooth function that is known with its rate at successive points.
class Extremes {
public:
  void point(double value) {
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
  }

  // Between two points `h` apart: the turn of the cubic through both values and rates, if a rate changes
  // sign.
  void between(double value0, double rate0, double value1, double rate1, double h) {
    if (rate0 * rate1 >= 0.0) return;
    const double slope = (value1 - value0) / h;
    const double a = 3.0 * (rate0 + rate1 - 2.0 * slope);
    const double b = 2.0 * (3.0 * slope - 2.0 * rate0 - rate1);
    const double root = std::sqrt(std::max(0.0, b * b - 4.0 * a * rate0));
    const double q = -0.5 * (b + std::copysign(root, b));
    // a s^2 + b s + rate0 = 0 changes sign between s = 0 and 1, so exactly one of its roots lies there.
    const double s1 = q / a;
    const double s = (a != 0.0 && s1 >= 0.0 && s1 <= 1.0) ? s1 : rate0 / q;
    if (s >= 0.0 && s <= 1.0) point(value0 + h * s * (rate0 + s * (0.5 * b + s * a / 3.0)));
  }

  double min() const { return min_; }
  double max() const { return max_; }

private:
  double min_ = no_limit;
  double max_ = -no_limit;
};

// A moment of the motion: time, state, and what the extremes need.
struct Moment {
  double time = 0.0;
  double acceleration = 0.0;
  double jerk = 0.0;
  double force = 0.0;
  double force_rate = 0.0;
};

// Samples at equal times, extremes per cycle. Its grid refines the samples (ExactOptions::last_point()).
class Recorder {
public:
  Recorder(const Chain &chain, const ExactOptions &options)
      : chain_(chain), per_sample_(options.points_per_sample()), per_cycle_(options.points_per_cycle()),
        last_(options.last_point()), cycles_(static_cast<std::size_t>(last_ / per_cycle_) + 1) {}

  double end() const { return time_of(last_); }
  // The next point of the grid that awaits recording; infinity after the last.
  double next() const { return next_ <= last_ ? time_of(next_) : no_limit; }

  // A piece begins: the extremes do not connect it to the piece before.
  void begin_piece(Phase phase, double t, const State &y) {
    before_ = moment(phase, t, y, chain_.derivative(phase, t, y));
    take(before_);
  }

  // The motion continues smoothly to t, which is not later than next().
  void follow(Phase phase, double t, const State &y) {
    const State rate = chain_.derivative(phase, t, y);
    const Moment now = moment(phase, t, y, rate);
    take(now);
    const double h = now.time - before_.time;
    if (h > 0.0) {
      Cycle &cycle = current();
      cycle.a.between(before_.acceleration, before_.jerk, now.acceleration, now.jerk, h);
      cycle.F.between(before_.force, before_.force_rate, now.force, now.force_rate, h);
    }
    before_ = now;
  }

  // Records the grid's next point with the state there.
  void grid_point(Phase phase, const State &y) {
    const double t = time_of(next_);
    if (next_ % per_sample_ == 0) {
      const State rate = chain_.derivative(phase, t, y);
      history_.time.push_back(t);
      history_.x_drum.push_back(y[x_drum]);
      history_.v_drum.push_back(y[v_drum]);
      history_.a_drum.push_back(rate[v_drum]);
      history_.x_frame.push_back(y[x_frame]);
      history_.v_frame.push_back(y[v_frame]);
      history_.a_frame.push_back(rate[v_frame]);
      history_.F_contact.push_back(chain_.recorded_force(phase, t, y));
      history_.F_excitation.push_back(chain_.excitation(t));
      history_.F_bond.push_back(chain_.bond(y));
      if (const WaySection *section = chain_.section()) {
        history_.s.push_back(section->place(t));
        history_.pass.push_back(section->pass);
      }
    }
    ++next_;
    take(moment(phase, t, y, chain_.derivative(phase, t, y))); // a border of cycles belongs to both
  }

  // The contact lasted from `from` to `to`.
  void contact(double from, double to) {
    for (std::size_t i = cycle_at(from); i < cycles_.size() && time_of_cycle(i) < to; ++i)
      cycles_[i].contact +=
          std::max(0.0, std::min(to, time_of_cycle(i + 1)) - std::max(from, time_of_cycle(i)));
  }

  void event(const ContactEvent &event) {
    Cycle &cycle = cycles_[cycle_at(event.time)];
    ++(event.make ? cycle.makes : cycle.breaks);
  }

  ChainHistory take_history() { return std::move(history_); }

  std::vector<CycleSummary> summaries() const {
    std::vector<CycleSummary> rows;
    for (std::size_t i = 0; i < static_cast<std::size_t>(last_ / per_cycle_); ++i) {
      const Cycle &cycle = cycles_[i];
      rows.push_back(
          {static_cast<int>(i) + 1, time_of_cycle(i), cycle.a.min(), cycle.a.max(),
           chain_.parameters().transition == Transition::B ? std::max(0.0, cycle.F.min()) : cycle.F.min(),
           cycle.F.max(), std::min(1.0, cycle.contact / chain_.parameters().period()), cycle.makes,
           cycle.breaks});
    }
    return rows;
  }

private:
  struct Cycle {
    Extremes a;
    Extremes F;
    double contact = 0.0;
    int makes = 0;
    int breaks = 0;
  };

  double time_of(long point) const {
    return static_cast<double>(point) * chain_.parameters().period() / static_cast<double>(per_cycle_);
  }
  double time_of_cycle(std::size_t cycle) const { return time_of(static_cast<long>(cycle) * per_cycle_); }

  std::size_t cycle_at(double t) const {
    const auto cycle = static_cast<std::size_t>(std::max(0.0, t / chain_.parameters().period()));
    return std::min(cycle, cycles_.size() - 1);
  }

  // The cycle between the last point recorded and the next.
  Cycle &current() { return cycles_[static_cast<std::size_t>(std::max(0L, next_ - 1) / per_cycle_)]; }

  Moment moment(Phase phase, double t, const State &y, const State &rate) const {
    return {t, rate[v_drum], chain_.drum_jerk(phase, t, y, rate), chain_.contact_force(phase, t, y),
            phase == Phase::contact ? chain_.law_rate(t, y, rate) : 0.0};
  }

  void take(const Moment &now) {
    Cycle &cycle = current();
    cycle.a.point(now.acceleration);
    cycle.F.point(now.force);
  }

  const Chain &chain_;
  long per_sample_;
  long per_cycle_;
  long last_;
  long next_ = 0;
  std::vector<Cycle> cycles_;
  ChainHistory history_;
  Moment before_;
};

// ---- the run

class Run {
public:
  Run(const ChainParameters &parameters, const ExactOptions &options, double rtol)
      : chain_(parameters, options.way), options_(options), rtol_(rtol), recorder_(chain_, options) {
    SUNContext context = nullptr;
#if SUNDIALS_VERSION_MAJOR >= 7
    const auto no_ranks = SUN_COMM_NULL;
#else
    void *const no_ranks = nullptr;
#endif
    if (SUNContext_Create(no_ranks, &context) != 0) throw std::runtime_error("SUNDIALS could not be set up");
    context_.reset(context);
  }

  ExactSolution solve() {
    begin();
    const double end = recorder_.end();
    recorder_.begin_piece(phase_, t_, y_);
    recorder_.grid_point(phase_, y_);
    // The rest of the run after an event near its end may be shorter than the rounding error of the period:
    // nothing moves in it.
    const double nothing = 1e-14 * chain_.parameters().period();
    std::size_t section = 0;
    while (end - t_ > nothing) {
      const bool last = section + 1 >= options_.way.size();
      const double until = last ? end : std::min(end, options_.way[section].end);
      while (until - t_ > nothing && !piece(until)) {
      }
      if (last) break;
      enter(options_.way[++section]);
    }
    while (recorder_.next() <= end)
      recorder_.grid_point(phase_, y_);
    if (phase_ == Phase::contact) recorder_.contact(made_at_, end);

    result_.history = recorder_.take_history();
    result_.cycles = recorder_.summaries();
    return std::move(result_);
  }

private:
  void begin() {
    const ChainParameters &p = chain_.parameters();
    if (options_.impact_speed > 0.0) {
      y_ = {0.0, -options_.impact_speed, 0.0, -options_.impact_speed};
    } else {
      const double x2 = p.g > 0.0 ? -(p.m2 + p.m3) * p.g / chain_.soil(0.0).k : 0.0;
      y_ = {x2, 0.0, p.g > 0.0 ? x2 - p.m3 * p.g / p.k23 : x2, 0.0};
    }
    if (y_[x_drum] < 0.0) {
      phase_ = Phase::contact;
    } else if (options_.impact_speed > 0.0 || p.Fw > 0.0) {
      make(chain_.soil(t_).c * -y_[v_drum]); // touching, and moving or about to be pushed down
    } else {
      phase_ = Phase::free; // touching, and nothing acts
    }
  }

  // The roller comes to the next section of its way. At a step of the soil the force jumps; under B a contact
  // then ends where it would be a tension, and begins again where it is a compression.
  void enter(const WaySection &section) {
    const double before = chain_.law(t_, y_);
    chain_.enter(section);
    const double force = chain_.law(t_, y_);
    if (chain_.parameters().transition == Transition::A || y_[x_drum] >= 0.0 || force == before) return;
    if (phase_ == Phase::contact && force < 0.0)
      end_contact(Phase::clamped, std::max(0.0, before));
    else if (phase_ == Phase::clamped && force > 0.0)
      make(force);
  }

  // One smooth piece, from event to event; true if it reached `end`.
  bool piece(double end) {
    const double start = t_;
    const bool stiff = chain_.stiff(phase_, start);
    Integrator &integrator = method(stiff);
    integrator.start(phase_, start, y_, end - start);
    if (start > 0.0) recorder_.begin_piece(phase_, start, y_);

    // Adams takes few long steps: look between their ends for extremes. BDF's steps are short.
    const int parts = stiff ? 1 : 4;
    double elapsed = 0.0;
    while (true) {
      const Reached reached = integrator.step();
      constexpr long most_steps = 200'000'000; // minutes: rounding can make steps short without end
      if (++steps_ > most_steps)
        throw std::runtime_error(
            fmt::format("CVODE took more than {} steps up to t = {} s", most_steps, start + reached.elapsed));
      const Departure departure = first_departure(integrator, start, elapsed, reached);
      const double until = departure.exit ? departure.elapsed : reached.elapsed;
      const State y = until < reached.elapsed ? integrator.state_at(until) : integrator.state();
      for (int part = 1; part <= parts; ++part) {
        const double to = elapsed + (until - elapsed) * part / parts;
        while (recorder_.next() <= start + to) {
          const double grid = recorder_.next();
          const State there = integrator.state_at(std::min(std::max(grid - start, elapsed), until));
          recorder_.follow(phase_, grid, there);
          recorder_.grid_point(phase_, there);
        }
        recorder_.follow(phase_, start + to, part == parts ? y : integrator.state_at(to));
      }
      elapsed = until;
      if (departure.exit || reached.at_end) {
        result_.pieces += integrator.steps();
        t_ = departure.exit ? start + elapsed : end;
        y_ = y;
        if (departure.exit) leave(*departure.exit);
        return !departure.exit;
      }
    }
  }

  // Where the phase ends within the last step, if it does.
  struct Departure {
    std::optional<std::size_t> exit;
    double elapsed = no_limit;
  };

  // CVODE finds the exits whose sign differs between the two ends of the step. It does not find two kinds: a
  // function that crosses zero and returns within the step, and one that is zero, or positive by rounding,
  // where the piece starts.
  Departure first_departure(Integrator &integrator, double start, double from, const Reached &reached) const {
    const auto exits_at = [&](double elapsed) {
      const State y = integrator.state_at(elapsed);
      return chain_.exits(phase_, start + elapsed, y);
    };
    const Exits before = exits_at(from);
    const Exits now = exits_at(reached.elapsed);
    Departure first;
    for (std::size_t i = 0; i < chain_.exit_count(phase_); ++i) {
      double lo = from;
      double hi = reached.elapsed;
      if (reached.leaving[i]) {
        lo = hi;
      } else {
        // Narrows lo and hi to where `negative` turns false.
        const auto bisect = [&lo, &hi](const auto &negative) {
          for (double middle = 0.5 * (lo + hi); lo < middle && middle < hi; middle = 0.5 * (lo + hi))
            (negative(middle) ? lo : hi) = middle;
        };
        if (now[i].value > 0.0) {
          if (before[i].rate < 0.0) { // it falls at first: it can cross zero only after a minimum
            if (now[i].rate <= 0.0) continue;
            bisect([&](double elapsed) { return exits_at(elapsed)[i].rate < 0.0; });
            hi = reached.elapsed;
          }
        } else if (before[i].rate > 0.0 && now[i].rate < 0.0) { // it has a maximum within the step: find it
          bisect([&](double elapsed) { return exits_at(elapsed)[i].rate > 0.0; });
          if (exits_at(hi)[i].value <= 0.0) continue;
          lo = from;
        } else {
          continue;
        }
        if (exits_at(lo)[i].value < 0.0)
          bisect([&](double elapsed) { return exits_at(elapsed)[i].value < 0.0; });
      }
      if (lo < first.elapsed) first = {i, lo};
    }
    return first;
  }

  void leave(std::size_t exit) {
    switch (phase_) {
    case Phase::free:
      y_[x_drum] = 0.0;
      make(chain_.soil(t_).c * -y_[v_drum]);
      break;
    case Phase::clamped:
      if (exit == 0) {
        y_[x_drum] = 0.0;
        phase_ = Phase::free;
      } else {
        make(0.0);
      }
      break;
    case Phase::contact:
      if (chain_.parameters().transition == Transition::A) {
        y_[x_drum] = 0.0;
        end_contact(Phase::free, chain_.soil(t_).c * -y_[v_drum]);
      } else if (chain_.soil(t_).c > 0.0 && y_[x_drum] < 0.0) {
        end_contact(Phase::clamped, 0.0);
      } else { // without damping F_c = 0 and d = 0 are one
        y_[x_drum] = 0.0;
        end_contact(Phase::free, 0.0);
      }
      break;
    }
  }

  void make(double force) {
    phase_ = Phase::contact;
    made_at_ = t_;
    log(true, force);
  }

  void end_contact(Phase next, double force) {
    phase_ = next;
    recorder_.contact(made_at_, t_);
    log(false, force);
  }

  void log(bool made, double force) {
    // 0 - x rather than -x: an overlap of zero is written "0", not "-0".
    const ContactEvent event = {t_, made, 0.0 - y_[x_drum], 0.0 - y_[v_drum], force + 0.0, 1, 2};
    result_.events.push_back(event);
    recorder_.event(event);
    constexpr std::size_t per_cycle = 100000;
    constexpr std::size_t most = ExactOptions::most_events;
    if (result_.events.size() > most)
      throw std::runtime_error(
          fmt::format("CVODE met more than {} contacts made and broken up to t = {} s", most, t_));
    if (result_.events.size() > per_cycle * (1 + static_cast<std::size_t>(t_ / chain_.parameters().period())))
      throw std::runtime_error(fmt::format(
          "CVODE met more than {} contacts made and broken per cycle up to t = {} s", per_cycle, t_));
  }

  Integrator &method(bool stiff) {
    std::unique_ptr<Integrator> &integrator = stiff ? bdf_ : adams_;
    if (!integrator)
      integrator = std::make_unique<Integrator>(context_.get(), chain_, options_.impact_speed, rtol_, stiff);
    return *integrator;
  }

  Chain chain_;
  ExactOptions options_;
  double rtol_;
  long steps_ = 0;
  Recorder recorder_;
  ContextPointer context_;
  std::unique_ptr<Integrator> adams_;
  std::unique_ptr<Integrator> bdf_;
  Phase phase_ = Phase::contact;
  double t_ = 0.0;
  State y_ = {};
  double made_at_ = 0.0;
  ExactSolution result_;
};

} // namespace

post::ExactSolution solve_by_cvode(const ChainParameters &parameters, const ExactOptions &options,
                                   double rtol) {
  std::string fault = parameters.invalid();
  if (fault.empty()) fault = options.invalid();
  if (!fault.empty()) throw std::invalid_argument(fault);
  return Run(parameters, options, rtol).solve();
}

} // namespace drumlin::test
