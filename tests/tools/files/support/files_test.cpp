// Files, processes, and results that continue.
#include "tests/support/engine_runs.h"
#include "tests/support/run_folders.h"
#include "support/process.h"
#include "support/resumed.h"
#include "support/usage_error.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>
#include <sys/wait.h>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

// Output files and folders that the tools can and cannot write. All files are made in a scratch folder, and a
// full disk is a small file system that the test mounts.
namespace files {

using post::Outcome;
using post::read_text;

class OutputFiles : public ::testing::Test {
protected:
  OutputFiles() {
    fs::create_directory(folder_ / "folder");
    put("file");
    put("read-only");
    ::chmod((folder_ / "read-only").c_str(), 0444);
    ::mkfifo((folder_ / "pipe").c_str(), 0600);
    // A node like /dev/null, for root only.
    has_device_ = ::mknod((folder_ / "device").c_str(), S_IFCHR | 0600, makedev(1, 3)) == 0;
    fs::create_symlink("file", folder_ / "link");
    fs::create_symlink("nowhere", folder_ / "dangling");
    fs::create_symlink("circle", folder_ / "circle");
    fs::create_symlink("pipe", folder_ / "link-to-pipe");
    fs::create_symlink("folder", folder_ / "link-to-folder");
  }
  void put(const std::string &name, const std::string &text = "earlier\n") const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  Outcome run(std::vector<std::string> words) const {
    words.insert(words.begin(), DRUMLIN_TOOLS);
    return post::run_program(words, {}, folder_);
  }
  /// The entries of the folder: type, mode, size, and the target of a link.
  std::string listing() const {
    const Outcome outcome = post::run_program(
        {"sh", "-c", "find . ! -name screen.txt -printf '%p %y %m %s %l\\n' | sort"}, {}, folder_);
    return outcome.output;
  }
  std::vector<std::string> no_files() const {
    std::vector<std::string> names = words_of("folder read-only pipe dangling circle link-to-pipe file/x");
    if (has_device_) names.emplace_back("device");
    return names;
  }

  const Scratch scratch_;
  const fs::path folder_ = scratch_.path();
  bool has_device_ = false;
};

TEST_F(OutputFiles, NothingButARegularFileIsReplaced) {
  const std::string before = listing();
  for (const std::string &name : no_files()) {
    SCOPED_TRACE(name);
    const Outcome bed = run({"bed", "--balls", "3", "--out", name});
    EXPECT_EQ(bed.status, 2) << bed.output;
    EXPECT_EQ(bed.output.rfind("ERROR: drumlin bed: --out is '" + name + "': ", 0), 0u) << bed.output;
    EXPECT_TRUE(printed(bed, "; allowed: a file that can be written\n"));
    EXPECT_NE(error_of([&] { post::write_files({{folder_ / name, "new"}}); }), "no error");
    EXPECT_NE(error_of([&] { post::append_text(folder_ / name, "new"); }), "no error");
    EXPECT_NE(error_of([&] { post::replace_file(folder_ / "file", folder_ / name); }), "no error");
    EXPECT_EQ(listing(), before);
  }
}

TEST_F(OutputFiles, FoldersOfResultsAreChecked) {
  put("run/parameters.csv", "name,value\ntimestep,0.1\n");
  put("run/dump/balls_0.vtp", ball_dump());
  const std::string before = listing();
  for (const std::string &name : no_files()) {
    if (name == "folder") continue;
    SCOPED_TRACE(name);
    for (std::vector<std::string> words : {std::vector<std::string>{"exact", "--cycles", "1"},
                                           {"vtk", "run"},
                                           {"study", "meter", "--quick"}}) {
      const std::string command = words.front();
      words.insert(words.end(), {"--out", name});
      const Outcome outcome = run(words);
      EXPECT_EQ(outcome.status, 2) << outcome.output;
      EXPECT_EQ(outcome.output.rfind(fmt::format("ERROR: drumlin {}: --out is '{}': ", command, name), 0), 0u)
          << outcome.output;
    }
    EXPECT_EQ(listing(), before);
  }
}

// Only the checks are called: nothing is written there.
TEST_F(OutputFiles, TheSystemsFoldersAreRefused) {
  for (const char *name : {"/", "//", "/dev", "/dev/x", "/proc/self", "/sys/x/y", "/tmp/../dev/x"})
    EXPECT_NE(error_of([name] { post::check_output_folder(name); }), "no error") << name;
  fs::create_symlink("/dev", folder_ / "link-to-dev");
  EXPECT_NE(error_of([this] { post::check_output_folder(folder_ / "link-to-dev" / "x"); }), "no error");
  EXPECT_NE(error_of([] { post::check_output_file("/dev/drumlin"); }), "no error");
  EXPECT_EQ(error_of([this] { post::check_output_folder(folder_ / "device-of-mine" / "new"); }), "no error");
}

// In an earlier result's folder, too: exact replaces neither a file that is read-only nor a node, and keeps
// all four.
TEST_F(OutputFiles, FilesInAFolderOfResultsAreChecked) {
  ASSERT_EQ(run({"exact", "--cycles", "1", "--out", "o"}).status, 0);
  fs::remove(folder_ / "o/events.csv");
  for (const char *kind : {"read-only", "pipe", "dangling"}) {
    fs::rename(folder_ / kind, folder_ / "o/events.csv");
    const std::string before = listing();
    const Outcome outcome = run({"exact", "--cycles", "2", "--out", "o"});
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_TRUE(printed(outcome, "--out is 'o': events.csv is "));
    EXPECT_EQ(listing(), before);
    fs::remove(folder_ / "o/events.csv");
  }
  put("run/parameters.csv", "name,value\ntimestep,0.1\n");
  put("run/dump/balls_0.vtp", ball_dump());
  ASSERT_EQ(run({"vtk", "run"}).status, 0);
  fs::remove(folder_ / "run/vtk/balls_0.vtp");
  ::mkfifo((folder_ / "run/vtk/balls_0.vtp").c_str(), 0600);
  const std::string before = listing();
  EXPECT_EQ(run({"vtk", "run"}).status, 2);
  EXPECT_EQ(listing(), before);
}

TEST_F(OutputFiles, LinksAreFollowed) {
  ::chmod((folder_ / "file").c_str(), 0640);
  EXPECT_EQ(run({"bed", "--balls", "3", "--out", "link"}).status, 0);
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_TRUE(contains(read_text(folder_ / "file"), "3 atoms"));
  EXPECT_EQ(fs::status(folder_ / "file").permissions(), fs::perms(0640)); // kept
  EXPECT_EQ(run({"exact", "--cycles", "1", "--out", "link-to-folder/new"}).status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "folder/new/chain.csv"));
}

/// Text of a shell script that works in the folder `place`, on a disk with little free space. It calls the
/// tool with the arguments `small`, whose results fit on the disk, runs the command `limit`, and calls the
/// tool with `large`, whose results do not fit. Exit status 0: the second call failed with an ERROR line, and
/// the results of the first are unchanged.
std::string starved(const std::string &place, const std::string &limit, const std::string &small,
                    const std::string &large) {
  const std::string tool = "'" DRUMLIN_TOOLS "' ";
  return "cd " + place + " && " + tool + small + " --out o >/dev/null && cp -r o ../kept || exit 10; " +
         limit + "; " + tool + large +
         " --out o >../said 2>&1 && exit 11; cat ../said; grep -q '^ERROR: drumlin' ../said " +
         "|| exit 12; diff -r o ../kept || exit 13; [ \"$(ls -A)\" = o ] || exit 14";
}

const std::vector<std::pair<std::string, std::string>> small_and_large = {
    {"exact --cycles 1 --samples-per-cycle 10", "exact --cycles 30 --samples-per-cycle 100"},
    {"bed --balls 20", "bed --balls 9000"},
    {"vtk ../run", "vtk ../large"}};

class FullDisk : public OutputFiles {
protected:
  FullDisk() {
    put("run/parameters.csv", "name,value\ntimestep,0.1\n");
    put("run/dump/balls_0.vtp", ball_dump());
    constexpr int balls = 5000;
    std::string dump = fmt::format("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: ATOMS id type radius "
                                   "mass x y z vx vy vz omegax omegay omegaz fx fy fz\n",
                                   balls);
    for (int id = 1; id <= balls; ++id) { // digits that do not compress
      dump += fmt::format("{} 1 0.1 1", id);
      for (int column = 1; column <= 12; ++column)
        dump += fmt::format(" {:.17g}", std::sin(static_cast<double>(id * column * column)));
      dump += '\n';
    }
    put("large/parameters.csv", "name,value\ntimestep,0.1\n");
    put("large/dump/balls_0.dump", dump);
  }
  void again() const {
    fs::remove_all(folder_ / "kept");
    fs::remove_all(folder_ / "disk");
    fs::create_directory(folder_ / "disk");
  }
};

// A limit on the size of a file replaces a full disk where nothing can be mounted.
TEST_F(FullDisk, AWriteThatFailsLeavesTheEarlierFileWhole) {
  for (const auto &[small, large] : small_and_large) {
    SCOPED_TRACE(large);
    again();
    const Outcome outcome = post::run_program(
        {"sh", "-c", starved("disk", "trap '' XFSZ; ulimit -f 200", small, large)}, {}, folder_);
    EXPECT_EQ(outcome.status, 0) << outcome.output;
  }
}

TEST_F(FullDisk, AFullDiskLeavesTheEarlierFileWhole) {
  if (::geteuid() != 0) GTEST_SKIP() << "a small disk can be mounted by root only";
  const std::string mount = "mount -t tmpfs -o size=200k tmpfs disk || exit 77; ";
  again();
  if (post::run_program({"unshare", "-m", "sh", "-c", mount}, {}, folder_).status != 0)
    GTEST_SKIP() << "this machine lets no small disk be mounted";
  for (const auto &[small, large] : small_and_large) {
    SCOPED_TRACE(large);
    again();
    const Outcome outcome = post::run_program(
        {"unshare", "-m", "sh", "-c", mount + starved("disk", "true", small, large)}, {}, folder_);
    EXPECT_EQ(outcome.status, 0) << outcome.output;
  }
}

// A report is complete or not there, whichever of its files does not fit: a table, a picture or a page.
TEST_F(FullDisk, AReportIsAnErrorAndLeavesNothing) {
  if (::geteuid() != 0) GTEST_SKIP() << "a small disk can be mounted by root only";
  ASSERT_EQ(run({"exact", "--cycles", "3", "--out", "chain"}).status, 0);
  fs::create_directory(folder_ / "disk");
  for (const char *size : {"60k", "300k", "400k"}) {
    const Outcome outcome =
        post::run_program({"unshare", "-m", "sh", "-c",
                           fmt::format("mount -t tmpfs -o size={} tmpfs disk || exit 77; '{}' report chain "
                                       "--out disk/o; echo status $?; ls -A disk",
                                       size, DRUMLIN_TOOLS)},
                          {}, folder_);
    if (outcome.status == 77 || outcome.says("unshare: "))
      GTEST_SKIP() << "this machine lets no small disk be mounted";
    EXPECT_TRUE(printed(outcome, "ERROR: drumlin report: "));
    const std::string end = "status 1\n";
    EXPECT_EQ(outcome.output.find(end) + end.size(), outcome.output.size()) << outcome.output;
  }
}

// Rows of a study are added one by one: one that cannot be written completely is removed again.
TEST_F(FullDisk, ARowThatDoesNotArriveIsAnError) {
  put("rows.csv", "a,b\n1,2\n");
  const auto child = [this] {
    ::signal(SIGXFSZ, SIG_IGN);
    rlimit limit{};
    limit.rlim_cur = limit.rlim_max = 12;
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const std::string fault =
        error_of([this] { post::append_text(folder_ / "rows.csv", "3,4,5,6,7,8,9\n"); });
    std::_Exit(fault.find("rows.csv: cannot be written: ") != std::string::npos ? 0 : 1);
  };
  EXPECT_EXIT(child(), ::testing::ExitedWithCode(0), "");
  EXPECT_EQ(read_text(folder_ / "rows.csv"), "a,b\n1,2\n");
}

// Threads that make theirs in one place at the same time: each has a folder of its own, which no other takes
// for that of a killed process.
TEST(TemporaryFolders, OfThreadsAreTheirOwn) {
  const post::TemporaryFolder parent(testing::TempDir(), "threads.");
  std::atomic<int> shared{0};
  constexpr std::size_t count = 4;
  std::vector<std::thread> threads;
  threads.reserve(count);
  while (threads.size() < count)
    threads.emplace_back([&parent, &shared] {
      for (int i = 0; i < 500; ++i) {
        const post::TemporaryFolder mine(parent.path(), "made.");
        std::error_code lost; // with the folder
        if (!fs::create_directory(mine.path() / "by_me", lost)) ++shared;
        std::this_thread::yield();
        if (!fs::exists(mine.path() / "by_me")) ++shared;
      }
    });
  for (std::thread &thread : threads)
    thread.join();
  EXPECT_EQ(shared, 0);
  EXPECT_TRUE(fs::is_empty(parent.path()));
}

} // namespace files

// Programs that are run as child processes, and their lines while they run.
namespace process {

using post::Program;

/// Runs a line of sh in a scratch folder; what it prints goes to the file `text` there.
Program shell(const Scratch &scratch, const std::string &line) {
  Program program;
  program.words = {"sh", "-c", line};
  program.folder = scratch.path();
  program.output = scratch / "text";
  program.limit = 600.0;
  return program;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST(Process, HandsOnLinesWhileItRuns) {
  const Scratch scratch;
  // The program continues only when its first line has been read.
  Program program =
      shell(scratch, "echo one; while [ ! -e seen ]; do sleep 0.01; done; printf 'two\\n\\nhalf'");
  std::vector<std::string> lines;
  program.line = [&](const std::string &line) {
    if (lines.empty()) fs::create_directory(scratch / "seen");
    lines.push_back(line);
  };
  const Outcome outcome = well(run_program(program));
  EXPECT_EQ(outcome.output, "one\ntwo\n\nhalf");
  EXPECT_EQ(lines, (std::vector<std::string>{"one", "two", ""})); // the last line has no line end
}

TEST(Process, IsStoppedWhenAReaderOfItsLinesFails) {
  for (const bool own_group : {true, false}) {
    const Scratch scratch;
    Program program = shell(scratch, "echo $$ >number; echo one; exec sleep 50");
    program.own_group = own_group;
    program.line = [](const std::string &line) { throw std::runtime_error("not " + line); };
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_THROW(run_program(program), std::runtime_error);
    EXPECT_LT(seconds_since(begin), 30.0);
    EXPECT_NE(::kill(std::stoi(read_text(scratch / "number")), 0), 0);
  }
}

TEST(Process, EndsWithTheProcessThatStartedIt) {
  for (const auto &[own_group, deaf] : {std::pair{true, ""}, {false, ""}, {true, "trap '' TERM; "}}) {
    const Scratch scratch;
    Program program =
        shell(scratch,
              std::string(deaf) + "echo $$ >number.unfinished; mv number.unfinished number; exec sleep 50");
    program.own_group = own_group;
    const pid_t parent = ::fork();
    if (parent == 0) {
      run_program(program);
      ::_exit(0);
    }
    const auto begin = std::chrono::steady_clock::now();
    while (!fs::exists(scratch / "number") && seconds_since(begin) < 30.0)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const pid_t child = std::stoi(read_text(scratch / "number"));
    ::kill(parent, SIGKILL);
    ::waitpid(parent, nullptr, 0);
    // A zombie, if nobody waits for it here, has ended, too.
    const auto runs = [child] {
      std::ifstream stat("/proc/" + std::to_string(child) + "/stat");
      std::string number, name, state;
      return stat >> number >> name >> state && state != "Z";
    };
    while (runs() && seconds_since(begin) < 30.0)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_FALSE(runs());
  }
}

// A program that does not stop is killed after 5 s; what the caller has to clear away is cleared then.
TEST(Process, ThatDoesNotStopIsKilledBeforeASignalEndsItsCaller) {
  const Scratch scratch;
  const Program program = shell(scratch, "trap '' TERM; echo >ready; exec sleep 50");
  const pid_t caller = ::fork();
  if (caller == 0) {
    post::stop_where_told();
    try {
      run_program(program);
    } catch (const post::StoppedBySignal &) {
      fs::create_directory(scratch / "cleared away");
    }
    ::_exit(0);
  }
  const auto begin = std::chrono::steady_clock::now();
  while (!fs::exists(scratch / "ready") && seconds_since(begin) < 30.0)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ::kill(caller, SIGTERM);
  int status = 0;
  ::waitpid(caller, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(fs::exists(scratch / "cleared away"));
}

TEST(Process, WithoutItsProgramIsAnError) {
  const Scratch scratch;
  Program program = shell(scratch, "");
  program.words = {"no-such-program"};
  EXPECT_EQ(error_of([&] { run_program(program); }),
            "cannot start no-such-program: No such file or directory");
}

TEST(Process, IsFoundByPath) {
  EXPECT_EQ(post::program_file("sh").filename(), "sh");
  EXPECT_EQ(post::program_file("/bin/sh"), "/bin/sh");
  for (const char *name : {"", "/", "/bin", "/etc/passwd", "no-such-program"})
    EXPECT_TRUE(post::program_file(name).empty()) << name;
}

} // namespace process

// What survives an interruption: complete rows of a table are kept, the others are measured again, and what
// is no table of the call is refused and left as it is. A folder of results takes one call at a time, and the
// same settings.
namespace resumed {

using namespace drumlin::post;
using namespace drumlin::test;

struct Point {
  double D = 0.0, limit = 0.0;
  std::string command;
};
const CsvSchema<Point> &columns() {
  static const CsvSchema<Point> schema({csv_column("D", &Point::D), csv_column("limit", &Point::limit),
                                        csv_column("command", &Point::command)},
                                       1);
  return schema;
}

class Results : public ::testing::Test {
protected:
  void write(const std::string &text) const { std::ofstream(file, std::ios::binary) << text; }
  ResumedTable open(const std::string &rows) const {
    write("D,limit,command\n" + rows);
    return {file, columns()};
  }

  drumlin::test::Scratch scratch;
  fs::path file = scratch / "results.csv";
};

TEST_F(Results, ForgetRowsWithoutANumber) {
  ResumedTable results = open("1,nan,x\n2,-nan,x\n3,NaN,x\n4,inf,x\n5,1.5,Fw nan\n6,nan(0x1),x\n7,2,x");
  EXPECT_EQ(read_text(file), "D,limit,command\n4,inf,x\n5,1.5,Fw nan\n");
  for (const char *key : {"1", "2", "3", "6", "7"})
    EXPECT_FALSE(results.has({key})) << key;
  for (const char *key : {"4", "5"})
    EXPECT_TRUE(results.has({key})) << key;
  const std::vector<Point> points = read_points(file, columns());
  ASSERT_EQ(points.size(), 2u);
  EXPECT_TRUE(std::isinf(points[0].limit));
  EXPECT_EQ(points[1].limit, 1.5);
  EXPECT_EQ(points[1].command, "Fw nan");
}

TEST_F(Results, ComeBackAsTheyWereAdded) {
  ResumedTable results = open("");
  const Point point{0.1, 1.0 / 3.0, "a, \"b\""};
  results.add(columns().cells(point));
  EXPECT_TRUE(results.has({number_text(0.1)}));
  EXPECT_FALSE(results.has({"0.2"}));
  EXPECT_EQ(read_text(file), "D,limit,command\n0.10000000000000001,0.33333333333333331,\"a, \"\"b\"\"\"\n");
  const std::vector<Point> points = read_points(file, columns());
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].limit, point.limit);
  EXPECT_EQ(points[0].command, point.command);
  EXPECT_THROW(results.add({"1"}), std::logic_error);
}

TEST_F(Results, RefuseWhatNoCallHasWritten) {
  for (const auto &[text, message] : std::vector<std::pair<std::string, std::string>>{
           {"D,command\n1,x\n", "the header of "},
           {"speed", "the header of "},
           {"D,limit,command\n1,2,x\n2,2\n3,2,x\n", "line 3: the number of cells is '2'; allowed: 3"},
           {"D,limit,command\n1,2,x,y\n", "line 2: the number of cells is '4'; allowed: 3"},
           {"D,limit,command\n1,2,x\n2,2,x\n1,2,x\n",
            "line 4, column 'D' is '1'; allowed: each once, or --fresh"}}) {
    write(text);
    const std::string fault = error_of([this] { ResumedTable(file, columns()); });
    EXPECT_TRUE(contains(fault, {message, "'; allowed: "}));
    EXPECT_EQ(read_text(file), text);
  }
}

TEST_F(Results, RefuseDoubledPointsWhereTheyAreOnlyRead) {
  write("D,limit,command\n1,2,x\n2,2,x\n1,3,y\n");
  EXPECT_TRUE(contains(error_of([this] { read_points(file, columns()); }),
                       "line 4, column 'D' is '1'; allowed: each once"));
}

TEST_F(Results, BeginAnewWhereTheHeaderIsCut) {
  const std::string header = "D,limit,command\n";
  for (std::size_t length = 0; length < header.size(); ++length) {
    write(header.substr(0, length));
    EXPECT_TRUE(read_points(file, columns()).empty());
    ResumedTable results(file, columns());
    EXPECT_FALSE(results.has({"1"}));
    EXPECT_EQ(read_text(file), header);
  }
}

TEST_F(Results, GetTheOrderOfTheCall) {
  ResumedTable results = open("3,1,c\n1,1,a\n");
  for (const char *key : {"1", "2", "3", "4"})
    results.has({key});
  results.add({"4", "1", "d"});
  results.add({"2", "1", "b"});
  results.finish();
  EXPECT_EQ(read_text(file), "D,limit,command\n1,1,a\n2,1,b\n3,1,c\n4,1,d\n");
}

TEST_F(Results, RefuseRowsOfAnotherCall) {
  ResumedTable results = open("1,1,a\n7,1,a\n");
  results.has({"1"});
  const std::string fault = error_of([&] { results.finish(); });
  EXPECT_TRUE(contains(fault, "line 3, column 'D' is '7'; allowed: a row of this call, or --fresh"));
  EXPECT_EQ(read_text(file), "D,limit,command\n1,1,a\n7,1,a\n");
}

TEST_F(Results, RefuseWordsForANumber) {
  for (const std::string word : {"much", "1.5e"}) {
    const ResumedTable results = open("1," + word + ",x\n");
    EXPECT_TRUE(contains(error_of([this] { read_points(file, columns()); }),
                         "line 2, column 'limit' is '" + word + "'; allowed: a number"));
  }
}

class Folder : public ::testing::Test {
protected:
  std::string open(const std::string &settings = "steps 3\n", bool fresh = false) const {
    return error_of([&] { ResumedFolder(out, "study", settings, fresh); });
  }
  void put(const std::string &name) const { std::ofstream(out / name) << "text"; }

  drumlin::test::Scratch scratch;
  fs::path out = scratch / "out";
};

TEST_F(Folder, IsContinuedWithTheSameSettings) {
  EXPECT_EQ(open(), "no error");
  put("rows.csv");
  EXPECT_EQ(open(), "no error");
  const std::string fault = open("steps 4\n");
  EXPECT_EQ(
      fault.find("--out is '" + out.string() + "'; allowed: the folder of a study with the same settings"),
      0U)
      << fault;
  EXPECT_TRUE(contains(fault, "(its study.txt has 'steps 3', this call 'steps 4')"));
  EXPECT_TRUE(contains(open(""), "has 'steps 3', this call '')"));
  EXPECT_TRUE(contains(open("steps 3\nquick\n"), "has '', this call 'quick')"));
  EXPECT_TRUE(fs::exists(out / "rows.csv"));
  EXPECT_EQ(open("steps 4\n", true), "no error");
  EXPECT_FALSE(fs::exists(out / "rows.csv"));
  EXPECT_EQ(open("steps 4\n"), "no error");
}

TEST_F(Folder, WithOtherFilesIsRefused) {
  fs::create_directory(out);
  put("thesis.txt");
  for (const bool fresh : {false, true})
    EXPECT_TRUE(contains(open("", fresh), "allowed: a folder that is new, empty or of an earlier study"));
  EXPECT_TRUE(fs::exists(out / "thesis.txt"));
}

TEST_F(Folder, TakesOneCallAtATime) {
  const ResumedFolder first(out, "study", "", false);
  put("rows.csv");
  for (const bool fresh : {false, true})
    EXPECT_TRUE(contains(open("", fresh),
                         "--out is '" + out.string() + "', into which another call writes; allowed: "));
  EXPECT_TRUE(fs::exists(out / "rows.csv"));
}

// Killed while it wrote its settings or a page.
TEST_F(Folder, IsClearedOfHalfWrittenFiles) {
  fs::create_directories(out);
  put("study.txt.tmp.123.0");
  EXPECT_EQ(open(), "no error");
  fs::create_directories(out / "data");
  put("data/rows.csv.tmp.77.3");
  put("notes.tmp");
  EXPECT_EQ(open(), "no error");
  EXPECT_FALSE(fs::exists(out / "study.txt.tmp.123.0"));
  EXPECT_FALSE(fs::exists(out / "data/rows.csv.tmp.77.3"));
  EXPECT_TRUE(fs::exists(out / "notes.tmp"));
}

TEST(Fingerprint, IsAnotherForAnotherText) {
  EXPECT_EQ(fingerprint(""), "cbf29ce484222325"); // the offset and a test vector of FNV-1a
  EXPECT_EQ(fingerprint("foobar"), "85944171f73967e8");
}

} // namespace resumed

} // namespace
} // namespace drumlin::test
