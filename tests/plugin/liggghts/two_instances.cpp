// Two LAMMPS instances in one process, through the library interface. Arguments: liblammps.so, plugin, deck, its lines, and `after` or
// `beside`: whether the first is closed before the second runs. Each writes INSTANCE.txt.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <string>

int main(int narg, char **arg) {
  void *engine = narg == 6 ? dlopen(arg[1], RTLD_NOW | RTLD_GLOBAL) : nullptr;
  if (engine == nullptr) return 2;
  const auto open = reinterpret_cast<void *(*)(int, char **, void **)>(dlsym(engine, "lammps_open_no_mpi"));
  const auto file = reinterpret_cast<void (*)(void *, const char *)>(dlsym(engine, "lammps_file"));
  const auto failed = reinterpret_cast<int (*)(void *)>(dlsym(engine, "lammps_has_error"));
  const auto close = reinterpret_cast<void (*)(void *)>(dlsym(engine, "lammps_close"));
  const auto run = [&](const char *name) {
    std::array<std::string, 12> words = {"lmp",  "-log",  "none", "-var", "plugin",   arg[2],
                                         "-var", "lines", arg[4], "-var", "instance", name};
    std::array<char *, 12> pointers{};
    for (std::size_t n = 0; n < words.size(); ++n)
      pointers.at(n) = words.at(n).data();
    void *instance = open(12, pointers.data(), nullptr);
    file(instance, arg[3]); // at an error LAMMPS ends the process; since 2024 it returns instead
    if (failed(instance) != 0) std::exit(1);
    return instance;
  };
  void *first = run("first");
  if (std::string(arg[5]) == "after") close(first);
  void *second = run("second");
  close(second);
  if (std::string(arg[5]) != "after") close(first);
  return 0;
}
