#pragma once
// fix contact/local: the contacts of a step, walls' included, for dump local. See
// plugin/doc/fix_contact_local.md.

#include "engine.h"
#include "contact/contact_observer.h"

namespace LAMMPS_NS {

/// Hands out the contacts of every N-th step as local data, one row per contact, on one rank only.
class FixContactLocal : public Fix, public drumlin::ContactObserver {
public:
  FixContactLocal(LAMMPS *, int, char **);

  int setmask() override;
  void init() override;
  void setup_pre_force(int) override;
  void setup(int) override;
  void pre_force(int) override;
  void end_of_step() override;
  double memory_usage() override;
  void see_contact(const drumlin::ContactRecord &record) override { records_.push_back(record); }

private:
  void fill_rows();

  /// IDs of the balls, the force on the first and the unit vector to it, the overlap.
  static constexpr std::size_t numbers = 9;
  using Row = std::array<double, numbers>;

  std::vector<drumlin::ContactRecord> records_; // from the beginning of a step's forces to its end
  std::vector<Row> rows_;
  std::vector<double *> row_pointers_;
};

} // namespace LAMMPS_NS
