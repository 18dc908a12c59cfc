// The studies of the laboratory, which measure the project itself.
#pragma once

#include "experiment/study.h"

#include <array>

namespace drumlin::post {

/// `drumlin study accuracy`: error over step size and over wall time. The coarsest steps are run first.
///   chain.csv    cases I to IV under A and B with both integration schemes, and the engine's own law under B
///   impacts.csv  single impacts; the make occurs at several instants within a time step
///   scaling.csv  chains of other parameters, with the number of steps that `drumlin advise` gives for them
///   orders.csv   fitted orders of convergence, and the steps that each scheme needs for an error
///   index.html   tables and figures
void run_accuracy_study(const StudyOptions &options);

/// `drumlin study timing`: wall time of a time step on the chain and on beds, what each optional part adds to
/// it, and throughput and memory from small beds to large ones, on one rank and on two. Also throws
/// std::runtime_error if runs that compute the same do not end with the balls at the same positions.
///   bed_2500_X.data, ...  settled beds that all variants start from; X depends on what they are made of
///   runs.csv              wall time and peak memory of each run
///   index.html            tables and figures
void run_timing_study(const StudyOptions &options);

/// In the order of the help.
inline constexpr std::array lab_studies = {
    Study{"accuracy",
          "Error of the chain and of single impacts over step size and wall time, for both integration "
          "schemes and the engine's own contact law; tests what `drumlin advise` says. About half an hour.",
          &run_accuracy_study},
    Study{"timing",
          "Time of a step on the chain and on settled beds: what each optional part adds, as ratios within "
          "interleaved rounds; balls times steps per second and memory from 2500 balls to a quarter of a "
          "million, on one rank and on two, compared with the engine's own law. About forty minutes, on a "
          "quiet machine.",
          &run_timing_study},
};

} // namespace drumlin::post
