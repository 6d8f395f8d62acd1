#pragma once
/// What `zonal verify` tolerates, a row a quantity. docs/verify.md prints this table and derives the numbers.

#include <span>

namespace zonal {

/// What a tolerance is multiplied with.
enum class Unit {
  kAbsolute,  ///< 1
  kLargest,   ///< the largest |truth| of the array it stands in: relative in the sense of the maximum norm
};

/// How an element of the array is named in a report.
enum class Layout { kPlain, kCoefficients, kCoefficientGradients };

struct Tolerance {
  const char* kind;      ///< of file
  const char* quantity;  ///< the file's key
  double in_float, in_double;
  Unit unit = Unit::kLargest;
  const char* condition = "";  ///< what is added for ill-conditioned inputs; "" nothing
  Layout layout = Layout::kPlain;
};

std::span<const Tolerance> tolerances();
const Tolerance& tolerance_of(const char* kind, const char* quantity);

}  // namespace zonal
