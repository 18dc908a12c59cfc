// Which scene of an experiment on beds answers a question at the least processor time.
#pragma once

#include "experiment/results.h"
#include "support/statistics.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// A question about a bed.
struct BedQuestion {
  std::string name;     ///< as the option --question gives it
  std::string quantity; ///< of the plan
  double within = 0.1;  ///< error that is allowed, > 0
  /// Whether errors are given in the unit of the quantity. Otherwise they are relative to the mean of the
  /// complete scene.
  bool absolute = false;
};

/// The cheapest scene whose error stays within the request.
struct BedAdvice {
  const Scene *scene = nullptr; ///< of the plan
  std::string differs;          ///< what differs from the complete scene, in words
  MeanInterval error{};         ///< against the complete scene: relative, or in the unit of the quantity
  std::size_t seeds = 0;        ///< in which both were run
  double cost = 1.0;            ///< processor time over that of the complete scene
  std::string closest;          ///< name of the cheaper scene with the smallest error; empty: none is cheaper
  /// Largest error of the closest scene that its 95 % confidence interval leaves possible.
  double least_error = 0.0;
  /// Standard deviation of the result from one bed of the complete scene to another.
  double scatter = 0.0;
  /// How many beds of the complete scene must be averaged so that the 95 % confidence interval of their mean
  /// has a half width of at most BedQuestion::within.
  int beds = 0;
  double cpu_s = 0.0; ///< processor time of the scene's excitation, median over the seeds [s]
};

/// An experiment on beds: its plan, whose first scene is the complete one, at the size at which it was run,
/// and its results.
struct BedExperiment {
  Plan plan;
  Results results;
};
/// From the files `plan` and runs.csv of a folder. Throws UsageError for the option --from if it has none, or
/// without beds.
BedExperiment read_bed_experiment(const std::filesystem::path &folder);

/// A scene keeps to the request if the whole 95 % confidence interval of its change does; two seeds or more.
/// One that takes more than 0.9 times the processor time of the complete scene does not count as cheaper,
/// since measured times depend on what else the machine does. The complete scene is the advice if no cheaper
/// one is within. Throws std::runtime_error if there is no scene to compare and, for a relative error, if the
/// mean of the complete beds does not differ from zero.
BedAdvice advise_bed(const BedExperiment &experiment, const BedQuestion &question);

/// How single beds of a scene scatter, and what a mean over them takes.
struct SceneScatter {
  const Scene *scene = nullptr;
  std::size_t seeds = 0;
  MeanInterval mean{};       ///< in the unit of the quantity
  ScatterInterval scatter{}; ///< in the same unit
  /// How many beds must be averaged so that the 95 % confidence interval of their mean has a half width of at
  /// most BedQuestion::within, of the scene's own mean unless absolute; by the scatter, and by both ends of
  /// its interval. 0: more than a million, or no error relative to a mean that does not differ from zero.
  int beds = 0, least_beds = 0, most_beds = 0;
  double cpu_s = 0.0; ///< processor time of the excitation of one bed, median over the seeds [s]

  double total_s() const { return cpu_s * beds; } ///< of all beds
};

/// Of all scenes with two seeds or more; those first that take the least processor time for their beds, those
/// for which the number of beds is not known last.
std::vector<SceneScatter> scatter_of_scenes(const BedExperiment &experiment, const BedQuestion &question);

/// The scene in words: dimensions, number and size of balls, box, drum.
std::string scene_words(const Scene &scene);

/// The words after the front script with which the scene is made and run, a line for each command: bit for
/// bit the run of the experiment's seed 1.
std::vector<std::string> scene_commands(const Scene &scene);

} // namespace drumlin::post
