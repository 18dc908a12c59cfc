// The page of a study: what it says in words, tables and figures, in the look of the report.
#pragma once

#include "pages/figure.h"
#include "pages/table.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// Collects what a study has to say, then writes it into the study's folder: index.html, data/NAME.csv of every table and
/// figure, figures/NAME.svg, .png and .gp. All links are relative, so that the folder can be moved.
class StudyPage {
public:
  /// \param out folder of the study
  StudyPage(std::filesystem::path out, std::string title);

  /// Begins a section; what follows belongs to it.
  void section(const std::string &title);
  /// Plain text.
  void paragraph(const std::string &text);
  /// A table; data/NAME.csv is made from it. shown_columns 0 shows all.
  void table(ReportTable table);
  /// A figure: label ("Fig. 1"), caption, panels, and the CSV text behind it (CurveTable makes one; the curves read
  /// data_path(NAME)). PlannedFigure::section is not used.
  void figure(const PlannedFigure &figure);

  /// Draws the figures and writes everything, the page last.
  void write() const;

private:
  std::filesystem::path out_;
  std::string title_;
  std::string body_;
  bool in_section_ = false;
  std::vector<PlannedFigure> figures_;
  std::vector<ReportTable> tables_;
};

} // namespace drumlin::post
