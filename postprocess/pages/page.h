// The page of a study: its answer in words, tables and figures, in the style of the report.
#pragma once

#include "pages/table.h"
#include "pages/drawing.h"
#include "pages/figure.h"
#include "pages/html.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// Collects paragraphs, tables and figures, then writes them into the study's folder: index.html,
/// data/NAME.csv of every table and figure, figures/NAME.svg, .png and .gp. All links are relative, so the
/// folder can be moved.
///
/// The page opens with its answer, a drawing of the model and up to two key figures; then come the sections
/// in their order, and the contents list names them.
class Page {
public:
  /// \param out folder of the study
  /// \param drawing of the model that the page is about, if there is one
  Page(std::filesystem::path out, std::string title, std::optional<Drawing> drawing);

  /// A sentence of the opening paragraph, plain text.
  void answer(const std::string &sentence) { answer_.push_back({sentence}); }
  /// How many acceptance criteria hold, as a sentence of the opening paragraph and as its mark. Without
  /// criteria: nothing.
  void answer(const std::vector<Acceptance> &criteria);

  /// Begins a section; what follows belongs to it.
  void section(const std::string &title);
  /// Plain text.
  void paragraph(const std::string &text);
  /// A table; data/NAME.csv is made from it.
  void table(PageTable table);
  /// A figure: label ("Fig. 1"), caption, panels, and the CSV text behind it (CurveTable makes one; the
  /// curves read data_path(NAME)). PageFigure::section is not used. Up to two figures of largest weight open
  /// the page.
  void figure(const PageFigure &figure);

  /// Draws the figures and writes all files, the page last.
  void write() const;

private:
  std::string html() const;

  std::filesystem::path out_;
  std::string title_;
  std::optional<Drawing> drawing_;
  std::vector<Sentence> answer_;
  bool judged_ = false;
  bool good_ = true;
  std::string body_;
  std::vector<std::string> sections_; ///< titles
  std::vector<PageFigure> figures_;
  std::vector<PageTable> tables_;
};

} // namespace drumlin::post
