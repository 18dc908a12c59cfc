#include "experiment/runner.h"

#include "experiment/page.h"
#include "experiment/results.h"
#include "experiment/scene.h"
#include "support/csv.h"
#include "support/files.h"
#include "support/parallel.h"
#include "support/progress.h"
#include "support/resumed.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Scenes on one soil and a seed, of which the first makes the soil, or scenes of a round: they run one after
/// the other.
struct Group {
  std::vector<const Scene *> scenes;
  int seed;
};

/// Those of a part of the plan. All seeds of the scenes on one soil come before the others, so that a study
/// that is interrupted has whole results of its first scenes.
std::vector<Group> groups_of(const Plan &plan, const Part &part) {
  std::vector<std::vector<const Scene *>> soils;
  for (const Scene &scene : plan.scenes) {
    const auto same = std::find_if(soils.begin(), soils.end(), [&scene](const auto &soil) {
      return (scene.rounds && soil.front()->rounds) ||
             (scene.bed && soil.front()->bed && soil_text(*soil.front()) == soil_text(scene));
    });
    if (same == soils.end())
      soils.push_back({&scene});
    else
      same->push_back(&scene);
  }
  std::vector<Group> groups;
  int run = 0;
  for (const std::vector<const Scene *> &soil : soils)
    for (int seed = 1;; ++seed) {
      Group group{{}, seed};
      const int before = run;
      for (const Scene *scene : soil)
        if (seed <= scene->seeds && ++run % part.of == part.number % part.of) group.scenes.push_back(scene);
      if (run == before) break;
      if (!group.scenes.empty()) groups.push_back(group);
    }
  return groups;
}

/// Copies the files of a run into a folder, which appears when it has all of them.
void keep_files(const fs::path &run, const fs::path &folder) {
  fs::create_directories(folder.parent_path());
  FolderInProgress kept(fs::absolute(folder));
  fs::copy(run, kept.path(), fs::copy_options::recursive);
  kept.publish();
}

class Runs {
public:
  Runs(const Plan &plan, const fs::path &out, const Part &part, bool keep)
      : plan_(plan), out_(out), keep_(keep), groups_(groups_of(plan, part)),
        table_(out / results_name, result_rows()), progress_(runs()) {
    missing();       // asked for in order, which is that of the table
    table_.finish(); // before the runs, for rows that belong to none of them
  }

  /// The runs that are not finished, "scene, seed 1".
  std::vector<std::string> missing() {
    std::vector<std::string> names;
    for (const Group &group : groups_)
      for (const Scene *scene : group.scenes)
        if (!is_finished(*scene, group.seed))
          names.push_back(fmt::format("{}, seed {}", scene->name, group.seed));
    return names;
  }

  /// Takes over the runs that other calls have made in a folder.
  void take(const fs::path &folder) {
    std::vector<ResumedTable::Row> rows;
    for (const Result &result : read_points(folder / results_name, result_rows()))
      if (!table_.has(result_rows().key(result))) rows.push_back(result_rows().cells(result));
    table_.add(rows);
    table_.finish();
  }

  std::vector<std::string> make(int jobs) {
    in_parallel(groups_.size(), jobs, [this](std::size_t i) {
      for (const Scene *scene : groups_[i].scenes)
        make_one(*scene, groups_[i].seed, groups_[i].scenes.size() > 1 ? Soil::kept : Soil::used_up);
    });
    table_.finish();
    return failures_;
  }

private:
  std::size_t runs() const {
    std::size_t sum = 0;
    for (const Group &group : groups_)
      sum += group.scenes.size();
    return sum;
  }

  bool has(const Scene &scene, int seed, const Quantity &quantity) {
    return table_.has({scene.name, std::to_string(seed), quantity.name});
  }

  bool is_finished(const Scene &scene, int seed) {
    bool all = true;
    for (const Quantity &quantity : plan_.measured_in(scene))
      all = has(scene, seed, quantity) && all;
    return all;
  }

  void make_one(const Scene &scene, int seed, Soil soil) {
    {
      const std::lock_guard lock(mutex_);
      if (is_finished(scene, seed)) {
        progress_.found();
        return;
      }
    }
    const std::string what = fmt::format("seed {}, {}: ", seed, scene.name);
    try {
      const std::unique_ptr<DeckRun> run = run_scene(scene, seed, out_, soil);
      const double width = scene.bed && scene.bed->packing.depth > 0.0 ? scene.bed->packing.depth : 1.0; // m
      const std::vector<Quantity> quantities = plan_.measured_in(scene);
      const std::vector<double> values = measured(quantities, run->file(""), width);
      if (keep_) keep_files(run->file(""), folder_of(scene) / std::to_string(seed));
      const std::lock_guard lock(mutex_);
      add(scene, seed, quantities, values, run->outcome().cpu_seconds);
      progress_.measured(what + words(quantities, values));
    } catch (const MissingColumn &fault) { // no run of the plan has it
      throw std::runtime_error(what + fault.what());
    } catch (const std::exception &fault) { // a run that fails does not stop the others
      const std::lock_guard lock(mutex_);
      failures_.push_back(what + fault.what());
      progress_.measured(failures_.back());
    }
  }

  /// Begins with the number of the scene, since names that differ can be equal as names of folders.
  fs::path folder_of(const Scene &scene) const {
    std::string name = fmt::format("{}_{}", &scene - plan_.scenes.data() + 1, scene.name);
    std::replace_if(
        name.begin(), name.end(),
        [](unsigned char c) { return std::isalnum(c) == 0 && c != '.' && c != '-'; }, '_');
    return out_ / "runs" / name;
  }

  void add(const Scene &scene, int seed, const std::vector<Quantity> &quantities,
           const std::vector<double> &values, double cost) {
    std::vector<ResumedTable::Row> rows;
    for (std::size_t q = 0; q < values.size(); ++q) {
      const Quantity &quantity = quantities[q];
      if (!has(scene, seed, quantity)) // a kill can have left some of a run's rows
        rows.push_back(
            result_rows().cells({scene.name, seed, quantity.name, quantity.unit, values[q], cost}));
    }
    table_.add(rows);
  }

  /// The first values, for the progress.
  static std::string words(const std::vector<Quantity> &quantities, const std::vector<double> &values) {
    constexpr std::size_t most = 3;
    std::vector<std::string> texts;
    for (std::size_t q = 0; q < std::min(most, values.size()); ++q) {
      const Quantity &quantity = quantities[q];
      texts.push_back(
          fmt::format("{} {:.3g} {}", quantity.name, quantity.scale * values[q], quantity.shown_unit));
    }
    return fmt::format("{}", fmt::join(texts, ", "));
  }

  const Plan &plan_;
  fs::path out_;
  bool keep_;
  std::vector<Group> groups_;
  std::mutex mutex_; // of table_, progress_ and failures_
  ResumedTable table_;
  CountedProgress progress_;
  std::vector<std::string> failures_;
};

} // namespace

namespace {

void throw_if_any(const std::vector<std::string> &failures, const char *told) {
  if (!failures.empty())
    throw std::runtime_error(fmt::format("{} of the runs failed; {}", failures.size(), told));
}

} // namespace

void run_experiment(const Plan &plan, const fs::path &out, const RunOptions &options) {
  write_files({{out / plan_name, plan.copy()}});
  if (!plan.left_out.empty()) fmt::print("SKIPPED: {}\n", plan.left_out);
  Runs runs(plan, out, {}, options.keep);
  if (fs::is_directory(out / parts_name))
    for (const fs::directory_entry &part : fs::directory_iterator(out / parts_name))
      runs.take(part.path());
  const std::vector<std::string> failures =
      options.page_only ? std::vector<std::string>() : runs.make(options.jobs);
  if (options.page_only)
    for (const std::string &name : runs.missing())
      fmt::print("missing: {}\n", name);
  const Results results = read_results(out, plan);
  for (const PlanTable &table : plan.tables)
    write_files({{out / table.file, table_text(table, plan, results)}});
  write_experiment_page(out, plan, results, failures);
  fmt::print("{}\n", (out / "index.html").string());
  throw_if_any(failures, "the page tells which");
  const std::vector<Judged> rows = judged(plan, results);
  const auto missed = std::count_if(rows.begin(), rows.end(), [](const Judged &row) { return !row.holds; });
  if (missed > 0)
    throw std::runtime_error(
        fmt::format("{} of {} known values are not met; the page tells which", missed, rows.size()));
}

void make_part(const Plan &plan, const Part &part, const fs::path &folder, const RunOptions &options) {
  throw_if_any(Runs(plan, folder, part, options.keep).make(options.jobs),
               "the lines above tell which, and the same command makes them again");
}

} // namespace drumlin::post
