#pragma once
// fix drumlin/outputs, which the command drumlin/outputs adds; decks do not use it.

#include "engine.h"
#include "support/output_set.h"

#include <memory>
#include <optional>

namespace LAMMPS_NS {

/// Owns the set of output files of a run and commits it when the run has passed its first steps.
class FixOutputs : public Fix {
public:
  FixOutputs(LAMMPS *lammps, int narg, char **arg) : Fix(lammps, narg, arg) { nevery = 1; }
  ~FixOutputs() override;

  /// Adds the fix to the engine, or replaces it. \param set on rank 0; nullptr on the others
  static void provide(LAMMPS *lammps, std::unique_ptr<drumlin::OutputSet> set);

  /// The fix of this engine instance; nullptr if the deck has no output files.
  static FixOutputs *of(const LAMMPS *lammps);
  /// The run's parameters: see OutputSet::record().
  void record(const std::string &file);
  /// Why the run ends before its time.
  void note_end(const std::string &why);

  int setmask() override { return FixConst::END_OF_STEP | FixConst::POST_RUN; }
  void setup(int) override;
  void end_of_step() override;
  void post_run() override;

  static constexpr const char *style_name = "drumlin/outputs";

private:
  /// Time steps after which fix guard, with the settings of the project's decks, has made each of its checks
  /// at least once.
  static constexpr drumlin::engine::bigint first_steps = 100;

  void commit();
  /// Ends the run if a dump is incomplete. Collective.
  void check_numbered();
  std::unique_ptr<drumlin::OutputSet> set_;
  std::optional<drumlin::engine::bigint> first_;
  bool committed_ = false;
  bool running_ = false;
};

} // namespace LAMMPS_NS
