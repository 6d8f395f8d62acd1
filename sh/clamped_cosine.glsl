// The product with max(0, cos theta) about z, up to 10 bands (Mézières 2022, Eq. 4.6): the integral of Y_l1^m max(0, z)
// Y_l2^m is 0 unless l1 + l2 is even or |l1 - l2| = 1, and the same for m and -m. Light is in the frame of the normal.
// The irradiance is 2 sqrt(pi) c[0] of the product (Eq. 4.4). The table needs GLSL 4.20 for its braces; include sh/basis.glsl
// first, for ShCoefficients.

// Order by order, m = 0..9; for each l1 = m..9 its l2 = l1, l1 + 1, l1 + 2, l1 + 4, l1 + 6, ... up to 9. A test compares
// them with sh/clamped_cosine.cpp.
const float kShClampedCosine[170] = {
    // clang-format off
    // m = 0
    0.25f, 0.288675135f, 0.139754249f, -0.03125f, 0.0140841847f, -0.00805294068f, 0.375f, 0.25819889f,
    0.095470327f, -0.0149597986f, 0.00524078432f, -0.0024576284f, 0.3125f, 0.253546276f, 0.113550327f,
    -0.0251945555f, 0.0117044998f, 0.328125f, 0.251976315f, 0.102831614f, -0.0186793373f, 0.00724002953f,
    0.31640625f, 0.251259454f, 0.109152431f, -0.0231522044f, 0.322265625f, 0.250872603f, 0.10453477f,
    -0.0198534379f, 0.317382812f, 0.250640206f, 0.107748148f, 0.32043457f, 0.250489716f, 0.105185853f,
    0.317764282f, 0.250386698f, 0.319633484f,
    // m = 1
    0.1875f, 0.223606798f, 0.116926793f, -0.0289695253f, 0.013865812f, -0.00824313624f, 0.3125f, 0.239045722f,
    0.0956831931f, -0.016664632f, 0.00623778102f, 0.30078125f, 0.243975018f, 0.108394038f, -0.0237788457f,
    0.0110153541f, 0.31640625f, 0.246182982f, 0.102049613f, -0.0190992258f, 0.311523437f, 0.247363722f,
    0.107116264f, -0.0225426958f, 0.317382812f, 0.248069469f, 0.103950326f, 0.314712524f, 0.248525061f,
    0.106677925f, 0.317764282f, 0.248836301f, 0.316082001f,
    // m = 2
    0.15625f, 0.188982237f, 0.101487352f, -0.0263490968f, 0.0130472551f, 0.2734375f, 0.21821789f,
    0.0906889591f, -0.0167445588f, 0.00653536422f, 0.28125f, 0.230283093f, 0.102685442f, -0.0225985087f,
    0.30078125f, 0.236524958f, 0.0991703907f, -0.0189659321f, 0.301513672f, 0.240192231f, 0.104117254f,
    0.308990479f, 0.242535625f, 0.102136338f, 0.308685303f, 0.24412604f, 0.312530518f,
    // m = 3
    0.13671875f, 0.166666667f, 0.0906889591f, -0.0241686888f, 0.0122265469f, 0.24609375f, 0.201007563f,
    0.085380832f, -0.0163555998f, 0.263183594f, 0.217262047f, 0.097335288f, -0.0215426489f, 0.285644531f,
    0.226455407f, 0.0957568952f, 0.29045105f, 0.232210182f, 0.100863866f, 0.299606323f, 0.236066843f,
    0.301368713f,
    // m = 4
    0.123046875f, 0.150755672f, 0.0826696351f, -0.0223958274f, 0.225585938f, 0.186989398f, 0.0805664063f,
    -0.0158275058f, 0.247558594f, 0.205688338f, 0.0925374782f, 0.271911621f, 0.216930458f, 0.0923271172f,
    0.279632568f, 0.224298011f, 0.290206909f,
    // m = 5
    0.112792969f, 0.138675049f, 0.076432004f, -0.0209378221f, 0.209472656f, 0.175411604f, 0.0763390614f,
    0.234146118f, 0.195538472f, 0.0882816095f, 0.259658813f, 0.208191386f, 0.269477844f,
    // m = 6
    0.104736328f, 0.129099445f, 0.0714086532f, 0.196380615f, 0.165683374f, 0.0726425874f, 0.222564697f,
    0.186627226f, 0.248748779f,
    // m = 7
    0.0981903076f, 0.121267813f, 0.0672539675f, 0.185470581f, 0.157377895f, 0.212472916f,
    // m = 8
    0.0927352905f, 0.114707867f, 0.176197052f,
    // m = 9
    0.088098526f
    // clang-format on
};

// Where order m starts, and how many entries the r last l1 of an order have.
const int kShClampedCosineStart[10] = {0, 39, 72, 99, 121, 138, 151, 160, 166, 169};
const int kShClampedCosineTail[11] = {0, 1, 3, 6, 9, 13, 17, 22, 27, 33, 39};

// The integral, 0 <= m <= l1, l2 < 10.
KERNEL float sh_clamped_cosine(int l1, int l2, int m) {
  int low = l1 < l2 ? l1 : l2;
  int apart = l1 < l2 ? l2 - l1 : l1 - l2;
  if (apart > 1 && apart % 2 == 1) return 0.0f;
  int place = apart < 2 ? apart : apart / 2 + 1;
  return kShClampedCosine[kShClampedCosineStart[m] + kShClampedCosineTail[10 - m] - kShClampedCosineTail[10 - low] +
                          place];
}

// All coefficients below `bands` <= 10; the rest of `product` is 0.
KERNEL void sh_clamped_cosine_product(int bands, ShCoefficients light, OUT(ShCoefficients) product) {
  for (int i = 0; i < 100; ++i) product.c[i] = 0.0f;
  for (int m = 0; m < bands; ++m) {
    int at = kShClampedCosineStart[m];
    for (int l1 = m; l1 < 10; ++l1) {
      for (int l2 = l1; l2 < 10; l2 += l2 == l1 ? 1 : (l2 == l1 + 1 ? 1 : 2)) {
        float value = kShClampedCosine[at];
        at += 1;
        if (l2 >= bands) continue;
        int i = l1 * (l1 + 1);
        int j = l2 * (l2 + 1);
        product.c[i + m] += value * light.c[j + m];
        if (l1 != l2) product.c[j + m] += value * light.c[i + m];
        if (m > 0) {
          product.c[i - m] += value * light.c[j - m];
          if (l1 != l2) product.c[j - m] += value * light.c[i - m];
        }
      }
    }
  }
}
