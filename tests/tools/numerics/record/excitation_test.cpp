// The exciter's frequency and phase from records of a roller that an independent program made: Runge-Kutta of
// fourth order with a fixed step, which shares no code with the solvers of the tools. In flight its
// accelerations fulfil the equations of motion exactly, wherever its steps met the events.
#include "tests/support/prelude.h"
#include "record/excitation.h"

namespace drumlin::test {
namespace {

using namespace drumlin::post;

/// A roller of 12 t on a soil of one spring and one dashpot.
struct Roller {
  double m2 = 3955.0, m3 = 3713.0, k23 = 3.1e6, c23 = 31e3, me_re = 7.38, g = 9.81;
  double k = 45e6, c = 211e3, frequency = 29.3, phase = 1.0;
  bool pulls = false; // condition A

  double omega() const { return 2.0 * M_PI * frequency; }
  double Fw() const { return me_re * omega() * omega(); }
};

using State = std::array<double, 4>; // x2, v2, x3, v3, upwards

/// Accelerations of drum and frame.
std::array<double, 2> accelerations(const Roller &r, double t, const State &s, bool touches) {
  double force = touches ? -r.k * s[0] - r.c * s[1] : 0.0;
  if (!r.pulls) force = std::max(0.0, force);
  const double bond = r.c23 * (s[3] - s[1]) + r.k23 * (s[2] - s[0]);
  const double a2 = -r.g + (force + bond - r.Fw() * std::sin(r.omega() * t + r.phase)) / r.m2;
  return {a2, -r.g - bond / r.m3};
}

/// A record of `cycles` cycles at `rate` samples per second, after twenty cycles of running in.
Record record_of(const Roller &r, double rate, int cycles) {
  constexpr int inner = 40; // steps between samples
  const double h = 1.0 / rate / inner;
  State s{-(r.m2 + r.m3) * r.g / r.k, 0.0, -(r.m2 + r.m3) * r.g / r.k - r.m3 * r.g / r.k23, 0.0};
  const auto slope = [&r](double t, const State &y) {
    const auto a = accelerations(r, t, y, y[0] < 0.0);
    return State{y[1], a[0], y[3], a[1]};
  };
  const auto moved = [](const State &y, const State &d, double by) {
    State z = y;
    for (std::size_t i = 0; i < z.size(); ++i)
      z[i] += by * d[i];
    return z;
  };
  Record record;
  record.file = "made.csv";
  record.interval = 1.0 / rate;
  const auto settling = static_cast<long>(20.0 * rate / r.frequency);
  const auto samples = static_cast<long>(cycles * rate / r.frequency) + 1;
  for (long i = 0; i < settling + samples; ++i) {
    const double t = static_cast<double>(i) / rate;
    if (i >= settling) {
      const auto a = accelerations(r, t, s, s[0] < 0.0);
      record.time.push_back(static_cast<double>(i - settling) / rate);
      record.a_drum.push_back(a[0]);
      record.a_frame.push_back(a[1]);
    }
    for (int j = 0; j < inner; ++j) {
      const double u = t + j * h;
      const State k1 = slope(u, s), k2 = slope(u + 0.5 * h, moved(s, k1, 0.5 * h)),
                  k3 = slope(u + 0.5 * h, moved(s, k2, 0.5 * h)), k4 = slope(u + h, moved(s, k3, h));
      for (std::size_t n = 0; n < s.size(); ++n)
        s[n] += h / 6.0 * (k1[n] + 2.0 * k2[n] + 2.0 * k3[n] + k4[n]);
    }
  }
  record.pieces = {{0.0, record.time.back(), record.time.size()}};
  record.m2 = r.m2;
  record.m3 = r.m3;
  record.g = r.g;
  return record;
}

/// Phase of the exciter at the first sample of record_of().
double first_phase(const Roller &r, double rate) {
  const auto settling = std::floor(20.0 * rate / r.frequency);
  return std::remainder(r.omega() * settling / rate + r.phase, 2.0 * M_PI);
}

RecordOptions said(const Roller &r, double nominal) {
  RecordOptions options;
  options.omega = nominal * r.omega();
  options.me_re = r.me_re;
  return options;
}

void add_noise(Record &record, double level) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, level);
  for (auto *values : {&record.a_drum, &record.a_frame})
    for (double &value : *values)
      value += noise(random);
}

constexpr double g = 9.80665, degree = M_PI / 180.0;

// Whatever was said within 5 %, with an offset of both sensors, under both conditions.
TEST(Excitation, IsToldByTheFlights) {
  for (const bool pulls : {false, true})
    for (const double k : {45e6, 100e6, 200e6})
      for (const double nominal : {0.95, 1.0003, 1.05}) {
        Roller roller;
        roller.k = k;
        roller.c = 2.0 * 0.25 * std::sqrt(k * roller.m2);
        roller.pulls = pulls;
        SCOPED_TRACE("k " + std::to_string(k) + (pulls ? " A " : " B ") + std::to_string(nominal));
        constexpr double rate = 2000.0;
        Record record = record_of(roller, rate, 60);
        const std::vector<double> a_drum = record.a_drum, a_frame = record.a_frame;
        for (double &a : record.a_drum)
          a += 0.3 * g;
        for (double &a : record.a_frame)
          a -= 0.1 * g;
        record.omega = nominal * roller.omega();
        settle_excitation(record, said(roller, nominal));
        ASSERT_TRUE(record.phase);
        EXPECT_NEAR(*record.omega, roller.omega(), 1e-6 * roller.omega());
        EXPECT_NEAR(std::remainder(*record.phase - first_phase(roller, rate), 2.0 * M_PI), 0.0,
                    0.04 * degree);
        // The force of both sensors' offsets is gone; how it was shared, no flight tells.
        const auto force = [&roller](double a2, double a3) { return roller.m2 * a2 + roller.m3 * a3; };
        for (std::size_t i = 0; i < a_drum.size(); ++i)
          ASSERT_NEAR(force(record.a_drum[i], record.a_frame[i]), force(a_drum[i], a_frame[i]), 150.0);
      }
}

TEST(Excitation, OfANoisyRecordIsWithinItsInterval) {
  Roller roller;
  constexpr double rate = 1000.0;
  Record record = record_of(roller, rate, 60);
  add_noise(record, 0.05 * g);
  record.omega = 0.97 * roller.omega();
  settle_excitation(record, said(roller, 0.97));
  ASSERT_TRUE(record.phase);
  EXPECT_NEAR(std::remainder(*record.phase - first_phase(roller, rate), 2.0 * M_PI), 0.0,
              2.0 * record.phase_half_width + 0.1 * degree);
  EXPECT_LT(record.phase_half_width, 0.5 * degree);
}

// In unbroken contact the frequency is that of the line, and nothing tells the phase.
TEST(Excitation, OfUnbrokenContactHasAFrequencyAlone) {
  Roller roller;
  roller.k = 12e6;
  roller.c = 2.0 * 0.4 * std::sqrt(roller.k * roller.m2);
  Record record = record_of(roller, 1000.0, 120);
  record.omega = 1.04 * roller.omega();
  settle_excitation(record, said(roller, 1.04));
  EXPECT_FALSE(record.phase);
  EXPECT_NEAR(*record.omega, roller.omega(), 1e-5 * roller.omega());
}

// Every sign of every sensor, whether flights or the said phase tell it.
TEST(Excitation, FindsTheSensorThatIsTurned) {
  for (const double k : {15e6, 60e6})
    for (const bool with_phase : {true, false}) {
      if (k < 20e6 && !with_phase) continue; // unbroken contact: nothing tells which of both it is
      Roller roller;
      roller.k = k;
      roller.c = 2.0 * 0.3 * std::sqrt(k * roller.m2);
      constexpr double rate = 1000.0;
      Record right = record_of(roller, rate, 60);
      add_noise(right, 0.03 * g);
      RecordOptions options = said(roller, 1.02);
      right.omega = options.omega;
      right.Fw = roller.Fw();
      if (with_phase) right.phase = options.phase = first_phase(roller, rate) + 2.0 * degree;
      for (const std::string turned : {"a_drum", "a_frame", "a_drum and a_frame", ""}) {
        SCOPED_TRACE(turned + ", k " + std::to_string(k) + (with_phase ? ", with phase" : ""));
        Record record = right;
        for (auto &[name, values] :
             {std::pair{"a_drum", &record.a_drum}, std::pair{"a_frame", &record.a_frame}})
          if (turned.find(name) != std::string::npos)
            for (double &a : *values)
              a = -a;
        std::string message = "taken";
        try {
          settle_excitation(record, options);
        } catch (const std::runtime_error &error) {
          message = error.what();
        }
        const std::string expected =
            turned.empty() ? "taken"
                           : "made.csv: the sign of " + turned + " is 'as given'; allowed: the other one";
        EXPECT_EQ(message.substr(0, expected.size()), expected) << message;
      }
    }
}

// Where contact is not lost, nothing that another phase and force of the exciter leave counts as flights.
TEST(Excitation, OfUnbrokenContactHasNoFlights) {
  for (const double k : {8e6, 12e6, 16e6})
    for (const double D : {0.3, 0.4, 0.6}) {
      Roller roller;
      roller.k = k;
      roller.c = 2.0 * D * std::sqrt(k * roller.m2);
      roller.pulls = true;
      SCOPED_TRACE("k " + std::to_string(k) + ", D " + std::to_string(D));
      Record record = record_of(roller, 1500.0, 60);
      add_noise(record, 0.01 * g);
      record.omega = roller.omega();
      settle_excitation(record, said(roller, 1.01));
      EXPECT_FALSE(record.phase);
    }
}

/// A signal that rises when the exciter passes an angle, but not in the `missing` turn, and twice in another.
std::vector<double> pulses(const Record &record, double omega, double phase, double angle, double missing,
                           double doubled) {
  std::vector<double> signal;
  for (const double t : record.time) {
    const double turns = (omega * t + phase - angle) / (2.0 * M_PI), part = turns - std::floor(turns);
    const bool first = part < 0.1 && std::floor(turns) != missing;
    const bool second = part > 0.3 && part < 0.35 && std::floor(turns) == doubled;
    signal.push_back(first || second ? 4.8 : 0.2);
  }
  return signal;
}

// In unbroken contact, where no flight does.
TEST(Excitation, IsToldByPulses) {
  Roller roller;
  roller.k = 12e6;
  roller.c = 2.0 * 0.4 * std::sqrt(roller.k * roller.m2);
  constexpr double rate = 2000.0, angle = 40.0 * degree;
  Record record = record_of(roller, rate, 120);
  const double phase = first_phase(roller, rate);
  record.pulse = pulses(record, roller.omega(), phase, angle, 7.0, 12.0);
  RecordOptions options = said(roller, 1.04);
  options.pulse_angle = angle;
  record.omega = options.omega;
  settle_excitation(record, options);
  ASSERT_TRUE(record.phase);
  EXPECT_NEAR(*record.omega, roller.omega(), 1e-5 * roller.omega());
  const double off = std::fabs(std::remainder(*record.phase - phase, 2.0 * M_PI));
  EXPECT_LT(off, 1.5 * record.phase_within);
  EXPECT_LT(record.phase_within, 1.0 * degree);
  EXPECT_TRUE(record.wander.empty());
  const auto note = std::find_if(record.notes.begin(), record.notes.end(), [](const std::string &text) {
    return text.find(" 1 missing, 1 too many") != std::string::npos;
  });
  EXPECT_NE(note, record.notes.end());
}

// Pulses that are none, some of them alone, behind the right one by more than half a turn, or several in a
// row, move nothing.
TEST(Excitation, LeavesOutSpuriousPulses) {
  Roller roller;
  roller.k = 12e6;
  roller.c = 2.0 * 0.4 * std::sqrt(roller.k * roller.m2);
  constexpr double rate = 2000.0;
  const double phase = first_phase(roller, rate);
  for (const std::vector<double> &spurious :
       {std::vector<double>{20.6}, std::vector<double>{10.55, 20.6, 21.6, 22.45, 40.7}}) {
    Record record = record_of(roller, rate, 60);
    for (const double t : record.time) {
      const double turns = (roller.omega() * t + phase) / (2.0 * M_PI);
      bool high = turns - std::floor(turns) < 0.1;
      for (const double at : spurious)
        high = high || (turns > at && turns < at + 0.05);
      record.pulse.push_back(high ? 5.0 : 0.0);
    }
    RecordOptions options = said(roller, 1.03);
    record.omega = options.omega;
    settle_excitation(record, options);
    EXPECT_NEAR(*record.omega, roller.omega(), 1e-5 * roller.omega());
    EXPECT_NEAR(std::remainder(*record.phase - phase, 2.0 * M_PI), 0.0, 1.5 * record.phase_within);
    EXPECT_TRUE(record.wander.empty());
    EXPECT_NE(record.notes.back().find(std::to_string(spurious.size()) + " too many"), std::string::npos)
        << record.notes.back();
  }
}

// A pulse's edge is seen at the next sample. If a revolution takes nearly a whole number of samples, the
// error grows from revolution to revolution, up to a sample, and begins again: the exciter does not drift. If
// it takes just a whole number, all edges have the same error, which the record cannot tell.
TEST(Excitation, DoesNotFollowEdgesThatSamplesMove) {
  Roller roller;
  for (const double samples : {180.03, 180.0}) {
    SCOPED_TRACE(samples);
    Record record = record_of(roller, samples * roller.frequency, 120);
    record.pulse.clear();
    for (const double t : record.time)
      record.pulse.push_back(std::fmod(roller.omega() * t + 0.01, 2.0 * M_PI) < 0.6 ? 5.0 : 0.0);
    RecordOptions options = said(roller, 0.98);
    record.omega = options.omega;
    record.m2.reset(); // the pulses alone
    settle_excitation(record, options);
    EXPECT_TRUE(record.wander.empty());
    EXPECT_NEAR(std::remainder(record.angle(0) - roller.omega() * record.time[0] - 0.01, 2.0 * M_PI), 0.0,
                record.phase_within);
    EXPECT_LT(record.phase_within, 1.5 * degree); // a sample has 2 degrees
  }
}

// A frequency that goes up and down by 0.5 %: the pulses follow the angle.
TEST(Excitation, FollowsADriftByPulses) {
  Roller roller;
  constexpr double rate = 2000.0, swing = 0.4;
  Record record = record_of(roller, rate, 120);
  const double length = record.time.back();
  const std::vector<double> steady = record.a_drum;
  std::vector<double> angles;
  record.pulse.clear();
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double t = record.time[i];
    angles.push_back(roller.omega() * t + swing * std::sin(2.0 * M_PI * t / length));
    record.pulse.push_back(std::fmod(angles.back(), 2.0 * M_PI) < 0.6 ? 5.0 : 0.0);
    const double at = std::clamp((angles.back() / roller.omega() - record.time.front()) / record.interval,
                                 0.0, static_cast<double>(record.size()) - 1.001);
    const auto before = static_cast<std::size_t>(at);
    const double share = at - static_cast<double>(before);
    record.a_drum[i] = (1.0 - share) * steady[before] + share * steady[before + 1]; // the drum follows
  }
  RecordOptions options = said(roller, 0.98);
  record.omega = options.omega;
  record.m2.reset(); // the pulses alone
  settle_excitation(record, options);
  ASSERT_EQ(record.wander.size(), record.size());
  constexpr double of_sample = 5.3, of_many = 3.0; // degrees
  for (std::size_t i = 0; i < record.size(); ++i) {
    const bool at_end = std::min(i, record.size() - i) < 500;
    ASSERT_NEAR(std::remainder(record.angle(i) - angles[i], 2.0 * M_PI), 0.0,
                (at_end ? of_sample : of_many) * degree);
  }
}

// A frequency that drifts, without flights and without pulses.
TEST(Excitation, DriftsWithoutFlightsAreSeen) {
  const Roller roller;
  Record record = record_of(roller, 1000.0, 60);
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double angle =
        roller.omega() * record.time[i] + 0.5 * std::sin(2.0 * M_PI * record.time[i] / record.time.back());
    record.a_drum[i] = 30.0 * std::sin(angle);
    record.a_frame[i] = -3.0 * std::sin(angle - 0.5);
  }
  record.omega = roller.omega();
  settle_excitation(record, said(roller, 1.0));
  ASSERT_FALSE(record.phase);
  try {
    refuse_drift(record);
    ADD_FAILURE() << "not refused";
  } catch (const std::runtime_error &error) {
    EXPECT_NE(std::string(error.what()).find("the phase of the drum's motion is 'wandering by "),
              std::string::npos)
        << error.what();
  }
  // With a phase that is said it is a doubt, which the whole motion may remove.
  Record said_phase = record;
  said_phase.phase = M_PI;
  settle_excitation(said_phase, said(roller, 1.0));
  EXPECT_EQ(said_phase.doubt.rfind("the phase of the drum's motion is 'wandering by ", 0), 0U)
      << said_phase.doubt;
}

TEST(Excitation, RefusesRecordsThatContradictWhatWasSaid) {
  const Roller roller;
  const auto message = [&roller](const auto &change) {
    Record record = record_of(roller, 2000.0, 60);
    RecordOptions options = said(roller, 1.0);
    record.omega = options.omega;
    change(record, options);
    try {
      settle_excitation(record, options);
    } catch (const std::runtime_error &error) {
      return std::string(error.what());
    }
    return std::string("not refused");
  };
  const auto expect = [](const std::string &text, const char *part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect(message([](Record &r, RecordOptions &o) { r.omega = o.omega = 0.8 * *o.omega; }),
         "made.csv: the frequency is '23.44'; allowed: that of the record to 6 % [Hz]");
  expect(message([](Record &r, RecordOptions &) { r.phase = 2.5; }),
         "made.csv: the phase is '143.2 degrees'; ");
  expect(message([](Record &r, RecordOptions &) {
           for (double &a : r.a_drum)
             a = -a;
         }),
         "made.csv: the sign of a_drum is 'as given'; allowed: the other one");
  expect(message([](Record &r, RecordOptions &) {
           for (double &a : r.a_drum)
             a = std::min(a, 2.0 * g);
         }),
         "made.csv: a_drum is '");
  expect(message([&roller](Record &r, RecordOptions &) {
           r.pulse = pulses(r, 0.2 * roller.omega(), 0.0, 0.0, -1.0, -1.0);
         }),
         "made.csv: the number of pulses is '");
  expect(message([](Record &r, RecordOptions &) { r.pulse.assign(r.size(), 1.0); }),
         "made.csv: pulse is '1'; allowed: a signal that rises once in each revolution");
  expect(message([](Record &r, RecordOptions &) { r.a_frame.assign(r.size(), 0.5); }),
         "made.csv: a_frame is '0.5'; allowed: values that change");
}

} // namespace
} // namespace drumlin::test
