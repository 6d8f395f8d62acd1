// The frame of a gathering pass: one pixel an invocation, a method's own `vec3 gathered(Point p, ivec2 at, int first, int end)`
// adds up the radiance that lights [first, end) of the chunk bound send to the camera by way of the point.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 1, rgba32f) uniform image2D sum;
uniform ivec2 size;
uniform ivec2 range;  // first light and one past the last

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, size))) return;
  Point p = point_read(at);
  if (!point_gathers(p)) return;
  imageStore(sum, at, imageLoad(sum, at) + vec4(gathered(p, at, range.x, range.y), 0.0));
}
