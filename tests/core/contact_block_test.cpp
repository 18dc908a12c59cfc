/// The forces of a block of contacts have the same bits as those of its contacts one by one.
#include "tests/core/law_samples.h"
#include "physics/scheme/contact_block.h"

namespace {

using namespace drumlin::physics;

/// Coefficients as the adapters have them.
template <class Contact>
struct Coefficients {
  Contact contact;
  double ct, mu, mu_r;
  Friction tangential(double kt, double c, Cap cap) const { return {kt, ct + 0.1 * c, mu, cap}; }
  Rolling rolling_resistance(double kt, double radius, Resisted resisted) const {
    return rolling_of(kt, mu_r, radius, resisted);
  }
};

template <class Contact>
Contact contact_of_stiffness() { // forces of some 10 N at the overlaps of these blocks
  return drumlin::test::sample_contact<Contact>(Contact::depends_on_radius ? 1e7 : 1e5);
}

template <class Contact>
Coefficients<Contact> coefficients(Transition transition, Damping kind) {
  Coefficients<Contact> all{contact_of_stiffness<Contact>(), 0.3, 0.4, 0.1};
  all.contact.damping = 0.4;
  all.contact.damping_kind = kind;
  all.contact.transition = transition;
  return all;
}

/// ContactSet that stick, slide, pull, touch barely, and such that have just been apart.
std::unique_ptr<ContactBlock> random_block(std::mt19937 &random) {
  auto b = std::make_unique<ContactBlock>();
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const auto vector = [&](double size) {
    return Vec3{size * any(random), size * any(random), size * any(random)};
  };
  for (int n = 0; n < block_size; ++n) {
    const Vec3 direction = vector(1.0);
    b->ri[n] = 0.02 + 0.01 * any(random);
    b->rj[n] = 0.02 + 0.01 * any(random);
    const double reach = b->ri[n] + b->rj[n];
    const double distance = reach * (1.0 - 0.005 * (1.0 + any(random)));
    b->separation.set(n, scaled(distance / std::sqrt(dot(direction, direction)), direction));
    b->squared[n] = dot(b->separation[n], b->separation[n]);
    b->m_eff[n] = 0.05 + 0.02 * any(random);
    b->velocity.set(n, vector(0.2));
    b->velocity_before.set(n, sum(b->velocity[n], 1.0, vector(0.02)));
    b->wi.set(n, vector(3.0));
    b->wj.set(n, vector(3.0));
    b->damping_over_mass[n] = 3e3 * (1.0 + any(random));
    b->force_before[n] = 10.0 * any(random);
    b->memory_before[n] = (reach - distance) * (n % 4 == 0 ? 0.0 : 1.0 + any(random));
    b->spring.set(n, vector(1e-4));
    b->stored_stiffness[n] = n % 3 == 0 ? 0.0 : 3e4 * (1.0 + 0.9 * any(random));
    b->rolling_spring.set(n, vector(1e-3));
  }
  return b;
}

void expect_same(double a, double b, const char *what, int n) {
  std::uint64_t x = 0, y = 0;
  std::memcpy(&x, &a, sizeof x);
  std::memcpy(&y, &b, sizeof y);
  EXPECT_EQ(x, y) << what << " of contact " << n << ": " << a << " and " << b;
}
void expect_same(const Vec3 &a, const Vec3 &b, const char *what, int n) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    expect_same(a[axis], b[axis], what, n);
}

constexpr double dt = 1e-4;

/// The normal force of contact n of a block that has been computed, from that contact alone. \param rare
/// whether the block has said that the contact needs more than that
template <bool stepped, Slip slip, class Contact>
void expect_normal_force(const ContactBlock &b, int n, const Contact &parameters, bool rare) {
  const Vec3 normal = scaled(1.0 / std::sqrt(b.squared[n]), b.separation[n]);
  const double overlap = b.ri[n] + b.rj[n] - std::sqrt(b.squared[n]);
  const double rate_half = -dot(b.velocity[n], normal);
  auto law = parameters.law(b.m_eff[n], effective_radius(b.ri[n], b.rj[n]), b.memory_before[n]);
  expect_same(b.normal[n], normal, "normal", n);
  const Vec3 turning = sum(scaled(b.arm_i[n], b.wi[n]), b.arm_j[n], b.wj[n]);
  expect_same(b.slip[n],
              slip == Slip::in_middle
                  ? slip_velocity_of_step(b.velocity[n], normal_in_middle(b.separation[n], b.velocity[n], dt),
                                          normal, turning)
                  : slip_velocity(b.velocity[n], normal, turning),
              "slip", n);
  ContactState state{b.force_before[n], true};
  if constexpr (stepped) {
    const StepMotion motion{overlap, rate_half, -dot(b.velocity_before[n], normal), dt};
    const StepContext context{b.m_eff[n], b.damping_over_mass[n], false};
    const bool lost = lost_its_force(state.force, going_on(law, motion, state.force, b.m_eff[n]));
    EXPECT_EQ(rare, lost || !goes_on(law, motion, state, context)) << n;
    const StepResult result = advance(law, motion, state, context);
    expect_same(b.force[n], state.force, "force", n);
    if (!rare) expect_same(b.push[n], result.kick, "kick", n);
  } else {
    const StepResult result = advance_stock(law, {overlap, rate_half, rate_half, dt}, state);
    expect_same(b.push[n], result.kick, "kick", n);
    expect_same(b.force[n], state.force, "force", n);
  }
  if constexpr (Contact::remembers) {
    law.remember(overlap);
    expect_same(b.memory[n], law.memory(), "memory", n);
  }
}

/// The tangential stiffness of contact n in the step.
template <class Contact>
double stiffness_of(const ContactBlock &b, int n, const Contact &contact) {
  const double at =
      Contact::tangential_varies ? overlap_of_spring(b.overlap[n], b.rate_half[n], dt) : b.overlap[n];
  return contact.tangential(at, effective_radius(b.ri[n], b.rj[n]));
}

/// Friction of contact n, from the spring that it had before.
template <bool springs, Cap cap, class Contact>
void expect_friction(const ContactBlock &b, int n, const Coefficients<Contact> &all,
                     const ContactBlock &before) {
  const double r_eff = effective_radius(b.ri[n], b.rj[n]);
  const double kt = stiffness_of(b, n, all.contact);
  const Friction friction =
      all.tangential(kt, all.contact.law(b.m_eff[n], r_eff, 0.0).dashpot(b.overlap[n]), cap);
  const double kept = Contact::tangential_varies ? kept_spring(before.stored_stiffness[n], kt) : 1.0;
  const FrictionStep step = springs ? friction_step(friction, b.force[n], b.normal[n], b.slip[n],
                                                    scaled(kept, before.spring[n]), dt)
                                    : friction_step_without_history(friction, b.force[n], b.slip[n], dt);
  expect_same(b.tangential_force[n], step.force, "friction", n);
  if (springs) expect_same(b.spring[n], step.spring, "spring", n);
  const Vec3 moment = cross(b.normal[n], step.force);
  expect_same(b.torque_i[n], scaled(-b.arm_i[n], moment), "torque on ball i", n);
  expect_same(b.torque_j[n], scaled(-b.arm_j[n], moment), "torque on ball j", n);
  expect_same(b.total_force[n], sum(step.force, b.push[n], b.normal[n]), "total", n);
}

/// Rolling resistance of contact n, from the spring that it had before.
template <class Contact>
void expect_rolling(const ContactBlock &b, int n, const Coefficients<Contact> &all,
                    const ContactBlock &before) {
  const double kt = stiffness_of(b, n, all.contact);
  const double kept = Contact::tangential_varies ? kept_torque(before.stored_stiffness[n], kt) : 1.0;
  const Rolling resistance =
      all.rolling_resistance(kt, effective_radius(b.ri[n], b.rj[n]), Resisted::rolling);
  const RollingStep step = rolling_step(resistance, b.force[n], b.normal[n], sum(b.wi[n], -1.0, b.wj[n]),
                                        scaled(kept, before.rolling_spring[n]), dt);
  expect_same(b.kt[n], kt, "tangential stiffness", n);
  if (Contact::tangential_varies) expect_same(b.stored_stiffness[n], kt, "stored stiffness", n);
  expect_same(b.rolling[n], step.torque, "rolling", n);
  expect_same(b.rolling_spring[n], step.spring, "rolling spring", n);
}

template <class Contact, bool stepped, Slip slip, bool springs, Cap cap>
void expect_block_as_contacts() {
  std::mt19937 random(7);
  for (const Transition transition : {Transition::A, Transition::B})
    for (const Damping kind : {Damping::coefficient, Damping::ratio})
      for (const int end : {1, 2, 3, 7, 31, 32}) {
        const auto all = coefficients<Contact>(transition, kind);
        const auto before = random_block(random);
        const auto b = std::make_unique<ContactBlock>(*before);
        const int first = end > 4 ? 2 : 0;
        const ContactSet rare = compute_normal_forces<stepped, slip>(*b, first, end, all.contact, dt);
        compute_tangential_stiffness<springs, true, true>(*b, first, end, all.contact, dt);
        compute_friction<springs, cap>(*b, first, end, all, dt);
        compute_rolling(*b, first, end, all, dt);
        for (int n = first; n < end; ++n) {
          expect_normal_force<stepped, slip>(*b, n, all.contact, (rare >> n & 1) != 0);
          expect_friction<springs, cap>(*b, n, all, *before);
          expect_rolling(*b, n, all, *before);
        }
      }
}

template <class Contact>
void expect_all_blocks() {
  expect_block_as_contacts<Contact, false, Slip::at_end, true, Cap::total>();
  expect_block_as_contacts<Contact, false, Slip::in_middle, true, Cap::coulomb>();
  expect_block_as_contacts<Contact, true, Slip::in_middle, true, Cap::coulomb>();
  expect_block_as_contacts<Contact, true, Slip::at_end, true, Cap::spring>();
  expect_block_as_contacts<Contact, true, Slip::at_end, false, Cap::total>();
}

TEST(ContactBlock, HasTheBitsOfItsContactsOneByOne) {
  drumlin::for_each_law([](auto law) { expect_all_blocks<typename decltype(law)::type>(); });
}

// A wall differs from a ball that does not turn by the effective radius alone, which the linear law needs for
// rolling resistance only.
TEST(ContactBlock, AtAWallHasTheBitsOfABallThatDoesNotTurn) {
  std::mt19937 random(11);
  const auto all = coefficients<LinearContact>(Transition::B, Damping::ratio);
  const auto balls = random_block(random);
  for (int n = 0; n < block_size; ++n)
    balls->wj.set(n, {});
  const auto wall = std::make_unique<ContactBlock>(*balls);
  const ContactSet rare =
      compute_normal_forces<true, Slip::in_middle>(*balls, 0, block_size, all.contact, dt);
  wall->normal = balls->normal;
  wall->overlap = balls->overlap;
  for (int n = 0; n < block_size; ++n)
    wall->normal_in_middle.set(n, normal_in_middle(wall->separation[n], wall->velocity[n], dt));
  const auto compute = [&](ContactBlock &b) {
    compute_tangential_stiffness<true, true, true>(b, 0, block_size, all.contact, dt);
    compute_friction<true, Cap::coulomb>(b, 0, block_size, all, dt);
  };
  EXPECT_EQ(
      (compute_normal_forces<true, Slip::in_middle, Partner::wall>(*wall, 0, block_size, all.contact, dt)),
      rare);
  compute(*balls);
  compute(*wall);
  const auto before = std::make_unique<ContactBlock>(*wall);
  compute_rolling<Partner::wall>(*wall, 0, block_size, all, dt);
  for (int n = 0; n < block_size; ++n) {
    expect_same(wall->force[n], balls->force[n], "force", n);
    expect_same(wall->push[n], balls->push[n], "kick", n);
    expect_same(wall->total_force[n], balls->total_force[n], "total", n);
    expect_same(wall->torque_i[n], balls->torque_i[n], "torque on the ball", n);
    EXPECT_EQ(wall->torque_j[n], Vec3{}) << n;
    const RollingStep step =
        rolling_step(all.rolling_resistance(wall->kt[n], wall->ri[n], Resisted::rolling), wall->force[n],
                     wall->normal[n], wall->wi[n], before->rolling_spring[n], dt);
    expect_same(wall->rolling[n], step.torque, "rolling", n);
  }
}

} // namespace
