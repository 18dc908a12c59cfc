// What a report is made of.
#pragma once

#include "report/bed/measures.h"
#include "report/chain/ends_page.h"
#include "report/chain/figures.h"
#include "report/chain/measures.h"
#include "report/chain/tables.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// Versions of the programs that made the report.
struct ReportVersions {
  std::string drumlin;
  std::string gnuplot;
  std::string made_at; ///< date and time, UTC
};

/// A study that is part of the report.
struct StudyLink {
  std::string place;        ///< link to its index.html, relative to the report's
  std::string title;        ///< plain text
  std::string picture = {}; ///< shown on the first page, which links the study by it; empty: none
};

/// What a report is made of. With runs on beds or of drums with two ends only,
/// `results` and `figures` are empty.
struct ReportContent {
  ReportResults results;
  FigurePlan figures;
  std::vector<BedResult> beds;
  std::vector<BedGroup> groups; ///< of `beds`, which must stay where they are
  FigurePlan bed_figures;
  std::vector<EndsResult> ends; ///< drums with two ends
  FigurePlan ends_figures;
  std::vector<KeyFigure> keys;      ///< of the first page: with chains and beds one of each
  std::vector<KeyFigure> bed_keys;  ///< of the page on beds
  std::vector<KeyFigure> ends_keys; ///< of the page on drums with two ends
  std::vector<PageTable> bed_tables;
  std::vector<PageTable> tables; ///< all, those of the other pages included
  std::vector<StudyLink> studies;
  std::vector<LeftOut> left_out; ///< runs that were cut, and what cannot be read
  ReportVersions versions;
};

} // namespace drumlin::post
