// LAMMPS instances in one process, through the library interface. Arguments: liblammps.so, plugin, deck, how.
// The deck reads the lines of an instance from NAME.lines; the variable `instance` is the NAME: first or
// second. how: one of the names, that instance alone; `after`, the second when the first is closed;
// `in_turns`, both open, a run of one after a run of the other.
#include <array>
#include <cstdlib>
#include <dlfcn.h>
#include <string>

int main(int narg, char **arg) {
  void *engine = narg == 5 ? dlopen(arg[1], RTLD_NOW | RTLD_GLOBAL) : nullptr;
  if (engine == nullptr) return 2;
  const auto open = reinterpret_cast<void *(*)(int, char **, void **)>(dlsym(engine, "lammps_open_no_mpi"));
  const auto file = reinterpret_cast<void (*)(void *, const char *)>(dlsym(engine, "lammps_file"));
  const auto command = reinterpret_cast<char *(*)(void *, const char *)>(dlsym(engine, "lammps_command"));
  const auto failed = reinterpret_cast<int (*)(void *)>(dlsym(engine, "lammps_has_error"));
  const auto close = reinterpret_cast<void (*)(void *)>(dlsym(engine, "lammps_close"));
  const auto check =
      [&](void *instance) { // at an error LAMMPS ends the process; since 2024 it returns instead
        if (failed(instance) != 0) std::exit(1);
      };
  const auto start = [&](const std::string &name) {
    std::array<std::string, 12> words = {"lmp",  "-log",  "none",          "-var", "plugin",   arg[2],
                                         "-var", "lines", name + ".lines", "-var", "instance", name};
    std::array<char *, 12> pointers{};
    for (std::size_t n = 0; n < words.size(); ++n)
      pointers.at(n) = words.at(n).data();
    void *instance = open(12, pointers.data(), nullptr);
    file(instance, arg[3]);
    check(instance);
    return instance;
  };
  const auto run = [&](void *instance) {
    command(instance, "run 400");
    check(instance);
  };
  const std::string how = arg[4];
  if (how == "in_turns") {
    void *first = start("first");
    void *second = start("second");
    for (int n = 0; n < 2; ++n)
      for (void *instance : {first, second})
        run(instance);
    close(first);
    run(second); // it outlives the one that has loaded the plugin
    close(second);
    return 0;
  }
  for (const char *name : {"first", "second"}) {
    if (how != "after" && how != name) continue;
    void *instance = start(name);
    for (int n = 0; n < (std::string(name) == "first" ? 2 : 3); ++n)
      run(instance);
    close(instance);
  }
  return 0;
}
