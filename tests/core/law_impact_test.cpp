/// Every contact law in impacts on a fixed partner and under a force that changes, by both schemes: motion,
/// heat and located makes and breaks against CVODE, restitution against the closed form. A law is a row of
/// `kinds`. Mass, stiffness (of first loading) and, but where stated, speed are 1.
#include "tests/core/velocity_verlet.h"
#include "tests/support/ode.h"
#include "physics/laws/laws.h"
#include "physics/laws/restitution.h"
#include "physics/scheme/event_location.h"

namespace {

using namespace drumlin::physics;
using drumlin::AnyLaw;
using verlet::Scheme;

constexpr double pi = 3.14159265358979323846;

/// A law as the pages state it, for the oracle: spring d^p, dashpot c d^q d', c = 2 D sqrt((p + 1)/2 ratio).
/// Unloading is `ratio` times as stiff as first loading. Beside it the law and the closed form of the core.
struct Kind {
  const char *name;
  double p, q, ratio;
  double bound; ///< of the error of the motion behind an impact of 100 steps
  AnyLaw (*law)(Transition, double D);
  double (*restitution)(Transition, double D);
};

template <int percent>
AnyLaw yield(Transition transition, double D) {
  return YieldContact{1.0, 0.01 * percent, D, Damping::ratio, transition}.law(1.0, 0.0, 0.0);
}
template <int percent>
double restitution_of_yielding(Transition transition, double D) {
  return restitution_of_yield(transition, D, 0.01 * percent);
}

const std::array<Kind, 4> kinds{
    {{"hooke", 1.0, 0.0, 1.0, 8e-4,
      [](Transition transition, double D) -> AnyLaw {
        return LinearContact{1.0, D, Damping::ratio, transition}.law(1.0);
      },
      restitution},
     {"hertz", 1.5, 0.25, 1.0, 1.1e-3,
      [](Transition transition, double D) -> AnyLaw {
        return HertzContact{0.75, 1.0, D, Damping::ratio, transition}.law(1.0, 1.0); // k = 4/3 E* sqrt(R)
      },
      restitution},
     {"yield15", 1.0, 0.0, 1.5, 1.2e-3, yield<150>, restitution_of_yielding<150>},
     {"yield4", 1.0, 0.0, 4.0, 4e-3, yield<400>, restitution_of_yielding<400>}}};

/// What a ball meets.
struct Contact {
  Kind kind;
  Transition transition;
  double D;
  double share = 0.0; ///< suction over the largest force of an undamped impact without it

  /// Largest overlap of an impact without dashpot and suction, from its energy.
  [[nodiscard]] double deepest(double speed = 1.0) const {
    return std::pow(0.5 * (kind.p + 1.0) * speed * speed, 1.0 / (kind.p + 1.0));
  }
  /// Duration of the same impact: deepest/speed times twice the integral of (1 - s^(p + 1))^(-1/2), 0 to 1.
  [[nodiscard]] double duration(double speed = 1.0) const {
    return (kind.p > 1.0 ? 2.9432675 : pi) * deepest(speed) / speed;
  }
  /// Of the dashpot.
  [[nodiscard]] double c() const { return 2.0 * D * std::sqrt(0.5 * (kind.p + 1.0) * kind.ratio); }
  [[nodiscard]] double suction() const { return share * std::pow(deepest(), kind.p); }
};

/// The motion by CVODE, started again wherever the force changes its formula.
class Exact {
public:
  /// \param d, rate overlap and its rate at time 0 \param push of other forces, towards the partner
  Exact(const Contact &contact, double d, double rate, std::function<double(double)> push = nullptr)
      : contact_(contact), touches_(d >= 0.0), push_(std::move(push)),
        motion_([this](double t, const oracle::State &y, oracle::State &f) { rates(t, y, f); }, 0.0,
                {d, rate, 0.0}, {std::fabs(rate) + 1e-3, std::fabs(rate) + 1e-3, 1.0}) {}

  void go_to(double end) {
    while (motion_.time() < end) {
      const int event = motion_.advance(end, events_);
      if (event < 0) return;
      change(event);
      motion_.restart(motion_.state());
    }
  }
  [[nodiscard]] double overlap() const { return motion_.state()[0]; }
  [[nodiscard]] double rate() const { return motion_.state()[1]; }
  /// Of the dashpot and of yielding, since the beginning.
  [[nodiscard]] double heat() const {
    return motion_.state()[2] + yielded_before_ + loss(line_ == loading && touches_ ? overlap() : largest_);
  }

  struct {
    double time = INFINITY, overlap = 0.0, rate = 0.0;
  } broke;                      ///< the first break
  int makes = 0;                ///< begins of a force
  int makes_while_touching = 0; ///< of these, while the balls still overlapped

private:
  [[nodiscard]] double loss(double d) const { return 0.5 * (1.0 - 1.0 / contact_.kind.ratio) * d * d; }
  [[nodiscard]] double plastic() const { return (1.0 - 1.0 / contact_.kind.ratio) * largest_; }
  /// Force of the spring, or with the exponent p - q that over the dashpot's d^q.
  [[nodiscard]] double spring(double d, double exponent) const {
    if (line_ == loading) return std::pow(std::max(d, 0.0), exponent);
    return line_ == unloading ? contact_.kind.ratio * (d - plastic()) : 0.0;
  }
  void rates(double t, const oracle::State &y, oracle::State &f) const {
    const double elastic = std::max(0.0, spring(y[0], contact_.kind.p));
    const double dashpot =
        released_ ? -elastic : contact_.c() * std::pow(std::max(y[0], 0.0), contact_.kind.q) * y[1];
    f[0] = y[1];
    f[1] = (push_ ? push_(t) : 0.0) - (touches_ ? elastic + dashpot - contact_.suction() : 0.0);
    f[2] = touches_ ? dashpot * y[1] : 0.0;
  }
  void change(int event) {
    const bool lets_go = contact_.share > 0.0 ? event == touch : !released_ && event <= balance;
    if (touches_ && lets_go && broke.time == INFINITY) broke = {motion_.time(), overlap(), rate()};
    if (event == touch) {
      yielded_before_ += loss(largest_);
      largest_ = 0.0;
      line_ = loading;
      touches_ = !touches_;
      released_ = false;
      makes += touches_ ? 1 : 0;
    } else if (event == balance) {
      released_ = !released_;
      makes += released_ ? 0 : 1;
      makes_while_touching += released_ ? 0 : 1;
    } else if (event == rest) {
      line_ = unloading;
      largest_ = overlap();
    } else if (event == reloaded) {
      line_ = loading;
    } else {
      line_ = rate() > 0.0 ? unloading : loose;
    }
  }

  const Contact contact_;
  bool touches_;
  bool released_ = false; ///< under B, where spring and dashpot would pull
  enum { loading, unloading, loose } line_ = loading;
  double largest_ = 0.0, yielded_before_ = 0.0;
  const std::function<double(double)> push_;
  oracle::Ode motion_;
  enum { touch, balance, rest, reloaded, at_plastic };
  /// In this order; 1 while an event cannot happen.
  const std::vector<oracle::Event> events_{
      [](double, const oracle::State &y) { return y[0]; },
      [this](double, const oracle::State &y) {
        const bool pushes_to_the_end = contact_.D == 0.0 && contact_.kind.ratio == 1.0;
        if (!touches_ || contact_.transition == Transition::A || pushes_to_the_end) return 1.0;
        return spring(y[0], contact_.kind.p - contact_.kind.q) + contact_.c() * y[1];
      },
      [this](double, const oracle::State &y) {
        return touches_ && contact_.kind.ratio > 1.0 && line_ == loading ? y[1] : 1.0;
      },
      [this](double, const oracle::State &y) { return line_ == unloading ? largest_ - y[0] : 1.0; },
      [this](double, const oracle::State &y) { return line_ != loading ? y[0] - plastic() : 1.0; }};
};

template <class Run>
void with_law(const Contact &contact, const Run &run) {
  std::visit(run, contact.kind.law(contact.transition, contact.D));
}
template <class Law>
verlet::Ball<Law> thrown(const Contact &contact, const Law &law, double gap, double speed, double dt,
                         Scheme scheme) {
  return {1.0, gap, -speed, dt, {{0.0, 1.0, law, contact.suction()}}, 0.0, scheme};
}

/// Largest errors of an impact over places of the make and of the break in their steps.
struct Errors {
  double motion = 0.0;  ///< of overlap and rate some time after the impact
  double heat = 0.0;    ///< of what has become heat
  double balance = 0.0; ///< of the sum of energy and heat
  double make = 0.0;    ///< of its time
  double ending = 0.0;  ///< of time, overlap and force of the break
  double rate = 0.0;    ///< of the rate there
  int breaks = 0;
};

void judge(const ContactTransition &event, const Contact &contact, double begin, double touch,
           const Exact &exact, Errors &errors) {
  const double jump = contact.kind.q == 0.0 ? contact.c() : 0.0; // of the dashpot at d = 0
  if (event.make) {
    EXPECT_NEAR(event.force, jump - contact.suction(), 1e-12 * (1.0 + jump));
    errors.make = std::max(errors.make, std::fabs(begin + event.since - touch));
    return;
  }
  ++errors.breaks;
  errors.rate = std::max(errors.rate, std::fabs(event.rate - exact.broke.rate));
  const double pull = contact.transition == Transition::A ? jump * exact.broke.rate : 0.0;
  errors.ending = std::max({errors.ending, std::fabs(begin + event.since - touch - exact.broke.time),
                            std::fabs(event.overlap - exact.broke.overlap),
                            std::fabs(event.force - (pull - contact.suction()))});
}

/// Of impacts at speed 1. \param exact the reference solution at `end`, a while after the touch
Errors errors_of(const Contact &contact, const Exact &exact, double end, int steps, Scheme scheme) {
  Errors errors;
  for (const int all : {steps, steps * 103 / 100, steps * 107 / 100, steps * 112 / 100}) // place of the break
    for (const double onset : {0.1, 0.3, 0.5, 0.7, 0.9}) { // share of the first step before the touch
      const double dt = end / (all - onset), touch = onset * dt;
      with_law(contact, [&](const auto &fresh) {
        auto ball = thrown(contact, fresh, touch, 1.0, dt, scheme);
        for (int step = 0; step < all; ++step) {
          const OverlapState before{-ball.x, -ball.v};
          const auto law = ball.partner().law;
          ball.step();
          if (const auto event = locate_transition(law, dt, before, {-ball.x, -ball.v}, contact.suction()))
            judge(*event, contact, step * dt, touch, exact, errors);
        }
        errors.motion =
            std::max({errors.motion, std::fabs(ball.x + exact.overlap()), std::fabs(ball.v + exact.rate())});
        errors.heat = std::max(errors.heat, std::fabs(ball.heat - exact.heat()));
        errors.balance = std::max(errors.balance, std::fabs(ball.energy() + ball.heat - 0.5));
      });
    }
  return errors;
}

/// Of errors of some steps and of four times as many. \param small error that may have any order
void expect_order(double order, double coarse, double fine, const char *what, double small = 1e-10) {
  EXPECT_LT(fine, std::max(coarse / std::pow(4.0, order), small)) << what << ": " << coarse << ", " << fine;
}

class Impact : public testing::TestWithParam<std::tuple<std::size_t, Transition>> {
protected:
  Kind kind = kinds.at(std::get<0>(GetParam()));
  Transition transition = std::get<1>(GetParam());

  /// Calls run(contact, errors of 100 steps in a contact, errors of 400) for contacts with and without
  /// suction. Under A with D >= 1 the contact of a ball that has come never ends.
  template <class Run>
  void for_contacts(const std::vector<double> &ratios, Scheme scheme, const Run &run) const {
    for (const double D : ratios)
      for (const double share : {0.0, 0.1, 1.0}) {
        if (transition == Transition::A && D >= 1.0) continue;
        SCOPED_TRACE(testing::Message() << "D " << D << ", suction " << share);
        const Contact contact{kind, transition, D, share};
        const double end = 3.3 * contact.duration();
        Exact exact(contact, 0.0, 1.0);
        exact.go_to(end);
        run(contact, errors_of(contact, exact, end, 330, scheme),
            errors_of(contact, exact, end, 1320, scheme));
      }
  }
};

TEST(Kinds, HaveARowForEveryLaw) {
  std::set<std::size_t> laws;
  for (const Kind &kind : kinds)
    laws.insert(kind.law(Transition::B, 0.1).index());
  EXPECT_EQ(laws.size(), std::variant_size_v<AnyLaw>);
}

TEST_P(Impact, HasTheRestitutionOfTheClosedFormAtAnySpeed) {
  for (const double D : {0.0, 0.05, 0.3, 0.8, 1.0, 2.0, 10.0})
    for (const double speed : {0.01, 30.0}) {
      const Contact contact{kind, transition, D};
      Exact exact(contact, 0.0, speed);
      exact.go_to(20.0 * contact.duration(speed));
      EXPECT_NEAR(exact.broke.rate / speed, -kind.restitution(transition, D), 1e-6) << D << ' ' << speed;
    }
}

TEST_P(Impact, ErrsWithTheSquareOfTheStep) {
  for_contacts({0.0, 0.05, 0.3, 0.8, 2.0, 10.0}, Scheme::second,
               [&](const Contact &contact, const Errors &coarse, const Errors &fine) {
                 EXPECT_LT(coarse.motion, contact.share > 0.0 ? 5.0 * kind.bound : kind.bound);
                 EXPECT_LT(coarse.heat, 2e-3);
                 EXPECT_LT(coarse.balance, 3e-4);
                 EXPECT_LT(coarse.ending, 7e-3 * (1.0 + contact.D));
                 EXPECT_LT(fine.rate, 1e-3);
                 EXPECT_LT(fine.make, 1e-14);
                 expect_order(1.5, coarse.motion, fine.motion, "motion");
                 expect_order(1.5, coarse.heat, fine.heat, "heat");
                 expect_order(1.5, coarse.balance, fine.balance, "balance");
                 expect_order(1.5, coarse.ending, fine.ending, "break");
                 EXPECT_EQ(fine.breaks % 20, 0); // it sticks or leaves, wherever the steps are
                 if (contact.share == 0.0 && kind.restitution(transition, contact.D) > 0.0) {
                   EXPECT_EQ(fine.breaks, 20);
                 }
               });
}

TEST_P(Impact, ErrsInFirstOrderByTheSchemeOfTheEngine) {
  for_contacts({0.0, 0.05, 0.3, 2.0}, Scheme::stock,
               [](const Contact &, const Errors &coarse, const Errors &fine) {
                 EXPECT_LT(coarse.motion, 0.25);
                 expect_order(0.65, coarse.motion, fine.motion, "motion", 5e-3);
                 expect_order(0.65, coarse.balance, fine.balance, "balance");
               });
}

/// Restitution, by few steps. \param onset share of the first step before the touch
double rebound(const Contact &contact, double steps, double onset, Scheme scheme, double speed = 1.0) {
  const double dt = contact.duration(speed) / steps;
  double e = 0.0;
  with_law(contact, [&](const auto &law) {
    auto ball = thrown(contact, law, onset * dt * speed, speed, dt, scheme);
    double left = 1000.0 * steps;
    do
      ball.step();
    while (ball.x <= 0.0 && left-- > 0.0);
    e = ball.v / speed;
  });
  return e;
}

/// Largest error over places of the make in its step.
double worst_rebound(const Contact &contact, double steps, Scheme scheme) {
  double worst = 0.0;
  for (int n = 0; n < 20; ++n)
    worst = std::max(worst, std::fabs(rebound(contact, steps, (n + 0.5) / 20.0, scheme) -
                                      contact.kind.restitution(contact.transition, contact.D)));
  return worst;
}

// The weights of a make and of a break belong to the dashpot alone: given to the spring, too, they let weakly
// damped impacts gain energy. Where a contact yields, most of the error is that of the kink at the largest
// overlap, with both schemes.
TEST(FewSteps, ErrLessThanWithTheSchemeOfTheEngineAtAnyDamping) {
  for (const Kind &kind : kinds)
    for (const Transition transition : {Transition::A, Transition::B})
      for (double D = 5e-4; D < (transition == Transition::A ? 0.85 : 4.0) && kind.ratio == 1.0; D *= 1.5)
        for (const double steps : {10.0, 12.5, 16.5, 20.0, 25.0, 36.0, 40.0}) {
          const Contact contact{kind, transition, D};
          EXPECT_LT(worst_rebound(contact, steps, Scheme::second),
                    1.1 * worst_rebound(contact, steps, Scheme::stock))
              << kind.name << ' ' << D << ' ' << steps;
        }
}

TEST_P(Impact, IsThatOfTheEngineWithoutDashpot) {
  for (const double steps : {4.0, 7.3, 10.0, 23.0, 40.0})
    for (int n = 0; n < 20; ++n) {
      const Contact contact{kind, transition, 0.0};
      const double onset = (n + 0.5) / 20.0;
      EXPECT_EQ(rebound(contact, steps, onset, Scheme::second),
                rebound(contact, steps, onset, Scheme::stock));
    }
}

TEST_P(Impact, ErrsAlikeAtAnySpeed) {
  for (const double D : {0.05, 0.3})
    for (const double speed : {0.01, 100.0}) {
      const Contact contact{kind, transition, D};
      if (kind.restitution(transition, D) == 0.0) continue; // it never leaves
      EXPECT_NEAR(rebound(contact, 50.0, 0.3, Scheme::second, speed),
                  rebound(contact, 50.0, 0.3, Scheme::second), 1e-9)
          << speed;
    }
}

// A dashpot that pulls until d = 0 and hardly slows the ball: v = 1 - c t until then, to first order in c.
TEST(Break, OfAConstantPullHasPlaceAndSpeedOfItsEquation) {
  const double c = 1e-4, dt = 0.1, end = 6.0 * dt;
  for (const double share : {0.1, 0.5, 0.9}) { // of the fourth step
    const double pulled = (3.0 + share) * dt;
    verlet::Ball<LinearLaw> ball(1.0, -pulled, 1.0, dt, {{0.0, 1.0, {1e-12, c, Transition::A}}});
    for (int step = 0; step < 6; ++step)
      ball.step();
    EXPECT_NEAR(ball.v, 1.0 - c * pulled, 1e-8) << share;
    EXPECT_NEAR(ball.x, end - pulled - c * pulled * (end - 0.5 * pulled), 1e-8) << share;
  }
}

/// A weight and a force that changes as a sine: the ball hammers on its partner. Contacts open and, where
/// they yield, forget; under B some lose their force and are made again while the balls overlap.
struct Drive {
  double frequency, D, share;
  [[nodiscard]] double operator()(double t) const { return 1.0 + 3.0 * std::sin(frequency * t); }
};
struct Driven {
  double x = 0.0, v = 0.0, heat = 0.0; ///< errors
  int makes = 0;
};

template <class Law>
Driven errors_of_drive(const Contact &contact, const Law &law, const Drive &drive, const Exact &exact,
                       double end, int steps) {
  const double dt = end / steps;
  verlet::Ball<Law> ball(1.0, 0.5, 0.0, dt, {{0.0, 1.0, law, contact.suction()}}, -drive(0.0));
  Driven found;
  bool acted = false;
  for (int n = 1; n <= steps; ++n) {
    ball.constant = -drive(n * dt);
    ball.step();
    const bool acts = ball.partner().law.acts(-ball.x, -ball.v);
    found.makes += acts && !acted ? 1 : 0;
    acted = acts;
  }
  found.x = std::fabs(ball.x + exact.overlap());
  found.v = std::fabs(ball.v + exact.rate());
  found.heat = std::fabs(ball.heat - exact.heat());
  return found;
}

TEST_P(Impact, FollowsADriveWithSecondOrder) {
  int makes_while_touching = 0;
  for (const Drive &drive : {Drive{0.7, 0.0, 0.0}, Drive{0.7, 0.3, 0.1}, Drive{1.8, 0.3, 0.0}}) {
    SCOPED_TRACE(drive.frequency + drive.D);
    constexpr double end = 90.0;
    const Contact contact{kind, transition, drive.D, drive.share};
    Exact exact(contact, -0.5, 0.0, drive);
    exact.go_to(end);
    makes_while_touching += exact.makes_while_touching;
    // Means over steps of nearly one length: the error of one run depends on where makes are in their steps.
    const auto mean = [&](int least) {
      constexpr int runs = 5;
      Driven sum;
      for (int n = 0; n < runs; ++n)
        with_law(contact, [&](const auto &law) {
          const Driven one = errors_of_drive(contact, law, drive, exact, end, least + least / 300 * n);
          sum.x += one.x / runs;
          sum.v += one.v / runs;
          sum.heat += one.heat / runs;
          sum.makes += one.makes;
        });
      return sum;
    };
    const Driven coarse = mean(5000), fine = mean(20000);
    EXPECT_EQ(fine.makes, 5 * exact.makes);
    expect_order(1.5, coarse.x, fine.x, "place");
    expect_order(1.5, coarse.v, fine.v, "velocity");
    expect_order(1.5, coarse.heat, fine.heat, "heat");
    EXPECT_LT(fine.x, 5e-2);
    EXPECT_LT(fine.heat, 2e-2);
  }
  EXPECT_EQ(makes_while_touching > 0, transition == Transition::B && kind.p == 1.0);
}

INSTANTIATE_TEST_SUITE_P(, Impact,
                         testing::Combine(testing::Range(std::size_t{0}, kinds.size()),
                                          testing::Values(Transition::A, Transition::B)),
                         [](const auto &row) {
                           return std::string(kinds.at(std::get<0>(row.param)).name) +
                                  (std::get<1>(row.param) == Transition::A ? "_A" : "_B");
                         });

// The values that the project's reference lists, computed there by other means.
TEST(Restitution, HoldsTheListedValues) {
  EXPECT_NEAR(restitution(Transition::A, 0.2), 0.526621, 5e-7);
  EXPECT_NEAR(restitution(Transition::A, 0.5), 0.163034, 5e-7);
  EXPECT_NEAR(restitution(Transition::A, 0.8), 0.015165, 5e-7);
  EXPECT_NEAR(restitution(Transition::B, 0.2), 0.571740, 5e-7);
  EXPECT_NEAR(restitution(Transition::B, 0.5), 0.298436, 5e-7);
  EXPECT_NEAR(restitution(Transition::B, 0.8), 0.179783, 5e-7);
  EXPECT_NEAR(restitution(Transition::B, 2.0), 0.047769, 5e-7);
}

TEST(Restitution, FallsWithDAndDoesNotJumpAtCriticalDamping) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (int n = 0; n < 99; ++n)
      EXPECT_GT(restitution(transition, 0.01 * n), restitution(transition, 0.01 * (n + 1))) << n;
  EXPECT_NEAR(restitution(Transition::B, 1.0), restitution(Transition::B, 1.0 - 1e-6), 1e-6);
  EXPECT_NEAR(restitution(Transition::B, 1.0), restitution(Transition::B, 1.0 + 1e-6), 1e-6);
  EXPECT_NEAR(restitution(Transition::B, 1e4) * 4e8, 1.0, 1e-6); // 1 / (4 D^2)
}

TEST(Restitution, OfALawThatYieldsIsTheLinearOneWhereUnloadingIsNotStiffer) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double D : {0.0, 0.1, 0.7, 1.0, 3.0})
      EXPECT_NEAR(restitution_of_yield(transition, D, 1.0), restitution(transition, D), 1e-12) << D;
}

TEST(Restitution, GivesTheDampingThatHasIt) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double share : {1.0, 0.999, 0.7, 0.3, 0.05, 1e-4}) {
      EXPECT_NEAR(restitution(transition, damping_ratio_of_restitution(transition, share)), share,
                  1e-14 + 1e-12 * share);
      for (const double ratio : {1.0, 2.0, 9.0}) {
        YieldContact contact{1.0, ratio, 0.0, Damping::ratio, transition};
        const double e = share * contact.largest_restitution();
        contact.set_restitution(e);
        EXPECT_NEAR(restitution_of_yield(transition, contact.damping, ratio), e, 1e-12) << ratio << ' ' << e;
      }
    }
  EXPECT_EQ(damping_ratio_of_restitution(Transition::A, 1.0), 0.0);
  EXPECT_EQ(damping_ratio_of_restitution(Transition::B, 1.0), 0.0);
}

} // namespace
