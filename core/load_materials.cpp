// "materials": one reader a kind. Texture slots are filled later, when TextureSlots reads the files.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/loading.h"
#include "materials/measured_brdf.h"

namespace zonal {
namespace {

using nlohmann::json;

const std::array<std::string, 2> kEncodings{"srgb", "linear"};
const std::array<std::string, 4> kChannels{"r", "g", "b", "a"};
constexpr Range kShare{0, 1};

/// What the object form {"file": ...} of a texture may say besides its file.
struct TextureKeys {
  Texture::Encoding encoding = Texture::Encoding::linear;
  vec3* color_scale = nullptr;    ///< "scale" is a colour
  float* number_scale = nullptr;  ///< "scale" is a number
  int* channel = nullptr;
  bool channel_by_alpha = false;  ///< without "channel": alpha where the file has one
};

/// "file.png" or {"file": ..., ...}.
void read_texture(Loading& loading, const json& value, const std::string& where, const Texture** slot,
                  TextureKeys keys) {
  if (value.is_string()) {
    const std::string file = loading.resolve(read_text(value, where), where);
    loading.textures.add(file, keys.encoding, where, slot, keys.channel_by_alpha ? keys.channel : nullptr);
    return;
  }
  Fields fields(value, where);
  const std::string text = fields.text("file");
  keys.encoding =
      static_cast<Texture::Encoding>(fields.choice("encoding", static_cast<int>(keys.encoding), kEncodings));
  if (keys.color_scale) *keys.color_scale = fields.color("scale", vec3(1), {0, 1000});
  if (keys.number_scale) *keys.number_scale = fields.number("scale", 1.0f, {0, 1000});
  if (keys.channel) {
    if (fields.has("channel")) keys.channel_by_alpha = false;
    *keys.channel = fields.choice("channel", *keys.channel, kChannels);
  }
  fields.finish();
  loading.textures.add(loading.resolve(text, fields.at("file")), keys.encoding, where, slot,
                       keys.channel_by_alpha ? keys.channel : nullptr);
}

void read_slot(Loading& loading, Fields& fields, const char* key, TexturedColor& slot) {
  const json* value = fields.find(key);
  if (!value) return;
  const bool file = value->is_string() && value->get_ref<const std::string&>().rfind('#', 0) != 0;
  if (file || value->is_object()) {
    slot.value = vec3(1);
    read_texture(loading, *value, fields.at(key), &slot.texture,
                 {.encoding = Texture::Encoding::srgb, .color_scale = &slot.value});
  } else if (value->is_number() || value->is_string() || (value->is_array() && value->size() == 3)) {
    slot.value = read_color(*value, fields.at(key), kShare);
  } else {
    fields.fail(key, "found " + describe(*value) +
                         ", expected a colour ([r, g, b], a number or \"#rrggbb\") or a texture "
                         "(\"file.png\" or {\"file\": ...})");
  }
}

void read_slot(Loading& loading, Fields& fields, const char* key, TexturedNumber& slot) {
  const json* value = fields.find(key);
  if (!value) return;
  if (value->is_string() || value->is_object()) {
    slot.value = 1;
    read_texture(loading, *value, fields.at(key), &slot.texture,
                 {.number_scale = &slot.value, .channel = &slot.channel});
  } else if (value->is_number()) {
    slot.value = read_number(*value, fields.at(key), kShare);
  } else {
    fields.fail(key, "found " + describe(*value) +
                         ", expected a number in [0, 1] or a texture (\"file.png\" or {\"file\": ...})");
  }
}

// ---- one reader a kind -------------------------------------------------------------------------------

std::unique_ptr<Material> lambert(Loading& loading, Fields& fields) {
  auto m = std::make_unique<LambertMaterial>();
  read_slot(loading, fields, "albedo", m->albedo);
  return m;
}

std::unique_ptr<Material> blinn_phong(Loading& loading, Fields& fields) {
  auto m = std::make_unique<BlinnPhongMaterial>();
  read_slot(loading, fields, "diffuse", m->diffuse);
  read_slot(loading, fields, "specular", m->specular);
  m->exponent = fields.number("exponent", m->exponent, {0, 1e6});
  return m;
}

std::unique_ptr<Material> conductor(Loading& loading, Fields& fields) {
  auto m = std::make_unique<ConductorMaterial>();
  std::vector<std::string> names;
  for (const Metal& metal : metals()) names.push_back(metal.name);
  const bool named = fields.has("metal"), by_index = fields.has("eta") || fields.has("k");
  if (named && by_index)
    fields.fail("metal", "found beside \"eta\" or \"k\", expected either a name or both numbers");
  if (by_index && !(fields.has("eta") && fields.has("k")))
    fields.fail(fields.has("eta") ? "eta" : "k", "found alone, expected both \"eta\" and \"k\"");

  // Without either it is the default's metal, copper, as in pbrt.
  if (const int index = fields.choice("metal", -1, names); index >= 0) {
    m->eta = metals()[static_cast<size_t>(index)].eta;
    m->k = metals()[static_cast<size_t>(index)].k;
  }
  m->eta = fields.color("eta", m->eta, {1e-3, 1e3});
  m->k = fields.color("k", m->k, {0, 1e3});
  read_slot(loading, fields, "tint", m->tint);
  m->roughness.channel = 1;
  read_slot(loading, fields, "roughness", m->roughness);
  m->anisotropy = fields.number("anisotropy", 0.0f, {-1, 1});
  return m;
}

std::unique_ptr<Material> coated(Loading& loading, Fields& fields) {
  auto m = std::make_unique<CoatedMaterial>();
  read_slot(loading, fields, "albedo", m->albedo);
  m->roughness.channel = 1;
  read_slot(loading, fields, "roughness", m->roughness);
  m->ior = fields.number("ior", m->ior, {1, 10});
  m->anisotropy = fields.number("anisotropy", 0.0f, {-1, 1});
  return m;
}

std::unique_ptr<Material> metallic_roughness(Loading& loading, Fields& fields) {
  auto m = std::make_unique<MetallicRoughnessMaterial>();
  read_slot(loading, fields, "base_color", m->base_color);
  read_slot(loading, fields, "metallic", m->metallic);
  read_slot(loading, fields, "roughness", m->roughness);
  return m;
}

void add_entry(Loading& loading, const DatabaseEntry& entry, const std::string& where,
               MeasuredMaterial* material) {
  if (!std::filesystem::exists(entry.source))
    throw SceneError(
        fmt::format("{}: {}: its measured file {} is gone, expected it where it was projected from", where,
                    in_quotes(entry.name), entry.source));
  material->sh_file = entry.sh_file;
  loading.measured.add(entry.source, where, material);
}

std::unique_ptr<Material> measured(Loading& loading, Fields& fields) {
  auto m = std::make_unique<MeasuredMaterial>();
  if (!fields.find("entry")) {
    loading.measured.add(loading.resolve(fields.text("file"), fields.at("file")), fields.at("file"), m.get());
    return m;
  }
  const std::string name = fields.text("entry"), where = fields.at("entry");
  const MaterialDatabase* database = loading.database();
  if (!database)
    fields.fail("entry", "found " + in_quotes(name) +
                             ", expected a \"material_database\" in the scene or ZONAL_MATERIALS in "
                             "the environment that names one");
  const DatabaseEntry* entry = database->find(name);
  if (!entry)
    fields.fail("entry", "found " + in_quotes(name) + ", expected a material of the database" +
                             did_you_mean(name, database->names()));
  add_entry(loading, *entry, where, m.get());
  return m;
}

using Reader = std::unique_ptr<Material> (*)(Loading&, Fields&);
const std::array<std::string, 6> kKinds{"lambert", "blinn_phong",        "conductor",
                                        "coated",  "metallic_roughness", "measured"};
constexpr std::array<Reader, 6> kReaders{lambert, blinn_phong,        conductor,
                                         coated,  metallic_roughness, measured};

/// Keys every kind has.
void read_common(Loading& loading, Fields& fields, Material& m) {
  if (const json* map = fields.find("normal_map"))
    read_texture(loading, *map, fields.at("normal_map"), &m.normal_map, {});
  m.normal_scale = fields.number("normal_scale", m.normal_scale, {-100, 100});
  if (const json* mask = fields.find("mask"))
    read_texture(loading, *mask, fields.at("mask"), &m.mask,
                 {.channel = &m.mask_channel, .channel_by_alpha = true});
  m.mask_cutoff = fields.number("mask_cutoff", m.mask_cutoff, kShare);
}

uint32_t add_lambert(Loading& loading, const char* name, vec3 albedo) {
  auto m = std::make_unique<LambertMaterial>();
  m->name = name;
  m->albedo.value = albedo;
  loading.parts.materials.push_back(std::move(m));
  return static_cast<uint32_t>(loading.parts.materials.size() - 1);
}

}  // namespace

void read_materials(Loading& loading, const json& list, const std::string& where) {
  const auto values = read_array(list, where, "materials");
  for (size_t i = 0; i < values.size(); ++i) {
    Fields fields(values[i], where_of(where, i));
    const std::string name = fields.text("name");
    if (name.empty()) fields.fail("name", "found an empty string, expected a name");
    for (size_t j = 0; j < i; ++j)
      if (loading.material_names[j] == name)
        fields.fail("name", fmt::format("found {} again, expected a name that /materials/{} does not have",
                                        in_quotes(name), j));
    const int kind = fields.choice("type", kKinds);
    std::unique_ptr<Material> material = kReaders[static_cast<size_t>(kind)](loading, fields);
    material->name = name;
    read_common(loading, fields, *material);
    fields.finish();

    loading.material_names.push_back(name);
    loading.material_used.push_back(false);
    loading.parts.materials.push_back(std::move(material));
  }
}

void MeasuredSlots::add(const std::string& file, const std::string& where, MeasuredMaterial* slot) {
  Request& request = requests_[file];
  if (request.slots.empty()) request.where = where;
  request.slots.push_back(slot);
}

void MeasuredSlots::load_all() {
  for (const auto& [file, request] : requests_) {
    try {
      const std::shared_ptr<const MeasuredBrdf> brdf = load_measured(file);
      for (MeasuredMaterial* slot : request.slots) slot->brdf = brdf;
    } catch (const SceneError& error) {
      throw SceneError(request.where + ": " + error.what());
    }
  }
}

uint32_t Loading::find_material(const std::string& name) {
  const auto found = std::find(material_names.begin(), material_names.end(), name);
  if (found == material_names.end()) {
    if (const auto used = from_database.find(name); used != from_database.end()) return used->second;
    const DatabaseEntry* entry = database() ? database()->find(name) : nullptr;
    if (!entry) return kNone;
    auto material = std::make_unique<MeasuredMaterial>();
    material->name = name;
    add_entry(*this, *entry, database_where, material.get());
    parts.materials.push_back(std::move(material));
    return from_database[name] = static_cast<uint32_t>(parts.materials.size() - 1);
  }
  const auto index = found - material_names.begin();
  material_used[static_cast<size_t>(index)] = true;
  return static_cast<uint32_t>(index);
}

const MaterialDatabase* Loading::database() {
  if (database_folder.empty()) return nullptr;
  try {
    if (!opened_database) opened_database = MaterialDatabase::open(database_folder);
  } catch (const SceneError& error) {
    throw SceneError(database_where + ": " + error.what());
  }
  return &*opened_database;
}

void replace_materials(json& root, const json& replacements, const std::string& file) {
  if (replacements.empty()) return;
  std::vector<std::string> names;
  if (root.is_object() && root.contains("materials") && root["materials"].is_array())
    for (json& material : root["materials"]) {
      const std::string name = material.is_object() ? material.value("name", "") : "";
      names.push_back(name);
      if (!replacements.contains(name)) continue;
      const json& by = replacements[name];
      if (by.is_object()) {
        material = by;
        material["name"] = name;
      } else {
        material = {{"name", name}, {"type", "measured"}, {"entry", by}};
      }
    }
  for (const auto& [name, by] : replacements.items())
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw SceneError(fmt::format("{}: --material: found {}, expected the name of a material of the scene{}",
                                   file, in_quotes(name), did_you_mean(name, names)));
}

uint32_t Loading::grey() {
  if (default_material == kNone) default_material = add_lambert(*this, "default grey", vec3(0.5f));
  return default_material;
}

uint32_t Loading::black() {
  if (black_material == kNone) black_material = add_lambert(*this, "light", vec3(0));
  return black_material;
}

}  // namespace zonal
