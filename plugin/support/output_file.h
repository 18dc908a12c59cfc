#pragma once
// A table that rank 0 writes during a run.

#include "engine.h"
#include "support/whole_file.h"

#include <cerrno>
#include <cstdio>
#include <string>
#include <sys/file.h>
#include <unistd.h>

namespace drumlin {

/// The file is opened when a run is set up, not when the engine reads the fix's line: a mistake in a later
/// line of the deck leaves the file of an earlier run as it was.
class OutputFile {
public:
  /// \param append rows are added to an existing file instead of replacing it
  OutputFile(std::string name, bool append) : name_(std::move(name)), append_(append) {}
  OutputFile(const OutputFile &) = delete;
  OutputFile &operator=(const OutputFile &) = delete;
  ~OutputFile() {
    if (file_) std::fclose(file_);
  }

  /// Ends the run if open() would fail; changes no file. For a fix's init(): the engine initializes all fixes
  /// before it sets up the first, so that one bad name leaves the files of all fixes as they were.
  /// Collective.
  /// \param what command and keyword that gave the name, for the error
  static void check(const std::string &name, LAMMPS_NS::Comm *comm, LAMMPS_NS::Error *error, MPI_Comm world,
                    const std::string &what) {
    stop_if(comm->me == 0 && !is_output_file(name) ? 1 : 0, name, error, world, what, output_name_allowed);
  }

  /// Opens the file on rank 0 and writes the header if the file is new; further calls do nothing. Ends the
  /// run if that fails. Collective.
  void open(LAMMPS_NS::Comm *comm, LAMMPS_NS::Error *error, MPI_Comm world, const std::string &what,
            const char *header) {
    if (opened_) return;
    opened_ = true;
    int failed = 0;
    if (comm->me == 0) {
      // Opened without truncating it: a file that another fix writes is refused, and stays as it is.
      file_ = std::fopen(name_.c_str(), "a");
      if (file_ != nullptr && flock(fileno(file_), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        failed = taken;
      else if (file_ == nullptr || (!append_ && ftruncate(fileno(file_), 0) != 0))
        failed = 1;
      else if (!append_ || std::ftell(file_) == 0)
        std::fprintf(file_, "%s\n", header);
    }
    stop_if(failed, name_, error, world, what,
            failed == taken ? "a file that no other fix and no other run writes" : output_name_allowed);
  }

  const std::string &name() const { return name_; }
  FILE *get() const { return file_; } ///< nullptr on ranks other than 0, and before open()

  /// Flushes what was written and ends the run if any write has failed, as on a full disk. Collective.
  void flush(LAMMPS_NS::Error *error, MPI_Comm world, const std::string &what) const {
    const int failed = file_ != nullptr && (std::fflush(file_) != 0 || std::ferror(file_) != 0) ? 1 : 0;
    stop_if(failed, name_, error, world, what, "a file on a disk with room");
  }

private:
  static constexpr int taken = 2; ///< another fix or run writes the file

  static void stop_if(int failed, const std::string &name, LAMMPS_NS::Error *error, MPI_Comm world,
                      const std::string &what, const std::string &allowed) {
    MPI_Bcast(&failed, 1, MPI_INT, 0, world);
    if (failed)
      error->all(FLERR, engine::error_text(what + " is '" + name +
                                           "', which cannot be written; allowed: " + allowed));
  }

  std::string name_;
  bool append_;
  bool opened_ = false;
  FILE *file_ = nullptr;
};

} // namespace drumlin
