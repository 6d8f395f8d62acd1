#include "apps/verify_tolerances.h"

#include <fmt/format.h>

#include <cassert>
#include <string>
#include <string_view>

#include "apps/verify.h"

namespace zonal {
namespace {

constexpr Unit kAbsolute = Unit::kAbsolute, kLargest = Unit::kLargest;
constexpr Layout kCoefficients = Layout::kCoefficients, kGradients = Layout::kCoefficientGradients;

/// docs/verify.md derives each number.
constexpr Tolerance kTolerances[] = {
    {"sh_basis", "Y", 3e-6, 1e-13, kAbsolute, "", kCoefficients},
    {"sh_basis", "unit d", 2.4e-7, 4.4e-16, kAbsolute},
    {"sh_basis", "high", 3e-4, 1e-11, kAbsolute},
    {"sh_gradient", "grad", 3e-6, 1e-13, kLargest, "", kGradients},
    {"zh_sphere", "zh", 2e-6, 1e-12},
    {"zh_sphere", "dzh_dd", 2e-6, 1e-12},
    {"zh_sphere", "coeffs", 2e-6, 1e-12, kLargest, "", kCoefficients},
    {"zh_sphere", "grad_x", 2e-6, 1e-12, kLargest, "", kGradients},
    {"polygon_sh", "coeffs", 2e-6, 1e-12, kLargest, "", kCoefficients},
    {"polygon_sh", "grad_x_coeffs", 2e-6, 1e-12, kLargest, "4δ ℓ/h of the largest", kGradients},
    {"polygon_sh", "signed_solid_angle", 2e-6, 1e-12},
    {"polygon_sh", "grad_x_signed_solid_angle", 2e-6, 1e-12, kLargest, "2δ Σ (1/ℓᵢ + 1/ℓⱼ)(1 + tan²(T/2))"},
    {"products", "product_truncated", 3e-6, 1e-13, kLargest, "2ε‖a‖‖b‖", kCoefficients},
    {"products", "product_full", 3e-6, 1e-13, kLargest, "2ε‖a‖‖b‖", kCoefficients},
    {"products", "double_product", 3e-6, 1e-13, kLargest, "√n ε‖a‖‖b‖"},
    {"products", "triple_entries", 1e-6, 1e-13},
    {"products", "clamped_cosine", 1e-6, 1e-13},
    {"products", "triple_nonzero_count_by_bands", 0, 0},
    {"products", "triple_unique_sorted_count_by_bands", 0, 0},
    {"products", "clamped_cosine_nonzero_count_by_bands", 0, 0},
    {"ggx_zh", "ndf", 2e-6, 1e-12},
    {"ggx_zh", "ndf_cos", 2e-6, 1e-12},
    {"ggx_zh", "reflect_normal_incidence", 2e-6, 1e-12},
    {"yuksel", "attenuation", 5e-7, 4e-15},
    {"yuksel", "grad_x", 5e-7, 4e-15},
    {"yuksel", "inv_sq", 5e-7, 4e-15},
    {"yuksel", "grad_x_inv_sq", 5e-7, 4e-15},
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
    text += fmt::format("| `{}` | {} | {:.2g} | {:.2g} | {} | {} |\n", row.kind, row.quantity, row.in_float,
                        row.in_double, row.unit == kAbsolute ? "1" : "largest",
                        *row.condition ? row.condition : "-");
  }
  return text;
}

}  // namespace zonal
