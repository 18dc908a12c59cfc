// A library that looks like an engine to the preloaded stub: it exports the symbol by which the stub enters,
// and for LIGGGHTS the one by which it knows that engine.
#include <cstdio>

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
#endif
