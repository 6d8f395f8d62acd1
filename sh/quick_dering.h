#pragma once
/// Deringing by samples, for every shaded point: what sh::dering finds by search, in one sweep over fixed
/// directions.
///
///     const sh::QuickDering quick(5);
///     quick.apply(L);                       // L[c * 25 + i], three colours, each by its own strength
///
/// Between a function f cut to N bands and the same under positive_weights, g, lies (1 - s) f + s g: where f
/// is negative and g is not, s = -f/(g - f) lifts it to 0, and the largest s of all directions lifts all of
/// it. Directions lie an eighth of the last band's wavelength apart, so that what is between them is lower by
/// 1 - cos(pi/8) = 8 % of the ringing at most: s is taken 8 % larger.

#include <vector>

#include "sh/basis.h"

namespace zonal::sh {

class QuickDering {
 public:
  explicit QuickDering(int bands);
  /// Three functions in place, coefficients[c * count(bands) + i]. strength, where it is not null: of each,
  /// [0, 1].
  void apply(float* coefficients, float* strength = nullptr) const;

 private:
  int bands_, directions_;
  std::vector<float> positive_;  ///< weights by band
  std::vector<float> basis_;     ///< [i * directions + k]
};

}  // namespace zonal::sh
