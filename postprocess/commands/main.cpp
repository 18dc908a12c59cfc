// The tool behind ./drumlin: one program, one subcommand per job.
#include "commands/commands.h"
#include "support/range.h"
#include "support/stop_signal.h"
#include "support/usage_error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

namespace {

using drumlin::post::AddCommand;
using drumlin::post::refusal;

struct Subcommand {
  const char *name;
  AddCommand add;
};

// A new subcommand is one line here. A build with -DDRUMLIN_POSTPROCESS=OFF has `run` alone, which needs none
// of the libraries of the others.
constexpr std::array subcommands = {
#ifndef DRUMLIN_ONLY_RUN
    Subcommand{"advise", &drumlin::post::add_advise_command},
    Subcommand{"bed", &drumlin::post::add_bed_command},
    Subcommand{"calibrate", &drumlin::post::add_calibrate_command},
    Subcommand{"demo", &drumlin::post::add_demo_command},
    Subcommand{"exact", &drumlin::post::add_exact_command},
    Subcommand{"way", &drumlin::post::add_way_command},
    Subcommand{"identify", &drumlin::post::add_identify_command},
    Subcommand{"map", &drumlin::post::add_map_command},
    Subcommand{"meter", &drumlin::post::add_meter_command},
    Subcommand{"passes", &drumlin::post::add_passes_command},
    Subcommand{"report", &drumlin::post::add_report_command},
    Subcommand{"study", &drumlin::post::add_study_command},
    Subcommand{"vtk", &drumlin::post::add_vtk_command},
#endif
    Subcommand{"run", &drumlin::post::add_run_command},
};

#ifdef DRUMLIN_ONLY_RUN
constexpr const char *left_out = " in a build with -DDRUMLIN_POSTPROCESS=OFF";
#else
constexpr const char *left_out = "";
#endif

struct GoneOption {
  const char *subcommand, *option, *instead;
};
constexpr std::array gone_options = {
    GoneOption{"advise", "--ends", "none; inputs/study/ends/findings.md says how many contacts are enough"},
    GoneOption{"exact", "--rtol", "none; the solution has all digits"},
    GoneOption{"meter", "--export", "none; meter.csv in --out has all values, a site is mapped by Veta"},
    GoneOption{"passes", "--field", "none, but folders of runs: FOLDER...; a site is mapped by Veta"},
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

/// Opens standard input, output and error streams that are closed, to /dev/null: otherwise a file that is
/// opened later would get the number of one of them, and the printed text would go into this file.
void open_standard_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
    if (::fcntl(stream, F_GETFD) < 0)
      static_cast<void>(::open("/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY));
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
      return fail(
          "", refusal("the subcommand", wanted, std::string("those that 'drumlin --help' lists") + left_out),
          bad_usage);
    app.parse(argc, argv);
  } catch (const CLI::ParseError &error) {
    if (error.get_exit_code() == 0) return app.exit(error); // help or version
    for (const GoneOption &gone : gone_options)
      for (const std::string &word : std::vector<std::string>(argv + 1, argv + argc))
        if (name == gone.subcommand && word.substr(0, word.find('=')) == gone.option)
          return fail(name, refusal(gone.option, "given", gone.instead), bad_usage);
    return fail(name,
                refusal("the command line", session.command,
                        fmt::format("what 'drumlin{} --help' lists: {}", name.empty() ? "" : " " + name,
                                    error.what())),
                bad_usage);
  } catch (const drumlin::post::UsageError &error) {
    return fail(name, error.what(), bad_usage);
  } catch (const std::exception &error) {
    return fail(name, error.what(), 1);
  }
  return session.status;
}

} // namespace

int main(int argc, char **argv) {
  open_standard_streams();
  drumlin::post::stop_where_told();
  try {
    const int status = run(argc, argv);
    const bool printed = std::fflush(stdout) == 0 && static_cast<bool>(std::cout.flush());
    return status != 0 || printed ? status
                                  : fail("", "standard output cannot be written; allowed: one that can", 1);
  } catch (const drumlin::post::StoppedBySignal &signal) {
    drumlin::post::end_by(signal);
  } catch (...) { // there was no memory for a message
    return 1;
  }
}
