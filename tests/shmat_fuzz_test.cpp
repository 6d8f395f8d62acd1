// Damaged .shmat files: each is refused in one line that names the file, the field, what was found and what
// was expected, or is as good as whole. Runs under sanitizers like all tests.

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <random>

#include "core/atomic_file.h"
#include "core/error.h"
#include "materials/sh_material.h"
#include "materials/sh_projector.h"
#include "materials/shmat_format.h"

namespace zonal {
namespace {

using Bytes = std::vector<std::byte>;

/// Rows of 1 to 4 bands with made-up coefficients.
Bytes whole_file(bool half, bool mirrored, int azimuths) {
  ShProjection p;
  p.name = "fuzz/material", p.source = "material.bsdf";
  p.mirrored = mirrored, p.azimuths = azimuths, p.albedo = vec3(0.5f);
  for (auto& table : p.rows) {
    for (int r = 0; r < azimuths * ShMaterial::kElevations; ++r) {
      const int bands = 1 + r % 4;
      table.push_back(
          {bands, std::vector<float>(3 * size_t(sh_count(bands, mirrored)), 0.01f * float(r % 7)), 1, 0.95});
    }
  }
  return write_shmat(p, {.half = half});
}

shmat::Header header_of(const Bytes& bytes) {
  shmat::Header h;
  std::memcpy(&h, bytes.data(), sizeof h);
  return h;
}
void set_header(Bytes& bytes, const shmat::Header& h) {
  std::memcpy(bytes.data(), &h, sizeof h);
}
void sign(Bytes& bytes) {
  shmat::Header h = header_of(bytes);
  h.checksum = shmat::file_checksum(bytes.data(), bytes.size());
  set_header(bytes, h);
}

/// The error of reading these bytes; "" when they are accepted, after using everything there is.
std::string reading(const Bytes& bytes) {
  try {
    const ShMaterial m = ShMaterial::from_bytes(bytes, "bad.shmat");
    float out[3 * 36] = {};
    for (int i = 0; i < 40; ++i) {
      const float t = 0.04f * float(i), p = 0.3f * float(i);
      const vec3 w(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t));
      for (const ShTable table : {ShTable::brdf, ShTable::brdf_cosine}) {
        EXPECT_LE(m.look_up(table, w, 6, 36, out), 6);
        for (int k = 0; k < 3 * 36; ++k) EXPECT_TRUE(std::isfinite(out[k]));
      }
    }
    for (int e = 0; e < ShMaterial::kElevations; ++e)
      for (int a = 0; a < m.azimuths(); a += 7) m.row(ShTable::brdf_cosine, a, e);
    return "";
  } catch (const SceneError& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.find("bad.shmat: "), 0u) << line;
    EXPECT_NE(line.find("found"), std::string::npos) << line;
    EXPECT_NE(line.find("expected"), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    return line;
  }
}

void expect_error(const Bytes& bytes, const std::string& field, const std::string& part = "") {
  const std::string line = reading(bytes);
  EXPECT_NE(line.find(field), std::string::npos) << field << ": " << line;
  EXPECT_NE(line.find(part), std::string::npos) << part << ": " << line;
}

TEST(ShmatFuzz, truncated_files_are_refused_at_every_length) {
  const Bytes whole = whole_file(true, true, 1);
  ASSERT_EQ(reading(whole), "");
  for (size_t size = 0; size < whole.size(); size += size < 200 ? 1 : 97) {
    const Bytes cut(whole.begin(), whole.begin() + std::ptrdiff_t(size));
    expect_error(cut, size < sizeof(shmat::Header) ? "size" : "file_bytes");
    if (size < sizeof(shmat::Header)) continue;
    // Also where the header agrees with the size it has.
    Bytes consistent = cut;
    shmat::Header h = header_of(consistent);
    h.file_bytes = size;
    set_header(consistent, h);
    sign(consistent);
    EXPECT_NE(reading(consistent), "") << size;
  }
  Bytes longer = whole;
  longer.resize(whole.size() + 4);
  expect_error(longer, "file_bytes", "appended");
}

TEST(ShmatFuzz, every_flipped_bit_is_noticed) {
  const Bytes whole = whole_file(true, false, 1);
  std::mt19937 random(1);
  for (int i = 0; i < 6000; ++i) {
    Bytes bytes = whole;
    // All bits of the header, then bits anywhere.
    const size_t bit = i < 640 ? size_t(i) : random() % (8 * bytes.size());
    bytes[bit / 8] ^= std::byte(1 << bit % 8);
    EXPECT_NE(reading(bytes), "") << "bit " << bit;
  }
}

TEST(ShmatFuzz, fields_are_named) {
  const Bytes whole = whole_file(true, true, 2);
  const auto with = [&](const std::function<void(shmat::Header&)>& change) {
    Bytes bytes = whole;
    shmat::Header h = header_of(bytes);
    change(h);
    set_header(bytes, h);
    sign(bytes);
    return bytes;
  };
  expect_error(with([](auto& h) { h.magic[0] = 'X'; }), "magic");
  expect_error(with([](auto& h) { h.version = 2; }), "version",
               "found 2, expected 1: the file was written by a later");
  expect_error(with([](auto& h) { h.version = 0; }), "version", "found 0");
  expect_error(with([](auto& h) { h.file_bytes += 4; }), "file_bytes", "cut");
  expect_error(with([](auto& h) { h.flags = 4; }), "flags", "0x4");
  expect_error(with([](auto& h) { h.elevations = 90; }), "elevations", "found 90, expected 91");
  expect_error(with([](auto& h) { h.azimuths = 0; }), "azimuths", "1 to 360");
  expect_error(with([](auto& h) { h.azimuths = 0xffffffff; }), "azimuths");
  expect_error(with([](auto& h) { h.azimuths = 3; }), "offset");
  expect_error(with([](auto& h) { h.name_bytes = 65535; }), "name_bytes");
  expect_error(with([](auto& h) { h.source_bytes = 4000; }), "rows_offset");
  expect_error(with([](auto& h) { h.text_offset = 0; }), "text_offset");
  expect_error(with([](auto& h) { h.rows_offset = 0xfffffffc; }), "rows_offset");
  expect_error(with([](auto& h) { h.shares_offset += 4; }), "shares_offset");
  expect_error(with([](auto& h) { h.data_offset = 80; }), "data_offset");
  expect_error(with([](auto& h) { h.data_words -= 1; }), "data_words");
  expect_error(with([](auto& h) { h.data_words = 0x40000001; }), "data_words");
  expect_error(with([](auto& h) { h.max_bands = 3; }), "max_bands", "found 3, expected 4");
  expect_error(with([](auto& h) { h.albedo[1] = std::numeric_limits<float>::quiet_NaN(); }), "albedo");
  expect_error(with([](auto& h) { h.asymmetry = -1; }), "asymmetry");

  Bytes unsigned_bytes = whole;
  unsigned_bytes.back() ^= std::byte(1);
  expect_error(unsigned_bytes, "checksum", "damaged");

  const shmat::Header h = header_of(whole);
  const auto with_row = [&](uint32_t word) {
    Bytes bytes = whole;
    std::memcpy(bytes.data() + h.rows_offset + 4 * 17, &word, 4);
    sign(bytes);
    return bytes;
  };
  expect_error(with_row(shmat::row_word(0, 0)), "row 17: bands", "found 0, expected 1 to 100");
  expect_error(with_row(shmat::row_word(101, 0)), "row 17: bands");
  expect_error(with_row(shmat::row_word(100, 0)), "row 17: offset");
  expect_error(with_row(shmat::row_word(4, h.data_words)), "row 17: offset");
  expect_error(with_row(0xffffff01u), "row 17: offset");
  EXPECT_EQ(reading(with_row(shmat::row_word(2, 0))), "");  // rows may share coefficients
}

TEST(ShmatFuzz, coefficients_that_are_no_numbers_are_refused) {
  for (const bool half : {true, false}) {
    const Bytes whole = whole_file(half, true, 1);
    const shmat::Header h = header_of(whole);
    for (const uint32_t word :
         half ? std::initializer_list<uint32_t>{0x7c00u, 0xfc000000u, 0x7e000000u, 0x7fffu}
              : std::initializer_list<uint32_t>{0x7f800000u, 0xffc00000u, 0x7f800001u, 0x7f000000u}) {
      Bytes bytes = whole;
      std::memcpy(bytes.data() + h.data_offset + 4 * (h.data_words / 2), &word, 4);
      sign(bytes);
      expect_error(bytes, "coefficients", "infinity");
    }
  }
  ShProjection p;
  for (auto& table : p.rows)
    table.assign(91, {1, {0.1f, 0.2f, std::numeric_limits<float>::infinity()}, 1, 1});
  EXPECT_THROW(write_shmat(p, {.half = false}), SceneError);
  for (auto& table : p.rows) table.assign(91, {1, {0.1f, 0.2f, 7e4f}, 1, 1});
  EXPECT_THROW(write_shmat(p, {.half = true}), SceneError);
  EXPECT_EQ(reading(write_shmat(p, {.half = false})), "");
}

// Random damage with a right checksum: only the checks behind it stand between the header and memory.
TEST(ShmatFuzz, random_headers_with_a_right_checksum_are_safe) {
  std::mt19937 random(2);
  int accepted = 0;
  for (int i = 0; i < 4000; ++i) {
    Bytes bytes = whole_file(i % 2, i % 3 == 0, 1);
    for (int changes = 1 + int(random() % 3); changes > 0; --changes) {
      const size_t at =
          random() % 3 == 0 ? random() % bytes.size() : random() % (sizeof(shmat::Header) + 400);
      bytes[at] = random() % 2 ? std::byte(random()) : std::byte(random() % 2 ? 0xff : 0);
    }
    sign(bytes);
    accepted += reading(bytes).empty();
  }
  EXPECT_GT(accepted, 10);  // changes of text, shares and coefficients are none of the format's business
}

TEST(ShmatFuzz, files_that_are_none_are_refused) {
  const std::string folder = ::testing::TempDir();
  const auto error_of = [](const std::string& file) -> std::string {
    try {
      ShMaterial::open(file);
      return "";
    } catch (const SceneError& error) {
      return error.what();
    }
  };
  EXPECT_NE(error_of(folder + "/absent.shmat").find("absent.shmat: file: found No such file"),
            std::string::npos);
  EXPECT_NE(error_of(folder).find("no regular file"), std::string::npos);
  const std::string empty = folder + "/empty.shmat";
  write_atomically(empty, "", 0);
  EXPECT_NE(error_of(empty).find("size: found 0 bytes"), std::string::npos);
  const std::string text = folder + "/text.shmat";
  const std::string words(500, 'x');
  write_atomically(text, words.data(), words.size());
  EXPECT_NE(error_of(text).find("magic"), std::string::npos);
}

}  // namespace
}  // namespace zonal
