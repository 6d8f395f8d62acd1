// `zonal material` and the material database, from files to pictures.

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "core/error.h"
#include "core/image.h"
#include "core/scene_loader.h"
#include "materials/material_database.h"
#include "materials/measured_brdf.h"
#include "sweep/process.h"
#include "tests/gpu_shmat.h"
#include "tests/measured_files.h"
#include "tests/paths.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class MaterialCommand : public testing::Test {
 protected:
  MaterialCommand() {
    std::string name = (fs::temp_directory_path() / "zonal-material-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    fs::create_directories(folder_ + "/in/made");
  }
  ~MaterialCommand() override { fs::remove_all(folder_); }

  /// Exit code of the program; what it complained of is in `said_`.
  int run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), test::program());
    const ProcessResult result = run_process(arguments, nullptr);
    said_ = result.last_line;
    return result.signal ? -result.signal : result.exit_code;
  }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ + "/" + name) << text;
    return folder_ + "/" + name;
  }
  /// A ball of the material on a grey floor under a lamp.
  std::string scene_of(const std::string& material, const std::string& database = "db") const {
    return write(
        "scene.json",
        json{{"camera", {{"position", {0, 1, 4}}, {"look_at", {0, 0.6, 0}}, {"resolution", {16, 16}}}},
             {"material_database", database},
             {"objects",
              {{{"type", "sphere"}, {"center", {0, 0.7, 0}}, {"radius", 0.7}, {"material", material}},
               {{"type", "quad"}, {"corner", {-4, 0, -4}}, {"edges", {{0, 0, 8}, {8, 0, 0}}}}}},
             {"lights", {{{"type", "point"}, {"position", {2, 3, 2}}, {"intensity", 30}}}}}
            .dump());
  }
  void expect_complete(const std::string& folder, const DatabaseEntry& entry);

  std::string folder_, said_;
};

/// Shader and C++ see the same numbers in a file's bytes.
void expect_gpu_layout(const ShMaterial& m) {
  std::vector<uint32_t> buffer(m.bytes().size() / 4);
  std::memcpy(buffer.data(), m.bytes().data(), 4 * buffer.size());
  gpu::words = buffer.data();
  const gpu::ShmatTable table = gpu::shmat_open(0u);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(0.01f, 1);
  const int bands = 4, count = sh_count(bands, m.mirrored());
  for (int i = 0; i < 30; ++i) {
    const float z = uniform(random), s = std::sqrt(1 - z * z), phi = 6.2831853f * uniform(random);
    const vec3 w(s * std::cos(phi), s * std::sin(phi), z);
    std::vector<float> expected(3 * count);
    m.look_up(ShTable(i % 2), w, bands, count, expected.data());
    const gpu::ShmatPlace place = gpu::shmat_find(table, uint32_t(i % 2), w);
    for (int l = 0; l < bands; ++l)
      for (int k = m.mirrored() ? 0 : -l; k <= l; ++k)
        for (int c = 0; c < 3; ++c) {
          const float value = expected[c * count + sh_index(l, k, m.mirrored())];
          // Both interpolate between rows in float; elevations differ by 2e-5 degrees, and rows a degree
          // apart differ by no more than their own size.
          ASSERT_NEAR(gpu::shmat_coefficient(table, place, gpu::shmat_index(table, l, k))[c], value,
                      1e-4 * std::max(1.0f, std::fabs(value)));
        }
  }
}

/// A material goes through reader, shader, picture and both methods.
void MaterialCommand::expect_complete(const std::string& folder, const DatabaseEntry& entry) {
  SCOPED_TRACE(entry.name);
  EXPECT_EQ(entry.bands, 6);
  const ShMaterial material = ShMaterial::open(entry.sh_file);
  expect_gpu_layout(material);
  // Band 0 of F' is the directional albedo over 2 sqrt(pi); its mean over the hemisphere is what the
  // measured file tells of itself from a few thousand samples.
  const auto brdf = load_measured(entry.source);
  vec3 mean(0);
  for (int k = 0; k < 90; ++k) {
    const float theta = (k + 0.5f) * kPi / 180;
    for (int a = 0; a < 12; ++a) {
      const float phi = 2 * kPi * a / 12;
      float c[3];
      material.look_up(ShTable::brdf_cosine,
                       {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}, 1,
                       1, c);
      mean += vec3(c[0], c[1], c[2]) * (2 * std::sqrt(kPi) * std::sin(2 * theta) * kPi / 180 / 12);
    }
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], brdf->albedo[c], 0.03 * brdf->albedo[c] + 0.002) << c;

  const std::string picture = folder_ + "/show.png";
  ASSERT_EQ(run({"material", "show", entry.sh_file, "-o", picture}), 0) << said_;
  EXPECT_GT(fs::file_size(picture), 5000u);
  for (const char* method : {"path", "vpl"}) {
    const std::string image = folder_ + "/render.exr";
    ASSERT_EQ(run({"render", scene_of(entry.name, folder), "--integrator", method, "--passes", "2", "-o",
                   image, "--quiet"}),
              0)
        << said_;
    double sum = 0;
    const ImageFile rendered = read_image(image);
    for (const float v : rendered.layers.at("").pixels) {
      ASSERT_TRUE(std::isfinite(v) && v >= 0);
      sum += v;
    }
    EXPECT_GT(sum, 0);
  }
}

TEST_F(MaterialCommand, takes_every_kind_of_file_from_folder_to_picture) {
  // Anisotropic files in a folder of their own: a few azimuths are enough here.
  fs::create_directories(folder_ + "/turned");
  test::write_anisotropic_rgl(folder_ + "/turned");
  test::write_isotropic_rgl(folder_ + "/in/made", 0.3);
  ASSERT_EQ(
      run({"material", "merl", "ggx:roughness=0.5,f0=0.9", "-o", folder_ + "/in/made/ggx.binary", "--quiet"}),
      0)
      << said_;
  const std::vector<std::string> published = test::published_rgl_files();
  for (const fs::path file : published) fs::create_symlink(file, folder_ + "/in/" + file.filename().string());
  const size_t files = 3 + published.size();
  const std::string db = folder_ + "/db", turned = folder_ + "/db/turned";
  ASSERT_EQ(run({"material", "project", folder_ + "/in", "--bands", "6", "-o", db, "--quiet"}), 0) << said_;
  ASSERT_EQ(run({"material", "project", folder_ + "/turned", "--bands", "6", "--azimuths", "8", "-o", turned,
                 "--quiet"}),
            0)
      << said_;
  std::vector<std::pair<std::string, DatabaseEntry>> entries;
  for (const std::string& folder : {db, turned})
    for (const DatabaseEntry& entry : MaterialDatabase::open(folder).entries())
      entries.emplace_back(folder, entry);
  ASSERT_EQ(entries.size(), files);
  for (const auto& [folder, entry] : entries) expect_complete(folder, entry);
}

TEST_F(MaterialCommand, projecting_again_keeps_what_is_current) {
  test::write_isotropic_rgl(folder_ + "/in/made", 0.4);
  const std::string db = folder_ + "/db";
  ASSERT_EQ(
      run({"material", "project", folder_ + "/in", "--bands", "3", "--nodes", "500", "-o", db, "--quiet"}), 0)
      << said_;
  const std::string file = MaterialDatabase::open(db).entries().at(0).sh_file;
  const auto written = fs::last_write_time(file);
  ASSERT_EQ(
      run({"material", "project", folder_ + "/in", "--bands", "3", "--nodes", "500", "-o", db, "--quiet"}),
      0);
  EXPECT_EQ(fs::last_write_time(file), written);
  ASSERT_EQ(
      run({"material", "project", folder_ + "/in", "--bands", "4", "--nodes", "500", "-o", db, "--quiet"}),
      0);
  EXPECT_EQ(MaterialDatabase::open(db).entries().at(0).bands, 4);
}

TEST_F(MaterialCommand, one_broken_file_does_not_keep_the_others_out) {
  test::write_isotropic_rgl(folder_ + "/in/made", 0.4);
  write("in/broken.bsdf", "tensor_file");
  EXPECT_EQ(run({"material", "project", folder_ + "/in", "--bands", "2", "--nodes", "500", "-o",
                 folder_ + "/db", "--quiet"}),
            2);
  EXPECT_NE(said_.find("broken.bsdf"), std::string::npos) << said_;
  EXPECT_EQ(MaterialDatabase::open(folder_ + "/db").entries().size(), 1u);
}

TEST_F(MaterialCommand, a_folder_of_broken_files_alone_is_answered_file_by_file) {
  write("in/broken.bsdf", "tensor_file");
  EXPECT_EQ(run({"material", "project", folder_ + "/in", "-o", folder_ + "/db"}), 2);
  EXPECT_NE(said_.find("broken.bsdf"), std::string::npos) << said_;
  EXPECT_EQ(said_.find("index.json"), std::string::npos) << said_;
}

TEST_F(MaterialCommand, mistakes_are_told_in_one_line) {
  fs::create_directories(folder_ + "/empty");
  EXPECT_EQ(run({"material", "project", folder_ + "/empty"}), 2);
  EXPECT_NE(said_.find(".bsdf"), std::string::npos) << said_;
  EXPECT_EQ(run({"material", "project", folder_ + "/nowhere.bsdf"}), 2);
  EXPECT_EQ(run({"material", "show", write("x.shmat", "no projection")}), 2);
  EXPECT_NE(said_.find("x.shmat"), std::string::npos) << said_;
  EXPECT_EQ(run({"material", "bands", folder_ + "/x.shmat"}), 2);
  EXPECT_EQ(run({"list", "materials", "--database", folder_ + "/empty"}), 2);

  const std::string file = test::write_isotropic_rgl(folder_ + "/in/made", 0.4);
  ASSERT_EQ(run({"material", "project", folder_ + "/in", "--bands", "2", "--nodes", "500", "-o",
                 folder_ + "/db", "--quiet"}),
            0)
      << said_;
  EXPECT_EQ(run({"material", "project", file, "--bands", "101"}), 2);
  EXPECT_EQ(run({"material", "project", file, "-o", folder_ + "/x.png"}), 2);
  EXPECT_NE(said_.find(".shmat"), std::string::npos) << said_;
  const std::string name = MaterialDatabase::open(folder_ + "/db").names().at(0);
  EXPECT_EQ(run({"render", scene_of(name.substr(0, name.size() - 1)), "--passes", "1", "-o", "none"}), 2);
  EXPECT_NE(said_.find(name), std::string::npos) << said_;  // the nearest name
  fs::remove(file);
  EXPECT_EQ(run({"render", scene_of(name), "--passes", "1", "-o", "none"}), 2);
  EXPECT_NE(said_.find("gone"), std::string::npos) << said_;
}

TEST_F(MaterialCommand, a_scenes_material_can_be_replaced_from_the_command_line) {
  test::write_isotropic_rgl(folder_ + "/in/made", 0.4);
  ASSERT_EQ(run({"material", "project", folder_ + "/in", "--bands", "2", "--nodes", "500", "-o",
                 folder_ + "/db", "--quiet"}),
            0)
      << said_;
  json scene = {
      {"camera", {{"position", {0, 0, 4}}, {"look_at", {0, 0, 0}}, {"resolution", {8, 8}}}},
      {"material_database", "db"},
      {"materials", {{{"name", "ball"}, {"type", "lambert"}}}},
      {"objects", {{{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", 1}, {"material", "ball"}}}},
      {"lights", {{{"type", "point"}, {"position", {2, 3, 4}}, {"intensity", 30}}}}};
  const std::string file = write("scene.json", scene.dump()),
                    entry = MaterialDatabase::open(folder_ + "/db").names().at(0);
  const Scene replaced = load_scene(file, {.materials = {{"ball", entry}}});
  EXPECT_STREQ(replaced.materials().at(0)->type(), "measured");
  EXPECT_EQ(run({"render", file, "--material", "ball=" + entry, "--passes", "1", "-o", "none", "--quiet"}), 0)
      << said_;
  EXPECT_EQ(run({"render", file, "--material", "bal=" + entry, "--passes", "1", "-o", "none"}), 2);
  EXPECT_NE(said_.find("\"ball\""), std::string::npos) << said_;

  // A table of two bands, which do not hold what the lobe needs.
  EXPECT_EQ(run({"render", file, "--material", "ball=" + entry, "--integrator", "hvl", "--set", "bands=3",
                 "--set", "emission_bands=2", "--passes", "1", "-o", "none"}),
            2);
  EXPECT_NE(said_.find("bands: found 3, expected 1 to 2"), std::string::npos) << said_;
}

TEST_F(MaterialCommand, bands_of_a_wide_lobe_are_few_and_grow_with_the_share) {
  const std::string file = test::write_isotropic_rgl(folder_ + "/in/made", 0.8), csv = folder_ + "/bands.csv";
  ASSERT_EQ(run({"material", "bands", file, "--csv", csv}), 0) << said_;
  std::ifstream in(csv);
  std::string line;
  std::getline(in, line);
  int rows = 0, before = 0;
  while (std::getline(in, line)) {
    ++rows;
    if (line.find(",spherical,0,") == std::string::npos) continue;
    const int bands = std::atoi(line.substr(line.rfind(',') + 1).c_str());
    EXPECT_GE(bands, before) << line;
    before = bands;
  }
  EXPECT_EQ(rows, 9 * 7 * 2);
  // A GGX of width 0.8 times the cosine is close to a clamped cosine, whose first 3 bands hold 98 %.
  EXPECT_GE(before, 2);
  EXPECT_LE(before, 6);
}

}  // namespace
}  // namespace zonal
