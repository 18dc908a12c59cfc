// The tool behind ./drumlin: one program, one subcommand per job.
#include "commands/advise.h"
#include "commands/bed.h"
#include "commands/exact.h"
#include "commands/map.h"
#include "commands/report.h"
#include "commands/study.h"
#include "commands/vtk.h"
#include "support/usage_error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

namespace {

using drumlin::post::AddCommand;

struct Subcommand {
  const char *name;
  AddCommand add;
};

// A new subcommand is one line here.
constexpr std::array subcommands = {
    Subcommand{"advise", &drumlin::post::add_advise_command},
    Subcommand{"bed", &drumlin::post::add_bed_command},
    Subcommand{"exact", &drumlin::post::add_exact_command},
    Subcommand{"map", &drumlin::post::add_map_command},
    Subcommand{"report", &drumlin::post::add_report_command},
    Subcommand{"study", &drumlin::post::add_study_command},
    Subcommand{"vtk", &drumlin::post::add_vtk_command},
};

constexpr int bad_usage = 2;

std::string command_line(int argc, char **argv) {
  std::string text = "drumlin";
  for (int i = 1; i < argc; ++i)
    text += fmt::format(" {}", argv[i]);
  return text;
}

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n')
    text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

int fail(const std::string &subcommand, const std::string &what, int status) {
  fmt::print(stderr, "ERROR: drumlin{}{}: {}\n", subcommand.empty() ? "" : " ", subcommand, one_line(what));
  return status;
}

int run(int argc, char **argv) {
  const std::string wanted = argc > 1 ? argv[1] : "";
  const bool known =
      std::any_of(subcommands.begin(), subcommands.end(),
                  [&wanted](const Subcommand &subcommand) { return wanted == subcommand.name; });
  const std::string name = known ? wanted : "";

  drumlin::post::Session session;
  session.command = command_line(argc, argv);
  CLI::App app("Vibratory roller on granular soil: exact solutions, analysis and reports.", "drumlin");
  app.set_version_flag("--version", std::string("drumlin " DRUMLIN_VERSION));
  app.require_subcommand(1);
  app.footer("'drumlin SUBCOMMAND --help' tells the options of a subcommand.");
  try {
    for (const Subcommand &subcommand : subcommands)
      subcommand.add(app, session);
    if (!known && !wanted.empty() && wanted.front() != '-')
      return fail("",
                  fmt::format("subcommand '{}' is not known; 'drumlin --help' lists those that are", wanted),
                  bad_usage);
    app.parse(argc, argv);
  } catch (const CLI::ParseError &error) {
    if (error.get_exit_code() == 0) return app.exit(error); // help or version
    return fail(name, error.what(), bad_usage);
  } catch (const drumlin::post::UsageError &error) {
    return fail(name, error.what(), bad_usage);
  } catch (const std::exception &error) {
    return fail(name, error.what(), 1);
  }
  return session.status;
}

} // namespace

int main(int argc, char **argv) {
  try {
    const int status = run(argc, argv);
    const bool printed = std::fflush(stdout) == 0 && static_cast<bool>(std::cout.flush());
    return status != 0 || printed ? status
                                  : fail("", "standard output cannot be written; allowed: one that can", 1);
  } catch (...) { // not even a message could be made
    return 1;
  }
}
