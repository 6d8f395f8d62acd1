#include "gl/triangles.h"

#include <epoxy/gl.h>

namespace zonal::gl {

TrianglePass::TrianglePass(const ShaderText& text)
    : program_(Program::graphics(text, "gl/visibility.vert", "gl/visibility.frag")) {
  glCreateVertexArrays(1, &vertex_array_);
}
TrianglePass::~TrianglePass() {
  glDeleteVertexArrays(1, &vertex_array_);
}

void TrianglePass::draw(const SceneBuffers& scene, unsigned framebuffer, int width, int height,
                        const mat4& to_clip) {
  scene.bind();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  const float far = 0;
  glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &far);
  GLint attached = GL_NONE;
  glGetNamedFramebufferAttachmentParameteriv(framebuffer, GL_COLOR_ATTACHMENT0,
                                             GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &attached);
  const GLuint nothing[4] = {0, 0, 0, 0};
  if (attached != GL_NONE) glClearNamedFramebufferuiv(framebuffer, GL_COLOR, 0, nothing);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(vertex_array_);
  program_.use();
  program_.set("projection", to_clip);
  if (scene.triangles() > 0) glDrawArrays(GL_TRIANGLES, 0, 3 * scene.triangles());
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace zonal::gl
