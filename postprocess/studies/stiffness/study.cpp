#include "studies/studies.h"

#include "engine/deck_run.h"
#include "studies/fidelity/results.h"
#include "studies/placed_bed.h"
#include "studies/stiffness/results.h"
#include "studies/study.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace {

/// A run on each seed's bed: the default run, or one that differs in one variable.
struct LawVariant {
  std::string name;
  std::string m3;     ///< of frame [kg/m], with which the roller is placed
  Variables run = {}; ///< of in.bed alone
};

struct LawPlan {
  std::string beds; ///< in words
  PlacedBed bed;
  Variables run; ///< of in.bed alone, of all variants that do not say otherwise
  std::vector<LawVariant> variants;
  int seeds, cycles;
};

Variables frequency(double hertz, const char *steps) {
  constexpr double pi = 3.14159265358979323846;
  return {{"omega", number_text(2.0 * pi * hertz)}, {"steps_per_cycle", steps}};
}

LawPlan quick_plan() {
  PlacedBed bed = small_bed();
  bed.soil = "loose";
  return {"150 discs of case loose, a test of the study",
          bed,
          {{"Fw", "2940"}},
          {{default_run, "50"},
           {"Fw 1470", "50", {{"Fw", "1470"}}},
           {"30 Hz", "50", frequency(30.0, "1750")},
           {"m3 100", "100"}},
          2,
          4};
}

LawPlan full_plan() {
  PlacedBed bed = gravel_bed();
  bed.soil = "gravel";
  // The amplitudes are a half, 1, 2 and 3 times the default roller's weight; the time steps follow the default.
  return {"1000 discs of case gravel in a box 1.26 m wide",
          bed,
          {},
          {{default_run, "1000"},
           {"Fw 14.7e3", "1000", {{"Fw", "14.7e3"}}},
           {"Fw 29.4e3", "1000", {{"Fw", "29.4e3"}}},
           {"Fw 88.2e3", "1000", {{"Fw", "88.2e3"}}},
           {"15 Hz", "1000", frequency(15.0, "10750")},
           {"30 Hz", "1000", frequency(30.0, "5500")},
           {"m3 500", "500"},
           {"m3 3000", "3000"}},
          5,
          6};
}

BedLaw measure(const LawPlan &plan, const LawVariant &variant, int seed, const std::filesystem::path &out) {
  PlacedBed bed = plan.bed;
  bed.name = "m3_" + variant.m3;
  bed.place = {{"m3", variant.m3}}; // the settled soil does not depend on it
  const DeckRun run("bed/in.bed",
                    with_start(joined(joined(variant.run, plan.run), joined(bed.place, bed.scene)),
                               placed(bed, seed, out), plan.cycles));
  run.must_succeed();
  BedLaw law = identified_law(run.file(""));
  law.run = variant.name;
  law.seed = seed;
  const BedValues values = bed_values(read_table(run.file("cycles.csv")), 1.0);
  law.peak_force = values[static_cast<std::size_t>(BedQuantity::force)];
  law.contact_share = values[static_cast<std::size_t>(BedQuantity::contact)];
  law.cpu_s = run.outcome().cpu_seconds;
  return law;
}

MeasuredRun measured(const BedLaw &law) {
  return {bed_laws().cells(law),
          fmt::format("k = {:.3g} MN/m, D = {:.2g}, R2 = {:.3f}", 1e-6 * law.k, law.D, law.r2)};
}

} // namespace

void run_stiffness_study(const StudyOptions &options) {
  check_engine_path(options.out);
  const LawPlan plan = options.quick ? quick_plan() : full_plan();
  ResumedTable results(options.out / "runs.csv", bed_laws());
  std::vector<std::vector<SeedRun>> groups; // one for each seed, whose beds share the settled soil
  for (int seed = 1; seed <= plan.seeds; ++seed) {
    groups.emplace_back();
    for (const LawVariant &variant : plan.variants)
      groups.back().push_back({variant.name, seed, [&plan, &variant, &options, seed] {
                                 return measured(measure(plan, variant, seed, options.out));
                               }});
  }
  const std::vector<std::string> failures = make_runs(groups, options.jobs, results);
  write_stiffness_page(options.out, plan.beds, read_points(results.file(), bed_laws()), failures);
  fmt::print("{}\n", (options.out / "index.html").string());
  if (!failures.empty())
    throw std::runtime_error(fmt::format("{} of the runs failed; the page tells which", failures.size()));
}

} // namespace drumlin::post
