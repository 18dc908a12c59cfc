// The library that `plugin load` loads. It uses no symbols of the engine, so that every LAMMPS can load it.
// If the engine is the one that the plugin is built for it loads libdrumlin-lammps.so, otherwise it ends the
// process with the reason. (LAMMPS itself would print a warning on an undefined symbol and continue without
// the plugin.)

#include "stub.h"

#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <string>

namespace {

using drumlin::find_function;
using drumlin::stop;

/// The number that lammps_version() returns for a date: 20210929 for "29 Sep 2021".
int version_number(const char *date) {
  constexpr const char *months = "JanFebMarAprMayJunJulAugSepOctNovDec";
  char *end = nullptr;
  const long day = std::strtol(date, &end, 10);
  const std::string month(end + 1, 3);
  const long year = std::strtol(end + 4, nullptr, 10);
  const char *found = std::strstr(months, month.c_str());
  return static_cast<int>(year * 10000 + ((found - months) / 3 + 1) * 100 + day);
}

/// Ends the process if the plugin cannot be used with this engine.
void check_engine(void *lmp) {
  auto *version = find_function<int (*)(void *)>("lammps_version");
  auto *setting = find_function<int (*)(void *, const char *)>("lammps_extract_setting");
  if (version == nullptr || setting == nullptr) stop("this process does not export LAMMPS's C interface");
  const std::string built_for = std::string("built for LAMMPS ") + LAMMPS_VERSION;
  const int built = version_number(LAMMPS_VERSION);
  if (version(lmp) != built)
    stop(built_for + " (" + std::to_string(built) + "), but this is " + std::to_string(version(lmp)) +
         "; allowed: the version that it is built for, as ./drumlin setup lammps builds it in a checkout");
  if (setting(lmp, "tagint") != 4 || setting(lmp, "bigint") != 8)
    stop(built_for + " with -DLAMMPS_SIZES=SMALLBIG, its default, but this one has other sizes of numbers");
  auto *has_package = find_function<int (*)(const char *)>("lammps_config_has_package");
  if (has_package != nullptr && has_package("GRANULAR") == 0)
    stop("this LAMMPS has no package GRANULAR; allowed: one built with -DPKG_GRANULAR=ON, as ./drumlin setup "
         "lammps builds it in a checkout");
}

} // namespace

extern "C" __attribute__((visibility("default"))) void lammpsplugin_init(void *lmp, void *handle,
                                                                         void *register_function) {
  check_engine(lmp);
  Dl_info self{};
  dladdr(reinterpret_cast<const void *>(&lammpsplugin_init), &self);
  const std::string file = self.dli_fname;
  const std::string plugin = file.substr(0, file.find_last_of('/') + 1) + "libdrumlin-lammps.so";
  void *library = dlopen(plugin.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) stop(std::string("cannot load the plugin: ") + dlerror());
  using Register = void (*)(void *, void *, void *);
  reinterpret_cast<Register>(dlsym(library, "drumlin_register"))(lmp, handle, register_function);
}
