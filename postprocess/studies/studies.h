// The studies. Each makes the runs that its folder does not have yet, and writes their results and a page
// there. They throw UsageError for a folder whose path has a space, at which the engine would split it, and
// std::runtime_error if a run fails.
#pragma once

#include <array>

namespace drumlin::post {

struct StudyOptions;

/// `drumlin study accuracy`: error over step size and over wall time. The coarsest steps are run first.
///   chain.csv    cases I to IV under A and B with both integration schemes, and the engine's own law under B
///   impacts.csv  single impacts; the make occurs at several instants within a time step
///   scaling.csv  chains of other parameters, with the number of steps that `drumlin advise` gives for them
///   orders.csv   fitted orders of convergence, and the steps that each scheme needs for an error
///   index.html   tables and figures
void run_accuracy_study(const StudyOptions &options);

/// `drumlin study benchmarks`: published tests of one or two spheres in both engines, against closed forms and
/// an integration of the equations of motion.
///   runs.csv    parameters and results of each run
///   index.html  tables and figures
void run_benchmarks_study(const StudyOptions &options);

/// `drumlin study box`: what width, depth, floor and sides of the box do to the answers of a bed. Failures as in the
/// study of fidelity.
///   beds/       restart files of the beds
///   runs.csv    forces, acceleration, settlement, CMV, k, D of each run
///   index.html  tables and figures, with 95 % confidence intervals over the seeds
void run_box_study(const StudyOptions &options);

/// `drumlin study cost`: wall time of a time step, and the time that each optional part adds to it. Also
/// throws std::runtime_error if variants with the same contact law do not end with the balls at the same
/// positions.
///   bed_2500_X.data, ...  settled beds that all variants start from; X depends on what they are made of
///   runs.csv              wall time of each run
///   index.html            tables and a figure
void run_cost_study(const StudyOptions &options);

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

/// `drumlin study meter`: what a roller's meter shows over the stiffness of the soil, and what identification
/// finds in the same records, for all rollers of the chain. Needs no engine.
///   records.csv  meter values, operating mode and identified stiffness of each record
///   index.html   tables and figures
void run_meter_study(const StudyOptions &options);

/// `drumlin study speed`: throughput (number of balls times time steps per second) and memory from small beds
/// to large ones, on one rank and on two. Also throws std::runtime_error if runs of one scene do not end with
/// the balls at the same positions.
///   runs.csv    wall time and peak memory of each run
///   index.html  tables and a figure
void run_speed_study(const StudyOptions &options);

/// `drumlin study stability`: the longest stable time step, and runs at the limits of the allowed parameters.
/// Throws std::runtime_error with the runs that fail, after everything is written.
///   map.csv       longest stable time step at each damping ratio, for both integration schemes
///   extremes.csv  runs at the limits, each compared with an independent solution
///   index.html    tables and a figure
void run_stability_study(const StudyOptions &options);

/// `drumlin study stiffness`: stiffness k and damping ratio D of the linear law that identification finds in
/// the records of a roller on beds, over static load, force amplitude and frequency. Failures as in the study
/// of fidelity.
///   beds/       restart files of the beds
///   runs.csv    k, D, R2 of each run with the intervals of its record
///   index.html  tables and figures, with 95 % confidence intervals over the seeds
void run_stiffness_study(const StudyOptions &options);

/// A study as `drumlin study NAME` offers it.
struct Study {
  const char *name;
  const char *summary; ///< for the help
  void (*run)(const StudyOptions &);
  bool parallel = false; ///< its runs may share the machine
  bool scaled = false;   ///< its beds may have another number of balls
};

/// All studies, in the order of the help.
inline constexpr std::array studies = {
    Study{
        "accuracy",
        "Error of the chain and of single impacts over step size and wall time, for both integration schemes "
        "and the engine's own contact law; tests what `drumlin advise` says. About half an hour.",
        &run_accuracy_study},
    Study{"benchmarks",
          "Published tests of one or two spheres (Chung and Ooi 2011; LAMMPS's unittest/granular): impacts, "
          "sliding, "
          "rolling, rest, in both engines against closed forms. About three minutes.",
          &run_benchmarks_study},
    Study{"box",
          "What the box does to the answers of a bed: width and depth up to four times the default, rigid "
          "walls or floor and sides that absorb waves; six seeds of the default box, three of the others. "
          "About half an hour of processor time.",
          &run_box_study, true},
    Study{
        "cost",
        "Time of a step on the chain and on settled beds, and what each optional part adds, as ratios within "
        "interleaved rounds. About twenty minutes, on a quiet machine.",
        &run_cost_study},
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
    Study{"meter",
          "What the meters of rollers show on soil of 1 to 200 MN/m, where a value may mean several "
          "stiffnesses, and what identification finds in the same records. Half a minute, without an engine.",
          &run_meter_study},
    Study{"speed",
          "Balls times steps per second from 2500 balls to a quarter of a million, on one rank and on two, "
          "compared with the engine's own law; memory; a projection to 1e8 balls. Ten to twenty minutes, on "
          "a quiet machine.",
          &run_speed_study},
    Study{
        "stability",
        "The longest stable time step over damping, for both integration schemes; runs at the limits of the "
        "allowed parameters. About ten minutes.",
        &run_stability_study},
    Study{"stiffness",
          "Stiffness k and damping ratio D that `drumlin identify` finds on beds of 1000 discs, over static "
          "load, force amplitude and frequency: 8 runs on each of five seeds. About 10 minutes of processor "
          "time.",
          &run_stiffness_study, true},
};

} // namespace drumlin::post
