#pragma once
/// What the window of `zonal view` does with its inputs, whoever makes them: the window's panel and keys, or
/// a script, one line a frame:
///
///     method hvl            set lights=100        key w 0.5       turn 10 -5 (degrees)
///     resize 320 180        save PREFIX           reload          random 100 7 (that many inputs, from a
///     seed)

#include <deque>
#include <random>
#include <string>

#include "gl/fly_camera.h"
#include "gl/session.h"

namespace zonal::gl {

class Viewer {
 public:
  /// `shader_folder`: where shaders are read again from; empty: those of the program.
  Viewer(const Context& context, const std::string& scene, const std::string& method,
         const nlohmann::json& settings, const std::string& shader_folder);

  /// Carries out one line. What goes wrong is kept in `message` and changes nothing; a line that means
  /// nothing throws SceneError.
  void act(const std::string& line);
  void choose(const std::string& method, const nlohmann::json& settings);
  /// To its defaults, but for what means the same in every method: lights, bounces, direct.
  void change_method(const std::string& method);
  void set(const std::string& key, const std::string& value);
  void reload();
  void save(const std::string& prefix);
  /// Draws the camera's view at this size and shows it in the window's framebuffer.
  void frame(int width, int height);
  /// Whether a shader's file has changed since they were read.
  bool shaders_changed();

  Session session;
  FlyCamera fly;
  std::string message;            ///< the last error; empty when the last input did what it should
  std::deque<float> frame_times;  ///< ms, the newest last, at most 240
  ivec2 wanted_size{0};           ///< the window's, when an input asked for one; (0, 0): none did

 private:
  void random_input(std::mt19937& random);
  std::string folder_;
  int64_t newest_ = 0;  ///< of the shaders' files
};

}  // namespace zonal::gl
