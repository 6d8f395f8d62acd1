#pragma once
/// A scene, a method and its settings, ready to draw frames: what `zonal view` shows, without its window.
///
///     Session session(*context, ShaderText(), "scenes/cornell/cornell.json");
///     session.choose("hvl", {{"lights", 400}});
///     session.draw(camera);
///     session.show(0, 1280, 720, camera.exposure);

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/image.h"
#include "gl/context.h"
#include "gl/direct.h"
#include "gl/timer.h"
#include "gl/twin.h"

namespace zonal::gl {

class Session {
 public:
  /// Throws SceneError for a scene that cannot be loaded or shown.
  Session(const Context& context, ShaderText text, const std::string& scene_file);
  ~Session();

  /// Changes the method; settings that are not given take what the GPU side has: nothing occluded, and direct
  /// light where it can show all of the scene's lights. Throws SceneError and keeps what was.
  void choose(const std::string& method, const nlohmann::json& settings);
  /// Compiles all shaders again, from the folder of `text` where it has one. Throws SceneError and keeps what
  /// was.
  void reload(const ShaderText& text);
  /// Draws a frame of the camera's size.
  void draw(const Camera& camera);
  /// Copies the frame to a framebuffer, with exposure and sRGB.
  void show(unsigned framebuffer, int width, int height, float exposure) const;
  /// The frame's radiance, W m^-2 sr^-1.
  Image radiance() const;
  /// Writes PREFIX.json, the scene with this camera, method and settings, and PREFIX.png. Files that the
  /// scene names are named by their full paths.
  void save(const std::string& prefix, const Camera& camera) const;

  struct Times {
    double points_ms = 0, direct_ms = 0, gather_ms = 0;
    double frame_ms() const { return points_ms + direct_ms + gather_ms; }
  };
  const Times& times() const { return times_; }  ///< of the last frame
  const Scene& scene() const { return scene_; }
  const std::string& method() const { return method_; }
  const nlohmann::json& settings() const { return settings_; }  ///< every parameter's value

 private:
  struct Frame;  ///< what hangs on the picture's size
  std::unique_ptr<Integrator> prepare(const std::string& method, const nlohmann::json& settings,
                                      nlohmann::json* values, std::unique_ptr<Twin>* twin,
                                      std::unique_ptr<DirectLight>* direct);
  bool shows_all_lights() const;

  ShaderText text_;
  std::string file_, method_;
  Scene scene_;
  nlohmann::json settings_;
  std::unique_ptr<SceneBuffers> buffers_;
  std::unique_ptr<Integrator> integrator_;
  std::unique_ptr<Twin> twin_;
  std::unique_ptr<DirectLight> direct_;
  std::unique_ptr<Frame> frame_;
  Program show_;
  Timer timer_;
  Times times_;
};

}  // namespace zonal::gl
