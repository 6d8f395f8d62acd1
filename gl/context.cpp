#include "gl/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <vector>

#include "core/error.h"

namespace zonal::gl {
namespace {

std::string text_of(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text ? text : "";
}

bool is_software(const std::string& renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR"})
    if (renderer.find(name) != std::string::npos) return true;
  return false;
}

bool has(const char* list, const char* extension) {
  return list &&
         (" " + std::string(list) + " ").find(" " + std::string(extension) + " ") != std::string::npos;
}

/// A display to try, and how it is reached.
struct Candidate {
  EGLenum platform;
  void* device;
  std::string name;
};

std::vector<Candidate> candidates() {
  std::vector<Candidate> list;
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const bool enumerates =
      has(extensions, "EGL_EXT_device_base") || has(extensions, "EGL_EXT_device_enumeration");
  if (enumerates && has(extensions, "EGL_EXT_platform_device")) {
    EGLDeviceEXT devices[32];
    EGLint count = 0;
    if (eglQueryDevicesEXT(32, devices, &count))
      for (int i = 0; i < count; ++i)
        list.push_back({EGL_PLATFORM_DEVICE_EXT, devices[i], fmt::format("EGL device {}", i)});
  }
  if (has(extensions, "EGL_MESA_platform_surfaceless"))
    list.push_back({EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, "EGL surfaceless"});
  return list;
}

class HeadlessContext : public Context {
 public:
  /// Throws a sentence's end: what of this candidate does not do.
  explicit HeadlessContext(const Candidate& candidate) {
    display_ = eglGetPlatformDisplayEXT(candidate.platform, candidate.device, nullptr);
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr))
      throw SceneError("no display");
    try {
      open();
      identify(candidate.name);
    } catch (...) {
      close();
      throw;
    }
  }
  ~HeadlessContext() override { close(); }

 private:
  void open() {
    if (!eglBindAPI(EGL_OPENGL_API)) throw SceneError("EGL without desktop OpenGL");
    EGLConfig config = nullptr;
    const char* extensions = eglQueryString(display_, EGL_EXTENSIONS);
    if (!has(extensions, "EGL_KHR_no_config_context")) {
      const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
      EGLint count = 0;
      if (!eglChooseConfig(display_, wanted, &config, 1, &count) || count == 0)
        throw SceneError("no configuration for OpenGL");
    }
    const EGLint core[] = {EGL_CONTEXT_MAJOR_VERSION,
                           kMajor,
                           EGL_CONTEXT_MINOR_VERSION,
                           kMinor,
                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                           EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, core);
    // A context of any version tells what the driver has, for the message.
    if (context_ == EGL_NO_CONTEXT) context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, nullptr);
    if (context_ == EGL_NO_CONTEXT) throw SceneError("no OpenGL context");
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      throw SceneError("a context that needs a window");
  }
  void close() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
    eglTerminate(display_);
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

class WindowContext : public Context {
 public:
  WindowContext() { identify("window"); }
};

}  // namespace

void Context::identify(const std::string& platform) {
  info_.platform = platform;
  info_.vendor = text_of(GL_VENDOR), info_.renderer = text_of(GL_RENDERER),
  info_.version = text_of(GL_VERSION);
  info_.software = is_software(info_.renderer);
  const bool core = epoxy_is_desktop_gl() && epoxy_gl_version() >= 10 * kMajor + kMinor;
  if (!core) throw SceneError(fmt::format("OpenGL {} ({})", info_.version, info_.renderer));
}

std::unique_ptr<Context> Context::headless() {
  std::unique_ptr<Context> software;
  std::string found;
  for (const Candidate& candidate : candidates()) {
    try {
      auto context = std::make_unique<HeadlessContext>(candidate);
      if (!context->info().software) return context;
      // Devices of a kind are alike: the first software one is kept while hardware is looked for.
      if (!software) software = std::move(context);
    } catch (const SceneError& error) {
      if (!found.empty()) found += "; ";
      found += candidate.name + ": " + error.what();
    }
  }
  if (!software)
    throw SceneError(
        fmt::format("no GPU backend: found {}, expected OpenGL {}.{} core through EGL (Mesa's software "
                    "renderer will do: libgl1-mesa-dri)",
                    found.empty() ? "no EGL device and no surfaceless EGL" : found, kMajor, kMinor));
  // Looking further may have left another context current.
  const std::string name = software->info().platform;
  software.reset();
  for (const Candidate& candidate : candidates())
    if (candidate.name == name) return std::make_unique<HeadlessContext>(candidate);
  throw SceneError("no GPU backend: " + name + " has gone");
}

std::unique_ptr<Context> Context::of_window() {
  try {
    return std::make_unique<WindowContext>();
  } catch (const SceneError& error) {
    throw SceneError(fmt::format("the window's context: found {}, expected OpenGL {}.{} core", error.what(),
                                 kMajor, kMinor));
  }
}

void Context::check(const std::string& what) const {
  glFinish();
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  while (glGetError() != GL_NO_ERROR) {
  }
  const char* name = error == GL_OUT_OF_MEMORY       ? "out of memory"
                     : error == GL_INVALID_ENUM      ? "invalid enum"
                     : error == GL_INVALID_VALUE     ? "invalid value"
                     : error == GL_INVALID_OPERATION ? "invalid operation"
                                                     : "an error";
  throw SceneError(fmt::format("{}: OpenGL reports {} ({:#x}) on {}", what, name, error, info_.renderer));
}

}  // namespace zonal::gl
