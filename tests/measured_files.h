#pragma once
/// RGL files: the published ones where ZONAL_DATA is set, and files made from an analytic BRDF, so that tests
/// need no data: GGX with Smith's masking and Schlick's Fresnel, written down as the measurement of such a
/// surface would be (Dupuy and Jakob 2018).
///
///     std::string file = write_isotropic_rgl(folder, 0.3);     // folder/ggx_0.3_rgb.bsdf
///     std::string other = write_anisotropic_rgl(folder);

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "materials/tensor_file.h"

namespace zonal::test {

using Vec = glm::dvec3;
inline constexpr double kPiDouble = 3.14159265358979323846;

/// A bilinear density over the unit square in double, everything straight from its definition as an integral:
/// sums of trapezoids, and their inverse by bisection. Slow, and shares nothing with materials/rgl_warp.
struct SlowWarp {
  int width, height;
  std::vector<double> values;       ///< rows
  std::vector<double> totals = {};  ///< of each row; made when first needed

  double at(double x, double y) const {
    const double px = x * (width - 1), py = y * (height - 1);
    const int i = std::min(int(px), width - 2), j = std::min(int(py), height - 2);
    const double s = px - i, t = py - j;
    const double* v = &values[size_t(j * width + i)];
    return (1 - t) * ((1 - s) * v[0] + s * v[1]) + t * ((1 - s) * v[width] + s * v[width + 1]);
  }
  /// Integral of one line from 0 to x.
  double line(double x, double y) const {
    double sum = 0;
    for (int i = 0; i + 1 < width; ++i) {
      const double a = double(i) / (width - 1), b = std::min(x, double(i + 1) / (width - 1));
      if (b <= a) break;
      sum += 0.5 * (b - a) * (at(a, y) + at(b, y));
    }
    return sum;
  }
  /// Integral of all lines from 0 to y.
  double area(double y) {
    for (int j = int(totals.size()); j < height; ++j) totals.push_back(line(1, double(j) / (height - 1)));
    double sum = 0;
    for (int j = 0; j + 1 < height; ++j) {
      const double a = double(j) / (height - 1), b = std::min(y, double(j + 1) / (height - 1));
      if (b <= a) break;
      const double share = (b - a) * (height - 1),
                   end = totals[size_t(j)] * (1 - share) + totals[size_t(j) + 1] * share;
      sum += 0.5 * (b - a) * (totals[size_t(j)] + end);
    }
    return sum;
  }
  glm::dvec2 invert(double x, double y) {
    const double whole = line(1, y);
    return {whole > 0 ? line(x, y) / whole : x, area(y) / area(1)};
  }
  double density(double x, double y) { return at(x, y) / area(1); }
  glm::dvec2 sample(double u, double v) {
    const double all = area(1);
    const double y = bisect([&](double t) { return area(t) < v * all; });
    const double whole = line(1, y);
    return {bisect([&](double t) { return line(t, y) < u * whole; }), y};
  }
  template <class Below>
  static double bisect(Below&& below) {
    double low = 0, high = 1;
    for (int i = 0; i < 48; ++i) {
      const double middle = 0.5 * (low + high);
      (below(middle) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
};

/// The analytic surface.
struct Ggx {
  double ax = 0.3, ay = 0.3;
  Vec f0{0.9, 0.5, 0.2};

  double D(Vec m) const {
    const double e = m.x * m.x / (ax * ax) + m.y * m.y / (ay * ay) + m.z * m.z;
    return 1 / (kPiDouble * ax * ay * e * e);
  }
  /// Projected area of the facets, per area of the surface: cos (1 + Lambda) (Heitz 2014).
  double sigma(Vec w) const {
    return 0.5 * (w.z + std::sqrt(ax * ax * w.x * w.x + ay * ay * w.y * w.y + w.z * w.z));
  }
  Vec fresnel(double cosine) const { return f0 + (Vec(1) - f0) * std::pow(1 - cosine, 5); }
  /// f cos(w_in) 4 sigma(w_out) / D(m) = F G2 / G1(w_out): what a file stores. Light below the horizon counts
  /// as on it.
  Vec stored(Vec w_out, Vec w_in, Vec m) const {
    const double in = std::max(w_in.z, 0.0), out = sigma(w_out);
    const double rest = sigma({w_in.x, w_in.y, in}) - in;  // cos Lambda
    // G2 / G1 = (1 + L(o)) / (1 + L(o) + L(i)), numerator and denominator times both cosines.
    return fresnel(glm::dot(w_out, m)) *
           (out * in / std::max(out * in + std::max(w_out.z, 0.0) * rest, 1e-12));
  }
  Vec f(Vec w_out, Vec w_in) const {
    const Vec m = glm::normalize(w_out + w_in);
    return stored(w_out, w_in, m) * D(m) / (4 * sigma(w_out) * w_in.z);
  }
};

struct RglSpec {
  Ggx surface;
  int azimuths = 1;    ///< slices over phi; 1: isotropic
  int reduction = 1;   ///< the azimuths cover 360, 180 or 90 degrees from -180 on
  int elevations = 9;  ///< slices over theta
  int facets = 33;     ///< vertices per side of vndf
  int side = 17;       ///< of luminance and rgb
  double least = 0;    ///< of what is stored: above 0 the BRDF is steep at the horizon, as measured ones are
};

inline Vec rgl_direction(double u_theta, double u_phi) {
  const double theta = u_theta * u_theta * kPiDouble / 2, phi = (2 * u_phi - 1) * kPiDouble;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// The file of a surface. Further fields may be added before it is written.
inline TensorWriter rgl_tensors(const RglSpec& spec) {
  const Ggx& s = spec.surface;
  const int P = spec.azimuths, T = spec.elevations, N = spec.facets, R = spec.side;
  const int rows = P == 1 ? 2 : N;  // D and sigma of an isotropic surface do not depend on phi
  std::vector<float> phi(size_t(P), 0.0f), theta, ndf, sigma, vndf, weights, rgb;
  for (int p = 0; p < P && P > 1; ++p)
    phi[size_t(p)] = float(-kPiDouble + 2 * kPiDouble / spec.reduction * p / (P - 1));
  for (int t = 0; t < T; ++t) theta.push_back(float(kPiDouble / 2 * t / (T - 1)));
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < N; ++x) {
      const Vec w = rgl_direction(double(x) / (N - 1), double(y) / (rows - 1));
      ndf.push_back(float(s.D(w))), sigma.push_back(float(s.sigma(w)));
    }
  }
  for (int p = 0; p < P; ++p) {
    for (int t = 0; t < T; ++t) {
      const double sine = std::sin(double(theta[size_t(t)]));
      const Vec out(sine * std::cos(double(phi[size_t(p)])), sine * std::sin(double(phi[size_t(p)])),
                    std::cos(double(theta[size_t(t)])));
      SlowWarp warp{N, N, {}};
      for (int y = 0; y < N; ++y) {
        for (int x = 0; x < N; ++x) {
          const double u = double(x) / (N - 1);
          const Vec m = rgl_direction(u, double(y) / (N - 1));
          // Visible normals, per area of the square: 2 pi^2 u sin(theta) times as much as per solid angle.
          const double jacobian = 2 * kPiDouble * kPiDouble * u * std::sin(u * u * kPiDouble / 2);
          warp.values.push_back(s.D(m) * std::max(glm::dot(m, out), 0.0) / s.sigma(out) * jacobian);
        }
      }
      for (const double v : warp.values) vndf.push_back(float(v));
      std::vector<Vec> colors;
      for (int y = 0; y < R; ++y) {
        for (int x = 0; x < R; ++x) {
          const glm::dvec2 u = warp.sample(double(x) / (R - 1), double(y) / (R - 1));
          const Vec m = rgl_direction(u.x, u.y);
          const Vec in = 2 * glm::dot(m, out) * m - out;
          colors.push_back(glm::max(s.stored(out, in, m), Vec(spec.least)));
        }
      }
      for (const Vec& c : colors) weights.push_back(float(0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z));
      for (int k = 0; k < 3; ++k)
        for (const Vec& c : colors) rgb.push_back(float(c[k]));
    }
  }
  const auto n = [](int i) { return uint64_t(i); };
  TensorWriter file;
  file.add("description", "Analytic GGX");
  file.add("phi_i", {n(P)}, phi);
  file.add("theta_i", {n(T)}, theta);
  file.add("sigma", {n(rows), n(N)}, sigma);
  file.add("ndf", {n(rows), n(N)}, ndf);
  file.add("vndf", {n(P), n(T), n(N), n(N)}, vndf);
  file.add("luminance", {n(P), n(T), n(R), n(R)}, weights);
  file.add("rgb", {n(P), n(T), 3, n(R), n(R)}, rgb);
  file.add("jacobian", std::string_view("\1", 1));
  return file;
}

/// Writes folder/ggx_ALPHA_rgb.bsdf and returns its name.
inline std::string write_isotropic_rgl(const std::string& folder, double alpha) {
  char name[64];
  std::snprintf(name, sizeof name, "/ggx_%g_rgb.bsdf", alpha);
  rgl_tensors({.surface = {alpha, alpha}}).write(folder + name);
  return folder + name;
}

/// Writes folder/ggx_anisotropic_rgb.bsdf (alpha 0.2 along x, 0.5 along y) and returns its name.
inline std::string write_anisotropic_rgl(const std::string& folder) {
  rgl_tensors({.surface = {0.2, 0.5}, .azimuths = 17, .elevations = 7, .facets = 25, .side = 13})
      .write(folder + "/ggx_anisotropic_rgb.bsdf");
  return folder + "/ggx_anisotropic_rgb.bsdf";
}

/// All .bsdf files of $ZONAL_DATA/materials/rgl, sorted; none where there is no such folder.
inline std::vector<std::string> published_rgl_files() {
  const char* data = std::getenv("ZONAL_DATA");
  const std::filesystem::path folder = std::filesystem::path(data ? data : "") / "materials/rgl";
  std::vector<std::string> files;
  if (!data || !std::filesystem::is_directory(folder)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".bsdf") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}
/// What a test says that is skipped without them.
inline constexpr const char* kNoPublishedFiles = "set ZONAL_DATA to the folder that has materials/rgl";

}  // namespace zonal::test
