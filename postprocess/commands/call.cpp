// The table of all subcommands, and how a command line is carried out.
#include "commands/commands.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace drumlin::post {

namespace {

struct Subcommand {
  const char *name;
  AddCommand add;
};

// A new subcommand is one line here. A build with -DDRUMLIN_POSTPROCESS=OFF has `run` alone, which needs none
// of the libraries of the others.
constexpr std::array subcommands = {
#ifndef DRUMLIN_ONLY_RUN
    Subcommand{"advise", &add_advise_command},
    Subcommand{"bed", &add_bed_command},
    Subcommand{"calibrate", &add_calibrate_command},
    Subcommand{"demo", &add_demo_command},
    Subcommand{"exact", &add_exact_command},
    Subcommand{"way", &add_way_command},
    Subcommand{"identify", &add_identify_command},
    Subcommand{"map", &add_map_command},
    Subcommand{"meter", &add_meter_command},
    Subcommand{"passes", &add_passes_command},
    Subcommand{"report", &add_report_command},
    Subcommand{"study", &add_study_command},
    Subcommand{"vtk", &add_vtk_command},
#endif
    Subcommand{"run", &add_run_command},
};

} // namespace

bool is_subcommand(const std::string &name) {
  return std::any_of(subcommands.begin(), subcommands.end(),
                     [&name](const Subcommand &subcommand) { return name == subcommand.name; });
}

std::string command_line(const std::vector<std::string> &words) {
  std::string text = "drumlin";
  for (const std::string &word : words)
    text += " " + word;
  return text;
}

void call(std::vector<std::string> words) {
  Session session;
  session.command = command_line(words);
  CLI::App app("Vibratory roller on granular soil: exact solutions, analysis and reports.", "drumlin");
  app.set_version_flag("--version", std::string("drumlin " DRUMLIN_VERSION));
  app.require_subcommand(1);
  app.footer("'drumlin SUBCOMMAND --help' tells the options of a subcommand.");
  for (const Subcommand &subcommand : subcommands)
    subcommand.add(app, session);
  try {
    std::reverse(words.begin(), words.end()); // as CLI11 wants them
    app.parse(std::move(words));
  } catch (const CLI::Success &asked) { // for help or the version
    app.exit(asked);
  }
}

} // namespace drumlin::post
