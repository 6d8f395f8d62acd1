#pragma once
/// Tells changed content from unchanged: keys of caches and of cells. Not a protection against forgery.
///
///     Hash hash;
///     hash.add(file_bytes);
///     std::string key = hash.text();   // 16 hexadecimal digits

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace zonal {

/// FNV-1a, 64 bits (Fowler, Noll, Vo).
class Hash {
 public:
  void add(std::string_view bytes) {
    for (const unsigned char byte : bytes) value_ = (value_ ^ byte) * 0x100000001b3u;
    value_ = (value_ ^ bytes.size()) * 0x100000001b3u;  // "ab" + "c" is not "a" + "bc"
  }
  uint64_t value() const { return value_; }
  std::string text() const { return fmt::format("{:016x}", value_); }

 private:
  uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace zonal
