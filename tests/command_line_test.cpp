// The program as scripts see it: exit codes, one line an error, files whole or absent.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/image.h"
#include "tests/paths.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int exit_code = -1;
  std::string out;  ///< stdout and stderr
};

Outcome zonal(const std::string& arguments) {
  FILE* pipe = popen((test::program() + " " + arguments + " 2>&1").c_str(), "r");
  Outcome run;
  std::array<char, 4096> buffer;
  while (size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) run.out.append(buffer.data(), n);
  const int status = pclose(pipe);
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return run;
}

class CommandLine : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("zonal_cli_" + std::to_string(getpid()));
    fs::create_directories(folder);
    scene = folder / "ball.json";
    std::ofstream(scene) << R"({
      "camera": {"position": [0, 1, 4], "look_at": [0, 0.5, 0], "vertical_fov": 40, "resolution": [32, 18]},
      "materials": [{"name": "grey", "type": "lambert", "albedo": 0.5}],
      "objects": [{"name": "ball", "type": "sphere", "center": [0, 0.5, 0], "radius": 0.5, "material": "grey"}],
      "lights": [{"type": "quad", "corner": [-1, 3, -1], "edges": [[2, 0, 0], [0, 0, 2]], "radiance": 5}]})";
  }
  void TearDown() override { fs::remove_all(folder); }
  std::string path(const std::string& name) const { return (folder / name).string(); }
  std::string render(const std::string& rest) const {
    return "render " + scene.string() + " --quiet " + rest;
  }

  void expect_refused(const std::string& arguments, const std::vector<std::string>& words) const {
    const Outcome run = zonal(arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << "\n" << run.out;
    EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 1) << "one line expected:\n" << run.out;
    for (const std::string& word : words)
      EXPECT_NE(run.out.find(word), std::string::npos) << word << " missing in: " << run.out;
  }

  fs::path folder, scene;
};

TEST_F(CommandLine, renders_an_exr_with_layers_and_stats) {
  const Outcome run = zonal(render("--passes 2 --seed 9 -o " + path("a.exr") + " --stats " + path("a.json")));
  ASSERT_EQ(run.exit_code, 0) << run.out;
  const ImageFile image = read_image(path("a.exr"));
  for (const char* layer : {"", "albedo", "normal", "depth"}) EXPECT_TRUE(image.layers.count(layer)) << layer;
  EXPECT_EQ(image.metadata.at("integrator"), "path");
  EXPECT_EQ(image.metadata.at("seed"), "9");
  const auto stats = nlohmann::json::parse(std::ifstream(path("a.json")));
  EXPECT_EQ(stats["passes"], 2);
  EXPECT_EQ(stats["counters"]["camera_rays"], 2 * 32 * 18);
  for (const char* key : {"load", "begin_pass", "radiance", "output"})
    EXPECT_TRUE(stats["seconds"].contains(key)) << key;
  for (const char* key : {"scene", "integrator", "parameters", "seed", "threads", "peak_memory_bytes",
                          "version", "compiler", "cpu", "gpu"})
    EXPECT_TRUE(stats.contains(key)) << key;
}

TEST_F(CommandLine, a_timed_render_can_be_had_again_with_its_number_of_passes) {
  for (const std::string method : {"path", "vpl"}) {
    ASSERT_EQ(zonal(render("--integrator " + method + " --time 0.3 -o " + path("t.exr") + " --stats " +
                           path("t.json")))
                  .exit_code,
              0);
    const auto stats = nlohmann::json::parse(std::ifstream(path("t.json")));
    const std::string repeat = stats["repeat"];
    const Outcome again =
        zonal(render("--integrator " + method + " --threads 1 -o " + path("u.exr") + " " + repeat));
    ASSERT_EQ(again.exit_code, 0) << again.out;
    EXPECT_EQ(read_image(path("t.exr")).layers.at("").pixels, read_image(path("u.exr")).layers.at("").pixels)
        << repeat;
  }
}

TEST_F(CommandLine, the_first_interrupt_ends_the_render_and_keeps_what_it_had) {
  const std::string image = path("stopped.exr");
  const pid_t child = fork();
  if (child == 0) {
    execl(test::program().c_str(), "zonal", "render", scene.c_str(), "--passes", "10000000", "--quiet", "-o",
          image.c_str(), nullptr);
    _exit(99);
  }
  usleep(1'500'000);  // long enough for a pass; the picture is tiny
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_GT(std::stoi(read_image(image).metadata.at("passes")), 0);
}

TEST_F(CommandLine, refuses_with_one_line_and_writes_nothing) {
  const std::string out = " -o " + path("never.exr");
  expect_refused("render " + path("missing.json") + out, {"missing.json"});
  expect_refused(render("--integrator pth" + out), {"pth", "path"});
  expect_refused(render("--set lihgts=4 --integrator vpl" + out), {"lihgts", "lights"});
  expect_refused(render("--set lights=-4 --integrator vpl" + out), {"lights", "-4"});
  expect_refused(render("--set lights=2.5 --integrator vpl" + out), {"lights", "2.5"});
  expect_refused(render("--set occlusion=sphere --integrator vpl" + out), {"occlusion", "sphere", "center"});
  expect_refused(render("--set lights" + out), {"key=value"});
  expect_refused(render("--size 0x10" + out), {"0x10"});
  expect_refused(render("--passes 0" + out), {"passes"});
  expect_refused(render("--passes 2 --time 3" + out), {"--time"});
  expect_refused(render("--backend gl" + out), {"gl"});
  expect_refused(render("--pases 3" + out), {"--pases", "--passes"});
  expect_refused(render("-o " + path("no/such/folder/a.exr")), {"no/such/folder"});
  expect_refused(render("-o " + path("a.bmp")), {".bmp", ".exr"});
  expect_refused("rendr x.json", {"rendr", "render"});
  EXPECT_FALSE(fs::exists(path("never.exr")));
  for (const auto& entry : fs::directory_iterator(folder)) EXPECT_EQ(entry.path().filename(), "ball.json");
}

TEST_F(CommandLine, compares_a_picture_with_itself) {
  ASSERT_EQ(zonal(render("--passes 1 -o " + path("a.exr"))).exit_code, 0);
  const Outcome run = zonal("compare " + path("a.exr") + " " + path("a.exr") + " --json");
  ASSERT_EQ(run.exit_code, 0) << run.out;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["linear"]["rmse"], 0);
  EXPECT_EQ(json["display"]["psnr"], "inf");
  EXPECT_EQ(json["display"]["ssim"], 1);
  EXPECT_EQ(json["display"]["flip"], 0);
}

TEST_F(CommandLine, lists_every_parameter_as_json) {
  const Outcome run = zonal("list integrators --json");
  ASSERT_EQ(run.exit_code, 0) << run.out;
  EXPECT_NE(run.out.find("max_bounces"), std::string::npos);
  EXPECT_TRUE(nlohmann::json::accept(run.out));
}

}  // namespace
}  // namespace zonal
