#pragma once
// The contact laws that a deck can choose. Pair styles, walls and fixes are compiled for each law of this
// list.

#include "physics/laws/hertz_contact.h"
#include "physics/laws/linear_contact.h"
#include "physics/laws/yield_contact.h"

#include <string>
#include <tuple>
#include <variant>

namespace drumlin {

/// Adding a law is adding its parameters here, and its number among the models of LIGGGHTS.
using Laws = std::tuple<physics::LinearContact, physics::HertzContact, physics::YieldContact>;

namespace detail {

template <template <class> class Of, class List>
struct OneOf;
template <template <class> class Of, class... Contact>
struct OneOf<Of, std::tuple<Contact...>> {
  using type = std::variant<Of<Contact>...>;
};
template <class Contact>
using LawOf = typename Contact::Law;

} // namespace detail

/// One of Of<Contact> for each law.
template <template <class> class Of>
using OneOfLaws = typename detail::OneOf<Of, Laws>::type;

/// The law of one contact.
using AnyLaw = OneOfLaws<detail::LawOf>;

/// Names a law's parameters as an argument.
template <class Contact>
struct LawTag {
  using type = Contact;
};

/// Calls run(LawTag<Contact>) for each law.
template <class Run>
void for_each_law(Run &&run) {
  std::apply([&run](auto... contact) { (run(LawTag<decltype(contact)>{}), ...); }, Laws{});
}

/// What the pair styles with these laws are called, for error texts: the names behind `prefix`.
inline std::string law_names(const std::string &prefix) {
  std::string names;
  for_each_law(
      [&](auto law) { names += (names.empty() ? "" : " or ") + prefix + decltype(law)::type::name; });
  return names;
}

} // namespace drumlin
