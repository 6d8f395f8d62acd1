#pragma once
/// Shader text with `#include "path"`, the paths being those of this project: the kernels that C++ includes
/// are the very ones shaders get. The texts are part of the program; a folder of the same layout can take
/// their place while it runs.
///
///     ShaderText text;                                             // what the program was built with
///     FlatShader flat = flatten(text, "integrators/vpl/vpl.comp", {"LIGHTS 400"});

#include <string>
#include <string_view>
#include <vector>

namespace zonal::gl {

/// Where texts come from.
class ShaderText {
 public:
  ShaderText() = default;
  /// Reads from files under this folder from now on.
  explicit ShaderText(std::string folder) : folder_(std::move(folder)) {}
  /// Throws SceneError naming the file when there is none.
  std::string read(const std::string& path) const;
  const std::string& folder() const { return folder_; }  ///< empty: the texts in the program

 private:
  std::string folder_;
};

/// One text ready to compile, and which file each number in its `#line` directives stands for.
struct FlatShader {
  std::string text;
  std::vector<std::string> files;
};

/// The file with every include in its place, once each, behind `#version 450`, the words that make a kernel
/// GLSL (KERNEL, OUT, INOUT) and a `#define` for each of `defines` ("NAME value"). Throws SceneError: file,
/// line, what.
FlatShader flatten(const ShaderText& text, const std::string& path,
                   const std::vector<std::string>& defines = {});

/// A compiler's log with its numbers turned into files: "integrators/vpl/vpl.comp:12: error: ...", one line a
/// message. Knows the forms of Mesa, "1:12(5): ...", and NVIDIA, "1(12) : ...".
std::string readable_log(std::string_view log, const FlatShader& shader);

/// The texts in the program: made by gl/embed.cmake.
struct EmbeddedShader {
  const char* path;
  const char* text;
};
extern const EmbeddedShader kEmbeddedShaders[];
extern const size_t kEmbeddedShaderCount;

}  // namespace zonal::gl
