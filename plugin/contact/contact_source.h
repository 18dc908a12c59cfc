#pragma once
// Access of the fixes to the pair style: its contact law for a pair of types, its friction, and the masses of
// balls in contacts. Each engine's adapter implements it. A fix that needs it ends the run with an error if
// the deck uses another pair style.

#include "engine.h"
#include "contact/contact_settings.h"
#include "physics/laws/friction_law.h"
#include "physics/scheme/implicit_dashpot.h"

#include <array>
#include <cmath>
#include <string>

namespace drumlin {

template <class Contact>
using TableOf = const CoefficientTable<Contact> *;
/// The coefficients of all pairs of types, of the law that the deck has chosen.
using AnyTable = OneOfLaws<TableOf>;

/// The tangential spring of a contact in the contact history.
struct TangentialSpring {
  const double *length = nullptr;    ///< m, three components, as ball i feels it; nullptr: there is none
  const double *stiffness = nullptr; ///< N/m; nullptr: that of the coefficients
};

/// The contact law in force, as the pair style applies it.
class ContactSource {
public:
  /// The law that the deck has chosen: the name of its style.
  virtual std::string law_name() const = 0;
  /// The coefficients of the law. Valid from the initialization of a run on.
  virtual AnyTable table() const = 0;
  /// The same, to be changed by a fix, of the linear law; nullptr: the deck has another. Valid until the next
  /// initialization. A fix that changes coefficients calls
  /// note_change() afterwards.
  virtual CoefficientTable<physics::LinearContact> *linear_table() = 0;
  void note_change() { ++changes_; }
  /// Number of changes of the coefficients so far.
  std::size_t changes() const { return changes_; }
  /// The law of balls i and j (local or ghost indices). \param memory of their contact, see law_memory()
  AnyLaw law(int i, int j, double memory) const;
  /// Suction F_a, N, of balls i and j, which the law does not contain.
  double suction(int i, int j) const;
  /// What that law depends on besides the types of the balls: their masses, kg, and radii, m.
  std::array<double, 4> sizes(int i, int j) const {
    return {mass(i), mass(j), balls().radius[i], balls().radius[j]};
  }
  /// The present friction of balls i and j, whose law is `law` and whose overlap, m, is given. Not for
  /// FrictionModel::none.
  physics::Friction friction(int i, int j, const AnyLaw &law, double overlap,
                             const TangentialSpring &spring) const;
  /// Mass (kg) of ball i (local or ghost index) as its contacts feel it: infinite if it is frozen, the body's
  /// if it belongs to a rigid body.
  virtual double mass(int i) const = 0;
  /// Effective mass (kg) of the contact of balls i and j, of which one at most is frozen.
  double effective_mass(int i, int j) const {
    const double mi = mass(i);
    const double mj = mass(j);
    return std::isinf(mi) ? mj : std::isinf(mj) ? mi : physics::effective_mass(mi, mj);
  }
  /// The dashpots of ball i (local) if it touches all walls at once; their sum is infinite if there are
  /// meshes, of which it may touch any number of triangles.
  virtual physics::Dashpots wall_dashpots(int i) const = 0;
  virtual FrictionModel friction_model() const = 0;
  /// Neighbour list of the pairs of balls that have this law, each pair once (twice across ranks with newton
  /// off).
  virtual const LAMMPS_NS::NeighList *contact_list() const = 0;
  /// What the contact of ball i and its jj-th neighbour in that list remembers; valid until the list is built
  /// anew. nullptr if contacts remember nothing.
  virtual const double *history(int i, int jj) const = 0;
  /// Where in that its numbers are.
  virtual const HistoryPlaces &places() const = 0;
  /// The tangential spring of that contact.
  TangentialSpring tangential_spring(int i, int jj) const {
    return {stored(i, jj, Remembered::spring), stored(i, jj, Remembered::stiffness)};
  }
  /// What it remembers for its law; nullptr: the law remembers nothing.
  const double *law_memory(int i, int jj) const { return stored(i, jj, Remembered::memory); }

protected:
  ContactSource() = default;
  ~ContactSource() = default;
  ContactSource(const ContactSource &) = default;
  ContactSource &operator=(const ContactSource &) = default;
  virtual const LAMMPS_NS::Atom &balls() const = 0;
  virtual physics::Cap cap() const = 0;

private:
  std::size_t changes_ = 0;

  const double *stored(int i, int jj, Remembered what) const {
    const int place = places()[what];
    return place < 0 ? nullptr : history(i, jj) + place;
  }
};

/// What ContactSource::law_memory() points to.
inline double memory_at(const double *memory) { return memory != nullptr ? *memory : 0.0; }

/// The law of a pair of balls for a fix that needs it in every step.
class PairLaw {
public:
  PairLaw(const ContactSource &source, int i, int j, double memory)
      : sizes_(source.sizes(i, j)), memory_(memory), changes_(source.changes()),
        law_(source.law(i, j, memory)) {}
  /// Makes the law anew if the mass or the radius of a ball, the coefficients, or what the contact remembers,
  /// has changed.
  void follow(const ContactSource &source, int i, int j, double memory) {
    if (memory != memory_ || source.changes() != changes_ || source.sizes(i, j) != sizes_)
      *this = PairLaw(source, i, j, memory);
  }
  const AnyLaw &law() const { return law_; }

private:
  std::array<double, 4> sizes_;
  double memory_;
  std::size_t changes_;
  AnyLaw law_;
};

/// Ends the run if the engine gives ghosts wrong velocities across the sides of a box that deforms. \param
/// command for the error
void check_deforming_box(const engine::LAMMPS *lmp, const std::string &command);

/// The error text of a fix that needs one of the plugin's contact laws, where the deck has another pair
/// style.
std::string other_pair_style(const engine::LAMMPS *lmp, const std::string &command);

/// Source of the pair style of this engine instance, or of the part of a hybrid pair style that has one of
/// the laws; nullptr if there is none, or more than one. Valid from the initialization of a run on.
ContactSource *contact_source(engine::LAMMPS *lmp);
/// The name of the law that the deck has chosen; empty: another pair style, or none.
std::string law_name(engine::LAMMPS *lmp);

} // namespace drumlin
