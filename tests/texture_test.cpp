/// Textures against values worked out by hand and OpenImageIO's own writer.

#include "core/texture.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"

using namespace zonal;

namespace {

/// A folder of this process's own, gone at the end.
class TextureTest : public testing::Test {
 protected:
  std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) /
                                  ("zonal_texture_" + std::to_string(reinterpret_cast<uintptr_t>(this)) +
                                   "_" + testing::UnitTest::GetInstance()->current_test_info()->name());
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  template <class T>
  std::string write(const std::string& name, int width, int height, int channels, OIIO::TypeDesc type,
                    const std::vector<T>& pixels) {
    const std::string file = (folder_ / name).string();
    auto out = OIIO::ImageOutput::create(file);
    OIIO::ImageSpec spec(width, height, channels, type);
    spec["oiio:UnassociatedAlpha"] = 1;
    EXPECT_TRUE(out && out->open(file, spec) && out->write_image(type, pixels.data()) && out->close());
    return file;
  }
};

/// The sRGB curve in double, from IEC 61966-2-1.
double srgb(int byte) {
  const double x = byte / 255.0;
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

/// A table in float, four products and three sums: a few roundings of values up to 1.
constexpr float kRounding = 4e-7f;

}  // namespace

TEST_F(TextureTest, the_first_row_of_a_picture_is_at_the_top_of_v) {
  const std::string file = write<uint8_t>("rows.png", 1, 2, 3, OIIO::TypeDesc::UINT8, {255, 0, 0, 0, 0, 255});
  const Texture t = Texture::load(file, Texture::Encoding::srgb);
  EXPECT_EQ(t.rgb({0.5f, 0.75f}), vec3(1, 0, 0));  // centre of the upper row
  EXPECT_EQ(t.rgb({0.5f, 0.25f}), vec3(0, 0, 1));
}

TEST_F(TextureTest, bytes_are_decoded_as_asked) {
  const std::string file =
      write<uint8_t>("bytes.png", 2, 1, 3, OIIO::TypeDesc::UINT8, {10, 128, 200, 0, 1, 255});
  const Texture encoded = Texture::load(file, Texture::Encoding::srgb);
  const Texture plain = Texture::load(file, Texture::Encoding::linear);
  const int left[3] = {10, 128, 200};
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(encoded.sample({0.25f, 0.5f})[c], srgb(left[c]), kRounding) << "channel " << c;
    EXPECT_NEAR(plain.sample({0.25f, 0.5f})[c], left[c] / 255.0, kRounding) << "channel " << c;
  }
  EXPECT_EQ(encoded.sample({0.25f, 0.5f}).w, 1);
  EXPECT_FALSE(encoded.has_alpha());
}

TEST_F(TextureTest, lookups_blend_four_texels_in_linear_light_and_repeat) {
  // 5 x 3 texels, so that the last square of the layout is padded on both sides.
  std::vector<uint8_t> bytes;
  for (int i = 0; i < 5 * 3 * 3; ++i) bytes.push_back(uint8_t(i * 37 % 256));
  const std::string file = write("blend.png", 5, 3, 3, OIIO::TypeDesc::UINT8, bytes);
  const Texture t = Texture::load(file, Texture::Encoding::srgb);
  const auto texel = [&](int x, int y, int c) {
    return srgb(bytes[((y + 3) % 3 * 5 + (x + 5) % 5) * 3 + c]);
  };
  for (const vec2 uv :
       {vec2(0.31f, 0.62f), vec2(0.0f, 0.0f), vec2(0.99f, 0.01f), vec2(-2.31f, 7.4f), vec2(3.95f, -0.9f)}) {
    const double x = (uv.x - std::floor(uv.x)) * 5.0 - 0.5, y = (1.0 - (uv.y - std::floor(uv.y))) * 3.0 - 0.5;
    const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
    const double fx = x - x0, fy = y - y0;
    for (int c = 0; c < 3; ++c) {
      const double expected = (1 - fy) * ((1 - fx) * texel(x0, y0, c) + fx * texel(x0 + 1, y0, c)) +
                              fy * ((1 - fx) * texel(x0, y0 + 1, c) + fx * texel(x0 + 1, y0 + 1, c));
      // Neighbours differ by up to 1 and a float's uv of size 8 is known to 5e-7, times 5 texels.
      EXPECT_NEAR(t.sample(uv)[c], expected, 3e-6) << "uv " << uv.x << " " << uv.y << " channel " << c;
    }
  }
}

TEST_F(TextureTest, grey_fills_all_channels_and_alpha_is_neither_encoded_nor_multiplied_in) {
  const std::string file = write<uint8_t>("grey.png", 2, 1, 2, OIIO::TypeDesc::UINT8, {200, 64, 100, 255});
  const Texture t = Texture::load(file, Texture::Encoding::srgb);
  const vec4 left = t.sample({0.25f, 0.5f});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(left[c], srgb(200), kRounding);
  EXPECT_NEAR(left.w, 64 / 255.0, kRounding);
  EXPECT_TRUE(t.has_alpha());
  // The nearest texel, not a blend: just left of the border it is still the left one.
  EXPECT_NEAR(t.alpha({0.49f, 0.5f}), 64 / 255.0, kRounding);
  EXPECT_EQ(t.alpha({0.51f, 0.5f}), 1);
}

TEST_F(TextureTest, sixteen_bits_are_decoded_and_floats_are_left_alone) {
  const std::string deep =
      write<uint16_t>("deep.png", 1, 1, 3, OIIO::TypeDesc::UINT16, {0, 32896, 65535});  // 128 x 257
  EXPECT_NEAR(Texture::load(deep, Texture::Encoding::srgb).rgb({0, 0}).y, srgb(128), 2e-6);
  const std::string hdr = write<float>("hdr.exr", 1, 1, 3, OIIO::TypeDesc::FLOAT, {12.5f, 0.25f, 0});
  EXPECT_EQ(Texture::load(hdr, Texture::Encoding::srgb).rgb({0, 0}), vec3(12.5f, 0.25f, 0));
}

TEST_F(TextureTest, a_picture_in_memory_reads_like_its_file) {
  const std::string file =
      write<uint8_t>("memory.png", 1, 2, 4, OIIO::TypeDesc::UINT8, {1, 2, 3, 4, 250, 251, 252, 253});
  std::ifstream in(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  const Texture a = Texture::load(file, Texture::Encoding::srgb);
  const Texture b = Texture::decode(std::as_bytes(std::span(bytes)), "memory", Texture::Encoding::srgb);
  for (const float v : {0.1f, 0.4f, 0.8f}) EXPECT_EQ(a.sample({0, v}), b.sample({0, v}));
}

TEST(Texture, coordinates_that_are_no_numbers_give_some_texel) {
  const Texture t(2, 1, {vec4(1), vec4(3)});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float bad : {nan, kInfinity, -kInfinity, 1e30f, -1e-30f}) {
    const vec4 value = t.sample({bad, bad});
    EXPECT_GE(value.x, 1);
    EXPECT_LE(value.x, 3);
    EXPECT_EQ(t.alpha({bad, bad}), t.alpha({bad, bad}));
  }
}

TEST(Texture, the_mean_is_that_of_decoded_texels) {
  const Texture t(2, 2, {vec4(1), vec4(2), vec4(3), vec4(6)});
  EXPECT_EQ(t.mean(), vec4(3));
}

TEST_F(TextureTest, what_is_wrong_with_a_file_is_said_in_one_line) {
  const auto message = [](auto&& load) -> std::string {
    try {
      load();
    } catch (const SceneError& e) {
      return e.what();
    }
    return "no error";
  };
  const std::string missing = (folder_ / "missing.png").string(), broken = (folder_ / "broken.png").string();
  const std::string text = (folder_ / "text.txt").string();
  const std::string whole =
      write("whole.png", 64, 64, 3, OIIO::TypeDesc::UINT8, std::vector<uint8_t>(64 * 64 * 3, 7));
  std::filesystem::copy_file(whole, broken);
  std::filesystem::resize_file(broken, std::filesystem::file_size(whole) / 2);
  std::ofstream(text) << "no picture";
  for (const std::string& file : {missing, broken, text}) {
    const std::string found = message([&] { Texture::load(file, Texture::Encoding::srgb); });
    EXPECT_EQ(found.find(file), 0u) << found;
    EXPECT_EQ(found.find('\n'), std::string::npos) << found;
  }
  const char noise[] = "no picture either";
  const std::string found =
      message([&] { Texture::decode(std::as_bytes(std::span(noise)), "embedded", Texture::Encoding::srgb); });
  EXPECT_EQ(found.find("embedded: "), 0u) << found;
}
