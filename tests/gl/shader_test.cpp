// Shader texts: includes, messages of the compiler, and what is said where there is no GL or too old a one.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "gl/program.h"
#include "tests/gl/support.h"

namespace zonal {
namespace {

/// A folder of shader texts that goes with the test.
struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("zonal_shaders_" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path / name) << text; }
};

std::string message_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ShaderText, every_kernel_in_the_program_is_the_file_itself) {
  const gl::ShaderText inside;
  ASSERT_GT(gl::kEmbeddedShaderCount, 10u);
  for (size_t i = 0; i < gl::kEmbeddedShaderCount; ++i) {
    const std::string path = gl::kEmbeddedShaders[i].path;
    EXPECT_EQ(inside.read(path), test::shader_text().read(path)) << path;
  }
}

TEST(ShaderText, a_file_is_included_once_and_lines_keep_their_numbers) {
  const Folder folder;
  folder.write("a.glsl", "float a;\n");
  folder.write("b.glsl", "#include \"a.glsl\"\nfloat b;\n");
  folder.write("c.comp", "#include \"a.glsl\"\n#include \"b.glsl\"\nfloat c;\n");
  const gl::FlatShader flat = gl::flatten(gl::ShaderText(folder.path), "c.comp", {"SIZE 3"});
  EXPECT_EQ(flat.text,
            "#version 450 core\n#define KERNEL\n#define OUT(type) out type\n#define INOUT(type) inout type\n"
            "#define SIZE 3\n#line 1 0\n#line 1 1\nfloat a;\n#line 2 0\n#line 1 2\n#line 2 2\nfloat b;\n"
            "#line 3 0\nfloat c;\n");
  EXPECT_EQ(flat.files, (std::vector<std::string>{"c.comp", "a.glsl", "b.glsl"}));
}

TEST(ShaderText, a_missing_include_names_who_asked) {
  const Folder folder;
  folder.write("c.comp", "\n#include \"gone.glsl\"\n");
  const std::string message = message_of([&] { gl::flatten(gl::ShaderText(folder.path), "c.comp"); });
  EXPECT_NE(message.find("c.comp:2: "), std::string::npos) << message;
  EXPECT_NE(message.find("gone.glsl"), std::string::npos) << message;
}

TEST(ShaderText, compilers_logs_name_the_file) {
  gl::FlatShader flat;
  flat.files = {"vpl.comp", "vpl.glsl"};
  EXPECT_EQ(gl::readable_log("1:12(5): error: no function\n", flat), "vpl.glsl:12: error: no function");
  EXPECT_EQ(gl::readable_log("0(7) : error C1008: undefined\nmore\n", flat),
            "vpl.comp:7: error C1008: undefined\nmore");
  EXPECT_EQ(gl::readable_log("9:1(1): error: a file that is not there", flat),
            "9:1(1): error: a file that is not there");
}

TEST(Program, a_mistake_in_an_included_file_is_told_with_its_line) {
  if (!test::gl_context()) GTEST_SKIP() << test::no_gl_reason();
  const Folder folder;
  folder.write("kernel.glsl", "float right() { return 1.0f; }\nfloat wrong() { return missing; }\n");
  folder.write("main.comp", "layout(local_size_x = 1) in;\n#include \"kernel.glsl\"\nvoid main() {}\n");
  const std::string message =
      message_of([&] { gl::Program::compute(gl::ShaderText(folder.path), "main.comp"); });
  EXPECT_NE(message.find("kernel.glsl:2:"), std::string::npos) << message;
  EXPECT_NE(message.find("missing"), std::string::npos) << message;
}

TEST(Context, names_the_driver_and_its_version) {
  if (!test::gl_context()) GTEST_SKIP() << test::no_gl_reason();
  const gl::ContextInfo& info = test::gl_context()->info();
  EXPECT_FALSE(info.renderer.empty());
  EXPECT_EQ(info.platform.rfind("EGL", 0), 0u) << info.platform;
  EXPECT_NO_THROW(test::gl_context()->check("nothing done"));
}

}  // namespace
}  // namespace zonal
