// The studies of beds. Each makes the runs that its folder does not have yet, and writes their results and a page
// there. If a run fails, std::runtime_error is thrown, by most after the others have been made.
#pragma once

#include "studies/study.h"

#include <array>

namespace drumlin::post {

/// `drumlin study box`: what width, depth, floor and sides of the box do to the answers of a bed. Failures as in the
/// study of fidelity.
///   beds/       restart files of the beds
///   runs.csv    forces, acceleration, settlement, CMV, k, D of each run
///   index.html  tables and figures, with 95 % confidence intervals over the seeds
void run_box_study(const StudyOptions &options);

/// `drumlin study fidelity`: effect of each part of a bed's model on the results, and its computing time. If
/// a run fails, the others are still made; the page names the failed runs, and std::runtime_error is thrown
/// at the end.
///   beds/       restart files of the beds
///   runs.csv    results of each run: settlement, forces, energies, computing time
///   index.html  tables and a figure of the effects, each with its 95 % confidence interval
void run_fidelity_study(const StudyOptions &options);

/// `drumlin study friction`: what the friction model changes in a bed. Failures as in the study of fidelity.
///   beds/       restart files of the beds
///   runs.csv    settlement, depth, forces, k and D of each run
///   index.html  tables, with 95 % confidence intervals over the seeds
void run_friction_study(const StudyOptions &options);

/// `drumlin study stiffness`: stiffness k and damping ratio D of the linear law that identification finds in
/// the records of a roller on beds, over static load, force amplitude and frequency. Failures as in the study
/// of fidelity.
///   beds/       restart files of the beds
///   runs.csv    k, D, R2 of each run with the intervals of its record
///   index.html  tables and figures, with 95 % confidence intervals over the seeds
void run_stiffness_study(const StudyOptions &options);

/// In the order of the help.
inline constexpr std::array bed_studies = {
    Study{"box",
          "What the box does to the answers of a bed: width and depth up to four times the default, rigid "
          "walls or floor and sides that absorb waves; six seeds of the default box, three of the others. "
          "About half an hour of processor time.",
          &run_box_study, true},
    Study{"fidelity",
          "Effect and computing time of each part of a bed's model, over five seeds: size and number of the "
          "balls, stiffness, "
          "time step, depth and width of the box, condition, friction, rolling, packing, grading, scheme, "
          "kind of drum. `drumlin advise --bed` answers from its table. Hours of processor time; with "
          "--balls 150 "
          "minutes.",
          &run_fidelity_study, true, true},
    Study{
        "friction",
        "A roller on beds of 1000 discs with the friction model coulomb and with the engine's history, five "
        "seeds each: settlement, depth, forces, stiffness. About half an hour of processor time.",
        &run_friction_study, true},
    Study{"stiffness",
          "Stiffness k and damping ratio D that `drumlin identify` finds on beds of 1000 discs, over static "
          "load, force amplitude and frequency: 8 runs on each of five seeds. About 10 minutes of processor "
          "time.",
          &run_stiffness_study, true},
};

} // namespace drumlin::post
