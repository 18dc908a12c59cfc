#pragma once
// A table that rank 0 writes while a run goes on.

#include "engine.h"

#include <cstdio>
#include <filesystem>
#include <string>
#include <unistd.h>

namespace drumlin {

/// Opened at set-up, not while the deck is parsed: bad input further down leaves an earlier run's file
/// untouched.
class OutputFile {
public:
  OutputFile(std::string name, bool append) : name_(std::move(name)), append_(append) {}
  OutputFile(const OutputFile &) = delete;
  OutputFile &operator=(const OutputFile &) = delete;
  ~OutputFile() {
    if (file_) std::fclose(file_);
  }

  /// What name allows, for an error text.
  static constexpr const char *allowed = "a file in a folder that exists";

  /// Whether a file of this name can be written; touches nothing. Not collective.
  static bool writable(const std::string &name) {
    namespace fs = std::filesystem;
    std::error_code code;
    const fs::path folder = fs::path(name).has_parent_path() ? fs::path(name).parent_path() : fs::path(".");
    if (fs::exists(name, code)) return !fs::is_directory(name, code) && access(name.c_str(), W_OK) == 0;
    return fs::is_directory(folder, code) && access(folder.c_str(), W_OK | X_OK) == 0;
  }

  /// Ends the run if open() is going to fail; touches nothing. For a fix's init(): all come before the first
  /// set-up, so that one bad name leaves the files of all fixes as they were. Collective.
  static void check(const std::string &name, LAMMPS_NS::Comm *comm, LAMMPS_NS::Error *error, MPI_Comm world,
                    const std::string &command) {
    end_if(comm->me == 0 && !writable(name) ? 1 : 0, name, error, world, command);
  }

  /// Opens the file once, on rank 0; collective. Ends the run if that fails.
  void open(LAMMPS_NS::Comm *comm, LAMMPS_NS::Error *error, MPI_Comm world, const std::string &command,
            const char *header) {
    if (opened_) return;
    opened_ = true;
    int failed = 0;
    if (comm->me == 0) {
      file_ = std::fopen(name_.c_str(), append_ ? "a" : "w");
      if (file_ && (!append_ || std::ftell(file_) == 0)) std::fprintf(file_, "%s\n", header);
      failed = file_ == nullptr;
    }
    end_if(failed, name_, error, world, command);
  }

  const std::string &name() const { return name_; }
  FILE *get() const { return file_; } ///< nullptr on other ranks
  void flush() const {
    if (file_) std::fflush(file_);
  }

private:
  static void end_if(int failed, const std::string &name, LAMMPS_NS::Error *error, MPI_Comm world,
                     const std::string &command) {
    MPI_Bcast(&failed, 1, MPI_INT, 0, world);
    if (failed) error->all(FLERR, (command + ": cannot write '" + name + "'; allowed: " + allowed).c_str());
  }

  std::string name_;
  bool append_;
  bool opened_ = false;
  FILE *file_ = nullptr;
};

} // namespace drumlin
