/// The Crytek Sponza, when the data folder is there: counts from its provenance page, and what one sees in
/// it.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>

#include "core/mesh_import.h"

using namespace zonal;

TEST(Sponza, loads_with_its_textures_and_masks_and_without_the_stray_banner) {
  const char* data = std::getenv("ZONAL_DATA");
  if (!data) GTEST_SKIP() << "ZONAL_DATA is not set: the large scenes are not bundled";
  const std::string file = std::string(data) + "/scenes/crytek-sponza/sponza.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";

  ImportOptions options;
  options.metres_per_unit = 0.01f;
  options.exclude = {"sponza_04"};
  ImportedFile f = import_mesh(file, options);
  size_t triangles = 0;
  for (const ShapeData& s : f.shapes) triangles += s.mesh.triangles.size();
  EXPECT_EQ(triangles, 279163u - 16896u);  // the file's `f` lines; those of object sponza_04
  EXPECT_EQ(f.shapes.size(), 25u);         // one for each of the 26 materials but the banner's
  std::set<std::string> masked;
  for (const auto& m : f.materials) {
    if (m->mask) masked.insert(m->name);
  }
  EXPECT_EQ(masked, (std::set<std::string>{"Material__57", "chain", "leaf"}));  // those with map_d

  SceneParts parts;
  parts.shapes = std::move(f.shapes), parts.materials = std::move(f.materials);
  parts.textures = std::move(f.textures);
  const Scene scene(std::move(parts));
  // One triangle of column_b uses a vertex twice.
  EXPECT_EQ(scene.triangle_count(), triangles - 1);
  // The court lies along x and is open to the sky.
  const vec3 middle(0, 2, 0);
  EXPECT_EQ(scene.material(scene.surface(scene.intersect(middle, {0, -1, 0}), {0, -1, 0}).material).name,
            "floor");
  EXPECT_FALSE(scene.intersect(middle, {0, 1, 0}).found());
  EXPECT_GT(scene.intersect(middle, {1, 0, 0}).t, 2 * scene.intersect(middle, {0, 0, 1}).t);
}
