// "camera": a pinhole that looks at a point, or one that an imported file brings.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/loading.h"

namespace zonal {
namespace {

using glm::dvec3;
using nlohmann::json;

/// A picture's layers take about 200 bytes a pixel while it is rendered.
constexpr double kMostPixels = 1 << 28;
constexpr Range kSide{1, 65536};

/// "from" and "object": the camera of an imported file.
Camera imported_camera(const Loading& loading, Fields& fields, const json& from) {
  std::vector<const ImportedCameras*> candidates;
  const std::string object = fields.text("object", "");
  std::vector<std::string> objects;
  for (const ImportedCameras& imported : loading.imported_cameras) {
    objects.push_back(imported.object);
    if (object.empty() ? !imported.cameras.empty() : imported.object == object)
      candidates.push_back(&imported);
  }
  if (!object.empty() && candidates.empty())
    fields.fail("object", fmt::format("found {}, expected the name of a mesh object{}", in_quotes(object),
                                      did_you_mean(object, objects)));
  if (candidates.empty() || candidates[0]->cameras.empty())
    fields.fail("from", "found " + describe(from) + ", but no imported file has a camera");
  if (candidates.size() > 1)
    fields.fail("from", "found cameras in more than one imported file, expected \"object\" to say which");

  const ImportedCameras& file = *candidates[0];
  if (from.is_number()) {
    const double last = static_cast<double>(file.cameras.size()) - 1;
    return file.cameras[static_cast<size_t>(read_integer(from, fields.at("from"), {0, last}))];
  }
  const std::string name = read_text(from, fields.at("from"));
  for (size_t i = 0; i < file.cameras.size(); ++i)
    if (file.names[i] == name) return file.cameras[i];
  fields.fail("from", fmt::format("found {}, expected a camera of {}{}", in_quotes(name),
                                  in_quotes(file.object), did_you_mean(name, file.names)));
}

/// Turns the camera towards a point; in double, because the point may be far away.
void look_at(Fields& fields, Camera& camera, vec3 target, dvec3 up, bool up_given) {
  const dvec3 way = dvec3(target) - dvec3(camera.position);
  if (glm::length(way) == 0)
    fields.fail("look_at", fmt::format("found the camera's own position [{}, {}, {}], expected another point",
                                       target.x, target.y, target.z));
  const dvec3 forward = glm::normalize(way);
  dvec3 right = glm::cross(forward, glm::normalize(up));
  if (glm::length(right) < 1e-6 && up_given)
    fields.fail("up", "found the viewing direction itself, expected a vector across it");
  // Straight up or down with the default "up": the picture's top is -z, north on a map.
  if (glm::length(right) < 1e-6) right = glm::cross(forward, dvec3(0, 0, -1));
  right = glm::normalize(right);
  camera.forward = vec3(forward);
  camera.right = vec3(right);
  camera.up = vec3(glm::cross(right, forward));
}

void read_resolution(Fields& fields, Camera& camera, const LoadOptions& options) {
  if (const json* value = fields.find("resolution")) {
    const std::string where = fields.at("resolution");
    const auto sides = read_array(*value, where, "width and height in pixels");
    if (sides.size() != 2)
      fields.fail("resolution", "found " + describe(*value) + ", expected [width, height] in pixels");
    camera.width = read_integer(sides[0], where_of(where, size_t(0)), kSide);
    camera.height = read_integer(sides[1], where_of(where, size_t(1)), kSide);
  }
  if (options.width > 0) camera.width = options.width;
  if (options.height > 0) camera.height = options.height;
  const double pixels = static_cast<double>(camera.width) * camera.height;
  if (!kSide.contains(camera.width) || !kSide.contains(camera.height) || pixels > kMostPixels)
    fields.fail("resolution", fmt::format("found {} x {} pixels, expected sides {} and at most {:.0f} pixels",
                                          camera.width, camera.height, kSide.text(), kMostPixels));
}

}  // namespace

Camera read_camera(const Loading& loading, const json& value, const std::string& where,
                   const LoadOptions& options) {
  Fields fields(value, where);
  Camera camera;
  const json* from = fields.find("from");
  if (from) {
    camera = imported_camera(loading, fields, *from);
  } else {
    camera.vertical_fov = 40 * (kPi / 180);
    if (fields.find("object")) fields.fail("object", "found without \"from\", expected both or neither");
  }

  const bool up_given = fields.has("up");
  const bool turned = fields.find("look_at") || !from;
  if (fields.has("position") || !from) camera.position = read_point(fields, "position");
  fields.find("position");
  if (up_given && !turned)
    fields.fail("up", "found without \"look_at\", expected both or neither with \"from\"");
  const vec3 up = up_given ? read_direction(fields, "up") : vec3(0, 1, 0);
  fields.find("up");
  if (turned) look_at(fields, camera, read_point(fields, "look_at"), dvec3(up), up_given);

  const Range angle{.low = 0, .high = 180, .open_low = true, .open_high = true};
  if (fields.find("vertical_fov")) camera.vertical_fov = fields.number("vertical_fov", angle) * (kPi / 180);
  camera.exposure =
      fields.number("exposure", camera.exposure, {.low = 0, .high = kBrightest, .open_low = true});
  read_resolution(fields, camera, options);
  fields.finish();
  return camera;
}

}  // namespace zonal
