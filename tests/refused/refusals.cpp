#include "tests/refused/refusals.h"
#include "tests/support/engine_runs.h"

namespace drumlin::test {

namespace fs = std::filesystem;

namespace {

const fs::path folder = fs::path(DRUMLIN_SOURCE_DIR) / "tests/refused";

bool begins_with(const std::string &text, const std::string &word) { return text.rfind(word, 0) == 0; }

/// Reads one table, line by line.
class Reader {
public:
  explicit Reader(const std::string &table)
      : file_(folder / table), lammps_(is_of_lammps(table)), tools_(begins_with(table, "tools/")) {}

  std::vector<Refusal> read() {
    std::ifstream in(file_);
    if (!in) throw std::runtime_error("cannot read " + file_.string());
    for (std::string line; std::getline(in, line); take(line))
      ++line_;
    take("");
    return std::move(rows_);
  }

private:
  [[noreturn]] void fail(const std::string &what) const {
    throw std::runtime_error(fmt::format("{}:{}: {}", file_.string(), line_, what));
  }

  /// One line of the file.
  void take(const std::string &line) {
    static const std::string message = "    | ", more = "    ";
    const std::size_t bar = line.find(" | ");
    if (begins_with(line, message) && !words_.empty()) {
      says_ = line.substr(message.size());
    } else if (begins_with(line, more) && !says_.empty()) {
      says_ += line.substr(more.size() - 1);
    } else if (begins_with(line, more) && words_.empty() && !files_.empty()) {
      files_.back().second += file_text(line.substr(more.size()));
    } else {
      finish();
      if (line.empty() || line[0] == '#') {
        if (!words_.empty()) fail("'" + words_ + "' has no message; allowed: WORDS | MESSAGE");
      } else if (bar != std::string::npos) {
        add_words(line.substr(0, bar));
        says_ = line.substr(bar + 3);
      } else if (line == "command" || begins_with(line, "command ")) {
        command_ = line.substr(std::min<std::size_t>(line.size(), 8));
        beginning_.clear();
        may_begin_ = true;
        return;
      } else if (may_begin_ && begins_with(line, "@ ")) {
        beginning_ = line.substr(2);
      } else if (begins_with(line, "deck ")) {
        deck_ = line.substr(5);
      } else if (tools_ && (begins_with(line, "file ") || begins_with(line, "made "))) {
        take_file(line);
      } else {
        add_words(line);
      }
    }
    may_begin_ = false;
  }

  /// `file NAME TEXT` or `made NAME KIND`.
  void take_file(const std::string &line) {
    const std::size_t name = line.find(' ') + 1, text = line.find(' ', name);
    const std::string called = line.substr(name, text - name);
    auto &all = begins_with(line, "file ") ? files_ : made_;
    all.erase(std::remove_if(all.begin(), all.end(), [&](const auto &old) { return old.first == called; }),
              all.end());
    if (text != std::string::npos) all.emplace_back(called, file_text(line.substr(text + 1)));
  }
  std::string file_text(const std::string &given) const { return whole(replaced(given, "\\n", "\n")); }

  void add_words(const std::string &line) {
    if (tools_ && !words_.empty()) fail("'" + words_ + "' has no message; allowed: WORDS | MESSAGE");
    words_ += (words_.empty() ? "" : "\n") + line;
    if (place_ == 0) place_ = line_;
  }

  /// Makes a row of the words and the message that were read.
  void finish() {
    if (says_.empty()) return;
    row();
    words_.clear();
    says_.clear();
    place_ = 0;
  }

  void row() {
    std::string &line = says_;
    Refusal row;
    row.place = fmt::format("{}:{}", file_.string(), place_);
    row.lammps = lammps_;
    bool bare = false;
    for (; line.back() == '}'; line.erase(line.find_last_not_of(' ') + 1)) {
      const std::size_t at = line.rfind('{');
      const std::string mark = line.substr(at);
      if (mark == "{two ranks}")
        row.on_two_ranks = true;
      else if (mark == "{in the run}")
        row.in_the_run = true;
      else if (mark == "{engine's words}")
        row.in_engine_words = true;
      else if (mark == "{bare}")
        bare = true;
      else if (mark == "{status 1}" && tools_)
        row.status = 1;
      else
        fail("mark is '" + mark +
             "'; allowed: {two ranks}, {in the run}, {engine's words}, {bare}, of tools {status 1}");
      line.erase(at);
    }
    row.says = parts_of(whole(line), " ... ");
    if (tools_) {
      if (begins_with(row.says[0], "... "))
        row.says[0].erase(0, 4), row.says.insert(row.says.begin(), command_);
      else
        row.says[0].insert(0, command_);
      row.files = files_;
      row.made = made_;
    } else if (begins_with(row.says[0], "ERROR: "))
      row.says[0].erase(0, 7);
    else if (!command_.empty())
      row.says.insert(row.says.begin(), command_);
    const std::string words = whole(replaced(words_, "\\n", "\n"));
    if (!deck_.empty()) {
      row.deck = deck_;
      for (std::string rest = words + ", "; !rest.empty(); rest.erase(0, rest.find(", ") + 2)) {
        const std::string given = rest.substr(0, rest.find(", "));
        const std::size_t blank = given.find(' ');
        row.variables.emplace_back(given.substr(0, blank),
                                   blank == std::string::npos ? "" : given.substr(blank + 1));
      }
    } else if (lammps_ || tools_ || !begins_with(words, "pair_style")) {
      row.lines = words;
    } else {
      split(words, bare, row);
    }
    rows_.push_back(row);
  }

  /// Lines of the host deck that begin with a pair style.
  static void split(const std::string &words, bool bare, Refusal &row) {
    static const std::regex of_pair(
        "(pair_style|pair_coeff|property|material) .*|fix \\w+ all property/global .*");
    std::vector<std::string> pair, lines;
    for (const std::string &line : lines_of(words))
      (lines.empty() && std::regex_match(line, of_pair) ? pair : lines).push_back(line);
    const bool coefficients = std::any_of(pair.begin(), pair.end(),
                                          [](const auto &line) { return begins_with(line, "pair_coeff"); });
    std::string given;
    for (const std::string &line : pair) {
      const std::vector<std::string> word = words_of(line);
      if (word[0] == "property")
        given += property(word.at(1), word.at(2));
      else if (word[0] == "material")
        given +=
            fmt::format("fix {0} all property/global {0} peratomtype {1} {1} {1}\n", word.at(1), word.at(2));
      else
        given += line + "\n";
      if (&line == &pair.front() && !coefficients) given += "pair_coeff * *\n";
    }
    row.pair = given + (bare ? "" : host_properties(given));
    for (const std::string &line : lines)
      row.lines += line + "\n";
  }

  std::string whole(const std::string &text) const {
    static const std::string inputs = (fs::path(DRUMLIN_SOURCE_DIR) / "inputs").string();
    const std::string with_beginning =
        beginning_.empty() ? text : replaced(text, "@", replaced(beginning_, "\\n", "\n"));
    return replaced(replaced(with_beginning, "INPUTS", inputs), "LONG", std::string(5000, 'x'));
  }

  fs::path file_;
  bool lammps_, tools_;
  std::vector<std::pair<std::string, std::string>> files_, made_;
  std::string command_, beginning_, deck_;
  bool may_begin_ = false;   // behind a line `command`
  std::string words_, says_; // of a row that goes on
  int line_ = 0, place_ = 0; // the present line, and that in which the row begins
  std::vector<Refusal> rows_;
};

} // namespace

std::vector<std::string> refusal_tables(const std::vector<std::string> &folders) {
  std::vector<std::string> tables;
  for (const std::string &of : folders)
    for (const auto &entry : fs::directory_iterator(folder / of))
      tables.push_back(of + ("/" + entry.path().filename().string()));
  std::sort(tables.begin(), tables.end());
  return tables;
}

std::string name_of_table(const ::testing::TestParamInfo<std::string> &info) {
  std::string name = info.param;
  for (char &letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0) letter = '_';
  return name;
}

::testing::AssertionResult says_so(const Refusal &refusal, const std::string &error) {
  std::size_t behind = 0;
  for (const std::string &words : refusal.says) {
    const std::size_t found = error.find(words, behind);
    if (found == std::string::npos)
      return ::testing::AssertionFailure() << "no '" << words << "' at its place in\n" << error;
    behind = found + words.size();
  }
  return ::testing::AssertionSuccess();
}

/// A row in one line, or in lines of at most 110 letters.
static std::string in_lines(const std::string &words, const std::string &message) {
  constexpr std::size_t longest = 110;
  if (words.size() + 3 + message.size() <= longest) return words + " | " + message + "\n";
  std::string text = words, line = "\n    |";
  for (const std::string &word : words_of(message)) {
    if (line.size() + word.size() > longest) {
      text += line;
      line = "\n   ";
    }
    line += " " + word;
  }
  return text + line + "\n";
}

void rewrite(const Refusal &refusal, const std::string &error) {
  const std::size_t colon = refusal.place.rfind(':');
  const fs::path file = refusal.place.substr(0, colon);
  const int place = std::stoi(refusal.place.substr(colon + 1));
  const std::size_t command = error.find(": ", error.find(": ") + 2); // ERROR: drumlin NAME: MESSAGE
  const std::string message = replaced(
      replaced(error.substr(command + 2), (fs::path(DRUMLIN_SOURCE_DIR) / "inputs").string(), "INPUTS"),
      std::string(5000, 'x'), "LONG");
  std::string text, line;
  std::ifstream in(file);
  bool in_row = false;
  for (int number = 1; std::getline(in, line); ++number) {
    in_row = number == place || (in_row && begins_with(line, "    "));
    if (!in_row)
      text += line + "\n";
    else if (number == place)
      text +=
          in_lines(line.substr(0, line.find(" | ")), message + (refusal.status == 1 ? " {status 1}" : ""));
  }
  std::ofstream(file) << text;
}

bool is_of_lammps(const std::string &table) {
  const std::string end = ".lammps";
  return table.size() > end.size() && table.compare(table.size() - end.size(), end.size(), end) == 0;
}

std::vector<Refusal> read_refusals(const std::string &table) { return Reader(table).read(); }

} // namespace drumlin::test
