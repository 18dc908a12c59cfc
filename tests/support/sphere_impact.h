// Impacts of one or two spheres, by closed form and by integrated equations of motion: what the study of
// benchmarks compares runs with.
#pragma once

namespace drumlin::test {

/// The parameters of a run of inputs/benchmarks/in.spheres. SI units.
struct SphereSetup {
  double k = 0.0, kt = 0.0;        ///< of the linear law; k = 0: the Hertz law
  double E_eff = 0.0, G_eff = 0.0; ///< of the Hertz law
  double ct = -1.0;                ///< negative: half of the normal dashpot
  double e = 1.0, mu = 0.0, mu_r = 0.0;
  double spheres = 1.0;
  double r1 = 0.0, r2 = 0.0, m1 = 0.0, m2 = 0.0;
  double vn = 0.0, vt = 0.0, spin = 0.0;         ///< of sphere 1: down, along x, about y
  double velocity_ratio = 0.0, spin_ratio = 0.0; ///< of sphere 2 over sphere 1
  double g = 0.0, slope = 0.0;                   ///< slope in degrees
  double time = 0.0;                             ///< length of the run

  bool pair() const { return spheres > 1.0; }
  double m_eff() const { return pair() ? m1 * m2 / (m1 + m2) : m1; }
  double r_eff() const { return pair() ? r1 * r2 / (r1 + r2) : r1; }
  double approach() const { return vn * (1.0 - velocity_ratio); }
  /// Normal force over overlap, or over overlap^(3/2).
  double stiffness() const;
  /// Largest overlap of an elastic impact, and its duration.
  double overlap() const;
  double contact_time() const;
};

/// State after an impact of sphere 1 on the floor or on sphere 2. SI units.
struct AfterImpact {
  double vx = 0.0, vz = 0.0, spin = 0.0;    ///< of sphere 1; up, along x, about y
  double vx2 = 0.0, vz2 = 0.0, spin2 = 0.0; ///< of sphere 2
};

/// Closed form of an impact in which the surfaces slide on each other all the time, so that friction is mu
/// times the normal force. The impulses are exact; of the lever arm of friction, r - d/2, the mean over an
/// elastic impact counts.
AfterImpact sliding_impact(const SphereSetup &setup);

/// Whether the surfaces slide during the whole impact, with a margin.
bool slides_throughout(const SphereSetup &setup);

/// Reference solution of any impact: the equations of motion with the law of normal.hooke or normal.hertz and
/// with friction (spring and dashpot in parallel, in series with a slider) integrated in steps of 5e-6 of an
/// undamped impact. The rotation of the normal during the impact is left out.
AfterImpact integrated_impact(const SphereSetup &setup);

} // namespace drumlin::test
