#include "core/json_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/image.h"

namespace zonal {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& where, const json& found, const std::string& expected) {
  throw SceneError(where + ": found " + describe(found) + ", expected " + expected);
}

/// "a number" and its range: "a number > 0".
std::string ranged(std::string what, const Range& range) {
  const std::string text = range.text();
  return text.empty() ? what : what + " " + text;
}

/// Whether the number is in the range both as written and as the float it becomes (1e-60 is > 0 until it is a
/// float).
bool fits(double x, const Range& range) {
  if (!std::isfinite(x) || std::abs(x) > std::numeric_limits<float>::max()) return false;
  return range.contains(x) && (!range.open_low || static_cast<float>(x) > range.low);
}

std::string listed(std::span<const std::string> names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::string number_text(double x) {
  return fmt::format("{:g}", x);
}

}  // namespace

std::string Range::text() const {
  const bool bounded_low = low > -1e300, bounded_high = high < 1e300;
  const std::string low_text = number_text(low), high_text = number_text(high);
  if (bounded_low && bounded_high)
    return fmt::format("in {}{}, {}{}", open_low ? '(' : '[', low_text, high_text, open_high ? ')' : ']');
  if (bounded_low) return (open_low ? "> " : ">= ") + low_text;
  if (bounded_high) return (open_high ? "< " : "<= ") + high_text;
  return "";
}

std::string in_quotes(std::string_view text, size_t longest) {
  const bool whole = text.size() <= longest;
  // The dump escapes control characters and quotes, and replaces what is not UTF-8.
  const json shown = std::string(text.substr(0, longest)) + (whole ? "" : "...");
  return shown.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string describe(const json& value) {
  switch (value.type()) {
    case json::value_t::string:
      return "the string " + in_quotes(value.get_ref<const std::string&>());
    case json::value_t::array:
      if (value.empty()) return "an empty array";
      if (value.size() <= 4 &&
          std::all_of(value.begin(), value.end(), [](const json& v) { return v.is_number(); }))
        return value.dump();
      return fmt::format("an array of {} value{}", value.size(), value.size() == 1 ? "" : "s");
    case json::value_t::object:
      return value.empty() ? "an empty object" : "an object";
    case json::value_t::null:
    case json::value_t::boolean:
    case json::value_t::number_integer:
    case json::value_t::number_unsigned:
    case json::value_t::number_float:
      return value.dump();
    default:
      return "something that is not JSON";
  }
}

std::string where_of(const std::string& where, std::string_view key) {
  // A JSON pointer (RFC 6901) escapes the two characters it is made of.
  std::string escaped;
  for (const char c : key) {
    if (c == '~')
      escaped += "~0";
    else if (c == '/')
      escaped += "~1";
    else
      escaped += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
  }
  if (escaped.size() > 80) escaped = escaped.substr(0, 80) + "...";
  return where + (where.find(": /") == std::string::npos ? ": /" : "/") + escaped;
}

std::string where_of(const std::string& where, size_t index) {
  return where_of(where, std::to_string(index));
}

float read_number(const json& value, const std::string& where, Range range) {
  const std::string expected = ranged("a number", range);
  if (!value.is_number()) refuse(where, value, expected);
  const double x = value.get<double>();
  if (std::abs(x) > std::numeric_limits<float>::max())
    refuse(where, value, expected + " that fits a 32-bit float (at most 3.4e38)");
  if (!fits(x, range)) refuse(where, value, expected);
  return static_cast<float>(x);
}

int read_integer(const json& value, const std::string& where, Range range) {
  const std::string expected = ranged("a whole number", range);
  if (!value.is_number()) refuse(where, value, expected);
  const double x = value.get<double>();
  if (x != std::floor(x) || !range.contains(x)) refuse(where, value, expected);
  if (x < std::numeric_limits<int>::min() || x > std::numeric_limits<int>::max())
    refuse(where, value, expected + " that fits 32 bits");
  return static_cast<int>(x);
}

vec3 read_vector(const json& value, const std::string& where, Range range) {
  if (!value.is_array() || value.size() != 3) refuse(where, value, "three numbers [x, y, z]");
  vec3 v(0);
  for (int i = 0; i < 3; ++i) v[i] = read_number(value[i], where_of(where, static_cast<size_t>(i)), range);
  return v;
}

vec3 read_color(const json& value, const std::string& where, Range range) {
  const std::string expected = ranged("a colour", range) + ": [r, g, b] linear, one number, or \"#rrggbb\"";
  if (value.is_number()) return vec3(read_number(value, where, range));
  if (value.is_array() && value.size() == 3) return read_vector(value, where, range);
  if (!value.is_string()) refuse(where, value, expected);

  const std::string& text = value.get_ref<const std::string&>();
  const bool hex = text.size() == 7 && text[0] == '#' &&
                   text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!hex) refuse(where, value, expected);
  const unsigned long rgb = std::stoul(text.substr(1), nullptr, 16);
  const vec3 color(srgb_decode(static_cast<float>(rgb >> 16 & 255) / 255.0f),
                   srgb_decode(static_cast<float>(rgb >> 8 & 255) / 255.0f),
                   srgb_decode(static_cast<float>(rgb & 255) / 255.0f));
  for (int i = 0; i < 3; ++i)
    if (!range.contains(color[i])) refuse(where, value, expected);
  return color;
}

std::string read_text(const json& value, const std::string& where) {
  if (!value.is_string()) refuse(where, value, "a string");
  const std::string& text = value.get_ref<const std::string&>();
  // A zero byte would end the name half way when the system sees it.
  if (text.find('\0') != std::string::npos) refuse(where, value, "a string without a zero byte");
  return text;
}

std::span<const json> read_array(const json& value, const std::string& where, std::string_view of_what) {
  if (!value.is_array()) refuse(where, value, "an array of " + std::string(of_what));
  const json::array_t& array = value.get_ref<const json::array_t&>();
  return {array.data(), array.size()};
}

Fields::Fields(const json& value, std::string where) : value_(value), where_(std::move(where)) {
  if (!value.is_object()) refuse(where_, value, "an object {...}");
}

bool Fields::has(std::string_view key) const {
  return value_.contains(key);
}

const json* Fields::find(std::string_view key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.emplace_back(key);
  const auto it = value_.find(key);
  return it == value_.end() ? nullptr : &*it;
}

const json& Fields::require(std::string_view key, std::string_view expected) {
  if (const json* found = find(key)) return *found;

  // A slip of the pen in a required key shows up here, before `finish` could name it.
  std::vector<std::string> unread;
  for (const auto& [name, value] : value_.items())
    if (std::find(asked_.begin(), asked_.end(), name) == asked_.end()) unread.push_back(name);
  const std::string nearest = nearest_name(key, unread);
  throw SceneError(fmt::format("{}: found no {}{}, expected {}", where_, in_quotes(key),
                               nearest.empty() ? "" : " but " + in_quotes(nearest), expected));
}

void Fields::wrong(std::string_view key, const json& found, const std::string& expected) const {
  refuse(at(key), found, expected);
}

float Fields::number(std::string_view key, Range range) {
  return read_number(require(key, ranged("a number", range)), at(key), range);
}

float Fields::number(std::string_view key, float otherwise, Range range) {
  const json* found = find(key);
  return found ? read_number(*found, at(key), range) : otherwise;
}

int Fields::integer(std::string_view key, int otherwise, Range range) {
  const json* found = find(key);
  return found ? read_integer(*found, at(key), range) : otherwise;
}

bool Fields::flag(std::string_view key, bool otherwise) {
  const json* found = find(key);
  if (!found) return otherwise;
  if (!found->is_boolean()) wrong(key, *found, "true or false");
  return found->get<bool>();
}

std::string Fields::text(std::string_view key) {
  return read_text(require(key, "a string"), at(key));
}

std::string Fields::text(std::string_view key, std::string otherwise) {
  const json* found = find(key);
  return found ? read_text(*found, at(key)) : otherwise;
}

vec2 Fields::pair(std::string_view key, vec2 otherwise) {
  const json* found = find(key);
  if (!found) return otherwise;
  if (!found->is_array() || found->size() != 2) wrong(key, *found, "two numbers [x, y]");
  return {read_number((*found)[0], where_of(at(key), size_t(0))),
          read_number((*found)[1], where_of(at(key), size_t(1)))};
}

vec3 Fields::vector(std::string_view key) {
  return read_vector(require(key, "three numbers [x, y, z]"), at(key));
}

vec3 Fields::vector(std::string_view key, vec3 otherwise) {
  const json* found = find(key);
  return found ? read_vector(*found, at(key)) : otherwise;
}

vec3 Fields::color(std::string_view key, vec3 otherwise, Range range) {
  const json* found = find(key);
  return found ? read_color(*found, at(key), range) : otherwise;
}

int Fields::choice(std::string_view key, std::span<const std::string> names) {
  require(key, "one of " + listed(names));
  return choice(key, 0, names);
}

int Fields::choice(std::string_view key, int otherwise, std::span<const std::string> names) {
  const json* found = find(key);
  if (!found) return otherwise;
  // A name that is a number, such as a year, may be written as one.
  const bool number = found->is_number_integer();
  if (!found->is_string() && !number) wrong(key, *found, "one of " + listed(names));
  const std::string text = number ? found->dump() : found->get<std::string>();
  const auto it = std::find(names.begin(), names.end(), text);
  if (it != names.end()) return static_cast<int>(it - names.begin());
  const std::string nearest = number ? "" : nearest_name(text, names);
  wrong(key, *found,
        "one of " + listed(names) + (nearest.empty() ? "" : " (did you mean \"" + nearest + "\"?)"));
}

void Fields::finish() const {
  for (const auto& [key, value] : value_.items())
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end())
      throw SceneError(where_ + ": unknown key " + in_quotes(key) + did_you_mean(key, asked_));
}

std::string Fields::at(std::string_view key) const {
  return where_of(where_, key);
}

void Fields::fail(std::string_view key, const std::string& sentence) const {
  throw SceneError(at(key) + ": " + sentence);
}

}  // namespace zonal
