namespace LAMMPS_NS {
struct Input {
  void file();
};
} // namespace LAMMPS_NS

int main() {
  LAMMPS_NS::Input input;
  input.file();
}
