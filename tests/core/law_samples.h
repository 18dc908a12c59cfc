#pragma once
/// Parameters for every law of the list, from the table of each: what tests of all laws take.
#include "tests/support/prelude.h"
#include "physics/laws/laws.h"

namespace drumlin::test {

/// A number that a parameter may be: its size is `size` for the first of a law, `share` of it for further
/// ones with the same unit, and a small number for one without a unit.
template <class Parameter, class First>
double sample_number(const Parameter &p, const First &first, std::size_t place, double size, double share) {
  if (std::isfinite(p.range.most)) return 0.6 * p.range.most;
  if (p.unit[0] == '\0') return p.range.least + 2.0;
  return std::string(p.unit) == first.unit && place > 0 ? share * size : size;
}

/// A contact whose stored energy at an overlap is in proportion to `size`. Damping and transition are not
/// set.
template <class Contact>
Contact sample_contact(double size, double share = 0.4) {
  constexpr auto table = Contact::parameters();
  Contact contact;
  for (std::size_t n = 0; n < table.size(); ++n)
    if (!table[n].of_friction) contact.*table[n].value = sample_number(table[n], table[0], n, size, share);
  contact.set_defaults();
  return contact;
}

/// What calls of a function for each parameter that a deck has to give say of a law: those of its materials,
/// or else those of its pairs. \param call called with the parameter and its number
template <class Contact, class Call>
void for_each_given(double size, const Call &call) {
  const auto table = [&](const auto &parameters) {
    for (std::size_t n = 0; n < parameters.size(); ++n)
      call(parameters[n], sample_number(parameters[n], parameters[0], n, size, 0.4));
  };
  if constexpr (Contact::material().size() > 0)
    table(Contact::material());
  else
    table(Contact::parameters());
}

/// Whether a deck may leave a parameter out.
template <class Parameter>
bool may_be_left_out(const Parameter &p) {
  if constexpr (std::is_same_v<Parameter, physics::MaterialParameter>)
    return false;
  else
    return p.of_friction;
}

} // namespace drumlin::test
