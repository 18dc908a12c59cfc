#include "lab/studies.h"

#include "experiment/study.h"
#include "lab/benchmarks/page.h"
#include "lab/benchmarks/runs.h"
#include "support/progress.h"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace drumlin::post {

void run_benchmarks_study(const StudyOptions &options) {
  check_engine_path(options.out);
  const std::vector<BenchmarkPoint> points = benchmark_points(options.quick);
  std::vector<std::string> engines = {"liggghts"};
  if (has_lammps()) engines.emplace_back("lammps");
  ResumedTable results(options.out / "runs.csv", benchmark_runs());
  CountedProgress progress(engines.size() * points.size());
  for (const BenchmarkPoint &point : points)
    for (const std::string &engine : engines) {
      if (results.has({point.test, point.material, number_text(point.at), engine})) {
        progress.found();
        continue;
      }
      results.add(benchmark_runs().cells(run_benchmark(point, engine)));
      progress.measured(
          fmt::format("{} {}, {} = {:g}, {}", point.test, point.material, point.variable, point.at, engine));
    }
  results.finish();
  write_benchmarks_page(options.out);
  fmt::print("{}\n", (options.out / "index.html").string());
}

} // namespace drumlin::post
