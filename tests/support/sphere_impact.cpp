#include "tests/support/sphere_impact.h"
#include "chain/analysis.h"

namespace drumlin::test {

namespace {

/// Masses, radii and law of a contact. Sphere 2, or the floor, has no inverse mass where it is fixed.
struct Contact {
  explicit Contact(const SphereSetup &s)
      : pair(s.pair()), r1(s.r1), r2(pair ? s.r2 : 0.0), inverse1(1.0 / s.m1),
        inverse2(pair ? 1.0 / s.m2 : 0.0), m_eff(s.m_eff()), approach(s.approach()), hertz(s.k == 0.0),
        k(s.stiffness()), kt(hertz ? 8.0 * s.G_eff * std::sqrt(s.r_eff()) : s.kt) {}

  /// Velocity of the surface of sphere 1 over that of sphere 2, at the full radii.
  double slip(double vx, double spin, double vx2, double spin2) const {
    return vx - r1 * spin - vx2 - r2 * spin2;
  }
  double spring(double d) const { return hertz ? k * d * std::sqrt(d) : k * d; }
  double tangential(double d) const { return hertz ? kt * std::sqrt(d) : kt; }

  bool pair;
  double r1, r2, inverse1, inverse2, m_eff, approach;
  bool hertz;
  double k, kt;
};

/// D of a coefficient of restitution under B: the closed form of the linear law, which holds for both laws.
double damping_ratio(double e) {
  const auto restitution = [](double D) {
    post::ImpactParameters p;
    p.damping_ratio = D;
    return -post::impact_state(p, post::impact_duration(p)).rate;
  };
  double low = 0.0, high = 20.0;
  for (int i = 0; i < 100; ++i)
    (restitution(0.5 * (low + high)) > e ? low : high) = 0.5 * (low + high);
  return e < 1.0 ? 0.5 * (low + high) : 0.0;
}

/// What changes in an impact.
struct Motion {
  double overlap = 0.0, rate = 0.0;
  double vx, spin, vx2, spin2;
  double spring = 0.0;    ///< force of the tangential spring, N
  double stiffness = 0.0; ///< and its stiffness, N/m
};

/// Friction of a step on sphere 1, along -x: the spring of stiffness `kt` and the dashpot `ct`, limited to
/// `most`.
double friction(Motion &m, double slip, double kt, double ct, double most, double dt) {
  const double before = m.spring;
  double pull = before + kt * dt * slip + ct * slip;
  if (std::fabs(pull) <= most) {
    m.spring = before + kt * dt * slip;
    return pull;
  }
  pull = std::copysign(most, pull);
  const double share = ct / (kt * dt);
  m.spring = (pull + share * before) / (1.0 + share);
  return pull;
}

} // namespace

double SphereSetup::stiffness() const { return k > 0.0 ? k : 4.0 / 3.0 * E_eff * std::sqrt(r_eff()); }

double SphereSetup::overlap() const {
  const double square = m_eff() * approach() * approach();
  return k > 0.0 ? std::sqrt(square / k) : std::pow(1.25 * square / stiffness(), 0.4);
}

double SphereSetup::contact_time() const {
  return k > 0.0 ? M_PI * std::sqrt(m_eff() / k) : 2.94 * overlap() / approach();
}

bool slides_throughout(const SphereSetup &setup) {
  const Contact c(setup);
  const double impulse = setup.mu * (1.0 + setup.e) * c.m_eff * c.approach;
  const double before =
      c.slip(setup.vt, setup.spin, setup.velocity_ratio * setup.vt, setup.spin_ratio * setup.spin);
  return std::fabs(before) > 1.05 * 3.5 * impulse / c.m_eff;
}

AfterImpact sliding_impact(const SphereSetup &setup) {
  const Contact c(setup);
  const double vx2 = setup.velocity_ratio * setup.vt, spin2 = setup.spin_ratio * setup.spin;
  const double normal = (1.0 + setup.e) * c.m_eff * c.approach;
  const double J = std::copysign(setup.mu * normal, c.slip(setup.vt, setup.spin, vx2, spin2));
  // Mean of d, weighted with the force, over the largest d.
  const double mean = c.hertz ? 0.5 * std::tgamma(1.4) * std::tgamma(0.5) / std::tgamma(1.9) : 0.25 * M_PI;
  const auto turned = [&](double r, double inverse) {
    return r > 0.0 ? J * inverse * (r - 0.5 * mean * setup.overlap()) / (0.4 * r * r) : 0.0;
  };
  return {setup.vt - J * c.inverse1,
          -setup.vn + normal * c.inverse1,
          setup.spin + turned(c.r1, c.inverse1),
          vx2 + J * c.inverse2,
          -setup.velocity_ratio * setup.vn - normal * c.inverse2,
          spin2 + turned(c.r2, c.inverse2)};
}

AfterImpact integrated_impact(const SphereSetup &setup) {
  const Contact c(setup);
  const double D = damping_ratio(setup.e);
  const double damping = 2.0 * D * std::sqrt((c.hertz ? 1.25 : 1.0) * c.k * c.m_eff);
  const auto dashpot = [&](double d) { return c.hertz ? damping * std::sqrt(std::sqrt(d)) : damping; };
  const auto force = [&](double d, double rate) { return d > 0.0 ? c.spring(d) + dashpot(d) * rate : 0.0; };
  constexpr int fine = 200000,
                first = 1000; // the first steps are smaller, since forces begin like roots of time
  const double longest = setup.contact_time() / fine;
  Motion m;
  m.rate = c.approach;
  m.vx = setup.vt, m.spin = setup.spin;
  m.vx2 = setup.velocity_ratio * setup.vt, m.spin2 = setup.spin_ratio * setup.spin;
  double impulse = 0.0;
  for (int step = 1; step < 20 * fine; ++step) {
    const double dt = longest * std::min(1.0, static_cast<double>(step) / first);
    const double d = m.overlap + 0.5 * dt * m.rate;
    const double rate = m.rate - 0.5 * dt * force(m.overlap, m.rate) / c.m_eff;
    const double F = force(d, rate);
    if (F <= 0.0) break;
    const double kt = c.tangential(d);
    if (kt < m.stiffness) m.spring *= kt / m.stiffness; // its length is kept; while kt grows, its force
    m.stiffness = kt;
    const double a1 = c.r1 - 0.5 * d, a2 = c.pair ? c.r2 - 0.5 * d : 0.0;
    const double slip = m.vx - a1 * m.spin - m.vx2 - a2 * m.spin2;
    const double ct = setup.ct < 0.0 ? 0.5 * dashpot(d) : setup.ct;
    const double J = dt * friction(m, slip, kt, ct, setup.mu * F, dt);
    m.vx -= J * c.inverse1;
    m.spin += J * a1 * c.inverse1 / (0.4 * c.r1 * c.r1);
    m.vx2 += J * c.inverse2;
    if (c.pair) m.spin2 += J * a2 * c.inverse2 / (0.4 * c.r2 * c.r2);
    m.overlap += dt * rate;
    m.rate -= dt * F / c.m_eff;
    impulse += dt * F;
  }
  return {m.vx,
          -setup.vn + impulse * c.inverse1,
          m.spin,
          m.vx2,
          -setup.velocity_ratio * setup.vn - impulse * c.inverse2,
          m.spin2};
}

} // namespace drumlin::test
