// Damaged files: cut, shuffled, swapped, with absurd numbers, with the line ends of another system. Every
// command that reads them ends within 200 s in a result or in one line that says what is wrong, and touches
// nothing else. Built with the sanitizers, so that memory errors that would otherwise have no visible effect
// end the command.
//
// The number of a mutant is the seed of everything that is random in it: a failure names it, and the same
// number gives the same damage.
#include "tests/support/run_folders.h"
#include "tests/support/tool.h"
#include "support/process.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;
using post::Outcome;
using post::Transition;

// -- What is damaged ----------------------------------------------------------------------------------------

/// A command and the files that it reads. Another command, or a deck, is another one of these in `subjects`.
struct Subject {
  const char *name;
  int mutants; ///< how many are tried
  void (*write)(const fs::path &folder);
  std::vector<std::string> files; ///< of these one or two are damaged
  /// Runs the command in the folder of the files. It may write to `out` there, and nowhere else.
  Outcome (*run)(const fs::path &folder, int mutant);
};

/// The name of a test with this subject, rather than its bytes.
void PrintTo(const Subject &subject, std::ostream *out) { *out << subject.name; }

constexpr double most_seconds = 200.0;

Outcome run_tools(const fs::path &folder, std::vector<std::string> words) {
  words.insert(words.begin(), DRUMLIN_TOOLS);
  return post::run_program(words, {"ASAN_OPTIONS=exitcode=99", "UBSAN_OPTIONS=exitcode=99"}, folder,
                           most_seconds);
}

Outcome run_report(const fs::path &folder, int mutant) {
  constexpr int really_drawn = 12; // one in so many; the others need not wait for gnuplot
  std::optional<SketchedPictures> sketched;
  if (mutant % really_drawn != 0) sketched.emplace();
  return run_tools(folder, {"report", "run", "--out", "out"});
}

Outcome run_vtk(const fs::path &folder, int /*mutant*/) {
  return run_tools(folder, {"vtk", "run", "--out", "out"});
}

Outcome run_advise(const fs::path &folder, int mutant) {
  const std::vector<std::string> own = words_of("advise --from run --case II --k 2e8");
  const std::vector<std::string> measured = words_of("advise --from run --case IV --stepping stock");
  return run_tools(folder, mutant % 4 == 0 ? own : measured); // the first solves the chain seven times
}

Outcome run_exact(const fs::path &folder, int /*mutant*/) {
  return run_tools(folder, words_of("exact --roller run/roller --setting low --cycles 3 --out out"));
}

Outcome run_passes(const fs::path &folder, int /*mutant*/) {
  const SketchedPictures sketched;
  return run_tools(folder, words_of("passes run --cell 0.4 --out out"));
}

void write_chain(const fs::path &folder) {
  write_chain_run(folder / "run", "II", Transition::B, 4);
  // The engine's cycles.csv has energies and harmonics besides.
  const post::Table table = post::read_table(folder / "run" / "cycles.csv");
  std::string text =
      "cycle,a_drum_min,a_drum_max,F_contact_min,F_contact_max,a1_cos,a1_sin,a2_cos,a2_sin,ah_cos,ah_sin,"
      "work_excitation,dissipated_contact,dissipated_bond,kinetic,potential,stored_contact,stored_bond\n";
  for (int cycle = 0; cycle <= 4; ++cycle)
    text += fmt::format("{0},-9.5,{0},-1e3,1e5,3,4,0.5,0,0.1,0,{1},{0},5,100.5,20,7,8\n", cycle, 120 * cycle);
  std::ofstream(folder / "run" / "cycles.csv", std::ios::binary) << text;
}

void write_bed(const fs::path &folder) {
  write_bed_run(folder / "run", Transition::B, 3);
  write_bed_dumps(folder / "run");
}

/// Two passes of 2 m at 1 m/s and 20 Hz over two rows of discs.
void write_drive(const fs::path &folder) {
  fs::create_directories(folder / "run/dump");
  constexpr double w = 40.0 * 3.14159265358979323846, r = 0.05;
  std::string bed = "time,x_drum,v_drum,a_drum,x_frame,v_frame,a_frame,F_contact,F_excitation,F_bond,"
                    "work_excitation,s,pass,traction,torque,work_traction,work_torque\n";
  std::string cycles =
      "cycle,time,contact_share,a1_cos,a1_sin,a2_cos,a2_sin,ah_cos,ah_sin\n0,0,1,0,0,0,0,0,0\n";
  for (int row = 0; row <= 1600; ++row) {
    const double t = row / 400.0, s = t < 2.0 ? -1.0 + t : 3.0 - t;
    bed += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},0,0,0,{:.9g},{:.9g},0,{:.9g},{:.9g},{},100,0,{:.9g},0\n",
                       t, -5.0 * std::cos(w * t) / (w * w), 5.0 * std::sin(w * t) / w, 5.0 * std::cos(w * t),
                       2000.0 * (9.81 + 5.0 * std::cos(w * t)) + 9810.0 + 100.0 * std::sin(w * t),
                       100.0 * std::sin(w * t), 50.0 * t, s, t < 2.0 ? 1 : 2, 100.0 * t);
  }
  for (int cycle = 1; cycle <= 80; ++cycle)
    cycles += fmt::format("{},{:.9g},1,5,0,0.5,0,0,0\n", cycle, cycle / 20.0);
  std::ofstream(folder / "run/bed.csv", std::ios::binary) << bed;
  std::ofstream(folder / "run/cycles.csv", std::ios::binary) << cycles;
  std::ofstream(folder / "run/parameters.csv", std::ios::binary)
      << fmt::format("name,value\ndeck,drive\ndimension,2\nmeasure_from,-0.5\nmeasure_to,0.5\nspeed,1\nomega,"
                     "{:.12g}\nFw,100\nm2,2000\nm3,1000\ntimestep,0.0005\nended,yes\n",
                     w);
  for (const int step : {0, 2000, 4000, 8000}) {
    std::string balls, contacts;
    int count = 0;
    for (int i = 0; i < 30; ++i)
      for (int layer = 0; layer < 2; ++layer) {
        balls += fmt::format("{} {} {} 3 {:.9g} {:.9g} 0 0 0 0 0 0 0 0 0 0\n", ++count, layer == 0 ? 1 : 4, r,
                             -1.5 + 2.0 * r * (i + 0.5), r + 2.0 * r * layer);
        if (layer == 1) contacts += fmt::format("{} {} 0 10 0 0 1 0 0\n", count, count - 1);
      }
    for (const int type : {2, 3})
      balls += fmt::format("{} {} 0.3 100 0 {} 0 0 0 0 0 0 0 0 0 0\n", ++count, type, type);
    std::ofstream(folder / fmt::format("run/dump/balls_{}.dump", step), std::ios::binary) << fmt::format(
        "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: ATOMS id type radius mass x y z vx vy "
        "vz omegax omegay omegaz fx fy fz\n{}",
        step, count, balls);
    std::ofstream(folder / fmt::format("run/dump/contacts_{}.dump", step), std::ios::binary) << fmt::format(
        "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ENTRIES\n30\nITEM: ENTRIES f_contacts[1] f_contacts[2] "
        "f_contacts[3] f_contacts[4] f_contacts[5] f_contacts[6] f_contacts[7] f_contacts[8] "
        "f_contacts[9]\n{}",
        step, contacts);
  }
}

void write_curves(const fs::path &folder) {
  fs::create_directories(folder / "run");
  for (const char *file : {"chain.csv", "scaling.csv"})
    fs::copy_file(fs::path(DRUMLIN_SOURCE_DIR) / "inputs/study/accuracy" / file, folder / "run" / file);
}

void write_roller(const fs::path &folder) {
  fs::create_directories(folder / "run");
  fs::copy_file(fs::path(DRUMLIN_SOURCE_DIR) / "inputs/rollers/CA3500", folder / "run/roller");
}

const std::vector<std::string> csv_files = {"chain.csv", "events.csv", "cycles.csv", "parameters.csv",
                                            "parameters.csv"};
const std::vector<std::string> dump_files =
    words_of("dump/balls_0.vtp dump/balls_800.vtp dump/contacts_0.dump dump/contacts_800.dump "
             "dump/contacts_700.dump parameters.csv");

const std::vector<Subject> &subjects() {
  static const std::vector<Subject> all = {
      {"chain", 100, write_chain, csv_files, run_report},
      {"impact",
       80,
       [](const fs::path &folder) { write_impact_run(folder / "run", Transition::B, 0.5); },
       {"chain.csv", "events.csv", "parameters.csv", "parameters.csv"},
       run_report},
      {"bed",
       100,
       write_bed,
       {"bed.csv", "events.csv", "cycles.csv", "parameters.csv", "parameters.csv"},
       run_report},
      {"dumps", 100, write_bed, dump_files, run_report},
      {"vtk", 100, write_bed, dump_files, run_vtk},
      {"passes", 150, write_drive,
       words_of("bed.csv cycles.csv parameters.csv dump/balls_0.dump dump/balls_4000.dump "
                "dump/contacts_8000.dump"),
       run_passes},
      {"advise", 40, write_curves, {"chain.csv", "scaling.csv"}, run_advise},
      {"roller", 300, write_roller, {"roller"}, run_exact},
  };
  return all;
}

// -- The test -----------------------------------------------------------------------------------------------

class Fuzz : public ::testing::TestWithParam<Subject> {
protected:
  const Scratch scratch_;
  const fs::path folder = scratch_.path();
};

/// What is wrong with how a command ended; empty if nothing.
std::string fault_of(const Outcome &outcome, const fs::path &place) {
  if (outcome.timed_out) return fmt::format("no end within {} s", most_seconds);
  if (outcome.status != 0 && outcome.status != 1 && outcome.status != 2)
    return fmt::format("ended with {}", outcome.status);
  const std::vector<std::string> lines = lines_of(outcome.output);
  const auto errors = std::count_if(lines.begin(), lines.end(), [](const std::string &line) {
    return line.rfind("ERROR: drumlin ", 0) == 0;
  });
  if (outcome.status == 0) return errors == 0 ? "" : "an error, but status 0";
  if (errors != 1) return fmt::format("status {} with {} lines of error", outcome.status, errors);
  if (outcome.says("std::")) return "an error of the language, not of the input";
  for (const fs::directory_entry &entry : fs::directory_iterator(place))
    if (const std::string name = entry.path().filename().string();
        name != "run" && name != post::program_output_file)
      return "left over: " + name;
  return "";
}

TEST_P(Fuzz, EndsInAResultOrInOneLine) {
  const Subject &subject = GetParam();
  subject.write(folder / "sound");
  ASSERT_TRUE(subject.run(folder / "sound", 0).ok()) << subject.run(folder / "sound", 0).output;
  fs::remove_all(folder / "sound" / "out");
  fs::remove(folder / "sound" / post::program_output_file);
  int results = 0;
  for (int mutant = 0; mutant < subject.mutants; ++mutant) {
    const fs::path place = folder / "damaged";
    fs::remove_all(place);
    fs::copy(folder / "sound", place, fs::copy_options::recursive);
    Choice choice(static_cast<unsigned>(mutant));
    std::string damaged_files;
    for (std::size_t n = 1 + choice.below(2); n > 0; --n) {
      const std::string &file = choice.of(subject.files);
      damaged_files += ' ' + file;
      const std::string text = damaged(post::read_text(place / "run" / file), choice);
      std::ofstream(place / "run" / file, std::ios::binary) << text;
    }
    const Outcome outcome = subject.run(place, mutant);
    if (outcome.ok()) ++results;
    if (const std::string fault = fault_of(outcome, place); !fault.empty()) {
      const fs::path kept =
          fs::temp_directory_path() / fmt::format("drumlin-fuzz-{}-{}", subject.name, mutant);
      fs::remove_all(kept);
      fs::copy(place, kept, fs::copy_options::recursive);
      ADD_FAILURE() << subject.name << ", mutant " << mutant << " (" << damaged_files.substr(1)
                    << "): " << fault << "; kept in " << kept << "\n"
                    << outcome.output.substr(0, 3000);
    }
  }
  // The test is meaningful only if some damaged files are accepted and some are refused.
  EXPECT_GT(results, subject.mutants / 20);
  EXPECT_LT(results, subject.mutants);
  RecordProperty("results", results);
}

INSTANTIATE_TEST_SUITE_P(Files, Fuzz, ::testing::ValuesIn(subjects()),
                         [](const ::testing::TestParamInfo<Subject> &subject) {
                           return std::string(subject.param.name);
                         });

} // namespace
} // namespace drumlin::test
