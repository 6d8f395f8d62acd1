// Reads a .shmat file from an array of 32-bit words, as it lies in a GPU buffer: the shader's side of
// ShMaterial::look_up. docs/shmat.md has the layout.
//
// Needs sh/angle.glsl before it. Who includes this defines SHMAT_WORD(i), the i-th word of the buffer. Files may lie one
// after the other: `base` is the word where one starts.
//
//     ShmatTable table = shmat_open(base);
//     ShmatPlace place = shmat_find(table, 1, w_out);                          // 0: F, 1: F'
//     vec3 c = shmat_coefficient(table, place, shmat_index(table, l, m));      // in the view frame

struct ShmatTable {
  uint rows;       // first row word
  uint data;       // first word of coefficients
  uint azimuths;
  uint half_floats;  // 1: two coefficients a word
  uint mirrored;     // 1: only m >= 0 is stored
};

// The rows around a direction, and their weights; unused ones have weight 0.
struct ShmatPlace {
  uint word[4];
  float weight[4];
};

KERNEL ShmatTable shmat_open(uint base) {
  ShmatTable t;
  uint flags = SHMAT_WORD(base + 6u);
  t.azimuths = SHMAT_WORD(base + 7u);
  t.rows = base + SHMAT_WORD(base + 10u) / 4u;
  t.data = base + SHMAT_WORD(base + 12u) / 4u;
  t.half_floats = flags & 1u;
  t.mirrored = (flags >> 1) & 1u;
  return t;
}

// Where coefficient (l, m) lies in a row.
KERNEL uint shmat_index(ShmatTable t, int l, int m) {
  return uint((t.mirrored == 1u ? l * (l + 1) / 2 : l * (l + 1)) + m);
}

KERNEL uint shmat_row(ShmatTable t, uint table, uint azimuth, uint elevation) {
  return SHMAT_WORD(t.rows + (table * t.azimuths + azimuth) * 91u + elevation);
}

// w_out: unit, shading frame, z > 0. Elevations are 0, 1, ... 89, 89.5 degrees; beyond, the last row.
KERNEL ShmatPlace shmat_find(ShmatTable t, uint table, vec3 w_out) {
  float r2 = w_out.x * w_out.x + w_out.y * w_out.y;
  float angle = upper_angle(sqrt(r2), w_out.z) * 57.2957795f;
  uint low = 90u;
  float s = 0.0f;
  if (angle < 89.5f) {
    low = min(uint(angle), 89u);
    s = (angle - float(low)) * (low == 89u ? 2.0f : 1.0f);
  }
  uint high = min(low + 1u, 90u);
  uint first = 0u;
  float a = 0.0f;
  if (t.azimuths > 1u && r2 > 1e-12f) {
    float turn = upper_angle(abs(w_out.y), w_out.x) * 0.159154943f;  // 1/2pi
    turn = (w_out.y < 0.0f ? 1.0f - turn : turn) * float(t.azimuths);
    first = min(uint(turn), t.azimuths - 1u);
    a = turn - float(first);
  }
  uint second = first + 1u == t.azimuths ? 0u : first + 1u;
  ShmatPlace p;
  p.word[0] = shmat_row(t, table, first, low);
  p.word[1] = shmat_row(t, table, first, high);
  p.word[2] = shmat_row(t, table, second, low);
  p.word[3] = shmat_row(t, table, second, high);
  p.weight[0] = (1.0f - a) * (1.0f - s);
  p.weight[1] = (1.0f - a) * s;
  p.weight[2] = a * (1.0f - s);
  p.weight[3] = a * s;
  return p;
}

// Bands of the row with the most.
KERNEL int shmat_bands(ShmatPlace p) {
  uint most = 0u;
  for (int k = 0; k < 4; ++k) {
    if (p.weight[k] > 0.0f) most = max(most, p.word[k] & 255u);
  }
  return int(most);
}

// Coefficient `index` of red, green and blue; 0 beyond a row's bands.
KERNEL vec3 shmat_coefficient(ShmatTable t, ShmatPlace p, uint index) {
  vec3 sum = vec3(0.0f, 0.0f, 0.0f);
  for (int k = 0; k < 4; ++k) {
    uint bands = p.word[k] & 255u;
    uint count = t.mirrored == 1u ? bands * (bands + 1u) / 2u : bands * bands;
    if (p.weight[k] > 0.0f && index < count) {
      vec3 c;
      for (int channel = 0; channel < 3; ++channel) {
        uint at = uint(channel) * count + index;
        uint start = t.data + (p.word[k] >> 8);
        if (t.half_floats == 1u) {
          vec2 pair = unpackHalf2x16(SHMAT_WORD(start + at / 2u));
          c[channel] = (at & 1u) == 0u ? pair.x : pair.y;
        } else {
          c[channel] = uintBitsToFloat(SHMAT_WORD(start + at));
        }
      }
      sum = sum + p.weight[k] * c;
    }
  }
  return sum;
}
