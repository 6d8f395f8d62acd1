// Choosing one of many lights: the stated probability is the real one, from no light to a million.
#include <gtest/gtest.h>

#include <chrono>

#include "tests/light_support.h"

namespace zonal {
namespace {

using namespace test;

struct Lamps {
  std::vector<std::unique_ptr<Light>> owned;
  LightSelector selector;

  void add(std::unique_ptr<Light> light) { owned.push_back(std::move(light)); }
  void finish() {
    std::vector<const Light*> lights;
    for (const auto& light : owned) lights.push_back(light.get());
    selector = LightSelector(lights);
  }
};

std::unique_ptr<PointLight> lamp(vec3 position, float intensity) {
  auto light = std::make_unique<PointLight>();
  light->position = position, light->intensity = vec3(intensity);
  return light;
}

Lamps lamps(int count) {
  Lamps result;
  for (int i = 0; i < count; ++i)
    result.add(lamp({float(i % 100), 1 + 0.1f * float(i % 7), float(i / 100)}, 1 + float(i % 13)));
  result.finish();
  return result;
}

Lamps every_kind() {
  Lamps result;
  result.add(lamp({1, 2, 0}, 3));
  auto spot = std::make_unique<SpotLight>();
  spot->position = {0, 3, 0}, spot->intensity = vec3(9);
  result.add(std::move(spot));
  auto sun = std::make_unique<DirectionalLight>();
  sun->set_scene_bounds({{0, 0, 0}, 5});
  result.add(std::move(sun));
  result.add(std::make_unique<SphereLight>(ball({-1, 2, 1}, 0.3f)));
  result.add(std::make_unique<MeshLight>(quad({0, 3, 0}, {1, 0, 0}, {0, 0, 1})));
  auto sky = std::make_unique<EnvironmentLight>(1, 1, std::vector<vec3>{vec3(0.2f)}, 0.0f);
  sky->set_scene_bounds({{0, 0, 0}, 5});
  result.add(std::move(sky));
  result.add(lamp({0, 1, 0}, 0));
  result.finish();
  return result;
}

void expect_frequencies_match(const Lamps& lamps, vec3 x, size_t bins) {
  const size_t lights = lamps.owned.size();
  std::vector<double> probability(bins, 0);
  double sum = 0;
  for (uint32_t i = 0; i < lights; ++i) {
    const float p = lamps.selector.probability(x, i);
    probability[i * bins / lights] += p, sum += p;
  }
  // Each is rounded to half of 2^-24 of itself.
  EXPECT_NEAR(sum, 1, 1e-6);

  const int n = 1 << 18;
  std::vector<int> count(bins, 0);
  double left_sum = 0, left_index = 0;
  for (int i = 0; i < n; ++i) {
    float left = -1;
    const LightSelector::Choice choice = lamps.selector.choose(x, unit_float(random_bits()), &left);
    ASSERT_NE(choice.light, nullptr);
    ASSERT_EQ(choice.light, lamps.owned[choice.index].get());
    ASSERT_EQ(choice.probability, lamps.selector.probability(x, choice.index));
    ASSERT_TRUE(left >= 0 && left < 1);
    ++count[choice.index * bins / lights];
    left_sum += left - 0.5;
    left_index += (left - 0.5) * (choice.index % 2 ? 1 : -1);
  }
  double chi_square = 0;
  int freedom = -1;
  for (size_t bin = 0; bin < bins; ++bin) {
    if (probability[bin] == 0) {
      EXPECT_EQ(count[bin], 0);
      continue;
    }
    chi_square += std::pow(count[bin] - n * probability[bin], 2) / (n * probability[bin]);
    ++freedom;
  }
  // The value that chance exceeds once in a million (Wilson and Hilferty 1931).
  const double c = 2 / (9.0 * std::max(1, freedom));
  EXPECT_LT(chi_square, std::max(1, freedom) * std::pow(1 - c + 4.75 * std::sqrt(c), 3));
  // What is left of the number is uniform (variance 1/12) and knows nothing of the light.
  EXPECT_NEAR(left_sum / n, 0, 5 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(left_index / n, 0, 5 * std::sqrt(1.0 / 12 / n));
}

TEST(light_selector, chooses_as_often_as_it_says) {
  const Lamps kinds = every_kind(), few = lamps(32), many = lamps(33), crowd = lamps(2000);
  for (const vec3 x : {vec3(0), vec3(0.5f, 1, -2), vec3(40, -3, 2)}) {
    expect_frequencies_match(kinds, x, kinds.owned.size());
    expect_frequencies_match(few, x, 32);
    expect_frequencies_match(many, x, 33);
    expect_frequencies_match(crowd, x, 200);
  }
}

TEST(light_selector, a_million_lights_are_chosen_from_in_no_time) {
  const Lamps million = lamps(1000000);
  expect_frequencies_match(million, {3, 0, 5}, 1000);
  // Twenty steps of a binary search; going through the lights would take a millisecond each time.
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 10000; ++i) million.selector.choose({0, 0, 0}, unit_float(random_bits()), nullptr);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 1.0);
}

TEST(light_selector, a_lamp_beside_the_sun_is_still_found) {
  Lamps street = lamps(1000);
  auto sun = std::make_unique<DirectionalLight>();
  sun->irradiance = vec3(1000), sun->set_scene_bounds({{0, 0, 0}, 1e5f});
  street.add(std::move(sun));
  street.finish();
  for (uint32_t i = 0; i < 1000; ++i) ASSERT_GT(street.selector.probability({0, 0, 0}, i), 0.4f / 1001) << i;
}

TEST(light_selector, says_null_where_no_light_can_reach) {
  EXPECT_EQ(LightSelector().choose({}, 0.5f, nullptr).light, nullptr);
  EXPECT_EQ(LightSelector(std::vector<const Light*>{}).choose({}, 0.5f, nullptr).light, nullptr);
  EXPECT_EQ(LightSelector().by_power().size(), 0u);

  SpotLight left, right;
  left.direction = {-1, 0, 0}, right.direction = {1, 0, 0};
  const LightSelector spots({&left, &right});
  EXPECT_EQ(spots.choose({0, 1, 0}, 0.5f, nullptr).light, nullptr);
  EXPECT_EQ(spots.probability({0, 1, 0}, 0), 0);
  for (const float u : {0.0f, 0.3f, 0x1.fffffep-1f}) {
    EXPECT_EQ(spots.choose({-2, 0, 0}, u, nullptr).light, &left);
    EXPECT_EQ(spots.choose({2, 0, 0}, u, nullptr).light, &right);
  }

  Lamps dark;
  for (int i = 0; i < 40; ++i) dark.add(lamp({0, 0, 0}, 0));
  dark.finish();
  EXPECT_EQ(dark.selector.choose({1, 0, 0}, 0.5f, nullptr).light, nullptr);
  EXPECT_EQ(dark.selector.probability({1, 0, 0}, 3), 0);
}

TEST(light_selector, stays_finite_on_top_of_a_light) {
  Lamps two;
  two.add(lamp({0, 0, 0}, 1e20f));
  two.add(lamp({1, 0, 0}, 1));
  two.finish();
  const LightSelector::Choice choice = two.selector.choose({0, 0, 0}, 0.5f, nullptr);
  EXPECT_EQ(choice.index, 0u);
  EXPECT_TRUE(choice.probability > 0.5f && choice.probability <= 1);
}

}  // namespace
}  // namespace zonal
