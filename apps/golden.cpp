#include "apps/golden.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "core/json_fields.h"
#include "sh/basis.h"

namespace zonal {

using nlohmann::json;

namespace {

double finite_number(const json& value, const std::string& where) {
  if (!value.is_number() || !std::isfinite(value.get<double>()))
    throw SceneError(fmt::format("{}: found {}, expected a finite number", where, describe(value)));
  return value.get<double>();
}

}  // namespace

Golden::Golden(const json& value, std::string where) : value_(&value), where_(std::move(where)) {
  if (!value.is_object())
    throw SceneError(fmt::format("{}: found {}, expected an object", where_, describe(value)));
}

bool Golden::has(std::string_view key) const {
  return value_->contains(key);
}

void Golden::fail(std::string_view key, const std::string& sentence) const {
  throw SceneError(fmt::format("{}: {}", where_of(where_, key), sentence));
}

const json& Golden::require(std::string_view key, const char* expected) const {
  const auto found = value_->find(key);
  if (found == value_->end()) fail(key, fmt::format("missing, expected {}", expected));
  return *found;
}

double Golden::number(std::string_view key) const {
  return finite_number(require(key, "a number"), where_of(where_, key));
}

double Golden::positive(std::string_view key) const {
  const double x = number(key);
  if (!(x > 0)) fail(key, fmt::format("found {}, expected a number > 0", x));
  return x;
}

int Golden::integer(std::string_view key, int low, int high) const {
  const double x = number(key);
  if (x != std::floor(x) || x < low || x > high)
    fail(key, fmt::format("found {}, expected a whole number in [{}, {}]", x, low, high));
  return static_cast<int>(x);
}

dvec3 Golden::point(std::string_view key) const {
  const std::vector<double> v = numbers(key, 3);
  return {v[0], v[1], v[2]};
}

dvec3 Golden::direction(std::string_view key) const {
  const dvec3 d = point(key);
  if (d == dvec3(0)) fail(key, "found the zero vector, expected a direction");
  return d;
}

std::vector<double> Golden::numbers(std::string_view key, size_t count, size_t columns) const {
  const json& rows = require(key, "an array of numbers");
  const std::string where = where_of(where_, key);
  if (!rows.is_array() || rows.empty() || (count && rows.size() != count)) {
    throw SceneError(fmt::format("{}: found {}, expected an array of {} {}", where, describe(rows),
                                 count ? std::to_string(count) : "one or more",
                                 columns > 1 ? fmt::format("arrays of {} numbers", columns) : "numbers"));
  }
  std::vector<double> all;
  all.reserve(rows.size() * columns);
  for (size_t i = 0; i < rows.size(); ++i) {
    if (columns == 1) {
      all.push_back(finite_number(rows[i], where_of(where, i)));
      continue;
    }
    if (!rows[i].is_array() || rows[i].size() != columns)
      throw SceneError(
          fmt::format("{}: found {}, expected {} numbers", where_of(where, i), describe(rows[i]), columns));
    for (size_t j = 0; j < columns; ++j)
      all.push_back(finite_number(rows[i][j], where_of(where_of(where, i), j)));
  }
  return all;
}

std::vector<Golden> Golden::objects(std::string_view key) const {
  const json& array = require(key, "an array of objects");
  const std::string where = where_of(where_, key);
  if (!array.is_array() || array.empty())
    throw SceneError(
        fmt::format("{}: found {}, expected an array of one or more objects", where, describe(array)));
  std::vector<Golden> all;
  for (size_t i = 0; i < array.size(); ++i) all.emplace_back(array[i], where_of(where, i));
  return all;
}

std::string Golden::text(std::string_view key, std::string otherwise) const {
  const auto found = value_->find(key);
  if (found == value_->end()) return otherwise;
  if (!found->is_string()) fail(key, fmt::format("found {}, expected a string", describe(*found)));
  return found->get<std::string>();
}

int Golden::bands(std::string_view key, size_t size) const {
  for (int n = 1; n <= sh::kMaxBands; ++n)
    if (static_cast<size_t>(sh::count(n)) == size) return n;
  fail(key, fmt::format("found {} values, expected bands^2 with bands in [1, {}]", size, sh::kMaxBands));
}

}  // namespace zonal
