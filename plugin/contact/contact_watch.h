#pragma once
// What contacts and bonds tell of themselves in the steps in which somebody looks at them: see fix guard.

#include "engine.h"
#include "physics/time_step.h"

#include <algorithm>
#include <vector>

namespace drumlin {

/// Somebody who looks at the links, contacts and bonds, that act in a step.
class ContactWatch {
public:
  ContactWatch() = default;
  ContactWatch(const ContactWatch &) = delete;
  ContactWatch &operator=(const ContactWatch &) = delete;

  /// One side of a link. Whoever computes a link calls this for each ball of it that this rank owns; with newton on, where no other
  /// rank meets a contact, for a ghost, too.
  /// \param i the ball
  /// \param partner ID of the other ball, 0 for a wall
  /// \param overlap of a contact, as a share of the smaller radius; 0 for a bond
  virtual void see(int i, int partner, const physics::LinkModes &modes, double overlap) = 0;

  /// Those who look in this step: none in most steps, so that a contact pays for one comparison.
  static const std::vector<ContactWatch *> &looking() { return list(); }

protected:
  ~ContactWatch() { stop_looking(); }
  void start_looking() {
    stop_looking();
    list().push_back(this);
  }
  void stop_looking() { list().erase(std::remove(list().begin(), list().end(), this), list().end()); }

private:
  static std::vector<ContactWatch *> &list() {
    static std::vector<ContactWatch *> all; // one engine instance per process runs a deck
    return all;
  }
};

} // namespace drumlin
