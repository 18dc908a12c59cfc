// `drumlin vtk`: the dumps of a bed run as time series for ParaView.
#pragma once

#include <optional>
#include <string>

namespace drumlin::post {

/// The options as given; numbers stay text until they are judged.
struct VtkArguments {
  std::string folder;              ///< of the run, with dump/ and parameters.csv
  std::optional<std::string> out;  ///< folder for the results; FOLDER/vtk if not given
  std::optional<std::string> cell; ///< side of the cells of the fields, m; fitted to the bed if not given
};

/// Writes balls.pvd, contacts.pvd and fields.pvd with the files of each step, and prints what there is.
/// Throws UsageError for folders, files and options that cannot be used; the results of an earlier call then
/// stay.
void write_vtk_series(const VtkArguments &arguments);

} // namespace drumlin::post
