#include "materials/sh_layers.h"

#include <algorithm>
#include <cmath>

#include "core/glsl.h"
#include "materials/microfacet.h"

namespace zonal {
#include "materials/sh_layers.glsl"

Bsdf ShLayers::load(const Bsdf& bsdf) {
  Bsdf b = bsdf;
  switch (b.kind) {
    case BsdfKind::metallic_roughness:
      b.specular = vec3(0, 1, 0), b.diffuse = vec3(0, 0, 1);
      break;
    case BsdfKind::coated:
      b.specular = vec3(1), b.diffuse = vec3(0, 1, 0);
      break;
    case BsdfKind::blinn_phong:
      b.specular = vec3(1, 0, 0), b.diffuse = vec3(0, 1, 0);
      break;
    default:
      b.specular = vec3(1), b.diffuse = vec3(0);
  }
  return b;
}

ShLayers::Weights ShLayers::weights(const Bsdf& b) {
  static_assert(int(BsdfKind::blinn_phong) == 2 && int(BsdfKind::coated) == 4 &&
                int(BsdfKind::metallic_roughness) == 5);
  vec3 x, y, z;
  sh_layer_weights(static_cast<int>(b.kind), b.specular, b.diffuse, x, y, z);
  Weights w{};
  for (int c = 0; c < 3; ++c) w[c] = {x[c], y[c], z[c]};
  return w;
}

void ShLayers::add_level(float roughness, std::shared_ptr<const ShMaterial> table, bool energies) {
  Level level{roughness, std::move(table), {}, {}};
  const ShMaterial& t = *level.table;
  for (int e = 0; energies && e < ShMaterial::kElevations; ++e) {
    const std::vector<float> row = t.row(ShTable::brdf_cosine, 0, e);
    const int bands = t.row_bands(ShTable::brdf_cosine, 0, e), count = sh_count(bands, t.mirrored());
    const float* x[3] = {row.data(), row.data() + count, row.data() + 2 * count};
    level.start.push_back(int(level.energy.size()));
    Symmetric sum{}, last{};
    for (int l = 0; l < bands; ++l) {
      last = {};
      for (int i = sh_count(l, t.mirrored()); i < sh_count(l + 1, t.mirrored()); ++i) {
        const float a = x[0][i], b = x[1][i], c = x[2][i];
        const Symmetric product = {a * a, b * b, c * c, a * b, a * c, b * c};
        for (int k = 0; k < 6; ++k) last[k] += product[k];
      }
      for (int k = 0; k < 6; ++k) sum[k] += last[k];
      level.energy.push_back(sum);
    }
    // Of the bands left out only their share in the three channels' sum is known; they are taken to be made
    // like the last band kept, which is all specular where the base is smooth.
    const float held = t.row_share(ShTable::brdf_cosine, 0, e), whole = sum[0] + sum[1] + sum[2];
    const float of_last = last[0] + last[1] + last[2];
    if (held > 0 && of_last > 0) {
      const float tail = std::fmax(1 / held - 1, 0.0f) * whole / of_last;
      for (int k = 0; k < 6; ++k) sum[k] += tail * last[k];
    }
    level.energy.push_back(sum);
  }
  if (energies) level.start.push_back(int(level.energy.size()));
  levels_.push_back(std::move(level));
}

/// Between level and the next; beyond the first and last, those.
ShLayers::Place ShLayers::place(const Bsdf& b) const {
  if (levels_.size() < 2) return {0, 0};
  const float first = levels_.front().roughness, step = levels_[1].roughness - first;
  const float x = sh_layer_place(vec2(b.alpha_x, b.alpha_y), first, step, float(levels_.size()));
  const size_t i = std::min(size_t(x), levels_.size() - 2);
  return {i, x - float(i)};
}

int ShLayers::bands(const Bsdf& b, ShTable table, vec3 w_out, float share) const {
  if (levels_.empty() || b.kind == BsdfKind::black || !(w_out.z > kMinCosine)) return 0;
  const Place p = place(b);
  const Level& level = levels_[p.level + (p.blend >= 0.5f ? 1 : 0)];
  const int stored = level.table->bands(table, w_out);
  if (level.energy.empty()) return stored;

  const float angle = std::atan2(std::sqrt(sqr(w_out.x) + sqr(w_out.y)), w_out.z) * (180 * kInvPi);
  const int row = angle > 89.25f ? ShMaterial::kElevations - 1 : int(angle + 0.5f);
  const int start = level.start[size_t(row)], end = level.start[size_t(row) + 1] - 1;
  Symmetric m{};
  for (const auto& w : weights(b)) {
    const Symmetric product = {w[0] * w[0],     w[1] * w[1],     w[2] * w[2],
                               2 * w[0] * w[1], 2 * w[0] * w[2], 2 * w[1] * w[2]};
    for (int k = 0; k < 6; ++k) m[k] += product[k];
  }
  const auto energy = [&](int i) {
    const Symmetric& e = level.energy[size_t(i)];
    return m[0] * e[0] + m[1] * e[1] + m[2] * e[2] + m[3] * e[3] + m[4] * e[4] + m[5] * e[5];
  };
  const float wanted = share * energy(end);
  for (int i = start; i < end; ++i) {
    if (energy(i) >= wanted) return std::min(i - start + 1, stored);
  }
  return std::min(end - start, stored);
}

int ShLayers::look_up(const Bsdf& b, ShTable table, vec3 w_out, int bands, int stride, float* out) const {
  const int wanted = sh_count(bands, mirrored());
  for (int c = 0; c < 3; ++c) std::fill_n(out + c * stride, wanted, 0.0f);
  if (levels_.empty() || b.kind == BsdfKind::black) return 0;
  thread_local std::vector<float> stored;
  stored.resize(std::max(stored.size(), 3 * size_t(wanted)));
  const Weights w = weights(b);
  const Place p = place(b);
  int most = 0;
  for (size_t i = 0; i < 2; ++i) {
    const float share = i == 0 ? 1 - p.blend : p.blend;
    if (share <= 0) continue;
    const int held = levels_[p.level + i].table->look_up(table, w_out, bands, wanted, stored.data());
    most = std::max(most, held);
    const int count = sh_count(held, mirrored());
    const float *x = stored.data(), *y = x + wanted, *z = y + wanted;
    for (int c = 0; c < 3; ++c) {
      const float a = share * w[c][0], d = share * w[c][1], e = share * w[c][2];
      float* to = out + c * stride;
      for (int k = 0; k < count; ++k) to[k] += a * x[k] + d * y[k] + e * z[k];
    }
  }
  return most;
}

}  // namespace zonal
