#include "core/mesh_import.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <filesystem>
#include <fstream>
#include <map>

#include "core/assimp_types.h"
#include "core/error.h"
#include "core/mesh_cameras.h"
#include "core/mesh_materials.h"
#include "core/smooth_normals.h"

namespace zonal {

namespace {

/// One mesh as one node places it.
struct Placed {
  const aiMesh* mesh;
  mat4 to_world;
};

bool matches(std::string_view pattern, std::string_view name) {
  if (!pattern.empty() && pattern.back() == '*')
    return name.starts_with(pattern.substr(0, pattern.size() - 1));
  return pattern == name;
}

/// Leaves out what a scene file does not want, and notices patterns that meet nothing.
class Exclusion {
 public:
  explicit Exclusion(const std::vector<std::string>& patterns)
      : patterns_(patterns), met_(patterns.size(), false) {}
  bool excludes(const std::string& name) {
    if (patterns_.empty() || name.empty()) return false;
    names_.push_back(name);
    bool any = false;
    for (size_t i = 0; i < patterns_.size(); ++i) {
      if (matches(patterns_[i], name)) any = met_[i] = true;
    }
    return any;
  }
  void check(const std::string& file) {
    std::sort(names_.begin(), names_.end());
    names_.erase(std::unique(names_.begin(), names_.end()), names_.end());
    for (size_t i = 0; i < patterns_.size(); ++i) {
      if (met_[i]) continue;
      throw SceneError(fmt::format("{}: exclude \"{}\" matches no object, mesh or material{}", file,
                                   patterns_[i], did_you_mean(patterns_[i], names_)));
    }
  }

 private:
  const std::vector<std::string>& patterns_;
  std::vector<bool> met_;
  std::vector<std::string> names_;
};

std::string mesh_name(const aiMesh& mesh) {
  return mesh.mName.length == 0 ? std::string("(without a name)") : fmt::format("\"{}\"", mesh.mName.C_Str());
}

std::string lower_extension(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

/// Indices are checked before anything that would follow them.
void check_indices(const aiScene& scene, const std::string& file) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      if (mesh.mFaces[f].mNumIndices == 0) {
        throw SceneError(fmt::format("{}: mesh {}: face {} has no vertices (is the file cut short?)", file,
                                     mesh_name(mesh), f));
      }
      for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k) {
        if (mesh.mFaces[f].mIndices[k] < mesh.mNumVertices) continue;
        throw SceneError(fmt::format("{}: mesh {}: face {} uses vertex {}, but there are {} vertices", file,
                                     mesh_name(mesh), f, mesh.mFaces[f].mIndices[k], mesh.mNumVertices));
      }
    }
    if (mesh.mMaterialIndex >= scene.mNumMaterials) {
      throw SceneError(fmt::format("{}: mesh {}: uses material {}, but there are {} materials", file,
                                   mesh_name(mesh), mesh.mMaterialIndex, scene.mNumMaterials));
    }
  }
}

/// Refuses what Assimp must not be given: a file that is not what its name says is tried by all of Assimp's
/// readers in turn, and a PLY header without an end is read for ever (Assimp 5.2).
void check_head(const std::string& file, const std::string& extension) {
  std::ifstream in(file, std::ios::binary);
  const auto refuse = [&](const char* reason) {
    throw SceneError(fmt::format("{}: cannot be read as a mesh: {}", file, reason));
  };
  std::string line;
  if (extension == ".ply") {
    std::getline(in, line);
    if (!line.starts_with("ply")) refuse("a PLY file starts with \"ply\"");
    for (int i = 0; i < 10000 && std::getline(in, line); ++i) {
      while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.pop_back();
      if (line == "end_header") return;
    }
    refuse("the PLY header has no end_header line");
  } else if (extension == ".glb") {
    char magic[4] = {};
    in.read(magic, 4);
    if (std::string_view(magic, 4) != "glTF") refuse("a GLB file starts with \"glTF\"");
  } else if (extension == ".gltf") {
    char first = 0;
    in >> first;
    if (first != '{') refuse("a glTF file starts with \"{\"");
  }
}

const aiScene& read(Assimp::Importer& importer, const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) throw SceneError(file + ": no such mesh file");
  const std::string extension = lower_extension(file);
  if (extension != ".obj" && extension != ".ply" && extension != ".gltf" && extension != ".glb") {
    throw SceneError(
        fmt::format("{}: found a \"{}\" file, expected .obj, .ply, .gltf or .glb", file, extension));
  }
  check_head(file, extension);
  const auto refuse = [&] {
    std::string reason = importer.GetErrorString();
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    throw SceneError(fmt::format("{}: cannot be read as a mesh: {}", file, reason));
  };
  const aiScene* scene = importer.ReadFile(file, 0);
  if (!scene || !scene->mRootNode) refuse();
  check_indices(*scene, file);
  scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (!scene) refuse();
  return *scene;
}

/// Walks the nodes and keeps the meshes nobody excluded.
std::vector<Placed> place(const aiScene& scene, const mat4& to_world, Exclusion& exclusion) {
  struct Visit {
    const aiNode* node;
    mat4 parent;
    bool excluded;
  };
  std::vector<Placed> placed;
  std::vector<Visit> open{{scene.mRootNode, to_world, false}};
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    const aiNode& node = *visit.node;
    const mat4 here = visit.parent * to_mat4(node.mTransformation);
    const bool excluded = exclusion.excludes(node.mName.C_Str()) || visit.excluded;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const aiMesh* mesh = scene.mMeshes[node.mMeshes[i]];
      const bool by_mesh = exclusion.excludes(mesh->mName.C_Str());
      const bool by_material = exclusion.excludes(material_name(scene, mesh->mMaterialIndex));
      if (!(excluded || by_mesh || by_material)) placed.push_back({mesh, here});
    }
    // Backwards onto the stack, so that they are met in the file's order.
    for (unsigned i = node.mNumChildren; i-- > 0;) open.push_back({node.mChildren[i], here, excluded});
  }
  return placed;
}

/// The mesh in world units. Throws for coordinates that are no numbers.
MeshData convert(const Placed& placed, const std::string& file, bool smooth) {
  const aiMesh& mesh = *placed.mesh;
  MeshData out;
  out.name = mesh.mName.C_Str();
  out.positions.resize(mesh.mNumVertices);
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& p = mesh.mVertices[i];
    out.positions[i] = vec3(placed.to_world * vec4(to_vec3(p), 1));
    if (!is_finite(out.positions[i])) {
      throw SceneError(fmt::format("{}: mesh {}: vertex {} is ({}, {}, {}), expected finite coordinates",
                                   file, mesh_name(mesh), i, p.x, p.y, p.z));
    }
  }
  const mat3 linear(placed.to_world);
  const float determinant = glm::determinant(linear);
  if (mesh.HasNormals()) {
    // A flattening transform has no inverse; such triangles have no area either.
    const mat3 for_normals = determinant != 0 ? glm::transpose(glm::inverse(linear)) : mat3(0);
    out.normals.resize(mesh.mNumVertices);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      out.normals[i] = for_normals * to_vec3(mesh.mNormals[i]);
    }
  }
  if (mesh.HasTextureCoords(0)) {
    out.uvs.resize(mesh.mNumVertices);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      out.uvs[i] = {mesh.mTextureCoords[0][i].x, mesh.mTextureCoords[0][i].y};
    }
  }
  out.triangles.reserve(mesh.mNumFaces);
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;  // points and lines
    // A mirroring transform turns the winding; turn it back, so that the front stays the front.
    const bool mirrored = determinant < 0;
    out.triangles.push_back(
        {face.mIndices[0], face.mIndices[mirrored ? 2 : 1], face.mIndices[mirrored ? 1 : 2]});
  }
  if (smooth && out.normals.empty()) make_smooth_normals(out);
  return out;
}

void append(MeshData& to, MeshData&& from) {
  const uint32_t base = uint32_t(to.positions.size());
  to.positions.insert(to.positions.end(), from.positions.begin(), from.positions.end());
  to.normals.insert(to.normals.end(), from.normals.begin(), from.normals.end());
  to.uvs.insert(to.uvs.end(), from.uvs.begin(), from.uvs.end());
  for (const uvec3 t : from.triangles) to.triangles.push_back(t + base);
  from = {};
}

/// Meshes with the same material and the same arrays become one shape: fewer, larger ones trace and load
/// faster.
void import_shapes(const std::vector<Placed>& placed, const std::map<unsigned, uint32_t>& material_of,
                   const std::string& file, bool smooth, ImportedFile& result) {
  std::vector<MeshData> meshes(placed.size());
  std::vector<std::string> errors(placed.size());
  tbb::parallel_for(size_t(0), placed.size(), [&](size_t i) {
    try {
      meshes[i] = convert(placed[i], file, smooth);
    } catch (const SceneError& e) {
      errors[i] = e.what();
    }
  });
  for (const std::string& error : errors) {
    if (!error.empty()) throw SceneError(error);
  }
  std::map<std::tuple<uint32_t, bool, bool>, std::vector<size_t>> groups;
  for (size_t i = 0; i < placed.size(); ++i) {
    if (meshes[i].triangles.empty()) continue;
    groups[{material_of.at(placed[i].mesh->mMaterialIndex), meshes[i].normals.empty(), meshes[i].uvs.empty()}]
        .push_back(i);
  }
  for (const auto& [key, members] : groups) {
    ShapeData shape;
    shape.material = std::get<0>(key);
    // One mesh keeps its name; several are called after what they share.
    shape.name = members.size() == 1 ? meshes[members[0]].name : result.materials[shape.material]->name;
    for (const size_t i : members) append(shape.mesh, std::move(meshes[i]));
    shape.mesh.name = shape.name;
    result.shapes.push_back(std::move(shape));
  }
}

/// Assimp says nothing about a material library that is not there. They stand near the top of the file.
void note_missing_libraries(const std::string& file, std::vector<std::string>& notes) {
  std::ifstream in(file, std::ios::binary);
  std::string head(1 << 16, '\0');
  in.read(head.data(), std::streamsize(head.size()));
  head.resize(size_t(in.gcount()));
  for (size_t at = head.find("mtllib "); at != std::string::npos; at = head.find("mtllib ", at + 1)) {
    if (at > 0 && head[at - 1] != '\n') continue;
    const size_t begin = at + 7, end = std::min(head.find_first_of("\r\n", begin), head.size());
    const std::string library = head.substr(begin, end - begin);
    std::error_code ignored;
    if (std::filesystem::exists(std::filesystem::path(file).parent_path() / library, ignored)) continue;
    notes.push_back(
        fmt::format("{}: material library \"{}\" is missing: its materials are grey", file, library));
  }
}

void note_what_is_ignored(const aiScene& scene, const std::string& file, std::vector<std::string>& notes) {
  size_t other = 0, colors = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    if (mesh.mPrimitiveTypes & (aiPrimitiveType_POINT | aiPrimitiveType_LINE)) ++other;
    if (mesh.HasVertexColors(0)) ++colors;
  }
  if (other) notes.push_back(fmt::format("{}: points and lines in {} meshes are ignored", file, other));
  if (colors) notes.push_back(fmt::format("{}: vertex colours of {} meshes are ignored", file, colors));
  if (scene.mNumAnimations) notes.push_back(fmt::format("{}: animations are ignored", file));
}

}  // namespace

ImportedFile import_mesh(const std::string& file, const ImportOptions& options) {
  Assimp::Importer importer;
  const aiScene& scene = read(importer, file);
  const mat4 scale(mat3(options.metres_per_unit));
  const mat4 to_world = options.transform * scale;

  ImportedFile result;
  Exclusion exclusion(options.exclude);
  const std::vector<Placed> placed = place(scene, to_world, exclusion);
  exclusion.check(file);

  // Only the materials of what is left, in the file's order.
  std::map<unsigned, uint32_t> material_of;
  for (const Placed& p : placed) material_of.emplace(p.mesh->mMaterialIndex, 0);
  std::vector<unsigned> wanted;
  for (auto& [source, ours] : material_of) {
    ours = uint32_t(wanted.size());
    wanted.push_back(source);
  }
  if (lower_extension(file) == ".obj") note_missing_libraries(file, result.notes);
  note_what_is_ignored(scene, file, result.notes);
  import_materials(scene, file, wanted, options.overridden_materials, result);
  import_shapes(placed, material_of, file, options.smooth_normals, result);
  import_cameras(scene, to_world, result);
  if (options.lights) import_lights(scene, file, to_world, result);
  return result;
}

}  // namespace zonal
