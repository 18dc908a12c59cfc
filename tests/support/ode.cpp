#include "tests/support/ode.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

namespace oracle {

struct Ode::Solver {
  Rates rates;
  std::vector<Event> events;
  double time;
  State y;
  State scratch;
  State slopes;
  SUNContext context = nullptr;
  N_Vector vector = nullptr;
  N_Vector tolerances = nullptr;
  SUNNonlinearSolver nonlinear = nullptr;
  void *cvode = nullptr;

  void load(N_Vector v) { scratch.assign(N_VGetArrayPointer(v), N_VGetArrayPointer(v) + y.size()); }
};

namespace {

void check(int flag, const char *call) {
  if (flag < 0) throw std::runtime_error(std::string(call) + " failed: " + std::to_string(flag));
}

} // namespace

Ode::Ode(Rates rates, double t, State y, const State &scale) : solver_(std::make_unique<Solver>()) {
  Solver &s = *solver_;
  s.rates = std::move(rates);
  s.time = t;
  s.y = std::move(y);
  s.slopes.resize(s.y.size());
#if SUNDIALS_VERSION_MAJOR >= 7
  const auto no_ranks = SUN_COMM_NULL;
#else
  void *const no_ranks = nullptr;
#endif
  check(SUNContext_Create(no_ranks, &s.context), "SUNContext_Create");
  const auto size = static_cast<sunindextype>(s.y.size());
  s.vector = N_VNew_Serial(size, s.context);
  s.tolerances = N_VNew_Serial(size, s.context);
  for (std::size_t i = 0; i < s.y.size(); ++i) {
    N_VGetArrayPointer(s.vector)[i] = s.y[i];
    N_VGetArrayPointer(s.tolerances)[i] = 1e-13 * scale.at(i);
  }
  s.cvode = CVodeCreate(CV_ADAMS, s.context);
  const CVRhsFn right_hand_side = [](sunrealtype time, N_Vector at, N_Vector slope, void *self) {
    Solver &me = *static_cast<Solver *>(self);
    me.load(at);
    me.rates(time, me.scratch, me.slopes);
    for (std::size_t i = 0; i < me.slopes.size(); ++i)
      N_VGetArrayPointer(slope)[i] = me.slopes[i];
    return 0;
  };
  check(CVodeInit(s.cvode, right_hand_side, t, s.vector), "CVodeInit");
  check(CVodeSVtolerances(s.cvode, 1e-12, s.tolerances), "CVodeSVtolerances");
  check(CVodeSetUserData(s.cvode, &s), "CVodeSetUserData");
  check(CVodeSetMaxNumSteps(s.cvode, 1000000), "CVodeSetMaxNumSteps");
  s.nonlinear = SUNNonlinSol_FixedPoint(s.vector, 0, s.context);
  check(CVodeSetNonlinearSolver(s.cvode, s.nonlinear), "CVodeSetNonlinearSolver");
  check(CVodeSetNoInactiveRootWarn(s.cvode), "CVodeSetNoInactiveRootWarn");
}

Ode::~Ode() {
  CVodeFree(&solver_->cvode);
  SUNNonlinSolFree(solver_->nonlinear);
  N_VDestroy(solver_->tolerances);
  N_VDestroy(solver_->vector);
  SUNContext_Free(&solver_->context);
}

int Ode::advance(double t_end, const std::vector<Event> &events) {
  Solver &s = *solver_;
  s.events = events;
  const CVRootFn roots = [](sunrealtype time, N_Vector at, sunrealtype *values, void *self) {
    Solver &me = *static_cast<Solver *>(self);
    me.load(at);
    for (std::size_t i = 0; i < me.events.size(); ++i)
      values[i] = me.events[i](time, me.scratch);
    return 0;
  };
  check(CVodeRootInit(s.cvode, static_cast<int>(events.size()), events.empty() ? nullptr : roots),
        "CVodeRootInit");
  // CVODE looks where its last search for roots ended, which a changed set of events has never had: start
  // again.
  check(CVodeReInit(s.cvode, s.time, s.vector), "CVodeReInit");
  check(CVodeSetStopTime(s.cvode, t_end), "CVodeSetStopTime");
  sunrealtype reached = s.time;
  const int flag = CVode(s.cvode, t_end, s.vector, &reached, CV_NORMAL);
  check(flag, "CVode");
  s.time = reached;
  s.y.assign(N_VGetArrayPointer(s.vector), N_VGetArrayPointer(s.vector) + s.y.size());
  if (flag != CV_ROOT_RETURN) return -1;
  std::vector<int> found(events.size());
  check(CVodeGetRootInfo(s.cvode, found.data()), "CVodeGetRootInfo");
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i] != 0) return static_cast<int>(i);
  throw std::runtime_error("CVODE reports a root and names none");
}

void Ode::restart(const State &y) {
  Solver &s = *solver_;
  s.y = y;
  for (std::size_t i = 0; i < y.size(); ++i)
    N_VGetArrayPointer(s.vector)[i] = y[i];
  check(CVodeReInit(s.cvode, s.time, s.vector), "CVodeReInit");
}

double Ode::time() const { return solver_->time; }
const State &Ode::state() const { return solver_->y; }

} // namespace oracle
