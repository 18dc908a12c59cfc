// The subcommands of `drumlin`. Each function adds one to the program; NAME.cpp defines add_NAME_command().
#pragma once

#include "support/usage_error.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// Whether there is such a subcommand.
bool is_subcommand(const std::string &name);

/// The command line as one text; `words` are those behind `drumlin`.
std::string command_line(const std::vector<std::string> &words);

/// Carries a command line out. Throws CLI::ParseError if it is none, else what its subcommand throws.
void call(std::vector<std::string> words);

/// `advise`: the steps per cycle that a chain needs for an error.
void add_advise_command(CLI::App &app, Session &session);

/// `bed`: soil balls at random positions, for inputs/bed; an option for each entry of BedRequest.
void add_bed_command(CLI::App &app, Session &session);

/// `calibrate`: finds contact parameters for which measured properties of a bed equal given targets.
void add_calibrate_command(CLI::App &app, Session &session);

/// `demo [--cycles N] [--balls N]`: the paper's cases and a bed under both transitions, with a report on
/// them. Writes results/demo and report in the working folder.
void add_demo_command(CLI::App &app, Session &session);

/// `exact`: the exact solution of the chain. Writes chain.csv, events.csv, cycles.csv and
/// parameters.csv into the folder --out, all or none.
void add_exact_command(CLI::App &app, Session &session);
void add_way_command(CLI::App &app, Session &session);

/// `identify RECORD`: stiffness and damping of the soil from a record of a roller's motion.
void add_identify_command(CLI::App &app, Session &session);

/// `map`: the regimes of a roller over two parameters of the chain.
void add_map_command(CLI::App &app, Session &session);

/// `meter RECORD`: the values that a roller's meter shows, from a record of its motion.
void add_meter_command(CLI::App &app, Session &session);

/// `passes FOLDER...`: what each pass of a roller that drives over a bed leaves.
void add_passes_command(CLI::App &app, Session &session);

/// `report DIR... [--out report]`: reads run folders and writes a folder with index.html.
void add_report_command(CLI::App &app, Session &session);

/// `run [-np N] DECK [engine arguments]`: prints the plain command of the stock engine with the plugin, and
/// becomes it.
void add_run_command(CLI::App &app, Session &session);

/// `study NAME`: measurements of accuracy, cost and stability.
void add_study_command(CLI::App &app, Session &session);

/// `vtk DIR [--out DIR] [--cell NUMBER]`: the dumps of a bed run as time series for ParaView.
void add_vtk_command(CLI::App &app, Session &session);

} // namespace drumlin::post
