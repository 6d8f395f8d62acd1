// Two limits of the many-light methods, one thread.
//
//     build/bench_many_lights [scene.json [method [settings]]]
//
// First: nanoseconds a shaded point and light without occlusion, RGB, 64 points of a tile against 1,024
// lights, GGX with Schlick's Fresnel over a diffuse part that loses what the coat keeps, at both ends: `vpl`
// as it renders, beside the same mathematics written by hand as one loop over arrays. Then vsl, for its
// samples. Second: with occlusion, shadow rays a second of one pass of the method (all its work counts),
// beside Embree answering the same rays with nothing around them, one by one and in packets of 8; the faster
// of these is the limit. Runs are interleaved, medians are printed.
#include <fmt/format.h>
#include <time.h>

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <numeric>

#include "core/embree.h"
#include "core/error.h"
#include "core/ray_recorder.h"
#include "core/render.h"
#include "core/scene_loader.h"
#include "integrators/table.h"
#include "integrators/vpl/vpl.h"
#include "integrators/vsl/vsl.h"
#include "materials/fresnel.h"
#include "materials/microfacet.h"

namespace zonal {
namespace {

constexpr int kLights = 1024, kRounds = 31;
constexpr int kRow = SpecularAlbedo::Row::kPoints;

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

MetallicRoughnessMaterial paint() {
  MetallicRoughnessMaterial material;
  material.roughness.value = 0.5f, material.metallic.value = 0;
  material.base_color.value = vec3(0.5f, 0.4f, 0.3f);
  return material;
}

/// A floor seen by one tile.
Scene floor_scene() {
  SceneParts parts;
  parts.materials.push_back(std::make_unique<MetallicRoughnessMaterial>(paint()));
  ShapeData shape;
  shape.mesh.positions = {{-50, 0, -50}, {-50, 0, 50}, {50, 0, 50}, {50, 0, -50}};
  shape.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  shape.material = 0;
  parts.shapes.push_back(std::move(shape));
  Camera camera;
  camera.position = {0, 2, 2}, camera.forward = glm::normalize(vec3(0, -1, -1));
  camera.up = glm::normalize(vec3(0, 1, -1)), camera.width = camera.height = 8;
  parts.camera = camera;
  return Scene(std::move(parts));
}

/// Lights all around above the floor, each of which every point sees.
VirtualLightSet lights_above(const Material& material) {
  VirtualLightSet set;
  for (int i = 0; i < kLights; ++i) {
    const auto random = [&](uint32_t k) { return unit_float(hash32(static_cast<uint32_t>(i), k)); };
    VirtualLight v;
    v.position = {6 * random(1) - 3, 3 + random(2), 6 * random(3) - 3};
    v.normal = {0, -1, 0}, v.frame = Frame(v.normal);
    v.w_in = glm::normalize(vec3(random(4) - 0.5f, -0.5f - random(5), random(6) - 0.5f));
    v.power = {random(7), random(8), random(9)};
    v.bsdf = material.at({});
    v.shadow_point = v.position;
    set.lights.push_back(v);
  }
  return set;
}

/// The same GGX at both ends, in plain arrays. Every point and every light has a material of its own, as in a
/// scene.
struct ByHand {
  std::array<float, kRow> row;
  std::vector<float> l[28];  ///< lights: position, frame z, x and y, w_in, stretch, power, material
  alignas(64) float p[25][kTilePixels];  ///< points: position, frame, w_out, stretch, material
  int points = 0;

  [[gnu::always_inline]] static float kept(const float* row, float z) {
    const float at = std::sqrt(std::sqrt(std::fmin(z, 1.0f))) * (kRow - 1);
    const int node = static_cast<int>(std::fmin(at, kRow - 2.0f));
    return row[node] + (at - static_cast<float>(node)) * (row[node + 1] - row[node]);
  }

  __attribute__((noinline)) void gather(float* sum_r, float* sum_g, float* sum_b) const {
    const float* table = row.data();
    for (int j = 0; j < kLights; ++j) {
      const float lx = l[0][j], ly = l[1][j], lz = l[2][j], mx = l[3][j], my = l[4][j], mz = l[5][j];
      const float ux = l[6][j], uy = l[7][j], uz = l[8][j], vx = l[9][j], vy = l[10][j], vz = l[11][j];
      const float ix = l[12][j], iy = l[13][j], iz = l[14][j], is = l[15][j];
      const float pr = l[16][j], pg = l[17][j], pb = l[18][j];
      const float ea = l[19][j], ei = l[20][j], er = l[21][j], eg = l[22][j], eb = l[23][j];
      const float dr = l[24][j], dg = l[25][j], db = l[26][j];
      const float* light_table = table + static_cast<int>(l[27][j]);
#pragma omp simd
      for (int k = 0; k < points; ++k) {
        const float dx = lx - p[0][k], dy = ly - p[1][k], dz = lz - p[2][k];
        const float d2 = std::fmax(dx * dx + dy * dy + dz * dz, 1e-18f), inverse = 1 / std::sqrt(d2);
        const float wx = dx * inverse, wy = dy * inverse, wz = dz * inverse;
        const float x = wx * p[3][k] + wy * p[4][k] + wz * p[5][k],
                    y = wx * p[6][k] + wy * p[7][k] + wz * p[8][k];
        const float z = wx * p[9][k] + wy * p[10][k] + wz * p[11][k];
        const float ex = -(wx * ux + wy * uy + wz * uz), ey = -(wx * vx + wy * vy + wz * vz);
        const float ez = -(wx * mx + wy * my + wz * mz);
        const float cos_in = std::fmax(z, kMinCosine), cos_out = std::fmax(ez, kMinCosine);
        const float visible = (z > kMinCosine ? cos_in : 0.0f) * (ez > kMinCosine ? cos_out : 0.0f) / d2;

        // Receiver.
        const float ox = p[12][k], oy = p[13][k], oz = p[14][k], os = p[15][k];
        const float a = p[16][k], ia = p[17][k], fr = p[18][k], fg = p[19][k], fb = p[20][k];
        float hx = x + ox, hy = y + oy, hz = cos_in + oz;
        float h = 1 / std::sqrt(hx * hx + hy * hy + hz * hz);
        hx *= h, hy *= h, hz *= h;
        float c = std::fmin(std::fmax(ox * hx + oy * hy + oz * hz, 0.0f), 1.0f);
        float s = (hx * ia) * (hx * ia) + (hy * ia) * (hy * ia) + hz * hz;
        float stretch = std::sqrt((a * x) * (a * x) + (a * y) * (a * y) + cos_in * cos_in);
        float lobe = 0.5f * kInvPi * ia * ia / (s * s * (oz * stretch + cos_in * os));
        float m = schlick_weight(c);
        float base = 1 - kept(table + static_cast<int>(p[24][k]), cos_in);
        const float rr = (fr + (1 - fr) * m) * lobe + p[21][k] * base;
        const float rg = (fg + (1 - fg) * m) * lobe + p[22][k] * base;
        const float rb = (fb + (1 - fb) * m) * lobe + p[23][k] * base;

        // Emitter.
        hx = ex + ix, hy = ey + iy, hz = cos_out + iz;
        h = 1 / std::sqrt(hx * hx + hy * hy + hz * hz);
        hx *= h, hy *= h, hz *= h;
        c = std::fmin(std::fmax(ix * hx + iy * hy + iz * hz, 0.0f), 1.0f);
        s = (hx * ei) * (hx * ei) + (hy * ei) * (hy * ei) + hz * hz;
        stretch = std::sqrt((ea * ex) * (ea * ex) + (ea * ey) * (ea * ey) + cos_out * cos_out);
        lobe = 0.5f * kInvPi * ei * ei / (s * s * (iz * stretch + cos_out * is));
        m = schlick_weight(c);
        base = 1 - kept(light_table, cos_out);
        sum_r[k] += rr * visible * pr * ((er + (1 - er) * m) * lobe + dr * base);
        sum_g[k] += rg * visible * pg * ((eg + (1 - eg) * m) * lobe + dg * base);
        sum_b[k] += rb * visible * pb * ((eb + (1 - eb) * m) * lobe + db * base);
      }
    }
  }
};

/// alpha, 1/alpha, F0, diffuse with its normalisation, place of the coat's table.
std::array<float, 9> numbers(const Bsdf& b, const BsdfContext& view) {
  const vec3 diffuse = b.diffuse * view.normalization;
  return {b.alpha_x, 1 / b.alpha_x, b.specular.x, b.specular.y, b.specular.z, diffuse.x, diffuse.y, diffuse.z,
          0};
}

ByHand by_hand(const Tile& tile, const VirtualLightSet& set) {
  ByHand h;
  tile.bsdfs[0].coat->row(tile.bsdfs[0].alpha_x).tabulate(h.row.data());
  for (const VirtualLight& v : set.lights) {
    const vec3 in = v.frame.to_local(v.w_in);
    const BsdfContext view = prepare(v.bsdf, in, PathEnd::light);
    int i = 0;
    for (const vec3 a : {v.position, v.frame.z, v.frame.x, v.frame.y, in})
      for (int c = 0; c < 3; ++c) h.l[i++].push_back(a[c]);
    h.l[i++].push_back(view.stretch_out);
    for (int c = 0; c < 3; ++c) h.l[i++].push_back(v.power[c]);
    for (const float number : numbers(v.bsdf, view)) h.l[i++].push_back(number);
  }
  h.points = tile.count;
  for (int k = 0; k < tile.count; ++k) {
    const Surface& s = tile.surfaces[k];
    const vec3 out = s.shading.to_local(s.w_out);
    const BsdfContext view = prepare(tile.bsdfs[k], out);
    int i = 0;
    for (const vec3 a : {s.position, s.shading.x, s.shading.y, s.shading.z, out})
      for (int c = 0; c < 3; ++c) h.p[i++][k] = a[c];
    h.p[i++][k] = view.stretch_out;
    for (const float number : numbers(tile.bsdfs[k], view)) h.p[i++][k] = number;
  }
  return h;
}

void measure_shading() {
  const Scene scene = floor_scene();
  const MetallicRoughnessMaterial material = paint();
  const VirtualLightSet set = lights_above(material);
  VplParams vpl_params;
  vpl_params.occlusion = Occlusion::none, vpl_params.direct = ManyLightsParams::Direct::none;
  VslParams vsl_params;
  vsl_params.occlusion = Occlusion::none, vsl_params.direct = ManyLightsParams::Direct::none;
  vsl_params.radius.rule = RadiusRule::metres, vsl_params.radius.metres = 0.3f;
  VplIntegrator vpl(vpl_params);
  VslIntegrator vsl(vsl_params);
  const Pass pass{.scene = scene, .camera = scene.camera()};
  PassStats stats;
  for (ManyLights* method : {static_cast<ManyLights*>(&vpl), static_cast<ManyLights*>(&vsl)}) {
    method->gather_from(set);
    method->begin_pass(pass, {}, stats);
  }
  Tile tile;
  std::array<Sampler, kTilePixels> samplers;
  trace_tile(scene, scene.camera(), {0, 0}, 0, 0, false, &tile, samplers.data());
  const ByHand hand = by_hand(tile, set);

  std::array<vec3, kTilePixels> radiance;
  TileStats counters;
  alignas(64) std::array<float, kTilePixels> r, g, b;
  std::vector<double> vpl_ns, vsl_ns, hand_ns, ratios;
  const double pairs = static_cast<double>(kLights) * tile.count;
  double difference = 0;
  for (int round = 0; round < kRounds; ++round) {
    double start = cpu_seconds();
    r.fill(0), g.fill(0), b.fill(0);
    hand.gather(r.data(), g.data(), b.data());
    hand_ns.push_back((cpu_seconds() - start) * 1e9 / pairs);
    start = cpu_seconds();
    vpl.shade(tile, radiance.data(), samplers.data(), {}, counters);
    vpl_ns.push_back((cpu_seconds() - start) * 1e9 / pairs);
    ratios.push_back(vpl_ns.back() / hand_ns.back());
    for (int k = 0; k < tile.count; ++k)
      difference = std::max(difference, std::abs(radiance[k].y / double(g[k]) - 1));
    if (round % 8 == 0) {
      start = cpu_seconds();
      vsl.shade(tile, radiance.data(), samplers.data(), {}, counters);
      vsl_ns.push_back((cpu_seconds() - start) * 1e9 / pairs);
    }
  }
  fmt::print(
      "{} points, {} lights, GGX over diffuse at both ends, RGB, no occlusion, 1 thread, medians of {}\n",
      tile.count, kLights, kRounds);
  fmt::print(
      "  vpl {:.2f} ns a point and light; by hand {:.2f} ns; ratio {:.2f} (limit 1.2); results differ by "
      "{:.1e}\n",
      median(vpl_ns), median(hand_ns), median(ratios), difference);
  fmt::print("  vsl {:.1f} ns a point and light, {} samples: {:.2f} ns each\n", median(vsl_ns),
             vsl_params.samples, median(vsl_ns) / vsl_params.samples);
}

RenderReport render_pass(const Scene& scene, const std::string& method, const std::string& settings) {
  const auto integrator =
      find_integrator(method, "").make(nlohmann::json::parse(settings), "settings", nullptr);
  Film film(160, 96);
  return render(scene, *integrator, film, {.passes = 1}, {.seed = 1, .threads = 1});
}

double trace_single(RTCScene raw, const std::vector<RayRecord>& rays) {
  embree::Context context = embree::context();
  const double start = cpu_seconds();
  for (const RayRecord& r : rays) {
    RTCRay ray{r.origin.x, r.origin.y, r.origin.z, r.t_min, r.direction.x, r.direction.y, r.direction.z, 0,
               r.t_max,    ~0u,        0,          0};
    embree::occluded1(raw, context, ray);
  }
  return (cpu_seconds() - start);
}

double trace_packets(RTCScene raw, const std::vector<RayRecord>& rays) {
  embree::Context context = embree::context();
  const double start = cpu_seconds();
  for (size_t first = 0; first < rays.size(); first += 8) {
    alignas(32) int valid[8];
    RTCRay8 packet;
    for (size_t i = 0; i < 8; ++i) {
      const RayRecord& r = rays[std::min(first + i, rays.size() - 1)];
      valid[i] = first + i < rays.size() ? -1 : 0;
      packet.org_x[i] = r.origin.x, packet.org_y[i] = r.origin.y, packet.org_z[i] = r.origin.z;
      packet.dir_x[i] = r.direction.x, packet.dir_y[i] = r.direction.y, packet.dir_z[i] = r.direction.z;
      packet.tnear[i] = r.t_min, packet.tfar[i] = r.t_max;
      packet.time[i] = 0, packet.mask[i] = ~0u, packet.id[i] = 0, packet.flags[i] = 0;
    }
    embree::occluded8_coherent(valid, raw, context, packet);
  }
  return (cpu_seconds() - start);
}

void measure_occlusion(const std::string& file, const std::string& method, const std::string& settings) {
  const Scene scene = load_scene(file);
  std::vector<RayRecord> rays;
  ray_recorder = &rays;  // one thread: the render runs in this one
  render_pass(scene, method, settings);
  ray_recorder = nullptr;
  // Camera and light rays are a fraction of a percent; the method pays for them.
  std::erase_if(rays, [](const RayRecord& r) { return !r.shadow || !(r.t_max > 0); });
  if (rays.empty()) return fmt::print("{}: {} traced no shadow rays\n", file, method);
  const auto raw = static_cast<RTCScene>(scene.embree());
  std::vector<double> rate, single, packets;
  for (int round = 0; round < 5; ++round) {
    const double start = cpu_seconds();
    render_pass(scene, method, settings);
    const auto count = static_cast<double>(rays.size()) * 1e-6;
    rate.push_back(count / (cpu_seconds() - start));
    single.push_back(count / trace_single(raw, rays));
    packets.push_back(count / trace_packets(raw, rays));
  }
  const double limit = std::max(median(single), median(packets));
  fmt::print("{}: {} {}, {} shadow rays at 160x96, 1 thread\n", file, method, settings, rays.size());
  fmt::print(
      "  {:.2f} Mrays/s; Embree alone {:.2f} one by one, {:.2f} in packets; ratio {:.2f} (limit 0.8)\n",
      median(rate), median(single), median(packets), median(rate) / limit);
}

}  // namespace
}  // namespace zonal

int main(int argc, char** argv) {
  oneapi::tbb::global_control alone(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  try {
    if (argc < 2) zonal::measure_shading();
    zonal::measure_occlusion(
        argc > 1 ? argv[1] : "scenes/atrium/atrium.json", argc > 2 ? argv[2] : "vpl",
        argc > 3 ? argv[3] : R"({"lights": 400, "direct": "none", "occlusion": "center"})");
  } catch (const zonal::SceneError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
