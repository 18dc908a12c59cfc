#include "pages/acceptance.h"

#include <fmt/format.h>

namespace drumlin::post {

ReportTable promise_table(const std::vector<Promise> &promises) {
  ReportTable table;
  table.name = "promises";
  table.title = "What is promised";
  table.text_columns = 2;
  table.header = {"promise", "measured", "holds"};
  int held = 0;
  for (const Promise &p : promises) {
    held += p.holds ? 1 : 0;
    table.add({p.promise, p.measured, p.holds ? "yes" : "no"},
              p.holds ? RowState::agrees : RowState::differs);
  }
  table.notes = {fmt::format("{} of {} hold.", held, promises.size())};
  return table;
}

} // namespace drumlin::post
