/// Imported files against what their text says.

#include "core/mesh_import.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/mesh_files.h"

using namespace zonal;
using namespace zonal::test;

namespace {

std::string message(const std::string& file, const ImportOptions& options = {}) {
  try {
    import_mesh(file, options);
  } catch (const SceneError& e) {
    return e.what();
  }
  return "no error";
}

ImportOptions excluding(std::vector<std::string> names) {
  ImportOptions options;
  options.exclude = std::move(names);
  return options;
}

template <class T>
const T& as(const std::unique_ptr<Material>& m) {
  const T* cast = dynamic_cast<const T*>(m.get());
  if (!cast) throw std::runtime_error("material \"" + m->name + "\" is " + m->type());
  return *cast;
}

/// Two objects, three materials; the quad of the second object is two triangles.
const char* kObj = R"(mtllib parts.mtl
o ball
v 0 0 0
v 1 0 0
v 0 1 0
v 1 1 0
vt 0 0
vt 1 0
vt 0 1
vt 1 1
usemtl matte
f 1/1 2/2 3/3
o slab
usemtl shiny
f 1/1 2/2 4/4 3/3
usemtl matte
f 2/2 4/4 3/3
o lamp
usemtl glow
f 1/1 3/3 2/2
)";
const char* kMtl = R"(newmtl matte
Kd 0.2 0.4 0.6
map_Kd red_over_blue.png
newmtl shiny
Kd 0.8 0.8 0.8
Ks 0.8 0.4 0.2
Ns 40
illum 2
newmtl glow
Kd 0 0 0
Ke 3 2 1
)";

class Obj : public testing::Test {
 protected:
  Folder folder_;
  std::string file_;
  void SetUp() override {
    file_ = folder_.write("parts.obj", kObj);
    folder_.write("parts.mtl", kMtl);
    folder_.png("red_over_blue.png", 1, 2, 3, {255, 0, 0, 0, 0, 255});
  }
};

}  // namespace

TEST_F(Obj, materials_follow_the_mtl) {
  const ImportedFile f = import_mesh(file_, {});
  ASSERT_EQ(f.materials.size(), 3u);
  ASSERT_EQ(f.shapes.size(), 3u);  // one a material
  const auto& matte = as<LambertMaterial>(f.materials[f.shapes[0].material]);
  EXPECT_EQ(matte.name, "matte");
  EXPECT_LT(length(matte.albedo.value - vec3(0.2f, 0.4f, 0.6f)), 1e-6f);
  ASSERT_NE(matte.albedo.texture, nullptr);
  // map_Kd multiplies Kd; v points up, so v = 3/4 is the centre of the picture's first row.
  EXPECT_LT(length(matte.albedo.at({0.5f, 0.75f}) - vec3(0.2f, 0, 0)), 1e-6f);
  EXPECT_LT(length(matte.albedo.at({0.5f, 0.25f}) - vec3(0, 0, 0.6f)), 1e-6f);
  EXPECT_EQ(matte.mask, nullptr);
  const auto& shiny = as<BlinnPhongMaterial>(f.materials[f.shapes[1].material]);
  // 0.8 + 0.8 is more than all light: both are divided by 1.6.
  EXPECT_LT(length(shiny.diffuse.value - vec3(0.5f)), 1e-6f);
  EXPECT_LT(length(shiny.specular.value - vec3(0.5f, 0.25f, 0.125f)), 1e-6f);
  EXPECT_EQ(shiny.exponent, 40);
  EXPECT_EQ(f.emission[f.shapes[2].material], vec3(3, 2, 1));
  EXPECT_EQ(f.emission[f.shapes[0].material], vec3(0));
}

TEST_F(Obj, meshes_with_one_material_become_one_shape_in_metres) {
  ImportOptions options;
  options.metres_per_unit = 0.5f;
  options.transform[3] = vec4(10, 0, 0, 1);
  const ImportedFile f = import_mesh(file_, options);
  EXPECT_EQ(f.shapes[0].mesh.triangles.size(), 2u);  // of ball and slab
  EXPECT_EQ(f.shapes[1].mesh.triangles.size(), 2u);  // the quad
  EXPECT_EQ(f.shapes[2].name, "lamp");
  const MeshData& lamp = f.shapes[2].mesh;
  std::vector<vec3> corners;
  for (int k = 0; k < 3; ++k) corners.push_back(lamp.positions[lamp.triangles[0][k]]);
  // The file's order of corners: (0,0,0), (0,1,0), (1,0,0); first scaled, then moved.
  EXPECT_EQ(corners, (std::vector<vec3>{{10, 0, 0}, {10, 0.5f, 0}, {10.5f, 0, 0}}));
  // No normals in the file: made up, on the side the winding shows.
  EXPECT_LT(length(lamp.normals[0] - vec3(0, 0, -1)), 1e-6f);
}

TEST_F(Obj, a_mirroring_transform_keeps_the_front) {
  ImportOptions options;
  options.transform[2][2] = -1;  // the patch is in z = 0, so only its front could change
  const MeshData mesh = import_mesh(file_, options).shapes[2].mesh;
  const vec3 a = mesh.positions[mesh.triangles[0].x], b = mesh.positions[mesh.triangles[0].y],
             c = mesh.positions[mesh.triangles[0].z];
  EXPECT_GT(cross(b - a, c - a).z, 0);  // was -z, mirrored with the object
}

TEST_F(Obj, exclusion_works_by_object_and_material_and_says_what_it_missed) {
  const auto count = [&](std::vector<std::string> exclude) {
    size_t triangles = 0;
    for (const ShapeData& s : import_mesh(file_, excluding(std::move(exclude))).shapes)
      triangles += s.mesh.triangles.size();
    return triangles;
  };
  EXPECT_EQ(count({}), 5u);
  EXPECT_EQ(count({"slab"}), 2u);
  EXPECT_EQ(count({"matte"}), 3u);
  EXPECT_EQ(count({"la*", "ball"}), 3u);
  EXPECT_EQ(count({"*"}), 0u);
  EXPECT_EQ(message(file_, excluding({"slap"})),
            file_ + ": exclude \"slap\" matches no object, mesh or material (did you mean \"slab\"?)");
}

TEST_F(Obj, textures_of_overridden_materials_are_not_read) {
  std::filesystem::remove(folder_.path("red_over_blue.png"));
  const std::string found = message(file_);
  for (const char* part : {"parts.obj: ", "\"matte\"", "\"red_over_blue.png\" is missing"}) {
    EXPECT_NE(found.find(part), std::string::npos) << found;
  }
  ImportOptions overriding;
  overriding.overridden_materials = {"matte"};
  EXPECT_EQ(message(file_, overriding), "no error");
  EXPECT_EQ(message(file_, excluding({"matte"})), "no error");
}

TEST_F(Obj, masks_come_from_map_d_or_the_alpha_of_map_kd) {
  folder_.png("grey.png", 2, 1, 1, {0, 255});
  folder_.png("rgba.png", 2, 1, 4, {255, 255, 255, 255, 255, 255, 255, 0});
  folder_.write("parts.mtl",
                "newmtl matte\nmap_Kd rgba.png\nmap_d grey.png\nnewmtl shiny\nmap_Kd rgba.png\nnewmtl glow\n"
                "map_Kd red_over_blue.png\n");
  const ImportedFile f = import_mesh(file_, {});
  const Material &both = *f.materials[0], &alpha = *f.materials[1], &opaque = *f.materials[2];
  EXPECT_TRUE(both.masked({0.25f, 0.5f}));
  EXPECT_FALSE(both.masked({0.75f, 0.5f}));
  EXPECT_FALSE(alpha.masked({0.25f, 0.5f}));
  EXPECT_TRUE(alpha.masked({0.75f, 0.5f}));
  EXPECT_EQ(opaque.mask, nullptr);
  EXPECT_EQ(f.textures.size(), 3u);  // each file once
}

TEST_F(Obj, a_missing_material_library_is_noted) {
  std::filesystem::remove(folder_.path("parts.mtl"));
  const ImportedFile f = import_mesh(file_, {});
  ASSERT_FALSE(f.notes.empty());
  EXPECT_EQ(f.notes[0], file_ + ": material library \"parts.mtl\" is missing: its materials are grey");
}

TEST(Import, smooth_normals_round_gentle_edges_and_keep_sharp_ones) {
  // A roof of two quads over the x axis; each rises at the given slope, so the fold is twice that.
  const auto normal_at_ridge = [](float slope) {
    Folder folder;
    const std::string h = std::to_string(-std::tan(slope));
    const std::string file =
        folder.write("roof.obj", "v 0 0 0\nv 1 0 0\nv 0 " + h + " 1\nv 1 " + h + " 1\nv 0 " + h +
                                     " -1\nv 1 " + h + " -1\nf 1 3 4 2\nf 1 2 6 5\n");
    const MeshData mesh = import_mesh(file, {}).shapes[0].mesh;
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
      if (mesh.positions[i] == vec3(0)) return mesh.normals[i];
    }
    return vec3(0);
  };
  EXPECT_LT(length(normal_at_ridge(0.4f) - vec3(0, 1, 0)), 1e-5f);  // a fold of 46 degrees: averaged
  EXPECT_NEAR(normal_at_ridge(0.7f).y, std::cos(0.7f), 1e-5f);      // of 80 degrees: each face its own
}

TEST(Import, ply_is_one_mesh_of_the_default_material) {
  Folder folder;
  const std::string file =
      folder.write("patch.ply",
                   "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                   "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                   "end_header\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n4 0 1 2 3\n");
  const ImportedFile f = import_mesh(file, {});
  ASSERT_EQ(f.shapes.size(), 1u);
  EXPECT_EQ(f.shapes[0].mesh.triangles.size(), 2u);
  ASSERT_EQ(f.materials.size(), 1u);
  EXPECT_EQ(as<LambertMaterial>(f.materials[0]).albedo.value, vec3(0.5f));
}

TEST(Import, bad_files_are_refused_in_one_line) {
  Folder folder;
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const struct {
    std::string file, expected;
  } cases[] = {
      {folder.path("none.obj"), "no such mesh file"},
      {folder.write("empty.obj", ""), "cannot be read as a mesh"},
      {folder.write("noise.ply", "no mesh at all"), "cannot be read as a mesh"},
      {folder.write("endless.ply", ply.substr(0, ply.find("end_header"))), "has no end_header line"},
      {folder.write("cut.ply", ply + "0 0 0\n1 0 0\n0 1 0\n"),
       "face 0 has no vertices (is the file cut short?)"},
      {folder.write("other.glb", obj), "a GLB file starts with"},
      {folder.write("broken.gltf", "{\"asset\":"), "cannot be read as a mesh"},
      {folder.write("short.glb", "glTF"), "cannot be read as a mesh"},
      {folder.write("indices.obj", obj + "f 1 2 9\n"), ""},
      {folder.write("indices.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"),
       "uses vertex 7, but there are 3 vertices"},
      {folder.write("nan.obj", "v 0 nan 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "expected finite coordinates"},
      {folder.write("nan.ply", ply + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), "expected finite coordinates"},
      {folder.write("mesh.fbx", "x"), "expected .obj, .ply, .gltf or .glb"},
  };
  for (const auto& c : cases) {
    const std::string found = message(c.file);
    EXPECT_EQ(found.find(c.file + ": "), 0u) << found;
    EXPECT_NE(found.find(c.expected), std::string::npos) << found;
    EXPECT_EQ(found.find('\n'), std::string::npos) << found;
  }
}
