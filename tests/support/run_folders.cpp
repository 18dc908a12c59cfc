#include "tests/support/run_folders.h"

#include "chain/analysis.h"
#include "chain/exact_solution.h"
#include "runs/chain_files.h"
#include "support/files.h"
#include "tests/support/dump_texts.h"

#include <fmt/format.h>

#include <fstream>
#include <utility>
#include <vector>

namespace drumlin::test {

namespace fs = std::filesystem;
using namespace post;

namespace {

void write(const fs::path &file, const std::string &text) { std::ofstream(file, std::ios::binary) << text; }

} // namespace

void write_chain_run(const fs::path &folder, const std::string &case_name, Transition transition, int cycles,
                     const std::string &command) {
  const ChainParameters p = table1_case(case_name, transition);
  ExactOptions options;
  options.cycles = cycles;
  const ExactSolution result = post::solve_chain(p, options);
  fs::create_directories(folder);
  write_files({{folder / "chain.csv", chain_text(result.history)}});
  write_files({{folder / "events.csv", events_text(result.events)}});
  write_files({{folder / "cycles.csv", cycles_text(result.cycles)}});
  std::vector<std::pair<std::string, std::string>> values = parameter_values(p);
  values.insert(values.end(), {{"deck", "chain"},
                               {"case", case_name},
                               {"stepping", "none"},
                               {"steps_per_cycle", "2000"},
                               {"timestep", number_text(p.period() / 2000)},
                               {"engine", "a test"},
                               {"command", command},
                               {"ended", "yes"}});
  write_files({{folder / "parameters.csv", parameters_text(values)}});
}

void write_impact_run(const fs::path &folder, Transition transition, double damping_ratio) {
  ImpactParameters p;
  p.transition = transition;
  p.damping_ratio = damping_ratio;
  const double duration = impact_duration(p);
  const ImpactState last = impact_state(p, duration);
  fs::create_directories(folder);
  std::string text = "time,x_drum,v_drum,a_drum,F_contact,F_excitation\n";
  for (int i = 0; i <= 300; ++i) {
    const double t = 1.5 * duration * i / 300;
    ImpactState s = impact_state(p, t);
    if (t >= duration) s = {last.overlap + last.rate * (t - duration), last.rate, 0.0};
    text += fmt::format("{},{},{},{},{},0\n", t, -s.overlap, -s.rate, s.force / p.mass, s.force);
  }
  write(folder / "chain.csv", text);
  write(folder / "events.csv",
        fmt::format(
            "time,event,overlap,overlap_rate,force,id_i,id_j\n0,make,0,{},{},1,2\n{},break,{},{},{},1,2\n",
            p.speed, impact_state(p, 0).force, duration, last.overlap, last.rate,
            transition == Transition::A ? last.force : 0.0));
  write_files({{folder / "parameters.csv", parameters_text({{"deck", "impact"},
                                                            {"transition", transition_name(transition)},
                                                            {"k", number_text(p.stiffness)},
                                                            {"D", number_text(p.damping_ratio)},
                                                            {"m2", number_text(p.mass)},
                                                            {"speed", number_text(p.speed)},
                                                            {"steps_per_contact", "200"},
                                                            {"ended", "yes"}})}});
}

void write_bed_run(const fs::path &folder, Transition transition, int cycles, const std::string &friction) {
  fs::create_directories(folder);
  std::string bed = "time,x_drum,v_drum,a_drum,x_frame,v_frame,a_frame,F_contact,F_excitation,F_bond,"
                    "settlement,overlap_ratio,coordination,void_ratio,kinetic,potential,elastic,dissipated,"
                    "work_excitation,F_floor,F_sides,F_thrust\n";
  const int last = cycles * rows_per_cycle;
  for (int i = 0; i <= last; ++i) {
    const int in_last_cycle = i - (last - rows_per_cycle); // 0 to 8
    bed += fmt::format("{:.17g},{},0,{},0,0,0,{},0,0,0,0,{},{},7,{},3,{},{},9e4,100,1e5\n",
                       i * period / rows_per_cycle, -1e-3 * i, i % rows_per_cycle, 1e3 * (i % rows_per_cycle),
                       in_last_cycle < 0 ? 3.3 : 1.0 + in_last_cycle, i == 0 ? 0.25 : 0.2, i == 0 ? -9 : -20,
                       i == last ? 120 : 60 * (i > 0), i == last ? 100 : 50 * (i > 0));
  }
  write(folder / "bed.csv", bed);
  std::string table = "cycle,time,a_drum_min,a_drum_max,F_contact_min,F_contact_max,contact_share,a1_cos,a1_"
                      "sin,a2_cos,a2_sin,ah_cos,ah_sin,settlement\n0,0,0,0,0,0,1,0,0,0,0,0,0,0\n";
  for (int n = 1; n <= cycles; ++n)
    table +=
        fmt::format("{},{:.17g},{},{},{},{},{},3,4,0.5,0,0,0,{}\n", n, n * period, -n, n == 1 ? 99 : 10 + n,
                    -100 * n, n == 2 ? 99e3 : 1e3 * n, n % 2 == 0 ? 0.5 : 1.0, 1e-3 * n * n);
  write(folder / "cycles.csv", table);
  write(folder / "events.csv", "time,event,overlap,overlap_rate,force,id_i,id_j\n");
  ChainParameters p;
  p.transition = transition;
  std::vector<std::pair<std::string, std::string>> values = parameter_values(p);
  values.insert(values.end(), {{"deck", "bed"},
                               {"case", "gravel"},
                               {"start", "roller.restart"},
                               {"stepping", "second"},
                               {"friction", friction},
                               {"balls", "2"},
                               {"r2", "0.5"},
                               {"drum_depth", "0.03"},
                               {"grading", "WMM_from_14mm"},
                               {"r_min", "0.007"},
                               {"r_max", "0.0265"},
                               {"d50", "0.0301"},
                               {"C_u", "1.75"},
                               {"layer_tops", "0.5"},
                               {"e_loosest", "0.3"},
                               {"e_densest", "0.1"},
                               {"steps_per_cycle", "800"},
                               {"timestep", number_text(period / 800)},
                               {"command", "liggghts -in <in.bed> -var out " + folder.filename().string()},
                               {"ended", "yes"}});
  write_files({{folder / "parameters.csv", parameters_text(values)}});
}

void write_bed_dumps(const fs::path &folder) {
  fs::create_directories(folder / "dump");
  for (const char *step : {"0", "200", "700", "800"}) {
    write(folder / "dump" / fmt::format("balls_{}.vtp", step), ball_dump());
    write(folder / "dump" / fmt::format("contacts_{}.dump", step), contact_dump());
  }
}

} // namespace drumlin::test
