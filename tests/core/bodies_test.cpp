// What acts on whole bodies (plugin/physics/bodies): bond, tilting body, travel, exciter, absorbing boundary.
#include "tests/support/ode.h"
#include "tests/support/oscillator.h"
#include "physics/bodies/absorbing_boundary.h"
#include "physics/bodies/bond_law.h"
#include "physics/bodies/excitation.h"
#include "physics/bodies/tilting_body.h"
#include "physics/bodies/travel.h"

namespace {

using namespace drumlin::physics;

// The bond against the damped oscillator, in closed form and by CVODE.
namespace bond {

constexpr double m = 1000.0, k = 1e6;

TEST(BondLaw, AcceleratesAMassAsTheClosedFormDoes) {
  for (const double ratio : {0.0, 0.16, 0.7, 1.5, 20.0}) {
    const Bond bond{k, 2.0 * ratio * std::sqrt(m * k), 0.75};
    const oracle::Oscillator closed{m, k, bond.damping};
    for (int i = 0; i <= 300; ++i) {
      const oracle::Motion now = closed.at(1e-3 * i, 0.02, -0.5);
      const double scale = 1e-11 * (k * 0.02 + bond.damping * 0.5);
      ASSERT_NEAR(bond_force(bond, 0.75 + now.x, now.v).force, -m * now.a, scale) << "D " << ratio;
    }
  }
}

/// A mass on the bond's other end, fourth order steps on the core's law.
std::pair<double, double> hung(const Bond &bond, double e, double v, double t) {
  const int steps = 20000;
  const double dt = t / steps;
  const auto a = [&](double x, double u) { return -bond_force(bond, bond.length + x, u).force / m; };
  for (int n = 0; n < steps; ++n) {
    const double v1 = v, a1 = a(e, v1);
    const double v2 = v + 0.5 * dt * a1, a2 = a(e + 0.5 * dt * v1, v2);
    const double v3 = v + 0.5 * dt * a2, a3 = a(e + 0.5 * dt * v2, v3);
    const double v4 = v + dt * a3, a4 = a(e + dt * v3, v4);
    e += dt / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
    v += dt / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
  return {e, v};
}

TEST(BondLaw, SwingsAsTheClosedFormAndCvode) {
  const double w0 = std::sqrt(k / m);
  for (const double ratio : {0.16, 1.0, 4.0})
    for (const double t : {0.02, 0.2}) {
      const Bond bond{k, 2.0 * ratio * std::sqrt(m * k), 0.75};
      const auto [e, v] = hung(bond, 0.02, -0.5, t);
      if (ratio == 1.0) { // the double root: e = (e0 + (v0 + w0 e0) t) exp(-w0 t)
        const double slope = -0.5 + w0 * 0.02;
        EXPECT_NEAR(e, (0.02 + slope * t) * std::exp(-w0 * t), 1e-12);
        EXPECT_NEAR(v, (slope - w0 * (0.02 + slope * t)) * std::exp(-w0 * t), 1e-10);
      } else {
        const oracle::Motion closed = oracle::Oscillator{m, k, bond.damping}.at(t, 0.02, -0.5);
        EXPECT_NEAR(e, closed.x, 1e-12);
        EXPECT_NEAR(v, closed.v, 1e-10);
      }
      oracle::Ode exact(
          [&](double, const oracle::State &y, oracle::State &f) {
            f[0] = y[1];
            f[1] = -(k * y[0] + bond.damping * y[1]) / m;
          },
          0.0, {0.02, -0.5}, {0.02, 0.5});
      exact.advance(t);
      EXPECT_NEAR(e, exact.state()[0], 1e-10);
      EXPECT_NEAR(v, exact.state()[1], 1e-8);
    }
}

TEST(BondLaw, PullsWhenLongAndPushesWhenShort) {
  const Bond bond{k, 1e4, 0.75};
  EXPECT_NEAR(bond_force(bond, 0.76, 0.0).force, 1e4, 1e-6);
  EXPECT_NEAR(bond_force(bond, 0.74, 0.0).force, -1e4, 1e-6);
  EXPECT_EQ(bond_force(bond, 0.75, 0.2).force, 2e3);
  EXPECT_EQ(bond_force(bond, 0.75, 0.0).force, 0.0);
}

TEST(BondLaw, SplitsThePowerIntoSpringAndDashpot) {
  const Bond bond{k, 1e4, 0.75};
  std::mt19937 random(611953);
  std::uniform_real_distribution<double> stretch(-0.05, 0.05), rate(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const double e = stretch(random), r = rate(random), h = 1e-6;
    const BondForce now = bond_force(bond, 0.75 + e, r);
    const double stored_rate =
        (bond_force(bond, 0.75 + e + r * h, r).stored - bond_force(bond, 0.75 + e - r * h, r).stored) /
        (2.0 * h);
    ASSERT_GE(now.dissipated, 0.0);
    ASSERT_GE(now.stored, 0.0);
    ASSERT_NEAR(now.force * r, stored_rate + now.dissipated, 1e-3);
  }
}

TEST(BondLaw, BreaksBeyondItsStrengthInTensionAndInCompression) {
  const Bond bond{k, 0.0, 0.75, 1e4};
  EXPECT_FALSE(bond_force(bond, 0.75 + 0.00999, 0.0).breaks);
  EXPECT_TRUE(bond_force(bond, 0.75 + 0.01001, 0.0).breaks);
  EXPECT_FALSE(bond_force(bond, 0.75 - 0.00999, 0.0).breaks);
  EXPECT_TRUE(bond_force(bond, 0.75 - 0.01001, 0.0).breaks);
  const Bond damped{k, 1e4, 0.75, 1e4};
  EXPECT_TRUE(bond_force(damped, 0.75, 1.01).breaks); // the dashpot's force counts
  EXPECT_FALSE(bond_force(Bond{k, 0.0, 0.75}, 1e9, 0.0).breaks);
}

} // namespace bond

// A body that tilts: its shares of force and moment against Newton's and Euler's laws, and its energy.
namespace tilt {

struct Ball {
  double mass;
  Vec3 x, v, f;
};

/// Balls on an axle along (0.6, 0.8, 0), tilted, each with a force of its own, that move as one body.
struct Body {
  TiltAxes axes{{0.8, -0.6, 0.0}, {0.6, 0.8, 0.0}};
  std::vector<Ball> balls;
  Vec3 speed{0.3, -0.2, 0.5};
  double rate = 0.4, tilt = 0.02;
  double mass = 0.0, centre = 0.0, inertia = 0.0;

  explicit Body(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int n = 0; n < 7; ++n) {
      Ball ball{1.5 + number(random), scaled(3.0 + number(random), axes.axle), {}, {}};
      ball.x = sum(ball.x, number(random), axes.axis);
      ball.f = {number(random), number(random), number(random)};
      balls.push_back(ball);
      mass += ball.mass;
      centre += ball.mass * dot(ball.x, axes.axle);
    }
    centre /= mass;
    for (Ball &ball : balls) {
      const double s = dot(ball.x, axes.axle) - centre;
      inertia += ball.mass * s * s;
      ball.x = sum(ball.x, 2.0 + tilt * s, axes.rise);
      ball.v = sum(speed, rate * s, axes.rise);
    }
  }
  AxleSums sums() const {
    AxleSums all;
    for (const Ball &ball : balls)
      all.add(axes, ball.mass, ball.x, ball.v, ball.f);
    return all;
  }
};

TEST(TiltingBody, HasMassInertiaAndMotionOfItsBalls) {
  for (unsigned seed = 1; seed < 50; ++seed) {
    const Body body(seed);
    const AxleSums sums = body.sums();
    EXPECT_NEAR(dot(body.axes.rise, Vec3{0, 0, 1}), 1, 1e-15) << "axis x axle points upwards";
    EXPECT_NEAR(sums.mass(), body.mass, 1e-13);
    EXPECT_NEAR(sums.centre(), body.centre, 1e-13);
    EXPECT_NEAR(sums.inertia(), body.inertia, 1e-12);
    EXPECT_NEAR(sums.height(), 2, 1e-13);
    EXPECT_NEAR(sums.tilt(), body.tilt, 1e-12);
    EXPECT_NEAR(sums.rate(), body.rate, 1e-12);
    double kinetic = 0;
    for (const Ball &ball : body.balls)
      kinetic += 0.5 * ball.mass * dot(ball.v, ball.v);
    EXPECT_NEAR(kinetic,
                0.5 * body.mass * dot(body.speed, body.speed) + 0.5 * body.inertia * body.rate * body.rate,
                1e-12);
  }
}

// Force and moment on the rigid drum are distributed over the balls on its axle. The forces on the balls must
// have the same sum, moment and power as those on the drum, and must keep the axle rigid: the acceleration
// then changes linearly along it. Only one distribution does both.
TEST(TiltingBody, SharesOutForceAndMoment) {
  for (unsigned seed = 1; seed < 50; ++seed) {
    Body body(seed);
    const AxleSums sums = body.sums();
    Vec3 force{};
    double moment = 0, work = 0;
    for (const Ball &ball : body.balls) {
      force = sum(force, 1, ball.f);
      moment += (dot(ball.x, body.axes.axle) - body.centre) * dot(ball.f, body.axes.rise);
      work += dot(ball.f, ball.v);
    }
    EXPECT_NEAR(sums.moment(), moment, 1e-12);
    std::vector<Vec3> accelerations;
    std::vector<double> places;
    double shared_work = 0;
    for (Ball &ball : body.balls) {
      const double s = dot(ball.x, body.axes.axle);
      ball.f = sums.share(body.axes, ball.mass, s, sums.force(), sums.moment());
      accelerations.push_back(scaled(1 / ball.mass, ball.f));
      places.push_back(s);
      shared_work += dot(ball.f, ball.v);
    }
    EXPECT_NEAR(shared_work, work, 1e-12);
    const Vec3 slope = scaled(1 / (places[1] - places[0]), sum(accelerations[1], -1, accelerations[0]));
    EXPECT_NEAR(dot(slope, body.axes.axle), 0, 1e-12);
    EXPECT_NEAR(dot(slope, body.axes.axis), 0, 1e-12);
    for (std::size_t n = 2; n < places.size(); ++n) {
      const Vec3 on_line = sum(accelerations[0], places[n] - places[0], slope);
      for (std::size_t a = 0; a < 3; ++a)
        EXPECT_NEAR(accelerations[n][a], on_line[a], 1e-11);
    }
    const AxleSums again = body.sums();
    EXPECT_NEAR(again.moment(), moment, 1e-12);
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_NEAR(again.force()[a], force[a], 1e-12);
  }
}

} // namespace tilt

// The programme of a roller that drives: its place against the integral of its speed, and closed forms.
namespace travels {

Travel programme() {
  Travel t;
  t.from = -1.0;
  t.to = 2.0;
  t.speed = 1.5;
  t.ramp = 0.4;
  t.pause = 0.3;
  t.passes = 3;
  return t;
}

/// Of the page: from the start of a pass.
double speed_in_pass(const Travel &t, double since) {
  const double left = t.pass_time() - since;
  if (since < 0.0 || left < 0.0) return 0.0;
  const double u = std::fmin(1.0, std::fmin(since, left) / t.ramp);
  return t.speed * (3.0 * u * u - 2.0 * u * u * u);
}

TEST(Travel, IsTheIntegralOfItsSpeed) {
  for (const bool one_way : {false, true})
    for (const double sign : {1.0, -1.0}) {
      Travel t = programme();
      t.one_way = one_way;
      if (sign < 0.0) std::swap(t.from, t.to);
      EXPECT_NEAR(t.duration(), 3 * (3.0 / 1.5 + 0.4) + 2 * 0.3, 1e-14);
      double distance = 0.0;
      constexpr int steps = 90000;
      const double h = (t.duration() + 0.5) / steps;
      const auto velocity = [&](double time) {
        double all = 0.0;
        for (int pass = 0; pass < 3; ++pass)
          all += (one_way || pass % 2 == 0 ? sign : -sign) *
                 speed_in_pass(t, time - pass * (t.pass_time() + t.pause));
        return all;
      };
      for (int n = 0; n <= steps; ++n) {
        const double time = n * h;
        const TravelState now = travel_state(t, time);
        ASSERT_NEAR(now.velocity, velocity(time), 1e-9) << time;
        ASSERT_NEAR(now.distance, distance, 1e-9) << time;
        const double place =
            one_way ? std::fabs(now.distance) - 3.0 * (now.pass - 1) : std::fabs(now.distance);
        ASSERT_NEAR(now.place, t.from + sign * place, 1e-9) << time;
        ASSERT_EQ(now.pass, std::min(3, 1 + static_cast<int>(time / (t.pass_time() + t.pause)))) << time;
        const double slope = (velocity(time + 1e-6) - velocity(time - 1e-6)) / 2e-6;
        ASSERT_NEAR(now.acceleration, slope, 1e-4) << time;
        const TravelState next = travel_state(t, time + h);
        EXPECT_NEAR(mean_velocity(t, time, time + h, now, next) * h, next.distance - now.distance, 1e-12);
        distance += h / 6 * (velocity(time) + 4 * velocity(time + h / 2) + velocity(time + h));
      }
    }
}

TEST(Travel, TurnsAtOnceWithoutRampsAndPauses) {
  Travel t;
  t.to = 3.0;
  t.speed = 0.7;
  t.passes = 1000;
  for (int n = 0; n < 100000; ++n) {
    const double time = t.duration() * n / 100000.0; // a turn at every hundredth
    const TravelState now = travel_state(t, time);
    ASSERT_EQ(std::fabs(now.velocity), 0.7) << time;
    const double way = std::fmod(0.7 * time, 6.0);
    ASSERT_NEAR(now.place, way < 3.0 ? way : 6.0 - way, 1e-9) << time;
  }
  const TravelState last = travel_state(t, t.duration());
  EXPECT_EQ(last.velocity, -0.7) << "it drives until then";
  EXPECT_NEAR(last.place, 0.0, 1e-9);
  for (int n = 1; n <= 1000; ++n) // times that rounding moves about a turn
    for (const double ulps : {-2.0, -1.0, 0.0, 1.0, 2.0}) {
      const double turn = n * (3.0 / 0.7);
      ASSERT_EQ(std::fabs(travel_state(t, turn + ulps * 1e-16 * turn).velocity), 0.7) << n;
    }
  const TravelState end = travel_state(t, t.duration() + 1.0);
  EXPECT_EQ(end.velocity, 0.0);
  EXPECT_EQ(end.pass, 1000);
  EXPECT_EQ(end.place, 0.0);
}

TEST(Travel, StaysOnAWayThatItsRampsFill) {
  Travel t = programme();
  t.ramp = t.length() / t.speed;
  EXPECT_EQ(t.invalid(), "");
  const TravelState middle = travel_state(t, t.ramp);
  EXPECT_NEAR(middle.velocity, t.speed, 1e-12);
  EXPECT_NEAR(middle.place, 0.5, 1e-12);
  t.ramp *= 1.001;
  EXPECT_EQ(t.invalid().rfind("way is '3 m' long; allowed: more than 0, and at least 3.00", 0), 0u)
      << t.invalid();
}

// A drum of the radius 0.5 m rolls from 0 on: a ball 0.4 m from the axle, at first above it, is where the
// cycloid has it.
TEST(Travel, RollsABallOnACycloid) {
  const InPlane top{0.0, 0.4};
  for (double way = 0.0; way < 10.0; way += 0.37) {
    const double angle = way / 0.5, spin = 3.0 / 0.5;
    const InPlane place = Turn(angle)(top), v = turning_velocity(spin, place);
    EXPECT_NEAR(place.along, 0.4 * std::sin(angle), 1e-15);
    EXPECT_NEAR(place.up, 0.4 * std::cos(angle), 1e-15);
    EXPECT_NEAR(v.along, 0.4 * spin * std::cos(angle), 1e-14);
    EXPECT_NEAR(v.up, -0.4 * spin * std::sin(angle), 1e-14);
  }
}

// The mean velocity of a step leads from the place at its beginning to that at its end, however long it is.
TEST(Travel, LeadsABallOfADrumAlongTheChord) {
  const InPlane ball{0.3, -0.2};
  for (const double change : {-2.0, -1e-3, 0.0, 1e-6, 0.1, 3.0})
    for (const double begin : {0.0, 1.0, -4.0}) {
      const double time = 0.01;
      const InPlane from = Turn(begin)(ball), to = Turn(begin + change)(ball);
      const InPlane mean = turning_velocity(spin_of_chord(change, time), Turn(begin + 0.5 * change)(ball));
      EXPECT_NEAR(to.along - from.along, time * mean.along, 1e-15);
      EXPECT_NEAR(to.up - from.up, time * mean.up, 1e-15);
    }
}

} // namespace travels

// The exciter against the turning of its rotor, by CVODE, and closed forms.
namespace exciter {

constexpr double pi = 3.14159265358979323846;

Excitation directed() {
  Excitation e;
  e.amplitude = 58.8e3;
  e.angular_frequency = 40.0 * pi;
  return e;
}

Excitation swept() {
  Excitation e = directed();
  e.phase = 0.3;
  e.start = 0.25;
  e.sweep_frequency = 80.0 * pi;
  e.sweep_duration = 1.5;
  return e;
}

TEST(Excitation, IsThePapersForce) { // Fe = Fw sin(w t), Eq. (1)
  for (int i = 0; i <= 50; ++i) {
    // quarter periods, where the sine is 0, 1, 0, -1
    const double expected = i % 2 == 0 ? 0.0 : (i % 4 == 1 ? 58.8e3 : -58.8e3);
    EXPECT_NEAR(excitation_force(directed(), i * 0.0125), expected, 1e-8);
  }
  EXPECT_GT(excitation_force(directed(), 1e-3), 0.0); // it begins by pushing the drum down
}

TEST(Excitation, TurnsByTheIntegralOfItsFrequency) {
  for (const double target : {80.0 * pi, 0.0, 20.0 * pi}) {
    Excitation e = swept();
    e.sweep_frequency = target;
    // An ODE solver turns the eccentric mass with the frequency that the user asked for: it changes linearly
    // from w to w2 during the sweep, and stays at w2.
    for (const double t : {0.25, 0.3, 1.0, 1.7499, 1.75, 1.7501, 2.5}) {
      oracle::Ode rotor(
          [&](double, const oracle::State &y, oracle::State &f) {
            f[0] = 1.0; // the clock
            f[1] = y[0] < 1.75 ? 40.0 * pi + (target - 40.0 * pi) * (y[0] - 0.25) / 1.5 : target;
          },
          0.25, {0.25, 0.3}, {1.0, 1.0});
      if (t > 0.25) rotor.advance(std::min(t, 1.75));
      if (t > 1.75) {
        rotor.restart(rotor.state());
        rotor.advance(t);
      }
      EXPECT_NEAR(excitation_phase(e, t), rotor.state()[1], 1e-7) << t;
    }
  }
}

TEST(Excitation, HasTheFrequencyAsTheSlopeOfItsPhase) {
  const Excitation e = swept();
  const double h = 1e-5;
  for (int i = 0; i < 400; ++i) {
    const double t = 0.0052 * i;
    const double slope = (excitation_phase(e, t + h) - excitation_phase(e, t - h)) / (2.0 * h);
    EXPECT_NEAR(excitation_frequency(e, t), slope, 1e-3) << t;
  }
  EXPECT_EQ(excitation_frequency(e, 0.25), 40.0 * pi);
  EXPECT_NEAR(excitation_frequency(e, 1.0), 60.0 * pi, 1e-12);
  EXPECT_EQ(excitation_frequency(e, 1.75), 80.0 * pi);
  EXPECT_EQ(excitation_frequency(e, 99.0), 80.0 * pi);
}

TEST(Excitation, DoesNotJumpWhereASweepStartsAndEnds) {
  for (const bool eccentric : {false, true}) {
    Excitation e = swept();
    e.eccentric = eccentric;
    e.eccentric_mass = 50.0;
    e.eccentric_radius = 0.07;
    e.phase = -pi / 2.0; // so that the amplitude itself shows
    const double h = 1e-9;
    for (const double edge : {0.25 + 2.0 * h, 1.75}) { // just after the start the force is there at once
      EXPECT_NEAR(excitation_phase(e, edge - h), excitation_phase(e, edge + h), 1e-6);
      EXPECT_NEAR(excitation_frequency(e, edge - h), excitation_frequency(e, edge + h), 1e-6);
      EXPECT_NEAR(excitation_force(e, edge - h), excitation_force(e, edge + h),
                  1e-5 * excitation_amplitude(e, edge));
    }
  }
}

TEST(Excitation, StartsAndRamps) {
  Excitation e = directed();
  e.start = 0.5;
  e.phase = pi / 2.0;
  EXPECT_EQ(excitation_amplitude(e, 0.4999), 0.0);
  EXPECT_EQ(excitation_force(e, 0.4999), 0.0);
  EXPECT_EQ(excitation_amplitude(e, 0.5), 58.8e3);
  EXPECT_NEAR(excitation_force(e, 0.5), 58.8e3, 1e-9); // the phase counts from the start
  e.ramp = 0.2;
  EXPECT_EQ(excitation_amplitude(e, 0.5), 0.0);
  EXPECT_NEAR(excitation_amplitude(e, 0.55), 14.7e3, 1e-8);
  EXPECT_NEAR(excitation_amplitude(e, 0.6), 29.4e3, 1e-8);
  EXPECT_NEAR(excitation_amplitude(e, 0.7 - 1e-12), 58.8e3, 1e-5);
  EXPECT_EQ(excitation_amplitude(e, 0.71), 58.8e3);
}

TEST(Excitation, OfAnEccentricMassIsItsCentripetalForce) {
  Excitation e = swept();
  e.eccentric = true;
  e.eccentric_mass = 50.0;
  e.eccentric_radius = 0.07;
  e.rotating = true;
  // The force on the drum is me re times the acceleration of a point on the unit circle, which does not
  // depend on how the core writes it; before the sweep and after it the point turns evenly.
  for (const double t : {2.0, 2.003, 2.5}) {
    const double h = 1e-5;
    const auto at = [&](double time) { return std::sin(excitation_phase(e, time)); };
    const double acceleration = (at(t + h) - 2.0 * at(t) + at(t - h)) / (h * h);
    EXPECT_NEAR(excitation_force(e, t), -50.0 * 0.07 * acceleration, 2.0);
  }
  const double slow = excitation_amplitude(e, 0.25), fast = excitation_amplitude(e, 1.8);
  EXPECT_NEAR(fast / slow, 4.0, 1e-12); // twice the frequency
  EXPECT_NEAR(slow, 50.0 * 0.07 * 15791.367041742974, 1e-7);
}

TEST(Excitation, RotatingKeepsItsMagnitudeAndTurnsAtItsFrequency) {
  Excitation e = directed();
  e.rotating = true;
  for (int i = 0; i < 200; ++i) {
    const double t = 7.3e-4 * i, h = 1e-4;
    const auto now = excitation_components(e, t);
    const auto later = excitation_components(e, t + h);
    EXPECT_NEAR(std::hypot(now[0], now[1]), 58.8e3, 1e-8);
    EXPECT_EQ(now[0], excitation_force(e, t));
    // From the second direction, axis x n, towards the first, n.
    const double turned = (now[1] * later[0] - now[0] * later[1]) / (58.8e3 * 58.8e3);
    EXPECT_NEAR(std::asin(turned) / h, 40.0 * pi, 1e-6);
  }
  EXPECT_NEAR(excitation_components(e, 0.0)[1], 58.8e3, 1e-9);
}

TEST(Excitation, DirectedKeepsItsDirection) {
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(excitation_components(directed(), 1e-3 * i)[1], 0.0);
    EXPECT_EQ(excitation_components(directed(), 1e-3 * i)[0], excitation_force(directed(), 1e-3 * i));
  }
}

} // namespace exciter

// The absorbing boundary against closed forms and CVODE.
namespace absorbs {

constexpr double pi = 3.141592653589793;
constexpr double rho = 1800.0, cp = 300.0, cs = 170.0, H = 2.5, area = 0.4;
constexpr double Z = rho * cp * area, K = rho * cp * cp * area / H;   // along the normal, written out
constexpr double Zs = rho * cs * area, Ks = rho * cs * cs * area / H; // in the plane
const Vec3 oblique{0.6, 0.0, 0.8}, in_plane{-0.8, 0.0, 0.6};

GroundedBall boundary(const Vec3 &normal, double balls = 1.0, double depth = H) {
  const Ground ground{rho, cp, cs, depth, area};
  EXPECT_EQ(ground.invalid(), "");
  return {normal, ground.along_normal(balls), ground.in_plane(balls)};
}

TEST(AbsorbingBoundary, ActsAlongTheNormalAndInThePlaneAsStated) {
  const GroundedBall ball = boundary(oblique, 5.0);
  const double un = 2e-4, ut = -3e-4, uy = 1e-4, vn = 0.02, vt = 0.05, vy = -0.01;
  const auto at = [](double n, double t, double y) {
    return Vec3{n * oblique[0] + t * in_plane[0], y, n * oblique[2] + t * in_plane[2]};
  };
  const Vec3 found = ball.force(at(un, ut, uy), at(vn, vt, vy));
  const Vec3 expected = at(-(K * un + Z * vn) / 5.0, -(Ks * ut + Zs * vt) / 5.0, -(Ks * uy + Zs * vy) / 5.0);
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_NEAR(found[a], expected[a], 1e-10 * K * 1e-4);
  EXPECT_EQ(boundary(oblique, 5.0, std::numeric_limits<double>::infinity()).along.stiffness, 0.0);
  const double q = 1e5; // the layer settles by q H/M under a pressure q
  EXPECT_NEAR(dot(oblique, ball.force(at(-q * H / (rho * cp * cp), 0.0, 0.0), {})), q * area / 5.0, 1e-9 * q);
}

TEST(AbsorbingBoundary, PowerIsStoredOrTurnsIntoHeat) {
  const GroundedBall ball = boundary(oblique);
  std::mt19937 random(611953);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 u{any(random), any(random), any(random)}, v{any(random), any(random), any(random)};
    const double h = 1e-4;
    const double stored_rate = (ball.stored(sum(u, h, v)) - ball.stored(sum(u, -h, v))) / (2.0 * h);
    ASSERT_GE(ball.heat(v), 0.0);
    ASSERT_NEAR(-dot(ball.force(u, v), v), stored_rate + ball.heat(v), 1e-7 * K);
  }
}

// A semi-infinite elastic rod of the ground's impedance ends at the boundary. A wave of velocity v_i arrives,
// the end moves with v, and the rod exerts Z (2 v_i - v) on the boundary: d'Alembert's solution. The velocity
// of the reflected wave is v - v_i. CVODE solves the same end with formulas of its own.
TEST(AbsorbingBoundary, ReflectsTheShareOfTheEnergyThatTheLayerDoes) {
  const GroundedBall ball = boundary({0.0, 0.0, 1.0});
  for (const double ratio : {0.05, 0.5, 2.0}) { // w H / c_p
    const double w = ratio * cp / H, period = 2.0 * pi / w;
    const auto incident = [w](double t) { return std::sin(w * t); };
    // The velocity with which the forces on the end balance: one step of Newton's method on a linear force.
    const auto end_velocity = [&](double t, double u) {
      const auto unbalanced = [&](double v) {
        return Z * (2.0 * incident(t) - v) + ball.force({0.0, 0.0, u}, {0.0, 0.0, v})[2];
      };
      return unbalanced(0.0) / (unbalanced(0.0) - unbalanced(1.0));
    };
    const int steps = 4000;
    double u = 0.0, arrived = 0.0, reflected = 0.0;
    oracle::Ode exact(
        [&](double t, const oracle::State &y, oracle::State &f) { f[0] = incident(t) - 0.5 * K / Z * y[0]; },
        0.0, {0.0}, {1.0 / w});
    const int cycles = 10 + static_cast<int>(20.0 / (K / Z / 2.0 * period)); // until the start has died away
    const double dt = period / steps;
    for (int n = 0; n < cycles * steps; ++n) {
      const double t = n * dt;
      const double v1 = end_velocity(t, u), v2 = end_velocity(t + 0.5 * dt, u + 0.5 * dt * v1);
      u += dt * v2;
      if (n < (cycles - 1) * steps) continue;
      const double v = end_velocity(t + dt, u), back = v - incident(t + dt);
      arrived += incident(t + dt) * incident(t + dt);
      reflected += back * back;
    }
    exact.advance(cycles * period);
    EXPECT_NEAR(u, exact.state()[0], 2e-6 / w) << ratio;
    EXPECT_NEAR(reflected / arrived, 1.0 / (1.0 + 4.0 * ratio * ratio), 2e-6) << ratio;
  }
}

// ---- In time steps

enum class Pass { alone, coupled };

/// A ball of mass m, released at rest beside its reference, by velocity Verlet with the second-order scheme.
Vec3 released(const GroundedBall &ball, double m, const Vec3 &start, double time, int steps, Pass pass) {
  const double dt = time / steps;
  Vec3 u = start, v{}, force = ball.force(u, v);
  for (int n = 0; n < steps; ++n) {
    const Vec3 half = sum(v, 0.5 * dt / m, force);
    u = sum(u, dt, half);
    const GroundedStep step{u, half, v, force, dt};
    if (pass == Pass::alone) {
      force = implicit_force(ball, step, m);
    } else {
      const CoupledGround coupled = coupled_ground(ball, step, std::sqrt(ball.along.damping) / m);
      force = coupled.second(ball.normal, sum(half, 0.5 * dt / m, coupled.first(ball.normal)));
    }
    v = sum(half, 0.5 * dt / m, force);
  }
  return u;
}

TEST(AbsorbingBoundary, StepsAreOfSecondOrderAlongTheNormalAndInThePlane) {
  const GroundedBall ball = boundary(oblique);
  for (const double m : {20.0, 500.0, 20000.0}) // damping ratios from above 1 to far below
    for (const Pass pass : {Pass::alone, Pass::coupled}) {
      const double time = 4.0 / std::sqrt(K / m);
      for (const bool along : {true, false}) {
        const Vec3 &axis = along ? oblique : in_plane;
        const double exact = oracle::Oscillator{m, along ? K : Ks, along ? Z : Zs}.at(time, 1e-3, 0.0).x;
        const auto error = [&](int steps) {
          return std::fabs(dot(axis, released(ball, m, scaled(1e-3, axis), time, steps, pass)) - exact);
        };
        const double order = std::log2(error(1600) / error(3200));
        EXPECT_NEAR(order, 2.0, 0.15) << m << (along ? " normal" : " plane");
        EXPECT_LT(error(3200), 1e-7) << m << (along ? " normal" : " plane");
      }
    }
}

TEST(AbsorbingBoundary, StaysStableUpToItsCriticalStepAndNotBeyond) {
  const double m = 500.0;
  for (const bool implicit : {true, false}) {
    const GroundedBall ball = boundary(oblique);
    LoadedBall loads;
    loads.add(ball.modes(m, implicit));
    const double critical = loads.critical_step();
    EXPECT_NEAR(critical, critical_step_stock(K, implicit ? 0.0 : Z, m), 1e-9 * critical);
    for (const double part : {0.99, 1.01}) {
      double u = 1.0, v = 0.0, force = ball.force(oblique, {})[2] / oblique[2];
      const double dt = part * critical;
      for (int n = 0; n < 2000; ++n) {
        const double half = v + 0.5 * dt / m * force;
        u += dt * half;
        const Vec3 at = scaled(u, oblique), rate = scaled(half, oblique);
        const GroundedStep step{at, rate, scaled(v, oblique), scaled(force, oblique), dt};
        force = dot(oblique, implicit ? implicit_force(ball, step, m) : ball.force(at, rate));
        v = half + 0.5 * dt / m * force;
      }
      EXPECT_EQ(std::fabs(u) < 1.0, part < 1.0) << implicit << " " << part << ": " << u;
    }
  }
}

} // namespace absorbs

} // namespace
