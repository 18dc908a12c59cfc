/// Roller files: what follows from a data sheet, against values computed by hand, and what is refused.
#include "tests/support/prelude.h"
#include "physics/files/roller.h"

#include <unistd.h>

namespace {

using namespace drumlin;

constexpr double pi = 3.14159265358979323846;

class RollerFile : public testing::Test {
protected:
  RollerFile() : file_(testing::TempDir() + "drumlin_roller_" + std::to_string(::getpid())) {}
  ~RollerFile() override { std::filesystem::remove(file_); }

  Roller read(const std::string &text) const {
    std::ofstream(file_, std::ios::binary) << text;
    return read_roller(file_);
  }
  /// The error without the file's name, for which it has FILE.
  std::string fault(const std::string &text) const {
    try {
      read(text);
    } catch (const std::invalid_argument &error) {
      std::string line = error.what();
      for (std::size_t at; (at = line.find(file_)) != std::string::npos;)
        line.replace(at, file_.size(), "FILE");
      return line;
    }
    return "";
  }
  double derived(const Roller &roller, const std::string &name) const {
    const RollerSetting &setting = roller.settings.front();
    for (const DerivedValue &value : derived_values(roller, &setting, 2.0 * pi * setting.frequency))
      if (value.name == name) return value.value;
    ADD_FAILURE() << name;
    return 0.0;
  }

  std::string file_;
};

TEST_F(RollerFile, ADataSheetGivesMassesMomentAndBond) {
  // 12 t class: linear load 30 kg/cm on 2 m is 6000 kg. 250 kN at 30 Hz: m_e r_e = 250e3/(60 pi)^2 = 7.03619
  // kg m; amplitude 1.8 mm: drum 3909.00 kg, frame 2091.00 kg.
  const Roller roller =
      read("operating_mass 12 t\nlinear_load 30 kg/cm # static\nwidth 2 m\n\nfrequency 1800 1/min\n"
           "force 250 kN\namplitude 1.8 mm");
  EXPECT_NEAR(roller.m2, 3909.00, 0.01);
  EXPECT_NEAR(roller.m3, 2091.00, 0.01);
  // 1.8 mm may be 1.75 to 1.85 mm: the drum 109 kg more or less, and the frame as much less or more.
  EXPECT_NEAR(roller.m2_tolerance, 0.0278, 1e-4);
  EXPECT_NEAR(roller.m3_tolerance * roller.m3, 108.6, 0.1);
  EXPECT_EQ(roller.me_re_tolerance, 0.0);
  ASSERT_EQ(roller.settings.size(), 1U);
  EXPECT_NEAR(roller.settings[0].frequency, 30.0, 1e-12);
  EXPECT_NEAR(roller.settings[0].me_re, 7.03619, 1e-5);
  EXPECT_TRUE(roller.bond_assumed);
  EXPECT_NEAR(roller.k23, 2091.00 * 4 * pi * pi * 4.82 * 4.82, 10.0);
  EXPECT_NEAR(derived(roller, "exciter_force"), 250e3, 1e-6);
  EXPECT_NEAR(derived(roller, "exciter_force_per_metre"), 125e3, 1e-6);
  EXPECT_EQ(derived(roller, "width"), 2.0);
  EXPECT_NEAR(derived(roller, "static_load"), 58860.0, 1e-6);
  EXPECT_NEAR(derived(roller, "static_load_per_metre"), 29430.0, 1e-6);
  EXPECT_NEAR(derived(roller, "nominal_amplitude"), 1.8e-3, 1e-12);
  EXPECT_NEAR(derived(roller, "frame_frequency"), 4.82, 1e-9);
  EXPECT_NEAR(derived(roller, "frame_damping_ratio"), 0.151, 1e-9);
}

TEST_F(RollerFile, TakesMassesUnitsToleranceAndSettings) {
  const Roller roller = read("\xEF\xBB\xBF"
                             "drum_mass 6 t\r\nframe_mass 3500 kg\r\nbond_stiffness 3.1 MN/m\r\n"
                             "bond_damping 31 kN s/m\r\ndrum_mass_tolerance 1 "
                             "%\r\neccentric_moment_tolerance 3 %\r\nbond_tolerance 25 %\r\n"
                             "setting high\r\nfrequency 30 Hz\r\neccentric_moment 11.4 kg m\r\n"
                             "setting low\r\nfrequency 35 Hz\r\namplitude 0.9 mm\r\n");
  EXPECT_EQ(roller.m2, 6000.0);
  EXPECT_EQ(roller.m3, 3500.0);
  EXPECT_EQ(roller.k23, 3.1e6);
  EXPECT_EQ(roller.c23, 31e3);
  EXPECT_FALSE(roller.bond_assumed);
  EXPECT_DOUBLE_EQ(roller.m2_tolerance, 0.01);
  EXPECT_EQ(roller.m3_tolerance, 0.0);
  EXPECT_DOUBLE_EQ(roller.me_re_tolerance, 0.03);
  EXPECT_DOUBLE_EQ(roller.bond_tolerance.value_or(0.0), 0.25);
  EXPECT_EQ(setting_of(roller, "high", file_).me_re, 11.4);
  EXPECT_DOUBLE_EQ(setting_of(roller, "low", file_).me_re, 5.4);
  EXPECT_THROW(setting_of(roller, "", file_), std::invalid_argument);
  EXPECT_THROW(setting_of(roller, "middle", file_), std::invalid_argument);
  // The drum's mass may be the load without the frame.
  EXPECT_NEAR(read("drum_load 58.86 kN\nframe_mass 2 t\nfrequency 30 Hz\nforce 250 kN\n").m2, 4000.0, 1e-9);
}

TEST_F(RollerFile, TakesWhatTiltsAboutTheWayOfTravel) {
  const std::string machine = "drum_mass 4 t\nframe_mass 3 t\nfrequency 30 Hz\nforce 250 kN\n";
  const Roller plain = read(machine);
  EXPECT_FALSE(plain.drum_inertia || plain.frame_inertia || plain.sensor_place || plain.springs.left);
  EXPECT_EQ(plain.springs.share_left, 0.5);
  EXPECT_EQ(plain.exciter_place, 0.0);
  const Roller roller =
      read(machine + "width 2.1 m\ndrum_inertia 2100 kg m2\nframe_inertia 2500 kg m2\nexciter_place -5 cm\n"
                     "sensor_place 1.1 m\nbond_stiffness 3 MN/m\nbond_stiffness_left 1200 kN/m\n"
                     "bond_damping 31 kN s/m\nbond_left 670 mm\nbond_right 0.75 m\n"
                     "bond_damping_left 0 N s/m\ndamper_left 0 m\ndamper_right 0.8 m\n");
  EXPECT_EQ(roller.drum_inertia, 2100.0);
  EXPECT_EQ(roller.frame_inertia, 2500.0);
  EXPECT_DOUBLE_EQ(roller.exciter_place, -0.05);
  EXPECT_EQ(roller.sensor_place, 1.1);
  EXPECT_DOUBLE_EQ(*roller.springs.left, 0.67);
  EXPECT_EQ(roller.springs.right, 0.75);
  EXPECT_DOUBLE_EQ(roller.springs.share_left, 0.4);
  EXPECT_EQ(roller.dashpots.left, 0.0);
  EXPECT_EQ(roller.dashpots.share_left, 0.0);
  for (const auto &[line, named] :
       {std::pair("bond_left 0.7 m\n", "bond_right of 'FILE' is missing"),
        {"damper_right 0.7 m\n", "damper_left of 'FILE' is missing"},
        {"bond_stiffness 1 MN/m\nbond_stiffness_left 2 MN/m\n",
         "bond_stiffness_left of 'FILE' is '2e+06 N/m'; allowed: at most the stiffness of the whole bond, "
         "1e+06"},
        {"drum_inertia 0 kg m2\n",
         "drum_inertia in line 5 of 'FILE' is '0 kg m2'; allowed: a positive number"},
        {"bond_left -0.7 m\n", "bond_left in line 5 of 'FILE' is '-0.7 m'; allowed: 0 or a positive number"},
        {"width 2 m\nexciter_place 1.1 m\n", "exciter_place of 'FILE' is '1.1 m'; allowed: a place within"},
        {"width 2 m\nsensor_place -2.1 m\n", "sensor_place of 'FILE' is '-2.1 m'; allowed: a place at most"},
        {"exciter_place 1e9 m\n",
         "exciter_place in line 5 of 'FILE' is '1e9 m'; allowed: a number from -100 to 100 m"}})
    EXPECT_EQ(fault(machine + line).substr(0, std::string(named).size()), named);
}

TEST_F(RollerFile, RefusesWhatCannotBeRightInOneLine) {
  const std::string machine = "drum_mass 4 t\nframe_mass 3 t\n", setting = "frequency 30 Hz\nforce 250 kN\n";
  EXPECT_EQ(fault(machine + setting), "");
  EXPECT_EQ(fault(machine + "frequency 30 Hz\n"),
            "force of 'FILE' is missing; allowed: force, eccentric_moment or amplitude");
  EXPECT_EQ(fault(machine),
            "frequency of 'FILE' is missing; allowed: a frequency and a force, eccentric_moment "
            "or amplitude");
  EXPECT_EQ(fault("drum_mass 4 t\n" + setting),
            "drum_load of 'FILE' is missing; allowed: drum_load, linear_load or frame_mass");
  EXPECT_EQ(fault("drum_mas 4 t\n").substr(0, 67),
            "name in line 1 of 'FILE' is 'drum_mas'; allowed: setting, operating");
  EXPECT_EQ(fault("drum_mass 4\n"),
            "drum_mass in line 1 of 'FILE' is '4'; allowed: a number and its unit, kg or t");
  for (const char *number : {"4 5 t", "nan t", "inf t", "0x10 t", "t", "4 T", "4t"})
    EXPECT_NE(fault(std::string("drum_mass ") + number).find("allowed: a number and its unit, kg or t"),
              std::string::npos)
        << number;
  for (const char *number : {"0 t", "-4 t", "1e9 t", "1e400 t"})
    EXPECT_NE(fault(std::string("drum_mass ") + number).find("allowed: a positive number up to 1000 t"),
              std::string::npos)
        << number;
  // Each contradiction, and which value is named; M stands for the machine, S for the setting.
  for (const auto &[text, named] :
       {std::pair("MM", "drum_mass in line 3"),
        {"Mdrum_load 8 t\nS", "drum_load"},
        {"Moperating_mass 6 t\nS", "operating_mass"},
        {"drum_mass 4 t\ndrum_load 3 t\nS", "drum_load"},
        {"drum_mass 9 t\nwidth 2 m\nlinear_load 30 kg/cm\nS", "linear_load times width"},
        {"Mlinear_load 30 kg/cm\nS", "width"},
        {"MSeccentric_moment 9 kg m\n", "force"},
        {"MSamplitude 3 mm\n", "amplitude"},
        {"drum_load 7 t\nsetting a\nSamplitude 2 mm\nsetting b\nSamplitude 3 mm\n",
         "force, frequency and amplitude of setting b"},
        {"Mbond_stiffness 1 MN/m\nframe_frequency 4 Hz\nS", "frame_frequency"},
        {"Mbond_damping 1 kN s/m\nframe_damping 0.1 -\nS", "frame_damping"},
        {"Msetting a\nSsetting a\n", "setting in line 6"},
        {"Msetting a\nSwidth 2 m\n", "width in line 6"},
        {"MSsetting a\n", "setting in line 5"},
        {"Msetting\n", "setting in line 3"},
        {"Mframe_mass_tolerance 60 %\nS", "frame_mass_tolerance"}}) {
    std::string file_text;
    for (const char *letter = text; *letter != '\0'; ++letter)
      if (*letter == 'M' && letter[1] != 'N')
        file_text += machine;
      else if (*letter == 'S')
        file_text += setting;
      else
        file_text += *letter;
    const std::string line = fault(file_text);
    EXPECT_EQ(line.substr(0, std::string(named).size()), named) << line;
    EXPECT_NE(line.find("; allowed: "), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
  for (const char *name : {"/dev/zero", "/", "", "/nowhere/roller"})
    EXPECT_THROW(read_roller(name), std::invalid_argument) << name;
  EXPECT_THROW(read(""), std::invalid_argument);
}

// Blanks may separate thousands, and a comma may do so or be the decimal sign: the range that rollers have
// tells.
TEST_F(RollerFile, ReadsNumbersAsDataSheetsWriteThem) {
  const std::string rest = "frame_mass 3 t\nfrequency 30 Hz\nforce 250 kN\n";
  EXPECT_EQ(read("drum_mass 12 540 kg\n" + rest).m2, 12540.0);
  EXPECT_TRUE(read("drum_mass 12 540 kg\n" + rest).warnings.empty());
  for (const auto &[number, mass] :
       {std::pair{"12,540 kg", 12540.0}, {"4,5 t", 4500.0}, {"1,900 t", 1900.0}, {"3955,25 kg", 3955.25}}) {
    const Roller roller = read(std::string("drum_mass ") + number + "\n" + rest);
    EXPECT_EQ(roller.m2, mass) << number;
    ASSERT_EQ(roller.warnings.size(), 1u) << number;
    EXPECT_NE(roller.warnings[0].find(std::string("is '") + number + "', read as "), std::string::npos);
  }
  for (const char *number : {"1,234,567 kg", "1.2,3 t", "1,2.3 t"}) // and what is neither
    EXPECT_NE(fault(std::string("drum_mass ") + number + "\n" + rest)
                  .find(std::string("is '") + number + "'; allowed: a number whose decimal sign is a point"),
              std::string::npos)
        << number;
  // Of 150 and 0.150 vibrations a minute no roller has either.
  EXPECT_NE(fault("drum_mass 4 t\nframe_mass 3 t\nfrequency 0,150 1/min\nforce 250 kN\n")
                .find("is '0,150 1/min'; allowed: a number whose decimal sign is a point"),
            std::string::npos);
  // A drum may be 1.25 m wide, but not 1250 m.
  EXPECT_EQ(read("width 1,250 m\ndrum_mass 4 t\n" + rest).width, 1.25);
}

// Numbers that rollers do not have are read with a warning that has the unit as it was read.
TEST_F(RollerFile, WarnsOfNumbersThatRollersDoNotHave) {
  const std::string good = "drum_mass 4 t\nframe_mass 3 t\nfrequency 30 Hz\neccentric_moment 7 kg m\n";
  EXPECT_TRUE(read(good + "frame_damping 0 %\n").warnings.empty());
  for (const auto &[line, warning] :
       {std::pair{"diameter 1504 cm", "diameter in line 5 of 'FILE' is '1504 cm'; rollers have 20 to 300 cm"},
        {"frame_damping 15 -", "frame_damping in line 5 of 'FILE' is '15 -'; rollers have 0.01 to 2 -"},
        {"frame_damping 1500 %", "frame_damping in line 5 of 'FILE' is '1500 %'; rollers have 1 to 200 %"},
        {"bond_stiffness 3.1 kN/m",
         "bond_stiffness in line 5 of 'FILE' is '3.1 kN/m'; rollers have 10 to 1e+06 kN/m"},
        {"exciter_place -3 m", "exciter_place in line 5 of 'FILE' is '-3 m'; rollers have 0 to 2 m"}}) {
    std::vector<std::string> found = read(good + line).warnings;
    ASSERT_EQ(found.size(), 1U) << line;
    EXPECT_EQ(found[0].replace(found[0].find(file_), file_.size(), "FILE"), warning);
  }
  const std::vector<std::string> fast =
      read("drum_mass 4 t\nframe_mass 3 t\nfrequency 1800 Hz\neccentric_moment 7 kg m\n").warnings;
  ASSERT_EQ(fast.size(), 1U);
  EXPECT_NE(fast[0].find("is '1800 Hz'; rollers have 5 to 150 Hz"), std::string::npos) << fast[0];
  for (const std::filesystem::directory_entry &machine :
       std::filesystem::directory_iterator(DRUMLIN_SOURCE_DIR "/inputs/rollers"))
    if (machine.path().extension() != ".md") {
      EXPECT_TRUE(read_roller(machine.path().string()).warnings.empty()) << machine.path();
    }
}

// Bytes at random, and lines of a good file in which bytes are changed: each is read or refused.
TEST_F(RollerFile, AnyBytesAreReadOrRefused) {
  const std::string good = "drum_mass 4 t\nframe_mass 3 t\nsetting a\nfrequency 30 Hz\nforce 250 kN\n";
  unsigned state = 1;
  const auto random = [&state](unsigned below) {
    return (state = state * 1664525u + 1013904223u) / 65536u % below;
  };
  int accepted = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::string text = good;
    for (unsigned change = random(4); change-- > 0;)
      text[random(static_cast<unsigned>(text.size()))] = static_cast<char>(random(256));
    try {
      const Roller roller = read(text);
      ++accepted;
      EXPECT_TRUE(roller.m2 > 0.0 && roller.m3 > 0.0 && roller.k23 > 0.0 && roller.settings[0].me_re > 0.0)
          << text;
    } catch (const std::invalid_argument &error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(accepted, 40);
}

} // namespace
