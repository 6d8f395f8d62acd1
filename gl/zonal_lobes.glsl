// A point's diffuse part and zonal lobe, from the tables behind zonal_brdf (materials/zonal_lobes.cpp). Needs gl/point.glsl and
// materials/zonal_lobes.glsl before it; BANDS is a constant.

layout(binding = 12) uniform samplerBuffer lobe_rows;  // GGX, then Blinn-Phong: [56 widths][64 cosines][67] floats
uniform float window[64];

struct ZonalReceiver {
  vec3 diffuse;   // 1/sr
  vec3 axis;      // unit, world
  vec3 specular;
  ZonalLobe lobe;
};

float lobe_value(int at) {
  return texelFetch(lobe_rows, at / 4)[at & 3];
}

ZonalReceiver zonal_receiver(Point p) {
  ZonalReceiver z;
  for (int l = 0; l < BANDS; ++l) z.lobe.weight[l] = 0.0;
  z.axis = p.z;
  z.specular = vec3(0.0);
  z.diffuse = p.kind == 3 ? vec3(0.0) : p.albedo * (0.318309886 * (1.0 - p.kept));
  bool ggx = p.kind != 2;
  if (p.kind == 1 || (!ggx && p.specular == vec3(0.0))) return z;

  // Linear between nodes even in the fourth roots of width and cosine.
  float alpha = ggx ? p.brdf.alpha.x : sqrt(2.0 / (p.brdf.exponent + 2.0));
  float x = (sqrt(sqrt(alpha)) - 0.1) * (55.0 / 0.9);
  float y = sqrt(sqrt(min(p.brdf.o.z, 1.0))) * 63.0;
  int i = clamp(int(x), 0, 54);
  int j = clamp(int(y), 0, 62);
  float u = clamp(x - float(i), 0.0, 1.0);
  float v = clamp(y - float(j), 0.0, 1.0);
  int start = ((ggx ? 0 : 56 * 64) + i * 64 + j) * 67;
  int places[4] = int[4](start, start + 67, start + 64 * 67, start + 65 * 67);
  float weights[4] = float[4]((1.0 - u) * (1.0 - v), (1.0 - u) * v, u * (1.0 - v), u * v);
  float albedo = 0.0;
  float angle = 0.0;
  float root = 0.0;
  for (int k = 0; k < 4; ++k) {
    albedo += weights[k] * lobe_value(places[k]);
    angle += weights[k] * lobe_value(places[k] + 1);
    root += weights[k] * lobe_value(places[k] + 2);
  }
  float cosine = min(root * root * root * root, 1.0);
  for (int k = 0; k < 4; ++k) {
    for (int l = 0; l < BANDS; ++l) {
      // sqrt((2l+1)/4pi) turns gains into zonal coefficients (sh/zonal.h).
      float to_gain = 0.282094792 * sqrt(2.0 * float(l) + 1.0) * window[l];
      z.lobe.weight[l] += weights[k] * lobe_value(places[k] + 3 + l) / cosine * to_gain;
    }
  }
  vec3 o = p.brdf.o;
  float sine_out = length(o.xy);
  vec3 axis = vec3(0.0, 0.0, 1.0);
  if (sine_out > 0.0) {
    float turn = -sqrt(max((1.0 - cosine) * (1.0 + cosine), 0.0)) / sine_out;
    axis = vec3(turn * o.xy, cosine);
  }
  z.axis = p.x * axis.x + p.y * axis.y + p.z * axis.z;

  // Fresnel's mean over the lobe.
  float middle = 1.0 - angle;
  if (p.kind == 3) {
    z.specular = p.specular * vec3(brdf_conductor(middle, p.brdf.f.x, p.brdf.k.x), brdf_conductor(middle, p.brdf.f.y, p.brdf.k.y),
                                   brdf_conductor(middle, p.brdf.f.z, p.brdf.k.z));
  } else if (p.kind == 4) {
    z.specular = p.specular * min(p.kept / albedo, 1.0);
  } else if (p.kind == 5) {
    z.specular = p.specular + (1.0 - p.specular) * brdf_schlick_weight(middle);
  } else {
    z.specular = p.specular;
  }
  return z;
}
