// Runs a deck, or, with the name of a library, loads that as `plugin load` does.
#include <cstdio>
#include <dlfcn.h>

namespace LAMMPS_NS {
struct Input {
  void file();
};
} // namespace LAMMPS_NS

int main(int argc, char **argv) {
  if (argc > 1) {
    void *library = dlopen(argv[1], RTLD_NOW);
    if (library == nullptr) {
      std::puts(dlerror());
      return 2;
    }
    reinterpret_cast<void (*)(void *, void *, void *)>(dlsym(library, "lammpsplugin_init"))(nullptr, library,
                                                                                            nullptr);
  }
  LAMMPS_NS::Input input;
  input.file();
}
