// The library that users preload. It uses no symbols of the engine, so that it can be in the LD_PRELOAD of
// any program. In a process that runs an engine it loads the plugin that is built for this engine, or ends
// the process with the reason why it cannot; other programs run unchanged.
//
// The engine's main program calls LAMMPS_NS::Input::file() through the dynamic linker, which finds the
// function of that name in this library first. It lets the plugin register its styles with the Input object
// and then calls the engine's function. The command `clear` makes new lists of styles and then calls
// LAMMPS_NS::LAMMPS::post_create(); in the same way this library replaces that function, to register the
// styles again.

// Used for the layout of two classes only.
#include "lammps.h"
#include "pointers.h"
#include "universe.h"

#include "stub.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <string>

namespace {

using drumlin::stop;

constexpr const char *input_file_symbol = "_ZN9LAMMPS_NS5Input4fileEv";
constexpr const char *post_create_symbol = "_ZN9LAMMPS_NS6LAMMPS11post_createEv";
constexpr const char *special_messages_symbol = "_ZN9LAMMPS_NS15SpecialMessagesC1EPNS_6LAMMPSE";
constexpr const char *liggghts_symbol = "_ZN8LIGGGHTS10PairStyles7Factory8instanceEv";

/// The file that defines a symbol, with symbolic links resolved: the name of the engine's library then ends
/// with its full version.
std::string real_file_of(const void *address) {
  Dl_info info{};
  if (dladdr(address, &info) == 0 || info.dli_fname == nullptr) return {};
  char *resolved = realpath(info.dli_fname, nullptr);
  std::string path = resolved != nullptr ? resolved : info.dli_fname;
  std::free(resolved);
  return path;
}

bool ends_with(const std::string &text, const std::string &end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string base_name(const std::string &path) { return path.substr(path.find_last_of('/') + 1); }

using Register = void (*)(void *input);
using RegisterAgain = void (*)(void *engine);

RegisterAgain register_again = nullptr; // nullptr before the plugin is loaded

/// Loads the plugin's library and returns its handle. On failure it returns nullptr and sets `why` to the
/// reason.
void *open_plugin(std::string &why) {
  const std::string self = real_file_of(reinterpret_cast<const void *>(&open_plugin));
  const std::string plugin = self.substr(0, self.find_last_of('/') + 1) + "libdrumlin-liggghts.so";
  void *handle = dlopen(plugin.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) {
    const char *reason = dlerror();
    why = std::string("cannot load the plugin: ") + (reason ? reason : "unknown reason");
  }
  return handle;
}

/// Loads the plugin and returns its function drumlin_register(). On failure it returns nullptr and sets `why`
/// to the reason.
Register load_plugin(const void *engine_input_file, std::string &why) {
  const std::string engine = real_file_of(engine_input_file);
  const std::string built_for = std::string("LIGGGHTS ") + LIGGGHTS_VERSION;
  if (dlsym(RTLD_DEFAULT, liggghts_symbol) == nullptr) {
    why = "built for " + built_for + ", but this process runs another engine (" + base_name(engine) +
          "); take the preload away, or use 'plugin load' with the library built for LAMMPS";
    return nullptr;
  }
  // A library that users have built themselves may have no version in its file name; drumlin_register() then
  // checks the engine's own.
  if (engine.find(".so.") != std::string::npos &&
      !ends_with(engine, std::string(".so.") + LIGGGHTS_VERSION)) {
    why = "built for " + built_for + ", but this process runs " + base_name(engine) +
          "; build drumlin against the installed version";
    return nullptr;
  }
  void *handle = open_plugin(why);
  if (handle == nullptr) return nullptr;
  register_again = reinterpret_cast<RegisterAgain>(dlsym(handle, "drumlin_register_again"));
  return reinterpret_cast<Register>(dlsym(handle, "drumlin_register"));
}

using Main = int (*)(int, char **, char **);

/// Whether the engine is part of the program itself, which exports its symbols.
bool is_engine(Main program) {
  const void *engine = dlsym(RTLD_DEFAULT, liggghts_symbol);
  Dl_info of_engine{};
  Dl_info of_program{};
  return engine != nullptr && dladdr(engine, &of_engine) != 0 &&
         dladdr(reinterpret_cast<const void *>(program), &of_program) != 0 &&
         of_engine.dli_fbase == of_program.dli_fbase;
}

/// The variables of the engine's LAMMPS_NS::SignalHandler; nullptr in other programs.
struct {
  bool *quit = nullptr, *write_restart = nullptr, *may_write_restart = nullptr;
} requests;

void find_requests() {
  const auto find = [](const char *name) { return static_cast<bool *>(dlsym(RTLD_DEFAULT, name)); };
  requests = {find("_ZN9LAMMPS_NS13SignalHandler12request_quitE"),
              find("_ZN9LAMMPS_NS13SignalHandler21request_write_restartE"),
              find("_ZN9LAMMPS_NS13SignalHandler22enable_restart_writingE")};
}

void request_restart() {
  if (requests.write_restart != nullptr && requests.may_write_restart != nullptr &&
      *requests.may_write_restart)
    *requests.write_restart = true;
}

} // namespace

// Replace the engine's LAMMPS_NS::SignalHandler::int_handler() and usr1_handler(), which allocate memory: a
// signal that comes within malloc(), as most do while the engine starts, would wait for its lock for ever.
extern "C" __attribute__((visibility("default"))) void
drumlin_int_handler(int) __asm__("_ZN9LAMMPS_NS13SignalHandler11int_handlerEi");

void drumlin_int_handler(int) {
  if (requests.quit == nullptr || *requests.quit) std::_Exit(EXIT_FAILURE); // the second signal
  request_restart();
  *requests.quit = true;
}

extern "C" __attribute__((visibility("default"))) void
drumlin_usr1_handler(int) __asm__("_ZN9LAMMPS_NS13SignalHandler12usr1_handlerEi");

void drumlin_usr1_handler(int) { request_restart(); }

namespace {

/// The plugin's main program for an engine that is one program.
int run_engine(int argc, char **argv, char **) {
  for (const int number : {SIGINT, SIGTERM}) // a scheduler's SIGTERM is handled as Ctrl-C
    std::signal(number, drumlin_int_handler);
  std::signal(SIGUSR1, drumlin_usr1_handler);
  std::string why;
  void *handle = open_plugin(why);
  if (handle == nullptr) stop(why);
  return reinterpret_cast<int (*)(int, char **)>(dlsym(handle, "drumlin_main"))(argc, argv);
}

/// Finds what the handlers of signals need, and sets standard output of an engine to line buffering: when it
/// is redirected, the texts of error->one() would be lost otherwise. The environment variable keeps Open MPI
/// in this process from adding eight lines on MPI_Abort to each error; messages of mpirun are not affected.
__attribute__((constructor)) void prepare_engine() {
  if (dlsym(RTLD_DEFAULT, liggghts_symbol) == nullptr) return;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  find_requests();
  ::setenv("OMPI_MCA_orte_execute_quiet", "1", 0); // NOLINT(concurrency-mt-unsafe): before main()
}

/// A substitute for the engine that has only what SpecialMessages reads: the version in its `universe`, which
/// is empty here.
LAMMPS_NS::LAMMPS *without_version() {
  alignas(LAMMPS_NS::Universe) static char universe[sizeof(LAMMPS_NS::Universe)] = {};
  alignas(LAMMPS_NS::LAMMPS) static char engine[sizeof(LAMMPS_NS::LAMMPS)] = {};
  static char no_version[] = "";
  reinterpret_cast<LAMMPS_NS::Universe *>(universe)->version = no_version;
  auto *stand_in = reinterpret_cast<LAMMPS_NS::LAMMPS *>(engine);
  stand_in->universe = reinterpret_cast<LAMMPS_NS::Universe *>(universe);
  return stand_in;
}

} // namespace

// Replaces the engine's LAMMPS_NS::Input::file().
extern "C" __attribute__((visibility("default"))) void
drumlin_input_file(void *input) __asm__("_ZN9LAMMPS_NS5Input4fileEv");

void drumlin_input_file(void *input) {
  using InputFile = void (*)(void *);
  static const auto engine_input_file = reinterpret_cast<InputFile>(dlsym(RTLD_NEXT, input_file_symbol));
  if (engine_input_file == nullptr)
    stop("the engine's Input::file() is not in a shared library; it cannot be extended");
  std::string why;
  const Register registration = load_plugin(reinterpret_cast<const void *>(engine_input_file), why);
  if (registration == nullptr) stop(why);
  registration(input);
  // After a signal the engine finishes the present command, ignores the rest of the deck and exits with
  // status 0. That must be an error.
  const auto stop_if_told = [] {
    if (requests.quit != nullptr && *requests.quit) stop("stopped by a signal before the end of the deck");
  };
  stop_if_told();
  engine_input_file(input);
  stop_if_told();
}

// Replaces the engine's LAMMPS_NS::LAMMPS::post_create(). Before the plugin is loaded it only calls the
// engine's function.
extern "C" __attribute__((visibility("default"))) void
drumlin_post_create(void *engine) __asm__("_ZN9LAMMPS_NS6LAMMPS11post_createEv");

void drumlin_post_create(void *engine) {
  using PostCreate = void (*)(void *);
  static const auto engine_post_create = reinterpret_cast<PostCreate>(dlsym(RTLD_NEXT, post_create_symbol));
  if (engine_post_create == nullptr)
    stop("the engine's LAMMPS::post_create() is not in a shared library; it cannot be extended");
  if (register_again != nullptr) register_again(engine);
  engine_post_create(engine);
}

// Replaces the function of the C library that calls main(). It starts run_engine() instead in an engine that
// is one program and exports its symbols; in all other programs it calls their main().
extern "C" __attribute__((visibility("default"))) int
drumlin_start(Main program, int argc, char **argv, void (*init)(), void (*fini)(), void (*rtld_fini)(),
              void *stack_end) __asm__("__libc_start_main");

int drumlin_start(Main program, int argc, char **argv, void (*init)(), void (*fini)(), void (*rtld_fini)(),
                  void *stack_end) {
  const auto start = reinterpret_cast<decltype(&drumlin_start)>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(is_engine(program) ? &run_engine : program, argc, argv, init, fini, rtld_fini, stack_end);
}

// Replaces the engine's LAMMPS_NS::SpecialMessages::SpecialMessages(LAMMPS *). To about one error in five,
// chosen at random, the engine adds a second line (a joke or a tip), which it prints from freed memory, so
// that users see unreadable characters. It does so only if the version in its `universe` says PUBLIC.
extern "C" __attribute__((visibility("default"))) void
drumlin_special_messages(void *messages,
                         void *engine) __asm__("_ZN9LAMMPS_NS15SpecialMessagesC1EPNS_6LAMMPSE");

void drumlin_special_messages(void *messages, void *engine) {
  using Construct = void (*)(void *, void *);
  static const auto engine_construct = reinterpret_cast<Construct>(dlsym(RTLD_NEXT, special_messages_symbol));
  if (engine_construct == nullptr)
    return; // cannot happen: only the engine calls this, and it has the function
  const bool known = ends_with(real_file_of(reinterpret_cast<const void *>(engine_construct)),
                               std::string(".so.") + LIGGGHTS_VERSION);
  engine_construct(messages, known ? without_version() : engine);
}
