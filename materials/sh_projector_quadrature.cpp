#include "materials/sh_projector_quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>

#include "materials/measured_brdf.h"
#include "sh/gauss_panel.h"

namespace zonal {
namespace {

using std::numbers::pi;

constexpr int kOrder = 6, kNodes = kOrder * kOrder;
/// Half of a cell's width times the highest l: six nodes integrate exp(i 3 t) to 3e-6.
constexpr double kPhase = 3;

/// Near the normal the kinks of the data in all azimuths cross the highlight, near grazing the horizon cuts
/// it: rows below and above get so many times more nodes, for errors like those of the others.
constexpr double kHardBelow = 13.5 * pi / 180, kHardAbove = 84.5 * pi / 180, kHardNodes = 2.2;

struct Direction {
  double x, y, z;
};

double chord(const Direction& a, const Direction& b) {
  return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

/// The two parts of the hemisphere: up to 89.5 degrees, and the strip below, where RGL data divide by a
/// constant cosine (docs/materials.md): the kink in between is an edge of cells.
enum Part { upper, strip };
constexpr double kStripHeight = 0.00872653549837393;  // cos 89.5 degrees

/// Where hemispherical harmonics see a direction (sh/hemispherical.h).
Direction squeezed(const Direction& w) {
  const double turn = 2 * std::sqrt(w.z / (1 + w.z));
  return {turn * w.x, turn * w.y, 2 * w.z - 1};
}

/// From (t, phi) of the half vector to w_in, t in [0, 1].
struct Map {
  double sin_out, cos_out;

  explicit Map(double theta_out) : sin_out(std::sin(theta_out)), cos_out(std::cos(theta_out)) {}

  /// w_in.z = 2 (h.o) h.z - o.z = radius sin(2 (theta_max - theta)) at the half vector's polar angle theta,
  /// with
  ///     tan 2 theta_max = -cos theta_o / (sin theta_o cos phi),  radius^2 = cos^2 theta_o + sin^2 theta_o
  ///     cos^2 phi  (ShQ-1)
  /// and d omega_in = 4 (h.o) sin theta dtheta dphi.
  Direction at(Part part, double t, double phi, double* jacobian = nullptr) const {
    const double c = std::cos(phi), s = std::sin(phi);
    const double widest = 0.5 * std::atan2(cos_out, -sin_out * c);
    const double radius = std::sqrt(cos_out * cos_out + sin_out * sin_out * c * c);
    const double edge = std::max(0.0, widest - 0.5 * std::asin(std::min(1.0, kStripHeight / radius)));
    // Depth is counted from the horizon, so that heights are exact where they go to zero. The strip's sin^2
    // is quadratic at both ends: at a highlight that reaches into it, and at the horizon, where hemispherical
    // harmonics are functions of sqrt z.
    double theta, depth, slope;
    if (part == upper) {
      theta = t * t * edge, depth = widest - theta, slope = 2 * t * edge;
    } else {
      const double low = std::sin(0.5 * pi * t), high = std::cos(0.5 * pi * t), strip = widest - edge;
      theta = edge + low * low * strip, depth = high * high * strip, slope = pi * low * high * strip;
    }
    const double sin_h = std::sin(theta), h_dot_o = sin_h * c * sin_out + std::cos(theta) * cos_out;
    if (jacobian) *jacobian = 4 * h_dot_o * sin_h * slope;
    return {2 * h_dot_o * sin_h * c - sin_out, 2 * h_dot_o * sin_h * s, radius * std::sin(2 * depth)};
  }
};

struct Rule {
  std::array<double, kOrder> node, weight;  ///< on [0, 1]
  std::array<double, kOrder> fifth,
      sixth;  ///< give the Legendre coefficients of degree 4 and 5 from the values

  Rule() {
    const double* x = sh::GaussPanels::get().nodes(kOrder);
    const double* w = sh::GaussPanels::get().weights(kOrder);
    for (int i = 0; i < kOrder; ++i) {
      node[i] = 0.5 + 0.5 * x[i], weight[i] = 0.5 * w[i];
      const double x2 = x[i] * x[i];
      fifth[i] = 9 * weight[i] * (35 * x2 * x2 - 30 * x2 + 3) / 8;
      sixth[i] = 11 * weight[i] * x[i] * (63 * x2 * x2 - 70 * x2 + 15) / 8;
    }
  }
  static const Rule& get() {
    static const Rule rule;
    return rule;
  }
};

/// F and F cos of each channel (a sum would hide a dark one), F^2 of their sum; the last is empty, to make a
/// vector.
constexpr int kIntegrands = 8;
using Integrals = std::array<double, kIntegrands>;
/// How much the error of each counts: what is shaded with is F', and energies need two digits less.
constexpr Integrals kWeights = {0.2, 0.2, 0.2, 1, 1, 1, 0.05, 0};

/// y += a x
void add(double a, const Integrals& x, Integrals* y) {
#pragma omp simd
  for (int q = 0; q < kIntegrands; ++q) (*y)[q] += a * x[q];
}
/// y += a |x|
void add_size(double a, const Integrals& x, Integrals* y) {
#pragma omp simd
  for (int q = 0; q < kIntegrands; ++q) (*y)[q] += a * std::abs(x[q]);
}

struct Cell {
  Part part;
  double t0, t1, phi0, phi1;
  std::array<Direction, kNodes> w{};
  std::array<double, kNodes> weight{};
  std::array<vec3, kNodes> f{};
  Integrals total{};
  Integrals tail_t{}, tail_phi{};  ///< size of the two highest Legendre coefficients along each side
};

class Integrator {
 public:
  /// `average`: of every direction and its mirror image in the plane of w_out.
  Integrator(const Bsdf& bsdf, double azimuth, double theta_out, bool average = false)
      : bsdf_(bsdf),
        average_(average),
        map_(theta_out),
        cos_(std::cos(azimuth)),
        sin_(std::sin(azimuth)),
        w_out_(float(map_.sin_out * cos_), float(map_.sin_out * sin_), float(map_.cos_out)),
        view_(prepare(bsdf, w_out_)) {}

  const Map& map() const { return map_; }

  /// Of directions in the view frame.
  void evaluate(int n, const Direction* w, vec3* f) const {
    std::array<vec3, kNodes> local;
    for (int i = 0; i < n; ++i) {
      // Float's rounding must not put a direction on the other side of the horizon's cut at 1e-8.
      const float z = std::max(float(w[i].z), 1.01e-8f);
      local[i] = vec3(float(cos_ * w[i].x - sin_ * w[i].y), float(sin_ * w[i].x + cos_ * w[i].y), z);
    }
    if (bsdf_.kind == BsdfKind::measured) {
      bsdf_.measured->evaluate(w_out_, n, local.data(), f);
    } else {
      for (int i = 0; i < n; ++i) f[i] = zonal::evaluate(bsdf_, view_, local[i]);
    }
  }

  void fill(Cell* cell) const;

 private:
  const Bsdf& bsdf_;
  bool average_;
  Map map_;
  double cos_, sin_;
  vec3 w_out_;
  BsdfContext view_;
};

void Integrator::fill(Cell* cell) const {
  const Rule& rule = Rule::get();
  const double width = cell->t1 - cell->t0, height = cell->phi1 - cell->phi0, area = width * height;
  std::array<double, kNodes> density;
  for (int i = 0; i < kOrder; ++i) {
    const double phi = cell->phi0 + height * rule.node[i];
    for (int j = 0; j < kOrder; ++j) {
      const int k = i * kOrder + j;
      cell->w[k] = map_.at(cell->part, cell->t0 + width * rule.node[j], phi, &density[k]);
      cell->weight[k] = area * density[k] * rule.weight[i] * rule.weight[j];
    }
  }
  evaluate(kNodes, cell->w.data(), cell->f.data());
  if (average_) {
    auto mirrored = cell->w;
    for (Direction& w : mirrored) w.y = -w.y;
    std::array<vec3, kNodes> other;
    evaluate(kNodes, mirrored.data(), other.data());
    for (int k = 0; k < kNodes; ++k) cell->f[k] = 0.5f * (cell->f[k] + other[k]);
  }

  std::array<Integrals, kNodes> g;
  for (int k = 0; k < kNodes; ++k) {
    const glm::dvec3 f = density[k] * glm::dvec3(cell->f[k]);
    const double z = cell->w[k].z;
    g[k] = {f.x, f.y, f.z, z * f.x, z * f.y, z * f.z, glm::dot(f, glm::dvec3(cell->f[k])), 0};
  }
  cell->total = cell->tail_t = cell->tail_phi = {};
  for (int a = 0; a < kOrder; ++a) {
    Integrals t4{}, t5{}, p4{}, p5{};
    const double share = area * rule.weight[a];
    for (int b = 0; b < kOrder; ++b) {
      const Integrals &along_t = g[a * kOrder + b], &along_phi = g[b * kOrder + a];
      add(rule.fifth[b], along_t, &t4), add(rule.sixth[b], along_t, &t5);
      add(rule.fifth[b], along_phi, &p4), add(rule.sixth[b], along_phi, &p5);
      add(share * rule.weight[b], along_t, &cell->total);
    }
    add_size(share, t4, &cell->tail_t), add_size(share, t5, &cell->tail_t);
    add_size(share, p4, &cell->tail_phi), add_size(share, p5, &cell->tail_phi);
  }
}

/// How far half of a cell may reach on the sphere of w_in, and whether also on the squeezed one.
struct Reach {
  double chord;
  bool hemispherical;
};

/// Splits [t0, t1] x [phi0, phi1] until that is so.
void seed(const Map& map, Part part, double t0, double t1, double phi0, double phi1, Reach reach,
          std::vector<Cell>* cells) {
  const double t[3] = {t0, 0.5 * (t0 + t1), t1}, phi[3] = {phi0, 0.5 * (phi0 + phi1), phi1};
  Direction w[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) w[i][j] = map.at(part, t[j], phi[i]);
  double along_t = 0, along_phi = 0;
  for (int i = 0; i < 3; ++i) {
    along_t = std::max({along_t, chord(w[i][0], w[i][1]), chord(w[i][1], w[i][2])});
    along_phi = std::max({along_phi, chord(w[0][i], w[1][i]), chord(w[1][i], w[2][i])});
  }
  if (reach.hemispherical) {
    for (auto& row : w)
      for (Direction& d : row) d = squeezed(d);
    for (int i = 0; i < 3; ++i) {
      along_t = std::max({along_t, chord(w[i][0], w[i][1]), chord(w[i][1], w[i][2])});
      along_phi = std::max({along_phi, chord(w[0][i], w[1][i]), chord(w[1][i], w[2][i])});
    }
  }
  if (std::max(along_t, along_phi) <= reach.chord || std::max(t1 - t0, phi1 - phi0) < 1e-4) {
    cells->push_back({.part = part, .t0 = t0, .t1 = t1, .phi0 = phi0, .phi1 = phi1});
  } else if (along_t > along_phi) {
    seed(map, part, t0, t[1], phi0, phi1, reach, cells);
    seed(map, part, t[1], t1, phi0, phi1, reach, cells);
  } else {
    seed(map, part, t0, t1, phi0, phi[1], reach, cells);
    seed(map, part, t0, t1, phi[1], phi1, reach, cells);
  }
}

/// Rings that narrow towards the highlight, so that none of width 1e-4 slips through, cut into cells.
std::vector<Cell> seeds(const Map& map, bool half, Reach reach) {
  std::vector<Cell> cells;
  const int sectors = half ? 4 : 8;
  for (int sector = 0; sector < sectors; ++sector) {
    const double phi0 = sector * pi / 4, phi1 = (sector + 1) * pi / 4;
    double t0 = 0;
    for (int ring = -8; ring <= 0; ++ring) {
      const double t1 = std::exp2(ring);
      seed(map, upper, t0, t1, phi0, phi1, reach, &cells);
      t0 = t1;
    }
    // Near grazing the highlight reaches into the strip.
    t0 = 0;
    for (int ring = map.cos_out < 4 * kStripHeight ? -8 : 0; ring <= 0; ring += 2) {
      const double t1 = std::exp2(ring);
      seed(map, strip, t0, t1, phi0, phi1, reach, &cells);
      t0 = t1;
    }
  }
  return cells;
}

}  // namespace

HemisphereNodes hemisphere_nodes(const Bsdf& bsdf, double azimuth, double theta_out,
                                 const HemisphereOptions& options) {
  const Integrator integrator(bsdf, azimuth, theta_out, options.half && options.average);
  std::vector<Cell> cells =
      seeds(integrator.map(), options.half, {kPhase / options.resolve_bands, options.hemispherical});
  HemisphereNodes nodes;
  Integrals total{};
  size_t made = 0;
  for (Cell& cell : cells) {
    integrator.fill(&cell);
    made += kNodes;
    add(1, cell.total, &total);
  }
  const bool hard = theta_out < kHardBelow || theta_out > kHardAbove;
  const double most_nodes = options.most_nodes * (hard ? kHardNodes : 1) * (options.half ? 1 : 2);

  // Halve the worst cell, along its worse side, until all are good or the budget is spent.
  const auto error = [&](const Cell& cell) {
    double worst = 0;
    for (int q = 0; q < kIntegrands; ++q)
      if (total[q] > 0) worst = std::max(worst, kWeights[q] * (cell.tail_t[q] + cell.tail_phi[q]) / total[q]);
    return worst;
  };
  using Entry = std::pair<double, size_t>;
  std::priority_queue<Entry> queue;
  for (size_t i = 0; i < cells.size(); ++i) queue.push({error(cells[i]), i});
  while (!queue.empty() && queue.top().first > options.tolerance && double(made + 2 * kNodes) <= most_nodes) {
    const size_t index = queue.top().second;
    queue.pop();
    const Cell& worst = cells[index];
    double along_t = 0, along_phi = 0;
    for (int q = 0; q < kIntegrands; ++q)
      if (total[q] > 0)
        along_t += kWeights[q] * worst.tail_t[q] / total[q],
            along_phi += kWeights[q] * worst.tail_phi[q] / total[q];
    Cell first{.part = worst.part, .t0 = worst.t0, .t1 = worst.t1, .phi0 = worst.phi0, .phi1 = worst.phi1},
        second = first;
    if (along_t > along_phi)
      first.t1 = second.t0 = 0.5 * (worst.t0 + worst.t1);
    else
      first.phi1 = second.phi0 = 0.5 * (worst.phi0 + worst.phi1);
    add(-1, worst.total, &total);
    for (Cell* cell : {&first, &second}) {
      integrator.fill(cell);
      made += kNodes;
      add(1, cell->total, &total);
    }
    cells[index] = first;
    cells.push_back(second);
    queue.push({error(cells[index]), index});
    queue.push({error(cells.back()), cells.size() - 1});
  }

  nodes.evaluations = options.half && options.average ? 2 * made : made;

  const size_t size = cells.size() * kNodes;
  for (auto* v : {&nodes.x, &nodes.y, &nodes.z, &nodes.weight, &nodes.f[0], &nodes.f[1], &nodes.f[2]})
    v->reserve(size);
  const double factor = options.half ? 2 : 1;
  for (const Cell& cell : cells) {
    for (int k = 0; k < kNodes; ++k) {
      const Direction w = cell.w[k];
      const double weight = factor * cell.weight[k];
      nodes.x.push_back(w.x), nodes.y.push_back(w.y), nodes.z.push_back(w.z), nodes.weight.push_back(weight);
      double square = 0;
      for (int c = 0; c < 3; ++c) {
        const double f = cell.f[k][c];
        nodes.f[c].push_back(weight * f);
        nodes.albedo[c] += weight * f * w.z;
        square += f * f;
      }
      nodes.energy += weight * square, nodes.energy_cosine += weight * square * w.z * w.z;
    }
  }
  return nodes;
}

double mirror_asymmetry(const Bsdf& bsdf, double theta_out) {
  const Integrator integrator(bsdf, 0, theta_out);
  double odd = 0, all = 0;
  for (Cell& cell : seeds(integrator.map(), true, {kPhase / 16, false})) {
    integrator.fill(&cell);
    std::array<vec3, kNodes> other;
    for (Direction& w : cell.w) w.y = -w.y;
    integrator.evaluate(kNodes, cell.w.data(), other.data());
    for (int k = 0; k < kNodes; ++k)
      for (int c = 0; c < 3; ++c) {
        const double a = cell.f[k][c], b = other[k][c];
        odd += cell.weight[k] * 0.25 * (a - b) * (a - b), all += cell.weight[k] * 0.5 * (a * a + b * b);
      }
  }
  return all > 0 ? std::sqrt(odd / all) : 0;
}

}  // namespace zonal
