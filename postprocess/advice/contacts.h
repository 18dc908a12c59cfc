// How many contacts along the width of a drum that tilts a question needs, from what the study `ends` has
// measured against sixteen contacts.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// What a number of contacts was off in the study.
struct ContactsError {
  int contacts = 0;
  double regime = 0.0;  ///< share of the points with another regime [-]
  double tilt = 0.0;    ///< largest difference of the tilt where the regime is the same [-]
  double share = 0.0;   ///< largest difference of the share of time in contact there [-]
  double seconds = 0.0; ///< processor time of all points [s]
};

/// A question, as the option --question gives it, and which error counts for it.
struct ContactsQuestion {
  const char *name;
  const char *words; ///< of the error
  double ContactsError::*error;
};
/// "regime", "tilt" and "contact".
extern const std::vector<ContactsQuestion> contacts_questions;

/// The rows of contacts.csv, in the order of the number of contacts; errors are against the last row.
/// std::runtime_error of one line for a table that cannot be used.
std::vector<ContactsError> read_contacts_study(const std::filesystem::path &file);

/// The row with the fewest contacts whose error is within what is allowed; the reference if no other is.
const ContactsError &fewest_contacts(const std::vector<ContactsError> &study,
                                     const ContactsQuestion &question, double within);

} // namespace drumlin::post
