// The command that starts an engine, and the links used in place of folders with blanks in their names.
#include "tests/support/engine_runs.h"
#include "engine/engine_command.h"
#include "engine/places.h"
#include "support/usage_error.h"

#include <unistd.h>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;
using post::Cores;
using post::Engine;
using post::EngineCommand;
using Words = std::vector<std::string>;

/// A variable of the environment with another value as long as this object lives.
class Environment {
public:
  Environment(const char *name, const std::string &value) : name_(name) {
    if (const char *text = std::getenv(name); text != nullptr) before_ = text;
    ::setenv(name, value.c_str(), 1);
  }
  ~Environment() {
    if (before_.empty())
      ::unsetenv(name_);
    else
      ::setenv(name_, before_.c_str(), 1);
  }
  Environment(const Environment &) = delete;
  Environment &operator=(const Environment &) = delete;

private:
  const char *name_;
  std::string before_;
};

TEST(PlainFolder, IsALinkWhereANameHasBlanksOrColons) {
  const Scratch scratch;
  const Environment cache("XDG_CACHE_HOME", (scratch / "cache").string());
  EXPECT_EQ(post::plain_folder(scratch.path()), scratch.path());
  EXPECT_FALSE(fs::exists(scratch / "cache"));
  for (const char *name : {"a b", "a:b", "tab\tbed", "two\nlines"}) {
    const fs::path folder = scratch / name;
    fs::create_directory(folder);
    const fs::path plain = post::plain_folder(folder);
    EXPECT_FALSE(post::is_split(plain)) << plain;
    EXPECT_EQ(fs::canonical(plain), fs::canonical(folder));
    EXPECT_EQ(post::plain_folder(folder), plain); // no second link
    EXPECT_EQ(post::plain_file(folder / "file"), plain / "file");
  }
  const fs::path links = scratch / "cache/drumlin/links";
  EXPECT_EQ(std::distance(fs::directory_iterator(links), fs::directory_iterator()), 4);
  EXPECT_EQ(fs::status(links).permissions(), fs::perms::owner_all);
}

TEST(PlainFolder, IsInTmpWhereTheCacheCannotTakeIt) {
  const Scratch scratch;
  const fs::path folder = scratch / "a b";
  fs::create_directory(folder);
  std::ofstream(scratch / "file") << "no folder";
  const std::string own = "/tmp/drumlin-" + std::to_string(::getuid());
  fs::create_directories(scratch / "linked/drumlin"); // a link for folders may have been put there by anybody
  fs::create_directory_symlink(scratch.path(), scratch / "linked/drumlin/links");
  for (const char *cache : {"with blanks", "file", "linked"}) {
    const Environment other("XDG_CACHE_HOME", (scratch / cache).string());
    const fs::path plain = post::plain_folder(folder);
    EXPECT_EQ(plain.parent_path(), own);
    EXPECT_EQ(fs::canonical(plain), fs::canonical(folder));
    fs::remove(plain);
  }
}

TEST(FindDeck, TakesAFileOrANameInInputs) {
  const fs::path deck = post::places().inputs / "chain/in.chain";
  for (const char *name : {"chain/in.chain", "inputs/chain/in.chain"})
    EXPECT_TRUE(fs::equivalent(post::find_deck(name), deck)) << name;
  EXPECT_EQ(post::find_deck(deck.string()), deck);
  for (const char *name : {"", ".", "chain", "inputs/", "chain/in.none", "/chain/in.chain", "--engine"})
    EXPECT_THROW(post::find_deck(name), post::UsageError) << name;
}

TEST(EngineCommand, OfOneRankAndOfTwo) {
  const std::string preload = "LD_PRELOAD=" + plugin_library();
  const fs::path deck = chain_deck("in.chain");
  const EngineCommand one = post::engine_command(deck, {"-var", "k", "1"}, 1);
  EXPECT_EQ(one.environment, Words{preload});
  EXPECT_EQ(one.words, (Words{post::places().liggghts, "-in", deck.string(), "-var", "k", "1"}));
  const EngineCommand two = post::engine_command(deck, {}, 2);
  EXPECT_TRUE(two.environment.empty()); // mpirun itself is not the engine
  EXPECT_EQ(two.words.front(), "mpirun");
  const Words end(two.words.end() - 7, two.words.end());
  EXPECT_EQ(end, (Words{"-np", "2", "-x", preload, post::places().liggghts, "-in", deck.string()}));
  const auto has = [](const EngineCommand &command, const char *word) {
    return std::count(command.words.begin(), command.words.end(), word) == 1;
  };
  EXPECT_EQ(has(two, "--allow-run-as-root"), ::geteuid() == 0);
  EXPECT_TRUE(has(post::engine_command(deck, {}, 100000), "--oversubscribe"));
  EXPECT_FALSE(has(two, "--bind-to"));
  EXPECT_TRUE(has(post::engine_command(deck, {}, 2, Cores::shared), "--bind-to"));
  const EngineCommand short_run = post::engine_command(deck, {"-var", "k", "1"}, 1, Cores::shared);
  EXPECT_EQ(short_run.words, one.words);
  EXPECT_EQ(short_run.environment.front(), preload);
  EXPECT_EQ(std::count(short_run.environment.begin(), short_run.environment.end(),
                       "OMPI_MCA_ess_singleton_isolated=1"),
            1);
}

TEST(EngineCommand, OfADeckForLammpsGetsThePlugin) {
  SKIP_WITHOUT_LAMMPS(true);
  EXPECT_EQ(post::engine_of("a/b.lammps"), Engine::lammps);
  EXPECT_EQ(post::engine_of("a.lammps/b"), Engine::liggghts);
  const fs::path deck = chain_deck("in.chain.lammps");
  const EngineCommand command = post::engine_command(deck, {"-log", "none"}, 1);
  EXPECT_TRUE(command.environment.empty());
  EXPECT_EQ(command.words, (Words{post::places().lammps, "-in", deck.string(), "-var", "plugin",
                                  post::places().lammps_plugin.string(), "-log", "none"}));
}

TEST(PlainWords, LeaveAllButFilesAndFoldersAlone) {
  const Words words = {
      "-var", "law", "hooke/transition damping coefficient", "-var", "out", "without", "-log", "out", "a b",
      "-var", "out"};
  EXPECT_EQ(post::plain_words(words), words);
  const Scratch scratch;
  const Environment cache("XDG_CACHE_HOME", (scratch / "cache").string());
  const std::string out = (scratch / "of mine/run").string();
  const Words plain = post::plain_words({"-v", "out", out});
  EXPECT_EQ(fs::canonical(plain[2]), fs::canonical(out));
  EXPECT_FALSE(post::is_split(plain[2])) << plain[2];
  std::ofstream(scratch / "a file") << "no folder";
  EXPECT_THROW(post::plain_words({"-v", "out", (scratch / "a file").string()}), post::UsageError);
  EXPECT_THROW(post::plain_words({"-v", "bed", (scratch / "a bed").string()}), post::UsageError);
}

TEST(ShellLine, IsWhatAShellReadsBack) {
  const Words odd = {"x y", "it's", "$(touch pwned)", "a\"b",       "b\\", "*",
                     "",    "~",    "100%",           "two\nlines", "A&B"};
  Words words = {"printf", "<%s>"};
  words.insert(words.end(), odd.begin(), odd.end());
  std::string printed;
  for (const std::string &word : odd)
    printed += "<" + word + ">";
  const Scratch scratch;
  const Outcome outcome =
      run_program({"sh", "-c", post::shell_line({{"NAME=a b"}, words})}, {}, scratch.path());
  EXPECT_EQ(outcome.output, printed);
}

} // namespace
} // namespace drumlin::test
