#include "gl/program.h"

#include <epoxy/gl.h>

#include <utility>

#include "core/error.h"

namespace zonal::gl {
namespace {

/// A shader object that goes when it is no longer needed.
struct Stage {
  GLuint id;
  explicit Stage(GLenum kind) : id(glCreateShader(kind)) {}
  ~Stage() { glDeleteShader(id); }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  void compile(const FlatShader& flat) const {
    const char* text = flat.text.c_str();
    glShaderSource(id, 1, &text, nullptr);
    glCompileShader(id);
    GLint done = 0, length = 0;
    glGetShaderiv(id, GL_COMPILE_STATUS, &done);
    if (done) return;
    glGetShaderiv(id, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<size_t>(length), '\0');
    glGetShaderInfoLog(id, length, nullptr, log.data());
    throw SceneError(readable_log(log, flat));
  }
};

void link(GLuint program, const FlatShader& flat) {
  glLinkProgram(program);
  GLint done = 0, length = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &done);
  if (done) return;
  glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<size_t>(length), '\0');
  glGetProgramInfoLog(program, length, nullptr, log.data());
  throw SceneError(flat.files.front() + ": " + readable_log(log, flat));
}

}  // namespace

Program Program::compute(const ShaderText& text, const std::string& path,
                         const std::vector<std::string>& defines) {
  const FlatShader flat = flatten(text, path, defines);
  const Stage stage(GL_COMPUTE_SHADER);
  stage.compile(flat);
  Program program(glCreateProgram());
  glAttachShader(program.id_, stage.id);
  link(program.id_, flat);
  glDetachShader(program.id_, stage.id);
  return program;
}

Program Program::graphics(const ShaderText& text, const std::string& vertex, const std::string& fragment,
                          const std::vector<std::string>& defines) {
  const FlatShader first = flatten(text, vertex, defines), second = flatten(text, fragment, defines);
  const Stage vertex_stage(GL_VERTEX_SHADER), fragment_stage(GL_FRAGMENT_SHADER);
  vertex_stage.compile(first);
  fragment_stage.compile(second);
  Program program(glCreateProgram());
  glAttachShader(program.id_, vertex_stage.id);
  glAttachShader(program.id_, fragment_stage.id);
  link(program.id_, second);
  glDetachShader(program.id_, vertex_stage.id);
  glDetachShader(program.id_, fragment_stage.id);
  return program;
}

Program::~Program() {
  if (id_) glDeleteProgram(id_);
}

Program& Program::operator=(Program&& other) noexcept {
  std::swap(id_, other.id_);
  return *this;
}

void Program::use() const {
  glUseProgram(id_);
}
int Program::place(const char* name) const {
  return glGetUniformLocation(id_, name);
}
void Program::set(const char* name, int value) const {
  glProgramUniform1i(id_, place(name), value);
}
void Program::set(const char* name, uint32_t value) const {
  glProgramUniform1ui(id_, place(name), value);
}
void Program::set(const char* name, float value) const {
  glProgramUniform1f(id_, place(name), value);
}
void Program::set(const char* name, vec2 v) const {
  glProgramUniform2f(id_, place(name), v.x, v.y);
}
void Program::set(const char* name, vec3 v) const {
  glProgramUniform3f(id_, place(name), v.x, v.y, v.z);
}
void Program::set(const char* name, ivec2 v) const {
  glProgramUniform2i(id_, place(name), v.x, v.y);
}
void Program::set(const char* name, const mat4& v) const {
  glProgramUniformMatrix4fv(id_, place(name), 1, GL_FALSE, &v[0][0]);
}

void Program::set(const char* name, std::span<const float> v) const {
  glProgramUniform1fv(id_, place(name), static_cast<GLsizei>(v.size()), v.data());
}

}  // namespace zonal::gl
