// What must not change the results of a scene: every row of the table `invariances`, run in each way that it
// names.
#include "tests/core/law_samples.h"
#include "tests/support/engine_runs.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

const fs::path inputs = fs::path(DRUMLIN_SOURCE_DIR) / "inputs";

/// How far results may be apart; 0: they are the same digit for digit, none: not tried.
using Allowed = std::optional<double>;

struct ResultFile {
  std::string name;
  std::vector<std::string> columns; ///< of a table, that are compared; none: all
  bool is_dump() const { return fs::path(name).extension() == ".txt"; }
};

struct Change {
  Variables variables;
  Allowed allowed;
};

struct Row {
  std::string heading, text; ///< of its scene, and its variables, as they are in the table
  int line = 0;
  bool of_inputs = false; ///< a deck of inputs
  std::string scene;
  std::vector<ResultFile> files;
  Variables variables, in_lammps;
  std::string properties; ///< of a law that the scene does not know: commands of LIGGGHTS
  Allowed ranks, engine;
  std::string restart;
  bool newton = false, by_night = false;
  std::vector<Change> also;
};

/// Reads a table line by line. Throws std::runtime_error with file and line.
class Reader {
public:
  explicit Reader(fs::path file) : file_(std::move(file)) {}
  std::vector<Row> read() {
    std::ifstream in(file_);
    if (!in) throw std::runtime_error("cannot read " + file_.string());
    std::string whole;
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      if (line.rfind("    ", 0) == 0 && !whole.empty()) {
        whole += line.substr(3);
        continue;
      }
      take(whole);
      whole = line;
      line_ = number;
    }
    take(whole);
    return rows_;
  }

private:
  [[noreturn]] void fail(const std::string &what) const {
    throw std::runtime_error(fmt::format("{}:{}: {}", file_.string(), line_, what));
  }

  void take(const std::string &line) {
    if (line.empty() || line[0] == '#') return;
    if (line.rfind("scene ", 0) == 0 || line.rfind("deck ", 0) == 0)
      take_heading(line);
    else if (line.rfind("all ", 0) == 0 && !heading_.scene.empty())
      heading_.variables = variables(line.substr(4));
    else
      take_row(line);
  }

  void take_heading(const std::string &line) {
    const std::vector<std::string> sides = parts_of(line, ": ");
    if (sides.size() != 2) fail("heading is '" + line + "'; allowed: scene NAME: FILES");
    heading_ = Row();
    heading_.heading = sides[0];
    heading_.of_inputs = line[0] == 'd';
    heading_.scene = sides[0].substr(sides[0].find(' ') + 1);
    for (const std::string &file : parts_of(sides[1], ", ")) {
      std::vector<std::string> words = parts_of(file, " ");
      heading_.files.push_back({words[0], {words.begin() + 1, words.end()}});
      if (!heading_.files.back().is_dump() && fs::path(words[0]).extension() != ".csv")
        fail("file is '" + words[0] + "'; allowed: a dump of balls, .txt, or a table, .csv");
    }
  }

  void take_row(std::string line) {
    if (heading_.scene.empty()) fail("row is '" + line + "'; allowed: one below `scene NAME: FILES`");
    Row row = heading_;
    row.line = line_;
    const std::string night = " {night}";
    if (line.size() > night.size() && line.substr(line.size() - night.size()) == night) {
      row.by_night = true;
      line.erase(line.size() - night.size());
    }
    const std::vector<std::string> cells = parts_of(line, " | ");
    if (cells.size() != 6)
      fail("row is '" + line + "'; allowed: variables | ranks | restart at | newton | other engine | also");
    row.text = cells[0];
    row.ranks = allowed(cells[1]);
    if (cells[2] != "-") row.restart = cells[2];
    if (cells[3] != "on" && cells[3] != "-") fail("newton is '" + cells[3] + "'; allowed: on, -");
    row.newton = cells[3] == "on";
    const std::vector<std::string> engine = parts_of(cells[4], " with ");
    row.engine = allowed(engine[0]);
    if (engine.size() > 1) row.in_lammps = variables(engine[1]);
    if (cells[5] != "-")
      for (const std::string &change : parts_of(cells[5], "; ")) {
        const std::vector<std::string> sides = parts_of(change, ": ");
        if (sides.size() != 2) fail("also is '" + change + "'; allowed: NAME VALUE: DIFFERENCE");
        row.also.push_back({variables(sides[0]), allowed(sides[1])});
      }
    if (cells[0] == "each law") return add_laws(row);
    row.variables = with(variables(cells[0]), row.variables);
    rows_.push_back(row);
  }

  Allowed allowed(const std::string &cell) const {
    if (cell == "-") return {};
    if (cell == "exact") return 0.0;
    const std::optional<double> value = post::any_number_from_text(cell);
    if (!value || *value <= 0) fail("difference is '" + cell + "'; allowed: a number > 0, exact, -");
    return value;
  }

  Variables variables(const std::string &cell) const {
    Variables all;
    if (cell == "-") return all;
    for (const std::string &part : parts_of(cell, ", ")) {
      const std::size_t blank = part.find(' ');
      if (blank == std::string::npos) fail("variable is '" + part + "'; allowed: NAME VALUE");
      const std::string value =
          replaced(part.substr(blank + 1), "DECKS", test_deck("").parent_path().string());
      all.emplace_back(part.substr(0, blank), replaced(value, "INPUTS", inputs.string()));
    }
    return all;
  }

  /// A row for each law of the list that the scene's own files do not know, with its sample parameters.
  void add_laws(const Row &row) {
    for_each_law([&](auto law) {
      using Law = typename decltype(law)::type;
      if constexpr (std::is_same_v<Law, physics::LinearContact> || std::is_same_v<Law, physics::HertzContact>)
        return;
      Row of_law = row;
      const std::string style = Law::name;
      of_law.text = style.substr(0, style.find('/'));
      of_law.variables = given("normal {}, tangential coulomb, rolling epsd2", of_law.text);
      std::string words;
      for_each_given<Law>(1e5, [&](const auto &p, double value) {
        if (may_be_left_out(p)) return;
        const std::string given = number(value);
        const bool of_types = std::is_same_v<std::decay_t<decltype(p)>, physics::MaterialParameter>;
        of_law.properties += fmt::format("fix {0} all property/global {0} {1} {2}\n", p.property,
                                         of_types ? "peratomtype" : "peratomtypepair 2",
                                         given + " " + given + (of_types ? "" : " " + given + " " + given));
        words += (words.empty() ? "" : " ") + given;
      });
      of_law.in_lammps.emplace_back("parameters", words);
      rows_.push_back(of_law);
    });
  }

  fs::path file_;
  int line_ = 0;
  Row heading_;
  std::vector<Row> rows_;
};

// --- how far results are apart

/// Of balls that are where they are at the start: the engine numbers them rank by rank. Places in m, spins
/// as 1e-3 of the fastest; infinite for other steps or balls.
double difference_of_dumps(const fs::path &one, const fs::path &other) {
  const std::vector<Frame> a = read_dump(one), b = read_dump(other);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (a.empty() || a.size() != b.size() || a[0].balls.size() != b[0].balls.size()) return infinite;
  std::map<std::array<double, 3>, long> there;
  for (const auto &[id, ball] : b[0].balls)
    there[ball.x] = id;
  double places = 0, spins = 0, fastest = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    if (a[n].step != b[n].step || a[n].balls.size() != b[n].balls.size()) return infinite;
    for (const auto &[id, ball] : a[n].balls) {
      const auto same = there.find(a[0].balls.at(id).x);
      if (same == there.end() || b[n].balls.count(same->second) == 0) return infinite;
      const Ball &twin = b[n].balls.at(same->second);
      for (std::size_t k = 0; k < 3; ++k) {
        places = std::fmax(places, std::fabs(ball.x[k] - twin.x[k]));
        spins = std::fmax(spins, std::fabs(ball.omega[k] - twin.omega[k]));
        fastest = std::fmax(fastest, std::fabs(ball.omega[k]));
      }
    }
  }
  return std::fmax(places, fastest > 0 ? 1e-3 * spins / fastest : spins);
}

std::vector<std::string> columns_of(const ResultFile &file, const post::Table &table) {
  return file.columns.empty() ? table.header() : file.columns;
}

/// The rows of a table, without those that fix print of LAMMPS alone writes in the set-up of a run: of the
/// time 0, or of the time of the row before.
std::vector<std::size_t> rows_of_steps(const post::Table &table) {
  std::vector<std::size_t> rows;
  for (std::size_t n = 0; n < table.rows(); ++n)
    if (table.row(n)[0] != (n == 0 ? "0" : table.row(n - 1)[0])) rows.push_back(n);
  return rows;
}

/// As part of the largest number in its column; infinite for other rows or words.
double difference_of_tables(const ResultFile &file, const post::Table &one, const post::Table &other) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> of_one(one.rows()), of_other(other.rows());
  std::iota(of_one.begin(), of_one.end(), 0);
  std::iota(of_other.begin(), of_other.end(), 0);
  if (one.rows() != other.rows()) {
    of_one = rows_of_steps(one);
    of_other = rows_of_steps(other);
  }
  if (of_one.size() != of_other.size()) return infinite;
  double most = 0;
  for (const std::string &column : columns_of(file, one)) {
    const std::vector<std::string> a = one.text(column), b = other.text(column);
    double apart = 0, largest = 0;
    for (std::size_t n = 0; n < of_one.size(); ++n) {
      const std::string &this_cell = a[of_one[n]], &other_cell = b[of_other[n]];
      const auto x = post::any_number_from_text(this_cell), y = post::any_number_from_text(other_cell);
      if (x && y) {
        apart = std::fmax(apart, std::fabs(*x - *y));
        largest = std::fmax(largest, std::fabs(*x));
      } else if (this_cell != other_cell) {
        return infinite;
      }
    }
    if (apart > 0) most = std::fmax(most, apart / largest);
  }
  return most;
}

double difference(const ResultFile &file, const fs::path &one, const fs::path &other) {
  return file.is_dump() ? difference_of_dumps(one / file.name, other / file.name)
                        : difference_of_tables(file, post::read_table(one / file.name),
                                               post::read_table(other / file.name));
}

/// The frames of a dump behind a step, as text.
std::string frames_behind(const fs::path &dump, long step) {
  const std::string text = read_text(dump), begin = "ITEM: TIMESTEP\n";
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1))
    if (std::stol(text.substr(at + begin.size())) > step) return text.substr(at);
  return {};
}

/// The last rows of a table, as text.
std::string last_rows(const ResultFile &file, const post::Table &table, std::size_t count) {
  std::string text;
  for (const std::string &column : columns_of(file, table)) {
    const std::vector<std::string> cells = table.text(column);
    for (std::size_t n = cells.size() - count; n < cells.size(); ++n)
      text += cells[n] + "\n";
  }
  return text;
}

// --- runs

struct Way {
  std::string engine = "liggghts";
  int ranks = 1;
  const char *newton = "off";
  std::string name() const { return fmt::format("{}, {} ranks, newton {}", engine, ranks, newton); }
};

class Invariance : public ::testing::Test {
public:
  Invariance(Row row, bool on_ranks) : row_(std::move(row)), on_ranks_(on_ranks) {}

  void TestBody() override {
    const Scratch base;
    run({}, {}, base);
    if (on_ranks_) {
      for (int ranks = 2; ranks <= most_ranks(); ranks *= 2) {
        compare({"liggghts", ranks}, row_.ranks, base);
        if (in_lammps()) compare_newton(ranks, std::max(*row_.engine, *row_.ranks), base);
      }
      return;
    }
    expect_that_its_variables_matter(base);
    continues({}, base);
    with_changes({}, base);
    if (row_.engine && !in_lammps())
      GTEST_SKIP() << "SKIPPED for LAMMPS, which is not set up (./drumlin setup lammps)";
    if (in_lammps()) compare_newton(1, *row_.engine, base);
  }

private:
  bool in_lammps() const { return row_.engine && post::has_lammps(); }
  static bool by_night() { return most_ranks() > 2; }

  /// LAMMPS, by day with newton off on one rank and on on two.
  void compare_newton(int ranks, double allowed, const Scratch &base) const {
    for (const char *newton : {"off", "on"})
      if (row_.newton ? by_night() || (ranks > 1) == (*(newton + 1) == 'n') : *(newton + 1) == 'f')
        compare({"lammps", ranks, newton}, allowed, base);
  }

  void compare(const Way &way, const Allowed &allowed, const Scratch &base) const {
    const Scratch there;
    run(way, {}, there);
    expect_same(base, there, *allowed, way.name());
    continues(way, there);
    if (way.ranks == 1) with_changes(way, there);
  }

  void with_changes(const Way &way, const Scratch &base) const {
    for (const auto &[variables, allowed] : row_.also) {
      const Scratch there;
      run(way, variables, there);
      expect_same(base, there, *allowed, way.name() + ", " + variables[0].first);
    }
  }

  /// The engine takes the first value of a variable.
  void run(const Way &way, const Variables &more, const Scratch &folder) const {
    const bool lammps = way.engine == "lammps";
    Variables all = more;
    const auto add = [&all](const Variables &some) { all.insert(all.end(), some.begin(), some.end()); };
    if (lammps) add(row_.in_lammps);
    if (row_.newton) add({{"newton", lammps ? way.newton : "off"}});
    if (!row_.restart.empty()) add({{"first", row_.restart}});
    if (!row_.properties.empty() && !lammps) {
      write_text(folder / "properties", row_.properties);
      add({{"parameters", "include " + (folder / "properties").string()}});
    }
    for (const auto &[name, value] : row_.variables)
      if (name == "bottom") // a deck of the chain with this box, so that soil and drum are on two ranks
        add({{"chain", chain_with_bottom(folder.path(), std::stod(value)).string()}});
      else
        add({{name, value}});
    well(row_.of_inputs
             ? run_deck(inputs / (row_.scene + (lammps ? ".lammps" : "")), all, folder.path(), way.ranks)
             : run_scene(way.engine, row_.scene, all, folder.path(), way.ranks));
  }

  void expect_same(const Scratch &one, const Scratch &other, double allowed, const std::string &what) const {
    for (const ResultFile &file : row_.files) {
      if (allowed > 0) {
        EXPECT_LT(difference(file, one.path(), other.path()), allowed) << what << ", " << file.name;
      } else if (file.is_dump()) {
        const long step = row_.restart.empty() ? -1 : std::stol(row_.restart);
        const std::string expected = frames_behind(one / file.name, step);
        EXPECT_FALSE(expected.empty()) << file.name;
        EXPECT_TRUE(frames_behind(other / file.name, step) == expected) << what << ", " << file.name;
      } else {
        EXPECT_EQ(difference(file, one.path(), other.path()), 0.0) << what << ", " << file.name;
      }
    }
  }

  /// From each restart file, in a process of its own. On one rank, and where the second part adds rows to
  /// tables, the first part is run once more, without the second: it repeats itself digit for digit.
  void continues(const Way &way, const Scratch &stayed) const {
    if (row_.restart.empty()) return;
    const Scratch alone;
    const bool repeated = way.ranks == 1 || !row_.files.front().is_dump();
    if (repeated) run(way, {{"rest", "0"}}, alone);
    const fs::path left = repeated ? alone.path() : stayed.path();
    std::vector<std::string> starts = {"first.restart"};
    const std::string during = "during." + row_.restart; // which some scenes write within a run
    if (fs::exists(left / during) && (way.ranks == 1 || by_night())) starts.push_back(during);
    for (const std::string &start : starts) {
      const Scratch again; // with the tables of the first part
      fs::copy(left, again.path());
      run(way, given("again 1, start {}", (left / start).string()), again);
      for (const ResultFile &file : row_.files)
        expect_continued(file, stayed.path(), left, again.path(),
                         way.name() + ", " + start + ", " + file.name);
    }
  }

  void expect_continued(const ResultFile &file, const fs::path &stayed, const fs::path &left,
                        const fs::path &again, const std::string &what) const {
    if (file.is_dump()) {
      EXPECT_EQ(read_text(stayed / file.name).rfind(read_text(left / file.name), 0), 0U) << what;
      const std::string expected = frames_behind(stayed / file.name, std::stol(row_.restart));
      EXPECT_FALSE(expected.empty()) << what;
      EXPECT_TRUE(frames_behind(again / file.name, std::stol(row_.restart)) == expected) << what;
      return;
    }
    const post::Table whole = post::read_table(stayed / file.name),
                      before = post::read_table(left / file.name), rest = post::read_table(again / file.name);
    ASSERT_GT(rest.rows(), 0U) << what;
    ASSERT_GE(whole.rows(), rest.rows()) << what;
    // The row of the restart itself has the forces of the set-up.
    const std::size_t count = rest.rows() > 1 ? rest.rows() - 1 : 1;
    EXPECT_TRUE(count == 1 || left == stayed || whole.rows() > before.rows() + 2)
        << what << ": nothing behind the restart";
    EXPECT_EQ(last_rows(file, rest, count), last_rows(file, whole, count)) << what;
  }

  /// A row whose variables change nothing proves nothing. Results of the first row of the scene are kept.
  void expect_that_its_variables_matter(const Scratch &base) const {
    static std::map<std::string, std::unique_ptr<Scratch>> first_rows;
    static std::map<std::string, int> line_of_first;
    const std::string scene = row_.heading + ": " + row_.files.front().name;
    std::unique_ptr<Scratch> &first = first_rows[scene];
    if (first == nullptr) {
      first = std::make_unique<Scratch>();
      for (const ResultFile &file : row_.files)
        fs::copy_file(base / file.name, *first / file.name);
      line_of_first[scene] = row_.line;
      return;
    }
    double most = 0;
    for (const ResultFile &file : row_.files)
      most = std::fmax(most, difference(file, first->path(), base.path()));
    EXPECT_GT(most, 100 * std::fmax(row_.ranks.value_or(0), row_.engine.value_or(0)))
        << "the variables change nothing against line " << line_of_first[scene];
  }

  Row row_;
  bool on_ranks_;
};

std::string name_of(const std::string &text) {
  std::string name;
  for (const char c : text)
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name == "_" ? "plain" : name;
}

class Unread : public ::testing::Test {
public:
  explicit Unread(std::string why) : why_(std::move(why)) {}
  void TestBody() override { FAIL() << why_; }

private:
  std::string why_;
};

const fs::path table = test_deck("invariances");

/// A test for each row, and one for its ranks.
const bool registered = [] {
  try {
    for (const Row &row : Reader(table).read())
      for (const bool on_ranks : {false, true}) {
        if (on_ranks && !row.ranks) continue;
        const std::string name =
            name_of(row.text) + (on_ranks ? "_Ranks" : "") + (row.by_night ? "_ByNight" : "");
        ::testing::RegisterTest(
            ("Invariances_" + name_of(row.heading.substr(row.heading.find(' ') + 1))).c_str(), name.c_str(),
            nullptr, nullptr, table.c_str(), row.line,
            [row, on_ranks]() -> Invariance * { return new Invariance(row, on_ranks); });
      }
  } catch (const std::exception &error) {
    const std::string why = error.what();
    ::testing::RegisterTest("Invariances", "CanBeRead", nullptr, nullptr, table.c_str(), 1,
                            [why]() -> Unread * { return new Unread(why); });
  }
  return true;
}();

TEST(TableOfInvariances, NamesFileAndLineOfAWrongRow) {
  const Scratch folder;
  const fs::path file = folder / "rows";
  const std::string heading = "# a comment\nscene bounce: balls.txt\n";
  for (const auto &[lines, says] :
       {std::pair<std::string, std::string>{"- | - | - | - | - | -\n", ":1: row is '- | - | - | - | - | -'"},
        {"scene bounce balls.txt\n", ":1: heading is 'scene bounce balls.txt'; allowed: scene NAME: FILES"},
        {"scene bounce: balls.dat\n", ":1: file is 'balls.dat'; allowed: a dump of balls"},
        {heading + "- | 1e-9 | 6000\n", ":3: row is '- | 1e-9 | 6000'; allowed: variables | ranks"},
        {heading + "mu | 1e-9 | - | - | - | -\n", ":3: variable is 'mu'; allowed: NAME VALUE"},
        {heading + "- | close | - | - | - | -\n", ":3: difference is 'close'; allowed: a number > 0"},
        {heading + "- | - | - | yes | - | -\n", ":3: newton is 'yes'; allowed: on, -"},
        {heading + "- | - | - | - | - | mu 1\n", ":3: also is 'mu 1'; allowed: NAME VALUE: DIFFERENCE"}}) {
    write_text(file, lines);
    EXPECT_EQ(error_of([&file = file] { Reader(file).read(); }).rfind(file.string() + says, 0), 0U) << lines;
  }
}

} // namespace
} // namespace drumlin::test
