#include "apps/verify_tolerances.h"

#include <fmt/format.h>

#include <cassert>
#include <string>
#include <string_view>

#include "apps/verify.h"

namespace zonal {
namespace {

constexpr Unit kAbsolute = Unit::kAbsolute, kLargest = Unit::kLargest;
constexpr Layout kPlain = Layout::kPlain, kCoefficients = Layout::kCoefficients,
                 kGradients = Layout::kCoefficientGradients;

/// docs/verify.md derives each number.
constexpr Tolerance kTolerances[] = {
    {"sh_basis", "Y", 3e-6, 1e-13, kAbsolute, "", kCoefficients},
    {"sh_basis", "d/|d|", 1.2e-7, 2.3e-16, kAbsolute},
    {"sh_basis", "high", 3e-4, 1e-11, kAbsolute},
    {"sh_gradient", "grad", 3e-6, 1e-13, kLargest, "", kGradients},
    {"rotation", "rotated", 3e-6, 1e-13, kLargest, "", kCoefficients},
    {"rotation", "rotated by zxzxz", 3e-6, 1e-13, kLargest, "", kCoefficients},
    {"rotation", "rotated back", 3e-6, 1e-13, kLargest, "", kCoefficients},
    {"rotation", "zonal_rotated_of_unit", 3e-6, 1e-13, kLargest, "", kCoefficients},
};

}  // namespace

std::span<const Tolerance> tolerances() {
  return kTolerances;
}

const Tolerance& tolerance_of(const char* kind, const char* quantity) {
  for (const Tolerance& row : kTolerances)
    if (std::string_view(row.kind) == kind && std::string_view(row.quantity) == quantity) return row;
  assert(false);
  return kTolerances[0];
}

std::string tolerance_table() {
  std::string text = "| kind | quantity | float | double | times | plus |\n|---|---|---|---|---|---|\n";
  for (const Tolerance& row : kTolerances) {
    text += fmt::format("| `{}` | {} | {:.0e} | {:.0e} | {} | {} |\n", row.kind, row.quantity, row.in_float,
                        row.in_double, row.unit == kAbsolute ? "1" : "the largest value of the case",
                        *row.condition ? row.condition : "-");
  }
  return text;
}

}  // namespace zonal
