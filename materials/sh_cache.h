#pragma once
/// Projections on spherical harmonics, made once: in memory while somebody holds them, and as `.shmat` files
/// by content in a folder of the user's ($ZONAL_CACHE, else $XDG_CACHE_HOME/zonal, else ~/.cache/zonal). A
/// file that is damaged, of another version or of another content under the same name is made anew; a folder
/// that cannot be written is done without.
///
///     std::shared_ptr<const ShMaterial> table = cached_projection(bsdf, {.bands = 9}, stop);

#include <functional>
#include <memory>
#include <string>

#include "materials/sh_projector.h"

namespace zonal {

/// Thread-safe. Null when stopped. Progress is in [0, 1], and only where something is projected.
std::shared_ptr<const ShMaterial> cached_projection(const Bsdf& bsdf, const ShProjectionOptions& options,
                                                    const Stop& stop = {},
                                                    const std::function<void(double)>& progress = {});

/// All that the projection depends on, as text; its hash names the file. Empty for a measured BRDF whose file
/// is gone.
std::string projection_key(const Bsdf& bsdf, const ShProjectionOptions& options);

/// Where the files are; empty where the environment names no place.
std::string cache_folder();

}  // namespace zonal
