#include "commands/report.h"

#include "commands/commands.h"
#include "commands/text_options.h"
#include "report/report.h"
#include "report/run_folder.h"
#include "support/options.h"
#include "support/progress.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>
#include <string>

namespace drumlin::post {

void print_report(const ReportArguments &arguments) {
  ReportOptions options;
  for (const std::string &folder : arguments.folders)
    options.folders.push_back(path_option("DIR", folder));
  options.out = output_folder_option("--out", arguments.out);
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

void add_report_command(CLI::App &app, Session &) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App *report =
      app.add_subcommand("report", "Figures, tables and checks against reference values from "
                                   "runs of the chain, of drums with two ends, of single impacts and of a "
                                   "roller on a bed, as pages that open from disk.");
  report
      ->add_option(
          "dir", arguments->folders,
          fmt::format(
              "run folders (with {}), studies (their pages are copied and linked), or parents of either",
              files_of_runs()))
      ->type_name("DIR")
      ->required();
  text_option(report, "--out", "DIR", arguments->out,
              "folder for the report; an earlier report there is replaced");
  report->callback([arguments] { print_report(*arguments); });
}

} // namespace drumlin::post
