#include "materials/sh_projector.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <mutex>

#include "core/error.h"
#include "materials/measured_brdf.h"
#include "materials/sh_projector_quadrature.h"
#include "sh/window.h"

namespace zonal {
namespace {

constexpr double kRadians = 3.14159265358979323846 / 180;
/// Where the two sides differ by more than this norm, the half m >= 0 is made from the mean of both.
constexpr double kAverage = 1e-5;

const std::array<std::string, 5> kWindows{"none", "hann", "lanczos", "hamming", "auto"};

/// Cumulative energy of bands 0..l, three channels summed.
std::vector<double> band_energies(int bands, bool mirrored, const std::vector<double>& c) {
  const size_t count = size_t(sh_count(bands, mirrored));
  std::vector<double> energy(static_cast<size_t>(bands));
  double sum = 0;
  for (int l = 0; l < bands; ++l) {
    for (int m = mirrored ? 0 : -l; m <= l; ++m)
      for (size_t channel = 0; channel < 3; ++channel) {
        const double x = c[channel * count + size_t(sh_index(l, m, mirrored))];
        sum += x * x;
      }
    energy[size_t(l)] = sum;
  }
  return energy;
}

/// F' from F, which has one band more.
std::vector<double> cosine_table(int bands, bool mirrored, ShBasis basis, const std::vector<double>& f) {
  std::vector<double> out(3 * size_t(sh_count(bands, mirrored)));
  for (int c = 0; c < 3; ++c)
    times_cosine(bands, mirrored, basis, f.data() + c * sh_count(bands + 1, mirrored),
                 out.data() + c * sh_count(bands, mirrored));
  return out;
}

/// The first `bands` of `stored` bands, windowed.
std::vector<float> cut(int stored, int bands, bool mirrored, const ShProjectionOptions& options,
                       const std::vector<double>& c) {
  const int count = sh_count(bands, mirrored);
  std::vector<double> kept(3 * size_t(count));
  for (int channel = 0; channel < 3; ++channel)
    std::copy_n(c.data() + channel * sh_count(stored, mirrored), count, kept.data() + channel * count);
  const double size = options.window_size > 0 ? double(options.window_size) : double(bands);
  if (options.window == "auto") {
    std::vector<double> all(size_t(sh::count(bands)));
    for (int channel = 0; channel < 3; ++channel) {
      double* from = kept.data() + channel * count;
      std::fill(all.begin(), all.end(), 0.0);
      for (int l = 0; l < bands; ++l)
        for (int m = mirrored ? 0 : -l; m <= l; ++m)
          all[size_t(sh::index(l, m))] = from[sh_index(l, m, mirrored)];
      sh::dering(bands, all.data());
      for (int l = 0; l < bands; ++l)
        for (int m = mirrored ? 0 : -l; m <= l; ++m)
          from[sh_index(l, m, mirrored)] = all[size_t(sh::index(l, m))];
    }
  } else if (options.window != "none") {
    const auto at = std::find(kWindows.begin(), kWindows.end(), options.window);
    const auto window = static_cast<sh::Window>(at - kWindows.begin());
    for (int channel = 0; channel < 3; ++channel)
      for (int l = 0; l < bands; ++l) {
        const double weight = sh::window_weight(window, l, size);
        for (int m = mirrored ? 0 : -l; m <= l; ++m)
          kept[size_t(channel * count + sh_index(l, m, mirrored))] *= weight;
      }
  }
  return {kept.begin(), kept.end()};
}

/// Both rows of one outgoing direction.
struct RowPair {
  ShRow row[2];
  vec3 albedo;
  size_t evaluations;
};

/// `average`: the half m >= 0 is made from the mean of both sides.
RowPair project_row(const Bsdf& bsdf, double azimuth, int elevation, bool mirrored, bool average,
                    const ShProjectionOptions& options) {
  const bool fan = options.azimuths > 1;
  const int most = options.bands > 0 ? options.bands
                   : fan             ? std::min(options.most_bands, kAnisotropicBands)
                                     : options.most_bands;
  const double theta = ShMaterial::degrees(elevation) * kRadians;
  HemisphereOptions quadrature{.half = mirrored, .average = average};
  if (fan) {
    // There are thousands of rows, and few bands that ask for less.
    quadrature.resolve_bands = 16, quadrature.tolerance = 1e-5, quadrature.most_nodes = 8000;
  }
  if (options.nodes > 0) quadrature.resolve_bands = 8, quadrature.most_nodes = options.nodes;
  quadrature.resolve_bands = std::max(quadrature.resolve_bands, most);
  const HemisphereNodes nodes = hemisphere_nodes(bsdf, azimuth, theta, quadrature);

  RowPair pair;
  pair.albedo = vec3(float(nodes.albedo[0]), float(nodes.albedo[1]), float(nodes.albedo[2]));
  pair.evaluations = nodes.evaluations;
  pair.row[0].energy = nodes.energy, pair.row[1].energy = nodes.energy_cosine;
  // Most materials need few bands, and the sums grow with their square: try few first.
  for (int tried = options.bands > 0 ? most : std::min(most, 12);; tried = std::min(most, 2 * tried)) {
    std::vector<double> c[2];
    c[0].resize(3 * size_t(sh_count(tried + 1, mirrored)));
    project_nodes(nodes, tried + 1, mirrored, ShBasis::spherical, c[0].data());
    c[1] = cosine_table(tried, mirrored, ShBasis::spherical, c[0]);
    bool enough = true;
    for (const int table : {1, 0}) {
      ShRow& row = pair.row[table];
      const std::vector<double> energy = band_energies(tried + 1 - table, mirrored, c[table]);
      row.bands = tried;
      if (options.bands == 0) {
        const int limit = table == 1 ? tried : pair.row[1].bands;
        const auto at = std::find_if(energy.begin(), energy.begin() + limit,
                                     [&](double e) { return e >= double(options.share) * row.energy; });
        if (table == 1) enough = at != energy.begin() + limit || tried == most;
        row.bands = std::min(limit, int(at - energy.begin()) + 1);
      }
      row.captured = row.energy > 0 ? energy[size_t(row.bands) - 1] / row.energy : 1;
      row.coefficients = cut(tried + 1 - table, row.bands, mirrored, options, c[table]);
    }
    if (enough) return pair;
  }
}

void check(const ShProjectionOptions& o) {
  const auto expect = [](bool good, const std::string& what) {
    if (!good) throw SceneError("projection: " + what);
  };
  expect(o.bands >= 0 && o.bands <= ShMaterial::kMaxBands, "bands: expected 0 (as many as needed) to 100");
  expect(o.most_bands >= 1 && o.most_bands <= ShMaterial::kMaxBands, "most_bands: expected 1 to 100");
  expect(o.share > 0 && o.share < 1, "share: expected a number in (0, 1)");
  expect(o.azimuths >= 0 && o.azimuths <= 360, "azimuths: expected 0 (automatic) to 360");
  expect(o.nodes >= 0, "nodes: expected 0 (automatic) or more");
  expect(o.window_size >= 0, "window_size: expected a number >= 0");
  expect(std::find(kWindows.begin(), kWindows.end(), o.window) != kWindows.end(),
         "window: found \"" + o.window + "\"" + did_you_mean(o.window, kWindows));
}

}  // namespace

bool is_isotropic(const Bsdf& bsdf) {
  switch (bsdf.kind) {
    case BsdfKind::conductor:
    case BsdfKind::coated:
    case BsdfKind::metallic_roughness:
      return bsdf.alpha_x == bsdf.alpha_y;
    case BsdfKind::measured:
      return bsdf.measured->isotropic();
    default:
      return true;
  }
}

ShProjection project_material(const Bsdf& bsdf, const ShProjectionOptions& options, const Stop& stop,
                              const std::function<void(double)>& progress) {
  check(options);
  constexpr int n = ShMaterial::kElevations;
  const bool isotropic = is_isotropic(bsdf);
  ShProjection out;
  out.azimuths = options.azimuths > 0 ? options.azimuths : isotropic ? 1 : 90;
  // Directions of anisotropic materials have no plane of symmetry in general, so nothing is asked of them.
  out.mirrored = false;
  std::vector<double> asymmetry(n);
  if (isotropic) {
    tbb::parallel_for(0, n, [&](int e) {
      if (!stop()) asymmetry[size_t(e)] = mirror_asymmetry(bsdf, ShMaterial::degrees(e) * kRadians);
    });
    out.asymmetry = *std::max_element(asymmetry.begin(), asymmetry.end());
    out.mirrored = out.asymmetry <= kMirrorTolerance;
  } else {
    out.asymmetry = 1;
  }

  ShProjectionOptions row_options = options;
  row_options.azimuths = out.azimuths;
  const int rows = out.azimuths * n;
  std::vector<RowPair> pairs(static_cast<size_t>(rows));
  std::atomic<bool> stopped{false};
  std::mutex telling;
  int done = 0;
  // The nearer to grazing, the more nodes a row needs: hand rows out one by one.
  tbb::parallel_for(
      tbb::blocked_range<int>(0, rows, 1),
      [&](const tbb::blocked_range<int>& range) {
        for (int r = range.begin(); r < range.end(); ++r) {
          if (stopped || stop()) {
            stopped = true;
            return;
          }
          const double azimuth = 360.0 * kRadians * (r / n) / out.azimuths;
          pairs[size_t(r)] =
              project_row(bsdf, azimuth, r % n, out.mirrored, out.asymmetry > kAverage, row_options);
          if (!progress) continue;
          const std::lock_guard lock(telling);
          progress(double(++done) / rows);
        }
      },
      tbb::simple_partitioner());
  if (stopped) return {};

  out.row_albedo.assign(n, vec3(0));
  for (int r = 0; r < rows; ++r) {
    RowPair& pair = pairs[size_t(r)];
    for (int table = 0; table < 2; ++table) out.rows[table].push_back(std::move(pair.row[table]));
    out.row_albedo[size_t(r % n)] += pair.albedo / float(out.azimuths);
    out.evaluations += pair.evaluations;
  }
  // Hemispherical albedo: mean of the rows weighted by 2 sin cos dtheta, by trapezoids; beyond 89.5 degrees
  // the last row.
  glm::dvec3 sum(0);
  double weights = 0;
  for (int e = 0; e < n; ++e) {
    const double below = e > 0 ? 0.5 * (ShMaterial::degrees(e) - ShMaterial::degrees(e - 1)) : 0;
    const double above = e + 1 < n ? 0.5 * (ShMaterial::degrees(e + 1) - ShMaterial::degrees(e)) : 0.25;
    const double weight = (below + above) * std::sin(2 * ShMaterial::degrees(e) * kRadians);
    sum += weight * glm::dvec3(out.row_albedo[size_t(e)]), weights += weight;
  }
  out.albedo = vec3(sum / weights);
  return out;
}

int BandStudy::bands(const std::vector<double>& shares, double share) {
  const auto at = std::find_if(shares.begin(), shares.end(), [&](double s) { return s >= share; });
  return at == shares.end() ? 0 : int(at - shares.begin()) + 1;
}

BandStudy study_bands(const Bsdf& bsdf, double theta_out, int most_bands) {
  assert(most_bands >= 1 && most_bands <= ShMaterial::kMaxBands);
  const double asymmetry = is_isotropic(bsdf) ? mirror_asymmetry(bsdf, theta_out) : 1;
  const bool mirrored = asymmetry <= kMirrorTolerance;
  HemisphereOptions options{.half = mirrored, .average = asymmetry > kAverage, .hemispherical = true};
  options.resolve_bands = std::max(options.resolve_bands, most_bands);
  const HemisphereNodes nodes = hemisphere_nodes(bsdf, 0, theta_out, options);
  const double whole[2] = {nodes.energy, nodes.energy_cosine};
  BandStudy study;
  for (const ShBasis basis : {ShBasis::spherical, ShBasis::hemispherical}) {
    auto& shares = basis == ShBasis::spherical ? study.spherical : study.hemispherical;
    std::vector<double> f(3 * size_t(sh_count(most_bands + 1, mirrored)));
    project_nodes(nodes, most_bands + 1, mirrored, basis, f.data());
    shares[0] = band_energies(most_bands + 1, mirrored, f);
    shares[0].pop_back();
    shares[1] = band_energies(most_bands, mirrored, cosine_table(most_bands, mirrored, basis, f));
    for (int table = 0; table < 2; ++table)
      for (double& e : shares[table]) e = whole[table] > 0 ? e / whole[table] : 1;
  }
  return study;
}

}  // namespace zonal
