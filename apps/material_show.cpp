// `zonal material show`: what a projection keeps of a material, as a picture and a few lines.

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>

#include "apps/canvas.h"
#include "apps/commands.h"
#include "apps/material_source.h"
#include "core/error.h"
#include "materials/material_database.h"
#include "materials/sh_projector.h"
#include "sh/basis.h"
#include "sh/zonal.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;
constexpr float kPiF = std::numbers::pi_v<float>;
constexpr int kSphere = 260, kMargin = 20, kPlot = 250;

struct Options {
  std::string file, output;
  int bands = 0;
};

/// A disc of light in the sky.
struct SkyLight {
  vec3 axis;
  float radius;  ///< radians
  float radiance;
};
const SkyLight kLights[] = {{glm::normalize(vec3(-1, 1.3f, 0.9f)), 0.12f, 40.0f},
                            {glm::normalize(vec3(1, 0.3f, 0.6f)), 0.6f, 0.5f}};

/// Directions that cover a cap evenly, for the exact picture.
std::vector<vec3> cap_directions(const SkyLight& light, int count) {
  const Frame frame(light.axis);
  std::vector<vec3> directions;
  for (int i = 0; i < count; ++i) {
    const float t = (i + 0.5f) / count * (1 - std::cos(light.radius)), phi = i * 2.39996323f;  // golden angle
    const float s = std::sqrt(t * (2 - t));
    directions.push_back(frame.to_world({s * std::cos(phi), s * std::sin(phi), 1 - t}));
  }
  return directions;
}

/// Radiance of a sphere's point towards the viewer, by the table: light's coefficients dotted with F'.
vec3 shade_by_table(const ShMaterial& material, vec3 w_out, const vec3* local_axes) {
  const int bands = material.max_bands(), stride = sh_count(bands, material.mirrored());
  std::vector<float> rows(3 * stride), Y(sh::count(bands)), gains(bands);
  const int kept = material.look_up(ShTable::brdf_cosine, w_out, bands, stride, rows.data());
  const ViewFrame view(w_out);
  vec3 sum(0);
  for (int k = 0; k < 2; ++k) {
    sh::evaluate(kept, view.to_view(local_axes[k]), Y.data());
    sh::cap_gains(kept, sh::cap_from_half_angle(kLights[k].radius), gains.data());
    for (int l = 0; l < kept; ++l)
      for (int m = material.mirrored() ? 0 : -l; m <= l; ++m)
        for (int c = 0; c < 3; ++c)
          sum[c] += kLights[k].radiance * gains[l] * Y[sh::index(l, m)] *
                    rows[c * stride + sh_index(l, m, material.mirrored())];
  }
  return sum;
}

/// Half of the directions over each light, half by the BRDF, weighted by the balance heuristic (Veach 1997):
/// highlights narrower and wider than the lights are both smooth.
vec3 shade_exactly(const Bsdf& bsdf, vec3 w_out, const Frame& frame) {
  constexpr int kCount = 128;
  const BsdfContext view = prepare(bsdf, w_out);
  vec3 sum(0);
  const auto add = [&](vec3 local, const SkyLight& light, float light_density) {
    if (!(local.z > 0)) return;
    vec3 f;
    float density;
    evaluate_with_pdf(bsdf, view, local, &f, &density);
    sum += f * local.z * light.radiance / (kCount * (light_density + density));
  };
  for (const SkyLight& light : kLights) {
    const float cosine = std::cos(light.radius), density = 1 / (2 * kPiF * (1 - cosine));
    for (const vec3 w : cap_directions(light, kCount)) add(frame.to_local(w), light, density);
    for (int i = 0; i < kCount; ++i) {
      // Points of the plastic-number lattice (Roberts 2018), which cover the square evenly.
      const vec2 u(std::fmod(0.5f + i * 0.7548776662f, 1.0f), std::fmod(0.5f + i * 0.5698402910f, 1.0f));
      const BsdfSample s = sample(bsdf, view, (i + 0.5f) / kCount, u);
      if (s.pdf > 0 && glm::dot(frame.to_world(s.w_in), light.axis) >= cosine) add(s.w_in, light, density);
    }
  }
  return sum;
}

void draw_sphere(Canvas& canvas, vec2 corner, const std::function<vec3(vec3 w_out, const Frame&)>& shade) {
  std::vector<vec3> colors(kSphere * kSphere, vec3(-1));
  oneapi::tbb::parallel_for(0, kSphere, [&](int y) {
    for (int x = 0; x < kSphere; ++x) {
      const vec2 p((x + 0.5f) / kSphere * 2.1f - 1.05f, 1.05f - (y + 0.5f) / kSphere * 2.1f);
      const float r2 = glm::dot(p, p);
      if (r2 >= 1) continue;
      const vec3 n(p.x, p.y, std::sqrt(1 - r2));
      const Frame frame(n);
      colors[y * kSphere + x] = shade(frame.to_local({0, 0, 1}), frame);
    }
  });
  for (int y = 0; y < kSphere; ++y)
    for (int x = 0; x < kSphere; ++x) {
      const vec3 c = colors[y * kSphere + x];
      const vec3 shown =
          c.x < -0.5f ? vec3(0.16f) : vec3(srgb_encode(c.x), srgb_encode(c.y), srgb_encode(c.z));
      canvas.dot(int(corner.x) + x, int(corner.y) + y, shown);
    }
}

/// F' in the plane of w_out, exact (blue) and by the table (orange), radius on a square-root scale.
void draw_lobe(Canvas& canvas, vec2 corner, const Bsdf& bsdf, const ShMaterial& material, float degrees) {
  const float theta = degrees * kPiF / 180;
  const vec3 w_out(std::sin(theta), 0, std::cos(theta));
  const BsdfContext view = prepare(bsdf, w_out);
  const int bands = material.max_bands(), stride = sh_count(bands, material.mirrored());
  std::vector<float> rows(3 * stride), Y(sh::count(bands));
  const int kept = material.look_up(ShTable::brdf_cosine, w_out, bands, stride, rows.data());
  constexpr int kSteps = 360;
  std::vector<vec2> exact, table;
  float most = 1e-9f;
  for (int i = 0; i <= kSteps; ++i) {
    const float angle = kPiF * i / kSteps;  // from +x over the normal to -x
    const vec3 w(std::cos(angle), 0, std::sin(angle));
    const float e = luminance(evaluate(bsdf, view, w)) * std::max(w.z, 0.0f);
    sh::evaluate(kept, w, Y.data());
    vec3 t(0);
    for (int l = 0; l < kept; ++l)
      for (int m = material.mirrored() ? 0 : -l; m <= l; ++m)
        for (int c = 0; c < 3; ++c)
          t[c] += Y[sh::index(l, m)] * rows[c * stride + sh_index(l, m, material.mirrored())];
    most = std::max(most, e);
    exact.push_back(vec2(std::cos(angle), std::sin(angle)) * std::sqrt(e));
    table.push_back(vec2(std::cos(angle), std::sin(angle)) * std::sqrt(std::max(luminance(t), 0.0f)));
  }
  const float scale = 0.46f * kPlot / std::sqrt(most);
  const vec2 origin = corner + vec2(kPlot / 2, 150);
  const auto place = [&](vec2 p) { return origin + vec2(p.x, -p.y) * scale; };
  canvas.line(origin - vec2(kPlot / 2 - 6, 0), origin + vec2(kPlot / 2 - 6, 0), kGrey);
  canvas.line(origin, origin + vec2(w_out.x, -w_out.z) * 0.46f * float(kPlot), kGrey);
  for (int i = 0; i < kSteps; ++i) canvas.line(place(exact[i]), place(exact[i + 1]), kBlue);
  for (int i = 0; i < kSteps; ++i) canvas.line(place(table[i]), place(table[i + 1]), kOrange);
  canvas.text(corner + vec2(8, 160), fmt::format("{:.0f} deg: {} bands", degrees, kept), kBlack);
}

/// Share of the energy of F' against bands, at four elevations.
void draw_energy(Canvas& canvas, vec2 corner, float width, const Bsdf& bsdf) {
  constexpr int kMost = 64;  // the most a row keeps by default
  const float height = 200;
  const auto place = [&](float bands, float share) {
    return corner + vec2(60 + (width - 70) * bands / kMost, height * (1 - share));
  };
  for (const float share : {0.0f, 0.5f, 0.9f, 1.0f}) {
    canvas.line(place(0, share), place(kMost, share), {0.88f, 0.88f, 0.88f});
    canvas.text(place(0, share) - vec2(58, 7), fmt::format("{:.0f}%", 100 * share), kBlack);
  }
  for (const int bands : {10, 20, 40, 60, 80, 100})
    canvas.text(place(bands, 0) + vec2(-12, 8), std::to_string(bands), kBlack);
  int i = 0;
  for (const float degrees : {0.0f, 40.0f, 60.0f, 80.0f}) {
    const BandStudy study = study_bands(bsdf, degrees * std::numbers::pi / 180, kMost);
    const vec3 color = glm::mix(kBlue, kOrange, i / 3.0f);
    const std::vector<double>& shares = study.spherical[1];
    for (size_t l = 1; l < shares.size(); ++l)
      canvas.line(place(l, float(shares[l - 1])), place(l + 1, float(shares[l])), color);
    canvas.text(place(40, 0.62f - 0.13f * i), fmt::format("{:.0f} deg", degrees), color);
    ++i;
  }
}

/// Rows of F' that met the limit before the share they should hold, as ranges of elevations.
void print_cut(const ShMaterial& material) {
  const auto is_cut = [&](int k) {
    return k < ShMaterial::kElevations &&
           material.row_bands(ShTable::brdf_cosine, 0, k) == material.max_bands() &&
           material.row_share(ShTable::brdf_cosine, 0, k) < 0.9495f;
  };
  // One number where both ends read the same.
  const auto range = [](const std::string& low, const std::string& high) {
    return low == high ? low : low + " to " + high;
  };
  std::string cut;
  for (int k = 0; k < ShMaterial::kElevations; ++k) {
    if (!is_cut(k)) continue;
    const int first = k;
    float low = 1, high = 0;
    for (; is_cut(k); ++k) {
      low = std::min(low, material.row_share(ShTable::brdf_cosine, 0, k));
      high = std::max(high, material.row_share(ShTable::brdf_cosine, 0, k));
    }
    cut += fmt::format("{} {} deg ({} %)", cut.empty() ? "" : ",",
                       range(fmt::format("{:g}", ShMaterial::degrees(first)),
                             fmt::format("{:g}", ShMaterial::degrees(k - 1))),
                       range(fmt::format("{:.0f}", 100 * low), fmt::format("{:.0f}", 100 * high)));
  }
  if (!cut.empty())
    fmt::print("    less than 95 % of the energy in {} bands:{}\n", material.max_bands(), cut);
}

void print_rows(const ShMaterial& material) {
  for (const auto& [table, name] : {std::pair(ShTable::brdf, "F "), std::pair(ShTable::brdf_cosine, "F'")}) {
    fmt::print("{}: bands at 0, 10, ... 80, 89.5 deg:", name);
    float worst = 1;
    for (int k = 0; k < ShMaterial::kElevations; ++k)
      worst = std::min(worst, material.row_share(table, 0, k));
    for (const int k : {0, 10, 20, 30, 40, 50, 60, 70, 80, 90})
      fmt::print(" {}", material.row_bands(table, 0, k));
    fmt::print("; largest L2 error {:.1f} %{}\n", 100 * std::sqrt(std::max(0.0f, 1 - worst)),
               table == ShTable::brdf
                   ? " (before the cosine that weights it; automatic tables keep the bands of F')"
                   : "");
    if (table == ShTable::brdf_cosine) print_cut(material);
  }
}

int show_command(const Options& options) {
  const bool projection = fs::path(options.file).extension() == ".shmat";
  const std::string output =
      options.output.empty() ? fs::path(options.file).stem().string() + ".png" : options.output;
  check_writable(output);
  ShMaterial material;
  std::optional<MaterialSource> source;
  if (projection) {
    material = ShMaterial::open(options.file);
    // The measured file lies where the database's index says; without it only the table can be shown.
    const fs::path beside = fs::path(options.file).parent_path() / material.source();
    if (fs::exists(beside)) source = read_material_source(beside.string());
    for (fs::path folder = fs::absolute(options.file).parent_path(); !source && folder.has_relative_path();
         folder = folder.parent_path())
      if (fs::exists(folder / "index.json"))
        for (const DatabaseEntry& entry : MaterialDatabase::open(folder.string()).entries())
          if (fs::exists(entry.source) && fs::exists(entry.sh_file) &&
              fs::equivalent(entry.sh_file, options.file))
            source = read_material_source(entry.source);
  } else {
    source = read_material_source(options.file);
    ShProjection made = project_material(source->bsdf, {.bands = options.bands});
    made.name = source->name, made.source = fs::path(options.file).filename().string();
    material = ShMaterial::from_bytes(write_shmat(made), options.file);
  }
  const vec3 albedo = material.albedo();
  fmt::print("{}: from {}; albedo {:.3f} {:.3f} {:.3f}; {} floats, {}, asymmetry {:.2g}, {:.1f} kB\n",
             material.name(), material.source(), albedo.x, albedo.y, albedo.z,
             material.half() ? "16-bit" : "32-bit", material.mirrored() ? "m >= 0 alone" : "all m",
             material.asymmetry(), material.bytes().size() * 1e-3);
  if (source) {
    if (source->brdf->negative_samples) fmt::print("negative samples: {}\n", source->brdf->negative_samples);
    for (const std::string& note : source->brdf->notes) fmt::print("{}\n", note);
  }
  print_rows(material);
  if (!source)
    fmt::print("{} is neither beside the projection nor where a database says: the exact half is left out\n",
               material.source());

  const int width = source ? 4 * kPlot + 2 * kMargin : kSphere + 2 * kMargin;
  Canvas canvas(width, source ? 580 : kSphere + 90);
  const auto by_table = [&](vec3 w_out, const Frame& frame) {
    const vec3 axes[] = {frame.to_local(kLights[0].axis), frame.to_local(kLights[1].axis)};
    return glm::max(shade_by_table(material, w_out, axes), vec3(0));
  };
  canvas.text({kMargin, 10}, material.name(), kBlack);
  draw_sphere(canvas, {kMargin, 40}, by_table);
  int most = 0;  // of F', which the picture is shaded with
  for (int k = 0; k < ShMaterial::kElevations; ++k)
    most = std::max(most, material.row_bands(ShTable::brdf_cosine, 0, k));
  canvas.text({kMargin, 46 + kSphere}, fmt::format("sh: up to {} bands", most), kOrange);
  if (source) {
    draw_sphere(canvas, {2 * kMargin + kSphere, 40},
                [&](vec3 w_out, const Frame& frame) { return shade_exactly(source->bsdf, w_out, frame); });
    canvas.text({2 * kMargin + kSphere, 46 + kSphere}, "exact", kBlue);
    const float left = 3 * kMargin + 2 * kSphere;
    canvas.text({left + 60, 10}, "energy of F' by bands", kBlack);
    draw_energy(canvas, {left, 60}, width - left - kMargin, source->bsdf);
    const float degrees[] = {0, 30, 60, 80};
    for (int i = 0; i < 4; ++i)
      draw_lobe(canvas, {kMargin + i * kPlot, 350}, source->bsdf, material, degrees[i]);
    canvas.text({kMargin, 550}, "F' in the plane of view: exact", kBlue);
    canvas.text({kMargin + 390, 550}, "sh", kOrange);
    canvas.text({kMargin + 430, 550}, "radius: square root of F'", kGrey);
  }
  canvas.write(output);
  fmt::print("{}\n", output);
  return kDone;
}

}  // namespace

void add_material_show(CLI::App& material, int* exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      material.add_subcommand("show", "a picture of a material and what its projection keeps of it");
  command->add_option("file", options->file, ".shmat, RGL .bsdf or MERL .binary file")->required();
  command
      ->add_option("--bands", options->bands,
                   "of a measured file: bands of every row; 0: as many as it needs")
      ->check(CLI::Range(0, 100));
  command->add_option("-o,--output", options->output, "picture to write (.png)");
  command->callback([=] { *exit_code = show_command(*options); });
}

}  // namespace zonal
