// Energy of a drum with two ends, and where it comes from, along a motion of the tools' solver.
#pragma once

#include "tests/support/prelude.h"
#include "chain/two_ends.h"

namespace drumlin::test {

/// Work and dissipation over pieces of the motion, by Gauss's formula. What the drive does on the contacts is
/// the integral of k' d^2/2 over time, also while an overlap has no force; steps of the soil are the
/// caller's.
class TwoEndsEnergy : public post::TwoEndsObserver {
public:
  explicit TwoEndsEnergy(const post::TwoEnds &machine) : m_(machine) {}

  double work = 0.0;       ///< of the exciter [J]
  double drive = 0.0;      ///< of what drives the roller over soil that changes [J]
  double dissipated = 0.0; ///< [J]
  double turned = 0.0;     ///< integral of the size of the exciter's power, a scale of errors [J]
  double start = 0.0;      ///< of the present cycle [s]

  /// At a time [s], for contacts that change.
  double stored(const post::TwoEndsState &y, double time = 0.0) const {
    const post::ChainParameters &p = m_.chain;
    double sum = 0.5 * (p.m2 * y[4] * y[4] + p.m3 * y[5] * y[5] + m_.drum_inertia * y[6] * y[6] +
                        m_.frame_inertia * y[7] * y[7]) +
                 p.g * (p.m2 * y[0] + p.m3 * y[1]);
    for (const AxleLink &bond : m_.bonds)
      sum += 0.5 * bond.k * std::pow(y[1] - y[0] + bond.y * (y[3] - y[2]), 2);
    for (const AxleLink &contact : m_.contacts_at(time))
      sum += 0.5 * contact.k * std::pow(std::min(0.0, y[0] + contact.y * y[2]), 2);
    return sum;
  }
  void piece(const post::ContactSet::Piece &piece, const post::ContactSet & /*set*/,
             std::uint32_t acting) override {
    constexpr std::array<double, 5> at = {0.0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                                          -0.9061798459386640};
    constexpr std::array<double, 5> weight = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                              0.2369268850561891, 0.2369268850561891};
    constexpr int parts = 4;
    for (int part = 0; part < parts; ++part)
      for (std::size_t i = 0; i < at.size(); ++i) {
        const double s = piece.end * (part + 0.5 * (1.0 + at[i])) / parts;
        add(piece.state(s), piece.begin + s * piece.length,
            0.5 * weight[i] * piece.end * piece.length / parts, acting);
      }
  }
  void change(const post::ContactChange & /*change*/) override {}

private:
  void add(const post::TwoEndsState &y, double time, double duration, std::uint32_t acting) {
    const post::ChainParameters &p = m_.chain;
    const double h = 1e-4 * p.period(), rise = y[4] + m_.exciter * y[6];
    work -= duration * p.Fw * std::sin(p.omega * time) * rise;
    turned += duration * std::fabs(p.Fw * rise);
    for (const AxleLink &bond : m_.bonds)
      dissipated += duration * bond.c * std::pow(y[5] - y[4] + bond.y * (y[7] - y[6]), 2);
    const std::vector<AxleLink> now = m_.contacts_at(start + time), soon = m_.contacts_at(start + time + h);
    for (std::size_t j = 0; j < now.size(); ++j) {
      const double rate = y[4] + now[j].y * y[6], z = y[0] + now[j].y * y[2];
      if (((acting >> j) & 1U) != 0)
        dissipated += duration * now[j].c * rate * rate;
      else if (z < 0.0) // an overlap without force: its spring is relaxed by the dashpot
        dissipated -= duration * now[j].k * z * rate;
      if (z < 0.0) drive += duration * (soon[j].k - now[j].k) / h * 0.5 * z * z;
    }
  }

  const post::TwoEnds &m_;
};

} // namespace drumlin::test
