#include "tests/support/host_deck.h"

#include "engine/engine_command.h"

#include <fstream>
#include <stdexcept>

namespace drumlin::test {

namespace fs = std::filesystem;

std::string host_pair_style() { return "pair_style gran model hooke/transition\npair_coeff * *\n"; }

std::string property(const std::string &name, const std::string &value) {
  std::string line = "fix " + name + " all property/global " + name + " peratomtypepair 3";
  for (int n = 0; n < 9; ++n)
    line += " " + value;
  return line + "\n";
}

std::string host_properties(const std::string &text) {
  std::string lines;
  for (const auto &[name, value] : Variables{{"kn", "1e7"},
                                             {"dampingRatio", "0.5"},
                                             {"gamman_abs", "1e5"},
                                             {"coefficientRollingFriction", "0.1"}})
    if (text.find("property/global " + name) == std::string::npos) lines += property(name, value);
  return lines;
}

std::string with_other_ids(const std::string &lines) {
  return "create_atoms 1 single 1.5 1.5 -1 units box\nset type 1 diameter 1.0\nset type 1 mass 2000\n" +
         lines + "\nrun 5\ngroup gone id 1\ndelete_atoms group gone";
}

std::vector<std::string> mpi_environment(const fs::path &folder) {
  return {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
          "OMPI_MCA_rmaps_base_oversubscribe=1", "OMPI_MCA_hwloc_base_binding_policy=none",
          "OMPI_MCA_mpi_yield_when_idle=1",
          "OMPI_MCA_odls_base_sigkill_timeout=0", // after a rank has failed mpirun waits 1 to 2 s by default
          // Without a daemon for one rank and without a search for networks a start takes 0.04 s instead of
          // 0.33. Single ranks without a daemon would share one session folder, and race for it.
          "OMPI_MCA_orte_tmpdir_base=" + folder.string(), "OMPI_MCA_ess_singleton_isolated=1",
          "OMPI_MCA_pml=ob1", "OMPI_MCA_btl=self,vader"};
}

Outcome run_engine(const fs::path &deck, const std::vector<std::string> &words, const fs::path &folder,
                   int ranks) {
  std::vector<std::string> arguments = {"-log", "none"};
  arguments.insert(arguments.end(), words.begin(), words.end());
  const post::EngineCommand command = post::engine_command(deck, arguments, ranks, post::Cores::shared);
  std::vector<std::string> environment = mpi_environment(folder);
  environment.insert(environment.end(), command.environment.begin(), command.environment.end());
  return run_program(command.words, environment, folder, 600.0);
}

const fs::path host_deck = fs::path(DRUMLIN_SOURCE_DIR) / "tests/support/in.host";

void write_host(const std::string &pair, const std::string &lines, const fs::path &folder) {
  write_text(folder / "pair", pair + "\n"); // the engine ignores a last line without its end
  write_text(folder / "lines", lines + "\n");
}

Outcome run_host(const std::string &pair, const std::string &lines, const fs::path &folder, int ranks) {
  write_host(pair, lines, folder);
  return run_engine(host_deck, {}, folder, ranks);
}

Outcome run_lammps_host(const std::string &lines, const fs::path &folder, int ranks) {
  write_text(folder / "lines", lines + "\nrun 20\n");
  const WaitForRanks at_once(0);
  return run_deck(fs::path(DRUMLIN_SOURCE_DIR) / "tests/support/host.lammps",
                  {{"lines", (folder / "lines").string()}}, folder, ranks);
}

void write_text(const fs::path &file, const std::string &text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

} // namespace drumlin::test
