// The page on a file of a site: meter map, values over passes, rules of acceptance.
#pragma once

#include "passes/field_file.h"
#include "passes/map_figures.h"

#include <filesystem>

namespace drumlin::post {

/// Writes the page index.html with plots and their data into a folder that exists.
void write_field_page(const std::filesystem::path &folder, const FieldFile &field, const JudgedMap &judged);

} // namespace drumlin::post
