#pragma once
// Functions on an engine whose source is the same for LIGGGHTS and LAMMPS. Each engine's engine.h includes
// this header at its end, after the names that differ.

namespace drumlin::engine {

/// Writes a text to the screen and the log file, without delay. Any rank may call it; rank 0 writes.
/// \param text with its line ends
inline void log_message(const LAMMPS *lmp, const std::string &text) {
  if (lmp->comm->me != 0) return;
  for (FILE *out : {lmp->screen, lmp->logfile})
    if (out != nullptr) {
      std::fputs(text.c_str(), out);
      std::fflush(out);
    }
}

/// Notes why the run ends before its time, in the parameters that fix drumlin/outputs knows.
void note_end(const LAMMPS *lmp, const std::string &why);

/// Whether the run continues a stopped one, as drumlin/read has found.
bool continues(LAMMPS *lmp);

/// Ends the run on all ranks with the line "ERROR: TEXT", and notes it in the run's parameters. Collective.
inline void stop(const LAMMPS *lmp, const std::string &text) {
  note_end(lmp, text);
  lmp->error->all(FLERR, engine::error_text(text));
}

/// A text of rank 0 on all ranks: only one rank needs to see a file. Collective.
inline std::string from_rank_0(const LAMMPS *lmp, std::string text) {
  auto length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, lmp->world);
  text.resize(static_cast<std::size_t>(length));
  MPI_Bcast(text.data(), length, MPI_CHAR, 0, lmp->world);
  return text;
}

/// Ends the run on all ranks with the line "ERROR: COMMAND: FAULT" if rank 0 has found a fault. Collective.
/// \param fault on rank 0 "KEYWORD is 'VALUE'; allowed: WHAT", or empty if all is well; ignored on other
/// ranks
inline void stop_on_fault(const LAMMPS *lmp, const std::string &command, const std::string &fault) {
  if (const std::string shared = from_rank_0(lmp, fault); !shared.empty()) stop(lmp, command + ": " + shared);
}

/// The bit of a group, by its number, in the masks of balls: both engines number bits as groups. (LAMMPS
/// means to hide its list of bits.)
inline int group_bit(int group) { return 1 << group; }

/// Whether a pair of balls of the contact law's neighbour list is counted on this rank, so that sums and
/// tables over all ranks have each pair once. With newton off a pair across ranks is in the lists of both: it
/// counts where the ball with the lower ID is owned.
/// \param i, j indices of owned balls or ghosts
inline bool owns_pair(const LAMMPS *lmp, int i, int j) {
  const LAMMPS_NS::Atom &atom = *lmp->atom;
  return lmp->force->newton_pair || (atom.tag[i] < atom.tag[j] ? i : j) < atom.nlocal;
}

/// Replaces a stored mass by the present sum over a group, unless these differ by rounding only: the sum
/// depends on the order of the balls in memory. A group whose balls are lost keeps its mass.
inline void follow_mass(double &stored, double now) {
  constexpr double rounding = 1e-12;
  if (now > 0.0 && std::fabs(now - stored) > rounding * stored) stored = now;
}

/// Index of a neighbour from an entry of a neighbour list, without the flags that the engine packs into its
/// highest bits.
inline int neighbour_index(int packed) { return packed & NEIGHMASK; }

/// The sum of the forces, N, x to z, that a fix freeze or setforce has removed from this rank's balls in this
/// step, which is the fix's output; nullptr for a fix of another style.
double *reaction(LAMMPS_NS::Fix *fix);

} // namespace drumlin::engine
