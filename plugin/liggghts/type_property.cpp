#include "liggghts/type_property.h"

#include "fix_property_global.h"

#include <fmt/format.h>
#include <utility>

namespace drumlin {

TypeProperty::TypeProperty(LAMMPS *engine, std::string command, const char *name, int ntypes, Of of)
    : Pointers(engine), command_(std::move(command)), name_(name), ntypes_(ntypes), of_(of),
      fix_(static_cast<LAMMPS_NS::FixPropertyGlobal *>(modify->find_fix_property(
          name, "property/global", of == Of::pair ? "peratomtypepair" : "peratomtype", ntypes,
          of == Of::pair ? ntypes : 0, command_.c_str(), false))) {}

double TypeProperty::checked(double value, const std::string &types, const physics::Range &range) {
  if (!range.contains(value))
    error->all(FLERR, engine::error_text(fmt::format("{}: property {} of {} is {}; allowed: {}", command_,
                                                     name_, types, value, physics::detail::text_of(range))));
  return value;
}

double TypeProperty::operator()(int i, int j, const physics::Range &range) {
  return checked(fix_->compute_array(i - 1, j - 1), fmt::format("types {} and {}", i, j), range);
}

double TypeProperty::operator()(int i, const physics::Range &range) {
  return checked(fix_->compute_vector(i - 1), fmt::format("type {}", i), range);
}

void TypeProperty::require(const std::string &meaning) const {
  if (given()) return;
  const std::string form = of_ == Of::pair
                               ? fmt::format("peratomtypepair {}' and {}", ntypes_, ntypes_ * ntypes_)
                               : fmt::format("peratomtype' and {}", ntypes_);
  error->all(FLERR, engine::error_text(fmt::format(
                        "{}: property {} ({}) is missing; allowed: 'fix ID all property/global {} {} values",
                        command_, name_, meaning, name_, form)));
}

} // namespace drumlin
