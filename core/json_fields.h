#pragma once
/// Reads a JSON object field by field and refuses what nobody read.
///
///     Fields sphere(json, "box.json: /objects/3");
///     float radius = sphere.number("radius", {.low = 0, .open_low = true});   // required
///     float angle = sphere.number("angle", 30.0f, {0, 90});                   // with a default
///     sphere.finish();                                                        // an unread key is a
///     SceneError
///
/// Every error is one line: where (file and JSON pointer), what was found, what was expected, the nearest
/// name.

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/vec.h"

namespace zonal {

/// Allowed numbers, ends included unless open. Printed as "in [0, 1]", "> 0" or "" when everything is
/// allowed.
struct Range {
  double low = -1e300, high = 1e300;
  bool open_low = false, open_high = false;
  bool contains(double x) const {
    return (open_low ? x > low : x >= low) && (open_high ? x < high : x <= high);
  }
  std::string text() const;
};

class Fields {
 public:
  /// `where` is printed in front of every error: "file: /pointer", or the bare file for the root. Throws
  /// SceneError when `value` is not an object. `value` must outlive the Fields.
  Fields(const nlohmann::json& value, std::string where);

  bool has(std::string_view key) const;
  /// Marks `key` as read and returns its value, or null when absent.
  const nlohmann::json* find(std::string_view key);
  /// Marks `key` as read; a missing one is a SceneError that says what is expected there.
  const nlohmann::json& require(std::string_view key, std::string_view expected = "one");

  float number(std::string_view key, Range range = {});  ///< required; finite
  float number(std::string_view key, float otherwise, Range range = {});
  int integer(std::string_view key, int otherwise, Range range = {});
  bool flag(std::string_view key, bool otherwise);
  std::string text(std::string_view key);  ///< required
  std::string text(std::string_view key, std::string otherwise);
  vec2 pair(std::string_view key, vec2 otherwise);
  vec3 vector(std::string_view key);  ///< required; three finite numbers
  vec3 vector(std::string_view key, vec3 otherwise);
  /// A colour: three numbers, one number (grey), or "#rrggbb" (sRGB). Components must lie in `range`.
  vec3 color(std::string_view key, vec3 otherwise, Range range = {0, 1e300});
  /// One of `names`, as its index; required.
  int choice(std::string_view key, std::span<const std::string> names);
  int choice(std::string_view key, int otherwise, std::span<const std::string> names);

  /// Throws SceneError naming the first key nobody asked for and the nearest one that was.
  void finish() const;

  /// "file: /pointer/key", for errors the caller finds.
  std::string at(std::string_view key) const;
  const std::string& where() const { return where_; }
  [[noreturn]] void fail(std::string_view key, const std::string& sentence) const;

 private:
  const nlohmann::json& value_;
  std::string where_;
  std::vector<std::string> asked_;

  [[noreturn]] void wrong(std::string_view key, const nlohmann::json& found,
                          const std::string& expected) const;
};

/// "a string", "a number", ... with the value when it is short: how errors name what was found.
std::string describe(const nlohmann::json& value);

/// Values without a key of their own (an array's elements, say). `where` names the value in the error.
float read_number(const nlohmann::json& value, const std::string& where, Range range = {});
int read_integer(const nlohmann::json& value, const std::string& where, Range range = {});
vec3 read_vector(const nlohmann::json& value, const std::string& where, Range range = {});
vec3 read_color(const nlohmann::json& value, const std::string& where, Range range = {0, 1e300});
std::string read_text(const nlohmann::json& value, const std::string& where);
/// The elements of an array, or a SceneError.
std::span<const nlohmann::json> read_array(const nlohmann::json& value, const std::string& where,
                                           std::string_view of_what);

/// "file: /pointer" + key -> "file: /pointer/key"; a bare file gets its first pointer.
std::string where_of(const std::string& where, std::string_view key);
std::string where_of(const std::string& where, size_t index);
/// `text` in quotes, shortened when long, with control characters escaped: safe inside a one-line error.
std::string in_quotes(std::string_view text, size_t longest = 60);

}  // namespace zonal
