#pragma once
// fix contact/events: makes and breaks of contact, located within the step. See
// plugin/doc/fix_contact_events.md.

#include "contact/fix_pair_observer.h"
#include "engine.h"
#include "support/clock.h"
#include "support/output_file.h"

#include <array>
#include <vector>

namespace LAMMPS_NS {

/// Writes a row to a CSV file when two balls of the group come into contact (make) and when their contact
/// ends (break). The keywords `types` and `between` restrict the pairs. Each event is written once, whatever
/// the number of ranks.
class FixContactEvents : public FixPairObserver {
public:
  FixContactEvents(LAMMPS *, int, char **);

  int setmask() override;
  void init() override;
  void setup(int) override;
  void post_integrate() override;
  void end_of_step() override;
  void post_run() override;
  void see_pair(const drumlin::PairStep &) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  /// Number of events written so far.
  double compute_scalar() override;

private:
  struct Event {
    double time;
    int make;
    double overlap, rate, force;
    int tag_i, tag_j;
  };

  bool selects(int i, int j) const override;
  void write_out();

  std::array<int, 2> types_{0, 0};     // 0: all pairs of the group
  std::array<int, 2> groupbits_{0, 0}; // of keyword between; 0: not given
  drumlin::OutputFile file_;
  drumlin::Clock clock_;
  std::vector<Event> pending_; // not yet written
  bigint count_ = 0;
};

} // namespace LAMMPS_NS
