/// The boundaries of the project, read from its sources: the include rule of ARCHITECTURE.md, and that every
/// source is named in a CMakeLists.txt.
#include "tests/support/prelude.h"

namespace {

namespace fs = std::filesystem;

const fs::path root = DRUMLIN_SOURCE_DIR;

struct Include {
  std::string name;
  bool quoted; ///< "name", not <name>
};

std::vector<Include> includes_of(const std::string &text) {
  static const std::regex line(R"re((?:^|\n)[ \t]*#[ \t]*include[ \t]*([<"])([^>"\n]+)[>"])re");
  std::vector<Include> found;
  for (std::sregex_iterator i(text.begin(), text.end(), line), end; i != end; ++i)
    found.push_back({(*i)[2].str(), (*i)[1].str() == "\""});
  return found;
}

bool starts_with(const std::string &text, const std::string &start) { return text.rfind(start, 0) == 0; }

bool is_standard(const Include &include) {
  static const std::string headers =
      " algorithm any array atomic bitset cassert cctype cerrno cfenv cfloat charconv chrono cinttypes "
      "climits clocale cmath codecvt complex condition_variable csetjmp csignal cstdarg cstddef cstdint "
      "cstdio cstdlib cstring ctime cuchar cwchar cwctype deque exception execution filesystem forward_list "
      "fstream functional future initializer_list iomanip ios iosfwd iostream istream iterator limits list "
      "locale map memory memory_resource mutex new numeric optional ostream queue random ratio regex "
      "scoped_allocator set shared_mutex sstream stack stdexcept streambuf string string_view system_error "
      "thread tuple type_traits typeindex typeinfo unordered_map unordered_set utility valarray variant "
      "vector ";
  return !include.quoted && headers.find(" " + include.name + " ") != std::string::npos;
}

/// The level of a room: it may include rooms of lower levels, and itself. A folder within a room has a level
/// among the folders of that room, 0 if it is not named here: it may include its room's own headers and
/// folders of lower levels. What lies directly in a room may include all its folders.
using Heights = std::map<std::string, int>;
const Heights plugin_rooms{{"physics", 0},        {"support", 1},      {"contact", 2},
                           {"fixes", 3},          {"commands", 3},     {"liggghts", 4},
                           {"lammps", 4},         {"physics/laws", 0}, {"physics/scheme", 1},
                           {"physics/bodies", 2}, {"physics/files", 0}};
const Heights postprocess_rooms{{"support", 0},   {"engine", 1},      {"pages", 1},   {"runs", 2},
                                {"chain", 3},     {"bed", 3},         {"record", 4},  {"meter", 5},
                                {"identify", 6},  {"map", 7},         {"passes", 7},  {"experiment", 8},
                                {"advice", 9},    {"calibration", 9}, {"report", 10}, {"commands", 11},
                                {"report/bed", 1}};

/// "ROOM" and "FOLDER" of a path "ROOM/FOLDER/...", without the name of the file; empty where there is none.
std::pair<std::string, std::string> room_and_folder(const std::string &path) {
  const fs::path folders = fs::path(path).parent_path();
  std::vector<std::string> names;
  for (const fs::path &name : folders)
    names.push_back(name.string());
  names.resize(std::max<std::size_t>(2, names.size()));
  return {names[0], names[1]};
}

/// Whether a file may include a header, both by their paths from the top of the rooms, "ROOM/..." or
/// "ROOM/FOLDER/...".
bool fits_room(const std::string &file, const std::string &header, const Heights &rooms) {
  if (header.find("..") != std::string::npos) return false;
  const auto [room, folder] = room_and_folder(file);
  const auto [other, its_folder] = room_and_folder(header);
  if (rooms.count(other) == 0) return false;
  if (other != room) return rooms.at(other) < rooms.at(room);
  if (folder.empty() || its_folder.empty() || folder == its_folder) return true;
  const auto level = [&rooms](const std::string &name) {
    const auto found = rooms.find(name);
    return found == rooms.end() ? 0 : found->second;
  };
  return level(room + "/" + its_folder) < level(room + "/" + folder);
}

/// Readers of files that a user writes for plugin and tools, the only code that both share: physics/files,
/// which the tools name without `physics`.
bool is_shared_reader(const std::string &header) {
  return starts_with(header, "files/") && header.find("..") == std::string::npos &&
         fs::exists(root / "plugin/physics" / header);
}

bool fits_postprocess(const std::string &file, const std::string &header) {
  return is_shared_reader(header) || fits_room(file, header, postprocess_rooms);
}

/// What lies directly in physics/ is included by all its folders, and so includes none of them.
bool fits_physics(const std::string &file, const Include &include) {
  if (is_standard(include)) return true;
  // Readers of files are included by the tools, too, without the rest of physics: they name each other by
  // name.
  if (starts_with(file, "physics/files/")) return include.quoted && is_shared_reader("files/" + include.name);
  if (!include.quoted || !starts_with(include.name, "physics/")) return false;
  if (room_and_folder(file).second.empty() && !room_and_folder(include.name).second.empty()) return false;
  return fits_room(file, include.name, plugin_rooms);
}

/// Rooms between the core and the adapters know an engine through engine.h alone; libraries that are no
/// engine's are named here.
bool fits_shared(const std::string &file, const Include &include) {
  if (include.quoted) return include.name == "engine.h" || fits_room(file, include.name, plugin_rooms);
  return is_standard(include) || starts_with(include.name, "fmt/") || starts_with(include.name, "sys/") ||
         include.name == "unistd.h" || include.name == "fcntl.h";
}

/// An adapter may include any header of its engine as well, which the plugin does not have, but not the other
/// adapter.
bool fits_adapter(const std::string &file, const Include &include) {
  if (include.name.find("..") != std::string::npos) return false;
  if (!include.quoted || include.name == "stub.h") return true;
  if (plugin_rooms.count(include.name.substr(0, include.name.find('/'))) == 1)
    return fits_room(file, include.name, plugin_rooms);
  return !fs::exists(root / "plugin" / include.name);
}

/// The post-processor judges what the plugin does, and so do the oracles: they share no code with it but the
/// readers of a user's files.
bool fits_judge(const Include &include) {
  if (!include.quoted) return !starts_with(include.name, "physics/") && !starts_with(include.name, "plugin/");
  if (include.name.find("..") != std::string::npos) return false;
  if (is_shared_reader(include.name)) return true;
  if (starts_with(include.name, "tests/support/") || starts_with(include.name, "tests/tools/"))
    return fs::exists(root / include.name);
  return fs::exists(root / "postprocess" / include.name);
}

std::string without_comments(const std::string &cmake) { // "#" to the end of its line
  return std::regex_replace(cmake, std::regex("#[^\n]*"), "");
}

bool globs(const std::string &cmake) {
  static const std::regex call(R"re(file[ \t\n]*\([ \t\n]*GLOB|aux_source_directory[ \t\n]*\()re",
                               std::regex::icase);
  return std::regex_search(without_comments(cmake), call);
}

/// Members of LAMMPS's Modify and Group that releases of autumn 2026 hide or remove, or are to hide.
bool uses_hidden_lists(const std::string &source) {
  static const std::regex use(
      R"re(\b(nfix|ncompute|fmask)\b|modify(\.|->)((fix|compute)\[|find_(fix|compute)\()|group(\.|->)bitmask\b)re");
  return std::regex_search(source, use);
}

std::string text_of(const fs::path &file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

bool is_source(const fs::path &file) {
  static const std::set<std::string> endings{".h",   ".hpp", ".hh",  ".cpp", ".cc",
                                             ".cxx", ".c",   ".ipp", ".inl"};
  return endings.count(file.extension().string()) == 1;
}

bool is_cmake(const fs::path &file) {
  return file.filename() == "CMakeLists.txt" || file.extension() == ".cmake";
}

/// Files below `folder` of the project, without build trees and hidden folders.
std::vector<fs::path> files(const fs::path &folder, const std::function<bool(const fs::path &)> &wanted) {
  std::vector<fs::path> found;
  if (!fs::exists(root / folder)) return found;
  for (auto i = fs::recursive_directory_iterator(root / folder); i != fs::recursive_directory_iterator();
       ++i) {
    const std::string name = i->path().filename().string();
    if (i->is_directory() &&
        (starts_with(name, "build") || starts_with(name, ".") || fs::exists(i->path() / "CMakeCache.txt")))
      i.disable_recursion_pending();
    else if (i->is_regular_file() && wanted(i->path()))
      found.push_back(i->path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// \param fit gets the path of a file from the top folder of `folder`, and what it includes
void expect_includes(const fs::path &folder,
                     const std::function<bool(const std::string &, const Include &)> &fit) {
  const std::vector<fs::path> sources = files(folder, is_source);
  ASSERT_FALSE(sources.empty()) << folder;
  for (const fs::path &file : sources)
    for (const Include &include : includes_of(text_of(file)))
      EXPECT_TRUE(fit(file.lexically_relative(root / *folder.begin()).generic_string(), include))
          << file.lexically_relative(root).string() << " includes " << include.name;
}

/// Folders below `folder` that hold sources, at any depth, by their first name.
std::set<std::string> rooms_of(const fs::path &folder) {
  std::set<std::string> rooms;
  for (const fs::path &file : files(folder, is_source)) {
    const fs::path inside = file.lexically_relative(root / folder);
    if (std::distance(inside.begin(), inside.end()) > 1) rooms.insert(inside.begin()->string());
  }
  return rooms;
}

TEST(Boundaries, ThePhysicsCoreIncludesTheStandardLibraryOnly) {
  for (const fs::path &file : files("plugin/physics", is_source)) {
    const std::string name = file.lexically_relative(root / "plugin").string();
    const std::string folder = room_and_folder(name).second;
    ASSERT_TRUE(folder.empty() || plugin_rooms.count("physics/" + folder) == 1) << file;
    for (const Include &include : includes_of(text_of(file)))
      EXPECT_TRUE(fits_physics(name, include)) << file << " includes " << include.name;
  }
  for (const fs::path &file : files("plugin/physics", is_source))
    for (const Include &include : includes_of(text_of(file)))
      if (include.quoted) {
        EXPECT_TRUE(fs::exists(root / "plugin" / include.name) ||
                    fs::exists(file.parent_path() / include.name))
            << file << " " << include.name;
      }
}

TEST(Boundaries, RoomsOfThePluginIncludeWhatIsBelowThem) {
  for (const std::string &room : rooms_of("plugin")) {
    ASSERT_EQ(plugin_rooms.count(room), 1U) << room;
    if (room == "physics") continue; // the test above is stricter
    const bool adapter = room == "liggghts" || room == "lammps";
    expect_includes(fs::path("plugin") / room, [&](const std::string &file, const Include &include) {
      if (room == "physics") return fits_physics(file, include);
      return adapter ? fits_adapter(file, include) : fits_shared(file, include);
    });
  }
}

TEST(Boundaries, RoomsOfThePostprocessorIncludeWhatIsBelowThem) {
  for (const std::string &room : rooms_of("postprocess")) {
    ASSERT_EQ(postprocess_rooms.count(room), 1U) << room;
    expect_includes(fs::path("postprocess") / room, [](const std::string &file, const Include &include) {
      return !include.quoted || fits_postprocess(file, include.name);
    });
  }
}

// All types of the tools are in one namespace: two of one name would be one type for the linker.
TEST(Boundaries, NoTwoHeadersOfThePostprocessorDefineATypeOfOneName) {
  static const std::regex definition(R"re(\n(?:struct|class|enum class|enum) (\w+)[^;\n]*\{)re");
  std::map<std::string, std::string> defined;
  for (const fs::path &file : files("postprocess", is_source)) {
    if (file.extension() != ".h") continue;
    const std::string text = text_of(file), name = file.lexically_relative(root).string();
    for (std::sregex_iterator i(text.begin(), text.end(), definition), end; i != end; ++i) {
      const auto [other, first] = defined.emplace((*i)[1].str(), name);
      EXPECT_TRUE(first) << (*i)[1] << " in " << name << " and " << other->second;
    }
  }
  EXPECT_GT(defined.size(), 100U);
}

// Sources of a room are compiled together (CMAKE_UNITY_BUILD): a constant of one would take the place of a
// header's in all others, without a word of the compiler.
TEST(Boundaries, ConstantsOfSourcesHideNoneOfHeaders) {
  static const std::regex constant(
      R"re(\n(?:inline |static )?(?:constexpr|const) [^=;({\n]*[ *&](\w+)(?:\[\w*\])? *[={;])re");
  std::map<std::string, std::string> of_headers;
  std::vector<std::pair<std::string, std::string>> of_sources; // name, file
  for (const fs::path &file : files("postprocess", is_source)) {
    const std::string text = text_of(file), path = file.lexically_relative(root).string();
    for (std::sregex_iterator i(text.begin(), text.end(), constant), end; i != end; ++i)
      if (file.extension() == ".h")
        of_headers.emplace((*i)[1].str(), path);
      else
        of_sources.emplace_back((*i)[1].str(), path);
  }
  EXPECT_GT(of_headers.size(), 50U);
  EXPECT_GT(of_sources.size(), 200U);
  for (const auto &[name, file] : of_sources)
    EXPECT_EQ(of_headers.count(name), 0U) << name << " in " << file << " and " << of_headers[name];
}

TEST(Boundaries, ThePostprocessorAndItsTestsKnowNothingOfThePlugin) {
  for (const char *folder : {"tests/tools", "tests/pages", "tests/nightly", "postprocess", "tests/support"})
    expect_includes(folder, [](const std::string &, const Include &include) { return fits_judge(include); });
  for (const char *folder : {"tests/tools", "tests/pages", "postprocess"})
    for (const fs::path &file : files(folder, is_cmake)) {
      const std::string text = without_comments(text_of(file));
      EXPECT_EQ(text.find("drumlin_physics"), std::string::npos) << file;
      EXPECT_EQ(text.find("/plugin"), std::string::npos) << file;
    }
}

TEST(Boundaries, ListsThatLammpsHidesAreKnownToOneHeader) {
  for (const fs::path &file : files("plugin", is_source)) {
    const std::string name = file.lexically_relative(root / "plugin").string();
    if (name == "lammps/lammps_version.h" || starts_with(name, "liggghts/")) continue;
    EXPECT_FALSE(uses_hidden_lists(text_of(file))) << name;
  }
}

TEST(Boundaries, EverySourceIsNamedNotGlobbed) {
  const std::vector<fs::path> lists = files(".", is_cmake);
  ASSERT_GE(lists.size(), 5U);
  for (const fs::path &file : lists)
    EXPECT_FALSE(globs(text_of(file))) << file;
}

// The checks above would also pass if they found no include lines at all. Here they must find and refuse
// some.
TEST(BoundaryChecks, ReadIncludeLines) {
  const auto found =
      includes_of("#include <cmath>\n  #  include \"engine.h\" // why\n// #include <no>\n#include <a/b.h>");
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].name, "cmath");
  EXPECT_FALSE(found[0].quoted);
  EXPECT_EQ(found[1].name, "engine.h");
  EXPECT_TRUE(found[1].quoted);
  EXPECT_EQ(found[2].name, "a/b.h");
}

TEST(BoundaryChecks, RefuseWhatDoesNotFit) {
  EXPECT_TRUE(fits_physics("physics/laws/file.h", {"cmath", false}));
  EXPECT_TRUE(fits_physics("physics/laws/file.h", {"physics/parameter_checks.h", true}));
  EXPECT_TRUE(fits_physics("physics/laws/file.h", {"physics/laws/contact_law.h", true}));
  EXPECT_TRUE(fits_physics("physics/bodies/file.h", {"physics/scheme/advance.h", true}));
  EXPECT_FALSE(fits_physics("physics/laws/file.h", {"physics/scheme/advance.h", true}));
  EXPECT_FALSE(fits_physics("physics/scheme/file.h", {"physics/bodies/excitation.h", true}));
  EXPECT_FALSE(fits_physics("physics/files/roller.h", {"physics/vec3.h", true}));
  EXPECT_FALSE(fits_physics("physics/vec3.h", {"physics/laws/contact_law.h", true}));
  for (const char *name : {"math.h", "Eigen/Dense", "mpi.h", "vtkPoints.h", "unistd.h", "cvode/cvode.h"})
    EXPECT_FALSE(fits_physics("physics/scheme/file.h", {name, false})) << name;
  for (const char *name : {"engine.h", "fixes/clock.h", "../fixes/clock.h", "physics/../engine.h", "cmath"})
    EXPECT_FALSE(fits_physics("physics/scheme/file.h", {name, true})) << name;

  EXPECT_TRUE(fits_shared("fixes/fix_guard.cpp", {"engine.h", true}));
  EXPECT_TRUE(fits_shared("fixes/fix_guard.cpp", {"physics/laws/contact_law.h", true}));
  EXPECT_TRUE(fits_shared("fixes/fix_guard.cpp", {"fixes/fix_guard.h", true}));
  for (const char *name : {"atom.h", "liggghts/engine.h", "lammps/engine.h", "../liggghts/engine.h", "fix.h",
                           "commands/commands.h"}) {
    EXPECT_FALSE(fits_shared("fixes/fix_guard.cpp", {name, true})) << name;
    EXPECT_FALSE(fits_shared("fixes/fix_guard.cpp", {name, false})) << name;
  }
  EXPECT_FALSE(fits_shared("support/arguments.cpp", {"contact/pair_motion.h", true}));

  EXPECT_TRUE(fits_adapter("lammps/pair.cpp", {"pair.h", true}));
  EXPECT_TRUE(fits_adapter("lammps/pair.cpp", {"fixes/fix_guard.h", true}));
  EXPECT_FALSE(fits_adapter("lammps/pair.cpp", {"liggghts/pair_source.h", true}));

  EXPECT_TRUE(fits_postprocess("report/answer.cpp", "chain/analysis.h"));
  EXPECT_TRUE(fits_postprocess("report/report.cpp", "report/chain/tables.h"));
  for (const auto &[file, header] : {std::pair("chain/analysis.cpp", "report/run_folder.h"),
                                     {"meter/values.cpp", "identify/identification.h"},
                                     {"calibration/soil_tests.cpp", "report/soil/pages.h"},
                                     {"chain/analysis.cpp", "nowhere/run_folder.h"},
                                     {"report/chain/tables.cpp", "report/bed/page.h"}})
    EXPECT_FALSE(fits_postprocess(file, header)) << file << " " << header;

  EXPECT_TRUE(fits_judge({"cvode/cvode.h", false}));
  EXPECT_TRUE(fits_judge({"tests/support/ode.h", true}));
  EXPECT_TRUE(fits_judge({"chain/exact_solution.h", true}));
  for (const char *name :
       {"physics/laws/contact_law.h", "contact_law.h", "plugin/physics/laws/contact_law.h",
        "../../plugin/physics/laws/contact_law.h", "fixes/anything.h", "support/arguments.h"})
    EXPECT_FALSE(fits_judge({name, true})) << name;
  EXPECT_FALSE(fits_judge({"physics/laws/contact_law.h", false}));
  EXPECT_TRUE(fits_judge({"files/roller.h", true}));
  EXPECT_FALSE(fits_judge({"files/nothing.h", true}));
  EXPECT_FALSE(fits_judge({"physics/files/roller.h", true}));
  EXPECT_TRUE(fits_postprocess("chain/parameters.cpp", "files/roller.h"));

  EXPECT_TRUE(uses_hidden_lists("for (int n = 0; n < modify->nfix; ++n)"));
  EXPECT_TRUE(uses_hidden_lists("modify->find_fix(id) >= 0"));
  EXPECT_FALSE(uses_hidden_lists("engine::find_fix(modify, id) != nullptr"));

  EXPECT_TRUE(globs("file(GLOB sources *.cpp)"));
  EXPECT_TRUE(globs("file( glob_recurse s *.cpp)"));
  EXPECT_TRUE(globs("aux_source_directory(. s)"));
  EXPECT_FALSE(globs("# no file(GLOB ...) here\nadd_executable(a a.cpp)"));
}

} // namespace
