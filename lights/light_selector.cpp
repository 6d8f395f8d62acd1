#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "core/sampling.h"
#include "lights/light.h"

/// Few lights: by what each can bring to the point, asked of every one. Many: by emitted power, whatever the
/// point, half of the choices shared evenly so that a lamp beside the sun is still found.

namespace zonal {

namespace {

constexpr size_t kFew = 32;  ///< asking each light costs a few ns, a shadow ray some hundred

struct Importances {
  std::array<float, kFew> value;
  float total = 0;

  Importances(std::span<const Light* const> lights, vec3 x) {
    for (size_t i = 0; i < lights.size(); ++i) total += value[i] = lights[i]->importance(x);
  }
};

std::vector<float> powers(std::span<const Light* const> lights) {
  std::vector<float> result;
  result.reserve(lights.size());
  for (const Light* light : lights) result.push_back(luminance(light->power()));
  return result;
}

}  // namespace

struct LightSelector::Impl {
  std::vector<const Light*> lights;
  Discrete by_power, many;
};

LightSelector::LightSelector(std::vector<const Light*> lights) {
  auto impl = std::make_shared<Impl>();
  impl->lights = std::move(lights);
  std::vector<float> weights = powers(impl->lights);
  impl->by_power = Discrete(weights);
  if (impl->lights.size() > kFew) {
    const auto lit = static_cast<float>(
        std::count_if(weights.begin(), weights.end(), [](float w) { return w > 0 && std::isfinite(w); }));
    const auto total = static_cast<float>(impl->by_power.total());
    for (float& w : weights)
      if (w > 0 && std::isfinite(w)) w = w / total + 1.0f / lit;
    impl->many = Discrete(weights);
  }
  impl_ = std::move(impl);
}

LightSelector::Choice LightSelector::choose(vec3 x, float u, float* u_left) const {
  if (u_left) *u_left = u;
  if (!impl_ || impl_->lights.empty()) return {};
  const auto& lights = impl_->lights;
  if (lights.size() == 1) return {lights[0], 0, 1.0f};

  if (lights.size() > kFew) {
    if (!(impl_->many.total() > 0)) return {};
    const uint32_t index = impl_->many.sample(u, u_left);
    return {lights[index], index, impl_->many.probability(index)};
  }

  // Walk along the importances to the one u falls into. Rounding may lead past the end: the last bright light
  // is meant.
  const Importances importances(lights, x);
  if (!(importances.total > 0)) return {};
  const float target = u * importances.total;
  float before = 0;
  uint32_t chosen = 0;
  float start = 0;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    if (!(importances.value[i] > 0)) continue;
    chosen = i, start = before;
    before += importances.value[i];
    if (target < before) break;
  }
  if (u_left) *u_left = std::clamp((target - start) / importances.value[chosen], 0.0f, 0x1.fffffep-1f);
  return {lights[chosen], chosen, importances.value[chosen] / importances.total};
}

float LightSelector::probability(vec3 x, uint32_t index) const {
  if (!impl_ || index >= impl_->lights.size()) return 0;
  const auto& lights = impl_->lights;
  if (lights.size() == 1) return 1;
  if (lights.size() > kFew) return impl_->many.total() > 0 ? impl_->many.probability(index) : 0.0f;
  const Importances importances(lights, x);
  return importances.total > 0 ? importances.value[index] / importances.total : 0.0f;
}

const Discrete& LightSelector::by_power() const {
  static const Discrete none;
  return impl_ ? impl_->by_power : none;
}

const std::vector<LightKind>& light_kinds() {
  static const std::vector<LightKind> kinds = {
      {"point", "shines equally in all directions from one point"},
      {"spot", "a cone of light with a soft edge"},
      {"directional", "parallel light from far away: the sun"},
      {"sphere", "a glowing ball"},
      {"quad", "a glowing parallelogram"},
      {"triangle", "a glowing triangle"},
      {"disk", "a glowing disk"},
      {"polygon", "a glowing flat polygon"},
      {"textured", "a glowing parallelogram with a picture on it"},
      {"mesh", "a glowing object: any object with \"emission\""},
      {"environment", "light from everywhere: a constant or a latitude-longitude picture"},
  };
  return kinds;
}

}  // namespace zonal
