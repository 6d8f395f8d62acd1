#include "integrators/sh_direct/sh_direct_gl.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>

#include "gl/sh_tables.h"
#include "gl/units.h"
#include "integrators/sh_direct/sh_direct.h"
#include "sh/clamped_cosine.h"
#include "sh/gauss_panel.h"
#include "sh/product_table.h"
#include "sh/rotation.h"

namespace zonal::gl {
namespace {

constexpr int kMostBands = 10;  ///< SH_MAX_BANDS of sh/basis.glsl
constexpr int kTexels = 4;      ///< a light, as lights.glsl has them
/// Of an edge: a trigonometric polynomial of degree 9 over half a turn is integrated to float's rounding
/// (GaussPanels::nodes_for asks for double's).
constexpr int kEdgeNodes = 16;
enum Kind { kSphere, kPoint, kSpot, kFacing, kTriangle };

using At = ShDirectParams::At;
using Shading = ShReceiverParams::Shading;

std::span<const vec4> span_of(const std::vector<vec4>& texels) {
  return texels;
}

void add_light(std::vector<vec4>& t, vec4 first, vec3 colour, Kind kind, vec4 third = {}, vec4 fourth = {}) {
  t.insert(t.end(), {first, vec4(colour, float(kind)), third, fourth});
}

std::vector<vec4> pack(const ShLights& lights) {
  std::vector<vec4> t;
  const auto place = [](const ShLights::Arrays& a, int i) { return vec3(a.x[i], a.y[i], a.z[i]); };
  const auto colour = [](const ShLights::Arrays& a, int i) {
    return vec3(a.colour[0][i], a.colour[1][i], a.colour[2][i]);
  };
  const auto axis = [](const ShLights::Arrays& a, int i) {
    return vec3(a.axis_x[i], a.axis_y[i], a.axis_z[i]);
  };
  const ShLights::Arrays &spheres = lights.spheres(), &points = lights.points(), &spots = lights.spots();
  for (int i = 0; i < spheres.count(); ++i)
    add_light(t, vec4(place(spheres, i), spheres.radius[i]), colour(spheres, i), kSphere);
  for (int i = 0; i < points.count(); ++i)
    add_light(t, vec4(place(points, i), 0.0f), colour(points, i), kPoint);
  for (int i = 0; i < spots.count(); ++i)
    add_light(t, vec4(place(spots, i), 0.0f), colour(spots, i), kSpot,
              vec4(axis(spots, i), spots.cos_inner[i]), vec4(vec3(0), spots.cos_outer[i]));
  const ShLights::Triangles& facing = lights.triangles();
  for (int i = 0; i < facing.spheres.count(); ++i)
    add_light(t, vec4(place(facing.spheres, i), facing.spheres.radius[i]), colour(facing.spheres, i), kFacing,
              vec4(axis(facing.spheres, i), 0.0f), vec4(vec3(0), facing.back[i] == 0 ? 0.0f : 1.0f));
  const sh::TriangleBatch<float>& exact = lights.exact_triangles();
  for (int i = 0; i < exact.count(); ++i) {
    const vec3 a = exact.corner(i, 0);
    add_light(t, vec4(a, exact.extent(i)), exact.radiance(i), kTriangle, vec4(exact.corner(i, 1) - a, 0.0f),
              vec4(exact.corner(i, 2) - a, exact.two_sided(i) ? 1.0f : 0.0f));
  }
  // A buffer without lights would be gone through without a pass, and parallel light left out.
  if (t.empty()) add_light(t, vec4(0, 0, 0, 1), vec3(0), kPoint);
  return t;
}

class ShDirectTwin : public Twin {
 public:
  ShDirectTwin(const ShaderText& text, ShDirectIntegrator& cpu, const Scene& scene)
      : cpu_(cpu), text_(text), materials_(static_cast<uint32_t>(scene.materials().size())) {
    cpu_.leave_grids_empty();
  }

  void begin_pass(const Pass&, SceneBuffers& scene) override {
    scene.upload_coats();
    if (gather_.id() == 0) prepare();
    if (on_grid()) build_grid();
  }

  void gather(const GBuffer& points, const Texture2D& sum) override {
    receive(points);
    receivers_.bind(units::kMethod);
    if (zonal()) lobes_.bind(units::kMethod + 1);
    rules_.bind(units::kMethod + 2), fixed_.bind(units::kMethod + 3);
    if (on_grid()) grid_values_.bind(units::kMethod + 4), grid_slots_.bind(units::kMethod + 5);
    gather_lights(gather_, lights_, points, sum, batch());
  }

 private:
  const ShDirectParams& params() const { return cpu_.params(); }
  bool on_grid() const { return params().at == At::grid; }
  bool zonal() const { return params().product == ShDirectParams::Product::zonal; }
  /// Light meets the tabulated BRDF times cosine; else the cosine first.
  bool by_table() const { return params().shading == Shading::table || zonal(); }

  void prepare() {
    bands_ = cpu_.receiver().most_light_bands();
    upload_lights();
    prepare_receiver();
    const bool triangles = cpu_.lights().exact_triangles().count() > 0;
    const std::vector<std::string> defines = {fmt::format("BANDS {}", bands_),
                                              fmt::format("TRIANGLES {}", triangles ? 1 : 0)};
    std::vector<std::string> of_gather = defines;
    of_gather.push_back(on_grid() ? "AT_GRID 1" : "AT_GRID 0");
    of_gather.push_back(zonal() ? "ZONAL 1" : "ZONAL 0");
    gather_ = Program::compute(text_, "integrators/sh_direct/sh_direct.comp", of_gather);
    set_rules(gather_);
    gather_.set("bands", bands_);
    if (zonal()) {
      // (SHD-9): (2l+1)/4pi times the integral of P_l times cosine.
      float zonals[kMostBands], weights[kMostBands];
      sh::clamped_cosine_zonal(kMostBands, zonals);
      for (int l = 0; l < bands_; ++l)
        weights[l] = zonals[l] * std::sqrt(float(2 * l + 1) / (4 * kPi)) * window(bands_)[l];
      gather_.set("cosine_weights", std::span<const float>(weights, size_t(bands_)));
      gather_.set("window", window(bands_));
    }
    if (!on_grid()) return;
    parts_ = params().scheme.parts();
    std::vector<std::string> of_grid = defines;
    of_grid.push_back(fmt::format("PARTS {}", parts_));
    of_grid.push_back(params().loops == ShDirectParams::Loops::reverse ? "REVERSE 1" : "REVERSE 0");
    grid_ = Program::compute(text_, "integrators/sh_direct/grid.comp", of_grid);
    set_rules(grid_);
    grid_.set("bands", bands_);
    gather_.set("interpolation", static_cast<int>(params().scheme.interpolation));
    gather_.set("differences", params().scheme.mixed == ShScheme::Mixed::differences ? 1 : 0);
    gather_.set("parts", parts_);
  }

  /// Lights a dispatch: Mesa's software renderer leaves an invocation's loops, nested ones counted, after
  /// 65,535 rounds; with margin for how they are counted.
  int batch() const {
    const int take = 2 * bands_ * bands_ + bands_, edge = 2 * bands_ * (bands_ + 1);
    const bool triangles = cpu_.lights().exact_triangles().count() > 0;
    return std::max(1, 30000 / (triangles ? std::max(64 * take, 3 * kEdgeNodes * edge) : take));
  }

  std::span<const float> window(int bands) const { return {cpu_.receiver().window_of(bands), size_t(bands)}; }

  void upload_lights() {
    lights_ = LightBuffer(pack(cpu_.lights()), kTexels);
    std::vector<float> L(3 * size_t(sh::count(bands_)));
    cpu_.lights().fixed(bands_, L.data());
    std::vector<vec4> fixed;
    const size_t n = sh::count(bands_);
    for (size_t i = 0; i < n; ++i) fixed.emplace_back(L[i], L[n + i], L[2 * n + i], 0.0f);
    fixed_ = TextureBuffer(span_of(fixed));

    std::vector<vec4> points;
    for (const auto& rule : sh::TriangleBatch<float>::rule_points()) {
      starts_.push_back(float(points.size()));
      for (const auto& p : rule) points.emplace_back(p.s, p.t, p.weight, 0.0f);
    }
    starts_.push_back(float(points.size()));
    const double *at = sh::GaussPanels::get().nodes(kEdgeNodes),
                 *weight = sh::GaussPanels::get().weights(kEdgeNodes);
    for (int i = 0; i < kEdgeNodes; ++i) points.emplace_back(0.5 + 0.5 * at[i], 0.5 * weight[i], 0.0, 0.0);
    starts_.push_back(float(points.size()));
    rules_ = TextureBuffer(span_of(points));
    reach_ = sh::TriangleBatch<float>::reaches(bands_, params().tolerance);
  }

  void set_rules(const Program& program) const {
    program.set("starts", std::span<const float>(starts_));
    program.set("reach", std::span<const float>(reach_));
    program.set("disks", params().spheres == ShDirectParams::Spheres::disk ? 1 : 0);
  }

  void prepare_receiver() {
    tables_ = ShTables(cpu_.receiver().materials(), materials_);
    float cosine[kMostBands];
    sh::clamped_cosine_zonal(kMostBands, cosine);
    if (by_table()) {
      const int used = std::min(bands_, params().bands);
      receive_ = Program::compute(text_, "integrators/hvl/receive.comp");
      receive_.set("bands", used);
      std::vector<float> weights(window(used).begin(), window(used).end());
      receive_.set("window", std::span<const float>(weights));
      float lambert[kMostBands];
      for (int l = 0; l < kMostBands; ++l) lambert[l] = cosine[l] * kInvPi;
      receive_.set("lambert_zonal", std::span<const float>(lambert));
    } else {
      prepare_product(cosine);
    }
    if (zonal() || !by_table()) lobes_ = zonal_lobe_texels();
    turn_ = Program::compute(text_, "integrators/sh_direct/turn.comp");
    turn_.set("bands", bands_);
    // About x by 90 degrees: y to z.
    const sh::Rotation<float> quarter(kMostBands,
                                      sh::Mat3<float>(vec3(1, 0, 0), vec3(0, 0, 1), vec3(0, -1, 0)));
    std::vector<float> elements;
    for (int l = 0; l < kMostBands; ++l)
      for (int n = -l; n <= l; ++n)
        for (int m = -l; m <= l; ++m) elements.push_back(quarter.element(l, m, n));
    elements.resize((elements.size() + 3) / 4 * 4);
    std::vector<vec4> texels;
    for (size_t i = 0; i < elements.size(); i += 4)
      texels.emplace_back(elements[i], elements[i + 1], elements[i + 2], elements[i + 3]);
    quarter_ = TextureBuffer(span_of(texels));
  }

  /// (SHD-3) on the receiver's side.
  void prepare_product(const float* cosine) {
    const int used = std::max(bands_, params().bands);
    const bool general = params().shading != Shading::cosine,
               windows_light = params().windowed == ShReceiverParams::Windowed::light;
    receive_ = Program::compute(text_, "integrators/sh_direct/receive.comp",
                                {fmt::format("BANDS {}", used), general ? "GENERAL 1" : "GENERAL 0"});
    receive_.set("bands", used), receive_.set("light_bands", bands_);
    std::vector<float> ones(kMostBands, 1.0f), lobe = ones, light = ones;
    std::copy_n(window(windows_light ? bands_ : used).data(), windows_light ? bands_ : used,
                windows_light ? light.data() : lobe.data());
    receive_.set("window", std::span<const float>(lobe));
    receive_.set("light_weights", std::span<const float>(light));

    const int cut = params().cosine_bands > 0 ? std::min(params().cosine_bands, used) : used;
    std::vector<float> diffuse(kMostBands, 0.0f);
    const bool irradiance = params().diffuse == ShReceiverParams::Diffuse::irradiance;
    const int read = irradiance ? std::min(bands_, params().cosine_bands > 0 ? params().cosine_bands : bands_)
                                : std::min(bands_, general ? cut : bands_);
    for (int l = 0; l < read; ++l) diffuse[l] = cosine[l] * (irradiance ? window(read)[l] : light[l]);
    receive_.set("diffuse_weights", std::span<const float>(diffuse));
    if (!general) return;
    receive_.set("cosine", std::span<const float>(cosine, size_t(kMostBands)));
    // `turned` has a cosine of few bands and a small tensor; `general` one that ends in zeros.
    const int second = params().shading == Shading::turned ? cut : used;
    std::vector<float> zeroed(cosine, cosine + kMostBands);
    std::fill(zeroed.begin() + cut, zeroed.end(), 0.0f);
    receive_.set("cosine", std::span<const float>(zeroed));
    std::vector<vec4> entries;
    sh::ProductTable<float>(used, second, used).for_each([&](int i, int j, int k, float value) {
      entries.emplace_back(float(i), float(j), float(k), value);
      // Of equal numbers of bands half are stored.
      if (used == second && i != j) entries.emplace_back(float(j), float(i), float(k), value);
    });
    receive_.set("entry_count", static_cast<int>(entries.size()));
    entries_ = TextureBuffer(span_of(entries));
  }

  /// Fills the layers that the gathering pass reads.
  void receive(const GBuffer& points) {
    if (receivers_.width() != points.width() || receivers_.height() != points.height()) {
      receivers_ = Texture2D(GL_RGBA32F, points.width(), points.height(), sh::count(bands_));
      // Bands that the receiver lacks stay 0.
      const float nothing[4] = {0, 0, 0, 0};
      glClearTexImage(receivers_.id(), 0, GL_RGBA, GL_FLOAT, nothing);
    }
    points.bind();
    receivers_.bind_image(2);
    tables_.bind(units::kMethod + 2, units::kMethod + 3);
    if (entries_.bytes() > 0) entries_.bind(units::kMethod);
    if (!by_table()) lobes_.bind(units::kMethod + 1);
    over_pixels(receive_, points);
    quarter_.bind(units::kMethod + 1);
    over_pixels(turn_, points);
  }

  static void over_pixels(const Program& program, const GBuffer& points) {
    program.use();
    program.set("size", ivec2(points.width(), points.height()));
    glDispatchCompute((points.width() + 7) / 8, (points.height() + 7) / 8, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }

  void build_grid() {
    const ShGrid& grid = cpu_.grid();
    const int count = grid.built_points();
    const size_t texels = std::max<size_t>(size_t(count) * parts_ * sh::count(bands_), 1);
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    if (texels > TextureBuffer::limit() || double(texels) * sizeof(vec4) > double(most))
      refuse("sh_direct", "grid", fmt::format("{} points", count),
             fmt::format("at most {}", most / GLint64(sizeof(vec4)) / parts_ / sh::count(bands_)));
    if (grid_values_.bytes() != texels * sizeof(vec4)) grid_values_ = TextureBuffer(texels);
    grid_values_.clear();
    std::vector<vec4> places;
    for (int slot = 0; slot < count; ++slot) places.emplace_back(grid.place(slot), 0.0f);
    std::vector<uint32_t> slots;
    for (const int slot : grid.slots()) slots.push_back(static_cast<uint32_t>(slot + 1));
    grid_places_ = TextureBuffer(span_of(places));
    grid_slots_ = TextureBuffer(std::span<const uint32_t>(slots));
    gather_.set("grid_low", grid.low()), gather_.set("grid_size", grid.cell_size());
    gather_.set("grid_points", vec3(grid.points()));
    fill_grid(count);
  }

  void fill_grid(int count) {
    grid_.use();
    grid_.set("count", count);
    const vec3 size = cpu_.grid().cell_size();
    grid_.set("cell", std::min({size.x, size.y, size.z}));
    rules_.bind(units::kMethod + 2), fixed_.bind(units::kMethod + 3);
    grid_places_.bind(units::kMethod + 4);
    grid_values_.bind_storage(0);
    const int invocations = params().loops == ShDirectParams::Loops::reverse ? count * bands_ : count;
    for (const LightBuffer::Chunk& chunk : lights_.chunks()) {
      chunk.texels.bind(units::kLights);
      grid_.set("chunk_first", chunk.first);
      for (int first = 0; first < chunk.count; first += batch()) {
        grid_.set("range", ivec2(first, std::min(first + batch(), chunk.count)));
        glDispatchCompute((invocations + 63) / 64, 1, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
      }
    }
  }

  ShDirectIntegrator& cpu_;
  ShaderText text_;
  uint32_t materials_;
  int bands_ = 0, parts_ = 1;
  Program gather_, receive_, turn_, grid_;
  LightBuffer lights_;
  ShTables tables_;
  TextureBuffer rules_, fixed_, lobes_, quarter_, entries_, grid_values_, grid_places_, grid_slots_;
  Texture2D receivers_;
  std::vector<float> starts_, reach_;
};

}  // namespace

std::unique_ptr<Twin> make_sh_direct_twin(const ShaderText& text, Integrator& cpu, const Scene& scene) {
  auto& direct = dynamic_cast<ShDirectIntegrator&>(cpu);
  const ShDirectParams& p = direct.params();
  const auto check = [&](const char* key, bool good, const std::string& found, const std::string& expected) {
    if (!good) refuse("sh_direct", key, found, expected);
  };
  const auto bands = [&](const char* key, int value) {
    check(key, value != kAuto && value <= kMostBands, value == kAuto ? "auto" : fmt::format("{}", value),
          fmt::format("1 to {}", kMostBands));
  };
  bands("bands", p.bands), bands("light_bands", p.light_bands);
  check("at", p.at != At::octree, "octree", "\"pixel\" or \"grid\"");
  check("occlusion", p.occlusion == ShDirectParams::Occlusion::none,
        p.occlusion == ShDirectParams::Occlusion::ambient ? "ambient" : "ratio", "\"none\"");
  check("mixed", p.at != At::grid || p.scheme.parts() <= 4, "hessian", "\"differences\" or \"zero\"");
  check("polygons",
        p.polygons == ShLightOptions::Polygons::exact || p.polygons == ShLightOptions::Polygons::main,
        p.polygons == ShLightOptions::Polygons::factorized ? "factorized" : "another sphere for triangles",
        "\"exact\" or \"main\"");
  check("window", p.window != ShReceiverParams::Window::dering, "dering", "another window");
  return std::make_unique<ShDirectTwin>(text, direct, scene);
}

}  // namespace zonal::gl
