#include "contact/contact_source.h"

#include "contact/contact_settings.h"

namespace drumlin {

AnyLaw ContactSource::law(int i, int j, double memory) const {
  const LAMMPS_NS::Atom &atom = balls();
  return std::visit(
      [&](const auto *coefficients) -> AnyLaw {
        const auto &contact = coefficients->at(atom.type[i], atom.type[j]).contact;
        using Contact = std::decay_t<decltype(contact)>;
        return contact.law(effective_mass(i, j), radius_for<Contact>(atom.radius[i], atom.radius[j]), memory);
      },
      table());
}

double ContactSource::suction(int i, int j) const {
  const int *type = balls().type;
  return std::visit([&](const auto *table) { return table->at(type[i], type[j]).suction; }, table());
}

physics::Friction ContactSource::friction(int i, int j, const AnyLaw &law, double overlap,
                                          const TangentialSpring &spring) const {
  const LAMMPS_NS::Atom &atom = balls();
  const double c = std::visit([overlap](const auto &one) { return one.dashpot(overlap); }, law);
  return std::visit(
      [&](const auto *coefficients) {
        const auto &p = coefficients->at(atom.type[i], atom.type[j]);
        using Contact = std::decay_t<decltype(p.contact)>;
        const double kt =
            spring.stiffness != nullptr
                ? *spring.stiffness
                : p.contact.tangential(overlap, radius_for<Contact>(atom.radius[i], atom.radius[j]));
        return p.tangential(kt, c, cap());
      },
      table());
}

/// The engines ask for the group of another ball than the one whose ghost they give the velocity of the side.
void check_deforming_box(const engine::LAMMPS *lmp, const std::string &command) {
  constexpr int velocities = 2; // remap v, in both engines
  for (const LAMMPS_NS::Fix *one : engine::fixes(lmp->modify)) {
    const auto *fix = std::string(one->style).rfind("deform", 0) == 0
                          ? static_cast<const LAMMPS_NS::FixDeform *>(one)
                          : nullptr;
    if (fix != nullptr && fix->remapflag == velocities && fix->igroup != 0)
      lmp->error->all(
          FLERR,
          engine::error_text(
              command + ": group of fix " + fix->id + " (deform) is '" + lmp->group->names[fix->igroup] +
              "', with remap v; allowed: all, for which the engine gives ghosts the velocity of the side"));
  }
}

std::string other_pair_style(const engine::LAMMPS *lmp, const std::string &command) {
  const char *style = lmp->force->pair_style;
  return command + ": pair_style is '" + (style != nullptr ? style : "none") +
         "'; allowed: " + law_names(engine::pair_style_before_law);
}

} // namespace drumlin
