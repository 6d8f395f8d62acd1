// `zonal sweep`: its files, searches, statistics and processes. Whole sweeps: sweep_run_test.cpp.

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <random>
#include <set>

#include "core/error.h"
#include "sweep/cell_store.h"
#include "sweep/picture_script.h"
#include "sweep/process.h"
#include "sweep/search.h"
#include "sweep/statistics.h"
#include "sweep/sweep_file.h"
#include "tests/sweep_support.h"

namespace zonal {
namespace {

using nlohmann::json;

/// What reading this sweep complains of.
std::string complaint(const json& sweep) {
  const Folder folder;
  try {
    read_sweep(folder.write("s.json", sweep.dump()));
  } catch (const SceneError& error) {
    return error.what();
  }
  return "nothing";
}

// ---- statistics -----------------------------------------------------------------------------------------

TEST(SweepStatistics, quantiles_are_those_of_the_tables) {
  // Two-sided 95 % points of Student's t (any statistics handbook), to their four digits.
  const std::pair<int, double> table[] = {{1, 12.706}, {2, 4.3027},  {4, 2.7764},   {5, 2.5706},
                                          {9, 2.2622}, {29, 2.0452}, {1000, 1.9623}};
  for (const auto& [degrees, quantile] : table)
    EXPECT_NEAR(student_95(degrees), quantile, 2e-4 * quantile) << degrees;
}

TEST(SweepStatistics, an_interval_holds_the_true_mean_in_95_percent_of_cases) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(3, 2);
  int held = 0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> values(5);
    for (double& v : values) v = normal(random);
    const Interval interval = student_interval(values);
    held += interval.low <= 3 && 3 <= interval.high;
  }
  // Binomial: 4 standard deviations are 4 sqrt(0.95 0.05 / 4000) = 0.0138.
  EXPECT_NEAR(double(held) / kTrials, 0.95, 0.0138);
}

TEST(SweepStatistics, median_of_odd_and_even_numbers) {
  EXPECT_EQ(median({5, 1, 3}), 3);
  EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
}

TEST(SweepStatistics, a_repeated_ratio_falls_into_the_interval_in_95_percent_of_cases) {
  // Times of two methods scatter by 2 and 5 %; the measurement is made twice.
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0, 1);
  const auto measured = [&](double time, double scatter) {
    std::vector<double> times(5);
    for (double& t : times) t = time * std::exp(scatter * normal(random));
    return times;
  };
  int held = 0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Interval first = ratio_interval(measured(3, 0.02), measured(2, 0.05));
    const double again = ratio_interval(measured(3, 0.02), measured(2, 0.05)).mean;
    held += first.low <= again && again <= first.high;
  }
  // Welch's degrees are estimated and rounded down, which errs on the wide side: from 95 % less 4 standard
  // deviations of the count (0.0138) up to 98 %.
  EXPECT_GT(double(held) / kTrials, 0.95 - 0.0138);
  EXPECT_LT(double(held) / kTrials, 0.98);
  EXPECT_NEAR(ratio_interval({2, 8}, {2, 2}).mean, 2, 1e-12);  // the geometric mean of 2 and 8 is 4
  EXPECT_DOUBLE_EQ(ratio_interval({3}, {2}).high, 1.5);
}

// ---- searches -------------------------------------------------------------------------------------------

TEST(SweepSearch, finds_the_count_of_an_affine_cost_in_six_runs) {
  for (const double fixed : {0.0, 0.02, 0.3}) {
    for (const double each : {1e-5, 1e-3}) {
      for (const double target : {0.5, 2.0}) {
        const auto time = [&](int n) { return fixed + each * n; };
        const SearchResult found = search_count(time, target, {.first = 400});
        EXPECT_TRUE(found.reached) << fixed << " " << each << " " << target << ": " << found.value;
        EXPECT_LE(found.runs.size(), 6u);
        EXPECT_NEAR(time(found.count), target, 0.05 * target);
      }
    }
  }
}

TEST(SweepSearch, finds_a_falling_error) {
  const auto error = [](int n) { return 0.01 + 1 / std::sqrt(n); };
  const SearchResult found = search_count(error, 0.05, {.first = 4, .slope = -0.5, .most_runs = 8});
  EXPECT_TRUE(found.reached);
  EXPECT_NEAR(error(found.count), 0.05, 0.0025);
}

TEST(SweepSearch, says_when_a_target_lies_between_two_counts_or_below_all) {
  const SearchResult between = search_count([](int n) { return n; }, 1.4, {.first = 8});
  EXPECT_FALSE(between.reached);
  EXPECT_EQ(between.count, 1);  // |ln(1/1.4)| < |ln(2/1.4)|
  const SearchResult below = search_count([](int n) { return 3.0 + n; }, 1, {.first = 100});
  EXPECT_FALSE(below.reached);
  EXPECT_EQ(below.count, 1);
  EXPECT_EQ(search_count([](int) { return std::nan(""); }, 1, {}).count, 0);
}

// ---- sweep files ----------------------------------------------------------------------------------------

TEST(SweepFile, the_cells_are_the_product_of_all_lists) {
  json sweep = small_sweep();
  sweep["budget"] = {{{"passes", 1}}, {{"seconds", 0.1}}};
  const Folder folder;
  const SweepPlan plan = read_sweep(folder.write("s.json", sweep.dump()));
  EXPECT_EQ(plan.methods.size(), 3u);  // path and two counts of lights
  EXPECT_EQ(plan.cells.size(), 3u * 2 * 2);
  EXPECT_EQ(plan.groups, 6);
  EXPECT_EQ(plan.methods[1].id, "vpl lights=4");
  EXPECT_EQ(plan.methods[1].parameters["lights"], 4);
  EXPECT_EQ(plan.methods[1].reference, json({{"max_bounces", 1}}));
  EXPECT_EQ(plan.methods[0].reference, json::object());
}

TEST(SweepFile, every_mistake_is_one_line_with_its_place_and_the_nearest_name) {
  const std::pair<json::json_pointer, json> kWrong[] = {
      {json::json_pointer("/scenes/0"), "nowhere.json"},
      {json::json_pointer("/scenes"), json::array()},
      {json::json_pointer("/methods/0"), "paht"},
      {json::json_pointer("/methods"), json::array()},
      {json::json_pointer("/methods/1/set/lihgts"), 3},
      {json::json_pointer("/methods/1/set/lights"), 0},
      {json::json_pointer("/metrics"), {"rsme"}},
      {json::json_pointer("/budget"), {{"passes", 2}, {"seconds", 1}}},
      {json::json_pointer("/budget"), {{"equal_time", 1}, {"search", "nothing"}}},
      {json::json_pointer("/budget"), {{"equal_error", 0.1}, {"metric", "rsme"}}},
      {json::json_pointer("/seeds"), 0},
      {json::json_pointer("/size"), "24"},
      {json::json_pointer("/backends"), {"gpu"}},
      {json::json_pointer("/backends"), {"cpu", "vulkan"}},
      {json::json_pointer("/backends"), json::array()},
      {json::json_pointer("/bugdet"), 1},
      {json::json_pointer("/methods/1/set/lights"), json::array()},
      {json::json_pointer("/materials"), json::array()},
      {json::json_pointer("/materials/whiet"), "rgl/paper_white"},
      {json::json_pointer("/budget"), json::array()},
      {json::json_pointer("/budget"), {{"passes", 2}, {"metric", "rmse"}}},
      {json::json_pointer("/reference"), {{"passes", 2}, {"seconds", 1}}},
  };
  const std::string kExpected[] = {"no such scene", "at least one scene",
                                   "\"path\"",      "at least one method",
                                   "\"lights\"",    "lights",
                                   "\"rmse\"",      "exactly one",
                                   "\"passes\" or", "\"rmse\"",
                                   "seeds",         "320x180",
                                   "cpu",           "vulkan",
                                   "at least one",  "\"budget\"",
                                   "at least one",  "at least one",
                                   "\"white\"",     "at least one",
                                   "metric",        "expected one"};
  static_assert(std::size(kWrong) == std::size(kExpected));
  size_t i = 0;
  for (const auto& [where, value] : kWrong) {
    json sweep = small_sweep();
    sweep[where] = value;
    const std::string said = complaint(sweep);
    EXPECT_NE(said.find(kExpected[i]), std::string::npos) << where << ": " << said;
    EXPECT_NE(said.find("s.json"), std::string::npos) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    ++i;
  }
}

TEST(SweepFile, lists_of_materials_make_scenes) {
  json sweep = small_sweep();
  const json red = {{"type", "lambert"}, {"albedo", {0.8, 0.1, 0.1}}}, mirror = {{"type", "conductor"}};
  sweep["materials"] = {{"white", {red, mirror}}};
  const Folder folder;
  const SweepPlan listed = read_sweep(folder.write("s.json", sweep.dump()));
  sweep["materials"] = {{{"white", red}}, {{"white", mirror}}};
  const SweepPlan objects = read_sweep(folder.write("s.json", sweep.dump()));
  ASSERT_EQ(listed.scenes.size(), 2u);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(listed.scenes[i].id, objects.scenes[i].id);
  EXPECT_EQ(listed.scenes[0].materials["white"], red);
}

TEST(SweepFile, the_published_sweeps_can_be_read) {
  int read = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(test::source_dir() + "/scenes/sweeps")) {
    const std::string file = entry.path().string(),
                      text = entry.path().extension() == ".json" ? text_of(file) : "";
    if (text.empty() || entry.path().filename() == "sweep.schema.json") continue;
    try {
      EXPECT_GT(read_sweep(file).cells.size(), 0u) << file;
    } catch (const SceneError& error) {
      // Scenes and materials that are downloaded may be absent, and no other reason is one.
      const std::string said = error.what();
      if (!std::getenv("ZONAL_DATA") && said.find("ZONAL_DATA") != said.npos) continue;
      if (!std::getenv("ZONAL_MATERIALS") && said.find("ZONAL_MATERIALS") != said.npos) continue;
      ADD_FAILURE() << said;
    }
    ++read;
  }
  EXPECT_GE(read, 2);
}

TEST(SweepFile, a_key_changes_with_everything_that_determines_the_pixels) {
  const Folder folder;
  const SweepPlan plan = read_sweep(folder.write("s.json", small_sweep().dump()));
  std::set<std::string> keys;
  for (const Cell& cell : plan.cells)
    keys.insert(cell_key(plan, cell, plan.methods[cell.method].parameters, plan.budgets[cell.budget]));
  EXPECT_EQ(keys.size(), plan.cells.size());
  SweepPlan other = plan;
  other.scenes[0].width = 25;
  EXPECT_NE(cell_key(other, other.cells[0], other.methods[0].parameters, other.budgets[0]),
            cell_key(plan, plan.cells[0], plan.methods[0].parameters, plan.budgets[0]));
}

TEST(SweepFile, a_method_means_the_same_where_the_scene_has_settings_for_it) {
  const Folder folder;
  json scene = json::parse(text_of(kScene));
  scene["integrator"] = {{"type", "vpl"}, {"clamp", 0.2}, {"lights", 7}};
  json sweep = small_sweep();
  sweep["scenes"] = {folder.write("own.json", scene.dump())};
  const SweepPlan plan = read_sweep(folder.write("s.json", sweep.dump()));
  EXPECT_EQ(method_settings(plan.scenes[0], plan.methods[1]), json({{"lights", 4}, {"clamp", 0.0}}));
  EXPECT_EQ(method_settings(plan.scenes[0], plan.methods[0]),
            json::object());  // the scene is silent about path
}

// ---- processes ------------------------------------------------------------------------------------------

TEST(SweepProcess, tells_how_a_process_ended) {
  EXPECT_TRUE(run_process({"/bin/true"}, nullptr).ok());
  const ProcessResult failed =
      run_process({"/bin/sh", "-c", "echo one >&2; echo 'the reason' >&2; exit 3"}, nullptr);
  EXPECT_EQ(failed.exit_code, 3);
  EXPECT_EQ(failed.reason(), "exit code 3: the reason");
  const ProcessResult killed = run_process({"/bin/sh", "-c", "kill -9 $$"}, nullptr);
  EXPECT_EQ(killed.signal, SIGKILL);
  const ProcessResult missing = run_process({"/nowhere/zonal"}, nullptr);
  EXPECT_EQ(missing.exit_code, 127);
  std::atomic<bool> stop = true;
  EXPECT_TRUE(run_process({"/bin/sleep", "60"}, &stop).interrupted);
}

// ---- pictures -------------------------------------------------------------------------------------------

TEST(SweepReport, shared_exponents_hold_colours_to_half_a_step) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> exponent(-12, 15), share(0, 1);
  for (int i = 0; i < 10000; ++i) {
    const float brightest = std::exp2(exponent(random));
    const vec3 color(brightest, brightest * share(random), brightest * share(random));
    const uint32_t word = pack_rgb9e5(color);
    const double scale = std::exp2(int(word >> 27) - 24);
    for (int c = 0; c < 3; ++c) {
      const double decoded = scale * (word >> 9 * c & 511);
      // The brightest mantissa is at least 255, so half a step is 1/510 of the brightest channel.
      EXPECT_NEAR(decoded, color[c], brightest / 510.0) << color.x << " " << color.y << " " << color.z;
    }
  }
  EXPECT_EQ(pack_rgb9e5({0, 0, 0}), 0u);
  EXPECT_EQ(pack_rgb9e5({-1, NAN, 0}), 0u);
  EXPECT_EQ(pack_rgb9e5({INFINITY, 0, 0}) & 511, 511u);
}

}  // namespace
}  // namespace zonal
