// `zonal view` under a virtual display: opens, shows each method, saves a state that renders, and holds
// through random inputs.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/scene_loader.h"
#include "gl/fly_camera.h"
#include "tests/gl/support.h"
#include "tests/paths.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;

/// An X server without a screen, as long as it lives; none where Xvfb is not installed.
class VirtualDisplay {
 public:
  VirtualDisplay() {
    if (std::system("command -v Xvfb >/dev/null 2>&1") != 0) return;
    number_ = 100 + ::getpid() % 10000;
    pid_ = ::fork();
    if (pid_ == 0) {
      const std::string display = ":" + std::to_string(number_);
      ::execlp("Xvfb", "Xvfb", display.c_str(), "-screen", "0", "640x480x24", "-nolisten", "tcp", nullptr);
      ::_exit(127);
    }
    // Up once its socket is there.
    for (int i = 0; i < 200 && !fs::exists("/tmp/.X11-unix/X" + std::to_string(number_)); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  ~VirtualDisplay() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
  }
  bool there() const { return pid_ > 0 && fs::exists("/tmp/.X11-unix/X" + std::to_string(number_)); }
  std::string name() const { return ":" + std::to_string(number_); }

 private:
  pid_t pid_ = -1;
  int number_ = 0;
};

struct Folder {
  fs::path path = fs::temp_directory_path() / ("zonal_view_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Exit code of `zonal view` playing these lines; `said` receives what it printed.
int play(const Folder& folder, const std::string& display, const std::string& lines, std::string* said) {
  std::ofstream(folder.path / "play.txt") << lines;
  const std::string command =
      "DISPLAY=" + display + " " + test::program() + " view " + test::source_dir() +
      "/scenes/cornell/cornell.json --integrator vpl --set lights=4 --size 64x36 --play " +
      (folder.path / "play.txt").string() + " > " + (folder.path / "said.txt").string() + " 2>&1";
  const int status = std::system(command.c_str());
  *said = text_of(folder.path / "said.txt");
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(View, shows_each_method_and_saves_a_state_that_loads) {
  const VirtualDisplay display;
  if (!display.there()) GTEST_SKIP() << "no Xvfb";
  const Folder folder;
  std::string said;
  const std::string prefix = (folder.path / "state").string();
  const int code = play(folder, display.name(),
                        "set lights=9\nkey w 0.5\nturn 10 -5\nresize 80 45\nmethod vsl\nset "
                        "samples=2\nmethod vsgl\nmethod hvl\n"
                        "set bands=3\nset bands=nonsense\nset lights=9\nreload\nsave " +
                            prefix + "\n",
                        &said);
  ASSERT_EQ(code, 0) << said;
  SceneSettings settings;
  const Scene scene = load_scene(prefix + ".json", {}, &settings);
  const auto integrator = nlohmann::json::parse(settings.integrator_json);
  EXPECT_EQ(integrator["type"], "hvl");
  EXPECT_EQ(integrator["bands"], 3);
  EXPECT_EQ(integrator["lights"], 9);
  EXPECT_TRUE(fs::exists(prefix + ".png"));
  // Half a second forward, a fifth of the scene's radius a second, along the camera it had then: -z.
  EXPECT_NEAR(scene.camera().position.z, 5.44 - 0.1 * scene.bounds().radius, 1e-3);
}

TEST(View, holds_through_ten_thousand_random_inputs) {
  const VirtualDisplay display;
  if (!display.there()) GTEST_SKIP() << "no Xvfb";
  const Folder folder;
  std::string said, lines;
  for (int i = 0; i < 25; ++i) lines += "random 400 " + std::to_string(i) + "\n";
  EXPECT_EQ(play(folder, display.name(), lines, &said), 0) << said;
}

TEST(View, without_a_display_is_told_in_a_line) {
  const Folder folder;
  std::string said;
  EXPECT_EQ(play(folder, "''", "key w 1\n", &said), 2);
  EXPECT_NE(said.find("display"), std::string::npos) << said;
}

TEST(View, a_line_that_means_nothing_is_told) {
  const VirtualDisplay display;
  if (!display.there()) GTEST_SKIP() << "no Xvfb";
  const Folder folder;
  std::string said;
  EXPECT_EQ(play(folder, display.name(), "jump 3\n", &said), 2);
  EXPECT_NE(said.find("\"jump 3\""), std::string::npos) << said;
}

TEST(FlyCamera, stays_orthonormal_and_upright_however_it_turns) {
  Camera start;
  gl::FlyCamera fly(start, 1);
  for (int i = 0; i < 1000; ++i) {
    fly.turn(0.37f, i % 7 < 4 ? 0.3f : -0.4f);
    const Camera& c = fly.camera;
    ASSERT_NEAR(glm::length(c.forward), 1, 1e-5);
    ASSERT_NEAR(glm::dot(c.forward, c.right), 0, 1e-5);
    ASSERT_NEAR(glm::dot(c.up, c.right), 0, 1e-5);
    ASSERT_EQ(c.right.y, 0);
    ASSERT_GT(c.up.y, 0);
  }
}

}  // namespace
}  // namespace zonal
