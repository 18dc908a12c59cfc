#include "commands/fix_outputs.h"

#include <stdexcept>
#include <string>

using namespace LAMMPS_NS;

void FixOutputs::provide(LAMMPS *lammps, std::unique_ptr<drumlin::OutputSet> set) {
  std::string words[] = {"drumlin_outputs", "all", style_name};
  char *arg[] = {words[0].data(), words[1].data(), words[2].data()};
  if (drumlin::engine::find_fix(lammps->modify, words[0]) != nullptr) lammps->modify->delete_fix(arg[0]);
  lammps->modify->add_fix(3, arg);
  static_cast<FixOutputs *>(drumlin::engine::find_fix(lammps->modify, words[0]))->set_ = std::move(set);
}

void FixOutputs::setup(int) {
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

void FixOutputs::post_run() { committed_ ? check_numbered() : commit(); }
