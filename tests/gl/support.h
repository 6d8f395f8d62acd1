#pragma once
/// One context for all tests of the GPU side; where there is none they are skipped, with the reason.
///
///     gl::Context* context = test::gl_context();
///     if (!context) GTEST_SKIP() << test::no_gl_reason();

#include "gl/context.h"
#include "gl/shader_text.h"

namespace zonal::test {

gl::Context* gl_context();
const std::string& no_gl_reason();
/// Texts from the source folder, where the tests' own shaders lie.
const gl::ShaderText& shader_text();

}  // namespace zonal::test
