// A library that looks like an engine to the preloaded stub: it exports the symbol by which the stub enters,
// and for LIGGGHTS the one by which it knows that engine. For LAMMPS it has the part of the C interface that
// the library of `plugin load` asks: a version that the environment names, usual sizes of numbers, no
// package.
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace LAMMPS_NS {
struct Input {
  void file();
};
void Input::file() { std::puts("the engine runs"); }
} // namespace LAMMPS_NS

#ifdef FAKE_LIGGGHTS
namespace LIGGGHTS::PairStyles {
struct Factory {
  static Factory &instance();
};
Factory &Factory::instance() {
  static Factory factory;
  return factory;
}
} // namespace LIGGGHTS::PairStyles
#else
extern "C" {
int lammps_version(void *) {
  const char *version = std::getenv("FAKE_VERSION");
  return version == nullptr ? 0 : std::atoi(version);
}
int lammps_extract_setting(void *, const char *name) { return std::strcmp(name, "tagint") == 0 ? 4 : 8; }
int lammps_config_has_package(const char *) { return 0; }
}
#endif
