// The lumped chain soil - drum - frame: its parameters, the cases of Table 1 of the paper (Wang, Sha and Hu
// 2018), the machine of a roller file, and the allowed ranges of the parameters. Everything is in SI units; x
// points up and x_drum = 0 where drum and soil just touch.
#pragma once

#include "support/units.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace drumlin {
struct Roller;
struct RollerSetting;
} // namespace drumlin

namespace drumlin::post {

/// When a contact between drum and soil begins and ends. Overlap d = x_soil - x_drum, rate d'.
enum class Transition {
  A, ///< in contact while d > 0: F_c = k d + c d' jumps at make, and is tensile just before break
  B  ///< F_c = max(0, k d + c d') for d > 0: made at d = 0, broken at F_c = 0, re-made at F_c = 0 while d > 0
};

/// "A" or "B".
std::string transition_name(Transition transition);

/// The transition called `name` ("A" or "B"). Throws std::invalid_argument, which names the value and what is
/// allowed, for any other name.
Transition transition_from_name(const std::string &name);

/// Parameters of the chain
///     m2 x2'' = -m2 g + F_c + c23 (x3' - x2') + k23 (x3 - x2) - F_e,   F_e = Fw sin(omega t)
///     m3 x3'' = -m3 g       - c23 (x3' - x2') - k23 (x3 - x2)
///     F_c = k d + c d' in contact, else 0,   d = -x2 (the soil is fixed)
/// with 2 the drum and 3 the frame. The defaults are those of the deck inputs/chain/in.chain: the values that
/// all cases of the paper have in common, and k, D and omega of case II.
struct ChainParameters {
  double m2 = 2000.0;                ///< mass of the drum [kg]
  double m3 = 1000.0;                ///< mass of the frame [kg]
  double k = 1e8;                    ///< stiffness of the contact drum - soil [N/m]
  double D = 0.5;                    ///< damping ratio of that contact [-], c = 2 D sqrt(m2 k)
  double omega = 125.66370614359172; ///< angular frequency of the excitation [rad/s]
  double Fw = 58.8e3;                ///< amplitude of the excitation force [N]
  double k23 = 1e6;                  ///< stiffness of the bond drum - frame [N/m]
  double c23 = 1e4;                  ///< damping coefficient of that bond [N s/m]
  double g = 9.81;                   ///< gravity [m/s2]
  Transition transition = Transition::B;

  /// Damping coefficient of the contact, c = 2 D sqrt(m2 k) [N s/m].
  double damping() const;
  /// Period of the excitation, 2 pi / omega [s].
  double period() const;
  /// Empty if all parameters are allowed; else one line that names the parameter, its value and what is
  /// allowed.
  std::string invalid() const;
};

/// A parameter of the chain: its name in decks, commands and files, and its allowed range. The ranges are far
/// wider than those of rollers and soils; within them no intermediate result of the exact solution overflows
/// or underflows.
struct ChainNumber {
  const char *name;
  double ChainParameters::*value;
  Range range;
  const char *help; ///< meaning and unit
};

/// All parameters that are numbers: k, D, omega, Fw, m2, m3, k23, c23, g.
extern const std::array<ChainNumber, 9> chain_numbers;

/// The chain's parameters by the names that decks, commands and parameters.csv give them, as text.
std::vector<std::pair<std::string, std::string>> parameter_values(const ChainParameters &parameters);

/// The names of the cases of the paper's Table 1.
constexpr std::array<const char *, 4> table1_cases = {"I", "II", "III", "IV"};

/// The case as the deck inputs/chain/case.NAME sets it: k, D and omega. Throws std::invalid_argument, which
/// names the value and what is allowed, for any other name.
ChainParameters table1_case(const std::string &name, Transition transition);

/// Lets the chain have the machine of a roller file: masses, bond, frequency and force of the exciter.
void set_machine(ChainParameters &parameters, const Roller &roller, const RollerSetting &setting);

} // namespace drumlin::post
