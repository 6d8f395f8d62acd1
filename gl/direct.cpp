#include "gl/direct.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "gl/units.h"

namespace zonal::gl {
namespace {

/// One map: which way it looks, and how a point of the world gets its place and depth there.
struct View {
  mat4 to_clip{0};
  float texel = 0;  ///< radians of a texel in the middle, or metres of a directional light's
};

void set_rows(mat4& m, vec3 origin, const vec3 (&rows)[4]) {
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 3; ++column) m[column][row] = rows[row][column];
    m[3][row] = -glm::dot(rows[row], origin);
  }
}

/// Depth is near / distance along `frame.z`.
View perspective(vec3 origin, const Frame& frame, float half_angle, float near) {
  View view;
  const float tangent = std::tan(half_angle);
  set_rows(view.to_clip, origin, {frame.x / tangent, frame.y / tangent, vec3(0), frame.z});
  view.to_clip[3][2] = near;
  view.texel = 2 * tangent / DirectLight::kMapSize;
  return view;
}

/// All of the scene's bounding sphere; depth is 1 where the light enters it and 0 where it leaves.
View parallel(const BoundingSphere& bounds, vec3 direction) {
  View view;
  const Frame frame(direction);
  const float r = bounds.radius * 1.001f;
  set_rows(view.to_clip, bounds.center, {frame.x / r, frame.y / r, -frame.z / (2 * r), vec3(0)});
  view.to_clip[3][2] += 0.5f;
  view.to_clip[3][3] = 1;
  view.texel = 2 * r / DirectLight::kMapSize;
  return view;
}

/// A light in the numbers of gl/direct.comp.
struct Source {
  int kind = 0;  ///< 0 point, 1 spot, 2 directional
  vec3 position{0}, direction{0, -1, 0}, intensity{0};
  vec3 cone{0, 1, 1};  ///< v_inner, v_outer, v_edge
  std::vector<View> views;
};

Source source_of(const Light& light, const BoundingSphere& bounds) {
  Source s;
  const float near = 1e-3f * bounds.radius;
  if (const auto* point = dynamic_cast<const PointLight*>(&light)) {
    s.position = point->position, s.intensity = point->intensity;
    for (int axis = 0; axis < 3; ++axis)
      for (const float side : {1.0f, -1.0f}) {
        vec3 z(0);
        z[axis] = side;
        // A little more than a quarter turn, so that filters find what is beyond the edge.
        s.views.push_back(perspective(point->position, Frame(z), 0.5f * 1.5707964f + 0.02f, near));
      }
  } else if (const auto* spot = dynamic_cast<const SpotLight*>(&light)) {
    s.kind = 1, s.position = spot->position, s.direction = spot->direction, s.intensity = spot->intensity;
    s.cone = vec3(spot->cone.v_inner, spot->cone.v_outer, spot->cone.v_edge);
    s.views.push_back(
        perspective(spot->position, Frame(spot->direction), std::min(spot->cone.outer + 0.01f, 1.5f), near));
  } else if (const auto* sun = dynamic_cast<const DirectionalLight*>(&light)) {
    s.kind = 2, s.direction = sun->direction, s.intensity = sun->irradiance;
    s.views.push_back(parallel(bounds, sun->direction));
  }
  return s;
}

}  // namespace

DirectLight::DirectLight(const ShaderText& text, const Scene& scene)
    : scene_(scene),
      triangles_(text),
      shade_(Program::compute(text, "gl/direct.comp")),
      maps_(GL_DEPTH_COMPONENT32F, kMapSize, kMapSize, 6) {
  for (const auto& light : scene.lights())
    if (!light->is_delta())
      throw SceneError(fmt::format(
          "--backend gl: /direct: found \"sampled\" with the light \"{}\" ({}), expected \"none\", or "
          "point, spot and directional lights alone",
          light->name, light->type()));
  glCreateFramebuffers(6, framebuffers_);
  for (int i = 0; i < 6; ++i)
    glNamedFramebufferTextureLayer(framebuffers_[i], GL_DEPTH_ATTACHMENT, maps_.id(), 0, i);
  glCreateSamplers(1, &sampler_);
  glSamplerParameteri(sampler_, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glSamplerParameteri(sampler_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glSamplerParameteri(sampler_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(sampler_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(sampler_, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glSamplerParameteri(sampler_, GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL);
}

DirectLight::~DirectLight() {
  glDeleteFramebuffers(6, framebuffers_);
  glDeleteSamplers(1, &sampler_);
}

void DirectLight::add(const SceneBuffers& buffers, const GBuffer& points, const Texture2D& sum) {
  buffers.bind();
  shade_.set("size", ivec2(points.width(), points.height()));
  shade_.set("sphere_count", buffers.spheres());
  for (const auto& light : scene_.lights()) {
    const Source s = source_of(*light, scene_.bounds());
    for (size_t i = 0; i < s.views.size(); ++i) {
      triangles_.draw(buffers, framebuffers_[i], kMapSize, kMapSize, s.views[i].to_clip);
      shade_.set(fmt::format("to_clip[{}]", i).c_str(), s.views[i].to_clip);
    }
    shade_.use();
    shade_.set("kind", s.kind), shade_.set("faces", static_cast<int>(s.views.size()));
    shade_.set("source", s.position), shade_.set("axis", s.direction), shade_.set("intensity", s.intensity);
    shade_.set("cone", s.cone), shade_.set("texel", s.views[0].texel);
    points.bind();
    sum.bind_image(1);
    maps_.bind(units::kMethod);
    glBindSampler(units::kMethod, sampler_);
    glDispatchCompute((points.width() + 7) / 8, (points.height() + 7) / 8, 1);
    glBindSampler(units::kMethod, 0);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
  }
}

}  // namespace zonal::gl
