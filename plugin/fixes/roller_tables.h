#pragma once
// Columns and rows of the files of fix roller/history: chain.csv or bed.csv (samples), and cycles.csv (one
// row per cycle). plugin/doc/roller_columns.md says what the columns mean.

#include "fixes/bed_sums.h"
#include "fixes/cycle_sums.h"
#include "fixes/roller_state.h"

#include <cstdio>
#include <string>
#include <vector>

namespace drumlin {

/// Masses and gravity, from which energies of drum and frame follow.
struct RollerMasses {
  double drum = 0.0, frame = 0.0;                 ///< kg
  double gravity = 0.0;                           ///< m/s2, downwards along the axis
  double drum_inertia = 0.0, frame_inertia = 0.0; ///< kg m2, of bodies that tilt
};

/// The state of a bed for one row.
struct BedSample {
  ContactSums contacts;
  BallSums balls;
  double void_ratio = 0.0;
  double raised = 0.0;        ///< kg m, mass times rise of all balls since the first set-up
  double friction_heat = 0.0; ///< J, of friction and rolling since the start
  double yield_heat = 0.0;    ///< J, heat of contacts that have yielded since the start
  bool absorbs = false;       ///< whether fix boundary/absorb acts on the bed
  bool yields = false;        ///< whether the contact law remembers, and may yield
};

/// Header line of the samples, and a row. \param bed nullptr: not a bed; otherwise `with_frame` must be true
/// \param travels whether place and pass follow the row \param tilts whether tilts_of() follows it
std::string history_header(bool with_frame, bool with_bed, bool travels, bool tilts);
std::vector<double> history_row(const RollerState &state, const CycleSums &cycle, const RollerMasses &masses,
                                bool with_frame, const BedSample *bed);

/// Tilts of drum and frame, and what the ends of the drum have. \param sensor distance of a_left and a_right
/// from the middle, m
std::vector<double> tilts_of(const RollerState &state, double sensor);

/// Header line of the cycles, and a row. \param bed nullptr: not a bed \param absorbs, yields those of
/// BedSample \param travels whether the work of what drives the roller follows the row
std::string cycles_header(bool with_bed, bool absorbs, bool yields, bool travels);
std::vector<double> cycles_row(const RollerState &state, const CycleSums &cycle, const RollerMasses &masses,
                               const BedSample *bed);

/// Writes a row with 17 significant digits; nothing if there is no file.
void write_row(FILE *file, const std::vector<double> &row);

} // namespace drumlin
