// Friction in both engines, and all combinations of tangential and rolling models.
#include "tests/support/engine_runs.h"
#include "bed/dump_readers.h"
#include "physics/laws/friction_law.h"

namespace drumlin::test {
namespace {

// Friction as the engine's tangential history and our tangential coulomb apply it to our contact: the core's
// law along recorded paths, closed forms of sticking and sliding, the defaults, that the history of a broken
// contact is deleted, impulses of oblique impacts, and a clump on a slope.
namespace friction {

using physics::Vec3;
using post::Transition;

constexpr double mass = 2000, radius = 0.75, other_radius = 0.5, k = 1e8;

double dot(const Vec3 &a, const Vec3 &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 sum(const Vec3 &a, double s, const Vec3 &b) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}
Vec3 cross(const Vec3 &a, const Vec3 &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// An oblique, spinning throw onto an obstacle under strong gravity, so that the ball returns before the
/// neighbour list would be rebuilt.
struct Throw {
  const char *obstacle;
  Transition transition;
  double D = 0.2, g = 20, dt = 1e-5;
  physics::Friction friction{2.0 / 7.0 * k, 0, 0.5, physics::Cap::spring}; // the defaults; the damping below

  Throw(const char *on, Transition how, physics::Cap cap = physics::Cap::spring)
      : obstacle(on), transition(how) {
    friction.damping = 0.5 * damping();
    friction.cap = cap;
  }
  bool coulomb() const { return friction.cap == physics::Cap::coulomb; }
  double damping() const { return 2 * D * std::sqrt(mass * k); }

  BallsRun run(const Variables &more) const {
    Variables variables = given("obstacle {}, transition {}, models {}, dashpot {}, g {}, gap 1e-4, "
                                "velocity2 1.4 0.1 -0.5, spin2 -0.2, dt {}, steps 5000",
                                obstacle, post::transition_name(transition),
                                coulomb() ? "tangential coulomb" : "tangential history", D, g, dt);
    variables.insert(variables.end(), more.begin(), more.end());
    return run_balls(variables);
  }
};

void PrintTo(const Throw &value, std::ostream *out) {
  *out << value.obstacle << ", " << post::transition_name(value.transition)
       << (value.coulomb() ? ", coulomb" : "");
}

/// How far the engine's forces and torques are from those of the core's law along the engine's own path.
struct Replay {
  double force = 0, torque = 0; ///< largest difference over the largest force and torque
  int contacts = 0, sliding = 0, sticking = 0;
};

/// The engine evaluates forces at the positions of a step and the velocities of its half: v = x' - dt/2 f/m
/// with x' and f of the step's end. `forget`: whether the spring vanishes with its contact.
Replay replay(const Throw &scene, const BallsRun &run, bool forget) {
  const bool on_ball = std::string(scene.obstacle) == "ball";
  const long id = on_ball ? 2 : 1;
  const double inertia = 0.4 * mass * radius * radius;
  Replay result;
  Vec3 spring{};
  bool touching = false;
  double largest_force = 0, largest_torque = 0;
  for (const Frame &frame : run.frames) {
    if (frame.step == 0) continue; // set-up: no contact
    const Ball &ball = frame.balls.at(id);
    const Vec3 v = sum(ball.v, -0.5 * scene.dt / mass, ball.f);
    const Vec3 spin = sum(ball.omega, -0.5 * scene.dt / inertia, ball.torque);
    const Vec3 centre = on_ball ? frame.balls.at(1).x : Vec3{ball.x[0], ball.x[1], 0};
    const Vec3 apart = sum(ball.x, -1, centre);
    const double distance = std::sqrt(dot(apart, apart));
    const Vec3 normal = {apart[0] / distance, apart[1] / distance, apart[2] / distance};
    const double overlap = radius + (on_ball ? other_radius : 0) - distance;
    Vec3 force = {0, 0, -mass * scene.g}, torque{};
    if (overlap > 0) {
      const double vn = dot(v, normal);
      double Fn = k * overlap - scene.damping() * vn;
      if (scene.transition == Transition::B) Fn = std::max(0.0, Fn);
      const Vec3 arm = {-(radius - overlap / 2) * normal[0], -(radius - overlap / 2) * normal[1],
                        -(radius - overlap / 2) * normal[2]};
      Vec3 vt = sum(sum(v, -vn, normal), 1, cross(spin, arm));
      if (scene.coulomb() &&
          on_ball) { // the slip about the normal of the middle of the step, across the normal of its end
        const Vec3 middle = sum(apart, -0.5 * scene.dt, v);
        const double length = std::sqrt(dot(middle, middle));
        const Vec3 direction = {middle[0] / length, middle[1] / length, middle[2] / length};
        const double size = radius - overlap / 2;
        const Vec3 lever = {-size * direction[0], -size * direction[1], -size * direction[2]};
        const Vec3 slip = sum(sum(v, -dot(v, direction), direction), 1, cross(spin, lever));
        vt = sum(slip, -dot(slip, normal), normal);
      }
      // The spring of `coulomb` begins to stretch when the surfaces touch.
      const bool begins = scene.coulomb() && !touching && overlap < -vn * scene.dt;
      const physics::FrictionStep step =
          physics::friction_step(scene.friction, Fn, normal, vt, spring, begins ? overlap / -vn : scene.dt);
      spring = step.spring;
      ++(step.sliding ? result.sliding : result.sticking);
      force = sum(sum(force, Fn, normal), 1, step.force);
      torque = cross(arm, step.force);
      if (!touching) ++result.contacts;
    } else if (forget) {
      spring = {};
    }
    touching = overlap > 0;
    for (std::size_t a = 0; a < 3; ++a) {
      largest_force = std::max(largest_force, std::fabs(ball.f[a]));
      largest_torque = std::max(largest_torque, std::fabs(ball.torque[a]));
      result.force = std::max(result.force, std::fabs(ball.f[a] - force[a]));
      result.torque = std::max(result.torque, std::fabs(ball.torque[a] - torque[a]));
    }
  }
  result.force /= largest_force;
  result.torque /= largest_torque;
  return result;
}

class Friction : public ::testing::TestWithParam<Throw> {};

TEST_P(Friction, IsTheCoresLawAlongThePathWithTheDefaults) {
  const Throw &scene = GetParam();
  const BallsRun run = scene.run({});
  EXPECT_NE(run.output.find("Neighbor list builds = 0\n"), std::string::npos);
  const Replay law = replay(scene, run, true);
  EXPECT_LT(law.force, 1e-10);
  EXPECT_LT(law.torque, 1e-10);
  EXPECT_GE(law.contacts, 2);
  EXPECT_GT(law.sliding, 50);
  EXPECT_GT(law.sticking, 50);
  // A contact of A breaks in tension, with a spring: had it been kept, the next contact would show it. (Under
  // B the limit mu Fn takes the spring along as Fn falls to zero.)
  const double kept = replay(scene, run, false).torque;
  RecordProperty("kept", number(kept) + ", contacts " + std::to_string(law.contacts) + ", sliding " +
                             std::to_string(law.sliding) + ", sticking " + std::to_string(law.sticking));
  if (scene.transition == Transition::A && !scene.coulomb()) {
    EXPECT_GT(kept, 1e-3);
  }
}

TEST_P(Friction, DefaultsAreTheValuesThatAreDocumented) {
  const Throw &scene = GetParam();
  const BallsRun as_given = scene.run(given("kt {}, ct {}, mu {}", scene.friction.stiffness,
                                            scene.friction.damping, scene.friction.coefficient));
  const BallsRun defaults = scene.run({});
  const long id = as_given.frames.front().balls.rbegin()->first;
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_LT(relative_difference(as_given.series(id, &Ball::x, axis), defaults.series(id, &Ball::x, axis)),
              1e-12);
}

TEST_P(Friction, GivenValuesAreTheOnesUsed) {
  Throw scene = GetParam();
  scene.friction = {0.8 * k, 0.15 * scene.damping(), 0.3, scene.friction.cap};
  const BallsRun run = scene.run(given("kt {}, ct {}, mu {}", scene.friction.stiffness,
                                       scene.friction.damping, scene.friction.coefficient));
  const Replay law = replay(scene, run, true);
  EXPECT_LT(law.force, 1e-10);
  EXPECT_LT(law.torque, 1e-10);
}

const Throw throws[] = {{"ball", Transition::A},
                        {"ball", Transition::B},
                        {"plane", Transition::A},
                        {"plane", Transition::B},
                        {"mesh", Transition::A},
                        {"mesh", Transition::B},
                        {"ball", Transition::A, physics::Cap::coulomb},
                        {"mesh", Transition::B, physics::Cap::coulomb}};
INSTANTIATE_TEST_SUITE_P(Obstacle, Friction, ::testing::ValuesIn(throws), [](const auto &test) {
  return test.param.obstacle + post::transition_name(test.param.transition) +
         (test.param.coulomb() ? "coulomb" : "");
});

/// A ball at rest on a plane under its weight, set in motion along it.
BallsRun pushed(const std::string &stepping, double dt, int steps, const Variables &how) {
  Variables variables = how;
  for (const auto &[name, value] : given("obstacle plane, stepping {}, g 9.81, gap {}, dt {}, steps {}",
                                         stepping, -mass * 9.81 / k, dt, steps))
    variables.emplace_back(name, value);
  return run_balls(variables);
}

/// Sticking, rolling or creeping without any sliding: a linear oscillator m q'' + c q' + k q = 0 with q'(0)
/// known.
struct SmallMotion {
  std::string name;
  Variables how;
  double speed; // q'(0)
  double stiffness_over_mass, damping_over_mass;
  bool turns; // q' is the spin about y; else the velocity along x
  double order;
};

void PrintTo(const SmallMotion &value, std::ostream *out) { *out << value.name; }

class SmallMotions : public ::testing::TestWithParam<std::tuple<SmallMotion, std::string>> {};

TEST_P(SmallMotions, AreOfTheOrderThatIsDocumented) {
  const SmallMotion &motion = std::get<0>(GetParam());
  const std::string &stepping = std::get<1>(GetParam());
  constexpr double time = 0.1;
  const std::complex<double> half = 0.5 * motion.damping_over_mass;
  const std::complex<double> root = std::sqrt(half * half - motion.stiffness_over_mass);
  const auto rate = [&](double t) { // of q, from q(0) = 0
    const std::complex<double> fast = -half + root, slow = -half - root;
    return (motion.speed * (fast * std::exp(fast * t) - slow * std::exp(slow * t)) / (2.0 * root)).real();
  };
  std::vector<double> all_steps, errors;
  for (const int steps : {500, 1000, 2000, 4000}) {
    const BallsRun run = pushed(stepping, time / steps, steps, motion.how);
    std::vector<double> exact;
    for (int n = 0; n <= steps; ++n)
      exact.push_back(rate(time / steps * n));
    all_steps.push_back(steps);
    errors.push_back(relative_difference(
        motion.turns ? run.series(2, &Ball::omega, 1) : run.series(1, &Ball::v, 0), exact));
  }
  RecordProperty("order", number(fitted_order(all_steps, errors)));
  EXPECT_NEAR(fitted_order(all_steps, errors), -motion.order, 0.1);
  EXPECT_LT(errors.back(), 5e-3);
}

constexpr double kt = 2.0 / 7.0 * k;
const double ct = 0.5 * 2 * 0.5 * std::sqrt(mass * k);
const SmallMotion small_motions[] = {
    {"ShearSpring", // `history` is the same then
     given("models tangential coulomb, integrator nve, ct 0, velocity2 1e-3 0 0"), 1e-3, kt / mass, 0, false,
     2},
    {"ShearSpringAndDashpot", given("models tangential history, integrator nve, velocity2 1e-3 0 0"), 1e-3,
     kt / mass, ct / mass, false, 1},
    {"CoulombSpringAndDashpot", given("models tangential coulomb, integrator nve, velocity2 1e-3 0 0"), 1e-3,
     kt / mass, ct / mass, false, 1},
    {"TangentialDashpot",
     given("models tangential coulomb, kt 0, integrator nve, ct 2e4, velocity2 1e-3 0 0"), 1e-3, 0,
     2e4 / mass, false, 1},
    // On a ball, since the engine's rate of rolling on a plane grows with the overlap: kr = kt r_eff^2, I =
    // 0.4 m r^2.
    {"RollingSpring", given("obstacle ball, models rolling_friction epsd2, mu_r 10, spin2 1e-3"), 1e-3,
     kt *std::pow(other_radius / (radius + other_radius), 2) / (0.4 * mass), 0, true, 2}};
INSTANTIATE_TEST_SUITE_P(Law, SmallMotions,
                         ::testing::Combine(::testing::ValuesIn(small_motions),
                                            ::testing::Values("second", "stock")),
                         [](const auto &test) {
                           return std::get<0>(test.param).name + std::get<1>(test.param);
                         });

TEST(FrictionOnAPlane, SlidesWithMuTimesTheNormalForce) {
  const BallsRun run =
      pushed("stock", 1e-5, 5000, given("models tangential history, integrator nve, velocity2 1 0 0"));
  const double limit = 0.5 * mass * 9.81;
  for (const Frame &frame : run.frames) {
    if (frame.step < 200) continue; // the spring is wound up
    const Ball &ball = frame.balls.at(1);
    ASSERT_NEAR(ball.f[0], -limit, 1e-9 * limit) << "step " << frame.step;
    ASSERT_NEAR(ball.f[1], 0, 1e-9 * limit);
  }
  const Ball &middle = run.frames[1000].balls.at(1), &end = run.frames[5000].balls.at(1);
  EXPECT_NEAR(end.v[0], middle.v[0] - 0.5 * 9.81 * 4000 * 1e-5, 1e-9);
}

class EnergyBalanceOfASlidingBall : public BothEngines {};

/// Without dashpots the contact point of a ball on a floor has the mass m' = 1/(1/m + a^2/I), a its distance
/// from the centre. It winds the spring up, a quarter of an oscillation at most, slides at mu N until it
/// stops, and then oscillates on the spring.
TEST_P(EnergyBalanceOfASlidingBall, SeparatesHeatOfFrictionFromTheEnergyOfItsSpring) {
  const std::string stepping = std::get<1>(GetParam());
  const Scratch folder; // at D = 0 `history` and `coulomb` are the same law: one for each stepping
  const Outcome outcome =
      run("slide", folder, {{"tangential", stepping == "second" ? "coulomb" : "history"}});
  ASSERT_TRUE(outcome.ok()) << outcome.output;

  constexpr double m = 0.3, r = 0.03, kn = 1e5, spring = 2.0 / 7.0 * kn, mu = 0.4, N = m * 9.81, v0 = 0.3;
  const double arm = r - 0.5 * N / kn;
  const double m_slip = 1 / (1 / m + arm * arm / (0.4 * m * r * r));
  const double w = std::sqrt(spring / m_slip), limit = mu * N / spring;
  const double t_slide = std::asin(limit * w / v0) / w, v_slide = v0 * std::cos(w * t_slide);
  const double t_stop = t_slide + v_slide * m_slip / (mu * N);
  const auto slid = [&](double t) { // m
    const double since = std::clamp(t, t_slide, t_stop) - t_slide;
    return v_slide * since - 0.5 * mu * N / m_slip * since * since;
  };
  const auto wound = [&](double t) { // of the spring, m
    return t < t_slide ? v0 / w * std::sin(w * t) : limit * std::cos(w * (std::max(t, t_stop) - t_stop));
  };

  const post::Table table = post::read_table(folder / "bed.csv");
  const std::vector<double> time = table.numbers("time"), elastic = table.numbers("elastic"),
                            heat = table.numbers("dissipated");
  const double most = 0.5 * spring * limit * limit; // J, of the spring
  int winding = 0, sliding = 0, swinging = 0;
  for (std::size_t n = 0; n < time.size(); ++n) {
    ++(time[n] < t_slide ? winding : time[n] < t_stop ? sliding : swinging);
    const double stored = 0.5 * spring * wound(time[n]) * wound(time[n]);
    EXPECT_NEAR(elastic[n] - 3 * 0.5 * N * N / kn, stored, 0.01 * most) << time[n];
    EXPECT_NEAR(heat[n], mu * N * slid(time[n]), 0.01 * most) << time[n];
  }
  EXPECT_GT(std::min({winding, sliding, swinging}), 1);
  const post::Table cycles = post::read_table(folder / "cycles.csv");
  EXPECT_NEAR(cycles.numbers("dissipated_friction").back(), 0.5 * m_slip * v_slide * v_slide, 0.01 * most);
  EXPECT_NEAR(cycles.numbers("dissipated_contact").back(), 0.0, 1e-4 * most);
}

INSTANTIATE_TEST_SUITE_P(Decks, EnergyBalanceOfASlidingBall, engines_and_steppings(), engine_and_stepping);

/// With dashpots there is no closed form, but energy is conserved: the mechanical energy that the ball loses
/// equals the heat recorded so far, and this heat never decreases.
TEST_P(EnergyBalanceOfASlidingBall, ClosesWithDashpotsUnderCoulomb) {
  const Scratch folder;
  const Outcome outcome = run("slide", folder, given("tangential coulomb, D 0.5, every 10"));
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  const post::Table table = post::read_table(folder / "bed.csv");
  const std::vector<double> kinetic = table.numbers("kinetic"), elastic = table.numbers("elastic"),
                            heat = table.numbers("dissipated"), potential = table.numbers("potential");
  const double start = kinetic.front() + elastic.front() + potential.front();
  for (std::size_t n = 0; n < heat.size(); ++n) {
    EXPECT_NEAR(kinetic[n] + elastic[n] + potential[n] + heat[n], start, 1e-3 * kinetic.front()) << n;
    if (n > 0) {
      EXPECT_GT(heat[n], heat[n - 1] - 1e-6 * kinetic.front()) << n;
    }
  }
  EXPECT_GT(heat.back(), 0.2 * kinetic.front());
}

class ObliqueImpacts : public BothEngines {
protected:
  /// Tangential over mu times normal impulse of the balls of oblique.scene, by ID.
  static std::array<double, 8> ratios(const Variables &variables) {
    const Scratch folder;
    write_floor(folder / "floor.stl", 0.36, true);
    const Outcome outcome = run("oblique", folder, variables);
    EXPECT_TRUE(outcome.ok()) << outcome.output;
    const std::vector<Frame> frames = read_dump(folder / "balls.txt");
    std::array<double, 8> all{};
    for (std::size_t n = 0; n < all.size(); ++n) {
      const Ball &before = frames.front().balls.at(static_cast<long>(n) + 1),
                 &after = frames.back().balls.at(static_cast<long>(n) + 1);
      all.at(n) = (before.v[0] - after.v[0]) / (0.5 * (after.v[2] - before.v[2]));
    }
    return all;
  }
};

// On planes, a mesh (LIGGGHTS), the faces of a region (LAMMPS) and balls. Without damping the Hertz law
// sticks at 72 degrees: its impulse there is tested by oblique_impact_test.cpp.
TEST_P(ObliqueImpacts, OfSlidingBallsHaveMuTimesTheNormalImpulse) {
  const bool lammps = std::get<0>(GetParam()) == "lammps";
  const Variables faces = lammps ? Variables{{"walls", "block"}} : Variables{{"mesh", "1"}};
  for (const auto &[normal, D] : {std::pair{"hooke", "0"},
                                  {"hooke", "0.3"},
                                  {"hooke", "0.5"},
                                  {"hooke", "2"},
                                  {"hertz", "0.3"},
                                  {"hertz", "0.5"},
                                  {"hertz", "2"}})
    for (const Variables &walls : {Variables{}, faces}) {
      Variables variables = walls;
      variables.emplace_back("normal", normal);
      variables.emplace_back("D", D);
      const std::array<double, 8> found = ratios(variables);
      for (std::size_t n = 0; n < found.size(); ++n)
        EXPECT_NEAR(found.at(n), 1.0, 0.01)
            << normal << ", D " << D << ", ball " << n + 1 << (walls.empty() ? "" : ", faces");
    }
  // What the engines' rule does, at 76 degrees from the normal.
  for (const auto &[D, known] : {std::pair{"0.3", 1.49}, {"0.5", 1.91}, {"2", 2.24}}) {
    const std::array<double, 8> spring = ratios(given("tangential history, D {}", D));
    EXPECT_NEAR(spring[1], known, 0.02) << D;
    EXPECT_NEAR(spring[5], known, 0.02) << D;
  }
}

/// Restitution of the linear law under B, e = exp(-b/w (pi - phi)) with the phase phi of the damped
/// oscillation in which the force is zero (Schwager and Poeschel 2007, Granular Matter 9, 465-469).
double restitution_under_b(double D) {
  const double w = std::sqrt(1 - D * D);
  return std::exp(-D / w * (std::acos(-1.0) - std::atan2(2 * D * w, w * w - D * D)));
}

// The balls slide from make to break, so that v_x changes by mu (1 + e) v_z, the closed form. The restitution
// of the Hertz law is that of the linear one.
TEST_P(ObliqueImpacts, OnAWallConvergeWithTheOrderOfTheScheme) {
  const bool second = std::get<1>(GetParam()) == "second";
  constexpr double D = 0.3, mu = 0.5, time = 2e-4;
  for (const char *normal : {"hooke", "hertz"}) {
    std::vector<double> all_steps, errors;
    for (const int steps : {100, 141, 200, 283, 400, 566, 800, 1131, 1600}) {
      const Scratch folder;
      const Outcome outcome =
          run("oblique", folder, given("normal {}, D {}, dt {}, steps {}", normal, D, time / steps, steps));
      ASSERT_TRUE(outcome.ok()) << outcome.output;
      const std::vector<Frame> frames = read_dump(folder / "balls.txt");
      double squares = 0.0;
      for (const long ball : {1, 2, 3, 4}) {
        const std::array<double, 3> &before = frames.front().balls.at(ball).v,
                                    &after = frames.back().balls.at(ball).v;
        const double exact = before[0] + mu * (1 + restitution_under_b(D)) * before[2];
        squares += std::pow((after[0] - exact) / before[2], 2);
      }
      all_steps.push_back(steps);
      errors.push_back(std::sqrt(squares / 4));
    }
    RecordProperty(std::string("order_") + normal, number(fitted_order(all_steps, errors)));
    RecordProperty(std::string("error_") + normal, number(errors.back()));
    EXPECT_NEAR(fitted_order(all_steps, errors), second ? -2.0 : -1.0, 0.25) << normal;
    EXPECT_LT(errors.back(), second ? 2e-4 : 5e-3) << normal;
  }
}

INSTANTIATE_TEST_SUITE_P(Decks, ObliqueImpacts, engines_and_steppings(), engine_and_stepping);

/// Scenes of crown.scene: what the ball meets moves with the velocity `frame`, m/s.
class Crown : public BothEngines {
protected:
  static constexpr double dt = 5e-5, r = 0.02;
  struct Motion {
    std::vector<Frame> frames;
    Vec3 frame;
  };

  static Motion motion(Variables variables, const Vec3 &frame) {
    const Scratch folder;
    write_floor(folder / "floor.stl", 0.09, false);
    for (const auto &[name, value] : given("dt {}, ux {}, uz {}", dt, frame[0], frame[2]))
      variables.emplace_back(name, value);
    const Outcome outcome = run("crown", folder, variables);
    EXPECT_TRUE(outcome.ok()) << outcome.output;
    return {outcome.ok() ? read_dump(folder / "balls.txt") : std::vector<Frame>{}, frame};
  }

  /// Largest difference of two motions, each seen from its frame, in units of the radius for positions, and
  /// of the final speed for velocities and spins times the radius.
  static double difference(const Motion &one, const Motion &other) {
    if (one.frames.size() != 11 || other.frames.size() != 11) return HUGE_VAL;
    double most = 0.0;
    for (std::size_t n = 0; n < one.frames.size(); ++n) {
      const Ball &a = one.frames[n].balls.begin()->second, &b = other.frames[n].balls.begin()->second;
      const double time = dt * static_cast<double>(one.frames[n].step);
      for (std::size_t c = 0; c < 3; ++c) {
        const double moved = one.frame[c] - other.frame[c];
        for (const double change :
             {(a.x[c] - b.x[c] - moved * time) / r, a.v[c] - b.v[c] - moved, r * (a.omega[c] - b.omega[c])})
          most = std::isfinite(change) ? std::max(most, std::fabs(change)) : HUGE_VAL;
      }
    }
    return most;
  }
};

// Friction at a wall takes the slip of the middle of the step, where the normal was another one: with that of
// the end `coulomb` differs by 1e-6.
TEST_P(Crown, OfAWallIsThatOfABallOfInfiniteMassThatMoves) {
  constexpr double R = 0.1;
  for (const char *normal : {"hooke", "hertz"})
    for (const char *tangential : {"coulomb", "history"}) {
      const Variables law = given("normal {}, tangential {}", normal, tangential);
      Variables wall = law;
      wall.emplace_back("wall", "1");
      // The radius of the wall does not count for the Hertz law, that of a ball does.
      wall.emplace_back("E", number(2e7 * std::sqrt(R / (R + r))));
      const Motion at_wall = motion(wall, {}), on_ball = motion(law, {0.3, 0, 0.1});
      EXPECT_LT(difference(at_wall, on_ball), 1e-9) << normal << ", " << tangential;
      ASSERT_FALSE(at_wall.frames.empty());
      const Ball &end = at_wall.frames.back().balls.begin()->second;
      EXPECT_GT(end.x[0] - at_wall.frames.front().balls.begin()->second.x[0], r) << "it has rolled";
      EXPECT_GT(r * end.omega[1], 1.0);
    }
}

// A mesh at rest and one that moves: its faces, in an impact with rolling resistance. On its edge the ball
// rolls as on one of a radius of nearly zero. (In the set-up of a run the engine does not know yet that a
// mesh moves.)
TEST_P(Crown, OfAMeshDoesNotDependOnTheFrame) {
  if (std::get<0>(GetParam()) == "lammps") GTEST_SKIP() << "SKIPPED: LAMMPS has no mesh";
  for (const char *tangential : {"coulomb", "history"}) {
    for (const char *normal : {"hooke", "hertz"}) {
      const Variables fall = given(
          "wall 2, normal {}, tangential {}, g 9.81, rolling epsd2, x 0.2, z 0.221, vx 0.8, vz -1, steps 200",
          normal, tangential);
      const Motion rest = motion(fall, {});
      EXPECT_LT(difference(rest, motion(fall, {0.3, 0, 0.2})), 1e-9) << normal << ", " << tangential;
      EXPECT_LT(difference(rest, motion(fall, {-0.5, 0, -0.4})), 1e-9) << normal << ", " << tangential;
      ASSERT_FALSE(rest.frames.empty());
      EXPECT_GT(rest.frames.back().balls.begin()->second.omega[1], 1.0);
    }
    const Variables roll = given("tangential {}, R 1e-12, steps 400", tangential);
    Variables edge = roll;
    edge.emplace_back("wall", "2");
    edge.emplace_back("mesh_x", "0.11");
    EXPECT_LT(difference(motion(edge, {}), motion(roll, {0.3, 0, 0.1})), 1e-8) << tangential;
  }
}

INSTANTIATE_TEST_SUITE_P(Decks, Crown, engines_and_steppings(), engine_and_stepping);

// A wall that moves within its shape turns no normal: the ball has the speed of the wall. (LAMMPS's walls do
// not move.)
TEST(RotatingDrum, CarriesABallAtItsOwnSpeed) {
  constexpr double turns = 50.0, R = 0.1, r = 0.02, axis = 0.2; // rad/s, m
  for (const char *tangential : {"coulomb", "history"})
    for (const char *stepping : {"second", "stock"}) {
      const Scratch folder;
      well(run_deck(test_deck("rotating_drum.in"), given("tangential {}, stepping {}", tangential, stepping),
                    folder.path()));
      const Ball end = read_dump(folder / "balls.txt").back().balls.at(1);
      // The engine's wall has the velocity of the drum where the centre of the ball is; the lever of a
      // contact is the radius less half of the overlap.
      const double below = axis - end.x[2], lever = r - 0.5 * (below + r - R);
      EXPECT_LT(lever, r);
      EXPECT_NEAR(std::fabs(end.omega[0]) * lever / (turns * below), 1.0, 1e-12)
          << tangential << ", " << stepping;
    }
}

class Slope : public BothEngines {};
INSTANTIATE_TEST_SUITE_P(Decks, Slope, engines_and_steppings(), engine_and_stepping);

/// The slope is a tenth less steep than the friction angle.
TEST_P(Slope, HoldsARigidClumpWithoutCreep) {
  const double weight = 0.3 * 9.81 * std::cos(0.9 * std::atan(0.5));
  const double hertz = 4.0 / 3.0 * 2e7 / (2 * (1 - 0.3 * 0.3)) * std::sqrt(0.03); // N/m^(3/2)
  for (const Variables &law :
       {Variables{}, given("normal hertz, rest {}", std::pow(weight / hertz, 2.0 / 3.0))}) {
    const Scratch folder;
    Variables variables = law;
    variables.emplace_back("steps", "1000000");
    const Outcome outcome = run("slope", folder, variables);
    ASSERT_TRUE(outcome.ok()) << outcome.output;
    const std::vector<Frame> frames = read_dump(folder / "balls.txt");
    ASSERT_EQ(frames.size(), 21u);
    const Ball &middle = frames[10].balls.at(1), &start = frames[0].balls.at(1);
    EXPECT_GT(middle.x[0] - start.x[0], 1e-6) << "the springs of friction are wound up";
    const double time = 500000 * 1e-5; // s, of the second half
    for (std::size_t n = 10; n < frames.size(); ++n)
      for (const auto &[id, ball] : frames[n].balls)
        for (std::size_t a = 0; a < 3; ++a) {
          EXPECT_NEAR(ball.v[a], 0, 1e-9) << "ball " << id;
          EXPECT_NEAR(ball.x[a], frames[10].balls.at(id).x[a], 1e-9 * time) << "ball " << id;
        }
  }
}

} // namespace friction

// All combinations of tangential and rolling models that the plugin supports, between balls, on primitive
// planes and on a mesh: they run, stay finite, keep the balls in the box and dissipate energy.
namespace of_combinations {

struct Combination {
  std::string tangential, rolling;
  std::string words() const { return "tangential " + tangential + " rolling_friction " + rolling; }
};

void PrintTo(const Combination &value, std::ostream *out) { *out << value.words(); }

std::vector<Frame> run_box(const Combination &models, const char *transition, const char *stepping) {
  const Scratch scratch;
  well(run_scene("liggghts", "box",
                 given("models {}, transition {}, stepping {}", models.words(), transition, stepping),
                 scratch.path()));
  return read_dump(scratch / "balls.txt");
}

constexpr double mass = 0.16, radius = 0.025, g = 9.81;

double energy(const Frame &frame) {
  double sum = 0;
  for (const auto &[id, ball] : frame.balls) {
    sum += mass * g * ball.x[2];
    for (std::size_t a = 0; a < 3; ++a)
      sum += 0.5 * mass * (ball.v[a] * ball.v[a] + 0.4 * radius * radius * ball.omega[a] * ball.omega[a]);
  }
  return sum;
}

class Combinations : public ::testing::TestWithParam<Combination> {};

TEST_P(Combinations, RunAndDissipateEnergy) {
  for (const char *transition : {"A", "B"}) {
    for (const char *stepping : {"second", "stock"}) {
      const std::vector<Frame> frames = run_box(GetParam(), transition, stepping);
      ASSERT_EQ(frames.size(), 5u);
      const Frame &end = frames.back();
      ASSERT_EQ(end.balls.size(), 50u);
      double spin_change = 0;
      for (const auto &[id, ball] : end.balls) {
        for (const auto part : {&Ball::x, &Ball::v, &Ball::f, &Ball::omega, &Ball::torque})
          for (const double value : ball.*part)
            ASSERT_TRUE(std::isfinite(value)) << "ball " << id;
        // Walls at -0.15 and 0.15, floor at 0; an impact at 1 m/s overlaps by a millimetre.
        EXPECT_LT(std::fabs(ball.x[0]), 0.15 - radius + 0.002);
        EXPECT_LT(std::fabs(ball.x[1]), 0.15 - radius + 0.002);
        EXPECT_GT(ball.x[2], radius - 0.002);
        spin_change += std::fabs(ball.omega[0]) + std::fabs(ball.omega[1] - 20) + std::fabs(ball.omega[2]);
      }
      EXPECT_LT(energy(end), 0.7 * energy(frames.front()));
      const bool turns = GetParam().tangential != "off" || GetParam().rolling != "off";
      EXPECT_EQ(spin_change > 1, turns) << spin_change;
    }
  }
}

TEST(MeshFloor, RowsOfContactsExplainTheForceOnEachBall) {
  const Scratch scratch;
  well(run_scene("liggghts", "box", given("models tangential history, stepping stock, every 20"),
                 scratch.path()));
  int on_floor = 0;
  double worst = 0, largest = 0;
  for (const Frame &frame : read_dump(scratch / "balls.txt")) {
    std::map<long, std::array<double, 3>> rest;
    for (const auto &[id, ball] : frame.balls)
      rest[id] = {ball.f[0], ball.f[1], ball.f[2] + mass * g};
    const std::string rows = "contacts_" + std::to_string(frame.step) + ".dump";
    for (const std::vector<double> &row : post::read_text_dump(scratch / rows).rows) {
      const std::array<double, 3> force = {row[2], row[3], row[4]};
      const auto i = static_cast<long>(row[0]), j = static_cast<long>(row[1]); // j = 0: a wall
      const Ball &ball = frame.balls.at(i);
      const bool at_a_side = std::max(std::fabs(ball.x[0]), std::fabs(ball.x[1])) > 0.15 - radius;
      if (j == 0 && !at_a_side) ++on_floor;
      for (std::size_t a = 0; a < 3; ++a) {
        rest[i][a] -= force[a];
        if (j > 0) rest[j][a] += force[a];
        largest = std::max(largest, std::fabs(force[a]));
      }
    }
    for (const auto &[id, force] : rest)
      for (const double component : force)
        worst = std::max(worst, std::fabs(component));
  }
  EXPECT_GT(on_floor, 50);
  EXPECT_LT(worst, 1e-12 * largest);
}

const Combination combinations[] = {{"off", "off"},       {"off", "epsd2"},   {"history", "off"},
                                    {"history", "epsd2"}, {"coulomb", "off"}, {"coulomb", "epsd2"}};
std::string name_of(const ::testing::TestParamInfo<Combination> &test) {
  return test.param.tangential + "_" + test.param.rolling;
}
INSTANTIATE_TEST_SUITE_P(Models, Combinations, ::testing::ValuesIn(combinations), name_of);

} // namespace of_combinations

} // namespace
} // namespace drumlin::test
