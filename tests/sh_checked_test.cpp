/// Checked entry points of the basis: what is refused, and with which words.

#include "sh/checked.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace zonal {
namespace {

using sh::Vec3;

TEST(sh_checked, says_what_is_wrong_and_what_is_valid) {
  float Y[9];
  Vec3<float> g[9];
  auto message = [](auto&& f) -> std::string {
    try {
      f();
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message([&] {
              sh::checked::evaluate(0, Vec3<float>{0, 0, 1}, Y);
            }),
            "bands is 0, must be 1 to 101");
  EXPECT_EQ(message([&] {
              sh::checked::evaluate(102, Vec3<float>{0, 0, 1}, Y);
            }),
            "bands is 102, must be 1 to 101");
  EXPECT_NE(message([&] {
              sh::checked::evaluate_gradient(3, Vec3<float>{0, 0, 0}, Y, g);
            }).find("not zero"),
            std::string::npos);
  EXPECT_NE(message([&] {
              sh::checked::evaluate(3, Vec3<float>{NAN, 0, 0}, Y);
            }).find("nan"),
            std::string::npos);
  EXPECT_EQ(message([&] { sh::checked::evaluate(3, Vec3<float>{0, 0, 1e-30f}, Y); }), "");
  EXPECT_FLOAT_EQ(Y[2], float(std::sqrt(3 / (4 * std::numbers::pi))));
}

}  // namespace
}  // namespace zonal
