#pragma once
/// An OpenGL 4.5 core context that is current on the thread which made it, with no window and no display.
///
///     auto context = gl::Context::headless();          // throws SceneError: what was found, what is needed
///     fmt::print("{}\n", context->info().renderer);

#include <memory>
#include <string>

namespace zonal::gl {

/// What the driver says of itself.
struct ContextInfo {
  std::string platform;  ///< "EGL device 0", "EGL surfaceless" or "window"
  std::string vendor, renderer, version;
  bool software = false;  ///< drawn by the CPU: timer queries mean nothing there
};

/// The versions this project is written for.
inline constexpr int kMajor = 4, kMinor = 5;

class Context {
 public:
  /// Tries EGL devices first (a server's GPU needs no display), then EGL without a surface; hardware before
  /// software.
  static std::unique_ptr<Context> headless();
  /// Of a window's context, already current; checks its version.
  static std::unique_ptr<Context> of_window();
  virtual ~Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const ContextInfo& info() const { return info_; }
  /// Waits for the queue to finish; throws SceneError naming `what` when the driver has recorded an error.
  void check(const std::string& what) const;

 protected:
  Context() = default;
  /// Reads the strings of the current context; throws SceneError when it is too old.
  void identify(const std::string& platform);

 private:
  ContextInfo info_;
};

}  // namespace zonal::gl
