#include "gl/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "core/error.h"
#include "integrators/table.h"

namespace zonal::gl {
namespace {

/// When the newest of the shaders in a folder was written, in the file system's ticks.
int64_t newest_shader(const std::string& folder) {
  int64_t newest = 0;
  std::error_code error;
  for (const char* part : {"gl", "sh", "materials", "integrators"}) {
    for (std::filesystem::recursive_directory_iterator i(folder + "/" + part, error), end; !error && i != end;
         i.increment(error)) {
      const std::string extension = i->path().extension();
      if (extension != ".glsl" && extension != ".comp" && extension != ".vert" && extension != ".frag")
        continue;
      newest = std::max(newest, int64_t(i->last_write_time(error).time_since_epoch().count()));
    }
  }
  return newest;
}

nlohmann::json value_of(const std::string& text) {
  const nlohmann::json parsed = nlohmann::json::parse(text, nullptr, false);
  return parsed.is_discarded() ? nlohmann::json(text) : parsed;
}

vec3 way_of(const std::string& key) {
  if (key == "w") return {0, 0, 1};
  if (key == "s") return {0, 0, -1};
  if (key == "d") return {1, 0, 0};
  if (key == "a") return {-1, 0, 0};
  if (key == "e") return {0, 1, 0};
  if (key == "q") return {0, -1, 0};
  throw SceneError(fmt::format("found the key \"{}\", expected w, a, s, d, q or e", key));
}

}  // namespace

Viewer::Viewer(const Context& context, const std::string& scene, const std::string& method,
               const nlohmann::json& settings, const std::string& shader_folder)
    : session(context, shader_folder.empty() ? ShaderText() : ShaderText(shader_folder), scene),
      folder_(shader_folder) {
  session.choose(method, settings);
  fly = FlyCamera(session.scene().camera(), 0.2f * session.scene().bounds().radius);
  if (!folder_.empty()) newest_ = newest_shader(folder_);
}

void Viewer::choose(const std::string& method, const nlohmann::json& settings) {
  try {
    session.choose(method, settings);
    message.clear();
  } catch (const SceneError& error) {
    message = error.what();
  }
}

void Viewer::change_method(const std::string& method) {
  nlohmann::json kept = nlohmann::json::object();
  for (const char* key : {"lights", "bounces", "direct"})
    if (session.settings().contains(key) && find_integrator(method, "view").has(key))
      kept[key] = session.settings()[key];
  choose(method, kept);
}

void Viewer::set(const std::string& key, const std::string& value) {
  nlohmann::json settings = session.settings();
  settings[key] = value_of(value);
  choose(session.method(), settings);
}

void Viewer::reload() {
  try {
    session.reload(folder_.empty() ? ShaderText() : ShaderText(folder_));
    message.clear();
  } catch (const SceneError& error) {
    message = error.what();
  }
}

bool Viewer::shaders_changed() {
  if (folder_.empty()) return false;
  const int64_t newest = newest_shader(folder_);
  if (newest == newest_) return false;
  newest_ = newest;
  return true;
}

void Viewer::save(const std::string& prefix) {
  try {
    session.save(prefix, fly.camera);
    message.clear();
  } catch (const SceneError& error) {
    message = error.what();
  }
}

void Viewer::frame(int width, int height) {
  // A minimised window has no pixels.
  if (width <= 0 || height <= 0) return;
  fly.camera.width = width, fly.camera.height = height;
  session.draw(fly.camera);
  session.show(0, width, height, fly.camera.exposure);
  frame_times.push_back(static_cast<float>(session.times().frame_ms()));
  if (frame_times.size() > 240) frame_times.pop_front();
}

void Viewer::random_input(std::mt19937& random) {
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  // Methods and settings seldom: each compiles shaders.
  const int kind = pick(400);
  if (kind < 2) {
    const auto& names = twin_names();
    change_method(names[pick(int(names.size()))]);
  } else if (kind < 6) {
    const auto params = find_integrator(session.method(), "view").params();
    const char* values[] = {"0", "1", "3", "none", "sh", "zonal", "paths", "-1", "2024", "x"};
    set(params[pick(int(params.size()))].name, values[pick(10)]);
  } else if (kind < 20) {
    wanted_size = {1 + pick(96), 1 + pick(54)};
  } else if (kind < 100) {
    fly.turn(0.01f * float(pick(200) - 100), 0.01f * float(pick(200) - 100));
  } else {
    fly.move(vec3(pick(3) - 1, pick(3) - 1, pick(3) - 1), 0.05f, pick(2) == 1);
  }
}

void Viewer::act(const std::string& line) {
  std::istringstream words(line);
  std::string what, first;
  words >> what;
  const auto number = [&](const char* meaning) {
    float value;
    if (!(words >> value)) throw SceneError(fmt::format("\"{}\": expected {}", line, meaning));
    return value;
  };
  if (what == "method" && words >> first) {
    change_method(first);
  } else if (what == "set" && words >> first && first.find('=') != std::string::npos) {
    set(first.substr(0, first.find('=')), first.substr(first.find('=') + 1));
  } else if (what == "key" && words >> first) {
    fly.move(way_of(first), number("seconds"));
  } else if (what == "turn") {
    const float right = number("degrees to the right"), up = number("degrees up");
    fly.turn(right * kPi / 180, up * kPi / 180);
  } else if (what == "resize") {
    const int width = int(number("a width")), height = int(number("a height"));
    wanted_size = {width, height};
  } else if (what == "save" && words >> first) {
    save(first);
  } else if (what == "reload") {
    reload();
  } else if (what == "random") {
    const int count = int(number("how many"));
    std::mt19937 random(static_cast<unsigned>(number("a seed")));
    for (int i = 0; i < count; ++i) random_input(random);
  } else {
    throw SceneError(
        fmt::format("found \"{}\", expected method, set, key, turn, resize, save, reload or random", line));
  }
}

}  // namespace zonal::gl
