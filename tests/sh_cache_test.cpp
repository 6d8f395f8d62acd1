// Projections kept by content on disk: the same bits, and no trust in what lies there.
#include "materials/sh_cache.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "tests/sh_materials_support.h"

namespace zonal::test {
namespace {

using ShCache = OwnCache;

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

MetallicRoughnessMaterial plain() {
  MetallicRoughnessMaterial m;
  m.roughness.value = 0.7f;
  return m;
}

TEST_F(ShCache, the_cache_gives_the_same_bits) {
  const auto once = [&] {
    const ShMaterials materials(list_of(plain()), {.bands = 3});
    return looked_up(materials, plain().at(vec2(0)), ShTable::brdf, direction(33.3f, 5), 3);
  };
  const Coefficients projected = once();
  ASSERT_EQ(files().size(), 1u);
  const auto written = fs::last_write_time(files()[0]);
  EXPECT_EQ(once(), projected);
  ASSERT_EQ(files().size(), 1u);
  EXPECT_EQ(fs::last_write_time(files()[0]), written) << "read, not made anew";
}

TEST_F(ShCache, damaged_and_foreign_files_of_the_cache_are_made_anew) {
  const auto once = [&] {
    const ShMaterials materials(list_of(plain()), {.bands = 3});
    return looked_up(materials, plain().at(vec2(0)), ShTable::brdf, direction(33.3f, 5), 3);
  };
  const Coefficients truth = once();
  ASSERT_EQ(files().size(), 1u);
  const fs::path file = files()[0];
  const std::string whole = bytes_of(file);
  std::string flipped = whole;
  flipped[flipped.size() / 2] = char(flipped[flipped.size() / 2] ^ 4);
  for (const std::string& damaged : {std::string(), whole.substr(0, 100), flipped, std::string("text")}) {
    std::ofstream(file, std::ios::binary) << damaged;
    EXPECT_EQ(once(), truth);
    EXPECT_EQ(bytes_of(file), whole);
  }
  // Another material's table under this name.
  ShProjection other = project_material(lambert(vec3(0.1f)).bsdf, {.bands = 1});
  other.source = "another";
  const std::vector<std::byte> bytes = write_shmat(other);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  EXPECT_EQ(once(), truth);
  EXPECT_EQ(bytes_of(file), whole);
}

TEST_F(ShCache, without_a_place_for_the_cache_it_goes_on) {
  std::ofstream(folder.string()) << "a file where the folder should be";
  const ShMaterials materials(list_of(plain()), {.bands = 2});
  EXPECT_EQ(materials.max_bands(), 2);
}

TEST_F(ShCache, settings_and_contents_have_keys_of_their_own) {
  const Bsdf b = plain().at(vec2(0));
  Bsdf other = b;
  other.alpha_x = std::nextafter(b.alpha_x, 1.0f);
  const std::set<std::string> keys = {projection_key(b, {}), projection_key(other, {}),
                                      projection_key(b, {.bands = 9}), projection_key(b, {.share = 0.9f}),
                                      projection_key(b, {.window = "hann"})};
  EXPECT_EQ(keys.size(), 5u);
  EXPECT_EQ(projection_key(b, {}), projection_key(plain().at(vec2(0.9f)), {}));
}

}  // namespace
}  // namespace zonal::test
