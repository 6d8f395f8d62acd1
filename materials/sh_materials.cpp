#include "materials/sh_materials.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/error.h"
#include "materials/material_database.h"
#include "materials/measured_brdf.h"
#include "materials/microfacet.h"
#include "materials/sh_cache.h"
#include "materials/sh_layers.h"
#include "sh/clamped_cosine.h"
#include "sh/zonal.h"

namespace zonal {
namespace {

/// Lambert's lobes of albedo 1: the upper hemisphere's indicator, or the clamped cosine, over pi.
struct LambertTable {
  std::array<float, ShMaterial::kMaxBands> zonal[2];
  /// Bands that hold `share` of the energy of F', which is 2/(3 pi).
  int bands(float share) const {
    double sum = 0;
    for (int l = 0; l < ShMaterial::kMaxBands; ++l) {
      const double z = zonal[int(ShTable::brdf_cosine)][l];
      sum += z * z;
      if (sum >= share * 2.0 / (3 * kPi)) return l + 1;
    }
    return ShMaterial::kMaxBands;
  }
  LambertTable() {
    double z[ShMaterial::kMaxBands];
    sh::cap_zonal(ShMaterial::kMaxBands, sh::cap_from_solid_angle(2 * 3.14159265358979323846), z);
    for (int l = 0; l < ShMaterial::kMaxBands; ++l) zonal[0][l] = static_cast<float>(z[l] / kPi);
    sh::clamped_cosine_zonal(ShMaterial::kMaxBands, z);
    for (int l = 0; l < ShMaterial::kMaxBands; ++l) zonal[1][l] = static_cast<float>(z[l] / kPi);
  }
};
const LambertTable& lambert_table() {
  static const LambertTable table;
  return table;
}

/// Of the energy of F', in every row: what automatic tables hold by default, less the rounding of what is
/// stored.
constexpr float kEnoughShare = 0.9499f;

struct Range {
  float low, high;
};

/// Of what a roughness can be anywhere on the surface: interpolation stays between texels.
Range range_of(const TexturedNumber& number) {
  Range range{number.value, number.value};
  if (const Texture* t = number.texture) {
    const auto row = [&](const tbb::blocked_range<int>& rows, Range r) {
      for (int y = rows.begin(); y < rows.end(); ++y) {
        for (int x = 0; x < t->width(); ++x) {
          const float v = number.at(vec2((x + 0.5f) / t->width(), 1 - (y + 0.5f) / t->height()));
          r = {std::fmin(r.low, v), std::fmax(r.high, v)};
        }
      }
      return r;
    };
    const auto join = [](Range a, Range b) {
      return Range{std::fmin(a.low, b.low), std::fmax(a.high, b.high)};
    };
    range = tbb::parallel_reduce(tbb::blocked_range<int>(0, t->height()), Range{kInfinity, -kInfinity}, row,
                                 join);
  }
  const auto clamp01 = [](float x) { return std::fmin(std::fmax(x, 0.0f), 1.0f); };
  return {clamp01(range.low), clamp01(range.high)};
}

void clear(int coefficients, int stride, float* out) {
  for (int c = 0; c < 3; ++c) std::fill_n(out + c * stride, coefficients, 0.0f);
}

}  // namespace

struct ShMaterials::Impl {
  struct Entry {
    bool lambert = false;
    std::shared_ptr<const ShMaterial> table;  ///< measured
    ShLayers layers;                          ///< all others
  };
  ShMaterialsOptions options;
  std::vector<Entry> entries;
  std::vector<std::string> notes;
  int max_bands = 0;

  ShProjectionOptions projection(int azimuths) const {
    return {.bands = options.bands,
            .share = options.share,
            .most_bands = options.most_bands,
            .azimuths = azimuths};
  }
  /// Rows that hold their share need no further bands; a table that was cut before cannot give more.
  void refuse_missing_bands(const Material& material, const ShMaterial& table) const {
    const int stored = table.max_bands();
    if (options.bands <= stored || describe_projection(table).least_share >= kEnoughShare) return;
    throw SceneError(fmt::format(
        "bands: found {}, expected 1 to {}, which the table of the material \"{}\" holds; \"auto\" "
        "takes what is there, `zonal material project --bands {}` makes more",
        options.bands, stored, material.name, options.bands));
  }
  void add(const Material& material, const Stop& stop);
  void add_layers(const Material& material, const TexturedNumber* roughness, const Stop& stop, Entry* entry);
};

void ShMaterials::Impl::add_layers(const Material& material, const TexturedNumber* roughness,
                                   const Stop& stop, Entry* entry) {
  Bsdf load = ShLayers::load(material.at(vec2(0.5f)));
  bool isotropic = is_isotropic(load);
  std::vector<float> levels;
  const Range range = roughness ? range_of(*roughness) : Range{1, 1};
  if (range.low < range.high) {
    if (!isotropic) {
      notes.push_back(
          "material \"" + material.name +
          "\": anisotropy is left out of its spherical harmonics, because its roughness has a texture");
      isotropic = true;
      if (load.coat) load.coat = &SpecularAlbedo::dielectric(load.eta.x);
    }
    const int first = int(range.low * kRoughnessSteps), last = int(std::ceil(range.high * kRoughnessSteps));
    for (int i = first; i <= last; ++i) levels.push_back(float(i) / kRoughnessSteps);
  }

  const size_t count = std::max<size_t>(levels.size(), 1);
  for (size_t i = 0; i < count; ++i) {
    if (!levels.empty()) load.alpha_x = load.alpha_y = std::fmax(sqr(levels[i]), kMinAlpha);
    const auto tell = [&](double share) {
      if (options.progress) options.progress(material.name, (double(i) + share) / double(count));
    };
    auto table = cached_projection(load, projection(isotropic ? 0 : options.azimuths), stop, tell);
    if (!table) {
      entry->layers = {};
      return;
    }
    max_bands = std::max(max_bands, table->max_bands());
    const bool grams = options.bands == 0 && isotropic && load.kind != BsdfKind::conductor;
    entry->layers.add_level(levels.empty() ? 0.0f : levels[i], std::move(table), grams);
  }
}

void ShMaterials::Impl::add(const Material& material, const Stop& stop) {
  Entry& entry = entries.emplace_back();
  if (dynamic_cast<const LambertMaterial*>(&material)) {
    entry.lambert = true;
    max_bands = std::max(max_bands, options.bands > 0 ? options.bands : lambert_table().bands(options.share));
  } else if (const auto* measured = dynamic_cast<const MeasuredMaterial*>(&material)) {
    if (!measured->sh_file.empty()) {
      entry.table = std::make_shared<const ShMaterial>(ShMaterial::open(measured->sh_file));
      refuse_missing_bands(material, *entry.table);
    } else {
      const auto tell = [&](double share) {
        if (options.progress) options.progress(material.name, share);
      };
      entry.table = cached_projection(material.at(vec2(0.5f)), projection(0), stop, tell);
    }
    if (entry.table) max_bands = std::max(max_bands, entry.table->max_bands());
  } else if (const auto* m = dynamic_cast<const MetallicRoughnessMaterial*>(&material)) {
    add_layers(material, &m->roughness, stop, &entry);
  } else if (const auto* m = dynamic_cast<const ConductorMaterial*>(&material)) {
    add_layers(material, &m->roughness, stop, &entry);
  } else if (const auto* m = dynamic_cast<const CoatedMaterial*>(&material)) {
    add_layers(material, &m->roughness, stop, &entry);
  } else {
    assert(dynamic_cast<const BlinnPhongMaterial*>(&material));
    add_layers(material, nullptr, stop, &entry);
  }
}

ShMaterials::ShMaterials(const std::vector<std::unique_ptr<Material>>& materials,
                         const ShMaterialsOptions& options, const Stop& stop) {
  assert(options.bands >= 0 && options.bands <= ShMaterial::kMaxBands);
  auto impl = std::make_shared<Impl>();
  impl->options = options;
  for (const auto& material : materials) impl->add(*material, stop);
  impl->options.progress = {};
  impl_ = std::move(impl);
}

bool ShMaterials::mirrored(uint32_t material) const {
  const Impl::Entry& entry = impl_->entries[material];
  return entry.lambert || (entry.table ? entry.table->mirrored() : entry.layers.mirrored());
}

int ShMaterials::bands(uint32_t material, const Bsdf& bsdf, ShTable table, vec3 w_out) const {
  const Impl::Entry& entry = impl_->entries[material];
  const ShMaterialsOptions& o = impl_->options;
  if (bsdf.kind == BsdfKind::black || !(w_out.z > kMinCosine)) return 0;
  if (entry.lambert) return o.bands > 0 ? o.bands : lambert_table().bands(o.share);
  const int stored =
      entry.table ? entry.table->bands(table, w_out) : entry.layers.bands(bsdf, table, w_out, o.share);
  return o.bands > 0 ? std::min(o.bands, stored) : stored;
}

int ShMaterials::look_up(uint32_t material, const Bsdf& bsdf, ShTable table, vec3 w_out, int bands,
                         int stride, float* out) const {
  const Impl::Entry& entry = impl_->entries[material];
  if (entry.lambert) {
    clear(sh_count(bands, true), stride, out);
    if (bsdf.kind == BsdfKind::black || !(w_out.z > kMinCosine)) return 0;
    const auto& zonal = lambert_table().zonal[int(table)];
    const int held = std::min(bands, ShMaterial::kMaxBands);
    for (int c = 0; c < 3; ++c) {
      for (int l = 0; l < held; ++l) out[c * stride + sh_index(l, 0, true)] = bsdf.diffuse[c] * zonal[l];
    }
    return held;
  }
  if (entry.table) return entry.table->look_up(table, w_out, bands, stride, out);
  return entry.layers.look_up(bsdf, table, w_out, bands, stride, out);
}

ShMaterials::Tables ShMaterials::tables(uint32_t material) const {
  const Impl::Entry& entry = impl_->entries[material];
  if (entry.lambert) return {};
  if (entry.table) return {Tables::measured, {{0.0f, entry.table.get()}}};
  Tables result{Tables::layers, {}};
  for (int i = 0; i < entry.layers.levels(); ++i)
    result.levels.push_back({entry.layers.roughness(i), &entry.layers.table(i)});
  return result;
}

int ShMaterials::max_bands() const {
  return impl_ ? impl_->max_bands : 0;
}

const std::vector<std::string>& ShMaterials::notes() const {
  static const std::vector<std::string> none;
  return impl_ ? impl_->notes : none;
}

}  // namespace zonal
