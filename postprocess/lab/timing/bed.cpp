#include "lab/timing/bed.h"

#include "engine/deck_run.h"
#include "support/files.h"
#include "support/progress.h"
#include "support/resumed.h"

#include <fmt/format.h>

namespace drumlin::post {

namespace fs = std::filesystem;

std::string TimedBed::name() const { return fmt::format("bed {}", balls()); }

Variables TimedBed::sides() const { return {{"sides", layers > 1 ? "p" : "f"}}; }

fs::path settled(const TimedBed &bed, const fs::path &folder) {
  const std::string made_of = fmt::format("{} {} {} {} {} {}", bed.columns, bed.layers, bed.rows,
                                          bed.settling, bed.copies_x, bed.copies_y);
  fs::path file = folder / fmt::format("bed_{}_{}.data", bed.balls(), fingerprint(made_of));
  if (fs::exists(file)) return file;
  const TemporaryFolder place(fs::absolute(folder), "unfinished.");
  const fs::path unfinished = place.path() / "bed.data";
  Variables variables = bed.sides();
  variables.emplace_back("data", unfinished.string());
  if (bed.copies_x * bed.copies_y > 1) {
    TimedBed cell = bed;
    cell.copies_x = cell.copies_y = 1;
    variables.insert(variables.end(), {{"from", "copies"},
                                       {"cell", fs::absolute(settled(cell, folder)).string()},
                                       {"copies_x", std::to_string(bed.copies_x)},
                                       {"copies_y", std::to_string(bed.copies_y)},
                                       {"steps", "0"}});
  } else {
    print_progress(fmt::format("settling {}: {} steps", bed.name(), bed.settling));
    variables.insert(variables.end(), {{"from", "lattice"},
                                       {"columns", std::to_string(bed.columns)},
                                       {"layers", std::to_string(bed.layers)},
                                       {"rows", std::to_string(bed.rows + 1)},
                                       {"steps", std::to_string(bed.settling)},
                                       {"D", "0.5"}});
  }
  DeckRun("study/in.cost_bed", variables).must_succeed();
  fs::rename(unfinished, file);
  return file;
}

std::string engine_law(const std::string &models) {
  return "hooke/stiffness " + models + " limitForce on absolute_damping on";
}

std::string plugin_law(const std::string &models, const std::string &stepping) {
  return fmt::format("hooke/transition {} stepping {} damping coefficient", models, stepping);
}

} // namespace drumlin::post
