#include "commands/fix_outputs.h"

#include <stdexcept>
#include <string>

using namespace LAMMPS_NS;

namespace {
constexpr const char *outputs_id = "drumlin_outputs";
} // namespace

void FixOutputs::provide(LAMMPS *lammps, std::unique_ptr<drumlin::OutputSet> set) {
  std::string words[] = {outputs_id, "all", style_name};
  char *arg[] = {words[0].data(), words[1].data(), words[2].data()};
  if (drumlin::engine::find_fix(lammps->modify, words[0]) != nullptr) lammps->modify->delete_fix(arg[0]);
  lammps->modify->add_fix(3, arg);
  of(lammps)->set_ = std::move(set);
}

FixOutputs *FixOutputs::of(const LAMMPS *lammps) {
  return dynamic_cast<FixOutputs *>(drumlin::engine::find_fix(lammps->modify, outputs_id));
}

/// A program that uses the engine as a library may go on after an error and destroy the engine in a run.
FixOutputs::~FixOutputs() {
  if (running_ && set_ != nullptr && !set_->ends()) set_->note_end(drumlin::ended_by_error);
}

void FixOutputs::record(const std::string &file) {
  if (set_ != nullptr) set_->record(file);
}

void FixOutputs::note_end(const std::string &why) {
  if (set_ != nullptr) set_->note_end(why);
}

void drumlin::engine::note_end(const LAMMPS *lmp, const std::string &why) {
  if (FixOutputs *outputs = FixOutputs::of(lmp)) outputs->note_end(why);
}

void FixOutputs::setup(int) {
  running_ = true;
  if (!first_) first_ = update->ntimestep;
}

void FixOutputs::end_of_step() {
  if (!committed_ && update->ntimestep > *first_ + first_steps) commit();
}

void FixOutputs::commit() {
  check_numbered(); // a full disk may have made the first dumps incomplete
  committed_ = true;
  if (set_ != nullptr) set_->commit();
}

void FixOutputs::check_numbered() {
  std::string fault;
  if (set_ != nullptr) {
    try {
      set_->check_numbered();
    } catch (const std::runtime_error &found) {
      fault = found.what();
    }
  }
  drumlin::engine::stop_on_fault(lmp, "drumlin/outputs", fault);
}

void FixOutputs::post_run() {
  running_ = false;
  committed_ ? check_numbered() : commit();
  if (drumlin::engine::runs_have_ended(lmp))
    note_end("stopped by a signal or a limit of time at step " + std::to_string(update->ntimestep));
}
