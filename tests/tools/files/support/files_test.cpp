// Output files and folders that the tools can and cannot write. All files are made in a scratch folder, and a
// full disk is a small file system that the test mounts.
#include "support/files.h"
#include "support/process.h"
#include "tests/support/checks.h"
#include "tests/support/dump_texts.h"
#include "tests/support/engine_runs.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;
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
    std::vector<std::string> names = {"folder", "read-only",    "pipe",  "dangling",
                                      "circle", "link-to-pipe", "file/x"};
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

} // namespace
} // namespace drumlin::test
