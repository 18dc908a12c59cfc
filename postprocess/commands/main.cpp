// The tool behind ./drumlin: one program, one subcommand per job.
#include "commands/commands.h"
#include "support/units.h"
#include "support/process.h"
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

using drumlin::post::refusal;

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

int run(const std::vector<std::string> &words) {
  const std::string wanted = words.empty() ? "" : words.front();
  const bool known = drumlin::post::is_subcommand(wanted);
  const std::string name = known ? wanted : "";
  if (!known && !wanted.empty() && wanted.front() != '-')
    return fail(
        "", refusal("the subcommand", wanted, std::string("those that 'drumlin --help' lists") + left_out),
        bad_usage);
  try {
    drumlin::post::call(words);
  } catch (const CLI::ParseError &error) {
    for (const GoneOption &gone : gone_options)
      for (const std::string &word : words)
        if (name == gone.subcommand && word.substr(0, word.find('=')) == gone.option)
          return fail(name, refusal(gone.option, "given", gone.instead), bad_usage);
    return fail(name,
                refusal("the command line", drumlin::post::command_line(words),
                        fmt::format("what 'drumlin{} --help' lists: {}", name.empty() ? "" : " " + name,
                                    error.what())),
                bad_usage);
  } catch (const drumlin::post::UsageError &error) {
    return fail(name, error.what(), bad_usage);
  } catch (const std::exception &error) {
    return fail(name, error.what(), 1);
  }
  return 0;
}

} // namespace

int main(int argc, char **argv) {
  open_standard_streams();
  drumlin::post::stop_where_told();
  try {
    const int status = run({argv + 1, argv + argc});
    const bool printed = std::fflush(stdout) == 0 && static_cast<bool>(std::cout.flush());
    return status != 0 || printed ? status
                                  : fail("", "standard output cannot be written; allowed: one that can", 1);
  } catch (const drumlin::post::StoppedBySignal &signal) {
    drumlin::post::end_by(signal);
  } catch (...) { // there was no memory for a message
    return 1;
  }
}
