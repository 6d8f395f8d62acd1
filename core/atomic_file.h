#pragma once
/// Files that are whole or not there: written to a temporary name beside the target, then renamed onto it.
///
///     write_atomically("out/stats.json", text.data(), text.size());   // SceneError when it cannot

#include <cstddef>
#include <string>

namespace zonal {

/// On failure the temporary file is gone, what stood at `file` is untouched, and SceneError says why in one
/// line.
void write_atomically(const std::string& file, const void* bytes, size_t size);

/// Throws the SceneError that `write_atomically` would: missing folder, no permission, a folder of that name.
/// It tries by making and removing the temporary file, because permission bits do not tell of read-only file
/// systems.
void check_can_write(const std::string& file);

}  // namespace zonal
