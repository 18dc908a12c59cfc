#include "commands/commands.h"

#include "commands/command.h"
#include "report/report.h"
#include "report/run_folder.h"
#include "support/options.h"
#include "support/progress.h"

#include <fmt/format.h>

#include <string>

namespace drumlin::post {

namespace {

struct ReportArguments : Options {
  using Options::Options;
  Texts folders =
      words("dir", "DIR",
            fmt::format("run folders (with {}), studies (their pages are copied and linked), or parents of "
                        "either",
                        files_of_runs()));
  ResultPath out =
      result_folder("--out", "folder for the report; an earlier report there is replaced", "report");
};

void run(const ReportArguments &arguments) {
  ReportOptions options;
  for (const std::string &folder : arguments.folders)
    options.folders.push_back(path_option("DIR", folder));
  options.out = *arguments.out;
  options.version = DRUMLIN_VERSION;
  options.progress = print_progress;
  const ReportOutcome outcome = write_report(options);
  if (outcome.checks.all > 0)
    fmt::print("{} of {} checks against reference values agree\n", outcome.checks.agree, outcome.checks.all);
  if (outcome.checks.not_judged > 0)
    fmt::print("{} values are not judged, for their runs are too short or were cut; these are long enough:\n",
               outcome.checks.not_judged);
  for (const std::string &command : outcome.judging_commands)
    fmt::print("  {}\n", command);
  for (const LeftOut &folder : outcome.left_out)
    fmt::print("left out: {}: {}\n", folder.folder.string(), folder.why);
  fmt::print("{}\n", outcome.page.string());
}

} // namespace

void add_report_command(CLI::App &app, Session &session) {
  add_command<ReportArguments>(app, session, "report",
                               "Figures, tables and checks against reference values from "
                               "runs of the chain, of drums with two ends, of single impacts and of a "
                               "roller on a bed, as pages that open from disk.",
                               run);
}

} // namespace drumlin::post
