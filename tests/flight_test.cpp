// `zonal flight`: a sequence's times and errors.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/paths.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;

class Flight : public testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() / ("zonal_flight_" + std::to_string(getpid()));
  void SetUp() override {
    fs::create_directories(folder);
    std::ofstream(folder / "scene.json") << R"({
      "camera": {"position": [0, 1, 4], "look_at": [0, 0, 0], "resolution": [24, 16]},
      "materials": [{"name": "grey", "type": "lambert", "albedo": 0.5}],
      "objects": [{"name": "floor", "type": "quad", "corner": [-2, 0, 2], "edges": [[4, 0, 0], [0, 0, -4]], "material": "grey"}],
      "lights": [{"name": "lamp", "type": "sphere", "center": [-1, 5, 0], "radius": 0.5, "radiance": 50}],
      "keyframes": {"lights": {"lamp": [{"frame": 0, "center": [-1, 5, 0]}, {"frame": 4, "center": [1, 5, 0]}]}}})";
  }
  void TearDown() override { fs::remove_all(folder); }

  int run(const std::string& rest) const {
    const std::string command = test::program() + " flight " + (folder / "scene.json").string() + " " + rest +
                                " > " + (folder / "out").string() + " 2>&1";
    return WEXITSTATUS(std::system(command.c_str()));
  }
  nlohmann::json stats(const std::string& rest) const {
    const fs::path file = folder / "stats.json";
    EXPECT_EQ(run(rest + " --stats " + file.string()), 0);
    std::ifstream in(file);
    return nlohmann::json::parse(in);
  }
};

TEST_F(Flight, gives_times_and_pictures_of_each_frame) {
  const nlohmann::json s = stats("--frames 1:4 --integrator sh_direct -o " + (folder / "f").string());
  ASSERT_EQ(s["milliseconds"].size(), 4u);
  EXPECT_LE(s["percentiles"]["p50"], s["percentiles"]["p95"]);
  EXPECT_LE(s["percentiles"]["p99"], s["percentiles"]["max"]);
  EXPECT_FALSE(s.contains("flicker_of_mean"));
  for (const char* name : {"f-00001.png", "f-00004.png"}) EXPECT_TRUE(fs::exists(folder / name)) << name;
}

TEST_F(Flight, paths_error_and_flicker_fall_with_its_noise) {
  const std::string path =
      "--frames 0:4 --integrator path --set max_bounces=0 --reference-set max_bounces=0 "
      "--reference-passes 64 --passes ";
  const nlohmann::json few = stats(path + "2"), many = stats(path + "32");
  // Independent noise falls by four when passes grow sixteen times; half as much tells it from none.
  EXPECT_LT(2 * many["error_of_mean"].get<double>(), few["error_of_mean"].get<double>());
  EXPECT_GT(few["error_of_mean"], 0);
  EXPECT_LT(2 * many["flicker_of_mean"].get<double>(), few["flicker_of_mean"].get<double>());
}

TEST_F(Flight, bad_input_is_told_in_a_line) {
  for (const char* rest : {"--frames 4:1", "--frames 3", "--frames 0:1 --integrator nothing",
                           "--frames 0:1 --reference-passes 1 --reference-set lights=3"})
    EXPECT_EQ(run(rest), 2) << rest;
}

}  // namespace
}  // namespace zonal
