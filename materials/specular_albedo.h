#pragma once
/// How much a rough dielectric coat reflects into the whole hemisphere, E(w, alpha): what the layer below
/// does not get. A table made once per index of refraction (and aspect of its anisotropy), shared by all
/// materials.
///
///     const SpecularAlbedo& coat = SpecularAlbedo::dielectric(1.5f);
///     SpecularAlbedo::Row row = coat.row(alpha);      // once a shading point
///     float reflected = row.at(w);                     // once a direction
///
/// Kelemen and Szirmay-Kalos 2001: f_diffuse = rho/pi (1 - E(o)) (1 - E(i)) / (1 - E_avg) is reciprocal, and
/// with rho = 1 coat and base together reflect everything.

#include <algorithm>
#include <atomic>
#include <vector>

#include "core/vec.h"

namespace zonal {

class SpecularAlbedo {
 public:
  /// Exact Fresnel of a dielectric, ior >= 1. `aspect` = alpha_y / alpha_x > 0; 1 is isotropic. Thread-safe;
  /// the first call for a pair computes its table (about 0.1 s isotropic, 0.5 s anisotropic).
  static const SpecularAlbedo& dielectric(float ior, float aspect = 1);
  /// Schlick's Fresnel with F0 = 0.04, glTF's dielectric.
  static const SpecularAlbedo& schlick();

  /// The table at one alpha.
  class Row {
   public:
    /// E towards w (unit, shading frame, z >= 0), [0,1].
    float at(vec3 w) const;
    /// E_avg: mean of E over the hemisphere weighted by the cosine, of the very interpolant that `at`
    /// returns.
    float average() const;
    /// `at` of an isotropic table at kPoints cosines whose fourth roots are evenly spaced from 0 to 1, linear
    /// between: for loops that look up many directions at one alpha.
    static constexpr int kPoints = 97;
    void tabulate(float* values) const;
    bool operator==(const Row&) const = default;

   private:
    friend class SpecularAlbedo;
    const SpecularAlbedo* table_ = nullptr;
    int index_ = 0;    ///< of the lower alpha
    float blend_ = 0;  ///< 0: lower alpha, 1: the next
  };
  /// `alpha` = sqrt(alpha_x alpha_y); clamped to [1e-4, 1].
  Row row(float alpha) const;

  float ior() const { return ior_; }  ///< 0: Schlick
  float aspect() const { return aspect_; }

 private:
  SpecularAlbedo(float ior, float aspect);
  /// A place between two nodes of an axis.
  struct Node {
    int index;
    float blend;
    Node(float x, int count) : index(std::min(static_cast<int>(x), count - 2)), blend(x - float(index)) {}
  };
  /// Nodes are uniform in cosine^(1/4) and alpha^(1/4), because the table's features sit at cosine ~ alpha,
  /// and along the azimuth in sqrt(width of the normals along w / alpha_x).
  static constexpr int kCosines = 97, kAlphas = 48, kAzimuths = 9;
  static constexpr float kFirstAlphaRoot = 0.1f;  ///< kMinAlpha^(1/4)
  static float fourth_root(float x) { return std::sqrt(std::sqrt(x)); }
  int azimuths() const { return aspect_ == 1.0f ? 1 : kAzimuths; }
  float interpolate(const float* values, Node cosine, float blend) const;
  float azimuth_coordinate(vec3 w) const;

  float ior_, aspect_;
  std::vector<float> values_;    ///< [alpha][azimuth][cosine]
  std::vector<float> averages_;  ///< [alpha]
};

/// Remembers the table of one material, so that shading never searches. Copies start out empty.
class CoatTable {
 public:
  CoatTable() = default;
  CoatTable(const CoatTable&) {}
  CoatTable& operator=(const CoatTable&) { return *this; }
  const SpecularAlbedo& get(float ior, float aspect) const {
    const SpecularAlbedo* table = table_.load(std::memory_order_acquire);
    if (table && table->ior() == ior && table->aspect() == aspect) return *table;
    table = &SpecularAlbedo::dielectric(ior, aspect);
    table_.store(table, std::memory_order_release);
    return *table;
  }

 private:
  mutable std::atomic<const SpecularAlbedo*> table_{nullptr};
};

inline SpecularAlbedo::Row SpecularAlbedo::row(float alpha) const {
  const float x = (fourth_root(alpha) - kFirstAlphaRoot) * ((kAlphas - 1) / (1.0f - kFirstAlphaRoot));
  const Node node(std::fmin(std::fmax(x, 0.0f), kAlphas - 1.0f), kAlphas);
  Row row;
  row.table_ = this, row.index_ = node.index, row.blend_ = node.blend;
  return row;
}

/// Bilinear in cosine and alpha; `values` is the lower alpha's first cosine.
inline float SpecularAlbedo::interpolate(const float* values, Node cosine, float blend) const {
  const float* lower = values + cosine.index;
  const float* upper = lower + azimuths() * kCosines;
  const float a = lower[0] + cosine.blend * (lower[1] - lower[0]);
  const float b = upper[0] + cosine.blend * (upper[1] - upper[0]);
  return a + blend * (b - a);
}

/// In [0, kAzimuths - 1]: 0 along the narrow axis, the last along the wide one.
inline float SpecularAlbedo::azimuth_coordinate(vec3 w) const {
  const float x2 = w.x * w.x, y2 = w.y * w.y;
  const float width = fourth_root((x2 + sqr(aspect_) * y2 + 1e-20f) / (x2 + y2 + 1e-20f));
  const float along_y = std::sqrt(aspect_);
  const float x = (width - along_y) / (1.0f - along_y);
  return std::fmin(std::fmax(x, 0.0f), 1.0f) * (kAzimuths - 1);
}

inline float SpecularAlbedo::Row::at(vec3 w) const {
  const SpecularAlbedo& t = *table_;
  const Node cosine(fourth_root(std::fmin(std::fmax(w.z, 0.0f), 1.0f)) * (kCosines - 1), kCosines);
  const float* values = &t.values_[size_t(index_) * t.azimuths() * kCosines];
  if (t.azimuths() == 1) return t.interpolate(values, cosine, blend_);
  const Node azimuth(t.azimuth_coordinate(w), kAzimuths);
  values += azimuth.index * kCosines;
  const float a = t.interpolate(values, cosine, blend_);
  return a + azimuth.blend * (t.interpolate(values + kCosines, cosine, blend_) - a);
}

inline void SpecularAlbedo::Row::tabulate(float* values) const {
  static_assert(kPoints == kCosines);
  const float* lower = &table_->values_[size_t(index_) * kCosines];
  for (int i = 0; i < kCosines; ++i) values[i] = lower[i] + blend_ * (lower[i + kCosines] - lower[i]);
}

inline float SpecularAlbedo::Row::average() const {
  const float* averages = &table_->averages_[index_];
  return averages[0] + blend_ * (averages[1] - averages[0]);
}

}  // namespace zonal
