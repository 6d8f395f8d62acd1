#include "core/mesh_cameras.h"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <string_view>

#include "core/assimp_types.h"

namespace zonal {

namespace {

/// World transform of the node that carries a camera's or light's name.
mat4 node_to_world(const aiScene& scene, const aiString& name, const mat4& to_world) {
  mat4 chain(1);
  for (const aiNode* n = scene.mRootNode->FindNode(name); n; n = n->mParent) {
    chain = to_mat4(n->mTransformation) * chain;
  }
  return to_world * chain;
}

vec3 point(const mat4& m, const aiVector3D& p) {
  return vec3(m * vec4(to_vec3(p), 1));
}

/// Turned by the transform and unit; `otherwise` when nothing is left of it.
vec3 direction(const mat4& m, const aiVector3D& d, vec3 otherwise) {
  const vec3 turned = mat3(m) * to_vec3(d);
  const float length = glm::length(turned);
  return length > 0 && std::isfinite(length) ? turned / length : otherwise;
}

/// Undoes what Assimp's glTF reader makes of the vertical angle. Its header promises half the horizontal
/// angle; 5.2 stores the vertical one times the aspect ratio, 5.4 the whole horizontal one. Which it is, a
/// camera of one radian tells.
float vertical_angle(float stored, float aspect) {
  static const bool is_product = [] {
    const std::string_view probe =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"camera":0}],"cameras":[)"
        R"({"type":"perspective","perspective":{"yfov":1,"aspectRatio":2,"znear":0.1}}]})";
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFileFromMemory(probe.data(), probe.size(), 0, "gltf");
    return scene && scene->mNumCameras == 1 && std::abs(scene->mCameras[0]->mHorizontalFOV - 2) < 1e-3f;
  }();
  return is_product ? stored / aspect : 2 * std::atan(std::tan(0.5f * stored) / aspect);
}

}  // namespace

void import_cameras(const aiScene& scene, const mat4& to_world, ImportedFile& result) {
  for (unsigned i = 0; i < scene.mNumCameras; ++i) {
    const aiCamera& source = *scene.mCameras[i];
    const mat4 m = node_to_world(scene, source.mName, to_world);
    Camera camera;
    // The node's own place: mPosition repeats its translation.
    camera.position = vec3(m[3]);
    camera.forward = direction(m, source.mLookAt, vec3(0, 0, -1));
    const vec3 right = glm::cross(camera.forward, direction(m, source.mUp, vec3(0, 1, 0)));
    // Looking straight along "up": any sideways direction will do.
    camera.right = glm::length(right) > 1e-6f ? glm::normalize(right) : Frame(camera.forward).x;
    camera.up = glm::cross(camera.right, camera.forward);
    // The angle was made with the aspect ratio, or with 1 where the file has none.
    const float aspect = source.mAspect > 0 ? source.mAspect : 1;
    const float fov = vertical_angle(source.mHorizontalFOV, aspect);
    if (fov > 0 && fov < kPi) camera.vertical_fov = fov;
    if (source.mAspect > 0)
      camera.width = int(std::clamp(std::round(camera.height * aspect), 1.0f, 16384.0f));
    if (!is_finite(camera.position)) continue;
    result.cameras.push_back(camera);
    result.camera_names.push_back(source.mName.C_Str());
  }
}

void import_lights(const aiScene& scene, const std::string& file, const mat4& to_world,
                   ImportedFile& result) {
  for (unsigned i = 0; i < scene.mNumLights; ++i) {
    const aiLight& source = *scene.mLights[i];
    const mat4 m = node_to_world(scene, source.mName, to_world);
    const vec3 color(source.mColorDiffuse.r, source.mColorDiffuse.g, source.mColorDiffuse.b);
    const vec3 position = point(m, source.mPosition),
               towards = direction(m, source.mDirection, vec3(0, -1, 0));
    if (!is_finite(color) || !is_finite(position)) continue;
    std::unique_ptr<Light> light;
    if (source.mType == aiLightSource_POINT) {
      auto p = std::make_unique<PointLight>();
      p->position = position, p->intensity = color;
      light = std::move(p);
    } else if (source.mType == aiLightSource_SPOT) {
      auto s = std::make_unique<SpotLight>();
      s->position = position, s->direction = towards, s->intensity = color;
      // glTF's are half angles up to pi/2; ours stay below.
      s->cone = {source.mAngleInnerCone, std::clamp(source.mAngleOuterCone, 1e-3f, 0.5f * kPi - 1e-3f)};
      light = std::move(s);
    } else if (source.mType == aiLightSource_DIRECTIONAL) {
      auto d = std::make_unique<DirectionalLight>();
      d->direction = towards, d->irradiance = color;
      light = std::move(d);
    } else {
      result.notes.push_back(
          fmt::format("{}: light \"{}\" is of a kind that is ignored", file, source.mName.C_Str()));
      continue;
    }
    light->name = source.mName.C_Str();
    result.lights.push_back(std::move(light));
  }
  if (!result.lights.empty()) {
    result.notes.push_back(
        fmt::format("{}: {} lights; candela and lux are read as W/sr and W/m^2", file, result.lights.size()));
  }
}

}  // namespace zonal
