#include "chain/parameters.h"

#include "files/roller.h"
#include "support/csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace drumlin::post {

namespace {

constexpr double PI = 3.14159265358979323846; // its name in the decks

// A line of a case as CMake takes it from the decks inputs/chain/case.*.
struct CaseRow {
  const char *name;
  double k, D, omega;
};
constexpr std::array<CaseRow, table1_cases.size()> rows = {{
#include <cases.inc>
}};

} // namespace

std::string transition_name(Transition transition) { return transition == Transition::A ? "A" : "B"; }

Transition transition_from_name(const std::string &name) {
  if (name == "A") return Transition::A;
  if (name == "B") return Transition::B;
  throw std::invalid_argument(refusal("transition", name, "A, B"));
}

double ChainParameters::damping() const { return 2.0 * D * std::sqrt(m2 * k); }

double ChainParameters::period() const { return 2.0 * PI / omega; }

const std::array<ChainNumber, 9> chain_numbers = {{
    {"k", &ChainParameters::k, {1e-6, 1e15, "N/m"}, "contact stiffness [N/m]"},
    {"D", &ChainParameters::D, {1e-12, 1e6, "", true}, "contact damping ratio [-], c = 2 D sqrt(m2 k)"},
    {"omega", &ChainParameters::omega, {1e-6, 1e9, "rad/s"}, "angular frequency of the excitation [rad/s]"},
    {"Fw", &ChainParameters::Fw, {1e-9, 1e15, "N", true}, "amplitude of the excitation force [N]"},
    {"m2", &ChainParameters::m2, {1e-6, 1e12, "kg"}, "mass of the drum [kg]"},
    {"m3", &ChainParameters::m3, {1e-6, 1e12, "kg"}, "mass of the frame [kg]"},
    {"k23", &ChainParameters::k23, {1e-6, 1e13, "N/m", true}, "stiffness of the bond drum - frame [N/m]"},
    {"c23", &ChainParameters::c23, {1e-9, 1e15, "N s/m", true}, "damping of the bond drum - frame [N s/m]"},
    {"g", &ChainParameters::g, {1e-9, 1e6, "m/s2", true}, "gravity [m/s2]"},
}};

std::string ChainParameters::invalid() const {
  for (const ChainNumber &number : chain_numbers)
    if (const double value = this->*number.value; !number.range.holds(value))
      return refusal(number.name, value, number.range.words());
  if (k23 == 0.0 && g > 0.0)
    return refusal(
        "k23", k23,
        fmt::format("numbers above 0 [N/m], or 0 with g = 0: with g = {} the frame has nothing to rest on",
                    g));
  return {};
}

ChainParameters table1_case(const std::string &name, Transition transition) {
  const auto *const row =
      std::find_if(rows.begin(), rows.end(), [&](const CaseRow &entry) { return name == entry.name; });
  if (row == rows.end())
    throw std::invalid_argument(refusal("case", name, fmt::format("{}", fmt::join(table1_cases, ", "))));
  ChainParameters p;
  p.k = row->k;
  p.D = row->D;
  p.omega = row->omega;
  p.transition = transition;
  return p;
}

void set_machine(ChainParameters &p, const Roller &roller, const RollerSetting &setting) {
  p.m2 = roller.m2;
  p.m3 = roller.m3;
  p.k23 = roller.k23;
  p.c23 = roller.c23;
  p.omega = 2.0 * PI * setting.frequency;
  p.Fw = setting.me_re * p.omega * p.omega;
}

std::vector<std::pair<std::string, std::string>> parameter_values(const ChainParameters &p) {
  std::vector<std::pair<std::string, std::string>> values = {{"transition", transition_name(p.transition)}};
  for (const ChainNumber &number : chain_numbers)
    values.emplace_back(number.name, number_text(p.*number.value));
  return values;
}

} // namespace drumlin::post
