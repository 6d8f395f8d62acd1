#include "core/mesh_materials.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <initializer_list>

#include "core/mesh_textures.h"

namespace zonal {

namespace {

using Encoding = Texture::Encoding;

/// Reads one aiMaterial: the keys we know, and a note for what we do not follow.
class MaterialReader {
 public:
  MaterialReader(const aiMaterial& source, std::string name, bool with_textures, TextureRequests& textures,
                 ImportedFile& result, std::vector<std::function<void()>>& after_loading)
      : source_(source),
        name_(std::move(name)),
        with_textures_(with_textures),
        textures_(textures),
        result_(result),
        after_loading_(after_loading) {}

  /// `is_named`: false when the file has no materials and this one is Assimp's filler.
  void read(bool is_named) {
    std::unique_ptr<Material> material;
    if (!is_named) {
      material = std::make_unique<LambertMaterial>();
    } else if (has_number(AI_MATKEY_ROUGHNESS_FACTOR) || has_number(AI_MATKEY_METALLIC_FACTOR)) {
      material = metallic_roughness();
    } else {
      material = phong();
    }
    material->name = name_;
    normal_map(*material);
    const size_t index = result_.materials.size();
    result_.materials.push_back(std::move(material));
    emission(index);
  }

 private:
  float number(const char* key, unsigned type, unsigned index, float otherwise) const {
    ai_real value = 0;
    return source_.Get(key, type, index, value) == aiReturn_SUCCESS && std::isfinite(value) ? float(value)
                                                                                            : otherwise;
  }
  bool has_number(const char* key, unsigned type, unsigned index) const {
    ai_real value = 0;
    return source_.Get(key, type, index, value) == aiReturn_SUCCESS;
  }
  /// Colours are linear in both MTL and glTF. A fourth number is asked for by `alpha`.
  vec3 color(const char* key, unsigned type, unsigned index, vec3 otherwise, float* alpha = nullptr) const {
    aiColor4D c;
    if (source_.Get(key, type, index, c) != aiReturn_SUCCESS) return otherwise;
    if (alpha && std::isfinite(c.a)) *alpha = c.a;
    const vec3 rgb(c.r, c.g, c.b);
    return is_finite(rgb) ? glm::max(rgb, vec3(0)) : otherwise;
  }
  /// A material that will be replaced has nothing to tell.
  void note(const std::string& text) {
    if (!with_textures_) return;
    result_.notes.push_back(fmt::format("material \"{}\": {}", name_, text));
  }

  /// The first texture of the given kinds, or null.
  const Texture* texture(std::initializer_list<aiTextureType> kinds, Encoding encoding,
                         aiTextureType* kind = nullptr) {
    for (const aiTextureType type : kinds) {
      aiString path;
      if (source_.GetTexture(type, 0, &path) != aiReturn_SUCCESS || path.length == 0) continue;
      if (kind) *kind = type;
      if (!with_textures_) return nullptr;
      int set = 0;
      if (source_.Get(AI_MATKEY_UVWSRC(type, 0), set) == aiReturn_SUCCESS && set != 0) {
        note(fmt::format("texture \"{}\" uses texture coordinates {}, read with the first set", path.C_Str(),
                         set));
      }
      aiUVTransform moved;
      if (source_.Get(AI_MATKEY_UVTRANSFORM(type, 0), moved) == aiReturn_SUCCESS && !is_identity(moved)) {
        note(fmt::format("the transform of texture \"{}\" is ignored", path.C_Str()));
      }
      return textures_.ask(path.C_Str(), encoding, name_);
    }
    return nullptr;
  }
  static bool is_identity(const aiUVTransform& t) {
    return t.mTranslation.x == 0 && t.mTranslation.y == 0 && t.mScaling.x == 1 && t.mScaling.y == 1 &&
           t.mRotation == 0;
  }

  std::unique_ptr<Material> phong() {
    vec3 kd = color(AI_MATKEY_COLOR_DIFFUSE, vec3(0.5f)), ks = color(AI_MATKEY_COLOR_SPECULAR, vec3(0));
    const Texture* map_kd = texture({aiTextureType_DIFFUSE}, Encoding::srgb);
    int illumination = 2;
    // MTL's models 0 and 1 have no highlight.
    if (source_.Get("$mat.illum", 0, 0, illumination) == aiReturn_SUCCESS && illumination < 2) ks = vec3(0);
    if (illumination >= 4)
      note(fmt::format("transparency and refraction (illum {}) are ignored", illumination));
    std::unique_ptr<Material> material;
    if (is_black(ks)) {
      // More than all light cannot come back.
      auto lambert = std::make_unique<LambertMaterial>();
      lambert->albedo = {glm::min(kd, vec3(1)), map_kd};
      material = std::move(lambert);
    } else {
      const float sum = max_component(kd + ks);
      const float scale = sum > 1 ? 1 / sum : 1;
      auto blinn = std::make_unique<BlinnPhongMaterial>();
      blinn->diffuse = {scale * kd, map_kd};
      blinn->specular = {scale * ks, texture({aiTextureType_SPECULAR}, Encoding::srgb)};
      blinn->exponent = std::clamp(number(AI_MATKEY_SHININESS, 50.0f), 1.0f, 1e4f);
      material = std::move(blinn);
    }
    mask_of_mtl(*material, map_kd);
    if (number(AI_MATKEY_OPACITY, 1.0f) < 1) note("partial opacity (d) is ignored: the surface is opaque");
    if (has_texture(aiTextureType_HEIGHT))
      note("a bump map of heights is ignored; a normal map belongs in `norm`");
    return material;
  }

  /// map_d, else the alpha of map_Kd. What channel map_d means shows only once it is read.
  void mask_of_mtl(Material& material, const Texture* map_kd) {
    const Texture* map_d = texture({aiTextureType_OPACITY}, Encoding::linear);
    material.mask_cutoff = 0.5f;
    if (map_d) {
      material.mask = map_d;
      after_loading_.push_back([&material, map_d] { material.mask_channel = map_d->has_alpha() ? 3 : 0; });
    } else if (map_kd) {
      after_loading_.push_back(
          [&material, map_kd] { material.mask = map_kd->has_alpha() ? map_kd : nullptr; });
    }
  }

  std::unique_ptr<Material> metallic_roughness() {
    auto material = std::make_unique<MetallicRoughnessMaterial>();
    float alpha = 1;
    const vec3 diffuse = color(AI_MATKEY_COLOR_DIFFUSE, vec3(1), &alpha);
    const vec3 base = color(AI_MATKEY_BASE_COLOR, diffuse, &alpha);
    const Texture* base_map = texture({aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}, Encoding::srgb);
    material->base_color = {glm::min(base, vec3(1)), base_map};
    // glTF packs both into one picture: roughness green, metalness blue. Assimp 5.2 files it under "unknown".
    const float metal = std::clamp(number(AI_MATKEY_METALLIC_FACTOR, 1.0f), 0.0f, 1.0f);
    const float rough = std::clamp(number(AI_MATKEY_ROUGHNESS_FACTOR, 1.0f), 0.0f, 1.0f);
    const Texture* packed = texture({aiTextureType_METALNESS, aiTextureType_UNKNOWN}, Encoding::linear);
    const Texture* rough_map =
        texture({aiTextureType_DIFFUSE_ROUGHNESS, aiTextureType_UNKNOWN}, Encoding::linear);
    material->metallic = {metal, packed, 2};
    material->roughness = {rough, rough_map, 1};
    mask_of_gltf(*material, base_map, alpha);
    return material;
  }

  void mask_of_gltf(Material& material, const Texture* base_map, float alpha) {
    aiString mode;
    if (source_.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) != aiReturn_SUCCESS) return;
    const bool blended = std::string_view(mode.C_Str()) == "BLEND",
               masked = std::string_view(mode.C_Str()) == "MASK";
    if (blended)
      note("alpha blending is ignored: texels with alpha below 0.5 are cut away, the others are opaque");
    if (!(blended || masked) || !base_map) return;
    // The factor's alpha multiplies the texture's: compare the texture's with cutoff / factor.
    const float cutoff = masked ? number(AI_MATKEY_GLTF_ALPHACUTOFF, 0.5f) : 0.5f;
    after_loading_.push_back([&material, base_map, cutoff, alpha] {
      if (!base_map->has_alpha()) return;
      material.mask = base_map, material.mask_channel = 3,
      material.mask_cutoff = cutoff / std::fmax(alpha, 1e-6f);
    });
  }

  void normal_map(Material& material) {
    material.normal_map = texture({aiTextureType_NORMALS}, Encoding::linear);
    material.normal_scale = number(AI_MATKEY_GLTF_TEXTURE_SCALE(aiTextureType_NORMALS, 0), 1.0f);
  }

  void emission(size_t index) {
    vec3 value = color(AI_MATKEY_COLOR_EMISSIVE, vec3(0));
#ifdef AI_MATKEY_EMISSIVE_INTENSITY
    value *= std::fmax(0.0f, number(AI_MATKEY_EMISSIVE_INTENSITY, 1.0f));
#endif
    int two_sided = 0;
    source_.Get(AI_MATKEY_TWOSIDED, two_sided);
    result_.emission.push_back(value);
    result_.emission_two_sided.push_back(two_sided != 0);
    if (is_black(value)) return;
    const Texture* map = texture({aiTextureType_EMISSIVE, aiTextureType_EMISSION_COLOR}, Encoding::srgb);
    if (!map) return;
    note("the emissive texture is replaced by its mean");
    after_loading_.push_back(
        [this_result = &result_, map, index] { this_result->emission[index] *= vec3(map->mean()); });
  }

  bool has_texture(aiTextureType type) const { return source_.GetTextureCount(type) > 0; }

  const aiMaterial& source_;
  std::string name_;
  bool with_textures_;
  TextureRequests& textures_;
  ImportedFile& result_;
  std::vector<std::function<void()>>& after_loading_;
};

}  // namespace

std::string material_name(const aiScene& scene, unsigned index) {
  const std::string name = scene.mMaterials[index]->GetName().C_Str();
  return name.empty() ? fmt::format("material {}", index) : name;
}

void import_materials(const aiScene& scene, const std::string& file, const std::vector<unsigned>& wanted,
                      const std::vector<std::string>& overridden, ImportedFile& result) {
  TextureRequests textures(scene, file);
  std::vector<std::function<void()>> after_loading;
  const bool is_ply = file.ends_with(".ply") || file.ends_with(".PLY");
  for (const unsigned index : wanted) {
    const std::string name = material_name(scene, index);
    const bool with_textures = std::none_of(overridden.begin(), overridden.end(), [&](const std::string& o) {
      return o == name || o == "*";  // the scene gives one material to the whole file
    });
    MaterialReader(*scene.mMaterials[index], name, with_textures, textures, result, after_loading)
        .read(!is_ply && name != AI_DEFAULT_MATERIAL_NAME);
  }
  result.textures = textures.load();
  for (const auto& finish : after_loading) finish();
}

}  // namespace zonal
