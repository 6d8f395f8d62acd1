// MERL files: written and read back, rendered, and refused when damaged. One full-size file serves all tests.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <memory>

#include "core/error.h"
#include "core/json_fields.h"
#include "tests/bsdf_quadrature.h"
#include "tests/merl_support.h"
#include "tests/support.h"

namespace zonal {
namespace {

using namespace test;
namespace fs = std::filesystem;

constexpr uintmax_t kFileSize = 12 + 3 * 90 * 90 * 180 * 8;

class MerlFiles : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<TemporaryFolder>();
    write_merl(file(), merl_function(ggx(0.4f)));
  }
  static void TearDownTestSuite() { folder.reset(); }
  static std::string file() { return *folder / "ggx.binary"; }

  /// Overwrites `size` bytes at `at` while it lives.
  class Patch {
   public:
    Patch(uintmax_t at, const void* bytes, size_t size) : at_(at), before_(size, '\0') {
      std::ifstream in(file(), std::ios::binary);
      in.seekg(std::streamoff(at)).read(before_.data(), std::streamsize(size));
      put(static_cast<const char*>(bytes));
    }
    ~Patch() { put(before_.data()); }
    Patch(const Patch&) = delete;

   private:
    uintmax_t at_;
    std::string before_;
    void put(const char* bytes) {
      std::fstream out(file(), std::ios::binary | std::ios::in | std::ios::out);
      out.seekp(std::streamoff(at_)).write(bytes, std::streamsize(before_.size()));
    }
  };

  static void expect_refused(const std::string& name, const std::vector<std::string>& words) {
    try {
      load_measured(name);
      ADD_FAILURE() << name << " was read; expected " << words[0];
    } catch (const SceneError& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.rfind(name + ": ", 0), 0u) << text;
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      for (const std::string& word : words)
        EXPECT_NE(text.find(word), std::string::npos) << word << ": " << text;
    }
  }

  static std::unique_ptr<TemporaryFolder> folder;
};
std::unique_ptr<TemporaryFolder> MerlFiles::folder;

TEST_F(MerlFiles, are_planes_of_doubles_scaled_as_the_database_scales_them) {
  ASSERT_EQ(fs::file_size(file()), kFileSize);
  std::ifstream in(file(), std::ios::binary);
  int32_t dims[3];
  in.read(reinterpret_cast<char*>(dims), sizeof dims);
  EXPECT_EQ(dims[0], 90);
  EXPECT_EQ(dims[1], 90);
  EXPECT_EQ(dims[2], 180);
  // Byte positions by hand: cell (30, 20, 50) of red, green and blue.
  const double scale[3] = {1 / 1500.0, 1.15 / 1500, 1.66 / 1500};
  const auto brdf = load_measured(file());
  EXPECT_STREQ(brdf->format(), "MERL");
  EXPECT_EQ(brdf->file, file());
  const MerlDirections w = merl_directions(30.5, 20.5, 50.5);
  const vec3 exact = evaluate(ggx(0.4f), prepare(ggx(0.4f), vec3(w.out)), vec3(w.in));
  const vec3 found = brdf->evaluate(vec3(w.out), vec3(w.in));
  for (int c = 0; c < 3; ++c) {
    double stored;
    in.seekg(12 + 8 * (c * 1458000 + 50 + 180 * (20 + 90 * 30)));
    in.read(reinterpret_cast<char*>(&stored), sizeof stored);
    EXPECT_NEAR(stored * scale[c] / exact[c], 1, 1e-5);
    EXPECT_NEAR(found[c] / exact[c], 1, 1e-4);
  }
}

TEST_F(MerlFiles, of_the_wrong_size_are_refused) {
  const std::string cut = *folder / "cut.binary";
  fs::copy_file(file(), cut);
  fs::resize_file(cut, kFileSize - 1);
  expect_refused(cut, {"size", "34992011", "34992012", "truncated"});
  fs::resize_file(cut, kFileSize + 1);
  expect_refused(cut, {"size", "34992013", "34992012", "too long"});
  for (uintmax_t size : {0, 7, 11}) {
    fs::resize_file(cut, size);
    expect_refused(cut, {"dimensions", std::to_string(size), "34992012"});
  }
  fs::resize_file(cut, 12);
  expect_refused(cut, {"dimensions", "0 x 0 x 0"});  // what the file was lengthened with
  fs::remove(cut);
}

TEST_F(MerlFiles, of_other_dimensions_are_refused_before_their_size_matters) {
  const int32_t dims[3] = {90, 90, 360};
  const Patch patch(0, dims, sizeof dims);
  expect_refused(file(), {"dimensions", "90 x 90 x 360", "90 x 90 x 180"});
}

TEST_F(MerlFiles, with_samples_that_are_no_reflectance_are_refused_by_name) {
  // Byte position of green's sample (2, 3, 4).
  const uintmax_t at = 12 + 8 * (1458000 + 4 + 180 * (3 + 90 * 2));
  for (double wrong : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300}) {
    const Patch patch(at, &wrong, sizeof wrong);
    expect_refused(file(), {"sample green, theta_h 2, theta_d 3, phi_d 4", "expected a finite number"});
  }
}

TEST_F(MerlFiles, with_flipped_bits_are_refused_or_read_as_numbers) {
  Random random(15);
  int refused = 0;
  for (int i = 0; i < 12; ++i) {
    // Every other one in the header, where it must be noticed.
    const uintmax_t at =
        i % 2 ? uintmax_t(random.unit() * 12) : 12 + uintmax_t(random.unit() * double(kFileSize - 12));
    std::ifstream in(file(), std::ios::binary);
    char byte = char(in.seekg(std::streamoff(at)).get());
    byte = char(byte ^ (1 << int(random.unit() * 8)));
    const Patch patch(at, &byte, 1);
    try {
      const auto brdf = load_measured(file());
      EXPECT_EQ(i % 2, 0) << "byte " << at << " of the header changed";
      EXPECT_TRUE(is_finite(brdf->albedo));
      for (vec3 w : views()) EXPECT_TRUE(is_finite(brdf->evaluate(w, views()[1])));
    } catch (const SceneError&) {
      ++refused;
    }
  }
  EXPECT_GE(refused, 6);
}

TEST_F(MerlFiles, that_are_none_are_refused) {
  expect_refused(*folder / "absent.binary", {"cannot be opened"});
  EXPECT_THROW(load_measured(*folder / ""), SceneError);  // a folder
  std::ofstream(*folder / "text.binary") << "this is not a measured material at all";
  expect_refused(*folder / "text.binary", {"dimensions", "expected 90 x 90 x 180"});
}

TEST_F(MerlFiles, cannot_be_written_from_what_is_no_reflectance) {
  const std::string out = *folder / "wrong.binary";
  for (double wrong : {std::nan(""), -1e-3, HUGE_VAL}) {
    EXPECT_THROW(write_merl(out, constant(glm::dvec3(0.5, wrong, 0.5))), SceneError);
    EXPECT_FALSE(fs::exists(out));
  }
  EXPECT_THROW(write_merl(*folder / "no/such/folder.binary", constant(glm::dvec3(0.1))), SceneError);
}

TEST_F(MerlFiles, rendered_by_path_under_a_white_sky_show_their_albedo) {
  // A plane seen from 60 degrees by a camera of half a degree: every pixel is what it reflects of radiance 1.
  const Scene scene = scene_from(R"({
    "camera": {"position": [8.660254, 5, 0], "look_at": [0, 0, 0], "vertical_fov": 0.5, "resolution": [16, 16]},
    "materials": [{"name": "metal", "type": "measured", "file": )" +
                                 nlohmann::json(file()).dump() + R"(}],
    "objects": [{"name": "plane", "type": "quad", "corner": [-9, 0, 9], "edges": [[18, 0, 0], [0, 0, -18]],
                 "material": "metal"}],
    "lights": [{"type": "environment", "radiance": 1}]})");
  RenderSpec spec;
  spec.passes = 64;
  const Image image = render_with(scene, "path", spec);
  const auto brdf = load_measured(file());
  glm::dvec3 exact(0);
  SphericalGrid(direction(60, 0), 0.16).integrate([&](vec3 v, double weight) {
    exact += glm::dvec3(brdf->evaluate(direction(60, 0), v)) * double(v.z) * weight;
  });
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) values.push_back(image.rgb(x, y)[c]);
    }
    const Estimate found = estimate(values);
    // The quadrature of a function with kinks is good to 1e-3; the rest is noise.
    EXPECT_NEAR(found.mean, exact[c], 5 * found.standard_error + 1e-3 * exact[c]) << "channel " << c;
    EXPECT_LT(found.standard_error, 0.01 * exact[c]);
  }
}

}  // namespace
}  // namespace zonal
