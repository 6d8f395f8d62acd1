#pragma once
/// Compares golden-vector files with the spherical harmonics of this build, in float and in double.
///
///     Verdict verdict = verify_file("tests/golden/sh_basis.json");   // SceneError: not such a file
///     if (!verdict.passed()) fmt::print("{}\n", one_line(verdict));
///
/// The double path is compared with the file. The float path gets the inputs rounded to float and is compared
/// with the double path *at the rounded inputs*, so that what is measured is the library and not the rounding
/// of the inputs. Tolerances: verify_tolerances.h, printed in docs/verify.md.

#include <string>
#include <vector>

namespace zonal {

/// The worst deviation of one quantity ("Y", "grad_x"), where worst means the largest share of its tolerance.
struct Deviation {
  std::string quantity;
  std::string place;    ///< `case 13 "random" Y(20,-3)`
  double absolute = 0;  ///< |got - truth|
  double relative = 0;  ///< absolute / the largest |truth| among the values it was compared with
  double allowed = 0;   ///< tolerance of `absolute` there
  double share = -1;    ///< absolute / allowed; infinite when a result is not finite
  size_t values = 0;    ///< numbers compared
};

struct Verdict {
  std::string file, kind;
  size_t cases = 0;
  std::vector<Deviation> in_float, in_double;  ///< one a quantity
  bool passed() const;
};

/// Throws SceneError when the file is missing, malformed or of no known kind.
Verdict verify_file(const std::string& file);

/// `FILE: ok, ...`: the worst of either precision.
std::string one_line(const Verdict& verdict);
/// A line a quantity and precision, indented.
std::string details(const Verdict& verdict);

/// The tolerances as the Markdown table of docs/verify.md.
std::string tolerance_table();

}  // namespace zonal
