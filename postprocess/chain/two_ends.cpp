#include "chain/two_ends.h"

#include "chain/linear_algebra.h"
#include "files/roller.h"
#include "support/units.h"

#include <Eigen/Core>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;

// Components of positions and of their velocities.
enum Component { drum, frame, drum_tilt, frame_tilt };

using Moments = AxleMoments;

/// Stiffness or damping of contacts and bonds.
Matrix4d matrix_of(const Moments &contacts, const Moments &bonds) {
  Matrix4d m;
  m << contacts.all + bonds.all, -bonds.all, contacts.first + bonds.first, -bonds.first,         //
      -bonds.all, bonds.all, -bonds.first, bonds.first,                                          //
      contacts.first + bonds.first, -bonds.first, contacts.second + bonds.second, -bonds.second, //
      -bonds.first, bonds.first, -bonds.second, bonds.second;
  return m;
}

Vector4d masses(const TwoEnds &machine) {
  return {machine.chain.m2, machine.chain.m3, machine.drum_inertia, machine.frame_inertia};
}

Vector4d weight(const TwoEnds &machine) {
  return {-machine.chain.m2 * machine.chain.g, -machine.chain.m3 * machine.chain.g, 0.0, 0.0};
}

bool every(std::size_t /*link*/) { return true; }
bool none(std::size_t /*link*/) { return false; }

/// What a contact has of a number of both halves of the drum, which `contacts` share.
double part_of(const AxleLink &contact, std::size_t contacts, double left, double right) {
  const double part = 2.0 / static_cast<double>(contacts);
  return contact.y == 0.0 ? 0.5 * part * (left + right) : part * (contact.y < 0.0 ? left : right);
}

/// The rates of k of contacts over a section [N/(m s)].
double rate_of(const AxleLink &contact, std::size_t contacts, const WaySection &section) {
  return part_of(contact, contacts, section.k_left_rate, section.k_rate - section.k_left_rate);
}

/// Contacts at the start of a section.
std::vector<AxleLink> at_start(std::vector<AxleLink> contacts, const WaySection &section, double m2) {
  const double damping = 2.0 * section.D * std::sqrt(m2 / section.k); // c over k
  for (AxleLink &contact : contacts) {
    contact.k = part_of(contact, contacts.size(), section.k_left, section.k - section.k_left);
    contact.c = contact.k * damping;
  }
  return contacts;
}

double norm_of(const Matrix4d &matrix, const Vector4d &mass) {
  const Vector4d scale = mass.cwiseSqrt().cwiseInverse();
  const Matrix4d scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  return std::sqrt(eigenvalues_of(scaled.transpose() * scaled).real().maxCoeff());
}

} // namespace

TwoEnds two_ends(const ChainParameters &chain, const Roller &roller) {
  AxleMachine axle = axle_machine(roller, chain.m2, chain.m3, chain.k23, chain.c23);
  TwoEnds machine;
  machine.chain = chain;
  machine.drum_inertia = axle.drum_inertia;
  machine.frame_inertia = axle.frame_inertia;
  machine.exciter = axle.exciter;
  machine.sensor = axle.sensor;
  machine.bonds = std::move(axle.bonds);
  return machine;
}

void set_ratio(std::vector<AxleLink> &contacts, double ratio) {
  for (AxleLink &contact : contacts) {
    if (contact.y == 0.0) continue;
    const double share = 2.0 / (1.0 + ratio) * (contact.y < 0.0 ? ratio : 1.0);
    contact.k *= share;
    contact.c *= share;
  }
}

TwoEnds over(TwoEnds machine, const WaySection &section) {
  machine.section = section;
  machine.contacts = at_start(std::move(machine.contacts), section, machine.chain.m2);
  return machine;
}

std::vector<AxleLink> TwoEnds::contacts_at(double time) const {
  return section && !section->constant() ? at_start(contacts, section->from(time), chain.m2) : contacts;
}

double drum_width(const Roller &roller) { return axle_machine(roller, 0.0, 0.0, 0.0, 0.0).width; }

std::vector<std::string> assumed_ends(const Roller &roller) {
  std::vector<std::string> names;
  const auto judge = [&names](bool given, const char *name) {
    if (!given) names.emplace_back(name);
  };
  judge(roller.width.has_value(), "width");
  judge(roller.drum_inertia.has_value(), "drum_inertia");
  judge(roller.frame_inertia.has_value(), "frame_inertia");
  judge(roller.springs.left.has_value(), "bond_left");
  judge(roller.springs.right.has_value(), "bond_right");
  return names;
}

std::string TwoEnds::invalid() const {
  if (std::string fault = chain.invalid(); !fault.empty()) return fault;
  const auto count = static_cast<double>(contacts.size());
  if (count < 1 || count > most_contacts)
    return refusal("contacts", count, fmt::format("a whole number from 1 to {}", most_contacts));
  const Range inertia = {1e-9, 1e12, "kg m2"};
  if (!inertia.holds(drum_inertia)) return refusal("drum_inertia", drum_inertia, inertia.words());
  if (!inertia.holds(frame_inertia)) return refusal("frame_inertia", frame_inertia, inertia.words());
  return chain.g == 0.0 ? std::string() : axle_fault(contacts, bonds);
}

// ---- linear dynamics ----

ContactSet::ContactSet(const TwoEnds &machine, std::uint32_t acting, double time)
    : omega_(machine.chain.omega), m2_(machine.chain.m2) {
  const auto acts = [acting](std::size_t contact) { return ((acting >> contact) & 1U) != 0; };
  const Vector4d mass = masses(machine);
  const Matrix4d inverse = mass.cwiseInverse().asDiagonal();
  const std::vector<AxleLink> contacts = machine.contacts_at(time);
  const Moments k(contacts, &AxleLink::k, acts), c(contacts, &AxleLink::c, acts);
  const Moments k_bonds(machine.bonds, &AxleLink::k, every), c_bonds(machine.bonds, &AxleLink::c, every);
  const Matrix4d stiffness = matrix_of(k, k_bonds), damping = matrix_of(c, c_bonds);
  springs_ = {{k.all, k.first}, {0.0, 0.0}, {c.all, c.first}};
  const double C = norm_of(damping, mass);
  rate_ = std::max(omega_, 0.5 * C + std::sqrt(0.25 * C * C + norm_of(stiffness, mass)));
  const AxlePositions rest = held_by(k, k_bonds, weight(machine)[drum], weight(machine)[frame]);
  rest_ = Eigen::Map<const Vector4d>(rest.data());
  // Positions at rest far away would cost the digits that they are to keep.
  const double natural = machine.chain.g / (rate_ * rate_);
  if (!(rest_.head<2>().norm() < 1e6 * natural)) rest_.setZero();
  Vector4d left = weight(machine) - stiffness * rest_;
  for (int i = 0; i < 4; ++i)
    if (std::fabs(left[i]) <= 1e-14 * weight(machine).norm()) left[i] = 0.0;
  const Vector4d push = {-machine.chain.Fw, 0.0, -machine.exciter * machine.chain.Fw, 0.0};
  stiffness_ = inverse * stiffness;
  damping_ = inverse * damping;
  gravity_ = left.cwiseQuotient(mass);
  push_ = push.cwiseQuotient(mass);

  changes_ = machine.section && !machine.section->constant();
  if (!changes_) return;
  section_ = machine.section->from(time);
  std::vector<AxleLink> rates = contacts;
  for (AxleLink &contact : rates)
    contact.k = rate_of(contact, contacts.size(), section_);
  const Moments k_rate(rates, &AxleLink::k, acts), nothing(machine.bonds, &AxleLink::k, none);
  springs_.k_rate = {k_rate.all, k_rate.first};
  contacts_ = inverse * matrix_of(k, nothing);
  contacts_rate_ = inverse * matrix_of(k_rate, nothing);
  damping_ = inverse * matrix_of(nothing, c_bonds);
  // In a piece k and D change by a tenth at most: the series of 1/sqrt(k) is then as short as that of the
  // motion, and the norm grows by less than a fifth.
  constexpr double share = 0.1, growth = 1.2;
  const double fastest = std::max({std::fabs(section_.k_left_rate) / section_.k,
                                   std::fabs(section_.k_rate - section_.k_left_rate) / section_.k,
                                   std::fabs(section_.D_rate) / std::max(1.0, section_.D)});
  longest_change_ = share / fastest;
  rate_ *= growth;
}

double ContactSet::damping_over_stiffness(double since) const {
  return 2.0 * (section_.D + section_.D_rate * since) *
         std::sqrt(m2_ / (section_.k + section_.k_rate * since));
}

TwoEndsState ContactSet::Piece::state(double s) const {
  Vector4d x = position[terms - 1], v = velocity[terms - 1];
  for (std::size_t n = terms - 1; n-- > 0;) {
    x = x * s + position[n];
    v = v * s + velocity[n];
  }
  TwoEndsState state;
  state << x, v;
  return state;
}

void ContactSet::expand(Piece &piece, const TwoEndsState &from, double length, double sine,
                        double cosine) const {
  piece.length = length;
  piece.terms = terms_of_series(length * rate_);
  piece.changes = changes_;
  if (changes_) {
    // After this number of terms the series of 1/sqrt(1 + x) is below 1e-18 for x = 0.1.
    constexpr std::size_t least_terms = 18;
    piece.terms = std::max(piece.terms, least_terms);
    const double k_share = length * section_.k_rate / section_.k;
    double root = 2.0 * std::sqrt(m2_ / section_.k), before = 0.0; // terms of 2 sqrt(m2/k)
    for (std::size_t n = 0; n < piece.terms; ++n) {
      piece.damping[n] = section_.D * root + length * section_.D_rate * before;
      before = root;
      root *= -k_share * (static_cast<double>(n) + 0.5) / static_cast<double>(n + 1);
    }
  }
  std::array<Vector4d, most_terms> rates; // stiffness of the contacts times velocities, per mass
  const double turn = omega_ * length;
  double s = sine, c = cosine;
  piece.position[0] = from.head<4>() - rest_;
  piece.velocity[0] = from.tail<4>();
  for (std::size_t n = 0; n + 1 < piece.terms; ++n) {
    const double share = 1.0 / static_cast<double>(n + 1);
    const double factor = length * share;
    piece.position[n + 1] = factor * piece.velocity[n];
    Vector4d force = s * push_ - stiffness_ * piece.position[n] - damping_ * piece.velocity[n];
    if (n == 0) force += gravity_;
    if (changes_) {
      rates[n] = contacts_ * piece.velocity[n];
      if (n > 0) {
        rates[n] += length * (contacts_rate_ * piece.velocity[n - 1]);
        force -= length * (contacts_rate_ * (n == 1 ? piece.position[0] + rest_ : piece.position[n - 1]));
      }
      for (std::size_t m = 0; m <= n; ++m)
        force -= piece.damping[m] * rates[n - m];
    }
    piece.velocity[n + 1] = factor * force;
    const double next = turn * share * c;
    c = -turn * share * s;
    s = next;
  }
  piece.position[0] += rest_;
}

void ContactSet::Piece::law(const AxleSprings &springs, std::array<double, most_terms> &values) const {
  const auto product = [](const Eigen::Vector2d &sums, const Vector4d &x) {
    return sums[0] * x[drum] + sums[1] * x[drum_tilt];
  };
  std::array<double, most_terms> rates{};
  for (std::size_t n = 0; n < terms; ++n) {
    values[n] = product(springs.k, position[n]);
    if (!changes) {
      values[n] += product(springs.c, velocity[n]);
      continue;
    }
    rates[n] = product(springs.k, velocity[n]);
    if (n > 0) {
      values[n] += length * product(springs.k_rate, position[n - 1]);
      rates[n] += length * product(springs.k_rate, velocity[n - 1]);
    }
    for (std::size_t m = 0; m <= n; ++m)
      values[n] += damping[m] * rates[n - m];
  }
}

Vector4d ContactSet::acceleration(const TwoEndsState &state, double sine, double since) const {
  const Vector4d from_rest = state.head<4>() - rest_, rates = state.tail<4>();
  Vector4d sum = gravity_ + sine * push_ - stiffness_ * from_rest - damping_ * rates;
  if (changes_)
    sum -= since * (contacts_rate_ * state.head<4>()) +
           damping_over_stiffness(since) * (contacts_ * rates + since * (contacts_rate_ * rates));
  return sum;
}

TwoEndsMatrix ContactSet::carry(const TwoEndsMatrix &differences, double time) const {
  TwoEndsMatrix rates = TwoEndsMatrix::Zero();
  rates.topRightCorner<4, 4>().setIdentity();
  rates.bottomLeftCorner<4, 4>() = -stiffness_;
  rates.bottomRightCorner<4, 4>() = -damping_;
  TwoEndsMatrix term = differences, sum = differences;
  const std::size_t terms = terms_of_series(time * rate_);
  for (std::size_t n = 1; n < terms; ++n) {
    term = (time / static_cast<double>(n)) * (rates * term).eval();
    sum += term;
  }
  return sum;
}

// ---- the machine ----

ManyContacts::ManyContacts(TwoEnds machine)
    : machine_(std::move(machine)), bond_k_(machine_.bonds, &AxleLink::k, every),
      bond_c_(machine_.bonds, &AxleLink::c, every) {
  if (const std::string fault = machine_.invalid(); !fault.empty()) throw std::invalid_argument(fault);
}

TwoEndsState ManyContacts::at_rest() const {
  TwoEndsState state = TwoEndsState::Zero();
  if (machine_.chain.g > 0.0) {
    const AxlePositions rest =
        drumlin::at_rest(machine_.contacts, machine_.bonds, weight(machine_)[drum], weight(machine_)[frame]);
    state.head<4>() = Eigen::Map<const Vector4d>(rest.data());
  }
  state[drum_tilt] += machine_.tilt;
  state[frame_tilt] += machine_.tilt;
  return state;
}

TwoEndsState ManyContacts::falling(double speed) {
  TwoEndsState state = TwoEndsState::Zero();
  state[4 + drum] = state[4 + frame] = -speed;
  return state;
}

const ContactSet &ManyContacts::Soil::at(std::uint32_t acting, double time) {
  const TwoEnds &machine = system_.machine_;
  if (!system_.soil_changes()) return system_.sets_.try_emplace(acting, machine, acting).first->second;
  contacts_ = machine.contacts_at(time);
  return of_now_.emplace(machine, acting, time);
}

void ManyContacts::Soil::height(const Piece &piece, std::size_t contact, double sign,
                                std::array<double, most_terms> &values) const {
  const double y = contacts_[contact].y;
  for (std::size_t n = 0; n < piece.terms; ++n)
    values[n] = sign * (piece.position[n][drum] + y * piece.position[n][drum_tilt]);
}

void ManyContacts::Soil::law(const Piece &piece, std::size_t contact, double sign,
                             std::array<double, most_terms> &values) const {
  const AxleLink &link = contacts_[contact];
  const double k_rate =
      system_.soil_changes() ? rate_of(link, contacts_.size(), *system_.machine_.section) : 0.0;
  const Eigen::Vector2d place = {sign, sign * link.y};
  piece.law({link.k * place, k_rate * place, link.c * place}, values);
}

void ManyContacts::drive_over(const WaySection &section) {
  machine_ = over(std::move(machine_), section);
  sets_.clear();
}

void ManyContacts::record(ChainHistory &h, const ContactSet &set, std::uint32_t acting, const TwoEndsState &y,
                          double sine, double time, double since) const {
  const std::vector<AxleLink> contacts = machine_.contacts_at(time);
  const bool clipped = machine_.chain.transition == Transition::B;
  double F_left = 0.0, F_right = 0.0;
  for (std::size_t j = 0; j < contacts.size(); ++j) {
    if (((acting >> j) & 1U) == 0) continue;
    const AxleLink &link = contacts[j];
    double force = -(link.k * height(y, link) + link.c * rise(y, link));
    if (clipped) force = std::max(0.0, force);
    if (link.y == 0.0) {
      F_left += 0.5 * force;
      F_right += 0.5 * force;
    } else {
      (link.y < 0.0 ? F_left : F_right) += force;
    }
  }
  const Vector4d a = set.acceleration(y, sine, since);
  h.x_drum.push_back(y[drum]);
  h.v_drum.push_back(y[4 + drum]);
  h.a_drum.push_back(a[drum]);
  h.x_frame.push_back(y[frame]);
  h.v_frame.push_back(y[4 + frame]);
  h.a_frame.push_back(a[frame]);
  h.F_contact.push_back(F_left + F_right);
  h.F_excitation.push_back(machine_.chain.Fw * sine);
  h.F_bond.push_back(
      bond_k_.all * (y[frame] - y[drum]) + bond_k_.first * (y[frame_tilt] - y[drum_tilt]) +
      (bond_c_.all * (y[4 + frame] - y[4 + drum]) + bond_c_.first * (y[4 + frame_tilt] - y[4 + drum_tilt])));
  h.theta_drum.push_back(y[drum_tilt]);
  h.omega_drum.push_back(y[4 + drum_tilt]);
  h.theta_frame.push_back(y[frame_tilt]);
  h.omega_frame.push_back(y[4 + frame_tilt]);
  h.a_left.push_back(a[drum] - machine_.sensor * a[drum_tilt]);
  h.a_right.push_back(a[drum] + machine_.sensor * a[drum_tilt]);
  h.F_left.push_back(F_left);
  h.F_right.push_back(F_right);
}

template class SolverOf<ManyContacts>;

namespace {

/// Small differences of two motions.
class Differences : public TwoEndsObserver {
public:
  explicit Differences(const TwoEnds &machine) : machine_(machine) {}
  const TwoEndsMatrix &matrix() const { return matrix_; }

  void piece(const ContactSet::Piece &piece, const ContactSet &set, std::uint32_t /*acting*/) override {
    matrix_ = set.carry(matrix_, piece.length * piece.end);
  }
  // Saltation: the neighbour that comes later is without the dashpot's force for that time (see
  // ContactChange).
  void change(const ContactChange &change) override {
    if (change.jump == 0.0) return;
    const double y = machine_.contacts[change.contact].y;
    const Eigen::Matrix<double, 1, 8> apart = change.jump * (matrix_.row(drum) + y * matrix_.row(drum_tilt));
    matrix_.row(4 + drum) -= apart / machine_.chain.m2;
    matrix_.row(4 + drum_tilt) -= y / machine_.drum_inertia * apart;
  }

private:
  const TwoEnds &machine_;
  TwoEndsMatrix matrix_ = TwoEndsMatrix::Identity();
};

} // namespace

TwoEndsMatrix TwoEndsSolver::monodromy(TwoEndsMotion &motion) const {
  Differences differences(machine());
  finish_cycle(motion, &differences);
  return differences.matrix();
}

// ---- whether it repeats ----

namespace {

constexpr std::size_t longest_orbit = 8, measured_cycles = 100, least_measured = 20;

/// \param motions at the starts of the last cycles and at the end
TwoEndsOrbit orbit_of(const TwoEndsSolver &solver, const std::vector<TwoEndsMotion> &motions) {
  const TwoEnds &machine = solver.machine();
  const ChainParameters &p = machine.chain;
  const double amplitude = std::max(p.Fw / (p.m2 * p.omega * p.omega), 1e-300);
  // Tilts count as displacements at the radius of gyration, velocities by the frequency.
  TwoEndsState scale;
  scale << (masses(machine) / p.m2).cwiseSqrt(), (masses(machine) / p.m2).cwiseSqrt() / p.omega;
  TwoEndsOrbit orbit;
  const std::size_t last = motions.size() - 1;
  for (std::size_t cycles = 1; cycles <= std::min(last, longest_orbit) && orbit.cycles == 0; ++cycles) {
    const TwoEndsState apart = motions[last].state - motions[last - cycles].state;
    if (apart.cwiseProduct(scale).lpNorm<Eigen::Infinity>() <= 1e-6 * amplitude)
      orbit.cycles = static_cast<int>(cycles);
  }
  const std::size_t count = orbit.cycles > 0 ? static_cast<std::size_t>(orbit.cycles) : last,
                    half = count / 2;
  if (count == 0 || (orbit.cycles == 0 && count < least_measured)) return orbit;
  // The products of bounce and of tilt are kept near one, and their sizes as logarithms.
  static constexpr std::array<int, 8> order = {drum,      frame,      4 + drum,      4 + frame,
                                               drum_tilt, frame_tilt, 4 + drum_tilt, 4 + frame_tilt};
  const auto place = [](int n) { return order[static_cast<std::size_t>(n)]; };
  TwoEndsMatrix all = TwoEndsMatrix::Identity();
  Matrix4d tilt = Matrix4d::Identity();
  double size = 0.0, tilt_size = 0.0, half_size = 0.0, half_tilt_size = 0.0;
  bool coupled = false;
  const auto shorten = [](auto &matrix, double &logarithm) {
    const double norm = matrix.norm();
    if (!(norm > 0.0)) return;
    matrix /= norm;
    logarithm += std::log(norm);
  };
  TwoEndsMotion motion = motions[last - count];
  for (std::size_t cycle = 0; cycle < count; ++cycle) {
    const TwoEndsMatrix plain = solver.monodromy(motion);
    TwoEndsMatrix step;
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 8; ++j)
        step(i, j) = plain(place(i), place(j)) * scale[place(i)] / scale[place(j)];
    coupled =
        coupled || !step.topRightCorner<4, 4>().isZero(1e-9) || !step.bottomLeftCorner<4, 4>().isZero(1e-9);
    all = (step * all).eval();
    tilt = (step.bottomRightCorner<4, 4>() * tilt).eval();
    shorten(all, size);
    shorten(tilt, tilt_size);
    if (cycle + 1 == half) {
      half_size = size;
      half_tilt_size = tilt_size;
    }
  }
  const auto grown = [&orbit, count, half](const auto &matrix, double logarithm, double at_half) {
    if (orbit.cycles > 0) return std::exp(logarithm) * eigenvalues_of(matrix).cwiseAbs().maxCoeff();
    return std::exp((logarithm - at_half) / static_cast<double>(count - half));
  };
  orbit.largest = grown(all, size, half_size);
  if (!coupled) orbit.of_tilt = grown(tilt, tilt_size, half_tilt_size);
  return orbit;
}

} // namespace

std::string too_much_work(const TwoEnds &machine, const ExactOptions &options) {
  TwoEnds stiffest = machine;
  double most = ExactOptions::most_pieces;
  if (!options.way.empty()) {
    WaySection worst;
    for (const WaySection &section : options.way) {
      for (const WaySection &here : {section, section.from(section.end)}) {
        worst.k_left = std::max(worst.k_left, here.k_left);
        worst.k = std::max(worst.k, here.k - here.k_left); // of the right half, here
        worst.D = std::max(worst.D, here.D);
      }
      if (!section.constant()) most = 2e6; // each takes longer
    }
    worst.k += worst.k_left;
    stiffest = over(std::move(stiffest), worst);
  }
  const double per_cycle = machine.chain.period() / ContactSet(stiffest, ~0U).longest_piece() + 1.0;
  return too_many_pieces(options, per_cycle, most);
}

TwoEndsResult solve_two_ends(const TwoEnds &machine, const ExactOptions &options,
                             const SolverProgress &progress) {
  if (const std::string fault = options.invalid(); !fault.empty()) throw std::invalid_argument(fault);
  const bool drives = !options.way.empty();
  TwoEndsSolver solver(drives ? over(machine, options.way.front()) : machine);
  std::vector<TwoEndsMotion> motions = {solver.start(options.impact_speed)};
  TwoEndsResult result;
  static_cast<ExactSolution &>(result) =
      solved<ManyContacts>(solver, options, 0, progress, [&motions](const TwoEndsMotion &motion) {
        if (motions.size() > measured_cycles) motions.erase(motions.begin());
        motions.push_back(motion);
      });
  if (!drives) result.orbit = orbit_of(solver, motions);
  return result;
}

} // namespace drumlin::post
