/// Random oblique impacts of two spinning balls with `tangential coulomb`, of both laws and under both
/// schemes: limit and energy of friction in every step, and the energy of whole impacts. The environment
/// variable DRUMLIN_IMPACTS sets the number of impacts of each law, DRUMLIN_SEED their seed; a hundred
/// thousand take half a minute.

#include "physics/scheme/advance.h"
#include "physics/laws/friction_law.h"
#include "tests/core/contact_friction.h"
#include "tests/core/law_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <tuple>

namespace {

using namespace drumlin::physics;

/// A contact law, two balls of one density, and their motion before they touch.
template <class Contact>
struct Impact {
  Contact contact;
  double friction;         ///< mu
  bool stock;              ///< the scheme
  double ri, rj;           ///< radii, m
  double mi, mj;           ///< kg
  Vec3 v, wi, wj;          ///< v_i - v_j, m/s; rad/s
  double normal_speed;     ///< m/s, of the approach
  double dt, contact_time; ///< s, of the step and of an undamped head-on impact
  double onset;            ///< share of the first step before the touch
};

double squared(const Vec3 &a) { return dot(a, a); }

/// What a run has found.
struct Found {
  double over_limit =
      0.0; ///< largest |Ft| / (mu max(Fn, 0)) - 1 of a step; infinite for a force without a limit
  double made_energy =
      0.0;             ///< largest increase of the stored energy over the work of a step, relative to both
  double gain = 0.0;   ///< kinetic energy of the relative motion, after less before, J
  double before = 0.0; ///< the same before the impact
  long steps = 0, sliding = 0;
};

/// Compares a step of friction with its limit and with the work done on it.
void judge(const FrictionStep &now, double limit, double stored_before, double work, Found &found) {
  const double force = std::sqrt(squared(now.force));
  if (force > 0.0) found.over_limit = std::max(found.over_limit, force / limit - 1.0);
  const double size = std::fabs(work) + stored_before + now.stored;
  if (size > 0.0) found.made_energy = std::max(found.made_energy, (now.stored - stored_before - work) / size);
  ++found.steps;
  found.sliding += now.sliding ? 1 : 0;
}

/// An impact in steps of velocity Verlet, in the frame of the centre of mass, with the forces of advance()
/// and friction_step().
template <class Contact>
Found run(const Impact<Contact> &impact) {
  Found found;
  const double m_eff = effective_mass(impact.mi, impact.mj);
  const double r_eff = effective_radius(impact.ri, impact.rj), reach = impact.ri + impact.rj;
  const double Ii = 0.4 * impact.mi * impact.ri * impact.ri, Ij = 0.4 * impact.mj * impact.rj * impact.rj;
  auto law = impact.contact.law(m_eff, r_eff, 0.0);
  const double dt = impact.dt;
  Vec3 v = impact.v, wi = impact.wi, wj = impact.wj, normal{1.0, 0.0, 0.0};
  Vec3 apart = sum(scaled(reach, normal), -impact.onset * dt, v); // x_i - x_j
  const auto kinetic = [&] { return 0.5 * (m_eff * squared(v) + Ii * squared(wi) + Ij * squared(wj)); };
  found.before = kinetic();
  ContactState state;
  verlet::ContactFriction<Contact> friction(impact.contact, impact.friction, r_eff);
  double stored = 0.0;
  Vec3 force{}, torque_i{}, torque_j{};
  double shift = 0.0;
  bool touched = false;
  const auto kick = [&](const Vec3 &acting) {
    v = sum(v, 0.5 * dt / m_eff, acting);
    wi = sum(wi, 0.5 * dt / Ii, torque_i);
    wj = sum(wj, 0.5 * dt / Ij, torque_j);
  };
  for (bool over = false; !over;) {
    const Vec3 v_before = v;
    kick(force);
    apart = sum(apart, dt, sum(v, 0.5 * dt / m_eff * shift, normal)); // see StepResult::shift
    const double distance = std::sqrt(squared(apart));
    normal = scaled(1.0 / distance, apart);
    const StepMotion motion{reach - distance, -dot(v, normal), -dot(v_before, normal), dt};
    // The dashpot of one contact alone need not be solved for together with others.
    const StepResult push =
        impact.stock ? advance_stock(law, motion, state) : advance(law, motion, state, {m_eff});
    const double arm_i = impact.ri - 0.5 * motion.overlap, arm_j = impact.rj - 0.5 * motion.overlap;
    Vec3 rub{}, closing{};
    if (motion.overlap > 0.0) {
      touched = true;
      const Vec3 slip =
          slip_velocity_of_step(v, normal_in_middle(apart, v, dt), normal, sum(scaled(arm_i, wi), arm_j, wj));
      const FrictionStep now =
          friction.step(motion, push.force, 0.5 * law.dashpot(motion.overlap), normal, slip);
      judge(now, impact.friction * std::max(0.0, push.force), stored, -dt * dot(now.force, slip), found);
      rub = now.force;
      closing = friction.closing(push, now);
      stored = now.stored;
    } else {
      friction.end();
      stored = 0.0;
    }
    const auto turn = [&](const Vec3 &friction_force) {
      const Vec3 moment = cross(normal, friction_force);
      torque_i = scaled(-arm_i, moment);
      torque_j = scaled(-arm_j, moment);
    };
    turn(closing);
    kick(sum(closing, push.kick, normal));
    turn(rub);
    law.remember(motion.overlap);
    force = sum(rub, push.force, normal);
    shift = push.shift;
    const bool free = motion.overlap <= 0.0 || (law.transition() == Transition::B && push.force == 0.0);
    over = touched && free && dot(v, normal) > 0.0;
  }
  found.gain = kinetic() - found.before;
  return found;
}

class Draw {
public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double decades(double low, double high) { return std::pow(10.0, between(low, high)); }
  bool one_in(int n) { return std::uniform_int_distribution<int>(1, n)(random_) == 1; }

private:
  std::mt19937 random_;
};

/// A contact so stiff that an undamped head-on impact reaches the overlap.
template <class Contact>
Contact contact_of_overlap(double overlap, double m_eff, double r_eff, double speed, Draw &draw) {
  const double share = draw.between(1.0 / 6.0, 0.25); // of G* in E* for a Poisson's ratio of 0.5 to 0
  Contact one = drumlin::test::sample_contact<Contact>(1.0, share);
  one.damping = 0.0;
  const double energy = one.law(m_eff, r_eff, 0.0).energy(overlap);
  return drumlin::test::sample_contact<Contact>(0.5 * m_eff * speed * speed / energy, share);
}

/// Half of the step, s, that fix guard allows: of a spring and a dashpot in the scheme of the engine.
double half_of_longest_step(double stiffness, double damping, double mass) {
  return 0.5 * (std::sqrt(damping * damping + 4.0 * stiffness * mass) - damping) / stiffness;
}

/// Angles from the normal from 0 to 89 degrees, spins up to ten times the speed, D and mu from 0 to 10, size
/// ratios from 1 to 100, overlaps from 1e-4 to 1e-2 of the smaller radius, 20 to 200 steps in a contact or
/// more where stability needs them.
template <class Contact>
Impact<Contact> random_impact(Draw &draw) {
  Impact<Contact> impact{};
  const double small = 0.01, large = small * draw.decades(0.0, 2.0), speed = 1.0;
  const bool first = draw.one_in(2);
  impact.ri = first ? small : large;
  impact.rj = first ? large : small;
  const auto mass = [](double r) { return 1e4 * r * r * r; };
  impact.mi = mass(impact.ri);
  impact.mj = mass(impact.rj);
  const double angle = draw.between(0.0, 89.0) / 180.0 * std::acos(-1.0);
  impact.normal_speed = speed * std::cos(angle);
  impact.v = {-impact.normal_speed, speed * std::sin(angle), 0.0};
  const auto spin = [&](double r) {
    const double w = draw.one_in(3) ? 0.0 : draw.decades(-2.0, 1.0) * speed / r;
    return Vec3{draw.between(-w, w), draw.between(-w, w), draw.between(-w, w)};
  };
  impact.wi = spin(impact.ri);
  impact.wj = spin(impact.rj);
  const double m_eff = effective_mass(impact.mi, impact.mj);
  const double r_eff = effective_radius(impact.ri, impact.rj);
  const double overlap = small * draw.decades(-4.0, -2.0);
  impact.contact = contact_of_overlap<Contact>(overlap, m_eff, r_eff, impact.normal_speed, draw);
  impact.contact.damping_kind = Damping::ratio;
  impact.contact.damping = draw.one_in(3) ? 0.0 : draw.between(0.0, 10.0);
  // Under A a dashpot can stop a ball inside of an overlap that a contact keeps.
  impact.contact.transition = draw.one_in(3) && !Contact::remembers ? Transition::A : Transition::B;
  impact.friction = draw.one_in(10) ? 0.0 : draw.between(0.0, 10.0);
  impact.stock = draw.one_in(2);
  impact.onset = draw.between(0.0, 1.0);
  const auto law = impact.contact.law(m_eff, r_eff, 0.0);
  const double c = law.dashpot(overlap);
  impact.contact_time = 3.0 * overlap / impact.normal_speed;
  impact.dt =
      std::min({impact.contact_time / draw.decades(1.3, 2.3),
                half_of_longest_step(impact.contact.tangential(overlap, r_eff), 0.5 * c, 2.0 / 7.0 * m_eff),
                half_of_longest_step(law.stiffest(overlap), impact.stock ? c : 0.0, m_eff)});
  return impact;
}

/// Whether a share of the kinetic energy is more than the energy error that the impact without friction and
/// dashpot has in such steps, over the kinetic energy of its approach: the largest over the phase of the make
/// in its step, and over steps up to 10 % longer. (With a whole number of steps in a contact, make and break
/// have one phase, and their errors cancel.)
template <class Contact>
bool exceeds_elastic_error(Impact<Contact> impact, double share) {
  impact.friction = impact.contact.damping = 0.0;
  const double energy =
      0.5 * effective_mass(impact.mi, impact.mj) * impact.normal_speed * impact.normal_speed;
  const double dt = impact.dt;
  for (const double longer : {1.0, 1.05, 1.02, 1.08, 1.03, 1.1})
    for (const double phase : {0.0, 0.5, 0.25, 0.75, 0.1, 0.9, 0.4, 0.6}) {
      impact.dt = longer * dt;
      impact.onset = phase;
      if (std::fabs(run(impact).gain) >= share * energy) return false;
    }
  return true;
}

template <class Contact>
class RandomImpacts : public testing::Test {};
template <class List>
struct AsTypes;
template <class... Contact>
struct AsTypes<std::tuple<Contact...>> {
  using type = testing::Types<Contact...>;
};
struct NameOfLaw {
  template <class Contact>
  static std::string GetName(int /* of the type */) {
    const std::string name = Contact::name;
    return name.substr(0, name.find('/'));
  }
};
TYPED_TEST_SUITE(RandomImpacts, AsTypes<drumlin::Laws>::type, NameOfLaw);

TYPED_TEST(RandomImpacts, KeepTheLimitOfFrictionAndMakeNoEnergy) {
  const auto given = [](const char *name, long usual) {
    const char *text = std::getenv(name); // NOLINT(concurrency-mt-unsafe): one thread
    return text != nullptr ? std::atol(text) : usual;
  };
  const long count = given("DRUMLIN_IMPACTS", 1000);
  Draw draw(static_cast<unsigned>(given("DRUMLIN_SEED", 20261124)));
  double over_limit = 0.0, made_energy = 0.0;
  long steps = 0, sliding = 0, gained = 0;
  for (long n = 0; n < count; ++n) {
    const Impact<TypeParam> impact = random_impact<TypeParam>(draw);
    const Found found = run(impact);
    over_limit = std::max(over_limit, found.over_limit);
    made_energy = std::max(made_energy, found.made_energy);
    steps += found.steps;
    sliding += found.sliding;
    const double share = found.gain / found.before;
    constexpr double rounding = 1e-11;
    if (share <= rounding) continue;
    ++gained;
    EXPECT_FALSE(exceeds_elastic_error(impact, share))
        << "impact " << n << ": D " << impact.contact.damping << ", mu " << impact.friction
        << (impact.stock ? ", stock" : ", second") << ", radii " << impact.ri << ' ' << impact.rj << ", gain "
        << share;
  }
  EXPECT_LE(over_limit, 1e-14);
  EXPECT_LE(made_energy, 1e-13);
  EXPECT_GT(sliding, steps / 10);
  EXPECT_LT(sliding, steps - steps / 100);
  this->RecordProperty("impacts", std::to_string(count) + ", steps " + std::to_string(steps) + ", gained " +
                                      std::to_string(gained));
}

} // namespace
