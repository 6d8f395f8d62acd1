#include "gl/sh_tables.h"

#include <cstring>
#include <map>

#include "materials/zonal_lobes.h"

namespace zonal::gl {

TextureBuffer zonal_lobe_texels() {
  std::vector<vec4> texels;
  for (const bool ggx : {true, false}) {
    const std::span<const float> rows = zonal_lobe_table(ggx);
    for (size_t i = 0; i < rows.size(); i += 4)
      texels.emplace_back(rows[i], rows[i + 1], rows[i + 2], rows[i + 3]);
  }
  return TextureBuffer(std::span<const vec4>(texels));
}

ShTables::ShTables(const ShMaterials& materials, uint32_t count) {
  std::vector<uint32_t> words;
  std::map<const ShMaterial*, uint32_t> places;
  // Two texels a material, then one a level: roughness and where the file starts.
  std::vector<vec4> records(2 * size_t(count));
  for (uint32_t m = 0; m < count; ++m) {
    const ShMaterials::Tables tables = materials.tables(m);
    const auto first = static_cast<float>(records.size());
    for (const auto& level : tables.levels) {
      const auto [place, fresh] = places.try_emplace(level.table, static_cast<uint32_t>(words.size()));
      if (fresh) {
        const auto bytes = level.table->bytes();
        words.resize(words.size() + (bytes.size() + 3) / 4);
        std::memcpy(words.data() + place->second, bytes.data(), bytes.size());
      }
      // Where a file starts may need more digits than a float has.
      records.emplace_back(level.roughness, float(place->second >> 12), float(place->second & 4095u), 0.0f);
    }
    const bool several = tables.levels.size() > 1;
    records[2 * m] = vec4(float(tables.kind), float(tables.levels.size()), first, 0.0f);
    records[2 * m + 1] = several ? vec4(tables.levels[0].roughness,
                                        tables.levels[1].roughness - tables.levels[0].roughness, 0, 0)
                                 : vec4(0.0f);
  }
  words_ = TextureBuffer(std::span<const uint32_t>(words));
  records_ = TextureBuffer(std::span<const vec4>(records));
}

}  // namespace zonal::gl
