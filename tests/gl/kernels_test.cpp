// Every function of the kernels that CPU and GPU share, on the GPU against C++: one text, two compilers.
#include <gtest/gtest.h>

#include <epoxy/gl.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/gtc/packing.hpp>
#include <random>
#include <regex>

#include "core/glsl.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "materials/sh_projector.h"
#include "tests/gl/support.h"
#include "tests/paths.h"

namespace zonal {
namespace kernel_cases {
// What GLSL has without asking.
using glm::uint;
using glm::uintBitsToFloat;
using glm::unpackHalf2x16;
inline const uint32_t* words = nullptr;  ///< the buffer a shader reads
inline uint32_t SHMAT_FIRST = 0, SHMAT_SECOND = 0;
#define SHMAT_WORD(i) words[i]
#define SUBJECT 0
#include "tests/gl/kernel_cases.glsl"
}  // namespace kernel_cases

namespace {

using namespace kernel_cases;

constexpr int kInputs = 1024, kNumbers = 34;
static_assert(sizeof(CaseInput) == kNumbers * sizeof(float));

struct KernelCase {
  int subject;  ///< of kernel_cases.glsl
  const char* name;
  void (*function)(CaseInput, CaseOutput&);
  int results;
};
void PrintTo(const KernelCase& row, std::ostream* out) {
  *out << row.name;
}

#define ROW(subject, name, results)      \
  KernelCase {                           \
    subject, #name, case_##name, results \
  }
const KernelCase kCases[] = {ROW(1, vpl_inverse_square, 1),
                             ROW(1, vpl_yuksel, 1),
                             ROW(1, vpl_geometry, 4),
                             ROW(1, vsl_cone, 2),
                             ROW(1, vsl_frame, 6),
                             ROW(1, vsl_direction, 3),
                             ROW(1, vsl_turn, 2),
                             ROW(1, inverse_square_attenuation, 4),
                             ROW(1, yuksel_attenuation, 4),
                             ROW(2, sh_direction, 4),
                             ROW(2, sh_evaluate, 100),
                             ROW(2, sh_evaluate_gradient, 36),
                             ROW(2, sh_evaluate_order, 32),
                             ROW(2, sh_dot, 1),
                             ROW(2, sh_clamped_cosine, 1),
                             ROW(2, sh_clamped_cosine_product, 100),
                             ROW(2, sh_next_multiple, 2),
                             ROW(2, sh_rotate_pair, 2),
                             ROW(2, sphere_cap, 3),
                             ROW(2, disk_cap, 3),
                             ROW(2, cap_first, 6),
                             ROW(2, cap_next, 6),
                             ROW(3, legendre_first, 2),
                             ROW(3, legendre_next, 19),
                             ROW(3, zonal_lobe_cap, 1),
                             ROW(3, zonal_diffuse, 1),
                             ROW(3, atan_tail, 1),
                             ROW(3, upper_angle, 1),
                             ROW(3, cap_irradiance, 1),
                             ROW(3, hvl_radiance, 3),
                             ROW(3, hvl_emission, 3),
                             ROW(3, hvl_edge, 1),
                             ROW(3, hvl_product, 3),
                             ROW(3, hvl_any_product, 3),
                             ROW(3, hvl_mirrored_product, 3),
                             ROW(3, hvl_zonal_product, 3),
                             ROW(4, sg_erfcx, 1),
                             ROW(4, sg_erfc, 1),
                             ROW(4, sg_erf_positive, 1),
                             ROW(4, sg_integral_of_erfc, 1),
                             ROW(4, sg_mean_exp, 1),
                             ROW(4, sg_evaluate, 1),
                             ROW(4, sg_integral, 1),
                             ROW(4, sg_product, 5),
                             ROW(4, sg_cosine_2015, 1),
                             ROW(4, sg_cosine_2024, 1),
                             ROW(4, sg_above_horizon, 1),
                             ROW(4, sg_sharpness_of, 1),
                             ROW(4, sg_shortfall_of, 1),
                             ROW(5, vsgl_distribution_sharpness, 1),
                             ROW(5, vsgl_reflection_2015, 4),
                             ROW(5, vsgl_dominant_normal, 3),
                             ROW(5, vsgl_reflection_2024, 4),
                             ROW(5, vsgl_unmasked, 1),
                             ROW(5, vsgl_add, 12),
                             ROW(5, vsgl_fit, 11),
                             ROW(5, vsgl_radiance, 5),
                             ROW(5, vsgl_asg_receiver, 6),
                             ROW(5, vsgl_specular_2015, 4),
                             ROW(5, vsgl_filtered_receiver, 12),
                             ROW(5, vsgl_specular_2024, 4),
                             ROW(5, vsgl_half_cosine, 1),
                             ROW(5, vsgl_base_cosine, 1),
                             ROW(5, vsgl_coat, 3),
                             ROW(5, vsgl_coat_at, 1),
                             ROW(6, sh_layer_weights, 9),
                             ROW(6, sh_layer_place, 1),
                             ROW(6, shmat_open, 5),
                             ROW(6, shmat_index, 1),
                             ROW(6, shmat_row, 2),
                             ROW(6, shmat_find, 5),
                             ROW(6, shmat_bands, 1),
                             ROW(6, shmat_coefficient, 3),
                             ROW(7, brdf_schlick_weight, 1),
                             ROW(7, brdf_dielectric, 1),
                             ROW(7, brdf_conductor, 1),
                             ROW(7, brdf_ggx, 3),
                             ROW(7, brdf_blinn_phong, 1),
                             ROW(7, brdf_coat_place, 1),
                             ROW(8, shd_dirac, 4),
                             ROW(8, shd_sphere, 11),
                             ROW(8, shd_bounded, 11),
                             ROW(8, shd_point, 8),
                             ROW(8, shd_spot, 8),
                             ROW(8, shd_facing_sphere, 11),
                             ROW(8, shd_triangle_point, 8),
                             ROW(8, shd_reflect, 3),
                             ROW(8, shd_zonal, 2),
                             ROW(8, shd_linear_cell, 32),
                             ROW(8, shd_hermite_cell, 32),
                             ROW(8, shd_difference, 64)};

std::vector<CaseInput> random_inputs() {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<CaseInput> inputs(kInputs);
  for (CaseInput& in : inputs) {
    for (float& u : in.u) u = std::min(float(unit(random)), 0x1.fffffep-1f);
    for (int i = 0; i < 6; ++i) {
      const double z = i < 3 ? 2 * unit(random) - 1 : 0.01 + 0.99 * unit(random),
                   phi = 2 * kPi * unit(random);
      const double s = std::sqrt(1 - z * z);
      in.d[i] = vec3(float(s * std::cos(phi)), float(s * std::sin(phi)), float(z));
    }
  }
  return inputs;
}

/// Two .shmat files of random coefficients: isotropic with half floats, anisotropic with floats and negative
/// orders.
std::vector<uint32_t> random_tables() {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> angle(0, 6);
  std::vector<uint32_t> all;
  std::array<float, 31> phase;
  for (float& x : phase) x = angle(random);
  for (const bool mirrored : {true, false}) {
    ShProjection p;
    p.name = "random", p.mirrored = mirrored, p.azimuths = mirrored ? 1 : 6;
    for (auto& table : p.rows)
      for (int r = 0; r < p.azimuths * ShMaterial::kElevations; ++r) {
        ShRow row;
        row.bands = 7, row.captured = 0.9;
        row.coefficients.resize(3 * size_t(sh_count(row.bands, mirrored)));
        // As smooth from row to row as real tables are: an angle's last digit must not decide.
        for (size_t i = 0; i < row.coefficients.size(); ++i)
          row.coefficients[i] = std::sin(0.05f * float(r % ShMaterial::kElevations) + phase[i % 31] +
                                         float(r / ShMaterial::kElevations));
        table.push_back(row);
      }
    const ShMaterial material = ShMaterial::from_bytes(write_shmat(p, {.half = mirrored}), "random");
    (mirrored ? SHMAT_FIRST : SHMAT_SECOND) = uint32_t(all.size());
    const auto bytes = material.bytes();
    all.resize(all.size() + (bytes.size() + 3) / 4);
    std::memcpy(all.data() + (mirrored ? SHMAT_FIRST : SHMAT_SECOND), bytes.data(), bytes.size());
  }
  return all;
}

class KernelsOnBothSides : public testing::TestWithParam<KernelCase> {};

TEST_P(KernelsOnBothSides, agree) {
  if (!test::gl_context()) GTEST_SKIP() << test::no_gl_reason();
  static const std::vector<CaseInput> inputs = random_inputs();
  static const std::vector<uint32_t> tables = random_tables();
  words = tables.data();
  const int results = GetParam().results;

  const gl::Program program = gl::Program::compute(
      test::shader_text(), "tests/gl/kernel_case.comp",
      {std::string("CASE case_") + GetParam().name, "SUBJECT " + std::to_string(GetParam().subject),
       "RESULTS " + std::to_string(results), "SHMAT_FIRST " + std::to_string(SHMAT_FIRST) + "u",
       "SHMAT_SECOND " + std::to_string(SHMAT_SECOND) + "u"});
  const gl::Buffer in{std::span(inputs)}, out(sizeof(float) * results * kInputs);
  const gl::TextureBuffer shmat{std::span(tables)};
  in.bind_storage(0), out.bind_storage(1), shmat.bind(0);
  program.use();
  program.set("count", kInputs);
  glDispatchCompute(kInputs / 64, 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<float> found(size_t(kInputs) * results);
  out.read(std::as_writable_bytes(std::span(found)));
  test::gl_context()->check(GetParam().name);

  std::vector<CaseOutput> expected(kInputs);
  for (int i = 0; i < kInputs; ++i) {
    expected[i] = {};
    GetParam().function(inputs[i], expected[i]);
  }
  bool any = false;
  for (int k = 0; k < results; ++k) {
    double square = 0;
    for (const CaseOutput& e : expected) square += double(e.v[k]) * e.v[k];
    const double rms = std::sqrt(square / kInputs);
    any = any || rms > 0;
    for (int i = 0; i < kInputs; ++i) {
      const double e = expected[i].v[k], f = found[i * results + k];
      ASSERT_LE(std::abs(f - e), 1e-5 * std::max(std::abs(e), rms))
          << "input " << i << ", result " << k << ": GPU " << f << ", C++ " << e;
    }
  }
  EXPECT_TRUE(any) << "every result is 0";
}

INSTANTIATE_TEST_SUITE_P(all, KernelsOnBothSides, testing::ValuesIn(kCases),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Kernels, none_is_without_a_case) {
  const std::filesystem::path root = test::source_dir();
  const std::string shader = test::shader_text().read("tests/gl/kernel_cases.glsl");
  const std::regex declared("KERNEL +[A-Za-z0-9_]+ +([a-z0-9_]+)\\(");
  int functions = 0;
  for (const char* folder : {"sh", "materials", "lights", "integrators"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      if (entry.path().extension() != ".glsl") continue;
      const std::string text = test::shader_text().read(std::filesystem::relative(entry.path(), root));
      for (std::sregex_iterator i(text.begin(), text.end(), declared), end; i != end; ++i, ++functions) {
        const std::string name = (*i)[1];
        EXPECT_TRUE(std::any_of(std::begin(kCases), std::end(kCases),
                                [&](const KernelCase& c) { return name == c.name; }))
            << entry.path() << ": " << name << " has no case in tests/gl/kernel_cases.glsl";
      }
    }
  }
  EXPECT_GE(functions, 60);
}

}  // namespace
}  // namespace zonal
