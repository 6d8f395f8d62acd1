// `zonal compare` and `zonal reference` as scripts see them: keys, values, exposure, exit codes, caching.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/flip_hdr.h"
#include "core/image.h"
#include "core/metrics.h"
#include "core/reference.h"
#include "core/sampling.h"
#include "tests/paths.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const std::vector<std::string> kLinear = {"rmse",  "mae",  "relmse",    "relmse_trimmed",
                                          "smape", "bias", "fireflies", "nan"};
const std::vector<std::string> kDisplay = {"rmse", "mae", "psnr", "ssim", "flip"};

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> names;
  for (const auto& [name, value] : object.items()) names.push_back(name);
  return names;
}

Image noise(int width, int height, uint32_t seed) {
  Image image(width, height);
  for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = unit_float(hash32(uint32_t(i), seed));
  return image;
}

class Compare : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("zonal_compare_" + std::to_string(getpid()));
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  std::string path(const std::string& name) const { return (folder / name).string(); }
  void write(const std::string& name, const Image& radiance, float exposure = 1,
             std::map<std::string, Image> layers = {}) const {
    ImageFile file;
    file.layers = std::move(layers);
    file.layers[""] = radiance;
    write_image(path(name), file, exposure);
  }
  /// Runs the program in the folder; stdout and stderr together.
  std::string zonal(const std::string& arguments, int expected_exit = 0) const {
    const std::string command =
        "cd " + folder.string() + " && " + test::program() + " " + arguments + " 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    std::string out;
    std::array<char, 4096> buffer;
    while (const size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) out.append(buffer.data(), n);
    EXPECT_EQ(WEXITSTATUS(pclose(pipe)), expected_exit) << arguments << "\n" << out;
    return out;
  }
  fs::path folder;
};

TEST_F(Compare, json_has_exactly_the_promised_keys_in_order) {
  write("x.exr", noise(16, 16, 1));
  write("r.exr", noise(16, 16, 2));
  const Json json = Json::parse(zonal("compare x.exr r.exr --json"));
  EXPECT_EQ(keys(json), (std::vector<std::string>{"linear", "display"}));
  EXPECT_EQ(keys(json["linear"]), kLinear);
  EXPECT_EQ(keys(json["display"]), kDisplay);
  for (const auto& [name, value] : json["linear"].items()) EXPECT_TRUE(value.is_number()) << name;
  const LinearMetrics expected = linear_metrics(noise(16, 16, 1), noise(16, 16, 2));
  EXPECT_EQ(json["linear"]["rmse"], expected.rmse);
  EXPECT_EQ(json["linear"]["bias"], expected.bias);
  EXPECT_EQ(json["linear"]["nan"], 0);
}

TEST_F(Compare, flip_of_radiance_is_added_when_asked_for_and_drawn) {
  const Image x = noise(16, 16, 1), r = noise(16, 16, 2);
  write("x.exr", x);
  write("r.exr", r);
  const Json json = Json::parse(zonal("compare x.exr r.exr --json --flip-hdr --flip-map flip.png"));
  EXPECT_EQ(json["linear"]["flip_hdr"], mean_of_map(FlipHdr(r).map(x)));
  EXPECT_EQ(json["display"]["flip"], mean_of_map(flip_map(to_display(x, 1), to_display(r, 1))));
  const ImageFile map = read_image(path("flip.png"));
  EXPECT_EQ(map.layers.at("").height, 16);
  EXPECT_GT(std::stof(map.metadata.at("error_map_high")), 0);
}

TEST_F(Compare, identical_pictures_have_an_infinite_psnr_and_small_ones_no_ssim) {
  write("x.exr", noise(10, 30, 1));
  const Json json = Json::parse(zonal("compare x.exr x.exr --json"));
  EXPECT_EQ(json["linear"]["rmse"], 0);
  EXPECT_EQ(json["display"]["psnr"], "inf");
  EXPECT_TRUE(json["display"]["ssim"].is_null());
  EXPECT_EQ(json["display"]["flip"], 0);
}

TEST_F(Compare, png_pairs_have_display_metrics_only) {
  write("x.png", noise(16, 16, 1));
  write("r.png", noise(16, 16, 2));
  const Json json = Json::parse(zonal("compare x.png r.png --json"));
  EXPECT_EQ(keys(json), (std::vector<std::string>{"display"}));
  const DisplayMetrics expected =
      display_metrics(read_image(path("x.png")).layers.at(""), read_image(path("r.png")).layers.at(""));
  EXPECT_EQ(json["display"]["rmse"], expected.rmse);
  EXPECT_EQ(json["display"]["ssim"], expected.ssim);
}

TEST_F(Compare, exposure_comes_from_the_metadata_unless_given) {
  const Image x = noise(16, 16, 1), r = noise(16, 16, 2);
  write("x.exr", x, 0.5f);
  write("r.exr", r, 0.25f);
  const auto rmse_at = [&](float exposure) {
    return display_metrics(to_display(x, exposure), to_display(r, exposure)).rmse;
  };
  EXPECT_EQ(Json::parse(zonal("compare x.exr r.exr --json"))["display"]["rmse"], rmse_at(0.25f));
  EXPECT_EQ(Json::parse(zonal("compare x.exr r.exr --json --exposure 3"))["display"]["rmse"], rmse_at(3));
  zonal("compare x.exr r.exr --exposure -1", 2);
}

TEST_F(Compare, nan_pixels_are_counted) {
  Image x = noise(32, 32, 1);  // large enough to have windows without them
  x.pixels[100] = x.pixels[400] = std::numeric_limits<float>::quiet_NaN();
  write("x.exr", x);
  write("r.exr", noise(32, 32, 2));
  const Json json = Json::parse(zonal("compare x.exr r.exr --json"));
  EXPECT_EQ(json["linear"]["nan"], 2);
  for (const char* name : {"rmse", "psnr", "ssim"}) EXPECT_TRUE(json["display"][name].is_number()) << name;
}

TEST_F(Compare, a_reference_of_two_halves_adds_what_only_it_can_tell) {
  const Image a = noise(16, 16, 3), b = noise(16, 16, 4), x = noise(16, 16, 1);
  write("x.exr", x);
  write("r.exr", noise(16, 16, 2), 1, {{"A", a}, {"B", b}});
  const Json json = Json::parse(zonal("compare x.exr r.exr --json"));
  EXPECT_EQ(keys(json["linear"]), kLinear);
  const LinearMetrics expected = linear_metrics(x, noise(16, 16, 2), &a, &b);
  EXPECT_EQ(json["reference"]["rmse_unbiased"], std::sqrt(*expected.mse_unbiased));
  EXPECT_EQ(json["reference"]["reference_floor"], *expected.reference_floor);
  EXPECT_EQ(json["reference"]["reference_limited"], expected.reference_limited());
}

TEST_F(Compare, error_map_is_a_png_with_its_scale_in_the_metadata) {
  write("x.exr", noise(64, 32, 1));
  write("r.exr", noise(64, 32, 2));
  EXPECT_NE(zonal("compare x.exr r.exr --error-map map.png").find("map.png"), std::string::npos);
  const ImageFile map = read_image(path("map.png"));
  EXPECT_EQ(map.metadata.at("error_map_low"), "0");
  EXPECT_GT(std::stod(map.metadata.at("error_map_high")), 0);
  EXPECT_EQ(map.layers.at("").height, 32);
}

TEST_F(Compare, bad_input_is_one_line_and_exit_code_2) {
  write("x.exr", noise(16, 16, 1));
  write("small.exr", noise(8, 4, 1));
  for (const char* arguments :
       {"compare x.exr", "compare x.exr none.exr", "compare x.exr small.exr", "compare x.exr x.exr --jason",
        "compare x.exr x.exr --error-map no/map.png", "list ligths"}) {
    const std::string out = zonal(arguments, 2);
    EXPECT_EQ(out.rfind("zonal: ", 0), 0u) << out;
    EXPECT_EQ(std::count(out.begin(), out.end(), '\n'), 1) << out;
  }
  EXPECT_NE(zonal("compare x.exr small.exr", 2).find("8x4"), std::string::npos);
  EXPECT_NE(zonal("compare x.exr x.exr --jason", 2).find("--json"), std::string::npos);
  EXPECT_NE(zonal("list ligths", 2).find("\"lights\""), std::string::npos);
}

// ---- cached references
// ----------------------------------------------------------------------------------------------

constexpr const char* kScene = R"({
  "camera": {"position": [0, 1, 4], "look_at": [0, 0.5, 0], "vertical_fov": 40, "resolution": [24, 16], "exposure": 2},
  "materials": [{"name": "grey", "type": "lambert", "albedo": 0.5}],
  "objects": [{"name": "ball", "type": "sphere", "center": [0, 0.5, 0], "radius": 0.5, "material": "grey"}],
  "lights": [{"type": "quad", "corner": [-1, 3, -1], "edges": [[2, 0, 0], [0, 0, 2]], "radiance": 5}]})";

TEST_F(Compare, a_reference_is_the_mean_of_two_independent_halves_and_is_made_once) {
  std::ofstream(folder / "ball.json") << kScene;
  zonal("reference ball.json --passes 8 -o r.exr --quiet");
  const ImageFile r = read_image(path("r.exr"));
  const Image &mean = r.layers.at(""), &a = r.layers.at("A"), &b = r.layers.at("B");
  double difference = 0;
  for (size_t i = 0; i < mean.pixels.size(); ++i) {
    ASSERT_EQ(mean.pixels[i], 0.5f * (a.pixels[i] + b.pixels[i]));
    difference += std::abs(a.pixels[i] - b.pixels[i]);
  }
  EXPECT_GT(difference, 0) << "the halves share their random numbers";
  for (const char* name : {"variance", "albedo", "normal", "depth"})
    EXPECT_TRUE(r.layers.count(name)) << name;
  EXPECT_EQ(std::stof(r.metadata.at("exposure")), 2);

  const Json record = Json::parse(std::ifstream(folder / "r.json"));
  EXPECT_EQ(record["passes"], Json({4, 4}));
  EXPECT_EQ(record["resolution"], Json({24, 16}));
  EXPECT_NE(record["seeds"][0], record["seeds"][1]);

  // The half is what `render` makes of its seed.
  zonal("render ball.json --integrator path --passes 4 --seed " + record["seeds"][0].dump() +
        " -o a.exr --quiet");
  EXPECT_EQ(read_image(path("a.exr")).layers.at("").pixels, a.pixels);

  const auto written = fs::last_write_time(folder / "r.exr");
  EXPECT_NE(zonal("reference ball.json --passes 8 -o r.exr").find("up to date"), std::string::npos);
  EXPECT_EQ(fs::last_write_time(folder / "r.exr"), written);
}

TEST_F(Compare, a_reference_is_made_anew_when_anything_it_depends_on_changes) {
  std::ofstream(folder / "ball.json") << kScene;
  const std::string command = "reference ball.json --passes 2 -o r.exr ";
  const auto up_to_date = [&](const std::string& rest) {
    return zonal(command + rest).find("up to date") != std::string::npos;
  };
  EXPECT_FALSE(up_to_date(""));
  EXPECT_TRUE(up_to_date(""));
  EXPECT_TRUE(up_to_date("--threads 1")) << "threads do not change a bit";
  EXPECT_FALSE(up_to_date("--set max_bounces=2"));
  EXPECT_FALSE(up_to_date("--seed 5"));
  EXPECT_FALSE(up_to_date("--size 20x10"));
  EXPECT_TRUE(up_to_date("--size 20x10"));
  std::ofstream(folder / "ball.json", std::ios::app) << "\n";
  EXPECT_FALSE(up_to_date("--size 20x10"));
  fs::resize_file(folder / "r.exr", 300);
  EXPECT_FALSE(up_to_date("--size 20x10")) << "a damaged reference is made again";
  fs::remove(folder / "r.json");
  EXPECT_FALSE(up_to_date("--size 20x10"));
}

TEST_F(Compare, reference_keys_see_into_the_files_a_scene_names) {
  std::ofstream(folder / "scene.json") << R"({"objects": [{"type": "mesh", "file": "a.obj"}]})";
  std::ofstream(folder / "a.obj") << "v 0 0 0\n";
  const ReferenceRequest request{.scene_file = path("scene.json"), .passes = 2};
  const std::string before = reference_key(request);
  EXPECT_EQ(reference_key(request), before);
  std::ofstream(folder / "a.obj") << "v 0 0 1\n";
  EXPECT_NE(reference_key(request), before);
}

TEST_F(Compare, half_seeds_are_distinct_and_hold_in_a_json_number) {
  std::vector<uint64_t> seeds;
  for (uint64_t seed = 0; seed < 1000; ++seed) {
    for (const int half : {0, 1}) seeds.push_back(half_seed(seed, half));
  }
  for (const uint64_t seed : seeds) ASSERT_LT(seed, uint64_t{1} << 53);
  std::sort(seeds.begin(), seeds.end());
  // 2000 of 2^48 values: a collision by chance has probability 2000^2 / 2^49 = 7e-9.
  EXPECT_EQ(std::unique(seeds.begin(), seeds.end()), seeds.end());
  EXPECT_GT(seeds.front(), 1000u) << "typed seeds are small";
}

}  // namespace
}  // namespace zonal
