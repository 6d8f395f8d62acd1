#pragma once
/// Errors of the world outside (a file, a key, a value): one sentence for the person who can act, exit code 2.
/// Our own mistakes are assertions.

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace zonal {

struct SceneError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The candidate with the smallest edit distance to `name`; "" when none is near enough to be meant.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// ` (did you mean "x"?)`, or a list of what there is when nothing is near: the tail of an "unknown name" sentence.
std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

}  // namespace zonal
