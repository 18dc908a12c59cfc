// The plan of an experiment: scenes, seeds and quantities, and what is compared with what; read from a file
// that a user edits.
#pragma once

#include "experiment/quantity.h"
#include "experiment/scene.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// An axis over which the page draws the results of scenes that have a place on it.
struct Axis {
  std::string name, label; ///< the label with unit
  bool is_log = false;     ///< figures over it are logarithmic in both directions
};

/// What differs, in words, and the scenes in which it does: each pair is a scene and the one that it is
/// compared with.
struct Comparison {
  std::string words;
  std::vector<std::pair<std::string, std::string>> pairs;
  /// Whether the seeds of the two are compared one by one, so that what they share cancels. Else they are two
  /// independent samples.
  bool paired = true;
};

/// A point that others have published of a quantity over an axis; pages draw it.
struct PublishedPoint {
  std::string axis, series, source, quantity;
  double at = 0.0, value = 0.0; ///< in the units of the axis and the quantity
};

/// The file of the results in the folder of an experiment.
constexpr const char *results_name = "runs.csv";

/// A CSV file beside it with a row for each scene.
struct PlanTable {
  struct Column {
    std::string header,
        name; ///< of a quantity, or of an axis or a variable of the deck, which tell the scene
    bool is_quantity;
  };
  std::string file;
  std::vector<Column> columns;
};

/// What Plan::can_be_scaled() asks for, in words.
constexpr const char *what_can_be_scaled = "with a plan of beds in the plane that has stiffness and all of "
                                           "r2, r3, m2, m3, k23, c23, Fw, but no place";

struct Plan {
  std::string title;
  std::vector<std::string> about, notes; ///< sentences that open the page, and paragraphs below its tables
  std::vector<Quantity> quantities;
  std::vector<Axis> axes;
  std::vector<Scene> scenes; ///< the first is that to which bed sizes refer
  std::vector<Comparison> comparisons;
  double between_engines =
      0.0; ///< allowed difference of a scene in LAMMPS from the same in LIGGGHTS, over the scale of Expected
  std::vector<PublishedPoint> published;
  std::vector<PlanTable> tables;
  std::vector<std::string> errors; ///< quantities of which pages give the order over logarithmic axes
  std::vector<std::filesystem::path> files; ///< with known values and published points
  std::string left_out;                     ///< why scenes are left out, in words; empty: none are
  std::string text;                         ///< of a file with this plan
  std::filesystem::path deck_folder;        ///< of decks that are not in inputs/
  bool names_deck_folder = false;           ///< whether the text does

  /// The text of this plan for a file in another folder.
  std::string copy() const;
  /// Whether one of its scenes has a known value of a quantity.
  bool knows(const std::string &quantity) const;
  /// The quantities that are measured in a scene: those for which it has a known value, and those for which
  /// no scene has one.
  std::vector<Quantity> measured_in(const Scene &scene) const;
  /// The cells of a table that tell a scene from others, numbers with all digits; none if it has no value of
  /// one of them, so that the table has no row of it.
  static std::vector<std::string> key_in(const PlanTable &table, const Scene &scene);
  /// \pre there is one of that name
  const Scene &scene(const std::string &name) const;
  /// Whether its beds can be made smaller or larger: all are in the plane, all variables of the roller are
  /// given, and the roller does not drive.
  bool can_be_scaled() const;
  /// The plan with so many balls in its first scene. \pre can_be_scaled()
  Plan with_balls(int balls) const;
  /// The plan of a trial run: two seeds of its first three scenes, a roller that drives makes two passes, one
  /// that shakes four cycles, and beds have 150 balls if can_be_scaled().
  Plan quick() const;
};

/// Reads a plan: lines `keyword value`, # begins a comment; inputs/study/plans.md has the keywords. Decks are
/// looked for in the folder of the plan, or that of its line deck_folder, then in inputs/; so are files of
/// known values. Scenes whose engine is not set up are left out if there are others. Throws
/// UsageError "FILE, line LINE: KEYWORD is 'VALUE'; allowed: WHAT".
Plan read_plan(const std::filesystem::path &file);

} // namespace drumlin::post
