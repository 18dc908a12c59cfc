#pragma once
// The end of each engine's engine.h: what is the same text for both engines.

namespace drumlin::engine {

/// Tells the user: on the screen and in the log file, at once. Rank 0 speaks, the others may call it too.
inline void say(const LAMMPS *lmp, const std::string &text) {
  if (lmp->comm->me != 0) return;
  for (FILE *out : {lmp->screen, lmp->logfile})
    if (out != nullptr) {
      std::fputs(text.c_str(), out);
      std::fflush(out);
    }
}

/// Ends the run on all ranks with the line "ERROR: COMMAND: fault" if rank 0 has found a fault. Collective.
inline void end_if(const LAMMPS *lmp, const std::string &command, std::string fault) {
  auto length = static_cast<int>(fault.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, lmp->world);
  if (length == 0) return;
  fault.resize(static_cast<std::size_t>(length));
  MPI_Bcast(fault.data(), length, MPI_CHAR, 0, lmp->world);
  lmp->error->all(FLERR, engine::as_is(command + ": " + fault));
}

/// A fix by its ID, or nullptr.
inline LAMMPS_NS::Fix *find_fix(LAMMPS_NS::Modify *modify, const std::string &id) {
  const int index =
      modify->find_fix(id.c_str()); // NOLINT(readability-redundant-string-cstr): LIGGGHTS's wants it
  return index < 0 ? nullptr : modify->fix[index];
}

/// Whether this rank speaks for a pair of the contact law's neighbour list: the only one that has it, or that which owns the ball with the lower ID.
inline bool speaks_for(const LAMMPS *lmp, int i, int j) {
  const LAMMPS_NS::Atom &atom = *lmp->atom;
  return lmp->force->newton_pair || (atom.tag[i] < atom.tag[j] ? i : j) < atom.nlocal;
}

/// Index of a neighbour without the bits that the engine packs into it.
inline int neighbour_index(int packed) { return packed & NEIGHMASK; }

/// The sums of force, N, x to z, that a fix freeze or setforce has taken from this rank's balls in this step and gives as its
/// output; nullptr for another fix.
double *reaction(LAMMPS_NS::Fix *fix);

} // namespace drumlin::engine
