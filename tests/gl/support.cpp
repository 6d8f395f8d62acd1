#include "tests/gl/support.h"

#include "core/error.h"
#include "tests/paths.h"

namespace zonal::test {
namespace {

struct Shared {
  std::unique_ptr<gl::Context> context;
  std::string reason;
  Shared() {
    try {
      context = gl::Context::headless();
    } catch (const SceneError& error) {
      reason = error.what();
    }
  }
};
const Shared& shared() {
  static const Shared one;
  return one;
}

}  // namespace

gl::Context* gl_context() {
  return shared().context.get();
}
const std::string& no_gl_reason() {
  return shared().reason;
}
const gl::ShaderText& shader_text() {
  static const gl::ShaderText text(test::source_dir());
  return text;
}

}  // namespace zonal::test
