#pragma once
// A table that rank 0 writes while a run goes on.

#include "engine.h"
#include "support/whole_file.h"

#include <cstdio>
#include <string>

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

  /// Ends the run if open() is going to fail; touches nothing. For a fix's init(): all come before the first
  /// set-up, so that one bad name leaves the files of all fixes as they were. Collective.
  static void check(const std::string &name, LAMMPS_NS::Comm *comm, LAMMPS_NS::Error *error, MPI_Comm world,
                    const std::string &command) {
    end_if(comm->me == 0 && !is_output_file(name) ? 1 : 0, name, error, world, command, output_name_allowed);
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
    end_if(failed, name_, error, world, command, output_name_allowed);
  }

  const std::string &name() const { return name_; }
  FILE *get() const { return file_; } ///< nullptr on other ranks

  /// Hands what was written to the system and ends the run if any of it did not reach the disk. Collective.
  void flush(LAMMPS_NS::Error *error, MPI_Comm world, const std::string &command) const {
    const int failed = file_ != nullptr && (std::fflush(file_) != 0 || std::ferror(file_) != 0) ? 1 : 0;
    end_if(failed, name_, error, world, command, "a file on a disk with room");
  }

private:
  static void end_if(int failed, const std::string &name, LAMMPS_NS::Error *error, MPI_Comm world,
                     const std::string &command, const std::string &allowed) {
    MPI_Bcast(&failed, 1, MPI_INT, 0, world);
    if (failed)
      error->all(FLERR, engine::as_is(command + ": cannot write '" + name + "'; allowed: " + allowed));
  }

  std::string name_;
  bool append_;
  bool opened_ = false;
  FILE *file_ = nullptr;
};

} // namespace drumlin
