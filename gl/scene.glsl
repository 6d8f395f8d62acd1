// A scene as gl/scene_buffers.cpp lays it out, and the look-ups in it.

layout(binding = 0) uniform samplerBuffer vertices;    // position and u; normal and v
layout(binding = 1) uniform usamplerBuffer triangles;  // three vertices and the shape
layout(binding = 2) uniform samplerBuffer shapes;      // four texels each
layout(binding = 3) uniform usamplerBuffer spheres;    // the shapes that are spheres
layout(binding = 4) uniform samplerBuffer materials;   // eight texels each
layout(binding = 5) uniform samplerBuffer texels;      // of all textures
layout(binding = 6) uniform usamplerBuffer textures;   // first texel, width, height, unused

const uint SHAPE_NORMALS = 1u;
const uint SHAPE_UVS = 2u;
const uint SHAPE_TANGENTS = 4u;
const uint SHAPE_MASK = 8u;

struct Shape {
  vec3 center;
  float radius;  // > 0: a sphere
  int material;
  uint flags;
  int first_triangle;
};

Shape shape_at(int i) {
  vec4 a = texelFetch(shapes, 4 * i);
  vec4 b = texelFetch(shapes, 4 * i + 1);
  return Shape(a.xyz, a.w, int(b.x), uint(b.y), int(b.z));
}

uvec4 triangle_at(int i) {
  return uvec4(texelFetch(triangles, 4 * i).x, texelFetch(triangles, 4 * i + 1).x, texelFetch(triangles, 4 * i + 2).x,
               texelFetch(triangles, 4 * i + 3).x);
}

struct Vertex {
  vec3 position;
  vec3 normal;
  vec2 uv;
};
Vertex vertex_at(uint i) {
  vec4 a = texelFetch(vertices, 2 * int(i));
  vec4 b = texelFetch(vertices, 2 * int(i) + 1);
  return Vertex(a.xyz, b.xyz, vec2(a.w, b.w));
}

// Bilinear and repeating, v up: Texture::sample of core/texture.cpp.
vec4 texture_at(int number, vec2 uv) {
  int start = int(texelFetch(textures, 4 * number).x);
  int width = int(texelFetch(textures, 4 * number + 1).x);
  int height = int(texelFetch(textures, 4 * number + 2).x);
  vec2 place = uv - floor(uv);
  float x = place.x * float(width) - 0.5;
  float y = (1.0 - place.y) * float(height) - 0.5;
  float left = floor(x);
  float top = floor(y);
  int x0 = int(left) < 0 ? width - 1 : min(int(left), width - 1);
  int y0 = int(top) < 0 ? height - 1 : min(int(top), height - 1);
  int x1 = x0 + 1 < width ? x0 + 1 : 0;
  int y1 = y0 + 1 < height ? y0 + 1 : 0;
  vec4 upper = mix(texelFetch(texels, start + y0 * width + x0), texelFetch(texels, start + y0 * width + x1), x - left);
  vec4 lower = mix(texelFetch(texels, start + y1 * width + x0), texelFetch(texels, start + y1 * width + x1), x - left);
  return mix(upper, lower, y - top);
}

// Whether a material is cut away there.
bool masked(int material, vec2 uv) {
  int mask = int(texelFetch(materials, 8 * material + 7).x);
  int channel = int(texelFetch(materials, 8 * material + 4).w);
  return texture_at(mask, uv)[channel] < texelFetch(materials, 8 * material + 3).w;
}
