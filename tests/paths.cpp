#include "tests/paths.h"

namespace zonal::test {

std::string source_dir() {
  return ZONAL_SOURCE_DIR;
}
std::string program() {
  return ZONAL_PROGRAM;
}

}  // namespace zonal::test
