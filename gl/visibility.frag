// Which triangle a pixel sees: its number and one, so that 0 is the sky.
#include "gl/scene.glsl"

in vec2 uv;
flat in int triangle;
layout(location = 0) out uint seen;

void main() {
  Shape shape = shape_at(int(texelFetch(triangles, 4 * triangle + 3).x));
  if ((shape.flags & SHAPE_MASK) != 0u && masked(shape.material, uv)) discard;
  seen = uint(triangle) + 1u;
}
