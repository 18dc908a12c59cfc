#pragma once
// fix contact/local: the contacts of a step, those with walls included, for dump local. See
// plugin/doc/fix_contact_local.md.

#include "engine.h"
#include "contact/contact_observer.h"

namespace LAMMPS_NS {

/// Records the contacts of every N-th step and provides them as local data, with one row per contact, on one
/// rank only.
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
  void make_rows();

  /// Columns of a row: the IDs of the two balls, the force on the first, the unit vector from the second to
  /// it, the overlap.
  static constexpr std::size_t numbers = 9;
  using Row = std::array<double, numbers>;

  std::vector<drumlin::ContactRecord>
      records_; // from the start of the force computation of a step to its end
  std::vector<Row> rows_;
  std::vector<double *> row_pointers_;
};

} // namespace LAMMPS_NS
