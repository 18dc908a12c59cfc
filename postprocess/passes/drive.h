// A run of a roller that drives over a bed (inputs/bed/in.drive): its record, its passes, and the bed before
// the first and after each of them. SI units; in two dimensions masses, forces and energies are per metre of
// width.
#pragma once

#include "bed/coarse_graining.h"
#include "record/record.h"
#include "runs/bed_files.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// A part of the way, m.
struct WayPart {
  double from = 0.0, to = 0.0;
  double length() const { return to - from; }
  bool holds(double place) const { return place >= from && place < to; }
};

/// The bed at a dumped step.
struct DumpedBed {
  long step = 0;
  std::vector<Ball> balls;
  std::vector<bool> lies;              ///< of each ball, as lying_soil() has it
  std::optional<BedContacts> contacts; ///< not given if the step has no dump of them
};

/// Which balls are soil that lies on the floor at y = 0, or on soil that does: no farther than its radius
/// from it. Balls in the air and those on the roller alone are no part of the bed.
std::vector<bool> lying_soil(const std::vector<Ball> &balls);

/// A pass that the roller has finished.
struct DrivenPass {
  std::size_t first = 0, last = 0;    ///< rows, its pause included
  std::size_t enters = 0, leaves = 0; ///< first and last row of the measured part of the way
  std::vector<long> passing;          ///< dumped steps with the roller in the measured part
  std::vector<long> dumps;            ///< all dumped steps with contacts, from the state before it on
};

/// What the run has written.
struct Drive {
  std::filesystem::path folder;
  Record record;
  DriveHistory history;       ///< row by row as the record
  WayPart measured;           ///< the middle part of the way, for which passes are evaluated
  double speed = 0.0;         ///< m/s
  double timestep = 0.0;      ///< s
  double thickness = 1.0;     ///< of the bed along the drum's axis, m; 1 m in two dimensions
  bool flat = true;           ///< two dimensions
  int layers = 1;             ///< of soil
  std::vector<WayPart> spots; ///< soft or stiff parts of the lowest layer (`drumlin bed --spot`)
  std::vector<DrivenPass> passes;
  std::vector<DumpedBed> states;  ///< before the first pass and after each
  std::vector<std::string> notes; ///< what was left out and why, sentences

  /// Layer of a soil ball, from 0. Types behind those of the layers are spots of the lowest.
  std::size_t layer_at(const Ball &ball) const {
    const int layer = layer_of(ball.type);
    return layer > layers ? 0U : static_cast<std::size_t>(layer - 1);
  }
};

/// The bed at one of the steps of DrivenPass::passing. Errors as read_drive().
DumpedBed read_dumped_bed(const std::filesystem::path &folder, long step);

/// Reads a run. A pass that the run did not finish is left out, with a note. std::runtime_error of one line:
/// no drive, no pass finished, a dump that is missing, files that cannot be read.
Drive read_drive(const std::filesystem::path &folder);

} // namespace drumlin::post
