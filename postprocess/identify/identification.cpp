#include "identify/identification.h"

#include "chain/linear_algebra.h"
#include "support/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double not_there = std::numeric_limits<double>::quiet_NaN();

// The three kinds of residuals.
enum Channel : std::size_t { of_force, of_x, of_v, channels };
using Levels = std::array<double, channels>;

// A least squares problem of one piece with its own unknowns eliminated.
struct Projected {
  MatrixXd slopes;   // of the residuals over k, c and the phase
  VectorXd residual; // over the noise of its channel
  VectorXd lever;    // share of each residual that the piece's own unknowns took
  std::vector<Channel> channel;
};

// k, c, phase error.
class Fitter {
public:
  Fitter(const DrumSignals &signals, const IdentificationSetting &setting, std::vector<ContactPiece> &pieces)
      : signals_(signals), setting_(setting), pieces_(pieces) {
    constexpr double first_guess = 0.01; // of the signals; later the residuals tell
    constexpr double rounding = 1e-9;
    const std::vector<double> *all[channels] = {&signals.force, &signals.x_drum, &signals.v_drum};
    for (std::size_t i = 0; i < channels; ++i) {
      noise_[i] = std::max(first_guess * rms(*all[i]), std::numeric_limits<double>::min());
      least_[i] = std::max(rounding * rms(*all[i]), std::numeric_limits<double>::min());
    }
  }

  void solve();
  LawEstimate estimate() const;
  const Vector3d &unknowns() const { return unknowns_; }

private:
  Projected project(ContactPiece &piece) const;
  void fill(const ContactPiece &piece, MatrixXd &own, VectorXd &residual, Projected &result) const;
  void add_flight(const ContactPiece &piece, Vector3d &slope, Matrix3d &square) const;
  double phase_weight() const;
  void collect();
  bool has_x() const { return !signals_.x_drum.empty(); }
  bool has_v() const { return !signals_.v_drum.empty(); }
  // Whether the force depends on the unknown x0. If so, the mean force in unbroken contact tells k, and then
  // the force tells the phase as well. If not, k, c and the phase have the same effects on a sinusoidal force
  // in unbroken contact but for the noise, which must not decide: the phase is that of the flights alone.
  bool tied() const { return has_x() && setting_.known_origin; }
  double phase_slope(std::size_t i) const {
    return -signals_.excitation[i] * std::sin(unknowns_[2]) + signals_.quadrature[i] * std::cos(unknowns_[2]);
  }

  const DrumSignals &signals_;
  const IdentificationSetting &setting_;
  std::vector<ContactPiece> &pieces_;
  Vector3d unknowns_ = Vector3d::Zero();
  Levels noise_{}, least_{};
  Matrix3d normal_ = Matrix3d::Zero(); // of the reduced problem, prior included
  Vector3d gradient_ = Vector3d::Zero();
  std::vector<Vector3d> scores_; // gradient of each block
  std::vector<Matrix3d> shares_; // what each block adds to the normal equations
  Levels squares_{}, freedom_{}; // of the residuals
};

// Weight of the knowledge of the phase: the variance of equally probable errors is a third of the largest
// one's square.
double Fitter::phase_weight() const {
  constexpr double exact = 1e-9; // rad
  const double within = std::max(setting_.phase_within, exact);
  return 3.0 / (within * within);
}

// Rows of a piece: residual = residual at zero + own * (unknowns of the piece). Those are the offset of the
// force w and v0, and x0 where a position is measured; with a known origin w = k x0; without measured x and v
// the force has the two unknowns w and k v0.
void Fitter::fill(const ContactPiece &piece, MatrixXd &own, VectorXd &residual, Projected &result) const {
  const double k = unknowns_[0];
  const double c = unknowns_[1];
  const bool only_force = !has_x() && !has_v();
  Index row = 0;
  for (std::size_t j = 0; j < piece.run.size(); ++j) {
    const std::size_t i = piece.run.first + j;
    const double tau = static_cast<double>(j) * signals_.dt;
    const double once = piece.integrals.once[j];
    const double twice = piece.integrals.twice[j];
    residual[row] = (signals_.force_at(i, unknowns_[2]) + k * twice + c * once) / noise_[of_force];
    own(row, 0) = (tied() ? k : 1.0) / noise_[of_force];
    own(row, 1) = (only_force ? tau : k * tau + c) / noise_[of_force];
    result.channel.push_back(of_force);
    ++row;
    if (has_x()) {
      residual[row] = (signals_.x_drum[i] - twice) / noise_[of_x];
      own(row, tied() ? 0 : 2) = -1.0 / noise_[of_x];
      own(row, 1) = -tau / noise_[of_x];
      result.channel.push_back(of_x);
      ++row;
    }
    if (has_v()) {
      residual[row] = (signals_.v_drum[i] - once) / noise_[of_v];
      own(row, 1) = -1.0 / noise_[of_v];
      result.channel.push_back(of_v);
      ++row;
    }
  }
}

Projected Fitter::project(ContactPiece &piece) const {
  const std::size_t per_sample = 1 + (has_x() ? 1 : 0) + (has_v() ? 1 : 0);
  const auto rows = static_cast<Index>(piece.run.size() * per_sample);
  const Index unknowns = has_x() && !tied() ? 3 : 2;
  Projected result;
  MatrixXd own = MatrixXd::Zero(rows, unknowns);
  VectorXd residual(rows);
  fill(piece, own, residual, result);
  const VectorXd sizes = own.colwise().norm().cwiseMax(std::numeric_limits<double>::min());
  const LeastSquares basis(own * sizes.cwiseInverse().asDiagonal());
  const VectorXd values = -basis.solution(residual).cwiseQuotient(sizes);

  const bool only_force = !has_x() && !has_v();
  piece.offset = -(tied() ? unknowns_[0] : 1.0) * values[0];
  piece.slope = values[1];
  piece.position = has_x() ? values[tied() ? 0 : 2] : not_there;
  result.slopes = MatrixXd::Zero(rows, 3);
  for (std::size_t j = 0; j < piece.run.size(); ++j) {
    const auto row = static_cast<Index>(j * per_sample);
    const double tau = static_cast<double>(j) * signals_.dt;
    const double v0 = only_force ? 0.0 : piece.slope;
    result.slopes(row, 0) = (tied() ? piece.position : 0.0) + v0 * tau + piece.integrals.twice[j];
    result.slopes(row, 1) = v0 + piece.integrals.once[j];
    result.slopes(row, 2) = phase_slope(piece.run.first + j);
  }
  result.slopes /= noise_[of_force];
  result.slopes = basis.left_of(result.slopes);
  result.residual = basis.left_of(residual);
  result.lever = basis.levers();
  return result;
}

void Fitter::add_flight(const ContactPiece &piece, Vector3d &slope, Matrix3d &square) const {
  for (const std::size_t i : piece.flight) {
    const double change = phase_slope(i) / noise_[of_force];
    slope[2] += change * signals_.force_at(i, unknowns_[2]) / noise_[of_force];
    square(2, 2) += change * change;
  }
}

// Normal equations, scores and residuals at the present values.
void Fitter::collect() {
  normal_.setZero();
  gradient_.setZero();
  scores_.clear();
  shares_.clear();
  squares_.fill(0.0);
  freedom_.fill(0.0);
  for (ContactPiece &piece : pieces_) {
    const Projected part = project(piece);
    Vector3d score = part.slopes.transpose() * part.residual;
    Matrix3d square = part.slopes.transpose() * part.slopes;
    if (!tied()) {
      score[2] = 0.0;
      square.row(2).setZero();
    }
    add_flight(piece, score, square);
    normal_ += square;
    gradient_ += score;
    scores_.push_back(score);
    shares_.push_back(square);
    for (Index row = 0; row < part.residual.size(); ++row) {
      const Channel channel = part.channel[static_cast<std::size_t>(row)];
      squares_[channel] += std::pow(part.residual[row] * noise_[channel], 2);
      freedom_[channel] += 1.0 - part.lever[row];
    }
  }
  normal_(2, 2) += phase_weight();
  gradient_[2] += phase_weight() * unknowns_[2];
}

// Whether the last unknown follows from its own equation alone.
bool last_is_alone(const Matrix3d &m) { return m(2, 0) == 0.0 && m(2, 1) == 0.0; }

// Solves m y = right. If the phase is that of the flights, its equation is solved first: in a record with
// hardly any noise the force depends on the phase so much more than the phase's own equation does that a
// general method takes the latter for zero.
Vector3d solved(const Matrix3d &m, const Vector3d &right) {
  if (!last_is_alone(m)) return solution_of(m, right);
  Vector3d y;
  y[2] = right[2] / m(2, 2);
  y.head<2>() = solution_of(m.topLeftCorner<2, 2>(), right.head<2>() - y[2] * m.col(2).head<2>());
  return y;
}

// The inverse of the matrix of the normal equations, with unknowns of unit size. Not symmetric if the phase
// is that of the flights.
Matrix3d inverse_of(const Matrix3d &normal) {
  const Vector3d sizes = normal.diagonal().cwiseSqrt();
  if (!(sizes.minCoeff() > 0.0) || !sizes.allFinite())
    throw std::runtime_error("the record does not determine k and c: the drum hardly moves in contact");
  const Eigen::DiagonalMatrix<double, 3> units(sizes.cwiseInverse());
  const Matrix3d scaled = units * normal * units;
  const Index together = last_is_alone(scaled) ? 2 : 3;
  const double pivot = last_pivot_of(scaled.topLeftCorner(together, together));
  constexpr double least_pivot = 1e-13;
  if (std::fabs(pivot) < least_pivot)
    throw std::runtime_error("the record does not determine k and c: the drum's position and velocity in "
                             "contact are proportional to each other");
  Matrix3d inverse;
  for (Index i = 0; i < inverse.cols(); ++i)
    inverse.col(i) = solved(scaled, Vector3d::Unit(i));
  return units * inverse * units;
}

void Fitter::solve() {
  constexpr int most_rounds = 30;
  constexpr double converged = 1e-10;
  for (int round = 0; round < most_rounds; ++round) {
    collect();
    const Vector3d step = -inverse_of(normal_) * gradient_;
    unknowns_ += step;
    const Vector3d sizes = normal_.diagonal().cwiseSqrt().cwiseInverse();
    bool same = std::fabs(step[0]) <= converged * std::fabs(unknowns_[0]) + 1e-3 * sizes[0] &&
                std::fabs(step[1]) <= converged * std::fabs(unknowns_[1]) + 1e-3 * sizes[1];
    for (std::size_t i = 0; i < channels; ++i) {
      if (!(freedom_[i] > 0.0)) continue;
      const double level = std::max(std::sqrt(squares_[i] / freedom_[i]), least_[i]);
      constexpr double level_converged = 1e-3;
      same = same && std::fabs(level - noise_[i]) <= level_converged * noise_[i];
      noise_[i] = level;
    }
    if (same && round > 1) break;
  }
  collect();
}

LawEstimate Fitter::estimate() const {
  LawEstimate law;
  const double k = unknowns_[0];
  const double c = unknowns_[1];
  law.blocks = scores_.size();
  const auto blocks = static_cast<double>(law.blocks);
  const Matrix3d inverse = inverse_of(normal_);
  Matrix3d middle = Matrix3d::Zero();
  // A block that matters much draws the solution to itself, and its residuals are small: divided by its share
  // in the solution (jackknife, CR3 of Bell and McCaffrey 2002).
  for (std::size_t i = 0; i < scores_.size(); ++i) {
    const Matrix3d others = Matrix3d::Identity() - shares_[i] * inverse;
    const Vector3d score = solved(others, scores_[i]);
    middle += score * score.transpose();
  }
  middle(2, 2) += phase_weight();
  const Matrix3d sandwich = inverse * middle * inverse.transpose();
  Matrix3d plain_middle = normal_; // of uncorrelated residuals
  if (!tied()) plain_middle.col(2).head(2).setZero();
  const Matrix3d plain = inverse * plain_middle * inverse.transpose();
  const double t = t_factor(std::max(1.0, blocks - 2.0));
  const auto half_width = [&](const Vector3d &direction) {
    return t * std::sqrt(std::max(direction.dot(sandwich * direction), direction.dot(plain * direction)));
  };
  law.k = {k, half_width(Vector3d::UnitX())};
  law.c = {c, half_width(Vector3d::UnitY())};
  law.phase = {unknowns_[2], half_width(Vector3d::UnitZ())};
  if (k > 0.0) {
    const double to_D = 1.0 / (2.0 * std::sqrt(setting_.m2 * k));
    law.D = {c * to_D, half_width({-0.5 * c * to_D / k, to_D, 0.0})};
  } else {
    law.D = {not_there, not_there};
  }
  law.force_noise = noise_[of_force];
  return law;
}

// --- Samples that belong to a contact ---

// The law's force j samples after the start of a piece, with integrals from there.
double law_force(const DrumSignals &signals, const Vector3d &unknowns, const ContactPiece &piece,
                 const Integrals &way, std::size_t j) {
  const bool only_force = signals.x_drum.empty() && signals.v_drum.empty();
  const double tau = static_cast<double>(j) * signals.dt;
  const double of_slope = only_force ? tau : unknowns[0] * tau + unknowns[1];
  return piece.offset - piece.slope * of_slope - unknowns[0] * way.twice[j] - unknowns[1] * way.once[j];
}

// Contacts cut into pieces of at most a cycle: the noise of the integrals grows with their length.
std::vector<ContactPiece> pieces_of(const DrumSignals &signals, const std::vector<SampleRun> &contacts) {
  std::vector<ContactPiece> pieces;
  const auto longest = std::max(static_cast<double>(least_contact), signals.per_cycle);
  for (const SampleRun &contact : contacts) {
    const auto count = static_cast<std::size_t>(std::ceil(static_cast<double>(contact.size()) / longest));
    for (std::size_t i = 0; i < count; ++i) {
      const SampleRun run = {contact.first + i * contact.size() / count,
                             contact.first + (i + 1) * contact.size() / count};
      if (run.size() < least_contact) continue;
      ContactPiece piece;
      piece.run = run;
      piece.integrals = integrals(signals.a_drum, run, signals.dt);
      pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

// Judges the samples of little force between two pieces by the law of the piece before them.
class Gap {
public:
  Gap(const DrumSignals &signals, const Vector3d &unknowns, const ContactPiece &before, std::size_t end)
      : first_(before.run.end), end_(end) {
    constexpr std::size_t look_ahead = 3;
    const std::size_t last = std::min(end + look_ahead, signals.size());
    const Integrals way = integrals(signals.a_drum, {before.run.first, last}, signals.dt);
    for (std::size_t i = first_; i < last; ++i) {
      force_.push_back(signals.force_at(i, unknowns[2]));
      law_.push_back(law_force(signals, unknowns, before, way, i - before.run.first));
    }
  }

  // The force follows the law through the gap and behind it.
  bool is_contact(double noise, double misfit) const {
    const std::size_t inside = end_ - first_;
    double of_law = 0.0;
    double of_none = 0.0;
    double behind = 0.0;
    for (std::size_t j = 0; j < force_.size(); ++j) {
      const double off = force_[j] - law_[j];
      (j < inside ? of_law : behind) += off * off;
      if (j < inside) of_none += force_[j] * force_[j];
    }
    const double samples = static_cast<double>(inside);
    const double later = static_cast<double>(force_.size() - inside);
    return force_.size() > inside && of_law < of_none + 4.0 * samples * noise * noise &&
           behind < 25.0 * later * misfit * misfit;
  }

  // Samples at which there is no force where the law has tension: those not next to the ends of the gap.
  std::vector<std::size_t> flight(const std::vector<double> &limits) const {
    std::vector<std::size_t> samples;
    constexpr std::size_t rim = 2;
    for (std::size_t i = first_ + rim; i + rim < end_; ++i)
      if (law_[i - first_] < -limits[i] && std::fabs(force_[i - first_]) <= limits[i]) samples.push_back(i);
    return samples;
  }

private:
  std::size_t first_, end_;
  std::vector<double> force_, law_;
};

struct Found {
  std::vector<ContactPiece> pieces;
  Vector3d unknowns = Vector3d::Zero();
  LawEstimate law;
};

Found fit(const DrumSignals &signals, const IdentificationSetting &setting,
          std::vector<ContactPiece> pieces) {
  Found found;
  found.pieces = std::move(pieces);
  Fitter fitter(signals, setting, found.pieces);
  fitter.solve();
  found.unknowns = fitter.unknowns();
  found.law = fitter.estimate();
  return found;
}

// Contacts and flights by the law that was found with fewer of them.
std::vector<ContactPiece> sorted_again(const DrumSignals &signals, const Found &found,
                                       const std::vector<double> &limits) {
  const double noise = noise_level(signals.force);
  std::vector<SampleRun> contacts;
  std::vector<std::vector<std::size_t>> flights; // after each contact
  for (std::size_t i = 0; i < found.pieces.size(); ++i) {
    const SampleRun &run = found.pieces[i].run;
    const bool same = !contacts.empty() && contacts.back().end == run.first;
    if (same)
      contacts.back().end = run.end;
    else
      contacts.push_back(run);
    flights.resize(contacts.size());
    if (i + 1 == found.pieces.size()) break;
    const std::size_t next = found.pieces[i + 1].run.first;
    if (next == run.end) continue;
    const Gap gap(signals, found.unknowns, found.pieces[i], next);
    if (gap.is_contact(noise, found.law.force_noise))
      contacts.back().end = next;
    else
      flights.back() = gap.flight(limits);
  }
  std::vector<ContactPiece> pieces = pieces_of(signals, contacts);
  // A flight belongs to the last piece that ends before it.
  for (const std::vector<std::size_t> &flight : flights) {
    if (flight.empty()) continue;
    auto after = std::find_if(pieces.begin(), pieces.end(),
                              [&](const ContactPiece &piece) { return piece.run.first > flight.front(); });
    if (after != pieces.begin()) std::prev(after)->flight = flight;
  }
  return pieces;
}

// Whether tension is seen, or would be if the contact could pull.
void judge_pull(const DrumSignals &signals, double force_within, Identification &result,
                const std::vector<double> &limits) {
  constexpr std::size_t enough = 3; // samples that show it
  const double noise = result.law.force_noise;
  constexpr double least_share = 0.08; // of the peak force: less may come from the data of machine or sensors
  const double peak = *std::max_element(result.force.begin(), result.force.end());
  std::size_t tensile = 0;
  double most = 0.0;
  for (std::size_t i = 1; i < signals.size(); ++i) {
    const double force = std::max(result.force[i], result.force[i - 1]); // one of them alone is an outlier
    const double limit = std::max({limits[i], 5.0 * noise, least_share * peak}) + force_within;
    if (force >= -limit) continue;
    ++tensile;
    most = std::max(most, -force);
  }
  const double k = result.law.k.mean;
  const double c = result.law.c.mean;
  if (tensile >= enough) {
    result.pull = Pull::pulls;
    result.tension = most;
    return;
  }
  // Under A the drum, which leaves with v, is pulled with c v, which takes a time of about c / k to end.
  double expected = 0.0;
  std::size_t breaks = 0;
  for (const ContactPiece &piece : result.pieces) {
    if (piece.flight.empty()) continue;
    const std::size_t last = piece.run.end - 1;
    const double v = result.v[last];
    expected += std::max(0.0, c * v);
    ++breaks;
  }
  if (breaks == 0 || !(k > 0.0)) return;
  expected /= static_cast<double>(breaks);
  result.tension = expected;
  const double visible = static_cast<double>(breaks) * std::floor(0.5 * c / k / signals.dt);
  const double limit = 5.0 * noise + *std::max_element(limits.begin(), limits.end()) + force_within;
  if (expected > 2.0 * limit && visible >= static_cast<double>(enough)) result.pull = Pull::does_not_pull;
}

void describe(const DrumSignals &signals, const Vector3d &unknowns, Identification &result) {
  const std::size_t n = signals.size();
  const bool only_force = signals.x_drum.empty() && signals.v_drum.empty();
  result.states.assign(n, SampleState::unclear);
  result.fitted.assign(n, not_there);
  result.x.assign(n, not_there);
  result.v.assign(n, not_there);
  result.force.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    result.force[i] = signals.force_at(i, unknowns[2]);
  for (const ContactPiece &piece : result.pieces) {
    // From forces alone k v0 is known, and x0 + c v0 / k.
    const double v0 = only_force ? piece.slope / unknowns[0] : piece.slope;
    const double x0 = std::isnan(piece.position)
                          ? -(piece.offset + (only_force ? unknowns[1] * v0 : 0.0)) / unknowns[0]
                          : piece.position;
    for (std::size_t j = 0; j < piece.run.size(); ++j) {
      const std::size_t i = piece.run.first + j;
      result.states[i] = SampleState::contact;
      result.fitted[i] = law_force(signals, unknowns, piece, piece.integrals, j);
      result.x[i] = x0 + v0 * static_cast<double>(j) * signals.dt + piece.integrals.twice[j];
      result.v[i] = v0 + piece.integrals.once[j];
    }
    for (const std::size_t i : piece.flight)
      result.states[i] = SampleState::flight;
  }
}

// What the fitted samples say: how many they are, and how well the law fits.
void add_quality(const DrumSignals &signals, const Found &found, std::size_t all_samples, LawEstimate &law) {
  double sum = 0.0;
  double squares = 0.0;
  double left = 0.0;
  law.samples = 0;
  for (const ContactPiece &piece : found.pieces) {
    for (std::size_t j = 0; j < piece.run.size(); ++j) {
      const double force = signals.force_at(piece.run.first + j, found.unknowns[2]);
      sum += force;
      squares += force * force;
      left += std::pow(force - law_force(signals, found.unknowns, piece, piece.integrals, j), 2);
    }
    law.samples += piece.run.size();
  }
  const auto count = static_cast<double>(law.samples);
  law.r2 = 1.0 - left / (squares - sum * sum / count);
  law.contact_share = count / static_cast<double>(all_samples);
}

} // namespace

Identification identify(const DrumSignals &signals, const IdentificationSetting &setting,
                        const std::function<void(double)> &progress) {
  const std::vector<double> first_limits = force_limits(signals, 0.0, setting.phase_within);
  const std::vector<SampleRun> loaded = loaded_runs(signals, first_limits, setting.least_force);
  if (loaded.empty())
    throw std::runtime_error("the record has no contact: the force is nowhere above its noise for 4 samples");
  Found found = fit(signals, setting, pieces_of(signals, loaded));
  std::vector<double> limits = first_limits;
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    if (progress) progress(static_cast<double>(round + 1) / (rounds + 1));
    limits =
        force_limits(signals, found.unknowns[2], std::min(setting.phase_within, found.law.phase.half_width));
    std::vector<ContactPiece> pieces = sorted_again(signals, found, limits);
    found = fit(signals, setting, std::move(pieces));
  }
  add_quality(signals, found, signals.size(), found.law);
  Identification result;
  result.law = found.law;
  result.pieces = std::move(found.pieces);
  describe(signals, found.unknowns, result);
  judge_pull(signals, setting.force_within, result, limits);
  return result;
}

LawEstimate identify_window(const DrumSignals &signals, const IdentificationSetting &setting,
                            const Identification &whole, const SampleRun &window) {
  std::vector<ContactPiece> pieces;
  for (const ContactPiece &piece : whole.pieces)
    if (piece.run.first >= window.first && piece.run.first < window.end) pieces.push_back(piece);
  if (pieces.empty()) throw std::runtime_error("no contact begins there");
  Found found = fit(signals, setting, std::move(pieces));
  add_quality(signals, found, window.size(), found.law);
  return found.law;
}

} // namespace drumlin::post
