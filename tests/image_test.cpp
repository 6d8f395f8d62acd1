// Pictures survive the disk bit for bit, and a failure leaves nothing behind.
#include "core/image.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/error.h"
#include "core/sampling.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;

class ImageFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("zonal_image_" + std::to_string(getpid()));
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  std::string path(const std::string& name) const { return (folder / name).string(); }
  size_t files() const { return std::distance(fs::directory_iterator(folder), fs::directory_iterator()); }
  std::string bytes(const std::string& name) const {
    std::ifstream in(folder / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  fs::path folder;
};

/// Any 32-bit pattern that is a number or an infinity: large, tiny and negative ones.
Image hashed(int width, int height, int channels, uint32_t seed) {
  Image image(width, height, channels);
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    uint32_t bits = hash32(uint32_t(i), seed);
    if ((bits & 0x7f800000u) == 0x7f800000u) bits &= 0xff800000u;
    std::memcpy(&image.pixels[i], &bits, 4);
  }
  return image;
}

/// What SceneError says, or "" when nothing was thrown.
template <class Function>
std::string complaint(Function f) {
  try {
    f();
  } catch (const SceneError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "";
}

TEST_F(ImageFiles, exr_keeps_every_bit_of_layers_and_metadata) {
  ImageFile out;
  const std::map<std::string, int> layers = {
      {"", 3},  {"albedo", 3},   {"normal", 3},          {"depth", 1},  {"A", 3},
      {"B", 3}, {"variance", 3}, {"glossy.indirect", 3}, {"weight", 1}, {"tinted", 4}};
  uint32_t seed = 1;
  for (const auto& [name, channels] : layers) out.layers[name] = hashed(37, 19, channels, seed++);
  out.layers[""].at(3, 4)[1] = std::numeric_limits<float>::quiet_NaN();
  out.metadata = {
      {"integrator", "path"}, {"parameters", R"({"a": "b\n", "long": [1, 2]})"}, {"exposure", "0.25"}};
  write_image(path("a.exr"), out, 2);
  EXPECT_EQ(files(), 1u);

  const ImageFile in = read_image(path("a.exr"));
  EXPECT_FALSE(in.display_referred);
  EXPECT_EQ(in.metadata, out.metadata);  // "exposure" given by the caller wins over the argument
  ASSERT_EQ(in.layers.size(), out.layers.size());
  for (const auto& [name, image] : out.layers) {
    const Image& read = in.layers.at(name);
    ASSERT_EQ(read.channels, image.channels) << name;
    ASSERT_EQ(read.pixels.size(), image.pixels.size()) << name;
    EXPECT_EQ(std::memcmp(read.pixels.data(), image.pixels.data(), 4 * image.pixels.size()), 0) << name;
  }
}

TEST_F(ImageFiles, exr_without_a_radiance_is_refused_and_one_channel_is_grey) {
  ImageFile out;
  EXPECT_NE(complaint([&] { write_image(path("a.exr"), out, 1); }).find("no pixels"), std::string::npos);
  out.layers[""] = hashed(5, 4, 1, 9);
  write_image(path("a.exr"), out, 0.1f);
  const ImageFile in = read_image(path("a.exr"));
  EXPECT_EQ(in.layers.at("").channels, 1);
  EXPECT_EQ(in.layers.at("").pixels, out.layers.at("").pixels);
  EXPECT_EQ(in.metadata.at("exposure"), "0.1");
}

TEST_F(ImageFiles, layers_of_another_size_are_refused) {
  ImageFile out;
  out.layers[""] = Image(4, 4);
  out.layers["depth"] = Image(4, 5, 1);
  const std::string line = complaint([&] { write_image(path("a.exr"), out, 1); });
  EXPECT_NE(line.find("4x5"), std::string::npos) << line;
  EXPECT_EQ(files(), 0u);
}

TEST_F(ImageFiles, png_holds_exposed_srgb_bytes) {
  // sRGB of 0.5 is 0.735357 (IEC 61966-2-1), of 0.002 it is 12.92 * 0.002 = 0.02584; times 255 and rounded.
  ImageFile out;
  out.layers[""] = Image(4, 1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> values = {0.25f, 0.001f, 0, 0.5f, 7, kInfinity, -3, nan, 0.1f, 0.5f, 0.25f, 0};
  out.layers[""].pixels = values;
  out.metadata["integrator"] = "path";
  write_image(path("a.png"), out, 2);
  const ImageFile in = read_image(path("a.png"));
  EXPECT_TRUE(in.display_referred);
  EXPECT_EQ(in.metadata.at("integrator"), "path");
  EXPECT_EQ(in.metadata.at("exposure"), "2");
  // 0.2 -> 1.055 * 0.2^(1/2.4) - 0.055 = 0.484529
  const std::vector<int> expected = {188, 7, 0, 255, 255, 255, 0, 0, 124, 255, 188, 0};
  ASSERT_EQ(in.layers.at("").pixels.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(std::lround(in.layers.at("").pixels[i] * 255), expected[i]) << "value " << values[i];
  }
}

TEST_F(ImageFiles, display_referred_pixels_are_not_encoded_twice) {
  ImageFile out;
  out.display_referred = true;
  out.layers[""] = Image(256, 1);
  for (int i = 0; i < 256; ++i) std::fill_n(out.layers[""].at(i, 0), 3, i / 255.0f);
  write_image(path("a.png"), out, 3);
  const ImageFile in = read_image(path("a.png"));
  for (int i = 0; i < 256; ++i) ASSERT_EQ(std::lround(in.layers.at("").at(i, 0)[1] * 255), i);
}

TEST(Srgb, decode_inverts_encode) {
  // Slope of the decoder is at most 2.4: two float roundings of values up to 1 give 2.4 * 2 * 2^-24 plus
  // pow's own.
  for (int i = 0; i <= 1000; ++i) EXPECT_NEAR(srgb_decode(srgb_encode(i * 1e-3f)), i * 1e-3f, 1.1e-7f);
}

TEST_F(ImageFiles, what_cannot_be_read_is_named_in_one_line) {
  EXPECT_NE(complaint([&] { read_image(path("none.exr")); }).find("none.exr: no such file"),
            std::string::npos);
  EXPECT_NE(complaint([&] { read_image(folder.string()); }).find("folder"), std::string::npos);
  std::ofstream(folder / "empty.png");
  EXPECT_NE(complaint([&] { read_image(path("empty.png")); }).find("empty.png"), std::string::npos);
  std::ofstream(folder / "text.exr") << "hello";
  EXPECT_NE(complaint([&] { read_image(path("text.exr")); }).find("text.exr"), std::string::npos);
  ImageFile out;
  out.layers[""] = hashed(64, 64, 3, 5);
  for (const char* name : {"cut.exr", "cut.png"}) {
    write_image(path(name), out, 1);
    fs::resize_file(folder / name, fs::file_size(folder / name) / 2);
    EXPECT_NE(complaint([&] { read_image(path(name)); }).find(name), std::string::npos);
  }
}

TEST_F(ImageFiles, impossible_targets_are_refused_before_and_when_writing) {
  ImageFile out;
  out.layers[""] = Image(2, 2);
  fs::create_directory(folder / "folder.exr");
  std::ofstream(folder / "plain") << "x";
  for (const char* name : {"a.jpg", "a", "none/a.exr", "folder.exr", "plain/a.exr"}) {
    EXPECT_NE(complaint([&] { check_writable(path(name)); }).find(name), std::string::npos);
    EXPECT_NE(complaint([&] { write_image(path(name), out, 1); }).find(name), std::string::npos);
  }
  EXPECT_NE(complaint([&] { check_writable(""); }), "");
  EXPECT_EQ(complaint([&] { check_writable(path("a.EXR")); }), "");
  EXPECT_EQ(files(), 2u);
}

TEST_F(ImageFiles, a_folder_without_permission_is_refused) {
  if (geteuid() == 0) GTEST_SKIP() << "the administrator may write everywhere";
  fs::permissions(folder, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_NE(complaint([&] { check_writable(path("a.exr")); }).find("ermission"), std::string::npos);
  fs::permissions(folder, fs::perms::owner_all);
}

TEST_F(ImageFiles, a_full_disk_leaves_the_old_file_and_nothing_else) {
  ImageFile small, large;
  small.layers[""] = hashed(4, 4, 3, 1);
  large.layers[""] = hashed(256, 256, 3, 2);
  write_image(path("a.exr"), small, 1);
  const std::string before = bytes("a.exr");

  // A limit on the size of files stands in for the full disk: write() fails in the middle of the file.
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit;
  getrlimit(RLIMIT_FSIZE, &old_limit);
  const rlimit limit{65536, old_limit.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limit);
  const std::string line = complaint([&] { write_image(path("a.exr"), large, 1); });
  const std::string text_line = complaint([&] { write_text(path("b.json"), std::string(100000, 'x')); });
  setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);

  EXPECT_NE(line.find("a.exr: cannot be written"), std::string::npos) << line;
  EXPECT_NE(text_line.find("b.json: cannot be written"), std::string::npos) << text_line;
  EXPECT_EQ(files(), 1u);
  EXPECT_EQ(bytes("a.exr"), before);
}

TEST_F(ImageFiles, writing_through_a_symbolic_link_keeps_the_link) {
  write_text(path("real.txt"), "old");
  fs::create_symlink("real.txt", folder / "link.txt");
  write_text(path("link.txt"), "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(bytes("real.txt"), "new");
}

TEST_F(ImageFiles, check_writable_leaves_nothing) {
  check_writable(path("a.exr"));
  check_writable_text(path("a.json"));
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace zonal
