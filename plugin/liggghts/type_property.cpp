#include "liggghts/type_property.h"

#include "fix_property_global.h"

#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace drumlin {
namespace {

LAMMPS_NS::FixPropertyGlobal *find(LAMMPS_NS::Modify *modify, const char *name, const char *style, int rows,
                                   int columns, const std::string &command) {
  return static_cast<LAMMPS_NS::FixPropertyGlobal *>(
      modify->find_fix_property(name, "property/global", style, rows, columns, command.c_str(), false));
}

std::string missing(const std::string &command, const char *name, const char *meaning,
                    const std::string &form) {
  return fmt::format("{}: property {} ({}) is missing; allowed: 'fix ID all property/global {} {} values",
                     command, name, meaning, name, form);
}

} // namespace

TypePairProperty::TypePairProperty(LAMMPS *engine, std::string command, const char *name, int ntypes)
    : Pointers(engine), command_(std::move(command)), name_(name), ntypes_(ntypes),
      fix_(find(modify, name, "peratomtypepair", ntypes, ntypes, command_)) {}

double TypePairProperty::operator()(int i, int j, bool zero_allowed, double most) {
  const double value = fix_->compute_array(i - 1, j - 1);
  if (!std::isfinite(value) || value < 0.0 || (value == 0.0 && !zero_allowed) || value > most)
    error->all(FLERR, engine::error_text(fmt::format(
                          "{}: property {} of types {} and {} is {}; allowed: a finite number {} 0{}",
                          command_, name_, i, j, value, zero_allowed ? ">=" : ">",
                          most < infinity ? fmt::format(" and <= {}", most) : "")));
  return value;
}

void TypePairProperty::require(const char *meaning) const {
  if (!given())
    error->all(FLERR, engine::error_text(
                          missing(command_, name_, meaning,
                                  fmt::format("peratomtypepair {}' and {}", ntypes_, ntypes_ * ntypes_))));
}

TypeProperty::TypeProperty(LAMMPS *engine, std::string command, const char *name, const char *meaning,
                           int ntypes)
    : Pointers(engine), command_(std::move(command)), name_(name),
      fix_(find(modify, name, "peratomtype", ntypes, 0, command_)) {
  if (fix_ == nullptr)
    error->all(FLERR, engine::error_text(
                          missing(command_, name_, meaning, fmt::format("peratomtype' and {}", ntypes))));
}

double TypeProperty::operator()(int i, double above, double most) {
  const double value = fix_->compute_vector(i - 1);
  if (!std::isfinite(value) || value <= above || value > most)
    error->all(FLERR, engine::error_text(fmt::format(
                          "{}: property {} of type {} is {}; allowed: a finite number > {}{}", command_,
                          name_, i, value, above, std::isinf(most) ? "" : fmt::format(" and <= {}", most))));
  return value;
}

} // namespace drumlin
