#include "experiment/plan.h"

#include "engine/deck_run.h"
#include "engine/engine_command.h"
#include "support/csv_schema.h"
#include "support/files.h"
#include "support/options.h"
#include "support/units.h"
#include "support/usage_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include <unistd.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr int most_seeds = 1000, most_ranks = 1000;
constexpr int quick_balls = 150, quick_seeds = 2;
constexpr std::size_t quick_scenes = 3;
constexpr const char *quick_cycles = "4";
constexpr const char *blanks = " \t\r";
/// What the scale of lengths changes: a plan that leaves one to the deck cannot be scaled.
constexpr std::array roller_variables = {"r2", "r3", "m2", "m3", "k23", "c23", "Fw"};

std::string trimmed(const std::string &text) {
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// A line without its comment, which begins with # at the start of the line or after a blank.
std::string without_comment(const std::string &line) {
  for (std::size_t i = 0; i < line.size(); ++i)
    if (line[i] == '#' && (i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t'))
      return trimmed(line.substr(0, i));
  return trimmed(line);
}

/// Whether a line goes on in the next one, as in decks.
bool is_continued(const std::string &text) {
  return text.size() > 1 && text.back() == '&' &&
         std::string(blanks).find(text[text.size() - 2]) != std::string::npos;
}

std::vector<std::string> words_in(const std::string &text) {
  std::vector<std::string> words;
  std::istringstream in(text);
  for (std::string word; in >> word;)
    words.push_back(word);
  return words;
}

/// The parts of a text between its separators.
std::vector<std::string> parts_of(const std::string &text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);)
    parts.push_back(trimmed(part));
  return parts;
}

bool is_file(const fs::path &path) {
  std::error_code ignored; // of a name that is too long
  return fs::is_regular_file(path, ignored) && ::access(path.c_str(), R_OK) == 0;
}

/// Whether tables would take a name for a value that is not there.
bool is_nan(const std::string &name) {
  const std::optional<double> number = any_number_from_text(name);
  return number && std::isnan(*number);
}

/// Whether a file stays in the folder in which it is looked for.
bool stays_inside(const fs::path &file) {
  return !file.is_absolute() && *file.lexically_normal().begin() != "..";
}

bool is_letter(char letter) { return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_'; }

/// Whether a text has a word, alone or as the value v_WORD of a variable.
bool has_word(const std::string &text, const std::string &word) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t begin = at >= 2 && text.compare(at - 2, 2, "v_") == 0 ? at - 2 : at;
    const std::size_t end = at + word.size();
    if ((begin == 0 || !is_letter(text[begin - 1])) && (end == text.size() || !is_letter(text[end])))
      return true;
  }
  return false;
}

/// The text of a user's deck and of all that it includes; nothing if it includes files from elsewhere.
std::optional<std::string> text_of_deck(const fs::path &deck) {
  std::string text;
  for (const fs::path &file : deck_files(deck))
    text += read_text(file) + "\n";
  std::istringstream words(text);
  for (std::string word, name; words >> word;)
    if ((word == "include" || word == "jump") && words >> name && name != "SELF" &&
        name.find("${here}/") == std::string::npos)
      return std::nullopt;
  return text;
}

bool is_name(const std::string &text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_letter);
}

/// A row of a file of known values.
struct ExpectedRow {
  std::string scene; ///< its name in LIGGGHTS, if it runs in both engines
  Expected expected;
};

const CsvSchema<ExpectedRow> &expected_rows() {
  static const CsvSchema<ExpectedRow> schema(
      {csv_column("scene", &ExpectedRow::scene),
       csv_column("quantity", &ExpectedRow::expected, &Expected::quantity),
       csv_column("value", &ExpectedRow::expected, &Expected::value),
       csv_column("scale", &ExpectedRow::expected, &Expected::scale),
       csv_column("tolerance", &ExpectedRow::expected, &Expected::tolerance),
       csv_column("source", &ExpectedRow::expected, &Expected::source)});
  return schema;
}

/// What a line `over` says: the variables, and for each scene that it makes a value of each of them.
struct Sweep {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> values;
  std::map<std::string, std::pair<std::size_t, double>>
      at; ///< axis -> a variable and the factor to the place
};

/// Leaves out comparisons with scenes that the plan does not have.
void leave_out_comparisons(Plan &plan) {
  const auto lacks = [&plan](const std::string &name) {
    return std::none_of(plan.scenes.begin(), plan.scenes.end(),
                        [&name](const Scene &scene) { return scene.name == name; });
  };
  for (Comparison &one : plan.comparisons)
    one.pairs.erase(std::remove_if(one.pairs.begin(), one.pairs.end(),
                                   [&](const auto &pair) { return lacks(pair.first) || lacks(pair.second); }),
                    one.pairs.end());
  plan.comparisons.erase(std::remove_if(plan.comparisons.begin(), plan.comparisons.end(),
                                        [](const Comparison &one) { return one.pairs.empty(); }),
                         plan.comparisons.end());
}

class PlanReader {
public:
  explicit PlanReader(fs::path file) : file_(std::move(file)) {}

  Plan read() {
    plan_.text = read_text(file_);
    if (const std::string mark = "\xEF\xBB\xBF"; plan_.text.compare(0, mark.size(), mark) == 0)
      plan_.text.erase(0, mark.size()); // that editors of Windows put before UTF-8
    plan_.deck_folder = fs::absolute(file_).parent_path();
    std::istringstream lines(plan_.text);
    int read = 0; // lines
    for (std::string line; std::getline(lines, line);) {
      line_ = ++read;
      std::string text = without_comment(line);
      for (; is_continued(text) && std::getline(lines, line); ++read)
        text = trimmed(text.substr(0, text.size() - 1)) + " " + without_comment(line);
      if (is_continued(text)) refuse("the last line", text, "a line below one that ends with &", read);
      if (text.empty()) continue;
      const std::size_t end = std::min(text.find_first_of(blanks), text.size());
      keyword_ = text.substr(0, end);
      value_ = trimmed(text.substr(end));
      take();
    }
    end_scene();
    keyword_.clear();
    require(!plan_.title.empty(), "title", "a line of it");
    require(!plan_.quantities.empty(), "quantity", "a line for each");
    require(!plan_.scenes.empty(), "scene", "a line for each, with its settings below");
    make_sweeps();
    for (const fs::path &file : expected_files_)
      take_expected(file);
    for (const Bounds &bounds : bounds_)
      take_bounds(bounds);
    make_twins();
    for (const Explicit &one : compared_)
      add_comparison(one);
    leave_out_engines();
    if (scaled_to_ == 0) return std::move(plan_);
    if (!plan_.can_be_scaled())
      refuse("scaled_to", std::to_string(scaled_to_), what_can_be_scaled, scaled_line_);
    std::string text = plan_.text;
    Plan scaled = plan_.with_balls(scaled_to_);
    scaled.text = std::move(text);
    return scaled;
  }

private:
  /// A comparison that a line of its own asks for, and the line.
  struct Explicit {
    int line;
    std::string scene, base, words;
  };
  /// What a line at_most says of the table that `table` counts in the plan.
  struct Bounds {
    double factor;
    std::string name; ///< of the file in the plan
    fs::path file;
    std::size_t table;
    std::set<std::string> quantities; ///< which it is about
  };
  struct Keyword {
    void (PlanReader::*take)();
    bool once;  ///< in a scene, or before the first one
    bool first; ///< of the whole plan: before the first scene
  };

  static const std::map<std::string, Keyword> &keywords() {
    using R = PlanReader;
    static const std::map<std::string, Keyword> all = {
        {"title", {&R::take_title, true, true}},
        {"about", {&R::take_about, false, true}},
        {"note", {&R::take_note, false, true}},
        {"quantity", {&R::take_quantity, false, true}},
        {"axis", {&R::take_axis, false, true}},
        {"log_axis", {&R::take_axis, false, true}},
        {"scene", {&R::take_scene, false, false}},
        {"from", {&R::take_from, true, false}},
        {"differs", {&R::take_differs, true, false}},
        {"paired", {&R::take_paired, true, false}},
        {"compare", {&R::take_compare, false, false}},
        {"deck", {&R::take_deck, true, false}},
        {"deck_folder", {&R::take_deck_folder, true, true}},
        {"seeds", {&R::take_seeds, true, false}},
        {"rounds", {&R::take_rounds, true, false}},
        {"ranks", {&R::take_ranks, true, false}},
        {"made", {&R::take_made, false, false}},
        {"seed_variable", {&R::take_seed_variable, true, false}},
        {"set", {&R::take_set, false, false}},
        {"set_settle", {&R::take_set, false, false}},
        {"set_placed", {&R::take_set, false, false}},
        {"set_run", {&R::take_set, false, false}},
        {"stiffness", {&R::take_stiffness, true, false}},
        {"frequency", {&R::take_frequency, true, false}},
        {"more_steps", {&R::take_more_steps, true, false}},
        {"balls", {&R::take_balls, true, false}},
        {"width", {&R::take_width, true, false}},
        {"depth", {&R::take_depth, true, false}},
        {"height", {&R::take_height, true, false}},
        {"radius_min", {&R::take_radius_min, true, false}},
        {"radius_max", {&R::take_radius_max, true, false}},
        {"grading", {&R::take_grading, true, false}},
        {"layer", {&R::take_layer, false, false}},
        {"spot", {&R::take_spot, false, false}},
        {"ratio", {&R::take_ratio, true, false}},
        {"at", {&R::take_at, false, false}},
        {"series", {&R::take_series, true, false}},
        {"over", {&R::take_over, true, false}},
        {"expect", {&R::take_expect, false, false}},
        {"published", {&R::take_published, true, true}},
        {"table", {&R::take_table, false, true}},
        {"at_most", {&R::take_at_most, false, true}},
        {"order", {&R::take_order, false, true}},
        {"also_in_lammps", {&R::take_also_in_lammps, true, true}},
        {"scaled_to", {&R::take_scaled_to, false, true}}};
    return all;
  }

  [[noreturn]] void refuse(const std::string &keyword, const std::string &value, const std::string &allowed,
                           int line) const {
    throw UsageError(fmt::format("{}{}: {}", file_.string(), line > 0 ? fmt::format(", line {}", line) : "",
                                 refusal(keyword, value, allowed)));
  }
  [[noreturn]] void refuse(const std::string &allowed) const { refuse(keyword_, value_, allowed, line_); }
  void require(bool there, const char *keyword, const char *allowed) const {
    if (!there) refuse(keyword, "", allowed, 0);
  }

  void take() {
    const auto found = keywords().find(keyword_);
    if (found == keywords().end()) {
      std::vector<std::string> names;
      for (const auto &[name, keyword] : keywords())
        names.push_back(name);
      refuse("the keyword", keyword_, fmt::format("{}", fmt::join(names, ", ")), line_);
    }
    if (value_.empty()) refuse("a value after it");
    if (found->second.first && in_scene_) refuse("before the first scene");
    if (found->second.once && !seen_.insert(keyword_).second)
      refuse(in_scene_ ? "once in a scene" : "once before the first scene");
    (this->*found->second.take)();
  }

  double number(const Range &range) const {
    try {
      return number_option(keyword_.c_str(), value_, range);
    } catch (const UsageError &) {
      refuse(range.words());
    }
  }
  int count(int least, int most) const {
    try {
      return count_option(keyword_.c_str(), value_, least, most);
    } catch (const UsageError &) {
      refuse(fmt::format("a whole number from {} to {}", least, most));
    }
  }
  void only_in_scene() const {
    if (!in_scene_) refuse("below the line of a scene");
  }

  // Of the whole plan.
  void take_title() { plan_.title = value_; }
  void take_about() { plan_.about.push_back(value_); }
  void take_note() { plan_.notes.push_back(value_); }

  void take_quantity() {
    const std::vector<std::string> words = words_in(value_);
    constexpr std::size_t own = 5;
    Quantity quantity;
    if (words.size() == 1) {
      const Quantity *known = named_quantity(words[0]);
      if (known == nullptr) {
        std::vector<std::string> names;
        for (const Quantity &one : named_quantities())
          names.push_back(one.name);
        refuse(fmt::format("{}, or NAME UNIT WAY FILE COLUMN", fmt::join(names, ", ")));
      }
      quantity = *known;
    } else if (words.size() >= own) {
      if (!is_name(words[0])) refuse("NAME UNIT WAY FILE COLUMN, NAME of letters, digits and _");
      if (is_nan(words[0]) || is_nan(words[1]))
        refuse("NAME UNIT WAY FILE COLUMN, NAME and UNIT not nan, which means no value");
      if (!stays_inside(words[3]))
        refuse("NAME UNIT WAY FILE COLUMN, FILE in the folder of the run, in which decks start");
      const std::vector<const char *> ways = column_ways();
      if (std::find(ways.begin(), ways.end(), words[2]) == ways.end())
        refuse(fmt::format("NAME UNIT WAY FILE COLUMN, WAY one of {}", fmt::join(ways, ", ")));
      const std::vector<std::string> column(words.begin() + own - 1, words.end()); // may have a unit
      const std::string name = fmt::format("{}", fmt::join(column, " ")), known = column_unit(words[3], name);
      const bool per_metre = (known == "N" || known == "J") && words[1] == known + "/m"; // beds in the plane
      if (!known.empty() && words[1] != known && !per_metre)
        refuse(fmt::format("NAME UNIT WAY FILE COLUMN, UNIT {}, that of the column", known));
      quantity = column_quantity(words[0], words[1], words[2], words[3], name);
    } else {
      refuse("the name of a bed's quantity, or NAME UNIT WAY FILE COLUMN");
    }
    for (const Quantity &one : plan_.quantities)
      if (one.name == quantity.name) refuse("each quantity once");
    plan_.quantities.push_back(quantity);
  }

  void take_axis() {
    const std::size_t end = value_.find_first_of(blanks);
    if (end == std::string::npos || !is_name(value_.substr(0, end)))
      refuse("NAME LABEL, NAME of letters, digits and _, LABEL with unit");
    const std::string name = value_.substr(0, end);
    for (const Axis &axis : plan_.axes)
      if (axis.name == name) refuse("each axis once");
    plan_.axes.push_back({name, trimmed(value_.substr(end)), keyword_ == "log_axis"});
  }

  /// The first one counts, which is that of Plan::with_balls().
  void take_scaled_to() {
    const int balls = count(1, PackingOptions::most_balls);
    if (scaled_to_ == 0) scaled_to_ = balls;
    scaled_line_ = line_;
  }

  // Scenes.
  Scene &scene() { return in_scene_ ? plan_.scenes.back() : common_; }

  void take_scene() {
    end_scene();
    if (value_.find_first_of(",|") != std::string::npos) refuse("a name without commas and |");
    if (is_nan(value_)) refuse("a name that does not mean no value");
    for (const Scene &one : plan_.scenes)
      if (one.name == value_) refuse("each name once");
    plan_.scenes.push_back(common_);
    plan_.scenes.back().name = plan_.scenes.back().family = value_;
    sweeps_.emplace_back();
    in_scene_ = true;
    scene_line_ = line_;
    paired_of_scene_ = paired_;
  }

  void take_from() {
    only_in_scene();
    if (seen_.size() > 1 || settings_ > 0) refuse("the first line of a scene");
    const auto base = std::find_if(plan_.scenes.begin(), plan_.scenes.end() - 1,
                                   [this](const Scene &one) { return one.name == value_; });
    if (base == plan_.scenes.end() - 1) refuse("the name of a scene above");
    const std::string name = plan_.scenes.back().name;
    plan_.scenes.back() = *base;
    plan_.scenes.back().name = plan_.scenes.back().family = name;
    sweeps_.back() = sweeps_[static_cast<std::size_t>(base - plan_.scenes.begin())];
    base_ = value_;
  }

  void take_differs() {
    only_in_scene();
    if (base_.empty()) refuse("below a line from");
    differs_ = value_;
  }

  void take_paired() {
    if (value_ != "yes" && value_ != "no") refuse("yes, no");
    (in_scene_ ? paired_of_scene_ : paired_) = value_ == "yes";
  }

  void take_compare() {
    const std::vector<std::string> parts = parts_of(value_, '|');
    if (parts.size() != 3 || parts[0].empty() || parts[1].empty() || parts[2].empty())
      refuse("SCENE | SCENE | what differs, in words");
    compared_.push_back({line_, parts[0], parts[1], parts[2]});
  }

  /// A file beside the plan, by its whole path; or one of inputs, by its name there.
  std::string found_file(const char *what) const {
    const fs::path beside = plan_.deck_folder / value_;
    if (is_file(beside)) return beside.lexically_normal().string();
    if (is_file(input_file(value_))) return value_;
    refuse(fmt::format("{} in {}, or in {}", what,
                       plan_.names_deck_folder ? plan_.deck_folder.string() : "the folder of the plan",
                       input_file("").string()));
  }

  void take_deck() { scene().deck = found_file("a deck"); }

  void take_deck_folder() {
    if (seen_.count("deck") > 0) refuse("above the line deck");
    plan_.deck_folder = fs::absolute(file_.parent_path() / value_);
    plan_.names_deck_folder = true;
  }

  void take_seeds() {
    scene().seeds = count(1, most_seeds);
    scene().rounds = false;
  }
  void take_rounds() {
    scene().seeds = count(1, most_seeds);
    scene().rounds = true;
  }
  void take_ranks() { scene().ranks = count(1, most_ranks); }

  void take_made() {
    constexpr const char *allowed =
        "VARIABLE DECK OUTPUT NAME=VALUE ..., VARIABLE of the scene's deck, OUTPUT "
        "and NAME of DECK, which makes the file";
    const std::vector<std::string> words = words_in(value_);
    if (words.size() < 3 || !is_name(words[0]) || !is_name(words[2])) refuse(allowed);
    if (seen_.insert(keyword_).second) scene().made.clear(); // those of the scene above
    MadeFile made{words[0], {}, words[2], {}};
    for (std::size_t n = 3; n < words.size(); ++n) {
      const std::size_t equal = words[n].find('=');
      if (equal == std::string::npos || !is_name(words[n].substr(0, equal))) refuse(allowed);
      made.settings.emplace_back(words[n].substr(0, equal), words[n].substr(equal + 1));
    }
    value_ = words[1];
    made.deck = found_file("a deck");
    scene().made.push_back(made);
  }

  void take_seed_variable() {
    if (!is_name(value_)) refuse("the name of a variable of the deck");
    scene().seed_variable = value_;
  }

  void take_set() {
    static const std::map<std::string, Scope> scopes = {{"set", Scope::all},
                                                        {"set_settle", Scope::settle},
                                                        {"set_placed", Scope::placed},
                                                        {"set_run", Scope::run}};
    const std::size_t end = std::min(value_.find_first_of(blanks), value_.size());
    const std::string name = value_.substr(0, end);
    std::string value = trimmed(value_.substr(end));
    const bool is_quoted = value.size() > 2 && value.front() == '"' && value.back() == '"';
    if (is_quoted) value = value.substr(1, value.size() - 2);
    if (!is_name(name) || value.empty() || (!is_quoted && value.find_first_of(blanks) != std::string::npos))
      refuse("NAME VALUE, or NAME \"WORDS\": a variable of the deck");
    ++settings_;
    if (!seen_.insert(keyword_ + " " + name).second) refuse("each variable once");
    const Scope scope = scopes.at(keyword_);
    for (Setting &setting : scene().settings)
      if (setting.scope == scope && setting.name == name) {
        setting.value = value;
        return;
      }
    scene().settings.push_back({scope, name, value});
  }

  static constexpr Range above_zero = {1e-12, 1e18, ""};
  void take_stiffness() { scene().stiffness = number({1e-6, 1e15, "N/m"}); }
  void take_frequency() { scene().frequency = number({1e-6, 1e6, "Hz"}); }
  void take_more_steps() { scene().more_steps = number({1e-3, 1e3}); }

  // Beds.
  SoilBed &bed() {
    if (!scene().bed) scene().bed.emplace();
    return *scene().bed;
  }
  void take_balls() { bed().packing.balls = count(1, PackingOptions::most_balls); }
  void take_width() { bed().packing.width = number(PackingOptions::length_range); }
  void take_depth() { bed().packing.depth = number(PackingOptions::length_range); }
  void take_height() { bed().packing.height = number(PackingOptions::length_range); }
  void take_radius_min() { bed().packing.radius_min = number(PackingOptions::radius_range); }
  void take_radius_max() { bed().packing.radius_max = number(PackingOptions::radius_range); }
  void take_grading() {
    if (value_ != "uniform" && value_ != "mass") refuse("uniform, mass");
    bed().packing.grading = grading_from_name(value_);
  }
  void take_layer() {
    if (seen_.insert(keyword_).second) bed().layers.clear(); // those of the scene above
    const std::vector<std::string> words = words_in(value_);
    const std::optional<double> thickness = any_number_from_text(words[0]);
    const bool has_density = words.size() == 3 && words[1] == "relative_density";
    const double density = has_density ? any_number_from_text(words[2]).value_or(NAN) : 0.0;
    const std::optional<SieveCurve> sizes =
        words.size() == 2 ? curve_between(words[1]) : std::optional<SieveCurve>();
    if (!thickness || !PackingOptions::length_range.holds(*thickness) ||
        (words.size() > 1 && !sizes && !has_density) || !(density >= 0.0))
      refuse(PackingOptions::length_range.words() +
             ", and behind it nothing, the smallest and the largest size, in mm, as 32-48, or "
             "relative_density and a number >= 0");
    BedLayer layer{{}, *thickness};
    layer.packing.sieve = sizes;
    if (sizes) layer.packing.sieve_name = words[1];
    if (has_density)
      layer.pouring =
          Pouring{density, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}; // check_bed() looks up how to pour it
    bed().layers.push_back(layer);
  }
  void take_spot() {
    if (seen_.insert(keyword_).second) bed().spots.clear(); // those of the scene above
    const std::vector<std::string> words = words_in(value_);
    const auto number = [&](std::size_t n) { return any_number_from_text(words[n]).value_or(NAN); };
    const double least = bed().spots.empty() ? -PackingOptions::length_range.most : bed().spots.back().to;
    if (words.size() != 2 || !(number(0) >= least) || !(number(1) > number(0)))
      refuse("FROM TO, m from the middle of the box, in the order of the way");
    bed().spots.push_back({number(0), number(1)});
  }
  void take_ratio() { bed().ratio = number_text(number(above_zero)); }

  // What the page draws.
  void take_at() {
    const std::vector<std::string> words = words_in(value_);
    const auto axis = std::find_if(plan_.axes.begin(), plan_.axes.end(),
                                   [&](const Axis &one) { return !words.empty() && one.name == words[0]; });
    double place = words.size() == 2 ? any_number_from_text(words[1]).value_or(NAN) : NAN;
    if (axis != plan_.axes.end() && words.size() == 2 && std::isnan(place))
      place = place_in_sweep(words[0], words[1]);
    if (axis == plan_.axes.end() || !(std::abs(place) <= above_zero.most))
      refuse("AXIS NUMBER, an axis that a line `axis` names; or, below a line over, AXIS NAME or "
             "AXIS NAME*NUMBER of its variables");
    if (!seen_.insert(keyword_ + " " + words[0]).second) refuse("each axis once");
    scene().at[words[0]] = place;
  }

  /// The place of the first scene that a line `over` makes, and the rule for the others; NaN if the text is
  /// not NAME or NAME*NUMBER of its variables.
  double place_in_sweep(const std::string &axis, const std::string &text) {
    if (!in_scene_) return NAN;
    Sweep &over = sweeps_.back();
    const std::size_t times = text.find('*');
    const auto name = std::find(over.names.begin(), over.names.end(), text.substr(0, times));
    const double factor =
        times == std::string::npos ? 1.0 : any_number_from_text(text.substr(times + 1)).value_or(NAN);
    if (name == over.names.end()) return NAN;
    over.at[axis] = {static_cast<std::size_t>(name - over.names.begin()), factor};
    double sum = 0.0; // of all places: NaN if one of them is no number
    for (std::size_t n = 0; n < over.values.size(); ++n)
      sum += place_of(over, axis, n);
    return std::isfinite(sum) ? place_of(over, axis, 0) : NAN;
  }
  static double place_of(const Sweep &over, const std::string &axis, std::size_t n) {
    const auto &[variable, factor] = over.at.at(axis);
    return factor * any_number_from_text(over.values[n][variable]).value_or(NAN);
  }

  void take_over() {
    only_in_scene();
    const char *const allowed = "NAME VALUE VALUE ..., or NAME,NAME VALUE,VALUE ...: variables of the deck";
    std::vector<std::string> words = words_in(value_);
    Sweep &over = sweeps_.back() = {parts_of(words.front(), ','), {}, {}};
    for (std::size_t n = 1; n < words.size(); ++n) {
      over.values.push_back(parts_of(words[n], ','));
      if (over.values.back().size() != over.names.size()) refuse(allowed);
    }
    if (over.values.empty() || !std::all_of(over.names.begin(), over.names.end(), is_name)) refuse(allowed);
    if (std::set<std::string>(words.begin() + 1, words.end()).size() != over.values.size())
      refuse("each value once");
    for (std::size_t i = 0; i < over.names.size(); ++i) {
      if (!seen_.insert("set " + over.names[i]).second) refuse("each variable once");
      set(scene(), over.names[i], over.values.front()[i]);
    }
    ++settings_;
  }

  // Known values.
  void take_expect() {
    const std::vector<std::string> words = words_in(value_);
    constexpr std::size_t own = 4;
    if (words.size() == 1) {
      if (in_scene_) refuse("QUANTITY VALUE TOLERANCE SOURCE; a file before the first scene");
      expected_files_.push_back(take_file());
      return;
    }
    only_in_scene();
    const std::optional<double> value = words.size() < own ? std::nullopt : any_number_from_text(words[1]),
                                tolerance = value ? any_number_from_text(words[2]) : std::nullopt;
    if (!tolerance || !std::isfinite(*value) || !(*tolerance >= 0.0))
      refuse("QUANTITY VALUE TOLERANCE SOURCE, or the file of such values before the first scene");
    if (!has_quantity(words[0])) refuse("QUANTITY VALUE TOLERANCE SOURCE, a quantity of the plan");
    if (seen_.insert(keyword_).second) scene().expected.clear();  // those of the scene above
    const std::vector<std::string> parts = parts_of(value_, '|'); // with a scene that is the scale
    const std::vector<std::string> source = words_in(parts.front());
    scene().expected.push_back({words[0], *value, 1.0, *tolerance,
                                fmt::format("{}", fmt::join(source.begin() + 3, source.end(), " ")),
                                parts.size() > 1 ? parts[1] : std::string()});
  }
  bool has_quantity(const std::string &name) const {
    return std::any_of(plan_.quantities.begin(), plan_.quantities.end(),
                       [&name](const Quantity &one) { return one.name == name; });
  }

  /// A file of the plan, by its whole path.
  fs::path take_file() {
    plan_.files.emplace_back(found_file("a file"));
    return plan_.files.back().is_absolute() ? plan_.files.back() : fs::path(input_file(value_));
  }

  void take_published() {
    static const CsvSchema<PublishedPoint> points(
        {csv_column("axis", &PublishedPoint::axis), csv_column("series", &PublishedPoint::series),
         csv_column("source", &PublishedPoint::source), csv_column("quantity", &PublishedPoint::quantity),
         csv_column("at", &PublishedPoint::at), csv_column("value", &PublishedPoint::value)});
    plan_.published = points.rows(read_table(take_file()));
  }

  void take_table() {
    constexpr const char *allowed = "NAME.csv COLUMN COLUMN ..., COLUMN a quantity above, an axis above or a "
                                    "variable of the deck, or HEADER=COLUMN";
    const std::vector<std::string> words = words_in(value_);
    const fs::path file = words.front();
    if (words.size() < 2 || file.has_parent_path() || file.extension() != ".csv" ||
        !is_name(file.stem().string()) || file == results_name)
      refuse(allowed);
    PlanTable table{words.front(), {}};
    for (std::size_t n = 1; n < words.size(); ++n) {
      const std::size_t equal = words[n].find('=');
      const std::string name = equal == std::string::npos ? words[n] : words[n].substr(equal + 1);
      if (!is_name(name)) refuse(allowed);
      table.columns.push_back({words[n].substr(0, equal), name, has_quantity(name)});
    }
    for (const PlanTable &one : plan_.tables)
      if (one.file == table.file) refuse("each table once");
    plan_.tables.push_back(table);
  }

  void take_at_most() {
    const std::vector<std::string> words = words_in(value_);
    const double factor = any_number_from_text(words.front()).value_or(NAN);
    const std::set<std::string> quantities(words.size() > 2 ? words.begin() + 2 : words.end(), words.end());
    if (quantities.empty() ||
        !std::all_of(quantities.begin(), quantities.end(),
                     [this](const std::string &name) { return has_quantity(name); }) ||
        !(factor > 0.0) || !std::isfinite(factor))
      refuse("X FILE QUANTITY ..., a factor, an earlier table, and quantities of the plan");
    value_ = words[1];
    const fs::path file = take_file();
    const auto table = std::find_if(plan_.tables.begin(), plan_.tables.end(),
                                    [&](const PlanTable &one) { return one.file == file.filename(); });
    if (table == plan_.tables.end()) refuse("a file with the name of a table above");
    bounds_.push_back(
        {factor, value_, file, static_cast<std::size_t>(table - plan_.tables.begin()), quantities});
  }

  void take_order() {
    if (!has_quantity(value_)) refuse("a quantity of the plan");
    plan_.errors.push_back(value_);
  }

  void take_also_in_lammps() { plan_.between_engines = number({0.0, 1.0, ""}); }
  void take_series() { scene().series = value_; }

  /// Checks what the lines of a scene, or those before the first one, say together.
  void end_scene() {
    const std::string differs = std::exchange(differs_, {}), base = std::exchange(base_, {});
    const bool is_placed = seen_.count("series") > 0 ||
                           std::any_of(seen_.begin(), seen_.end(),
                                       [](const std::string &seen) { return seen.rfind("at ", 0) == 0; });
    seen_.clear();
    settings_ = 0;
    if (!in_scene_) return;
    Scene &done = plan_.scenes.back();
    // Where the scene above is, it would be taken for another seed of that one.
    if (!base.empty() && !is_placed) done.at.clear();
    const auto refuse_scene = [&](const std::string &allowed) {
      refuse("scene", done.name, allowed, scene_line_);
    };
    if (done.deck.empty()) refuse_scene("with a line deck, here or before the first scene");
    for (const Setting &setting : done.settings) {
      const bool of_bed = done.bed && reserved_.count(setting.name) > 0;
      if (setting.name == "out" || of_bed || setting.name == done.seed_variable)
        refuse_scene(fmt::format("without set {}, which the study gives", setting.name));
      if (!done.bed && (setting.scope == Scope::settle || setting.scope == Scope::placed))
        refuse_scene("set_settle and set_placed on a bed: with balls or layer");
    }
    check_names(done, refuse_scene);
    if (done.stiffness == 0.0 && (done.frequency > 0.0 || done.more_steps != 1.0))
      refuse_scene("frequency and more_steps with stiffness, from which the steps per cycle follow");
    if (done.bed)
      check_bed(done, refuse_scene);
    else if (done.stiffness > 0.0)
      refuse_scene("stiffness on a bed: with balls or layer");
    else if (done.seed_variable.empty() && done.seeds > 1 && !done.rounds)
      refuse_scene("one seed, rounds, or seed_variable, the name of the deck's variable that gets it");
    if (done.rounds && (done.bed || !done.seed_variable.empty()))
      refuse_scene("rounds without a bed and without seed_variable");
    if (!differs.empty()) plan_.comparisons.push_back({differs, {{done.name, base}}, paired_of_scene_});
  }

  /// Checks that a user's deck has the variables that it is given: engines ignore others, and two scenes
  /// would be the same. Decks of the project, and those of beds, refuse them by themselves.
  template <class Refuse>
  void check_names(const Scene &scene, const Refuse &refuse) {
    if (scene.bed || !fs::path(scene.deck).is_absolute()) return;
    if (texts_.count(scene.deck) == 0) texts_[scene.deck] = text_of_deck(scene.deck);
    const std::optional<std::string> &text = texts_.at(scene.deck);
    if (!text) return;
    const std::string deck = fs::path(scene.deck).filename().string();
    for (const Setting &setting : scene.settings)
      if (!has_word(*text, setting.name))
        refuse(fmt::format("without set {}, a variable that deck {} does not have", setting.name, deck));
    if (!scene.seed_variable.empty() && !has_word(*text, scene.seed_variable))
      refuse(fmt::format("without seed_variable {}, which deck {} does not have", scene.seed_variable, deck));
  }

  /// Checks a bed, and makes its layers.
  template <class Refuse>
  static void check_bed(Scene &scene, const Refuse &refuse) {
    for (const SceneDeck deck : {SceneDeck::settle, SceneDeck::place})
      if (!is_file(input_file(deck_of(scene, deck))))
        refuse("beds of decks beside which there are in.settle and in.place");
    if (!scene.seed_variable.empty()) refuse("without seed_variable: the seed of a bed is that of its balls");
    if (const std::string wrong = scene.bed->packing.invalid(); !wrong.empty())
      refuse("a bed of which " + wrong);
    if (scene.bed->packing.depth > 0.0 && (scene.stiffness > 0.0 || !scene.bed->layers.empty()))
      refuse("stiffness and layer on a bed in the plane: without depth");
    for (BedLayer &layer : scene.bed->layers) {
      const PackingOptions own = std::exchange(layer.packing, scene.bed->packing);
      layer.packing.sieve = own.sieve;
      layer.packing.sieve_name = own.sieve_name;
      if (const std::string wrong = layer.invalid(); !wrong.empty()) refuse("a bed of which " + wrong);
      if (layer.pouring.has_value() != scene.bed->layers.front().pouring.has_value())
        refuse("relative_density of all layers, or of none");
      if (layer.pouring) {
        const MeasuredPackings packings = packings_of_gravel(layer.packing.dimensions());
        if (!other_balls(packings, layer.packing).empty())
          refuse("relative_density of layers without sizes of their own, whose radii have the ratio of case "
                 "gravel");
        if (layer.pouring->relative_density > packings.most())
          refuse(fmt::format("relative densities of at most {:.3f}, of the packing without friction",
                             packings.most()));
        layer.pouring = packings.pouring(layer.pouring->relative_density);
      }
      layer.packing.balls = balls_of(layer);
    }
    for (const Spot &spot : scene.bed->spots)
      if (scene.bed->layers.empty() || spot.from < -0.5 * scene.bed->packing.width ||
          spot.to > 0.5 * scene.bed->packing.width ||
          spot.to - spot.from < 2.0 * scene.bed->layers.front().packing.largest_radius())
        refuse("a spot in the width of a bed of layers, as long as the largest ball of the lowest one");
  }

  static void set(Scene &scene, const std::string &name, const std::string &value) {
    for (Setting &setting : scene.settings)
      if (setting.scope == Scope::all && setting.name == name) {
        setting.value = value;
        return;
      }
    scene.settings.push_back({Scope::all, name, value});
  }

  /// Puts in place of a scene with a line `over` those that the line makes.
  void make_sweeps() {
    std::vector<Scene> all;
    for (std::size_t i = 0; i < sweeps_.size(); ++i) {
      const Scene &scene = plan_.scenes[i];
      const Sweep &over = sweeps_[i];
      if (over.names.empty()) all.push_back(scene);
      for (std::size_t n = 0; n < over.values.size(); ++n) {
        Scene one = scene;
        const std::string suffix = fmt::format(": {} {}", over.names.front(), over.values[n].front());
        one.name += suffix;
        for (Expected &expected : one.expected)
          if (!expected.scale_of.empty()) expected.scale_of += suffix;
        for (std::size_t v = 0; v < over.names.size(); ++v)
          set(one, over.names[v], over.values[n][v]);
        for (const auto &[axis, rule] : over.at)
          one.at[axis] = place_of(over, axis, n);
        all.push_back(one);
      }
    }
    plan_.scenes = std::move(all);
    for (const Comparison &one : plan_.comparisons)
      for (const auto &[scene, base] : one.pairs)
        for (const std::string &name : {scene, base})
          if (!has_scene(name)) refuse("scene", name, "without over, since it is compared", 0);
    for (const Scene &scene : plan_.scenes)
      for (const Expected &expected : scene.expected)
        if (!expected.scale_of.empty() && !has_scene(expected.scale_of))
          refuse("expect", expected.scale_of, "behind | a scene, which has the same line over as this one",
                 0);
  }
  bool has_scene(const std::string &name) const {
    return std::any_of(plan_.scenes.begin(), plan_.scenes.end(),
                       [&name](const Scene &scene) { return scene.name == name; });
  }

  /// Gives the scenes the known values of a file.
  void take_expected(const fs::path &file) {
    const Table table = read_table(file);
    const std::vector<ExpectedRow> rows = expected_rows().rows(table);
    for (std::size_t n = 0; n < rows.size(); ++n) {
      const auto &[name, expected] = rows[n];
      const auto scene = std::find_if(plan_.scenes.begin(), plan_.scenes.end(),
                                      [&name = name](const Scene &one) { return one.name == name; });
      if (scene == plan_.scenes.end()) csv_refusal(file, table.line(n), "scene", name, "a scene of the plan");
      if (!has_quantity(expected.quantity))
        csv_refusal(file, table.line(n), "quantity", expected.quantity, "a quantity of the plan");
      if (!(std::isfinite(expected.value) && expected.scale > 0.0 && expected.tolerance >= 0.0))
        csv_refusal(file, table.line(n), "value", number_text(expected.value),
                    "a number, with a scale above zero and a tolerance");
      scene->expected.push_back(expected);
    }
  }

  /// Cells of which equal numbers are equal texts.
  static std::vector<std::string> with_all_digits(std::vector<std::string> cells) {
    for (std::string &cell : cells)
      if (const std::optional<double> number = any_number_from_text(cell)) cell = number_text(*number);
    return cells;
  }

  /// Line `at_most`: an error of a scene is at most a factor times that of the same scene in an earlier
  /// table.
  void take_bounds(const Bounds &bounds) {
    const PlanTable &table = plan_.tables[bounds.table];
    std::map<std::vector<std::string>, Scene *> scenes;
    for (Scene &scene : plan_.scenes)
      if (const std::vector<std::string> key = Plan::key_in(table, scene); !key.empty())
        scenes[with_all_digits(key)] = &scene;
    const Table known = read_table(bounds.file);
    for (std::size_t row = 0; row < known.rows(); ++row) {
      std::vector<std::string> key;
      for (const PlanTable::Column &column : table.columns)
        if (!column.is_quantity) key.push_back(known.text(column.header)[row]);
      const auto scene = scenes.find(with_all_digits(key));
      if (scene == scenes.end())
        csv_refusal(bounds.file, known.line(row), table.columns.front().header, key.front(),
                    "a row of a scene of the plan");
      for (const PlanTable::Column &column : table.columns) {
        const std::string cell =
            bounds.quantities.count(column.name) > 0 ? known.text(column.header)[row] : std::string();
        if (cell.empty()) continue;
        const double value = csv_number(bounds.file, known.line(row), column.header, cell);
        constexpr double least = std::numeric_limits<double>::min(); // a scale of 0 would divide by it
        scene->second->expected.push_back(
            {column.name, 0.0, std::max(std::fabs(value), least), bounds.factor, "of " + bounds.name});
      }
    }
  }

  /// Puts behind each scene the same in LAMMPS.
  void make_twins() {
    if (plan_.between_engines == 0.0 || !engine_fault(Engine::lammps).empty()) return;
    std::vector<Scene> all;
    for (const Scene &scene : plan_.scenes) {
      all.push_back(scene);
      Scene twin = scene;
      twin.name += " in LAMMPS";
      twin.twin = scene.name;
      twin.deck += ".lammps";
      if (!is_file(twin.deck) && !is_file(input_file(twin.deck)))
        refuse("also_in_lammps", fmt::format("{:g}", plan_.between_engines),
               fmt::format("with a deck {}", fs::path(twin.deck).filename().string()), 0);
      twin.at.clear(); // where its twin is, it would be taken for another seed of that one
      all.push_back(twin);
    }
    plan_.scenes = std::move(all);
  }

  /// Leaves out scenes whose engine, LIGGGHTS or LAMMPS, is not set up. If none is left the plan stays whole,
  /// and the study says what is missing.
  void leave_out_engines() {
    const auto fault_of = [](const Scene &scene) { return engine_fault(engine_of(scene.deck)); };
    const auto left = std::stable_partition(plan_.scenes.begin(), plan_.scenes.end(),
                                            [&](const Scene &scene) { return fault_of(scene).empty(); });
    if (left == plan_.scenes.end() || left == plan_.scenes.begin()) return;
    plan_.left_out =
        fmt::format("{} of {} scenes: {}", plan_.scenes.end() - left, plan_.scenes.size(), fault_of(*left));
    plan_.scenes.erase(left, plan_.scenes.end());
    leave_out_comparisons(plan_);
  }

  void add_comparison(const Explicit &one) {
    for (const std::string &name : {one.scene, one.base})
      if (!has_scene(name)) refuse("compare", name, "the name of a scene", one.line);
    for (Comparison &known : plan_.comparisons)
      if (known.words == one.words && known.paired == paired_) {
        known.pairs.emplace_back(one.scene, one.base);
        return;
      }
    plan_.comparisons.push_back({one.words, {{one.scene, one.base}}, paired_});
  }

  /// Variables of a bed's decks that name its files, or that a line of its own gives.
  const std::set<std::string> reserved_ = {"balls", "bed", "start", "ratio"};
  fs::path file_;
  Plan plan_;
  std::map<std::string, std::optional<std::string>> texts_; ///< of users' decks
  int line_ = 0;
  std::string keyword_, value_;
  Scene common_;              ///< what is before the first scene
  std::vector<Sweep> sweeps_; ///< of each scene
  std::vector<fs::path> expected_files_;
  std::vector<Bounds> bounds_;
  bool in_scene_ = false;
  bool paired_ = true, paired_of_scene_ = true;
  int scene_line_ = 0;
  std::string base_, differs_; ///< of the scene that is read
  std::set<std::string> seen_; ///< keywords of that scene
  int settings_ = 0;           ///< of that scene
  std::vector<Explicit> compared_;
  int scaled_to_ = 0, scaled_line_ = 0;
};

} // namespace

bool Plan::knows(const std::string &quantity) const {
  return std::any_of(scenes.begin(), scenes.end(),
                     [&quantity](const Scene &scene) { return known_value(scene, quantity) != nullptr; });
}

std::vector<Quantity> Plan::measured_in(const Scene &scene) const {
  std::vector<Quantity> measured;
  for (const Quantity &quantity : quantities)
    if (known_value(scene, quantity.name) != nullptr || !knows(quantity.name)) measured.push_back(quantity);
  return measured;
}

std::vector<std::string> Plan::key_in(const PlanTable &table, const Scene &scene) {
  std::vector<std::string> key;
  for (const PlanTable::Column &column : table.columns) {
    if (column.is_quantity) continue;
    const auto place = scene.at.find(column.name);
    key.push_back(place == scene.at.end() ? value_of(scene, column.name) : number_text(place->second));
    if (key.back().empty()) return {};
  }
  return key;
}

const Scene &Plan::scene(const std::string &name) const {
  return *std::find_if(scenes.begin(), scenes.end(), [&name](const Scene &one) { return one.name == name; });
}

std::string Plan::copy() const {
  const bool has_own_files =
      std::any_of(scenes.begin(), scenes.end(),
                  [](const Scene &scene) { return fs::path(scene.deck).is_absolute(); }) ||
      std::any_of(files.begin(), files.end(), [](const fs::path &file) { return file.is_absolute(); });
  return !has_own_files || names_deck_folder ? text
                                             : fmt::format("deck_folder {}\n", deck_folder.string()) + text;
}

bool Plan::can_be_scaled() const {
  return std::all_of(scenes.begin(), scenes.end(), [](const Scene &scene) {
    return scene.bed && scene.bed->packing.dimensions() == 2 && scene.stiffness > 0.0 &&
           value_of(scene, "place").empty() &&
           std::none_of(roller_variables.begin(), roller_variables.end(),
                        [&scene](const char *name) { return value_of(scene, name).empty(); });
  });
}

Plan Plan::with_balls(int balls) const {
  Plan plan = *this;
  const int of = scenes.front().bed->packing.balls;
  for (Scene &scene : plan.scenes)
    scene = scaled(scene, balls, of);
  plan.text = fmt::format("scaled_to {}\n", balls) + text;
  return plan;
}

Plan Plan::quick() const {
  Plan plan = can_be_scaled() ? with_balls(std::min(quick_balls, scenes.front().bed->packing.balls)) : *this;
  if (plan.scenes.size() > quick_scenes) plan.scenes.resize(quick_scenes);
  // A quantity that only scenes left out have known values of is left out with them.
  plan.quantities.erase(std::remove_if(plan.quantities.begin(), plan.quantities.end(),
                                       [&](const Quantity &quantity) {
                                         return knows(quantity.name) && !plan.knows(quantity.name);
                                       }),
                        plan.quantities.end());
  for (Scene &scene : plan.scenes) {
    scene.seeds = std::min(scene.seeds, quick_seeds);
    for (Setting &setting : scene.settings)
      if (setting.name == "cycles" && scene.expected.empty()) // known values are those of the whole run
        setting.value = quick_cycles;
      else if (setting.name == "passes")
        setting.value = "2";
  }
  leave_out_comparisons(plan);
  return plan;
}

Plan read_plan(const fs::path &file) { return PlanReader(file).read(); }

} // namespace drumlin::post
