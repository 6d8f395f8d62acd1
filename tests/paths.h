#pragma once
/// Where the tests find what is not compiled into them. One file alone knows the folders, so that a checkout
/// in another place compiles the same texts with the same options: compiler caches then serve both.
///
///     std::ifstream file(test::source_dir() + "/tests/golden/ssim.json");

#include <string>

namespace zonal::test {

std::string source_dir();  ///< the checkout, without a slash at its end
std::string program();     ///< the `zonal` command of this build

}  // namespace zonal::test
