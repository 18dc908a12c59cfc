// A scene of an experiment: a deck with its variables and, if it is on a bed, the soil that it stands on.
#pragma once

#include "bed/packing.h"
#include "engine/deck_run.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// The decks that make a bed with a roller on it and shake it, in their order: in.settle, in.place, and the
/// scene's own deck. A scene without a bed has the last one alone.
enum class SceneDeck { settle, place, run };

/// Which of these decks get a variable.
enum class Scope {
  all,
  settle, ///< in.settle alone
  placed, ///< in.place and the scene's own deck: what is done once the soil has settled
  run     ///< the scene's own deck alone
};

/// A variable of the decks.
struct Setting {
  Scope scope = Scope::all;
  std::string name, value;
};

/// The soil of a bed. Its seed is that of the run.
struct SoilBed {
  PackingOptions packing;
  std::vector<BedLayer> layers = {}; ///< the lowest first, instead of the packing's balls; empty: one layer
  std::vector<Spot> spots = {};      ///< parts of the lowest layer with contacts of their own, left to right
  std::string ratio = "1";           ///< unbalanced force at which it counts as at rest: see in.settle

  int balls() const; ///< of all layers
};

constexpr double soil_density = 2650.0; ///< of the balls [kg/m3]

/// A known value of one of a plan's quantities, with which its mean over the seeds is compared.
struct Expected {
  std::string quantity;
  double value = 0.0;        ///< in the quantity's unit
  double scale = 1.0;        ///< what an error is divided by, in that unit
  double tolerance = 0.0;    ///< of an error so divided
  std::string source;        ///< where the value is from, in words
  std::string scale_of = {}; ///< the scene whose value is the scale; empty: none
};

/// A file that a scene reads, made by another deck before.
struct MadeFile {
  std::string variable;     ///< of the scene's deck, that names the file
  std::string deck, output; ///< the deck that makes it, and its variable that names it
  Variables settings;       ///< of that deck, besides the files above
};

struct Scene {
  std::string name; ///< without commas
  std::string deck; ///< relative to inputs/, or absolute
  std::optional<SoilBed> bed = {};
  std::vector<Setting> settings = {}; ///< each name once for each scope
  std::string seed_variable = {};     ///< the deck's variable that gets the seed; of a bed none
  int seeds = 1;
  bool rounds = false; ///< `seeds` counts repetitions of the same run, in turn with those of other scenes
  int ranks = 1;
  std::vector<MadeFile> made = {}; ///< in the order in which they are made

  // Rules that give variables which `settings` do not have.
  double stiffness =
      0.0; ///< k of all contacts, with time step and steps per cycle [N/m]; 0: as the deck has them
  double frequency = 0.0;  ///< of the excitation: omega and steps per cycle [Hz]; 0: as the deck has it
  double more_steps = 1.0; ///< factor of the steps per cycle

  std::map<std::string, double> at = {}; ///< place on each axis over which the page draws the results
  std::string series = {};               ///< name in the legend of these figures

  std::vector<Expected> expected = {}; ///< each quantity once for each source
  std::string family = {};             ///< the name in the plan, which scenes share that a line `over` makes
  std::string twin = {};               ///< for a scene in LAMMPS: the name of the same scene in LIGGGHTS
};

/// One of its decks: the scene's own, or the one beside it that makes its bed, for the same engine.
std::string deck_of(const Scene &scene, SceneDeck deck);

/// The variables of one of a scene's decks, each name once, without those that name files.
Variables variables_of(const Scene &scene, SceneDeck deck);

/// The value of a variable of the scene's own deck; empty if the deck's default counts.
std::string value_of(const Scene &scene, const std::string &name);

/// The scene with a bed in the plane of `scale` times the lengths, of balls as large as before. Masses and
/// forces per metre of width go with the square of lengths; so does the stiffness of the contacts, so that
/// the drum on the soil keeps its natural frequency. \param balls numbers of balls are multiplied by balls/of
/// and rounded down; scale is the root of it
Scene scaled(Scene scene, int balls, int of);

/// All that a scene's soil is made of but the seed: scenes with the same text share their settled soil.
std::string soil_text(const Scene &scene);

/// The value that the plan expects of a quantity in a scene (line `expect`), the first if there are several;
/// nullptr if it expects none.
const Expected *known_value(const Scene &scene, const std::string &quantity);

/// Names and values one after the other.
std::string words_of(const Variables &variables);

/// The lists one after the other.
Variables joined(Variables first, const Variables &second);

/// Whether the settled soil of a scene stays when its roller has been placed, for other scenes on the same
/// soil.
enum class Soil { kept, used_up };

/// The restart file of a scene's soil at rest, in the folder `beds` of `out`; made if an earlier call did not
/// finish it. Its name has the fingerprint of all that the soil is made of.
std::filesystem::path settled_soil(const Scene &scene, int seed, const std::filesystem::path &out);

/// Name of a scene's bed with its roller, of one seed, with the fingerprint of all that both are made of.
std::string placed_name(const Scene &scene, int seed);

/// The restart file of a scene's bed with its roller at rest, in the same folder. Scenes on the same soil are
/// not placed at the same time.
std::filesystem::path placed_roller(const Scene &scene, int seed, const std::filesystem::path &out,
                                    Soil soil);

/// The file that run_scene() adds to those of a run: seconds in the engine's loop, processor time, memory of
/// the rank with the largest.
constexpr const char *cost_name = "cost.csv";

/// Runs the scene's deck for a seed, on its bed if it has one. Throws as DeckRun::must_succeed().
std::unique_ptr<DeckRun> run_scene(const Scene &scene, int seed, const std::filesystem::path &out, Soil soil);

} // namespace drumlin::post
