// Which scene of the fidelity study answers a question about a bed at the least processor time.
#pragma once

#include "studies/fidelity/plan.h"
#include "studies/fidelity/results.h"

#include <string>
#include <vector>

namespace drumlin::post {

struct BedAdviceRequest {
  BedQuantity question = BedQuantity::force;
  double within = 0.1;        ///< error that is allowed, > 0
  std::string name = "force"; ///< of the question, as the option --question gives it
  /// Whether errors are given in the unit of the quantity. Otherwise they are relative to the mean of the complete
  /// scene.
  bool absolute = false;
};

/// The cheapest scene whose error stays within the request.
struct BedAdvice {
  const FidelityScene *scene = nullptr; ///< of the plan
  Effect effect;       ///< of the scene against the complete one; without change if it is the complete one
  std::string closest; ///< name of the cheaper scene with the smallest error; empty: none is cheaper
  /// Largest error of the closest scene that its 95 % confidence interval leaves possible: relative, or in the unit
  /// of the quantity if the request is absolute.
  double least_error = 0.0;
  /// Standard deviation of the result from one bed of the complete scene to another: relative to its mean, or in
  /// the unit of the quantity if the request is absolute.
  double scatter = 0.0;
  /// How many beds of the complete scene must be averaged so that the 95 % confidence interval of their mean has a
  /// half width of at most BedAdviceRequest::within.
  int beds = 0;
  double cpu_s = 0.0; ///< processor time of the scene's excitation, median over the seeds
};

/// A scene keeps to the request if the whole 95 % confidence interval of its change does; two seeds or more. One that takes more than 0.9
/// times the processor time of the complete scene does not count as cheaper, since measured times depend on what else the machine does. The
/// complete scene is the advice
/// if no cheaper one is within. The plan is that of the table's runs. Throws std::runtime_error if the table has no scene to compare,
/// and, for a relative error, if the mean of the complete beds does not differ from zero.
BedAdvice advise_bed(const FidelityPlan &plan, const std::vector<FidelityRun> &runs,
                     const BedAdviceRequest &request);

/// The plan whose complete bed has as many balls as that of the runs. Throws std::runtime_error if they have no complete bed.
FidelityPlan plan_of(const std::vector<FidelityRun> &runs);

/// The scene in words: dimensions, number and size of balls, box, drum if it is not the default one.
std::string scene_words(const FidelityScene &scene);

/// The words after the front script with which the scene is made and run, a line for each command: bit for bit the run of the study's
/// seed 1.
std::vector<std::string> scene_commands(const FidelityScene &scene, int cycles);

} // namespace drumlin::post
