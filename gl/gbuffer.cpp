#include "gl/gbuffer.h"

#include <epoxy/gl.h>

#include <cmath>

#include "gl/units.h"

namespace zonal::gl {
namespace {

constexpr int kPointLayers = 13;  // gl/point.glsl

/// World to clip space: depth is near / distance, 1 at the near plane and 0 far away, which a float depth
/// buffer resolves evenly; rows go down, as images' do.
mat4 projection(const Camera& camera, vec2 inside, float near) {
  const float half = std::tan(0.5f * camera.vertical_fov);
  const float aspect = float(camera.width) / float(camera.height);
  // Moves the ray through `inside` of each pixel to its centre.
  const vec2 shift((1 - 2 * inside.x) / float(camera.width), (1 - 2 * inside.y) / float(camera.height));
  const vec3 x = camera.right / (half * aspect), y = -camera.up / half, z = camera.forward;
  const vec3 rows[4] = {x + shift.x * z, y + shift.y * z, vec3(0), z};
  mat4 m(0);
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 3; ++column) m[column][row] = rows[row][column];
    m[3][row] = -glm::dot(rows[row], camera.position);
  }
  m[3][2] = near;
  return m;
}

}  // namespace

GBuffer::GBuffer(const ShaderText& text, int width, int height)
    : triangles_(text),
      resolve_(Program::compute(text, "gl/points.comp")),
      seen_(GL_R32UI, width, height),
      depth_(GL_DEPTH_COMPONENT32F, width, height),
      points_(GL_RGBA32F, width, height, kPointLayers) {
  glCreateFramebuffers(1, &framebuffer_);
  glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, seen_.id(), 0);
  glNamedFramebufferTexture(framebuffer_, GL_DEPTH_ATTACHMENT, depth_.id(), 0);
}

GBuffer::~GBuffer() {
  glDeleteFramebuffers(1, &framebuffer_);
}

void GBuffer::draw(const SceneBuffers& scene, const Camera& camera, vec2 inside, float scene_radius) {
  triangles_.draw(scene, framebuffer_, width(), height(), projection(camera, inside, 1e-5f * scene_radius));

  resolve_.use();
  resolve_.set("size", ivec2(width(), height()));
  resolve_.set("inside", inside);
  resolve_.set("eye", camera.position);
  resolve_.set("right", camera.right), resolve_.set("up", camera.up), resolve_.set("forward", camera.forward);
  resolve_.set("half_height", std::tan(0.5f * camera.vertical_fov));
  resolve_.set("sphere_count", scene.spheres());
  seen_.bind(units::kVisibility);
  points_.bind_image(0);
  glDispatchCompute((width() + 7) / 8, (height() + 7) / 8, 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

void GBuffer::bind() const {
  points_.bind(units::kPoints);
}

std::vector<GBuffer::Pixel> GBuffer::read() const {
  const std::vector<vec4> position = points_.read_rgba(0), z = points_.read_rgba(3),
                          emitted = points_.read_rgba(4), albedo = points_.read_rgba(5);
  std::vector<Pixel> pixels(position.size());
  for (size_t i = 0; i < pixels.size(); ++i) {
    Pixel& p = pixels[i];
    p.depth = position[i].w;
    if (!(p.depth > 0)) continue;
    p.normal = vec3(z[i]), p.emitted = vec3(emitted[i]), p.albedo = vec3(albedo[i]);
    p.shape = static_cast<uint32_t>(emitted[i].w), p.primitive = static_cast<uint32_t>(albedo[i].w);
  }
  return pixels;
}

}  // namespace zonal::gl
