// The .shmat format and its readers: what is written comes back, in C++ and through the shaders' text.

#include "materials/sh_material.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "core/atomic_file.h"
#include "materials/sh_projector.h"
#include "materials/shmat_format.h"
#include "tests/gpu_shmat.h"
#include "tests/paths.h"

namespace zonal {
namespace {

/// Rows of random coefficients, 1 to 7 bands, never the same twice.
ShProjection random_projection(bool mirrored, int azimuths, int fixed_bands = 0) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> value(-2, 2);
  ShProjection p;
  p.name = "test/random", p.source = "random.bsdf";
  p.mirrored = mirrored, p.azimuths = azimuths, p.asymmetry = mirrored ? 1e-4 : 0.5;
  p.albedo = vec3(0.25f, 0.5f, 0.75f);
  for (auto& table : p.rows) {
    for (int r = 0; r < azimuths * ShMaterial::kElevations; ++r) {
      ShRow row;
      row.bands = fixed_bands > 0 ? fixed_bands : 1 + int(random() % 7);
      row.captured = (r % 100) / 100.0;
      row.coefficients.resize(3 * size_t(sh_count(row.bands, mirrored)));
      for (float& c : row.coefficients) c = value(random);
      table.push_back(row);
    }
  }
  return p;
}

ShMaterial material_of(const ShProjection& p, bool half) {
  return ShMaterial::from_bytes(write_shmat(p, {.half = half}), "memory");
}

vec3 direction(double theta, double phi) {
  return vec3(float(std::sin(theta) * std::cos(phi)), float(std::sin(theta) * std::sin(phi)),
              float(std::cos(theta)));
}
constexpr double kDegree = 3.14159265358979323846 / 180;

TEST(ShmatFormat, half_floats_agree_with_another_implementation) {
  for (uint32_t h = 0; h < 65536; ++h) {
    const float ours = shmat::from_half(uint16_t(h)), theirs = glm::unpackHalf1x16(uint16_t(h));
    if (std::isnan(theirs)) {
      EXPECT_TRUE(std::isnan(ours)) << h;
      continue;
    }
    EXPECT_EQ(std::bit_cast<uint32_t>(ours), std::bit_cast<uint32_t>(theirs)) << h;
    EXPECT_EQ(shmat::to_half(ours), h);
  }
}

// The nearest half by definition: no neighbour is nearer, and of two equally near ones the even one is taken.
TEST(ShmatFormat, half_floats_round_to_nearest_even) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> exponent(-26, 15.9f);
  for (int i = 0; i < 200000; ++i) {
    float x = std::exp2(exponent(random));
    if (i % 4 == 0) {  // ties
      const uint16_t h = shmat::to_half(x);
      x = 0.5f * (shmat::from_half(h) + shmat::from_half(uint16_t(h + 1)));
      if (!std::isfinite(x)) continue;
    }
    const uint16_t h = shmat::to_half(x);
    const double error = std::abs(double(shmat::from_half(h)) - x);
    for (int step : {-1, 1}) {
      if (h == 0 && step < 0) continue;
      const double other = std::abs(double(shmat::from_half(uint16_t(h + step))) - x);
      ASSERT_TRUE(error < other || (error == other && h % 2 == 0)) << x;
    }
    EXPECT_EQ(shmat::to_half(-x), h | 0x8000);
  }
  EXPECT_EQ(shmat::to_half(65519.9f), 0x7bff);
  EXPECT_EQ(shmat::to_half(65520.0f), 0x7c00);
}

TEST(ShmatFormat, checksum_is_crc_32c) {
  EXPECT_EQ(shmat::crc32c("123456789", 9), 0xe3069283u);  // the check value of the CRC catalogues
  const std::vector<unsigned char> zeros(32, 0), ones(32, 0xff);
  EXPECT_EQ(shmat::crc32c(zeros.data(), 32), 0x8a9136aau);  // RFC 3720, B.4
  EXPECT_EQ(shmat::crc32c(ones.data(), 32), 0x62a8ab43u);
  EXPECT_EQ(shmat::crc32c("6789", 4, shmat::crc32c("12345", 5)), 0xe3069283u);
}

TEST(ShMaterial, what_is_written_comes_back) {
  const std::string file = (std::filesystem::path(::testing::TempDir()) / "round_trip.shmat").string();
  for (const bool half : {false, true}) {
    for (const bool mirrored : {true, false}) {
      for (const int azimuths : {1, 5}) {
        const ShProjection p = random_projection(mirrored, azimuths);
        const std::vector<std::byte> bytes = write_shmat(p, {.half = half});
        write_atomically(file, bytes.data(), bytes.size());
        const ShMaterial m = ShMaterial::open(file);
        EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), m.bytes().begin(), m.bytes().end()));
        EXPECT_EQ(m.name(), p.name);
        EXPECT_EQ(m.source(), p.source);
        EXPECT_EQ(m.mirrored(), mirrored);
        EXPECT_EQ(m.half(), half);
        EXPECT_EQ(m.azimuths(), azimuths);
        EXPECT_EQ(m.albedo(), p.albedo);
        EXPECT_EQ(m.asymmetry(), float(p.asymmetry));
        EXPECT_EQ(m.max_bands(), 7);
        for (int table = 0; table < 2; ++table) {
          for (int r = 0; r < azimuths * 91; ++r) {
            const ShRow& row = p.rows[table][size_t(r)];
            ASSERT_EQ(m.row_bands(ShTable(table), r / 91, r % 91), row.bands);
            EXPECT_NEAR(m.row_share(ShTable(table), r / 91, r % 91), row.captured, 0.5 / 65535 + 1e-7);
            const std::vector<float> read = m.row(ShTable(table), r / 91, r % 91);
            ASSERT_EQ(read.size(), row.coefficients.size());
            // Half a unit in the last of 11 bits, or of the smallest exponent.
            for (size_t i = 0; i < read.size(); ++i)
              ASSERT_NEAR(read[i], row.coefficients[i],
                          half ? std::max(0x1p-11 * std::abs(row.coefficients[i]), 0x1p-25) : 0);
          }
        }
      }
    }
  }
}

// Issue's bars: a table of 10 bands in floats, both in halves, an anisotropic material's both in halves.
TEST(ShMaterial, ten_bands_fit_the_promised_sizes) {
  ShProjection p = random_projection(true, 1, 10);
  p.name = "rgl/a_name_of_some_length_as_files_have",
  p.source = "a_name_of_some_length_as_files_have_rgb.bsdf";
  const size_t floats = write_shmat(p, {.half = false}).size(),
               halves = write_shmat(p, {.half = true}).size();
  EXPECT_EQ(91u * 55 * 3 * 4, 60060u);
  EXPECT_LE((floats - sizeof(shmat::Header)) / 2, 61000u);
  EXPECT_LE(halves, 62000u);
  EXPECT_LE(write_shmat(random_projection(false, 90, 10), {.half = true}).size(), 20'000'000u);
}

TEST(ShMaterial, rows_are_interpolated_linearly) {
  for (const int azimuths : {1, 5}) {
    for (const bool mirrored : {true, false}) {
      const ShProjection p = random_projection(mirrored, azimuths);
      const ShMaterial m = material_of(p, false);
      std::mt19937 random(3);
      std::uniform_real_distribution<double> uniform(0, 1);
      for (int i = 0; i < 300; ++i) {
        const double degrees = 90 * uniform(random), turn = uniform(random);
        const vec3 w = direction(degrees * kDegree, 2 * 180 * kDegree * turn);
        const int bands = 1 + i % 9, count = sh_count(bands, mirrored), stride = count + 3;
        std::vector<float> out(size_t(3 * stride), 99.0f);
        const int held = m.look_up(ShTable(i % 2), w, bands, stride, out.data());

        // The definition: weights of four rows, missing coefficients zero.
        const int low = degrees < 89.5 ? int(degrees) : 90, high = std::min(low + 1, 90);
        const double t = low == 90 ? 0 : low == 89 ? 2 * (degrees - 89) : degrees - low;
        const int a = azimuths == 1 ? 0 : int(turn * azimuths), b = (a + 1) % azimuths;
        const double s = azimuths == 1 ? 0 : turn * azimuths - a;
        int most = 0;
        std::vector<double> sum(size_t(3 * count));
        const auto add = [&](int azimuth, int elevation, double weight) {
          const ShRow& row = p.rows[i % 2][size_t(azimuth * 91 + elevation)];
          if (weight > 0) most = std::max(most, std::min(row.bands, bands));
          const int stored = sh_count(row.bands, mirrored);
          for (int c = 0; c < 3; ++c)
            for (int k = 0; k < std::min(stored, count); ++k)
              sum[size_t(c * count + k)] += weight * row.coefficients[size_t(c * stored + k)];
        };
        add(a, low, (1 - s) * (1 - t)), add(a, high, (1 - s) * t), add(b, low, s * (1 - t)),
            add(b, high, s * t);
        EXPECT_EQ(held, most) << degrees;
        // Angles in float: 90 x 6e-8 relative, times differences of up to 4 between rows.
        for (int c = 0; c < 3; ++c) {
          for (int k = 0; k < count; ++k)
            ASSERT_NEAR(out[size_t(c * stride + k)], sum[size_t(c * count + k)], 1e-4)
                << degrees << " " << turn;
          for (int k = count; k < stride; ++k) EXPECT_EQ(out[size_t(c * stride + k)], 99.0f);
        }
        EXPECT_GE(m.bands(ShTable(i % 2), w), most);
      }
      std::vector<float> out(3, 1.0f);
      EXPECT_EQ(m.look_up(ShTable::brdf, vec3(1, 0, 0), 1, 1, out.data()), 0);
      EXPECT_EQ(out, std::vector<float>(3, 0.0f));
    }
  }
}

TEST(ShMaterial, shaders_read_the_same_from_the_bytes) {
  for (const bool half : {true, false}) {
    for (const bool mirrored : {true, false}) {
      for (const int azimuths : {1, 5}) {
        const ShMaterial m = material_of(random_projection(mirrored, azimuths), half);
        // Two files one after the other in the buffer: the second is read.
        std::vector<uint32_t> buffer(7 + m.bytes().size() / 4);
        std::memcpy(buffer.data() + 7, m.bytes().data(), m.bytes().size());
        gpu::words = buffer.data();
        const gpu::ShmatTable table = gpu::shmat_open(7u);
        std::mt19937 random(4);
        std::uniform_real_distribution<double> uniform(0, 1);
        for (int i = 0; i < 200; ++i) {
          const vec3 w = direction(90 * kDegree * uniform(random), 360 * kDegree * uniform(random));
          const int bands = 8, count = sh_count(bands, mirrored);
          std::vector<float> expected(size_t(3 * count));
          m.look_up(ShTable(i % 2), w, bands, count, expected.data());
          const gpu::ShmatPlace place = gpu::shmat_find(table, uint32_t(i % 2), w);
          EXPECT_EQ(gpu::shmat_bands(place), m.bands(ShTable(i % 2), w));
          for (int l = 0; l < bands; ++l) {
            for (int k = mirrored ? 0 : -l; k <= l; ++k) {
              const vec3 c = gpu::shmat_coefficient(table, place, gpu::shmat_index(table, l, k));
              // Angles of up to 90 degrees differ by 1e-7 (sh/angle.glsl) and a rounding or two (1.2e-7
              // each), in degrees 2e-5, times differences of rows up to 4, half a degree apart at the
              // horizon.
              for (int channel = 0; channel < 3; ++channel)
                ASSERT_NEAR(c[channel], expected[size_t(channel * count + sh_index(l, k, mirrored))], 1.6e-4);
            }
          }
        }
      }
    }
  }
}

TEST(ShMaterial, the_shader_text_is_glsl) {
  if (std::system("glslangValidator --version > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "glslangValidator is not installed";
  const std::string file = (std::filesystem::path(::testing::TempDir()) / "shmat_reader.comp").string();
  std::ifstream angle(test::source_dir() + "/sh/angle.glsl"),
      text(test::source_dir() + "/materials/sh_material.glsl");
  std::ofstream shader(file);
  shader << "#version 430\nlayout(local_size_x = 1) in;\n#define KERNEL\n#define OUT(type) out type\n"
         << "layout(std430, binding = 0) buffer Words { uint words[]; };\nlayout(std430, binding = 1) buffer "
            "Out { vec4 "
            "result; };\n#define SHMAT_WORD(i) words[i]\n"
         << angle.rdbuf() << text.rdbuf()
         << "void main() { ShmatTable t = shmat_open(0u); ShmatPlace p = shmat_find(t, 1u, vec3(0.6, 0.0, "
            "0.8));\n"
         << "result = vec4(shmat_coefficient(t, p, shmat_index(t, 1, 0)), float(shmat_bands(p))); }\n";
  shader.close();
  EXPECT_EQ(std::system(("glslangValidator " + file + " > /dev/null").c_str()), 0);
}

TEST(ShMaterial, an_empty_one_answers_black) {
  const ShMaterial m;
  float out[3] = {1, 1, 1};
  EXPECT_EQ(m.look_up(ShTable::brdf, vec3(0, 0, 1), 1, 1, out), 0);
  EXPECT_EQ(out[0] + out[1] + out[2], 0.0f);
  EXPECT_EQ(m.bands(ShTable::brdf, vec3(0, 0, 1)), 0);
  EXPECT_TRUE(m.bytes().empty());
}

TEST(ViewFrame, turns_w_out_into_the_xz_plane) {
  for (const double phi : {0.0, 1.0, 2.5, -3.0}) {
    const vec3 w = direction(0.7, phi), v = ViewFrame(w).to_view(w);
    EXPECT_NEAR(v.x, std::sin(0.7), 1e-6);
    EXPECT_NEAR(v.y, 0, 1e-6);
    // Azimuths are counted from that of w_out.
    const vec3 other = ViewFrame(w).to_view(direction(1.1, phi + 0.4));
    EXPECT_NEAR(std::atan2(other.y, other.x), 0.4, 1e-6);
  }
}

}  // namespace
}  // namespace zonal
