// The script for ParaView, run by ParaView, where there is one.
#include "engine_run.h"
#include "vtk_files.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

std::string program(const std::string &name) {
  const char *path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (fs::exists(fs::path(folder) / name)) return (fs::path(folder) / name).string();
  return {};
}

/// Width and height from the header of a PNG file; zeros if it is none.
std::pair<unsigned, unsigned> png_size(const fs::path &file) {
  const std::string text = fs::exists(file) ? post::read_text(file) : "";
  if (text.size() < 24 || text.compare(1, 3, "PNG") != 0) return {0, 0};
  const auto number = [&text](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = at; i < at + 4; ++i)
      value = value * 256 + static_cast<unsigned char>(text[i]);
    return value;
  };
  return {number(16), number(20)};
}

TEST(ParaView, DrawsABed) {
  const std::string pvpython = program("pvpython"), screen = program("xvfb-run");
  if (pvpython.empty())
    GTEST_SKIP()
        << "NOT TESTED: postprocess/paraview_bed.py, for there is no pvpython (package python3-paraview)";
  if (screen.empty())
    GTEST_SKIP()
        << "NOT TESTED: postprocess/paraview_bed.py, for there is no xvfb-run (packages xvfb, xauth)";

  std::string name = (fs::temp_directory_path() / "drumlin-paraview-XXXXXX").string();
  ASSERT_NE(mkdtemp(name.data()), nullptr);
  const fs::path folder = name;
  std::vector<post::Ball> balls(3);
  std::vector<std::pair<double, std::string>> ball_files, contact_files;
  for (std::size_t b = 0; b < 3; ++b) {
    balls[b].id = static_cast<long>(b) + 1;
    balls[b].type = b == 2 ? post::drum_type : post::soil_type;
    balls[b].radius = b == 2 ? 0.3 : 0.1;
    balls[b].position = {0.2 * static_cast<double>(b), 0.0, 0.0};
  }
  for (const int step : {0, 10}) {
    balls[1].velocity[1] = 0.1 * step;
    const post::BedContacts contacts = {{{0, 1, {-0.2, 0.0, 0.0}, {-100.0 - step, 0.0, 0.0}, 1e-5}}, {}};
    ball_files.emplace_back(0.1 * step, "balls_" + std::to_string(step) + ".vtp");
    contact_files.emplace_back(0.1 * step, "contacts_" + std::to_string(step) + ".vtp");
    post::write_ball_points(folder / ball_files.back().second, balls, {1, 1, 0});
    post::write_contact_lines(folder / contact_files.back().second, balls, contacts);
  }
  std::ofstream(folder / "balls.pvd") << post::collection_text(ball_files);
  std::ofstream(folder / "contacts.pvd") << post::collection_text(contact_files);

  const std::string script = DRUMLIN_SOURCE_DIR "/postprocess/paraview_bed.py";
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {screen, "-a", pvpython, script});
    return post::run_program(words, {}, folder, 120.0);
  };
  for (const char *colour : {"speed", "coordination"}) {
    const post::Outcome outcome =
        run({".", "--png", "bed.png", "--animation", "film.png", "--size", "320", "200", "--colour", colour});
    EXPECT_TRUE(outcome.ok()) << outcome.output;
    EXPECT_EQ(outcome.output.find("Traceback"), std::string::npos) << outcome.output;
    for (const char *picture : {"bed.png", "film.0000.png", "film.0001.png"}) {
      EXPECT_EQ(png_size(folder / picture), (std::pair<unsigned, unsigned>{320, 200})) << picture << "\n"
                                                                                       << outcome.output;
      fs::remove(folder / picture);
    }
  }
  EXPECT_TRUE(run({"nowhere", "--png", "bed.png"}).says("ERROR: paraview_bed: 'nowhere' has no balls.pvd"));
  EXPECT_TRUE(run({".", "--png", "no/bed.png"}).says("'no/bed.png' cannot be written"));
  fs::remove_all(folder);
}

} // namespace
} // namespace drumlin::test
