// Every triangle of the scene, drawn without vertex arrays.
#include "gl/scene.glsl"

uniform mat4 projection;  // world to clip space
out vec2 uv;
flat out int triangle;

void main() {
  triangle = gl_VertexID / 3;
  Vertex v = vertex_at(texelFetch(triangles, 4 * triangle + gl_VertexID % 3).x);
  uv = v.uv;
  gl_Position = projection * vec4(v.position, 1.0);
}
