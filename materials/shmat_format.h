#pragma once
/// The bytes of a `.shmat` file, for its writer and its reader; docs/shmat.md explains them. Little-endian.

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "materials/sh_material.h"

namespace zonal::shmat {

inline constexpr char kMagic[8] = {'S', 'H', 'M', 'A', 'T', '\r', '\n', '\x1a'};
inline constexpr uint32_t kVersion = 1;
inline constexpr uint32_t kHalf = 1, kMirrored = 2;  ///< flags
inline constexpr int kMaxAzimuths = 360;
inline constexpr size_t kMaxText = 4096;             ///< of the name, and of the source
inline constexpr uint32_t kMaxDataWords = 1u << 24;  ///< what 24 bits of a row word reach

struct Header {
  char magic[8];
  uint32_t version;
  uint32_t checksum;  ///< CRC-32C of the whole file, these four bytes taken as zero
  uint64_t file_bytes;
  uint32_t flags;
  uint32_t azimuths;
  uint32_t elevations;   ///< 91
  uint32_t max_bands;    ///< of all rows
  uint32_t rows_offset;  ///< bytes from the start of the file, as the next two
  uint32_t shares_offset;
  uint32_t data_offset;
  uint32_t data_words;  ///< 4 bytes each
  float albedo[3];
  float asymmetry;
  uint16_t name_bytes, source_bytes;
  uint32_t text_offset;  ///< name, then source, UTF-8 without a final zero
};
static_assert(sizeof(Header) == 80);

/// Where everything lies follows from three numbers; the offsets in the header repeat it for other readers.
struct Layout {
  size_t rows, text, row_words, shares, data;
  Layout(uint32_t azimuths, size_t text_bytes)
      : rows(size_t{2} * azimuths * ShMaterial::kElevations),
        text(sizeof(Header)),
        row_words((text + text_bytes + 3) / 4 * 4),
        shares(row_words + 4 * rows),
        data((shares + 2 * rows + 15) / 16 * 16) {}
};

/// A row word: bands in the low 8 bits, where its coefficients start, in words from data_offset, in the
/// upper 24.
constexpr uint32_t row_word(int bands, uint32_t offset) {
  return uint32_t(bands) | offset << 8;
}
constexpr int row_bands(uint32_t word) {
  return int(word & 255);
}
constexpr uint32_t row_offset(uint32_t word) {
  return word >> 8;
}
/// Words that a row takes: three channels one after the other, an odd number of halves padded by one.
constexpr uint32_t row_words(int bands, bool mirrored, bool half) {
  const uint32_t n = 3 * uint32_t(sh_count(bands, mirrored));
  return half ? (n + 1) / 2 : n;
}

/// CRC-32C (Castagnoli), continuing from `crc` (0 at the start).
uint32_t crc32c(const void* bytes, size_t size, uint32_t crc = 0);
/// Of a whole file, its checksum field taken as zero.
uint32_t file_checksum(const std::byte* bytes, size_t size);

/// IEEE 754 half precision, round to nearest even; too large becomes infinity.
uint16_t to_half(float x);
float from_half(uint16_t h);

}  // namespace zonal::shmat
