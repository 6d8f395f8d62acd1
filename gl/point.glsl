// What a pixel sees, made ready to gather light: layers of one picture, written by gl/points.comp. Needs gl/brdf.glsl before
// it.

const int POINT_LAYERS = 13;

struct Point {
  vec3 position;  // metres, world
  float depth;    // along the camera's ray; 0: the sky
  vec3 normal;    // geometric, on the camera's side
  vec3 x;         // shading frame, world
  vec3 y;
  vec3 z;
  vec3 emitted;   // towards the camera
  Brdf brdf;      // seen from the camera
  int kind;       // BsdfKind
  vec3 albedo;    // of the diffuse part
  float kept;     // what the coat reflects towards the camera
  vec3 specular;  // the material's
  int material;
  int shape;      // which shape, and which of its triangles
  int primitive;
};

// Whether light can be gathered there.
bool point_gathers(Point p) {
  return p.depth > 0.0 && p.kind != 0 && p.brdf.o.z > BRDF_MIN_COSINE;
}

#ifdef POINT_WRITE
layout(binding = 0, rgba32f) uniform writeonly image2DArray point_layers;
void point_put(ivec2 at, int layer, vec3 a, float b) {
  imageStore(point_layers, ivec3(at, layer), vec4(a, b));
}
void point_write(ivec2 at, Point p) {
  point_put(at, 0, p.position, p.depth);
  point_put(at, 1, p.normal, float(p.kind));
  point_put(at, 2, p.x, p.kept);
  point_put(at, 3, p.z, float(p.material));
  point_put(at, 4, p.emitted, float(p.shape));
  point_put(at, 5, p.albedo, float(p.primitive));
  point_put(at, 6, p.specular, 0.0);
  point_put(at, 7, p.brdf.o, float(p.brdf.kind));
  point_put(at, 8, vec3(p.brdf.alpha, p.brdf.stretch), float(p.brdf.coat));
  point_put(at, 9, p.brdf.f, p.brdf.exponent);
  point_put(at, 10, p.brdf.k, p.brdf.aspect);
  point_put(at, 11, p.brdf.tint, p.brdf.specular);
  point_put(at, 12, p.brdf.base, 0.0);
}
#else
layout(binding = 9) uniform sampler2DArray points;
vec4 point_get(ivec2 at, int layer) {
  return texelFetch(points, ivec3(at, layer), 0);
}
Point point_read(ivec2 at) {
  Point p;
  vec4 t = point_get(at, 0);
  p.position = t.xyz;
  p.depth = t.w;
  t = point_get(at, 1);
  p.normal = t.xyz;
  p.kind = int(t.w);
  t = point_get(at, 2);
  p.x = t.xyz;
  p.kept = t.w;
  t = point_get(at, 3);
  p.z = t.xyz;
  p.material = int(t.w);
  p.y = cross(p.z, p.x);
  t = point_get(at, 4);
  p.emitted = t.xyz;
  p.shape = int(t.w);
  t = point_get(at, 5);
  p.albedo = t.xyz;
  p.primitive = int(t.w);
  p.specular = point_get(at, 6).xyz;
  p.brdf = brdf_unpack(point_get(at, 7), point_get(at, 8), point_get(at, 9), point_get(at, 10), point_get(at, 11),
                       point_get(at, 12));
  return p;
}
#endif
