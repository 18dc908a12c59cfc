#pragma once
// The commands that the plugin adds to decks. Each has a page of its name in plugin/doc, and ends the run
// with one line if its arguments are wrong.

#include "engine.h"

namespace drumlin {

/// drumlin/variable NAME DEFAULT RULE UNIT GROUP MEANING: declares a variable of the deck.
void variable_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/variables FILE [GROUP ...]: declares the variables of a table.
/// drumlin/variables: ends the run if the command line gives a variable that the deck does not declare, or a
/// value with signs that the engine's parser does not take as they stand, or if a value breaks its rule.
void variables_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/check NAME VALUE RULE ...: ends the run if the value of a variable breaks a rule.
void check_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/roller FILE whole|per_metre [setting NAME]: sets the variables of a roller to those of its file.
void roller_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/read FILE [may_continue]: reads a bed, or a stopped run, which then continues.
void read_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/outputs [folder F] files NAME ... [numbered FOLDER PREFIX SUFFIX ...]: backs up the files of an
/// earlier run, which are restored if the new run fails in its first steps.
void outputs_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/take FILE DECKS ALLOWED [fixed GROUP ...] [free GROUP ...] [except NAME ...] [only NAME ...]
/// [default NAME ...]: reads the values with which a bed was made from its file, and gives them to the
/// variables that later lines of the deck declare.
void take_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/record FILE NAME VALUE ...: writes parameters.csv, the parameters of a run.
void record_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/run STEP [every N] [limit S] [restart FILE [NAME VALUE ...]]: runs to a step in pieces, with
/// progress and a limit of wall time.
void run_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/write restart|data|both FILE [NAME VALUE ...] [groups GROUP ...] [values_of NAME ...]: writes a
/// restart file, a data file or both, complete or not at all, with notes on how the scene was made.
void write_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/settle [ratio r] [every n] [limit N]: runs until static equilibrium.
void settle_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/surface NAME GROUP spacing s [beyond d x]: sets a variable to the mean height of the surface of a
/// group of balls.
void surface_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/density NAME GROUP [layers N] [scale LOOSEST DENSEST ASKED]: prints the solid fraction and the
/// relative density of each layer of a bed, and sets a variable to the heights of the surfaces of the layers.
void density_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/layers k LIST D LIST friction LIST rolling off|epsd2 LIST [suction LIST]
/// [variables NAME NAME NAME NAME]: gives the contacts of a bed the laws of its layers.
void layers_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/pick NAME WHICH LIST: sets a variable to the largest number of a list, or to that in a place.
void pick_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/repeat NAME N COMMAND ...: executes the commands N times, with the variable NAME as 1, 2, ... N.
void repeat_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/suction NAME GROUP strength S solid P contacts Z: sets a variable to the suction that gives soil a
/// tensile strength.
void suction_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/way FILE: sets the variables of the soil along a way to those of its start, and its ends.
void way_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/ends machine CONTACTS ROLLER m2 m3 k23 c23 k D g: sets the variables of a roller that tilts.
/// drumlin/ends laws STIFFNESSES RATIOS: gives its contacts their laws.
void ends_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// A command as a type, for engines that want a class for each.
template <void (*run)(LAMMPS_NS::LAMMPS *, int, char **)>
struct CommandType {
  static constexpr auto function = run;
};

/// Calls add(CommandType, name, description) for each command: the list from which both engines register
/// them.
template <class Add>
void for_each_command(Add &&add) {
  add(CommandType<check_command>(), "drumlin/check", "checks the value of a variable");
  add(CommandType<variable_command>(), "drumlin/variable", "declares a variable of the deck");
  add(CommandType<variables_command>(), "drumlin/variables", "declares and checks the variables of a table");
  add(CommandType<roller_command>(), "drumlin/roller", "takes the values of a roller from its file");
  add(CommandType<pick_command>(), "drumlin/pick", "takes a number from a list");
  add(CommandType<repeat_command>(), "drumlin/repeat", "executes commands for each of 1 to N");
  add(CommandType<layers_command>(), "drumlin/layers", "gives contacts the laws of the layers of a bed");
  add(CommandType<outputs_command>(), "drumlin/outputs", "backs up the files of an earlier run");
  add(CommandType<read_command>(), "drumlin/read", "reads a bed or a stopped run");
  add(CommandType<take_command>(), "drumlin/take", "takes the values with which a bed was made");
  add(CommandType<record_command>(), "drumlin/record", "writes the parameters of a run");
  add(CommandType<run_command>(), "drumlin/run", "runs with progress and a limit of wall time");
  add(CommandType<settle_command>(), "drumlin/settle", "runs to static equilibrium");
  add(CommandType<surface_command>(), "drumlin/surface", "measures the mean height of a surface");
  add(CommandType<density_command>(), "drumlin/density", "measures the density of the layers of a bed");
  add(CommandType<suction_command>(), "drumlin/suction", "finds the suction for a tensile strength");
  add(CommandType<way_command>(), "drumlin/way", "takes the ends of a way and its soil from a file");
  add(CommandType<ends_command>(), "drumlin/ends", "takes contacts and bonds of a roller that tilts");
  add(CommandType<write_command>(), "drumlin/write", "writes restart and data files with notes");
}

} // namespace drumlin
