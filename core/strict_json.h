#pragma once
/// JSON text into a value, more strictly than the library reads it: a key may appear once in an object,
/// nesting and size are bounded, and a mistake is one line with file, line and column.
///
///     nlohmann::json scene = parse_json(text, "box.json");   // SceneError: box.json:3:12: found ...,
///     expected ...

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace zonal {

/// Throws SceneError.
nlohmann::json parse_json(const std::string& text, const std::string& file);

/// The content of a regular file. Throws SceneError when it is missing, a folder, empty or unreadable; `what`
/// says what was expected ("a scene").
std::string read_text_file(const std::string& file, const std::string& what);

}  // namespace zonal
