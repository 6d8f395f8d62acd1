#pragma once
/// Reads golden-vector files: numbers keep double precision, shapes are checked, keys nobody asks for are
/// ignored (files carry notes on how they were made).

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace zonal {

using dvec3 = glm::dvec3;

/// One JSON object of such a file. Every error is a SceneError of one line: where, found, expected.
class Golden {
 public:
  Golden(const nlohmann::json& value, std::string where);

  bool has(std::string_view key) const;
  double number(std::string_view key) const;
  double positive(std::string_view key) const;
  dvec3 point(std::string_view key) const;
  dvec3 direction(std::string_view key) const;  ///< any length but 0
  /// A whole number in [low, high].
  int integer(std::string_view key, int low, int high) const;
  /// All numbers of an array, of arrays of `columns` numbers when columns > 1; `count` 0 takes any number of
  /// rows.
  std::vector<double> numbers(std::string_view key, size_t count = 0, size_t columns = 1) const;
  /// The elements of the array `key`, as objects.
  std::vector<Golden> objects(std::string_view key) const;
  std::string text(std::string_view key, std::string otherwise) const;

  /// Bands of an array of `size` = bands^2 rows found under `key`.
  int bands(std::string_view key, size_t size) const;
  [[noreturn]] void fail(std::string_view key, const std::string& sentence) const;

 private:
  const nlohmann::json& require(std::string_view key, const char* expected) const;

  const nlohmann::json* value_;
  std::string where_;
};

}  // namespace zonal
