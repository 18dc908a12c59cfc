// The exact motion of a machine on its contacts with the soil. Between two makes or breaks of a contact
// (events) the machine is linear with a sinusoidal force, so that its state follows from the exponential of a
// matrix. The power series of the exponential is summed over intervals of time (pieces) so short that its
// remainder is below the rounding error; in each piece the motion is thus a polynomial in time, in which no
// event is overlooked, however short a contact is (chain/power_series). Since eigenvectors are not needed,
// repeated eigenvalues (critical damping) are no special case.
//
// A System is a machine on its soil: OneContact (chain/one_contact) and ManyContacts (chain/two_ends) have
// - State, Piece (a polynomial), Dynamics (what expands a State to a Piece), most_contacts;
// - chain() with masses, excitation, gravity and transition; contacts(), their number, and link(j, time), one
//   of them; height(state, link) and rise(state, link) of the drum above it; level(state), which makes the
//   height 0 after an event at 0, and just_after_event(value), the function of an event after it;
// - at_rest(), falling(speed): the states of a start;
// - Soil: the Dynamics at a time, and the functions whose zeros are the events of a Piece;
// - section(), drive_over(section): of a way, if it drives, and soil_may_change: within a section;
// - record(...): a row of a history.
#pragma once

#include "chain/exact_solution.h"
#include "chain/parameters.h"
#include "chain/power_series.h"
#include "files/axle_links.h"
#include "runs/chain_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Empty if the cycles of a solution have no more pieces; else one line that says how many cycles are
/// allowed.
std::string too_many_pieces(const ExactOptions &options, double per_cycle,
                            double most = ExactOptions::most_pieces);

/// Whether drum and soil are in contact. `flight`: no overlap. `clamped`: overlap without force, which exists
/// under B only, where the law would give tension: d > 0 and k d + c d' <= 0.
enum class ContactPhase { contact, flight, clamped };

/// Present state of a motion.
template <class System>
struct MotionOf {
  typename System::State state = System::State::Zero();
  long cycle = 0;    ///< number of completed cycles
  double time = 0.0; ///< since the start of the cycle [s]
  struct Contact {
    ContactPhase phase = ContactPhase::flight;
    int boundary = -1;    ///< index of the event condition that its last event left at zero; -1: none
    double changed = 0.0; ///< time of that event, or when its soil last changed, as `time` [s]
  };
  std::array<Contact, System::most_contacts> contacts{};

  /// Bit j set: contact j acts.
  std::uint32_t acting() const {
    std::uint32_t bits = 0;
    for (std::size_t j = 0; j < contacts.size(); ++j)
      if (contacts[j].phase == ContactPhase::contact) bits |= 1U << j;
    return bits;
  }
};

/// An event of a contact: it is made, it is broken, or drum and soil part after they overlapped without
/// force.
struct ContactChange {
  std::size_t contact = 0;
  ContactPhase from = ContactPhase::contact, to = ContactPhase::contact;
  double time = 0.0;         ///< since the start of the cycle [s]
  double overlap = 0.0;      ///< [m]
  double overlap_rate = 0.0; ///< [m/s]
  double force = 0.0;        ///< just after a make or just before a break [N]
  /// Damping coefficient that begins (positive) or ends to act with an overlap rate [N s/m]: c at a make with
  /// d = 0, -c at A's break. Where it is not 0, the force jumps by it times d', and with it the small
  /// difference of two motions (saltation): the one that comes later is without that force for a time of its
  /// overlap over d', so that its velocity differs by the jump times the difference of the overlaps, over the
  /// mass. Condition B's break, its make at zero force, and the end of an overlap without force do not jump.
  double jump = 0.0;
  bool make() const { return to == ContactPhase::contact; }
  bool broken() const { return from == ContactPhase::contact; }
};

/// Receives each piece, with the contacts that act in it, and each change of a contact, in the order of time.
template <class System>
class ObserverOf {
public:
  virtual ~ObserverOf() = default;
  virtual void piece(const typename System::Piece &piece, const typename System::Dynamics &dynamics,
                     std::uint32_t acting) = 0;
  virtual void change(const ContactChange &change) = 0;
};

/// Solves one machine on one soil.
template <class System>
class SolverOf {
public:
  using State = typename System::State;
  using Motion = MotionOf<System>;
  using Observer = ObserverOf<System>;

  explicit SolverOf(System system) : system_(std::move(system)) {}

  const System &system() const { return system_; }
  /// Static equilibrium, or an impact: touching the soil, moving down with this speed [m/s].
  Motion start(double impact_speed = 0.0) const;
  /// A motion at the start of a cycle: the phases of the contacts follow from the state.
  Motion start_at(const State &state) const;
  /// Continues the motion to the end of the cycle. Throws std::runtime_error if it has more than 100,000
  /// changes of contacts in it.
  void finish_cycle(Motion &motion, Observer *observer = nullptr) const;
  /// The same to a time within the cycle [s].
  void go_to(double end, Motion &motion, Observer *observer = nullptr) const;
  /// Changes the soil to that of the next section of the way. Its stiffness and damping may jump. Under B the
  /// contact then ends if the new law gives a tension, and begins if the surfaces overlap and the new law
  /// gives a compression.
  void drive_over(const WaySection &section, Motion &motion, Observer *observer = nullptr);

protected:
  System system_;

private:
  using Contact = typename Motion::Contact;
  struct Exit {
    int index = -1;
    double share = 2.0;
  };
  double time_of(const Motion &motion) const {
    return static_cast<double>(motion.cycle) * system_.chain().period() + motion.time;
  }
  bool under(Transition transition) const { return system_.chain().transition == transition; }
  Exit first_exit(const typename System::Soil &soil, const typename System::Piece &piece, std::size_t contact,
                  const Contact &now) const;
  ContactChange leave(Motion &motion, std::size_t contact, int exit) const;
};

template <class System>
typename SolverOf<System>::Motion SolverOf<System>::start(double impact_speed) const {
  const bool falls = impact_speed > 0.0;
  Motion motion = start_at(falls ? system_.falling(impact_speed) : system_.at_rest());
  // A contact that just touches begins if the drum moves down, or an exciter is about to push it down.
  if (falls || system_.chain().Fw > 0.0)
    for (std::size_t j = 0; j < system_.contacts(); ++j)
      if (System::height(motion.state, system_.link(j, 0.0)) == 0.0) leave(motion, j, 0);
  return motion;
}

template <class System>
typename SolverOf<System>::Motion SolverOf<System>::start_at(const State &state) const {
  Motion motion;
  motion.state = state;
  for (std::size_t j = 0; j < system_.contacts(); ++j) {
    const AxleLink link = system_.link(j, 0.0);
    const double z = System::height(state, link);
    if (z >= 0.0) continue;
    const bool pulls = link.k * z + link.c * System::rise(state, link) > 0.0;
    motion.contacts[j].phase = under(Transition::B) && pulls ? ContactPhase::clamped : ContactPhase::contact;
  }
  return motion;
}

// The first event that ends the present phase of a contact, at d = 0 (0) or at F = 0 (1). The function of
// each is negative before its event and positive after it.
template <class System>
typename SolverOf<System>::Exit SolverOf<System>::first_exit(const typename System::Soil &soil,
                                                             const typename System::Piece &piece,
                                                             std::size_t contact, const Contact &now) const {
  const bool by_force = under(Transition::B) && now.phase != ContactPhase::flight;
  const bool by_gap = now.phase != ContactPhase::contact || under(Transition::A);
  // Just after an event of this contact its function is zero but for rounding.
  const bool just_left = piece.begin - now.changed <= 1e-12 * system_.chain().period();
  std::array<double, most_terms> values{};
  Exit first;
  const auto look = [&](int index) {
    if (just_left && now.boundary == index) values[0] = System::just_after_event(values[0]);
    const double share = first_upcrossing(values.data(), piece.terms);
    if (share <= 1.0 && share < first.share) first = {index, share};
  };
  if (by_gap) {
    soil.height(piece, contact, now.phase == ContactPhase::flight ? -1.0 : 1.0, values);
    look(0);
  }
  if (by_force) {
    soil.law(piece, contact, now.phase == ContactPhase::contact ? 1.0 : -1.0, values);
    look(1);
  }
  return first;
}

template <class System>
ContactChange SolverOf<System>::leave(Motion &motion, std::size_t contact, int exit) const {
  const AxleLink link = system_.link(contact, time_of(motion));
  Contact &now = motion.contacts[contact];
  ContactChange change;
  change.contact = contact;
  change.from = now.phase;
  change.time = motion.time;
  change.overlap_rate = 0.0 - System::rise(motion.state, link);
  switch (now.phase) {
  case ContactPhase::flight:
    change.to = ContactPhase::contact;
    change.force = link.c * change.overlap_rate + 0.0;
    change.jump = link.c;
    break;
  case ContactPhase::clamped:
    change.to = exit == 0 ? ContactPhase::flight : ContactPhase::contact;
    break;
  case ContactPhase::contact:
    if (under(Transition::A)) {
      change.to = ContactPhase::flight;
      change.force = link.c * change.overlap_rate + 0.0;
      change.jump = -link.c;
    } else if (link.c > 0.0 && System::height(motion.state, link) < 0.0) {
      change.to = ContactPhase::clamped;
    } else { // without damping F = 0 and d = 0 are one
      change.to = ContactPhase::flight;
      exit = 0;
    }
    break;
  }
  if (exit == 0)
    System::level(motion.state);
  else
    change.overlap = 0.0 - System::height(motion.state, link);
  now.phase = change.to;
  now.changed = motion.time;
  // With damping a make at d = 0 is not at F = 0: no exit function of B's contact is zero there.
  const bool force_next = under(Transition::B) && change.to == ContactPhase::contact;
  now.boundary = exit == 1 ? 1 : !force_next ? 0 : link.c == 0.0 ? 1 : -1;
  return change;
}

template <class System>
void SolverOf<System>::drive_over(const WaySection &section, Motion &motion, Observer *observer) {
  const double time = time_of(motion);
  std::array<AxleLink, System::most_contacts> before;
  for (std::size_t j = 0; j < system_.contacts(); ++j)
    before[j] = system_.link(j, time);
  system_.drive_over(section);
  for (std::size_t j = 0; j < system_.contacts(); ++j) {
    const AxleLink link = system_.link(j, time);
    Contact &now = motion.contacts[j];
    const double rounding = 1e-12;
    if (std::fabs(link.k - before[j].k) <= rounding * link.k &&
        std::fabs(link.c - before[j].c) <= rounding * link.c)
      continue;
    if (now.boundary == 1 || now.changed < motion.time) now.boundary = -1; // where F was 0, it no longer is
    now.changed = motion.time;
    const double z = System::height(motion.state, link), rate = System::rise(motion.state, link);
    if (under(Transition::A) || z >= 0.0) continue;
    const auto law = [&](const AxleLink &of) { return 0.0 - (of.k * z + of.c * rate); };
    const ContactPhase phase = law(link) > 0.0 ? ContactPhase::contact : ContactPhase::clamped;
    if (phase == now.phase) continue;
    const AxleLink &acts = phase == ContactPhase::contact ? link : before[j];
    if (observer != nullptr)
      observer->change(
          {j, now.phase, phase, motion.time, 0.0 - z, 0.0 - rate, std::max(0.0, law(acts)), 0.0});
    now = {phase, -1, motion.time};
  }
}

template <class System>
void SolverOf<System>::finish_cycle(Motion &motion, Observer *observer) const {
  const double end = system_.chain().period();
  go_to(end, motion, observer);
  motion.time = 0.0;
  ++motion.cycle;
  for (Contact &contact : motion.contacts)
    contact.changed -= end;
}

template <class System>
void SolverOf<System>::go_to(double end, Motion &motion, Observer *observer) const {
  constexpr int most_changes = 100'000;
  const double nothing = 1e-15 * system_.chain().period();
  const std::size_t count = system_.contacts();
  typename System::Soil soil(system_);
  typename System::Piece piece;
  std::array<Exit, System::most_contacts> exits;
  int changes = 0;
  while (end - motion.time > nothing) {
    const std::uint32_t acting = motion.acting();
    const typename System::Dynamics &dynamics = soil.at(acting, time_of(motion));
    const double left = end - motion.time;
    const double longest = dynamics.longest_piece(motion.time - motion.contacts[0].changed);
    const bool last = left <= longest;
    const double length = last ? left : longest;
    const double angle = system_.chain().omega * motion.time;
    piece.begin = motion.time;
    dynamics.expand(piece, motion.state, length, std::sin(angle), std::cos(angle));
    piece.end = 2.0;
    for (std::size_t j = 0; j < count; ++j) {
      exits[j] = first_exit(soil, piece, j, motion.contacts[j]);
      piece.end = std::min(piece.end, exits[j].share);
    }
    const bool event = piece.end <= 1.0;
    if (!event) piece.end = 1.0;
    if (observer != nullptr && piece.end > 0.0) observer->piece(piece, dynamics, acting);
    motion.state = piece.state(piece.end);
    motion.time = !event && last ? end : motion.time + length * piece.end;
    if (!event) continue;
    // Contacts whose motion is the same change together.
    for (std::size_t j = 0; j < count; ++j) {
      if (exits[j].index < 0 || exits[j].share > piece.end + 1e-15) continue;
      const ContactChange change = leave(motion, j, exits[j].index);
      if (observer != nullptr) observer->change(change);
      if (++changes > most_changes)
        throw std::runtime_error(
            fmt::format("more than {} contacts made and broken in cycle {}", most_changes, motion.cycle + 1));
    }
  }
}

/// Samples and events of cycles, and what is asked of each cycle.
template <class System>
class RecorderOf : public ObserverOf<System> {
public:
  using State = typename System::State;
  using Piece = typename System::Piece;
  using Dynamics = typename System::Dynamics;

  RecorderOf(const System &system, const ExactOptions &options)
      : system_(system), options_(options), period_(system.chain().period()),
        end_(static_cast<double>(options.last_point()) / static_cast<double>(options.points_per_cycle()) *
             period_),
        last_row_(options.last_point() / options.points_per_sample()) {}

  void begin_cycle(long cycle) {
    start_ = static_cast<double>(cycle) * period_;
    row_of_cycle_ = cycle * options_.samples_per_cycle;
    next_ = 0;
    constexpr double no_limit = std::numeric_limits<double>::infinity();
    summary_ = {static_cast<int>(cycle) + 1, start_, no_limit, -no_limit, no_limit, -no_limit, 0.0, 0, 0};
  }
  void end_cycle() {
    if (system_.chain().transition == Transition::B)
      summary_.F_contact_min = std::max(0.0, summary_.F_contact_min);
    summary_.contact_share = std::min(1.0, summary_.contact_share / period_);
    result_.cycles.push_back(summary_);
  }

  void piece(const Piece &piece, const Dynamics &dynamics, std::uint32_t acting) override {
    ++result_.pieces;
    summarize(piece, dynamics, acting);
    for (; next_ < options_.samples_per_cycle && row_of_cycle_ + next_ <= last_row_; ++next_) {
      const double t = next_ * period_ / options_.samples_per_cycle;
      const double s = (t - piece.begin) / piece.length;
      if (s >= piece.end) break;
      row(dynamics, acting, t, piece.state(std::max(0.0, s)), std::max(0.0, s) * piece.length);
    }
  }
  void change(const ContactChange &change) override {
    if (!change.make() && !change.broken()) return;
    if (start_ + change.time > end_) return;
    ++(change.make() ? summary_.makes : summary_.breaks);
    if (result_.events.size() >= ExactOptions::most_events)
      throw std::runtime_error(fmt::format("more than {} contacts made and broken up to t = {} s",
                                           ExactOptions::most_events, start_ + change.time));
    result_.events.push_back({start_ + change.time, change.make(), change.overlap, change.overlap_rate,
                              change.force + 0.0, 1, 2 + static_cast<long>(change.contact)});
  }
  /// \param since the time of the dynamics [s]
  void row(const Dynamics &dynamics, std::uint32_t acting, double t, const State &y, double since = 0.0) {
    const double time = start_ + t;
    result_.history.time.push_back(time);
    system_.record(result_.history, dynamics, acting, y, std::sin(system_.chain().omega * t), time, since);
    if (const WaySection *section = system_.section()) {
      result_.history.s.push_back(section->place(time));
      result_.history.pass.push_back(section->pass);
    }
  }
  ExactSolution take() { return std::move(result_); }

private:
  // Extremes and time in contact of a piece, up to its end.
  void summarize(const Piece &piece, const Dynamics &dynamics, std::uint32_t acting) {
    std::array<double, most_terms> a{};
    std::array<double, most_terms> F{};
    dynamics.law(piece, F);
    double power = 1.0; // of piece.end
    for (std::size_t n = 0; n < piece.terms; ++n, power *= piece.end) {
      F[n] *= -power;
      if (n + 1 < piece.terms)
        a[n] = static_cast<double>(n + 1) * piece.drum_velocity(n + 1) / piece.length * power;
    }
    widen(a, piece.terms - 1, summary_.a_drum_min, summary_.a_drum_max);
    widen(F, piece.terms, summary_.F_contact_min, summary_.F_contact_max);
    if (acting != 0) summary_.contact_share += piece.length * piece.end;
  }

  const System &system_;
  const ExactOptions &options_;
  double period_;
  double end_;
  long last_row_;
  int next_ = 0;
  long row_of_cycle_ = 0;
  double start_ = 0.0;
  CycleSummary summary_;
  ExactSolution result_;
};

/// The solution from the start, or from `lead` cycles later. \param solver of the first section of the way,
/// if it drives \param after_cycle called with the motion at the end of each complete cycle
template <class System>
ExactSolution solved(
    SolverOf<System> &solver, const ExactOptions &options, int lead, const SolverProgress &progress,
    const std::function<void(const MotionOf<System> &)> &after_cycle = [](const auto & /*motion*/) {}) {
  std::vector<WaySection> way = options.way;
  if (System::soil_may_change && !way.empty()) {
    // The last cycle is followed to its end: the soil then stays as it is.
    WaySection &behind = way.emplace_back(way.back().from(way.back().end));
    behind.velocity = behind.k_rate = behind.D_rate = behind.k_left_rate = 0.0;
  }
  auto section = way.begin();
  const System &system = solver.system();
  RecorderOf<System> recorder(system, options);
  MotionOf<System> motion = solver.start(options.impact_speed);
  for (int cycle = 0; cycle < lead; ++cycle)
    solver.finish_cycle(motion);
  const long whole = options.last_point() / options.points_per_cycle();
  const bool part = whole == 0 || options.last_point() % options.points_per_cycle() != 0;
  const double period = system.chain().period();
  for (long cycle = lead; cycle < whole + part; ++cycle) {
    recorder.begin_cycle(cycle);
    for (std::size_t j = 0; cycle == 0 && j < system.contacts(); ++j) {
      const AxleLink link = system.link(j, 0.0);
      if (motion.contacts[j].phase != ContactPhase::contact || System::height(motion.state, link) != 0.0)
        continue;
      const double rate = 0.0 - System::rise(motion.state, link);
      recorder.change(
          {j, ContactPhase::flight, ContactPhase::contact, 0.0, 0.0, rate, link.c * rate + 0.0, link.c});
    }
    while (way.end() - section > 1) {
      const double end = section->end - static_cast<double>(cycle) * period;
      if (end >= period) break;
      solver.go_to(end, motion, &recorder);
      solver.drive_over(*++section, motion, &recorder);
    }
    solver.finish_cycle(motion, &recorder);
    if (cycle < whole) {
      recorder.end_cycle();
      after_cycle(motion);
    }
    if (progress) progress(std::min(1.0, static_cast<double>(cycle + 1) / options.cycles));
  }
  if (!part) {
    recorder.begin_cycle(whole);
    typename System::Soil soil(system);
    recorder.row(soil.at(motion.acting(), static_cast<double>(whole) * period), motion.acting(), 0.0,
                 motion.state);
  }
  return recorder.take();
}

} // namespace drumlin::post
