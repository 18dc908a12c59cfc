#include "tests/support/run_folders.h"
#include "tests/support/checks.h"
#include "chain/analysis.h"
#include "chain/exact_solution.h"
#include "runs/chain_files.h"
#include "support/files.h"

#include <unistd.h>

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
  values = with(values, given("deck chain, case {}, stepping none, steps_per_cycle 2000, timestep {}, engine "
                              "a test, command {}, ended yes",
                              case_name, number_text(p.period() / 2000), command));
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
  write_files(
      {{folder / "parameters.csv",
        parameters_text(
            given("deck impact, transition {}, k {}, D {}, m2 {}, speed {}, steps_per_contact 200, ended yes",
                  transition_name(transition), number_text(p.stiffness), number_text(p.damping_ratio),
                  number_text(p.mass), number_text(p.speed)))}});
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
  values = with(values, given("deck bed, case gravel, start roller.restart, stepping second, friction {}, "
                              "balls 2, r2 0.5, drum_depth 0.03, grading WMM_from_14mm, r_min 0.007, r_max "
                              "0.0265, d50 0.0301, C_u 1.75, layer_tops 0.5, e_loosest 0.3, e_shaken 0.1, "
                              "steps_per_cycle 800, timestep {}, command {}, ended yes",
                              friction, number_text(period / 800),
                              "liggghts -in <in.bed> -var out " + folder.filename().string()));
  write_files({{folder / "parameters.csv", parameters_text(values)}});
}

void write_bed_dumps(const fs::path &folder) {
  fs::create_directories(folder / "dump");
  for (const char *step : {"0", "200", "700", "800"}) {
    write(folder / "dump" / fmt::format("balls_{}.vtp", step), ball_dump());
    write(folder / "dump" / fmt::format("contacts_{}.dump", step), contact_dump());
  }
}

namespace {

std::string array_text(const Array &array) {
  return "<DataArray type=\"Float64\" Name=\"" + array.name + "\" NumberOfComponents=\"" +
         std::to_string(array.components) + "\" format=\"ascii\">" + array.values + "</DataArray>\n";
}

} // namespace

std::string point_data(int points, const std::string &places, const std::vector<Array> &arrays) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<PolyData>\n"
      "<Piece NumberOfPoints=\"" +
      std::to_string(points) +
      "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData>\n";
  for (const Array &array : arrays)
    text += array_text(array);
  return text + "</PointData>\n<Points>\n" + array_text({"Points", 3, places}) +
         "</Points>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

std::map<std::string, Array> ball_arrays() {
  return {{"id", {"id", 1, "9 2 1"}},           {"type", {"type", 1, "2 1 1"}},
          {"radius", {"radius", 1, "2 1 1"}},   {"mass", {"mass", 1, "500 20 10"}},
          {"v", {"v", 3, "0 0 0 0 6 0 3 0 0"}}, {"omega", {"omega", 3, "0 0 0 0 0 2 0 0 1"}},
          {"f", {"f", 3, "0 7 0 0 0 0 1 2 3"}}};
}
std::string ball_dump(const std::map<std::string, Array> &arrays, const std::string &places) {
  std::vector<Array> columns;
  columns.reserve(arrays.size());
  for (const auto &named : arrays)
    columns.push_back(named.second);
  return point_data(3, places, columns);
}

std::string contact_dump(const std::string &rows) {
  std::string text = "ITEM: TIMESTEP\n200\nITEM: NUMBER OF ENTRIES\n" +
                     std::to_string(std::count(rows.begin(), rows.end(), '\n')) + "\nITEM: ENTRIES";
  for (int n = 1; n <= 9; ++n)
    text += " f_contacts[" + std::to_string(n) + "]";
  return text + " \n" + rows;
}

ScratchStudy::ScratchStudy(std::string name)
    : name_(std::move(name)),
      folder_(fs::temp_directory_path() / fmt::format("drumlin-{}-{}", name_, ::getpid())) {
  fs::create_directories(folder_);
}

ScratchStudy::~ScratchStudy() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

post::Outcome ScratchStudy::run() const {
  return post::run_program(tool_words("study {} --quick --out out", name_), {}, folder_, 200);
}

fs::path made_file(const fs::path &folder, const std::string &begin, const std::string &end) {
  fs::path found;
  for (const fs::directory_entry &entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(begin, 0) != 0 || entry.path().extension() != end) continue;
    EXPECT_TRUE(found.empty()) << found << " and " << entry.path();
    found = entry.path();
  }
  EXPECT_FALSE(found.empty()) << begin;
  return found;
}

void interrupt(const fs::path &file) {
  std::istringstream in(post::read_text(file));
  std::string line, kept;
  for (int row = 0; std::getline(in, line); ++row)
    if (row == 0 || row % 2 == 1) kept += line + '\n';
  kept.resize(kept.size() - 3);
  std::ofstream(file) << kept;
}

namespace {

std::string joined(const std::vector<std::string> &lines) {
  std::string text;
  for (const std::string &line : lines)
    text += line + '\n';
  return text;
}

/// Begin and length of a word of the text, as commas, blanks, line ends and angle brackets part them.
std::pair<std::size_t, std::size_t> some_word(const std::string &text, Choice &choice) {
  constexpr const char *parting = ", \t\n<>\"=";
  const std::size_t begin = std::min(text.find_first_not_of(parting, choice.below(text.size())), text.size());
  return {begin, std::min(text.find_first_of(parting, begin), text.size()) - begin};
}

using Damage = std::function<std::string(std::string, Choice &)>;

std::string with_absurd_number(std::string text, Choice &choice) {
  static const std::vector<std::string> absurd =
      words_of("nan -nan NAN(1) inf -inf 1e308 -1e308 1e-308 5e-324 1e999 9.2e18 9223372036854775807 "
               "-9223372036854775808 18446744073709551616 1e18 1e9 2147483648 -1 0 -0 {} 0x10 1,5 1e --1 {} "
               "word 100% {} {} {}",
               "", "\"", "{}", "\xff\xfe", std::string(5000, '9'));
  const auto [begin, length] = some_word(text, choice);
  return text.replace(begin, length, choice.of(absurd));
}

std::string with_words_swapped(std::string text, Choice &choice) {
  auto one = some_word(text, choice);
  auto other = some_word(text, choice);
  if (one.first > other.first) std::swap(one, other);
  if (one.first + one.second > other.first) return text; // the same word
  const std::string first = text.substr(one.first, one.second);
  const std::string second = text.substr(other.first, other.second);
  return text.replace(other.first, other.second, first).replace(one.first, one.second, second);
}

std::string with_bytes_changed(std::string text, Choice &choice) {
  for (std::size_t n = 1 + choice.below(8); n > 0 && !text.empty(); --n)
    text[choice.below(text.size())] = static_cast<char>(choice.below(256));
  return text;
}

std::string shuffled(const std::string &text, Choice &choice) {
  std::vector<std::string> lines = lines_of(text);
  for (std::size_t n = lines.size(); n > 1; --n) // the first line, a header, keeps its place half of the time
    std::swap(lines[n - 1], lines[choice.below(n)]);
  return joined(lines);
}

std::string with_rows_moved(const std::string &text, Choice &choice) {
  std::vector<std::string> lines = lines_of(text);
  if (lines.size() < 3) return text;
  const auto at = [&] {
    return lines.begin() + static_cast<std::ptrdiff_t>(1 + choice.below(lines.size() - 1));
  };
  switch (choice.below(4)) {
  case 0:
    lines.erase(at());
    break;
  case 1: {
    const std::string line = *at();
    lines.insert(at(), line);
    break;
  }
  case 2:
    std::iter_swap(at(), at());
    break;
  default:
    lines.insert(at(), "");
  }
  return joined(lines);
}

const std::vector<Damage> &ways_to_damage() {
  static const std::vector<Damage> ways = {
      with_absurd_number, // five times as often as the others: it gets farthest
      with_absurd_number,
      with_absurd_number,
      with_absurd_number,
      with_absurd_number,
      with_words_swapped,
      with_bytes_changed,
      shuffled,
      with_rows_moved,
      [](const std::string &text, Choice &choice) { return text.substr(0, choice.below(text.size())); },
      [](const std::string &text, Choice &choice) { return text.substr(choice.below(text.size())); },
      [](const std::string &text, Choice &) { return text + text; },
      [](const std::string &text, Choice &) {
        std::string other;
        for (const char c : text)
          other += c == '\n' ? std::string("\r\n") : std::string(1, c);
        return other;
      },
  };
  return ways;
}

} // namespace

std::string damaged(const std::string &text, Choice &choice) {
  return choice.of(ways_to_damage())(text, choice);
}

} // namespace drumlin::test
