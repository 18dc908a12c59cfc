// The program of the fake engines. Without arguments it calls Input::file() as an engine does to read its
// deck; given the file name of a library, it first loads that library as the command `plugin load` of LAMMPS
// does.
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
