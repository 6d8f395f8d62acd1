/// Tensor files and what they must hold to be a BRDF: read back as written, and every mistake answered with
/// file, field, what was found and what was expected.

#include "materials/tensor_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>

#include "core/error.h"
#include "materials/rgl.h"
#include "tests/measured_files.h"
#include "tests/mesh_files.h"

namespace zonal {
namespace {

using namespace test;

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

TensorWriter two_fields() {
  TensorWriter writer;
  writer.add("text", "hello");
  writer.add("numbers", {2, 3}, {1, 2, 3, 4, 5, 6.5f});
  return writer;
}

TEST(TensorFile, reads_what_was_written) {
  const Folder folder;
  two_fields().write(folder.path("a.bsdf"));
  const TensorFile file(folder.path("a.bsdf"));
  ASSERT_EQ(file.fields().size(), 2u);
  EXPECT_EQ(file.bytes(file.require("text", TensorType::u8, {5})), "hello");
  const TensorField& numbers = file.require("numbers", TensorType::f32, {kAnyLength, 3});
  EXPECT_EQ(file.floats(numbers), (std::vector<float>{1, 2, 3, 4, 5, 6.5f}));
  EXPECT_EQ(numbers.offset % 8, 0u);
}

/// Byte positions in `two_fields`: magic 12, version 2, count 4; then 2 + 4 + 2 + 1 + 8 + 8 for "text".
constexpr size_t kVersion = 12, kCount = 14, kFirst = 18, kType = kFirst + 8, kOffset = kType + 1,
                 kLength = kOffset + 8;

TEST(TensorFile, every_mistake_is_answered) {
  const std::string good = two_fields().bytes();
  const auto with = [&](size_t at, auto value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + at, &value, sizeof value);
    return bytes;
  };
  const std::pair<std::string, std::string> cases[] = {
      {"", R"(x.bsdf: found "" in front, expected "tensor_file" and a zero byte)"},
      {with(0, 'T'), R"(x.bsdf: found "Tensor_file\u0000" in front, expected "tensor_file" and a zero byte)"},
      {with(kVersion, uint8_t{2}), "x.bsdf: found version 2.0 of the tensor file, expected 1.0"},
      {with(kCount, 0xffffffffu), "found 4294967295 fields announced in a file of "},
      {with(kCount, 3u), R"(field "number 3": found )"},
      {with(kFirst, uint16_t{60000}), R"(field "number 1": found the end of the file at byte )"},
      {with(kFirst + 6, uint16_t{0}), R"(field "text": found 0 dimensions, expected 1 to 8)"},
      {with(kType, uint8_t{12}), R"(field "text": found type 12, expected 1 to 11)"},
      {with(kType, uint8_t{0}), R"(field "text": found type 0, expected 1 to 11)"},
      {with(kOffset, uint64_t{20}),
       R"(field "text": found its data at byte 20, expected them behind the header)"},
      {with(kOffset, uint64_t{1} << 60),
       R"(field "text": found 5 bytes of data at byte 1152921504606846976, expected)"},
      {with(kOffset, uint64_t{good.size() - 2}), R"(field "text": found )"},
      {with(kLength, uint64_t{0}), R"(field "text": found shape [0] of u8, expected lengths of at least 1)"},
      {with(kLength, ~uint64_t{0}),
       R"(field "text": found shape [18446744073709551615] of u8, expected lengths)"},
      {good.substr(0, good.size() - 1), R"(field "numbers": found 24 bytes of data at byte )"},
      {good + std::string(8, '\0'), "found 8 bytes behind the last field, expected the end of the file"},
  };
  for (const auto& [bytes, expected] : cases) {
    const std::string error = error_of([&, &data = bytes] { TensorFile("x.bsdf", data); });
    EXPECT_NE(error.find(expected), std::string::npos) << error << "\nexpected " << expected;
    EXPECT_EQ(error.find("x.bsdf: "), 0u) << error;
  }
}

TEST(TensorFile, fields_may_not_overlap_or_repeat) {
  TensorWriter writer = two_fields();
  std::string bytes = writer.bytes();
  const TensorFile file("x.bsdf", bytes);
  const uint64_t start = file.find("text")->offset;
  // The second field's offset stands behind its name, dimensions and type.
  const size_t second = kLength + 8 + 2 + 7 + 2 + 1;
  std::memcpy(bytes.data() + second, &start, 8);
  EXPECT_NE(error_of([&] {
              TensorFile("x.bsdf", bytes);
            }).find("expected them behind the header and what lies before"),
            std::string::npos);
}

TEST(TensorFile, folders_and_missing_files_are_told) {
  const Folder folder;
  EXPECT_EQ(error_of([&] { TensorFile(folder.path("no.bsdf")); }),
            folder.path("no.bsdf") + ": there is no such file, expected a tensor file");
  EXPECT_EQ(error_of([&] { TensorFile(folder.path("")); }),
            folder.path("") + ": found no regular file, expected a tensor file");
}

TEST(TensorFile, types_and_shapes_are_told) {
  const TensorFile file("x.bsdf", two_fields().bytes());
  EXPECT_EQ(error_of([&] { file.require("numbers", TensorType::u8, {kAnyLength}); }),
            R"(x.bsdf: field "numbers": found numbers of type f32, expected u8)");
  EXPECT_EQ(error_of([&] {
              file.require("numbers", TensorType::f32, {kAnyLength, 4});
            }),
            R"(x.bsdf: field "numbers": found shape [2, 3], expected [any, 4])");
  EXPECT_EQ(error_of([&] { file.require("number", TensorType::f32, {6}); }),
            R"(x.bsdf: field "number": found none, expected f32 of shape [6] (did you mean "numbers"?))");
}

// ---- what makes a tensor file a BRDF ---------------------------------------------------------------------

constexpr RglSpec kSmall{.surface = {}, .elevations = 3, .facets = 5, .side = 4};

/// The error that a small file gives after a change.
std::string rgl_error(const std::function<void(TensorWriter&)>& change) {
  TensorWriter writer = rgl_tensors(kSmall);
  change(writer);
  return error_of([&] { RglBrdf(TensorFile("x.bsdf", writer.bytes())); });
}

TEST(RglFile, small_is_enough) {
  EXPECT_EQ(rgl_error([](TensorWriter&) {}), "no error");
}

TEST(RglFile, every_mistake_is_answered) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto vndf = [&](float value) { return std::vector<float>(3 * 5 * 5, value); };
  const std::pair<std::function<void(TensorWriter&)>, std::string> cases[] = {
      {[](TensorWriter& w) {
         w.remove("rgb"), w.add("spectra", {1, 3, 3, 4, 4}, std::vector<float>(144, 1.0f));
       },
       R"(field "rgb": found none but "spectra", expected colours: take the file of this material that ends in _rgb.bsdf)"},
      {[](TensorWriter& w) { w.remove("sigma"); },
       R"(field "sigma": found none, expected f32 of shape [any, any])"},
      {[](TensorWriter& w) {
         w.add("theta_i", {3}, {0, 1, 0.5f});
       },
       R"(field "theta_i": found 0.5 after 1, expected ascending numbers)"},
      {[](TensorWriter& w) {
         w.add("theta_i", {3}, {0, 1, 2});
       },
       R"(field "theta_i": found 2 as number 3 of 3, expected a finite number in [0, 1.5708])"},
      {[](TensorWriter& w) {
         w.add("theta_i", {4}, {0, 0.5f, 1, 1.5f});
       },
       R"(field "vndf": found shape [1, 3, 5, 5], expected [1, 4, any, any])"},
      {[](TensorWriter& w) {
         w.add("phi_i", {3}, {0, 1, 2});
       },
       "field \"phi_i\": found azimuths over 114.6 degrees"},
      {[&](TensorWriter& w) {
         w.add("vndf", {1, 3, 5, 5}, vndf(nan));
       },
       R"(field "vndf": found nan as number 1 of 75, expected a finite number in [0, 1e+10])"},
      {[&](TensorWriter& w) {
         w.add("vndf", {1, 3, 5, 5}, vndf(0));
       },
       R"(field "vndf": found zeros alone for elevation 1 of 3, expected a density)"},
      {[&](TensorWriter& w) {
         w.add("vndf", {1, 3, 75, 1}, std::vector<float>(225, 1.0f));
       },
       R"(field "vndf": found slices of one row or column)"},
      {[](TensorWriter& w) {
         w.add("rgb", {1, 3, 3, 4, 3}, std::vector<float>(108, 1.0f));
       },
       R"(field "rgb": found shape [1, 3, 3, 4, 3], expected [1, 3, 3, 4, 4])"},
      {[](TensorWriter& w) {
         w.add("luminance", {1, 3, 3, 4}, std::vector<float>(36, 1.0f));
       },
       R"(field "luminance": found shape [1, 3, 3, 4], expected [1, 3, 4, 4])"},
      {[](TensorWriter& w) {
         w.add("sigma", {2, 2}, {1, 1, 0, 1});
       },
       R"(field "sigma": found 0 as number 3 of 4, expected a finite number in [1e-06, 1e+10])"},
      {[](TensorWriter& w) {
         w.add("ndf", {1, 4}, {1, 1, 0, 1});
       },
       R"(field "ndf": found 1 x 4 numbers, expected at least 2 x 2)"},
      {[](TensorWriter& w) { w.add("jacobian", std::string_view("\2", 1)); },
       R"(field "jacobian": found 2, expected 0 or 1)"},
  };
  for (const auto& [change, expected] : cases) {
    const std::string error = rgl_error(change);
    EXPECT_NE(error.find(expected), std::string::npos) << error << "\nexpected " << expected;
    EXPECT_EQ(error.find("x.bsdf: "), 0u) << error;
  }
}

TEST(RglFile, negative_samples_are_counted_and_reflect_nothing) {
  TensorWriter writer = rgl_tensors(kSmall);
  std::vector<float> rgb(144, 0.5f);
  std::fill(rgb.begin() + 16, rgb.begin() + 32, -0.25f);  // green of the first elevation
  writer.add("rgb", {1, 3, 3, 4, 4}, rgb);
  const RglBrdf brdf(TensorFile("x.bsdf", writer.bytes()));
  EXPECT_EQ(brdf.negative_samples, 16u);
  const vec3 f = brdf.evaluate({0, 0, 1}, {0.6f, 0, 0.8f});
  EXPECT_GT(f.x, 0);
  EXPECT_EQ(f.y, 0);
}

TEST(RglFile, without_jacobian_values_are_taken_as_they_are) {
  TensorWriter writer = rgl_tensors(kSmall);
  writer.add("rgb", {1, 3, 3, 4, 4}, std::vector<float>(144, 0.5f));
  writer.add("jacobian", std::string_view("\0", 1));
  const RglBrdf brdf(TensorFile("x.bsdf", writer.bytes()));
  EXPECT_NEAR(brdf.evaluate({0, 0.6f, 0.8f}, {0.6f, 0, 0.8f}).y, 0.5f / 0.8f, 1e-5f);
}

}  // namespace
}  // namespace zonal
