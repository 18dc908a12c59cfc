// What identification found, in words, as a table and as a page.
#pragma once

#include "identify/identified_record.h"
#include "identify/lumped_comparison.h"
#include "identify/two_sided.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// The answer in lines of plain text: k, c and D with their intervals, whether the contact pulls, the quality
/// of the fit, and what was assumed.
std::vector<std::string> identification_answer(const IdentifiedRecord &record);

/// identify.csv: a row for the whole record and one for each window.
std::string identification_csv(const IdentifiedRecord &record);

/// Writes the page with plots into a folder: index.html, data, figures.
/// \param compared the chain beside the record, for a section of its own; nullptr: none
/// \param roller a sentence on the roller; may be empty
void write_identification_page(const std::filesystem::path &out, const IdentifiedRecord &record,
                               const LumpedComparison *compared = nullptr, const std::string &roller = "");

/// The same of a record of both ends; identify.csv then has a row for each half and one for both.
std::vector<std::string> identification_answer(const TwoSidedRecord &record);
std::string identification_csv(const TwoSidedRecord &record);
void write_identification_page(const std::filesystem::path &out, const TwoSidedRecord &record,
                               const std::string &roller = "");

} // namespace drumlin::post
