#pragma once
// What contacts tell of the forces that they exert in a step, for those who keep the books of a bed: see fix roller/history,
// keyword soil.

#include "engine.h"

#include <algorithm>
#include <array>
#include <vector>

namespace drumlin {

/// One contact of two balls, or of a ball and a wall, in one step.
struct LedgerEntry {
  int i, j;                     ///< indices of the balls; j = -1: a wall at rest
  std::array<double, 3> normal; ///< from j to i
  double overlap;               ///< m
  double radius;                ///< of the smaller ball, m
  double share;                 ///< of the stiffnesses that acts: 1, or less on an edge of a mesh
  double normal_stiffness;      ///< N/m
  double tangential_stiffness;  ///< N/m; 0 without a tangential spring
  double normal_force;          ///< N, positive when it pushes
  const double *final_force;    ///< where it is when all forces of the step are known; nullptr: it is known
  const double *spring;         ///< tangential spring, m, three components; nullptr: none
  std::array<double, 3> tangential_force;   ///< on ball i, N
  std::array<double, 3> torque_i, torque_j; ///< N m
};

/// Somebody to whom every contact that is computed gives an entry.
class ContactLedger {
public:
  ContactLedger(const ContactLedger &) = delete;
  ContactLedger &operator=(const ContactLedger &) = delete;
  virtual ~ContactLedger() { list().erase(std::remove(list().begin(), list().end(), this), list().end()); }

  virtual void enter(const LedgerEntry &entry) = 0;

  /// Those who keep books: none in most scenes, so that a contact pays for one comparison.
  static const std::vector<ContactLedger *> &open() { return list(); }

protected:
  ContactLedger() { list().push_back(this); }

private:
  static std::vector<ContactLedger *> &list() {
    static std::vector<ContactLedger *> all; // one engine instance per process runs a deck
    return all;
  }
};

} // namespace drumlin
