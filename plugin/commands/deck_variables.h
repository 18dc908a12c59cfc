#pragma once
// The variables of a deck as drumlin/variable declares them. What is declared, noted in a file or wrong is
// kept in variables of the engine instance with names that begin with drumlin_, so that it exists before a
// box, outlives `clear` and is an instance's own.

#include "engine.h"

#include "commands/bed_files.h"
#include "support/arguments.h"

#include <optional>
#include <string>
#include <vector>

namespace drumlin {

/// A variable that drumlin/variable has declared.
struct DeclaredVariable {
  std::string name;
  std::string group;
  bool given; ///< whether -var may give it
  bool words; ///< whether its value may have blanks
  /// Whether the command line, or a note of a file, has chosen its value.
  bool chosen = false;
};

/// Notes of a file that drumlin/take has read, and which of them must agree.
struct TakenNotes {
  std::string file;                  ///< empty: none
  std::string decks;                 ///< that make the file, for an error
  std::vector<std::string> fixed;    ///< groups whose variables the file must note, and that cannot change
  std::vector<std::string> free;     ///< groups whose variables the file must note, and that may change
  std::vector<std::string> change;   ///< names of variables that may differ
  std::vector<std::string> standard; ///< names whose notes are defaults, and need not agree
  std::vector<std::string> later; ///< names that earlier files do not note: they were made with the defaults
  RestartNotes notes;
};

class DeckVariables {
public:
  explicit DeckVariables(LAMMPS_NS::LAMMPS *lmp) : variables_(*lmp->input->variable) {}

  /// The value of a variable; none if there is no such variable.
  std::optional<std::string> value(const std::string &name) const;
  /// Makes a variable an index variable of this value. One of any style that has the name is replaced.
  void set(const std::string &name, const std::string &value);
  void remove(const std::string &name);
  /// The same, unless there is a variable of this name.
  void set_default(const std::string &name, const std::string &value);

  std::vector<DeclaredVariable> declared() const;
  void declare(const DeclaredVariable &variable);

  bool is_declared(const std::string &name) const;

  TakenNotes taken() const;
  /// What is allowed instead of the value of a declared variable, by the notes that have been taken; empty:
  /// it agrees with them.
  std::string note_fault(const DeclaredVariable &variable, const std::string &value) const;
  void take(const TakenNotes &notes);
  void forget_notes();

  /// Between the first drumlin/variable and drumlin/variables, which tells the first fault: only then does
  /// the deck know all names.
  bool open() const;
  void close();
  /// The first fault, "COMMAND: variable NAME is 'VALUE'; allowed: WHAT"; empty: none.
  std::string fault() const;
  void add_fault(const std::string &fault);
  /// Ends the run with a fault, or notes it while declarations are open. Collective.
  static void refuse(LAMMPS_NS::LAMMPS *lmp, const std::string &fault);
  /// Ends the run with the first fault, if there is one. Collective.
  static void stop_on_fault(LAMMPS_NS::LAMMPS *lmp);

private:
  std::vector<std::string> lines(const std::string &name) const;
  void keep(const std::string &name, const std::vector<std::string> &lines);

  LAMMPS_NS::Variable &variables_;
};

/// The numbers of a list of an argument, separated by commas; ends the run if one is not in the range.
std::vector<double> list_numbers(const Arguments &in, const std::string &what, const std::string &list,
                                 const Range &range);
/// The words of a text, which are separated by blanks.
std::vector<std::string> words_of(const std::string &text);
/// Whether a name is in a list.
bool is_in(const std::vector<std::string> &names, const std::string &name);

/// Whether two values are the same: words exactly, numbers, also those of lists, to rounding, since a value
/// may come from a formula of the deck.
bool same_value(const std::string &a, const std::string &b);

/// A variable that -var or -v gives, with its values.
struct GivenVariable {
  std::string name;
  std::vector<std::string> values;
  /// "variable NAME is 'VALUE'" for an error, without control characters, at most 60 characters of the value
  std::string shown() const;
};

/// Whether `drumlin run` gives a variable of this name, to every deck.
bool of_front_script(const std::string &name);

/// The variables of the command line of this process, read as the engines read them.
std::vector<GivenVariable> given_variables();

/// Empty if the engine's parser takes a value as it is; else what is allowed.
/// \param of_words whether the value may have blanks
std::string value_fault(const GivenVariable &variable, bool of_words);

/// Empty if a value follows a rule of drumlin/check; else what follows "variable NAME is 'VALUE'" in the
/// error. Ends the run if there is no such rule. Collective.
/// \param rule the rule and its words
std::string rule_fault(LAMMPS_NS::LAMMPS *lmp, const std::string &command, const std::string &name,
                       const std::string &value, const std::vector<std::string> &rule);

} // namespace drumlin
