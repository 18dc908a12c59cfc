// A drum with two ends by CVODE with root finding, contact by contact: it shares no code with the solver of
// the tools, but their description of the machine.
#pragma once

#include "tests/support/ode.h"
#include "chain/two_ends.h"

namespace drumlin::test {

using post::AxleLink, post::ChainParameters, post::Transition, post::TwoEnds, post::TwoEndsState;

/// One motion of it.
class TwoEndsOracle {
public:
  /// k and c of a contact at a time.
  using Soil = std::function<AxleLink(std::size_t contact, double time)>;

  /// \param soil where the contacts change with time, smoothly until meet() is called
  TwoEndsOracle(const TwoEnds &machine, const TwoEndsState &start, Soil soil = {})
      : m_(machine), soil_(std::move(soil)), phase_(machine.contacts.size(), free),
        y_(start.data(), start.data() + 8),
        ode_([this](double t, const oracle::State &y, oracle::State &rates) { rate(t, y, rates); }, 0.0, y_,
             scale(machine)) {
    for (std::size_t j = 0; j < phase_.size(); ++j)
      if (gap(j, y_) < 0.0) phase_[j] = law(j, 0.0, y_) > 0.0 || !b() ? acting : silent;
  }

  /// Replaces the contacts, as where the roller comes to another soil.
  void meet(Soil soil) {
    soil_ = std::move(soil);
    const oracle::State y = ode_.state();
    for (std::size_t j = 0; j < phase_.size(); ++j) {
      if (!b() || phase_[j] == free || gap(j, y) >= 0.0) continue;
      const Phase next = law(j, ode_.time(), y) > 0.0 ? acting : silent;
      makes_ += next == acting && phase_[j] == silent;
      breaks_ += next == silent && phase_[j] == acting;
      phase_[j] = next;
    }
    ode_.restart(y);
  }

  /// State at a time.
  const oracle::State &at(double time) {
    while (ode_.time() < time) {
      // Of each contact: its overlap, and its law.
      std::vector<oracle::Event> events;
      std::vector<std::pair<std::size_t, bool>> which;
      for (std::size_t j = 0; j < phase_.size(); ++j) {
        const bool by_law = b() && phase_[j] != free;
        if (!by_law || phase_[j] == silent) {
          events.emplace_back([this, j](double, const oracle::State &y) { return gap(j, y); });
          which.emplace_back(j, false);
        }
        if (by_law) {
          events.emplace_back([this, j](double t, const oracle::State &y) { return law(j, t, y); });
          which.emplace_back(j, true);
        }
      }
      const int found = ode_.advance(time, events);
      if (found < 0) break;
      change(which[static_cast<std::size_t>(found)].first, which[static_cast<std::size_t>(found)].second);
    }
    return ode_.state();
  }
  /// Rates of the state at the present time.
  oracle::State rates() const {
    oracle::State rates(8);
    rate(ode_.time(), ode_.state(), rates);
    return rates;
  }
  int makes() const { return makes_; }
  int breaks() const { return breaks_; }
  bool left_lost() const { return lost_[0]; }
  bool right_lost() const { return lost_[1]; }

private:
  enum Phase { free, acting, silent };

  static oracle::State scale(const TwoEnds &m) {
    const double x =
        (m.chain.Fw + (m.chain.m2 + m.chain.m3) * m.chain.g) / (m.chain.m2 * m.chain.omega * m.chain.omega);
    oracle::State scale(8, x);
    for (std::size_t i = 4; i < 8; ++i)
      scale[i] = x * m.chain.omega;
    return scale;
  }
  bool b() const { return m_.chain.transition == Transition::B; }
  bool damped(std::size_t j) const { return (soil_ ? soil_(j, ode_.time()) : m_.contacts[j]).c > 0.0; }
  double gap(std::size_t j, const oracle::State &y) const { return y[0] + m_.contacts[j].y * y[2]; }
  double gap_rate(std::size_t j, const oracle::State &y) const { return y[4] + m_.contacts[j].y * y[6]; }
  double law(std::size_t j, double t, const oracle::State &y) const {
    const AxleLink link = soil_ ? soil_(j, t) : m_.contacts[j];
    return -link.k * gap(j, y) - link.c * gap_rate(j, y);
  }
  void rate(double t, const oracle::State &y, oracle::State &rates) const {
    const ChainParameters &p = m_.chain;
    const double push = p.Fw * std::sin(p.omega * t);
    double drum = -p.m2 * p.g - push, tilt = -m_.exciter * push, frame = -p.m3 * p.g, frame_tilt = 0.0;
    for (std::size_t j = 0; j < m_.contacts.size(); ++j)
      if (phase_[j] == acting) {
        drum += law(j, t, y);
        tilt += m_.contacts[j].y * law(j, t, y);
      }
    for (const AxleLink &bond : m_.bonds) {
      const double force =
          bond.k * (y[1] - y[0] + bond.y * (y[3] - y[2])) + bond.c * (y[5] - y[4] + bond.y * (y[7] - y[6]));
      drum += force;
      tilt += bond.y * force;
      frame -= force;
      frame_tilt -= bond.y * force;
    }
    for (std::size_t i = 0; i < 4; ++i)
      rates[i] = y[i + 4];
    rates[4] = drum / p.m2;
    rates[5] = frame / p.m3;
    rates[6] = tilt / m_.drum_inertia;
    rates[7] = frame_tilt / m_.frame_inertia;
  }
  // CVODE also reports a zero that the motion has just left, and one of the way back: only a function on its
  // way out of the phase counts.
  void change(std::size_t j, bool by_law) {
    const oracle::State y = ode_.state();
    const double t = ode_.time(), h = 1e-8 / m_.chain.omega; // short against all motion
    oracle::State rates(8), soon = y;
    rate(t, y, rates);
    for (std::size_t i = 0; i < soon.size(); ++i)
      soon[i] += h * rates[i];
    const double gap_speed = gap_rate(j, y);
    const double law_speed = law(j, t + h, soon) - law(j, t, y);
    Phase &phase = phase_[j];
    const Phase before = phase;
    if (!by_law && (phase == free ? gap_speed < 0.0 : gap_speed > 0.0))
      phase = phase == free ? acting : free;
    else if (by_law && phase == acting && law_speed < 0.0)
      phase = gap(j, y) < 0.0 && damped(j) ? silent : free;
    else if (by_law && phase == silent && law_speed > 0.0)
      phase = acting;
    makes_ += phase == acting && before != acting;
    if (before == acting && phase != acting) {
      ++breaks_;
      lost_[m_.contacts[j].y > 0.0] = true;
    }
    ode_.restart(y);
  }

  const TwoEnds &m_;
  Soil soil_;
  std::vector<Phase> phase_;
  oracle::State y_;
  oracle::Ode ode_;
  int makes_ = 0, breaks_ = 0;
  std::array<bool, 2> lost_ = {false, false};
};

} // namespace drumlin::test
