// zonal verify: golden files pass, a wrong digit does not, a file that is no golden file is refused in a
// line.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/verify.h"
#include "apps/verify_tolerances.h"
#include "core/error.h"
#include "sh/clamped_cosine.h"
#include "sh/sphere_light.h"
#include "tests/paths.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kGolden = test::source_dir() + "/tests/golden/";
const std::vector<std::string> kKinds = {"sh_basis", "sh_gradient", "zh_sphere", "polygon_sh",
                                         "rotation", "products",    "ggx_zh",    "yuksel"};

json read(const std::string& kind) {
  return json::parse(std::ifstream(kGolden + kind + ".json"));
}

std::string contents(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class VerifyFile : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("zonal_verify_" + std::to_string(getpid()));
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  std::string write(const std::string& text) const {
    std::ofstream(folder / "golden.json") << text;
    return (folder / "golden.json").string();
  }
  Verdict verify(const json& file) const { return verify_file(write(file.dump())); }

  void expect_refused(const std::string& text, const std::string& words) const {
    try {
      verify_file(write(text));
      ADD_FAILURE() << "accepted: " << text.substr(0, 200);
    } catch (const SceneError& error) {
      const std::string line = error.what();
      EXPECT_NE(line.find(words), std::string::npos) << "\"" << words << "\" missing in: " << line;
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
  }

  fs::path folder;
};

class EveryKind : public VerifyFile, public testing::WithParamInterface<std::string> {};

TEST_P(EveryKind, passes_in_float_and_double) {
  const Verdict verdict = verify_file(kGolden + GetParam() + ".json");
  EXPECT_TRUE(verdict.passed()) << details(verdict);
  EXPECT_EQ(verdict.kind, GetParam());
  EXPECT_GT(verdict.cases, 0u);
  // Whatever the table has a row for is compared, in both precisions; only the double path has truth for a
  // unit vector.
  size_t rows = 0;
  for (const Tolerance& row : tolerances()) rows += row.kind == GetParam();
  EXPECT_EQ(verdict.in_float.size(), rows) << details(verdict);
  EXPECT_EQ(verdict.in_double.size(), rows - (GetParam() == "sh_basis")) << details(verdict);
}

/// The first number of an array that is larger than a thousandth, wherever it lies.
json* some_number(json& value) {
  if (value.is_number() && std::abs(value.get<double>()) > 1e-3) return &value;
  if (value.is_array())
    for (json& element : value)
      if (json* found = some_number(element)) return found;
  return nullptr;
}

TEST_P(EveryKind, one_wrong_digit_is_found_and_its_case_is_named) {
  const json whole = read(GetParam());
  for (const char* key :
       {"Y", "grad", "zh", "dzh_dd", "coeffs", "grad_x", "grad_x_coeffs", "rotated", "product_full",
        "product_truncated", "ndf", "ndf_cos", "reflect_normal_incidence"}) {
    if (!whole["cases"].back().contains(key)) continue;
    json file = whole;
    json* number = some_number(file["cases"].back()[key]);
    if (!number) continue;
    *number = number->get<double>() * (1 + 1e-7);
    const Verdict verdict = verify(file);
    EXPECT_FALSE(verdict.passed()) << GetParam() << " " << key;
    const std::string line = one_line(verdict);
    EXPECT_NE(line.find("FAIL"), std::string::npos) << line;
    EXPECT_NE(line.find(" " + std::to_string(whole["cases"].size() - 1) + " "), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

INSTANTIATE_TEST_SUITE_P(Golden, EveryKind, testing::ValuesIn(kKinds),
                         [](const auto& info) { return info.param; });

TEST_F(VerifyFile, the_order_of_keys_notes_and_missing_optional_keys_do_not_matter) {
  json file = read("sh_basis");
  file["note"] = {{"anything", {1, "two", nullptr}}};
  file.erase("file"), file.erase("bands");
  for (json& c : file["cases"]) c.erase("tag"), c.erase("high");
  EXPECT_TRUE(verify(file).passed());

  json products = read("products");
  products.erase("cases");
  EXPECT_TRUE(verify(products).passed());
  json spheres = read("zh_sphere");
  spheres.erase("cases");
  EXPECT_TRUE(verify(spheres).passed());
}

// Y of an axis does not depend on its length, the gradient is its inverse: both ends of what a float can
// hold, and doubles that no float can.
TEST_F(VerifyFile, vectors_of_extreme_length) {
  const double a = std::sqrt(3 / (4 * 3.14159265358979323846)),
               b = std::sqrt(1 / (4 * 3.14159265358979323846));
  for (const double length : {1e-30, 1e30, 1e-300, 1e300}) {
    const json basis = {{"cases", {{{"d", {0, 0, length}}, {"Y", {b, 0, a, 0}}}}}};
    EXPECT_TRUE(verify(basis).passed()) << one_line(verify(basis));
    const json row = {0, 0, 0};
    const json gradient = {
        {"cases", {{{"d", {0, 0, length}}, {"grad", {row, {0, -a / length, 0}, row, {-a / length, 0, 0}}}}}}};
    EXPECT_TRUE(verify(gradient).passed()) << one_line(verify(gradient));
  }
}

TEST_F(VerifyFile, what_is_no_golden_file_is_refused) {
  expect_refused("", "expected");
  expect_refused("{", "expected");
  expect_refused("[]", "expected an object");
  expect_refused("{}", "found no golden vectors");
  expect_refused(R"({"cases": []})", "found no golden vectors");
  expect_refused(R"({"cases": [{"Y": []}]})", "/cases/0/d: missing");
  expect_refused(R"({"cases": [{"d": [0, 0, 1], "Y": []}]})", "/cases/0/Y: found an empty array");
  expect_refused(R"({"cases": [{"d": [0, 0, 1], "Y": [1, 2]}]})", "bands^2");
  expect_refused(R"({"cases": [{"d": [0, 0, 1], "Y": [null]}]})", "/cases/0/Y/0: found null");
  expect_refused(R"({"cases": [{"d": [0, 0, 1], "Y": [1e999]}]})", "number");
  expect_refused(R"({"cases": [{"d": [0, 0, 0], "Y": [1]}]})", "zero vector");
  expect_refused(R"({"cases": [{"d": [0, 1], "Y": [1]}]})", "3 numbers");
  expect_refused(R"({"cases": [{"d": [0, 0, 1], "Y": [1], "tag": 3}]})", "a string");
  expect_refused(R"({"cases": [{"d": [0, 0, 1], "Y": [1], "high": [[101, 0, 1]]}]})", "0 <= l <= 100");
  expect_refused(R"({"cases": [{"d": [0, 0, 1], "grad": [1]}]})", "3 numbers");
  expect_refused(R"({"cases": [{"r": -1, "d": 1, "zh": [1]}]})", "> 0");
  expect_refused(R"({"sh_cases": [{"kind": "cube", "x": [0,0,0], "y": [0,0,1], "r": 1, "coeffs": [1]}]})",
                 "cube");
  expect_refused(R"({"cases": [{"quat_wxyz": [0,0,0,0], "coeffs": [1], "rotated": [1]}]})",
                 "zero quaternion");
  expect_refused(R"({"cases": [{"alpha": 0, "ndf": [1]}]})", "> 0");
  expect_refused(R"({"cases": [{"alpha": 2, "ndf": [1]}]})", "[1e-6, 1]");
  expect_refused(R"({"cases": [{"x": [0,0,0], "vertices": [[0,0,1],[1,0,1]], "coeffs": [1]}]})", "vertices");
  expect_refused(R"({"triple_entries": [[0, 0, -1, 0.28]]})", "triple_entries");
  expect_refused(R"({"clamped_cosine": [[0, 0, 1, 0.28]]})", "clamped_cosine");
  EXPECT_THROW(verify_file((folder / "nowhere.json").string()), SceneError);
  EXPECT_THROW(verify_file(folder.string()), SceneError);
}

// The first program of docs/spherical_harmonics.md; irradiance of a ball overhead is pi (r/d)^2 (Eq. 3.10
// with a cosine). Five bands of light and of the product leave out what couples through bands 6, 8, ...:
// 2.4 % here.
TEST(SphericalHarmonicsPage, the_first_program_gives_what_it_says) {
  float light[sh::count(5)], weighted[sh::count(5)];
  sh::sphere_light(5, glm::vec3(0), glm::vec3(0, 0, 2), 0.5f, light);
  sh::clamped_cosine_product(5, light, weighted);
  const float irradiance = 2 * std::sqrt(3.14159265f) * weighted[0];
  EXPECT_NEAR(irradiance, 3.14159265f * 0.0625f, 0.005f);
  const std::string page = contents(test::source_dir() + "/docs/spherical_harmonics.md");
  for (const char* line :
       {"float light[sh::count(5)], weighted[sh::count(5)];",
        "sh::sphere_light(5, glm::vec3(0), glm::vec3(0, 0, 2), 0.5f, light);",
        "sh::clamped_cosine_product(5, light, weighted);", "2 * std::sqrt(3.14159265f) * weighted[0];"})
    EXPECT_NE(page.find(line), std::string::npos) << line;
}

TEST(VerifyDocumentation, prints_the_table_of_tolerances) {
  const std::string page = contents(test::source_dir() + "/docs/verify.md");
  EXPECT_NE(page.find(tolerance_table()), std::string::npos)
      << "docs/verify.md differs from zonal verify --tolerances:\n"
      << tolerance_table();
}

TEST_F(VerifyFile, exit_codes_are_0_past_1_and_unreadable_2) {
  const auto run = [&](const std::string& files) {
    const int status = std::system(
        (test::program() + " verify " + files + " > " + (folder / "out").string() + " 2>&1").c_str());
    return WEXITSTATUS(status);
  };
  const auto lines = [&] {
    const std::string text = contents((folder / "out").string());
    return std::count(text.begin(), text.end(), '\n');
  };
  const std::string good = kGolden + "yuksel.json ";
  EXPECT_EQ(run(good + good), 0);
  EXPECT_EQ(lines(), 2) << "one line a file";
  json wrong = read("yuksel");
  wrong["cases"][3]["attenuation"] = 1;
  EXPECT_EQ(run(good + write(wrong.dump())), 1);
  EXPECT_EQ(run(good + write("{}") + " " + good), 2);
  EXPECT_EQ(lines(), 3) << "a bad file does not keep the others from being checked";
  EXPECT_EQ(run(""), 2);
}

}  // namespace
}  // namespace zonal
