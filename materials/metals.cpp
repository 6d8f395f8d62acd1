/// Complex indices of refraction n + i k of metals, linearly interpolated in published tables at 630, 550 and
/// 465 nm.
///
/// Three wavelengths stand for the three channels: near the dominant wavelengths of Rec. 709's green and blue
/// primaries (549, 464 nm), and 630 nm rather than 611 nm for red, where copper's and gold's steep edge would
/// otherwise darken a channel that reaches to 680 nm. Against a spectral rendering, reflectances are off by a
/// few hundredths.
///
/// Sources (tables as collected by refractiveindex.info, which is in the public domain, CC0):
/// - copper, gold, silver: Johnson and Christy, Phys. Rev. B 6, 4370 (1972)
/// - chromium, cobalt, iron, nickel, palladium, titanium: Johnson and Christy, Phys. Rev. B 9, 5056 (1974)
/// - aluminium: Rakic, Appl. Opt. 34, 4755 (1995)
/// - platinum: Rakic et al., Appl. Opt. 37, 5271 (1998), Lorentz-Drude fit
/// - tungsten: Weaver, Olson and Lynch, Phys. Rev. B 12, 1293 (1975)
/// - brass (70 % Cu, 30 % Zn): Querry, report CRDC-CR-85034 (1985)

#include "materials/material.h"

namespace zonal {

const std::vector<Metal>& metals() {
  static const std::vector<Metal> table = {
      {"aluminium", {1.430f, 1.015f, 0.686f}, {7.508f, 6.627f, 5.635f}},
      {"aluminum", {1.430f, 1.015f, 0.686f}, {7.508f, 6.627f, 5.635f}},
      {"brass", {0.445f, 0.527f, 0.947f}, {3.522f, 2.765f, 1.920f}},
      {"chromium", {3.145f, 3.181f, 2.456f}, {3.312f, 3.329f, 3.210f}},
      {"cobalt", {2.209f, 2.052f, 1.789f}, {4.160f, 3.824f, 3.371f}},
      {"copper", {0.275f, 1.007f, 1.247f}, {3.373f, 2.582f, 2.456f}},
      {"gold", {0.188f, 0.424f, 1.332f}, {3.403f, 2.472f, 1.869f}},
      {"iron", {2.892f, 2.950f, 2.646f}, {3.065f, 2.932f, 2.805f}},
      {"nickel", {1.990f, 1.921f, 1.765f}, {4.094f, 3.616f, 3.048f}},
      {"palladium", {1.765f, 1.641f, 1.445f}, {4.275f, 3.845f, 3.351f}},
      {"platinum", {2.310f, 2.091f, 1.887f}, {4.147f, 3.704f, 3.224f}},
      {"silver", {0.057f, 0.060f, 0.047f}, {4.254f, 3.597f, 2.803f}},
      {"titanium", {2.698f, 2.542f, 2.305f}, {3.757f, 3.435f, 3.082f}},
      {"tungsten", {3.617f, 3.522f, 3.325f}, {2.910f, 2.741f, 2.574f}},
  };
  return table;
}

}  // namespace zonal
