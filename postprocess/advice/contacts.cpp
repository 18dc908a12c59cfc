#include "advice/contacts.h"

#include "support/csv.h"

#include <algorithm>
#include <cstddef>

namespace drumlin::post {

const std::vector<ContactsQuestion> contacts_questions = {
    {"regime", "share of points with another regime", &ContactsError::regime},
    {"tilt", "largest difference of the tilt, where the regime is the same", &ContactsError::tilt},
    {"contact", "largest difference of the share of time in contact, where the regime is the same",
     &ContactsError::share}};

std::vector<ContactsError> read_contacts_study(const std::filesystem::path &file) {
  const Table table = read_table(file);
  const std::vector<double> contacts = table.numbers("contacts"), regime = table.numbers("other_regime [-]"),
                            tilt = table.numbers("tilt [-]"), share = table.numbers("contact_share [-]"),
                            seconds = table.numbers("cpu [s]");
  std::vector<ContactsError> study;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (i > 0 && !(contacts[i] > contacts[i - 1]))
      csv_fault(file, table.line(i), "contacts", "does not grow; allowed: rows by the number of contacts");
    study.push_back({static_cast<int>(contacts[i]), regime[i], tilt[i], share[i], seconds[i]});
  }
  if (study.size() < 2) csv_fault(file, 0, {}, "has fewer than two rows; allowed: the reference and others");
  return study;
}

const ContactsError &fewest_contacts(const std::vector<ContactsError> &study,
                                     const ContactsQuestion &question, double within) {
  return *std::find_if(study.begin(), study.end() - 1,
                       [&](const ContactsError &row) { return row.*question.error <= within; });
}

} // namespace drumlin::post
