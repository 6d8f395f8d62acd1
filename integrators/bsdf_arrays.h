#pragma once
/// Many BRDFs, each seen from its own direction, as arrays: evaluated in loops that vectorise. The values are
/// those of `evaluate` (materials/bsdf.h) up to rounding.
///
///     BsdfArrays brdfs(points.padded);
///     for (int k = 0; k < points.padded; ++k) brdfs.set(k, points.bsdf(k), points.view[k]);
///     brdfs.finish();
///     brdfs.evaluate(0, points.padded, x, y, z, r, g, b);       // each its own direction
///     brdfs.evaluate_one(3, 64, x, y, z, r, g, b);              // one of them, 64 directions
///
/// Lambert, and isotropic or uncoated GGX with every Fresnel, run in vectors; Blinn-Phong, measured and
/// anisotropic coated ones one by one.

#include <vector>

#include "materials/bsdf.h"

namespace zonal {

class BsdfArrays {
 public:
  BsdfArrays() = default;
  explicit BsdfArrays(int count);
  /// The BRDF with its context: `w_out` of `view` is fixed, directions to come are the other one.
  void set(int i, const Bsdf& bsdf, const BsdfContext& view, Lobes lobes = Lobes::all);
  /// Call when all are set, and before evaluating.
  void finish();
  int count() const { return count_; }

  /// f of entry i, 1/sr, for the direction (x, y, z)[i - first] of its shading frame, for i in [first, end);
  /// 0 below the horizon. Results go to [i - first] as well.
  void evaluate(int first, int end, const float* x, const float* y, const float* z, float* r, float* g,
                float* b) const;
  /// The same with the density of `sample`, 1/sr.
  void evaluate_with_pdf(int first, int end, const float* x, const float* y, const float* z, float* r,
                         float* g, float* b, float* pdf) const;
  /// f of the entry `i` for n directions.
  void evaluate_one(int i, int n, const float* x, const float* y, const float* z, float* r, float* g,
                    float* b) const;

  /// Multiplies r, g, b by f of entry i for n directions, by `weights` and by `color`; at most `most`.
  void multiply_by_one(int i, int n, const float* x, const float* y, const float* z, const float* weights,
                       vec3 color, float most, float* r, float* g, float* b) const;
  /// Whether entry i is the same for all directions above the horizon, and then its value, 1/sr.
  bool constant(int i, vec3* f) const;

  /// An entry that vectorises, in numbers; Lambert is one without a specular part.
  struct Entry {
    float alpha_x = 1, alpha_y = 1;      ///< GGX widths
    float inverse_x = 1, inverse_y = 1;  ///< one over them
    float ox = 0, oy = 0, oz = 1;        ///< w_out
    float stretch = 1;                   ///< ggx_stretch of w_out
    float specular = 0;                  ///< 1: there is a specular part
    float share = 0;                     ///< probability of sampling it
    float f_r = 0, f_g = 0, f_b = 0;     ///< Schlick: F0; conductor: eta; dielectric: f_r = eta
    float k_r = 0, k_g = 0, k_b = 0;     ///< conductor: k
    float t_r = 1, t_g = 1, t_b = 1;     ///< tint
    float d_r = 0, d_g = 0, d_b = 0;     ///< diffuse albedo times what depends on w_out of it, 1/sr
    float coat = 0;                      ///< 1: the diffuse part loses what the coat keeps towards w_in
    float row = 0;                       ///< which of the coats' tables
    float diffuse_share = 0;             ///< probability of sampling the diffuse part
  };

 private:
  enum class Class : uint8_t { constant, schlick, dielectric, conductor, other };
  struct Run {
    int first, end;
    Class kind;
  };
  struct Single {
    Bsdf bsdf;
    BsdfContext view;
    Lobes lobes = Lobes::all;
  };
  static constexpr int kNumbers = sizeof(Entry) / sizeof(float);

  template <bool kPdf>
  void evaluate_runs(int first, int end, const float* x, const float* y, const float* z, float* r, float* g,
                     float* b, float* pdf) const;
  Entry entry(int i) const;
  float row_of(const SpecularAlbedo::Row& row);

  int count_ = 0;
  std::vector<Class> classes_;
  std::vector<Run> runs_;
  std::vector<int> run_of_;                 ///< each entry's run
  std::vector<float> numbers_;              ///< the members of Entry, one array of count_ a member
  std::vector<SpecularAlbedo::Row> coats_;  ///< of all rows but row 0
  std::vector<float> rows_;                 ///< their tables, one behind the other; the first is all zero
  std::vector<Single> singles_;             ///< the entries of Class::other
  std::vector<int> single_of_;              ///< each entry's place there
};

}  // namespace zonal
