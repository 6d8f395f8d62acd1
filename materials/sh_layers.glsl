// How the three scalar tables of a reflection model (materials/sh_layers.h) make up a point's colours.

// Colour = a x + b y + c z of the stored channels. `kind` is a BsdfKind: 2 blinn_phong, 4 coated, 5
// metallic_roughness, others (conductor) one stored channel a colour channel.
KERNEL void sh_layer_weights(int kind, vec3 specular, vec3 diffuse, OUT(vec3) a, OUT(vec3) b, OUT(vec3) c) {
  a = vec3(specular.x, 0.0f, 0.0f);
  b = vec3(0.0f, specular.y, 0.0f);
  c = vec3(0.0f, 0.0f, specular.z);
  if (kind == 2) {
    a = specular;
    b = diffuse;
    c = vec3(0.0f);
  } else if (kind == 4) {
    a = specular - diffuse;
    b = diffuse;
    c = vec3(0.0f);
  } else if (kind == 5) {
    a = vec3(1.0f) - specular - diffuse;
    b = specular;
    c = diffuse;
  }
}

// Where a point of these GGX widths lies among `levels` levels of roughness, even from `first` on by `step`:
// [0, levels - 1].
KERNEL float sh_layer_place(vec2 alpha, float first, float step, float levels) {
  float roughness = sqrt(sqrt(alpha.x * alpha.y));
  return clamp((roughness - first) / step, 0.0f, levels - 1.0f);
}
