// How often the 95 % intervals of `drumlin identify` contain the truth: a program of the night.
//
//     drumlin_coverage [RECORDS OF EACH CLASS] [SEED] [CLASS]
//
// Each record is the motion of a random roller on random soil by CVODE (tests/support/two_ends_oracle.h), as
// a logger would store it, with a roller's file as a data sheet would give it. The program ends with status 1
// if the intervals of all records together contain the truth in less than 93 or more than 97.5 %, if one is
// beyond three half widths, or if more than 5 % of the records with right data are refused.
#include "tests/support/engine_runs.h"
#include "tests/support/two_ends_oracle.h"
#include "files/roller.h"
#include "support/text.h"

namespace drumlin::test {
namespace {

constexpr double g = 9.81;

/// What a class of records is about; all others are as a careful engineer has them.
struct Class {
  std::string name;
  double least_k, most_k; ///< [N/m]
  bool ends = false;      ///< a sensor at each end, other soil below each half
  bool phase = false;     ///< the exciter's phase is given, with an error of its tolerance
  bool pulses = false;    ///< a pulse in each revolution; some are missing, some spurious
  bool frame = true;      ///< a sensor on the frame
  double machine = 0.0;   ///< tolerance of each datum of the machine [-], said in the roller's file
  bool turned = false;    ///< one sensor is mounted upside down
};

const std::vector<Class> classes = {
    {"one end, contact lost", 25e6, 200e6},
    {"one end, phase given", 8e6, 200e6, false, true},
    {"one end, pulses", 8e6, 200e6, false, false, true},
    {"one end, no sensor on the frame", 25e6, 200e6, false, false, false, false, 0.0},
    {"one end, data of the machine to 3 %", 25e6, 200e6, false, false, false, true, 0.03},
    {"one end, a sensor turned", 25e6, 200e6, false, false, false, true, 0.0, true},
    {"both ends, phase given", 20e6, 150e6, true, true},
    {"both ends, pulses", 8e6, 150e6, true, false, true},
    {"both ends, data of the machine to 3 %", 20e6, 150e6, true, true, false, true, 0.03},
};

struct Truth {
  std::vector<double> k, c; ///< of the contact, or of the left and the right half
};

class Maker {
public:
  Maker(const Class &of, unsigned seed) : of_(of), random_(seed) { draw(); }

  Truth truth; ///< of the last record

  void draw() {
    truth = {};
    const double by = between(0.85, 1.15);
    chain_.m2 = 3960.0 * between(0.8, 1.2);
    chain_.m3 = 3500.0 * between(0.8, 1.2);
    chain_.k23 = 3.1e6 * between(0.8, 1.2);
    chain_.c23 = 31e3 * between(0.7, 1.3);
    chain_.g = g;
    chain_.omega = 2.0 * pi * 30.0 * by;
    moment_ = chain_.m2 * between(1.0e-3, 1.9e-3);
    chain_.Fw = moment_ * chain_.omega * chain_.omega;
    chain_.transition = between(0.0, 1.0) < 0.5 ? post::Transition::A : post::Transition::B;
    machine_.chain = chain_;
    machine_.drum_inertia = chain_.m2 * std::pow(0.345 * width, 2);
    machine_.frame_inertia = chain_.m3 * std::pow(0.401 * width, 2);
    machine_.sensor = 0.5 * width;
    if (of_.ends) machine_.exciter = between(-0.1, 0.1);
    const double place = 0.334 * width;
    machine_.bonds = {{-place, 0.5 * chain_.k23, 0.5 * chain_.c23},
                      {place, 0.5 * chain_.k23, 0.5 * chain_.c23}};
    const double k = of_.least_k * std::pow(of_.most_k / of_.least_k, between(0.0, 1.0));
    const double share = 1.0 / (1.0 + std::exp(between(-0.8, 0.8)));
    const double D = between(0.1, 0.5), other_D = between(0.1, 0.5);
    const auto half = [&](double y, double part, double damping) {
      return AxleLink{y, part * k, 2.0 * damping * std::sqrt(0.5 * chain_.m2 * part * k)};
    };
    // On two contacts a drum may begin to rock by itself, which a sensor in the middle cannot tell.
    const double y = width / std::sqrt(12.0);
    if (of_.ends)
      machine_.contacts = {half(-y, share, D), half(y, 1.0 - share, other_D)};
    else
      machine_.contacts = {AxleLink{0.0, k, 2.0 * D * std::sqrt(chain_.m2 * k)}};
    for (const AxleLink &link : machine_.contacts) {
      truth.k.push_back(link.k);
      truth.c.push_back(link.c);
    }
  }

  /// The logger's file. Where nothing but flights can tell the exciter's phase, rollers are drawn until one
  /// flies.
  std::string record() {
    std::string text;
    while (!try_record(text))
      draw();
    return text;
  }

  /// Whether the record that it makes can tell the phase of the exciter.
  bool try_record(std::string &text) {
    const double noise = 0.005 * std::pow(40.0, between(0.0, 1.0)) * g; // 0.005 to 0.2 g
    const std::array<double, 5> rates = {500.0, 1000.0, 2000.0, 2500.0, 5000.0};
    const double rate = rates[static_cast<std::size_t>(between(of_.ends ? 1.0 : 0.0, 5.0))];
    const double begin = between(25.0, 26.0) * chain_.period();
    const auto samples = static_cast<int>(between(30.0, 80.0) * chain_.period() * rate);
    phase_ = std::remainder(chain_.omega * begin, 2.0 * pi);
    std::array<double, 3> offset{}, sign{1.0, 1.0, 1.0};
    for (double &of : offset)
      of = between(-3.0, 3.0);
    if (of_.turned) sign[between(0.0, 1.0) < 0.5 ? 0 : 2] = -1.0;
    TwoEndsState start = TwoEndsState::Zero();
    double stiffness = 0.0;
    for (const AxleLink &link : machine_.contacts)
      stiffness += link.k;
    start[0] = start[1] = -(chain_.m2 + chain_.m3) * g / stiffness;
    start[1] -= chain_.m3 * g / chain_.k23;
    TwoEndsOracle motion(machine_, start);
    text = of_.ends ? "t,l,r" : "t,d";
    if (of_.frame) text += ",f";
    if (of_.pulses) text += ",p";
    text += "\n";
    const double revolution = chain_.period();
    std::vector<double> pulses; // their times since the record's begin
    for (int n = 0; n < samples / rate / revolution + 2; ++n) {
      const double at = (n - phase_ / (2.0 * pi)) * revolution;
      if (between(0.0, 1.0) > 0.03) pulses.push_back(at);                                  // some are missing
      if (between(0.0, 1.0) < 0.03) pulses.push_back(at + between(0.2, 0.8) * revolution); // some spurious
    }
    int flying = 0;
    for (int i = 0; i < samples; ++i) {
      const double t = i / rate;
      motion.at(begin + t);
      const oracle::State rates_of = motion.rates();
      const double force = chain_.m2 * rates_of[4] + chain_.m3 * rates_of[5] + (chain_.m2 + chain_.m3) * g +
                           chain_.Fw * std::sin(chain_.omega * (begin + t));
      flying += std::fabs(force) < 1e-6 * chain_.Fw ? 1 : 0;
      const auto measured = [&](double a, std::size_t sensor) {
        return fmt::format(",{:.9g}", sign[sensor] * (a + noise * normal_(random_)) + offset[sensor]);
      };
      text += fmt::format("{:.9g}", t);
      if (of_.ends)
        text += measured(rates_of[4] - machine_.sensor * rates_of[6], 0) +
                measured(rates_of[4] + machine_.sensor * rates_of[6], 1);
      else
        text += measured(rates_of[4], 0);
      if (of_.frame) text += measured(rates_of[5], 2);
      if (of_.pulses) {
        const bool high = std::any_of(pulses.begin(), pulses.end(), [&](double at) {
          return t >= at && t < at + std::max(0.1 * revolution, 1.5 / rate);
        });
        text += fmt::format(",{:.4f}", (high ? 5.0 : 0.0) + 0.02 * normal_(random_));
      }
      text += "\n";
    }
    return of_.phase || of_.pulses || flying > 0.08 * samples;
  }

  /// The roller's file, with data that are off by their tolerance (two standard deviations).
  std::string roller() {
    const auto said = [&](double value) { return value * (1.0 + 0.5 * of_.machine * normal_(random_)); };
    std::string text = fmt::format("drum_mass {:.8g} kg\nframe_mass {:.8g} kg\nwidth {} m\n", said(chain_.m2),
                                   said(chain_.m3), width);
    const double bond_off = of_.frame ? 1.0 : 1.0 + 0.1 * normal_(random_);
    text += fmt::format("bond_stiffness {:.8g} N/m\nbond_damping {:.8g} N s/m\n", bond_off * chain_.k23,
                        bond_off * chain_.c23);
    if (!of_.frame) text += "bond_tolerance 20 %\n";
    if (of_.machine > 0.0)
      for (const char *name : {"drum_mass", "frame_mass", "eccentric_moment"})
        text += fmt::format("{}_tolerance {} %\n", name, 100.0 * of_.machine);
    if (of_.ends)
      text += fmt::format("drum_inertia {:.8g} kg m2\nframe_inertia {:.8g} kg m2\nexciter_place {:.6g} m\n",
                          machine_.drum_inertia, machine_.frame_inertia, machine_.exciter);
    return text + fmt::format("setting only\nfrequency {:.4g} Hz\neccentric_moment {:.8g} kg m\n",
                              chain_.omega / (2.0 * pi) * between(0.98, 1.02), said(moment_));
  }

  std::vector<std::string> words() {
    std::vector<std::string> words = {"--roller", "roller", "--column", "time=t"};
    const auto column = [&](const char *text) { words.insert(words.end(), {"--column", text}); };
    if (of_.ends) {
      column("a_left=l:m/s2");
      column("a_right=r:m/s2");
    } else {
      column("a_drum=d:m/s2");
    }
    if (of_.frame) column("a_frame=f:m/s2");
    if (of_.pulses) {
      column("pulse=p");
      words.insert(words.end(), {"--pulse-angle", "0"});
    }
    if (of_.phase) { // known to 3 degrees, the tolerance of a given phase
      const double off = normal_(random_) * 1.0;
      words.insert(words.end(), {"--phase", fmt::format("{:.6g}", phase_ * 180.0 / pi + off)});
    }
    return words;
  }

private:
  static constexpr double width = 2.13;
  double between(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }

  Class of_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_{0.0, 1.0};
  ChainParameters chain_;
  TwoEnds machine_;
  double moment_ = 0.0, phase_ = 0.0;
};

struct Count {
  int made = 0, refused = 0, inside = 0, judged = 0, beyond = 0;
  std::vector<double> widths;
};

/// Runs one record and counts; prints a line for what went wrong.
void judge(const Class &of, unsigned seed, Count &count) {
  Maker maker(of, seed);
  const Scratch scratch;
  post::write_files({{scratch / "record.csv", maker.record()}, {scratch / "roller", maker.roller()}});
  std::vector<std::string> words = {DRUMLIN_TOOLS, "identify", "record.csv"};
  const std::vector<std::string> more = maker.words();
  words.insert(words.end(), more.begin(), more.end());
  words.insert(words.end(), {"--out", "found"});
  const Outcome outcome = run_program(words, {}, scratch.path(), 300.0);
  ++count.made;
  if (!outcome.ok()) {
    ++count.refused;
    fmt::print("  refused: {} seed {}: {}\n", of.name, seed,
               outcome.output.substr(outcome.output.find("ERROR")));
    return;
  }
  const post::Table table = post::read_table(scratch / "found/identify.csv");
  const auto cell = [&](const std::string &column, std::size_t row) {
    const std::string text = table.has(column) ? table.text(column)[row] : std::string();
    return text.empty() ? 0.0 : post::number_from_text(text);
  };
  for (std::size_t half = 0; half < maker.truth.k.size(); ++half) // of one end row 0 is the whole record
    for (const auto &[name, unit, truth] :
         {std::tuple{"k", "N/m", maker.truth.k[half]}, std::tuple{"c", "N s/m", maker.truth.c[half]}}) {
      const double found = cell(fmt::format("{} [{}]", name, unit), half);
      const double wide = std::hypot(cell(fmt::format("{}_half_width [{}]", name, unit), half),
                                     cell(fmt::format("{}_machine [{}]", name, unit), half));
      const double off = std::fabs(found - truth) / wide;
      ++count.judged;
      count.inside += off <= 1.0 ? 1 : 0;
      if (name == std::string("k")) count.widths.push_back(wide / truth);
      if (!(off <= 3.0)) {
        ++count.beyond;
        fmt::print("  beyond: {} seed {}: {} {:.4g} +- {:.2g} for {:.4g}\n", of.name, seed, name, found, wide,
                   truth);
      }
    }
}

int run(int records, unsigned first_seed, const std::string &only) {
  Count all;
  for (const Class &of : classes) {
    if (!only.empty() && of.name.find(only) == std::string::npos) continue;
    Count count;
    for (int i = 0; i < records; ++i) {
      judge(of, first_seed + static_cast<unsigned>(i), count);
      std::fflush(stdout);
    }
    std::sort(count.widths.begin(), count.widths.end());
    fmt::print(
        "{}: {} records, {} refused, {} of {} in their intervals ({:.1f} %), {} beyond three half widths, "
        "median half width of k {:.2g} %\n",
        of.name, count.made, count.refused, count.inside, count.judged,
        100.0 * count.inside / std::max(count.judged, 1), count.beyond,
        count.widths.empty() ? 0.0 : 100.0 * count.widths[count.widths.size() / 2]);
    all.made += of.turned ? 0 : count.made;
    all.refused += of.turned ? 0 : count.refused; // a turned sensor may be refused
    all.inside += count.inside;
    all.judged += count.judged;
    all.beyond += count.beyond;
  }
  const double share = static_cast<double>(all.inside) / std::max(all.judged, 1);
  fmt::print("all: {:.1f} % in their intervals, {} beyond three half widths, {:.1f} % refused\n",
             100.0 * share, all.beyond, 100.0 * all.refused / std::max(all.made, 1));
  return share >= 0.93 && share <= 0.975 && all.beyond == 0 && all.refused <= 0.05 * all.made ? 0 : 1;
}

} // namespace
} // namespace drumlin::test

int main(int argc, char **argv) {
  const auto number = [&](int at, int usual) { return argc > at ? std::atoi(argv[at]) : usual; };
  return drumlin::test::run(number(1, 150), static_cast<unsigned>(number(2, 1)), argc > 3 ? argv[3] : "");
}
