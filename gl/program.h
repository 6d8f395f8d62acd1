#pragma once
/// A compiled shader program.
///
///     Program program = Program::compute(ShaderText(), "integrators/vpl/vpl.comp");
///     program.use();
///     program.set("first", 0);
///     glDispatchCompute(20, 12, 1);

#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "gl/shader_text.h"

namespace zonal::gl {

class Program {
 public:
  Program() = default;
  /// Both throw SceneError with the compiler's messages, each behind its file and line.
  static Program compute(const ShaderText& text, const std::string& path,
                         const std::vector<std::string>& defines = {});
  static Program graphics(const ShaderText& text, const std::string& vertex, const std::string& fragment,
                          const std::vector<std::string>& defines = {});
  ~Program();
  Program(Program&& other) noexcept { *this = std::move(other); }
  Program& operator=(Program&& other) noexcept;

  void use() const;
  /// Of uniforms; names the program does not use are ignored.
  void set(const char* name, int value) const;
  void set(const char* name, uint32_t value) const;
  void set(const char* name, float value) const;
  void set(const char* name, vec2 value) const;
  void set(const char* name, vec3 value) const;
  void set(const char* name, ivec2 value) const;
  void set(const char* name, const mat4& value) const;
  void set(const char* name, std::span<const float> values) const;

  unsigned id() const { return id_; }

 private:
  explicit Program(unsigned id) : id_(id) {}
  int place(const char* name) const;
  unsigned id_ = 0;
};

}  // namespace zonal::gl
