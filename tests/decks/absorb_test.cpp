// fix boundary/absorb in both engines: waves on a chain and on a hexagonal lattice, of which the boundary
// reflects the share of closed forms; settlement; energy balance; balls on its springs.
#include "tests/support/engine_runs.h"
#include "tests/support/oscillator.h"

namespace drumlin::test {
namespace {

using Complex = std::complex<double>;
constexpr double k = 1e8, m = 2, d = 0.04; // N/m of a contact, kg and m of a ball, as in absorb.scene
constexpr double no_layer = std::numeric_limits<double>::infinity();
const double tau = std::sqrt(m / k); // s

struct Placed {
  std::array<double, 3> x, v;
};

/// Writes balls.data of a box with the lower corner at 0.
void write_balls(const Scratch &folder, const std::array<double, 3> &box, const std::vector<Placed> &balls) {
  std::ofstream data(folder / "balls.data");
  data.precision(17);
  data << "Balls of absorb.scene\n\n" << balls.size() << " atoms\n1 atom types\n\n";
  for (std::size_t a = 0; a < 3; ++a)
    data << "0 " << box[a] << ' ' << "xyz"[a] << "lo "
         << "xyz"[a] << "hi\n";
  data << "\nAtoms\n\n";
  for (std::size_t n = 0; n < balls.size(); ++n)
    data << n + 1 << " 1 " << d << " 1000 " << balls[n].x[0] << ' ' << balls[n].x[1] << ' ' << balls[n].x[2]
         << '\n';
  data << "\nVelocities\n\n";
  for (std::size_t n = 0; n < balls.size(); ++n)
    data << n + 1 << ' ' << balls[n].v[0] << ' ' << balls[n].v[1] << ' ' << balls[n].v[2] << " 0 0 0\n";
}

/// The lines of a boundary that lies below (or above) its balls.
std::string boundary(const std::string &name, const std::string &ids, bool below, double area, double density,
                     double cp, double cs, double depth, bool keep) {
  return "group " + name + " id " + ids + "\nfix " + name + " " + name + " boundary/absorb normal 0 0 " +
         (below ? "-1" : "1") + " area " + number(area) + " density " + number(density) + " speeds " +
         number(cp) + " " + number(cs) + (depth < no_layer ? " depth " + number(depth) : "") + " static " +
         (keep ? "yes" : "no") + "\n";
}

void write_fixes(const Scratch &folder, const std::string &lines, const std::string &ground = "0",
                 const std::string &work = "0", const std::string &shift = "0") {
  std::ofstream(folder / "fixes") << lines << "variable ground equal " << ground << "\nvariable work equal "
                                  << work << "\nvariable shift equal " << shift << "\n";
}

/// A harmonic wave on rows of mass m a period, which stiffnesses k connect: w = 2 sqrt(k/m) sin(theta/2),
/// with the phase theta from row to row. The row at the end also has a dashpot c and a spring K.
struct Wave {
  double w, theta, row_k;

  /// Amplitude of the reflected over that of the arriving wave. For n rows from the boundary the motion is
  /// exp(i n theta) + r exp(-i n theta); r makes the force of dashpot and spring that of the missing row.
  Complex reflected(double c, double K) const {
    const Complex missing = row_k - K - Complex(0, w * c), back = std::polar(1.0, -theta);
    return -(row_k * back - missing) / (row_k / back - missing);
  }
};

/// The wave of a frequency, of which velocity Verlet makes (2/dt) sin(w dt/2).
Wave wave_of(double w, double row_k, double dt) {
  return {w, 2 * std::asin(std::sin(w * dt / 2) / dt * std::sqrt(m / row_k)), row_k};
}

/// Amplitude of the reflected over that of the arriving wave, in rows of complex amplitudes from the boundary
/// on, by least squares.
Complex measured_reflection(const Wave &wave, const std::vector<Complex> &rows) {
  Complex across = 0, in = 0, out = 0; // of the normal equations
  const auto count = static_cast<double>(rows.size());
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const Complex phase = std::polar(1.0, static_cast<double>(n) * wave.theta);
    across += std::conj(phase) * std::conj(phase);
    in += std::conj(phase) * rows[n];
    out += phase * rows[n];
  }
  const Complex arriving = (count * in - across * out) / (count * count - std::norm(across));
  return (out - std::conj(across) * arriving) / count / arriving;
}

constexpr int samples = 16, per_period = 640; // dumps and steps in the period of the lowest frequency

/// Complex amplitude of a ball's coordinate in the last period, at a multiple of its frequency.
Complex amplitude(const std::vector<Frame> &frames, long id, std::size_t axis, int multiple) {
  Complex sum = 0;
  for (int s = 0; s < samples; ++s) {
    const Frame &frame = frames[frames.size() - samples + static_cast<std::size_t>(s)];
    sum += frame.balls.at(id).x[axis] * std::polar(1.0, -2 * pi * multiple * s / samples);
  }
  return sum;
}

class Absorb : public BothEngines {
protected:
  static bool second() { return std::get<1>(GetParam()) == "second"; }
};

/// A chain with a boundary below, and the frequency that comes from above as a multiple of the lowest one.
struct Chain {
  double layer; // w H/c_p; infinite: no layer; 0: a fixed ball
  int multiple;
};

const std::vector<Chain> &chains() {
  static const std::vector<Chain> all = {
      {0.1, 1}, {0.2, 1},      {0.35, 1},     {0.5, 1},      {0.75, 1},     {1, 1},   {1.5, 1},
      {2, 1},   {no_layer, 1}, {no_layer, 2}, {no_layer, 3}, {no_layer, 5}, {0.5, 3}, {0, 1}};
  return all;
}

struct ChainsRun {
  std::vector<double> measured, exact; // share of the energy that is reflected
  std::vector<double> theta;
};

ChainsRun run_chains(const std::string &engine, const std::string &stepping) {
  const int length = 32, cycles = 10;
  const double a = 0.99 * d, cp = a / tau, density = m / a; // area 1 m2 a chain
  const double lowest = 2 / tau * std::sin(0.1), dt = 2 * pi / lowest / per_period;
  const Scratch folder;
  std::vector<Placed> balls;
  std::string lines, rigid, tops;
  std::map<int, std::string> driven; // balls by the multiple of the frequency
  ChainsRun run;
  std::vector<Wave> waves;
  for (std::size_t c = 0; c < chains().size(); ++c) {
    const Chain &chain = chains()[c];
    for (int n = 0; n < length; ++n)
      balls.push_back({{d * (1 + 2 * static_cast<double>(c)), d, d + a * n}, {}});
    const std::string low = std::to_string(balls.size() - length + 1),
                      high = " " + std::to_string(balls.size());
    const double w = lowest * chain.multiple, H = chain.layer * cp / w;
    tops += high;
    driven[chain.multiple] += high;
    if (chain.layer == 0) // the last chain
      rigid = "group rigid id " + low + "\nfix rigid rigid setforce 0 0 0\n";
    else
      lines += boundary("floor" + std::to_string(c), low, true, 1, density, cp, 0, H, true);
    waves.push_back(wave_of(w, k, dt));
    run.theta.push_back(waves.back().theta);
    run.exact.push_back(
        !rigid.empty() ? 1 : std::norm(waves.back().reflected(density * cp, density * cp * cp / H)));
  }
  const auto count = static_cast<double>(chains().size());
  lines += boundary("top", tops, false, count, density, cp, 0, no_layer, true);
  for (const auto &[multiple, ids] : driven) {
    const std::string name = "driven" + std::to_string(multiple);
    lines.append("group ").append(name).append(" id").append(ids).append("\nfix ").append(name);
    lines.append(" ")
        .append(name)
        .append(" drum/excite amplitude 100 omega ")
        .append(number(lowest * multiple));
    lines.append(" direction 0 0 1 ramp ").append(number(3 * per_period * dt)).append("\n");
  }
  write_balls(folder, {d * 2 * count, 0.1, d * (length + 2)}, balls);
  write_fixes(folder, lines + rigid);
  well(run_scene(engine, "absorb",
                 given("stepping {}, dt {}, steps {}, every {}, rows {}", stepping, dt, cycles * per_period,
                       per_period / samples, cycles * per_period),
                 folder.path()));
  const std::vector<Frame> frames = read_dump(folder / "balls.txt");
  for (std::size_t c = 0; c < chains().size(); ++c) {
    std::vector<Complex> rows;
    for (int n = 0; n + 1 < length; ++n) // the last ball is driven
      rows.push_back(amplitude(frames, static_cast<long>(c) * length + n + 1, 2, chains()[c].multiple));
    run.measured.push_back(std::norm(measured_reflection(waves[c], rows)));
  }
  return run;
}

// The scheme's error is of second order in w dt under `second`, of first under `stock`.
void expect_closed_form(const ChainsRun &run, bool second) {
  for (std::size_t c = 0; c < chains().size(); ++c) {
    const double layer = chains()[c].layer, theta = run.theta[c];
    const double step = 2 * pi * chains()[c].multiple / per_period; // w dt
    const std::string name = "w H/c_p " + number(layer) + ", theta " + number(theta);
    ::testing::Test::RecordProperty("chain_" + std::to_string(c), name + ": " + number(run.measured[c]) +
                                                                      ", exact " + number(run.exact[c]));
    EXPECT_NEAR(run.measured[c], run.exact[c], second ? 2.5 * step * step : 0.6 * step) << name;
    // In the continuum; the lattice differs by the finite length of the wave.
    const double continuum = 1 / (1 + 4 * layer * layer);
    EXPECT_NEAR(run.exact[c], continuum, layer < no_layer ? 0.3 * theta : theta * theta / 12) << name;
    if (layer == no_layer) {
      EXPECT_NEAR(run.exact[c], std::pow(std::tan(theta / 4), 2), 1e-4) << name;
    }
  }
}

TEST(AbsorbOnChains, ReflectsTheShareOfTheEnergyOfTheClosedFormAndTheSameInBothEngines) {
  const ChainsRun run = run_chains("liggghts", "second");
  expect_closed_form(run, true);
  SKIP_WITHOUT_LAMMPS(true);
  const ChainsRun there = run_chains("lammps", "second");
  for (std::size_t c = 0; c < chains().size(); ++c)
    EXPECT_NEAR(run.measured[c], there.measured[c], 1e-9) << c;
}

TEST(AbsorbOnChains, ReflectsNearlyThisShareUnderStockStepping) {
  expect_closed_form(run_chains("liggghts", "stock"), false);
}

// Plane waves along the normal of the rows of a hexagonal lattice, compression and shear at once. A contact
// with the force F at an angle of 60 degrees to the rows has the stiffness k along its normal and -F/L across
// it.
TEST_P(Absorb, ReflectsPlaneWavesOfCompressionAndShearOnAHexagonalLattice) {
  const int columns = 4, length = 30, cycles = 20;
  const double pressed = 1e-3, a = (1 - pressed) * d, h = a * std::sqrt(0.75), F_over_L = k * pressed * d / a;
  const double k_p = 2 * (0.75 * k - 0.25 * F_over_L), k_s = 2 * (0.25 * k - 0.75 * F_over_L);
  const double density = m / (a * h), cp = h * std::sqrt(k_p / m), cs = h * std::sqrt(k_s / m),
               area = columns * a;
  const double w = 2 * std::sqrt(k_p / m) * std::sin(0.11), dt = 2 * pi / w / per_period, H = 0.4 * cp / w;
  const Scratch folder;
  std::vector<Placed> balls;
  std::string low, high;
  for (int row = 0; row < length; ++row)
    for (int column = 0; column < columns; ++column) {
      balls.push_back({{a * (column + 0.25 + 0.5 * (row % 2)), d, d + h * row}, {}});
      const std::string id = " " + std::to_string(balls.size());
      if (row == 0) low += id;
      if (row + 1 == length) high += id;
    }
  write_balls(folder, {area, 0.1, d * 2 + h * length}, balls);
  const std::string shake =
      " drum/excite amplitude 1 omega " + number(w) + " ramp " + number(3 * per_period * dt);
  write_fixes(folder, boundary("floor", low, true, area, density, cp, cs, H, true) +
                          boundary("top", high, false, area, density, cp, cs, no_layer, true) +
                          "fix shake_z top" + shake + " direction 0 0 1\nfix shake_x top" + shake +
                          " direction 1 0 0\n");
  well(run("absorb", folder,
           given("dt {}, steps {}, every {}, rows {}", dt, cycles * per_period, per_period / samples,
                 cycles * per_period)));
  const std::vector<Frame> frames = read_dump(folder / "balls.txt");
  for (const bool shear : {false, true}) {
    const double speed = shear ? cs : cp;
    const Wave wave = wave_of(w, shear ? k_s : k_p, dt);
    const double exact =
        std::norm(wave.reflected(density * speed * a, density * speed * speed * a / H)); // a: area of a ball
    std::vector<Complex> rows;
    for (long row = 0; row + 1 < length; ++row)
      rows.push_back(amplitude(frames, row * columns + 1, shear ? 0 : 2, 1));
    const double measured = std::norm(measured_reflection(wave, rows));
    RecordProperty(shear ? "shear" : "compression", number(measured) + ", exact " + number(exact));
    EXPECT_NEAR(measured, exact, 2.5 * (second() ? w * w * dt * dt : w * dt / 4))
        << (shear ? "shear" : "compression");
  }
}

struct EnergyRow {
  double t, balls, ground, work, shift;
};

std::vector<EnergyRow> energy_rows(const Scratch &folder) {
  std::ifstream in(folder / "energies.txt");
  std::vector<EnergyRow> rows;
  for (EnergyRow r{}; in >> r.t >> r.balls >> r.ground >> r.work >> r.shift;)
    if (r.t > 0) rows.push_back(r); // LAMMPS has a row at the start, too
  return rows;
}

TEST_P(Absorb, SettlesUnderALoadAsTheLayerDoes) {
  const int length = 10, every = 100;
  const double cp = d / tau, density = m / d, H = 0.5, g = 9.81;
  const Scratch folder;
  std::vector<Placed> balls;
  balls.reserve(length);
  for (int n = 0; n < length; ++n)
    balls.push_back({{d, d, d + d * n}, {}});
  write_balls(folder, {0.2, 0.1, d * (length + 2)}, balls);
  write_fixes(folder,
              "fix g all gravity " + number(g) + " vector 0 0 -1\n" +
                  boundary("floor", "1", true, 1, density, cp, 0, H, false),
              "f_floor[1]+f_floor[2]", "f_floor[3]", "f_floor[7]");
  well(run("absorb", folder, given("dt 1e-5, D 0.1, steps 10000, every {}, rows {}", every, every)));
  const std::vector<EnergyRow> rows = energy_rows(folder);
  const std::vector<Frame> frames = read_dump(folder / "balls.txt");
  ASSERT_EQ(rows.size() + 1, frames.size());
  const double q = length * m * g, M = density * cp * cp; // of 1 m2
  EXPECT_NEAR(rows.back().shift, q * H / M, 1e-6 * q * H / M);
  double error = 0, most = 0; // energy error; work of gravity, J
  for (std::size_t n = 0; n < rows.size(); ++n) {
    double fallen = 0;
    for (const auto &[id, ball] : frames[n + 1].balls)
      fallen += m * g * (frames[0].balls.at(id).x[2] - ball.x[2]);
    error = std::max(error, std::fabs(rows[n].balls + rows[n].ground - fallen));
    most = std::max(most, fallen);
    EXPECT_EQ(rows[n].work, 0);
  }
  RecordProperty("energy_error", number(error / most));
  EXPECT_LT(error, 1e-3 * most);
}

// A pulse on a compressed chain whose ends keep their reaction: it neither expands nor creeps, and the energy
// of the pulse turns into heat of the dashpots.
TEST_P(Absorb, KeepsTheStaticReactionAndBalancesTheEnergyOfAPulse) {
  const int length = 60;
  const double pressed = 0.01, a = (1 - pressed) * d, cp = a / tau, density = m / a;
  const Scratch folder;
  std::vector<Placed> balls;
  double start = 0.5 * k * std::pow(pressed * d, 2) * (length - 1), pulse = 0;
  for (int n = 0; n < length; ++n) {
    const double v = 0.05 * std::exp(-std::pow((n - 30) / 4.0, 2));
    balls.push_back({{d, d, d + a * n}, {0, 0, v}});
    pulse += 0.5 * m * v * v;
  }
  write_balls(folder, {0.2, 0.1, d * (length + 2)}, balls);
  write_fixes(folder,
              boundary("floor", "1", true, 1, density, cp, 0, 0.1, true) +
                  boundary("top", std::to_string(length), false, 1, density, cp, 0, no_layer, true),
              "f_floor[1]+f_floor[2]+f_top[1]+f_top[2]", "f_floor[3]+f_top[3]", "f_top[6]");
  well(run("absorb", folder,
           second() ? given("dt {}, steps 10000, rows 20", 0.05 * tau)
                    : given("dt {}, steps 20000, rows 40", 0.025 * tau)));
  const std::vector<EnergyRow> rows = energy_rows(folder);
  ASSERT_EQ(rows.size(), 500u);
  double error = 0, most_work = 0;
  for (const EnergyRow &row : rows) {
    error = std::max(error, std::fabs(row.balls + row.ground - row.work - start - pulse));
    most_work = std::max(most_work, std::fabs(row.work));
  }
  RecordProperty("energy_error", number(error / pulse));
  EXPECT_LT(error, 1e-3 * pulse);
  EXPECT_GT(most_work, 10 * pulse); // so the constant forces take part in the balance
  EXPECT_NEAR(rows.back().ground, pulse, 1e-3 * pulse);
  EXPECT_NEAR(rows.back().shift, -k * pressed * d, 1e-6 * k * pressed * d); // the force on the upper end
}

// Balls on soft springs that cross the borders of the periodic box, and two that touch and keep their
// reaction.
TEST_P(Absorb, BallsThatMoveFollowTheOscillator) {
  if (!second()) return;                                                         // of first order
  constexpr double density = 0.2, cp = 10, cs = 5, H = 8e-4, vx = 2.5, vz = 4.5; // of absorb.moving
  const Scratch folder;
  well(run("absorb", folder,
           given("data {}, fixes {}, dt 2e-5, steps 3000, every 3000",
                 test_deck("absorb.moving.data").string(), test_deck("absorb.moving").string())));
  const std::vector<Frame> frames = read_dump(folder / "balls.txt");
  const double w = std::sqrt(density * cp * cp / H / m), time = 3000 * 2e-5;
  for (long n = 1; n <= 7; ++n) {
    const Ball &start = frames.front().balls.at(n), &ball = frames.back().balls.at(n);
    const auto motion = [&](double speed, double v0) {
      return oracle::Oscillator{m, density * speed * speed / H, density * speed}.at(time, 0, v0).x;
    };
    EXPECT_NEAR(ball.x[2] - start.x[2], motion(cp, vz), 1e-5 * vz / w) << n;
    const double across =
        std::remainder(ball.x[0] - start.x[0] - motion(cs, -vx), 0.2); // of the periodic box
    EXPECT_NEAR(across, 0, 1e-5 * vx / w) << n;
  }
}

INSTANTIATE_TEST_SUITE_P(Decks, Absorb, engines_and_steppings(), engine_and_stepping);

} // namespace
} // namespace drumlin::test
