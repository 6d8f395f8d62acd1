// Materials of a scene file: their numbers, and what a picture in each slot means.

#include <gtest/gtest.h>

#include "materials/material.h"
#include "tests/support.h"

namespace zonal {
namespace {

using test::scene_from;

Scene scene_with(const std::string& rest) {
  return scene_from(R"({"camera": {"position": [0, 0, 9], "look_at": [0, 0, 0]}, )" + rest + "}");
}

bool noted(const Scene& scene, const std::string& text) {
  for (const std::string& note : scene.notes())
    if (note.find(text) != std::string::npos) return true;
  return false;
}

/// The only material of a scene with one ball.
template <class Kind>
const Kind& only_material(const Scene& scene) {
  const auto* material = dynamic_cast<const Kind*>(&scene.material(0));
  if (!material) throw std::runtime_error("another kind of material");
  return *material;
}

Scene ball_of(const std::string& keys) {
  return scene_with(R"("materials": [{"name": "m", )" + keys +
                    R"(}], "objects": [{"type": "sphere", "material": "m"}])");
}

TEST(material, every_kind_with_its_numbers) {
  const Scene a = ball_of(R"("type": "lambert", "albedo": [0.1, 0.2, 0.3])");
  EXPECT_EQ(only_material<LambertMaterial>(a).albedo.value, vec3(0.1f, 0.2f, 0.3f));
  const Scene b = ball_of(R"("type": "blinn_phong", "diffuse": 0.25, "specular": 0.5, "exponent": 200)");
  EXPECT_EQ(only_material<BlinnPhongMaterial>(b).diffuse.value, vec3(0.25f));
  EXPECT_EQ(only_material<BlinnPhongMaterial>(b).specular.value, vec3(0.5f));
  EXPECT_EQ(only_material<BlinnPhongMaterial>(b).exponent, 200.0f);
  const Scene c = ball_of(
      R"("type": "conductor", "eta": [0.1, 0.2, 0.3], "k": 4, "tint": 0.9, "roughness": 0.2, "anisotropy": 0.5)");
  EXPECT_EQ(only_material<ConductorMaterial>(c).eta, vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(only_material<ConductorMaterial>(c).k, vec3(4));
  EXPECT_EQ(only_material<ConductorMaterial>(c).tint.value, vec3(0.9f));
  EXPECT_EQ(only_material<ConductorMaterial>(c).roughness.value, 0.2f);
  EXPECT_EQ(only_material<ConductorMaterial>(c).anisotropy, 0.5f);
  const Scene d =
      ball_of(R"("type": "coated", "albedo": 0.4, "roughness": 0.1, "ior": 1.7, "anisotropy": -0.5)");
  EXPECT_EQ(only_material<CoatedMaterial>(d).albedo.value, vec3(0.4f));
  EXPECT_EQ(only_material<CoatedMaterial>(d).roughness.value, 0.1f);
  EXPECT_EQ(only_material<CoatedMaterial>(d).ior, 1.7f);
  EXPECT_EQ(only_material<CoatedMaterial>(d).anisotropy, -0.5f);
  const Scene e =
      ball_of(R"("type": "metallic_roughness", "base_color": 0.4, "metallic": 0.75, "roughness": 0.1)");
  EXPECT_EQ(only_material<MetallicRoughnessMaterial>(e).base_color.value, vec3(0.4f));
  EXPECT_EQ(only_material<MetallicRoughnessMaterial>(e).metallic.value, 0.75f);
  EXPECT_EQ(only_material<MetallicRoughnessMaterial>(e).roughness.value, 0.1f);
}

TEST(material, a_named_metal_is_the_tables) {
  for (const Metal& metal : metals()) {
    const Scene scene = ball_of(R"("type": "conductor", "metal": ")" + metal.name + "\"");
    EXPECT_EQ(only_material<ConductorMaterial>(scene).eta, metal.eta) << metal.name;
    EXPECT_EQ(only_material<ConductorMaterial>(scene).k, metal.k) << metal.name;
  }
}

TEST(material, without_one_an_object_is_grey) {
  const Scene scene =
      scene_with(R"("objects": [{"type": "sphere"}, {"type": "box", "low": [2, 2, 2], "high": [3, 3, 3]}])");
  EXPECT_EQ(scene.materials().size(), 1u);
  EXPECT_EQ(only_material<LambertMaterial>(scene).albedo.value, vec3(0.5f));
}

TEST(material, one_that_nobody_uses_is_noted) {
  const Scene scene = scene_with(R"("materials": [{"name": "spare", "type": "lambert"}])");
  EXPECT_TRUE(noted(scene, "/materials/0: the material \"spare\" is not used"));
  EXPECT_FALSE(noted(ball_of(R"("type": "lambert")"), "not used"));
}

// flat.png is (128, 64, 32) / 255 everywhere. Decoded by IEC 61966-2-1: ((c + 0.055) / 1.055)^2.4.
const vec3 kFlatLinear(128 / 255.0f, 64 / 255.0f, 32 / 255.0f);
const vec3 kFlatDecoded(0.215861f, 0.051269f, 0.014444f);
constexpr float kTable = 2e-6f;  // the decoded values above have six digits

TEST(texture_slot, colours_are_srgb_and_numbers_linear) {
  const Scene color = ball_of(R"("type": "lambert", "albedo": "scene_files/flat.png")");
  EXPECT_LT(glm::length(only_material<LambertMaterial>(color).albedo.at({0.3f, 0.7f}) - kFlatDecoded),
            kTable);
  const Scene linear =
      ball_of(R"("type": "lambert", "albedo": {"file": "scene_files/flat.png", "encoding": "linear"})");
  EXPECT_LT(glm::length(only_material<LambertMaterial>(linear).albedo.at({0.3f, 0.7f}) - kFlatLinear), 1e-6f);
}

TEST(texture_slot, metallic_reads_blue_and_roughness_green_as_gltf_packs_them) {
  const Scene scene = ball_of(
      R"("type": "metallic_roughness", "metallic": "scene_files/flat.png", "roughness": "scene_files/flat.png")");
  const auto& m = only_material<MetallicRoughnessMaterial>(scene);
  EXPECT_NEAR(m.metallic.at({0, 0}), kFlatLinear.z, 1e-6f);
  EXPECT_NEAR(m.roughness.at({0, 0}), kFlatLinear.y, 1e-6f);
  EXPECT_EQ(m.metallic.texture, m.roughness.texture) << "one file, read twice";
  const Scene packed = ball_of(
      R"("type": "coated", "roughness": {"file": "scene_files/flat.png", "channel": "r", "scale": 0.5})");
  EXPECT_NEAR(only_material<CoatedMaterial>(packed).roughness.at({0, 0}), 0.5f * kFlatLinear.x, 1e-6f);
  const Scene plain = ball_of(R"("type": "conductor", "roughness": "scene_files/flat.png")");
  EXPECT_NEAR(only_material<ConductorMaterial>(plain).roughness.at({0, 0}), kFlatLinear.y, 1e-6f);
}

TEST(texture_slot, the_scale_of_a_colour_is_a_colour) {
  const Scene scene =
      ball_of(R"("type": "lambert", "albedo": {"file": "scene_files/flat.png", "scale": [1, 0.5, 0]})");
  EXPECT_LT(
      glm::length(only_material<LambertMaterial>(scene).albedo.at({0, 0}) - kFlatDecoded * vec3(1, 0.5f, 0)),
      kTable);
}

TEST(texture_slot, each_file_and_encoding_is_read_once) {
  const Scene scene = scene_with(R"("materials": [
      {"name": "a", "type": "lambert", "albedo": "scene_files/flat.png"},
      {"name": "b", "type": "lambert", "albedo": "scene_files/../scene_files/flat.png"},
      {"name": "c", "type": "lambert", "albedo": {"file": "scene_files/flat.png", "encoding": "linear"}}])");
  const auto texture = [&](uint32_t i) {
    return dynamic_cast<const LambertMaterial&>(scene.material(i)).albedo.texture;
  };
  EXPECT_EQ(texture(0), texture(1));
  EXPECT_NE(texture(0), texture(2));
}

TEST(texture_slot, a_mask_reads_alpha_where_there_is_one_else_red) {
  // alpha.png is white with alpha 51 / 255 = 0.2.
  const Scene alpha = ball_of(R"("type": "lambert", "mask": "scene_files/alpha.png", "mask_cutoff": 0.25)");
  EXPECT_EQ(alpha.material(0).mask_channel, 3);
  EXPECT_TRUE(alpha.material(0).masked({0.5f, 0.5f}));
  EXPECT_FALSE(alpha.intersect({0, 0, 9}, {0, 0, -1}).found()) << "the ball is cut away";
  const Scene red = ball_of(R"("type": "lambert", "mask": "scene_files/flat.png", "mask_cutoff": 0.25)");
  EXPECT_EQ(red.material(0).mask_channel, 0);
  EXPECT_TRUE(red.intersect({0, 0, 9}, {0, 0, -1}).found());
  const Scene blue = ball_of(
      R"("type": "lambert", "mask": {"file": "scene_files/flat.png", "channel": "b"}, "mask_cutoff": 0.25)");
  EXPECT_FALSE(blue.intersect({0, 0, 9}, {0, 0, -1}).found());
}

TEST(texture_slot, a_normal_map_keeps_its_strength) {
  const Scene scene =
      ball_of(R"("type": "lambert", "normal_map": "scene_files/normal.png", "normal_scale": 0.5)");
  ASSERT_TRUE(scene.material(0).normal_map);
  EXPECT_EQ(scene.material(0).normal_scale, 0.5f);
  EXPECT_NEAR(scene.material(0).normal_map->rgb({0, 0}).x, 128 / 255.0f, 1e-6f) << "decoded as a colour";
}

}  // namespace
}  // namespace zonal
