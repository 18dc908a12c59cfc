#include "chain_model.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

namespace drumlin::post {

namespace {

constexpr double pi = 3.14159265358979323846;

struct NamedCase {
  const char *name;
  double k;
  double D;
  double omega;
};

// Table 1 of the paper: what differs between the cases.
constexpr std::array<NamedCase, 4> table1 = {{
    {"I", 5e6, 0.5, 40.0 * pi},
    {"II", 100e6, 0.5, 40.0 * pi},
    {"III", 100e6, 0.5, 80.0 * pi},
    {"IV", 100e6, 2.0, 80.0 * pi},
}};

std::string not_positive(const char *name, double value, const char *unit) {
  if (std::isfinite(value) && value > 0.0) return {};
  return fmt::format("{} = {}: allowed are positive finite numbers [{}]", name, value, unit);
}

std::string negative(const char *name, double value, const char *unit) {
  if (std::isfinite(value) && value >= 0.0) return {};
  return fmt::format("{} = {}: allowed are finite numbers of at least 0 [{}]", name, value, unit);
}

} // namespace

std::string transition_name(Transition transition) { return transition == Transition::A ? "A" : "B"; }

Transition transition_from_name(const std::string &name) {
  if (name == "A") return Transition::A;
  if (name == "B") return Transition::B;
  throw std::invalid_argument(fmt::format("transition = '{}': allowed are A and B", name));
}

double ChainParameters::damping() const { return 2.0 * D * std::sqrt(m2 * k); }

double ChainParameters::period() const { return 2.0 * pi / omega; }

std::string ChainParameters::invalid() const {
  const std::array<std::string, 9> faults = {
      not_positive("m2", m2, "kg"), not_positive("m3", m3, "kg"),          not_positive("k", k, "N/m"),
      negative("D", D, "-"),        not_positive("omega", omega, "rad/s"), negative("Fw", Fw, "N"),
      negative("k23", k23, "N/m"),  negative("c23", c23, "N s/m"),         negative("g", g, "m/s2"),
  };
  for (const std::string &fault : faults)
    if (!fault.empty()) return fault;
  if (k23 == 0.0 && g > 0.0)
    return fmt::format(
        "k23 = 0 with g = {}: the frame has nothing to rest on; allowed are positive k23 [N/m], or "
        "k23 = 0 with g = 0",
        g);
  return {};
}

ChainParameters table1_case(const std::string &name, Transition transition) {
  for (const NamedCase &entry : table1) {
    if (name != entry.name) continue;
    ChainParameters parameters;
    parameters.k = entry.k;
    parameters.D = entry.D;
    parameters.omega = entry.omega;
    parameters.transition = transition;
    return parameters;
  }
  throw std::invalid_argument(fmt::format("case = '{}': allowed are I, II, III and IV", name));
}

} // namespace drumlin::post
