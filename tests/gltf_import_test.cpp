/// glTF and GLB: nodes, cameras, lights, materials and pictures, against the numbers in the file.

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/mesh_import.h"
#include "tests/mesh_files.h"

using namespace zonal;
using namespace zonal::test;

namespace {

const char* kPlain = R"({"name":"paint","pbrMetallicRoughness":{"baseColorFactor":[0.5,1,0.5,1],
  "baseColorTexture":{"index":0},"metallicFactor":0.25,"roughnessFactor":0.75}})";

/// A colour as the file's bytes decode.
struct Gltf : testing::Test {
  Folder folder;
  std::string picture;
  void SetUp() override {
    // Four rows red, four rows blue.
    std::vector<uint8_t> rows;
    for (int y = 0; y < 8; ++y)
      rows.insert(rows.end(), {uint8_t(y < 4 ? 255 : 0), 0, uint8_t(y < 4 ? 0 : 255)});
    folder.png("red_over_blue.png", 1, 8, 3, rows);
    picture = folder.read("red_over_blue.png");
  }
  ImportedFile load(const std::string& material) {
    return import_mesh(
        folder.write("scene.gltf", GltfScene(picture, false, material).gltf("red_over_blue.png")), {});
  }
};

/// What both containers must say.
void check(const ImportedFile& f) {
  ASSERT_EQ(f.shapes.size(), 1u);
  const MeshData& mesh = f.shapes[0].mesh;
  ASSERT_EQ(mesh.triangles.size(), 1u);
  // The node scales by 2, then moves by (1, 2, 3).
  const vec3 corners[3] = {{1, 2, 3}, {3, 2, 3}, {1, 4, 3}};
  const auto& paint = dynamic_cast<const MetallicRoughnessMaterial&>(*f.materials[f.shapes[0].material]);
  EXPECT_EQ(paint.name, "paint");
  // The file's uvs are (0,0), (1,0), (0,1) with v downwards: the third corner lies at the picture's lower
  // edge, blue.
  for (int k = 0; k < 3; ++k) {
    const uint32_t i = mesh.triangles[0][k];
    EXPECT_EQ(mesh.positions[i], corners[k]);
    const vec2 inwards = glm::mix(mesh.uvs[i], vec2(0.5f), 0.2f);  // away from the repeating edge
    const vec3 expected = k == 2 ? vec3(0, 0, 0.5f) : vec3(0.5f, 0, 0);
    EXPECT_LT(length(paint.base_color.at(inwards) - expected), 1e-6f) << "corner " << k;
  }
  EXPECT_EQ(paint.metallic.at({0, 0}), 0.25f);
  EXPECT_EQ(paint.roughness.at({0, 0}), 0.75f);

  ASSERT_EQ(f.cameras.size(), 1u);
  EXPECT_EQ(f.camera_names[0], "eye");
  const Camera& eye = f.cameras[0];
  EXPECT_NEAR(eye.vertical_fov, 0.7f, 1e-5f);
  EXPECT_EQ(eye.position, vec3(0, 1, 5));
  // Turned by 90 degrees about +y: -z becomes -x.
  EXPECT_LT(length(eye.forward - vec3(-1, 0, 0)), 1e-6f);
  EXPECT_LT(length(eye.up - vec3(0, 1, 0)), 1e-6f);
  EXPECT_LT(length(eye.right - vec3(0, 0, -1)), 1e-6f);
  EXPECT_NEAR(float(eye.width) / eye.height, 1.5f, 0.01f);

  ASSERT_EQ(f.lights.size(), 3u);
  const auto& bulb = dynamic_cast<const PointLight&>(*f.lights[0]);
  EXPECT_EQ(bulb.name, "bulb");
  EXPECT_EQ(bulb.position, vec3(4, 5, 6));
  EXPECT_EQ(bulb.intensity, vec3(8, 4, 2));
  const auto& torch = dynamic_cast<const SpotLight&>(*f.lights[1]);
  EXPECT_EQ(torch.position, vec3(0, 3, 0));
  // Turned by -90 degrees about x: -z becomes -y.
  EXPECT_LT(length(torch.direction - vec3(0, -1, 0)), 1e-6f);
  EXPECT_EQ(torch.intensity, vec3(2));
  EXPECT_NEAR(torch.cone.inner, 0.2f, 1e-6f);
  EXPECT_NEAR(torch.cone.outer, 0.6f, 1e-6f);
  const auto& sun = dynamic_cast<const DirectionalLight&>(*f.lights[2]);
  EXPECT_LT(length(sun.direction - vec3(0, -1, 0)), 1e-6f);
  EXPECT_EQ(sun.irradiance, vec3(3));
}

}  // namespace

TEST_F(Gltf, text_with_a_picture_beside_it) {
  check(load(kPlain));
}

TEST_F(Gltf, text_with_everything_inside) {
  const GltfScene scene(picture, false, kPlain);
  check(import_mesh(folder.write("inside.gltf", scene.gltf("data:image/png;base64," + base64(picture))), {}));
}

TEST_F(Gltf, binary_with_an_embedded_picture) {
  const GltfScene scene(picture, true, kPlain);
  check(import_mesh(folder.write("scene.glb", scene.glb()), {}));
}

TEST_F(Gltf, roughness_is_green_and_metalness_blue) {
  folder.png("red_over_blue.png", 1, 1, 3, {10, 51, 204});
  const ImportedFile f = load(R"({"name":"m","pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0},
    "metallicFactor":0.5,"roughnessFactor":1}})");
  const auto& m = dynamic_cast<const MetallicRoughnessMaterial&>(*f.materials[0]);
  EXPECT_NEAR(m.roughness.at({0, 0}), 51 / 255.0f, 1e-6f);
  EXPECT_NEAR(m.metallic.at({0, 0}), 0.5f * 204 / 255.0f, 1e-6f);
  EXPECT_EQ(m.base_color.texture, nullptr);
}

TEST_F(Gltf, normal_maps_are_linear_and_scaled) {
  folder.png("red_over_blue.png", 1, 1, 3, {188, 128, 230});
  const ImportedFile f = load(R"({"name":"m","normalTexture":{"index":0,"scale":0.5}})");
  ASSERT_NE(f.materials[0]->normal_map, nullptr);
  EXPECT_NEAR(f.materials[0]->normal_map->rgb({0, 0}).x, 188 / 255.0f, 1e-6f);
  EXPECT_EQ(f.materials[0]->normal_scale, 0.5f);
}

TEST_F(Gltf, masks_cut_below_the_cutoff_and_only_when_asked) {
  folder.png("red_over_blue.png", 2, 1, 4, {255, 255, 255, 60, 255, 255, 255, 100});
  const std::string base = R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";
  const ImportedFile masked = load(R"({"name":"m","alphaMode":"MASK","alphaCutoff":0.3,)" + base);
  EXPECT_TRUE(masked.materials[0]->masked({0.25f, 0.5f}));   // 60 / 255 = 0.24
  EXPECT_FALSE(masked.materials[0]->masked({0.75f, 0.5f}));  // 0.39
  EXPECT_EQ(load(R"({"name":"m",)" + base).materials[0]->mask, nullptr);
  const ImportedFile blended = load(R"({"name":"m","alphaMode":"BLEND",)" + base);
  EXPECT_TRUE(blended.materials[0]->masked({0.75f, 0.5f}));
  ASSERT_FALSE(blended.notes.empty());
  EXPECT_NE(blended.notes[0].find("alpha blending is ignored"), std::string::npos);
}

TEST_F(Gltf, emission_is_the_factor_times_the_mean_of_the_texture) {
  const ImportedFile f =
      load(R"({"name":"m","doubleSided":true,"emissiveFactor":[1,0.5,0.5],"emissiveTexture":{"index":0}})");
  EXPECT_LT(length(f.emission[0] - vec3(0.5f, 0, 0.25f)), 1e-6f);  // half of it red, half blue
  EXPECT_TRUE(f.emission_two_sided[0]);
}

TEST_F(Gltf, lights_can_be_left_out_and_units_scale_places_but_not_intensities) {
  const std::string file =
      folder.write("scene.gltf", GltfScene(picture, false, kPlain).gltf("red_over_blue.png"));
  ImportOptions dark, small;
  dark.lights = false, small.metres_per_unit = 0.1f;
  EXPECT_TRUE(import_mesh(file, dark).lights.empty());
  const ImportedFile f = import_mesh(file, small);
  EXPECT_LT(length(dynamic_cast<const PointLight&>(*f.lights[0]).position - vec3(0.4f, 0.5f, 0.6f)), 1e-6f);
  EXPECT_EQ(dynamic_cast<const PointLight&>(*f.lights[0]).intensity, vec3(8, 4, 2));
  EXPECT_LT(length(f.cameras[0].position - vec3(0, 0.1f, 0.5f)), 1e-6f);
}

TEST_F(Gltf, a_missing_or_broken_picture_is_named_with_its_material) {
  const auto message = [](const std::string& file) -> std::string {
    try {
      import_mesh(file, {});
    } catch (const SceneError& e) {
      return e.what();
    }
    return "no error";
  };
  const std::string missing =
      folder.write("missing.gltf", GltfScene(picture, false, kPlain).gltf("gone.png"));
  EXPECT_EQ(message(missing), missing + ": material \"paint\": texture \"gone.png\" is missing (looked for " +
                                  folder.path("gone.png") + ")");
  const GltfScene cut(picture.substr(0, picture.size() / 2), true, kPlain);
  const std::string broken = folder.write("broken.glb", cut.glb());
  const std::string found = message(broken);
  EXPECT_EQ(found.find(broken + ": material \"paint\": "), 0u) << found;
}

TEST_F(Gltf, names_with_escaped_spaces_are_found) {
  std::filesystem::copy_file(folder.path("red_over_blue.png"), folder.path("red over blue.png"));
  const std::string file =
      folder.write("s.gltf", GltfScene(picture, false, kPlain).gltf("red%20over%20blue.png"));
  check(import_mesh(file, {}));
}
