// The studies: each measures what is not measured yet, and writes its results and its page into the study's
// folder. They throw UsageError for a folder that the engine would split at a space, and std::runtime_error
// if a run fails.
#pragma once

#include <array>

namespace drumlin::post {

struct StudyOptions;

/// `drumlin study accuracy`: error against step size and against wall time. Coarse steps first.
///   chain.csv    cases I to IV under A and B, both steppings, and the engine's own law under B
///   impacts.csv  single impacts over the phase of the onset
///   scaling.csv  chains of other parameters at the steps that advice gives for them
///   orders.csv   fitted orders, and the steps that each stepping needs for an error
///   index.html   tables and figures
void run_accuracy_study(const StudyOptions &options);

/// `drumlin study cost`: what a step costs, and what each optional piece adds. Throws std::runtime_error,
/// too, if laws that are one did not move the balls alike.
///   bed_2500.data, ...  settled beds that all variants start from
///   runs.csv            time of every run
///   index.html          tables and a figure
void run_cost_study(const StudyOptions &options);

/// `drumlin study fidelity`: what each ingredient of a bed changes and costs. A run that fails stops no
/// other; the page says which, and std::runtime_error is thrown at the end.
///   beds/       restart files of the beds
///   runs.csv    what every run gave
///   index.html  effects with their confidence intervals
void run_fidelity_study(const StudyOptions &options);

/// `drumlin study speed`: steps of balls per second from small beds to large ones, on one rank and on two,
/// and memory. Throws std::runtime_error, too, if runs did not do the same work.
///   runs.csv    time and memory of every run
///   index.html  tables and a figure
void run_speed_study(const StudyOptions &options);

/// `drumlin study stability`: how long a step may be, and runs at the edges of what can be asked. Throws
/// std::runtime_error with the rows that fail, after everything is written.
///   map.csv       the longest stable step over damping
///   extremes.csv  runs at the edges, each against an oracle
///   index.html    tables and a figure
void run_stability_study(const StudyOptions &options);

/// A study as `drumlin study NAME` offers it.
struct Study {
  const char *name;
  const char *summary; ///< for the help
  void (*run)(const StudyOptions &);
  bool parallel = false; ///< its runs may share the machine
};

/// All studies, in the order of the help.
inline constexpr std::array studies = {
    Study{"accuracy",
          "Error of the chain and of single impacts against step size and wall time, for both steppings and "
          "the "
          "engine's own contact law; tests what `drumlin advise` says. About half an hour.",
          &run_accuracy_study},
    Study{"cost",
          "What a step costs on the chain and on settled beds, and what each optional piece adds, as ratios "
          "within interleaved rounds. About twenty minutes, on a quiet machine.",
          &run_cost_study},
    Study{"fidelity",
          "What each ingredient of a bed changes and costs, over five seeds: condition, friction, rolling, "
          "stiffness, step, number, size and "
          "packing of the balls, kind of drum, frequency, two dimensions or three. About five hours of "
          "processor "
          "time.",
          &run_fidelity_study, true},
    Study{"speed",
          "Steps of balls per second from 2500 balls to a quarter of a million, on one rank and on two, "
          "beside the "
          "engine's own law; memory; a projection to 1e8. About twenty minutes, on a quiet machine.",
          &run_speed_study},
    Study{"stability",
          "The longest stable step over damping, for both steppings; runs at the edges of what can be asked. "
          "About ten minutes.",
          &run_stability_study},
};

} // namespace drumlin::post
