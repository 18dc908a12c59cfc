#include "runs/parameter_file.h"

#include "support/csv.h"

#include <fmt/format.h>

#include <cstddef>

namespace drumlin::post {

namespace {
constexpr const char *parameters_header = "name,value";
} // namespace

std::map<std::string, std::string> read_parameters(const std::filesystem::path &file) {
  const Table table = read_table(file);
  const std::vector<std::string> names = table.text("name");
  const std::vector<std::string> values = table.text("value");
  std::map<std::string, std::string> parameters;
  for (std::size_t i = 0; i < table.rows(); ++i)
    if (!parameters.emplace(names[i], values[i]).second)
      csv_refusal(file, table.line(i), "name", names[i], "each name once");
  return parameters;
}

std::string parameters_text(const std::vector<std::pair<std::string, std::string>> &parameters) {
  std::string text = fmt::format("{}\n", parameters_header);
  for (const auto &[name, value] : parameters)
    text += fmt::format("{},{}\n", csv_cell(name), csv_cell(value));
  return text;
}

} // namespace drumlin::post
