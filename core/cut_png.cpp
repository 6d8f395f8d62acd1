#include "core/cut_png.h"

#include <cstdint>
#include <string_view>

#include "core/error.h"

namespace zonal {

void refuse_cut_png(std::istream& in, const std::string& name) {
  unsigned char head[8] = {};
  in.read(reinterpret_cast<char*>(head), 8);
  if (!in || std::string_view(reinterpret_cast<char*>(head), 4) != "\x89PNG") return;
  // A chunk: length (4 bytes, big-endian), type (4), data, checksum (4).
  while (in.read(reinterpret_cast<char*>(head), 8)) {
    if (std::string_view(reinterpret_cast<char*>(head) + 4, 4) == "IEND") return;
    const uint32_t length = uint32_t(head[0]) << 24 | head[1] << 16 | head[2] << 8 | head[3];
    in.seekg(std::streamoff(length) + 4, std::ios::cur);
  }
  throw SceneError(name + ": cannot be read as a picture: the PNG file is cut short");
}

}  // namespace zonal
