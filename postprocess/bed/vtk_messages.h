// VTK's messages, collected instead of printed.
#pragma once

#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>
#include <vtkStringOutputWindow.h>

#include <algorithm>
#include <cstddef>
#include <string>

namespace drumlin::post {

/// While an object of this class exists, VTK's messages go into it instead of to the screen.
class VtkMessages {
public:
  VtkMessages()
      : before_(vtkOutputWindow::GetInstance()), verbosity_(vtkLogger::GetCurrentVerbosityCutoff()) {
    vtkOutputWindow::SetInstance(window_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~VtkMessages() {
    vtkLogger::SetStderrVerbosity(verbosity_);
    vtkOutputWindow::SetInstance(before_);
  }
  VtkMessages(const VtkMessages &) = delete;
  VtkMessages &operator=(const VtkMessages &) = delete;

  /// The first message as one line, without where in VTK it arose; empty if there is none.
  std::string first() const {
    std::string text = window_->GetOutput();
    const std::size_t colon = text.find("): "); // "ERROR: In file, line n\nvtkClass (address): text"
    if (colon != std::string::npos) text.erase(0, colon + 3);
    text.erase(std::min(text.find_first_of("\r\n"), text.size()));
    return text;
  }

private:
  vtkNew<vtkStringOutputWindow> window_;
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkLogger::Verbosity verbosity_;
};

} // namespace drumlin::post
