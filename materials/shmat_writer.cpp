// The writer of .shmat files; shmat_format.h has their layout.

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "materials/sh_projector.h"
#include "materials/shmat_format.h"

namespace zonal {

std::vector<std::byte> write_shmat(const ShProjection& p, const ShmatOptions& options) {
  using namespace shmat;
  assert(!p.empty());
  const std::string name = p.name.substr(0, kMaxText), source = p.source.substr(0, kMaxText);
  const Layout layout(uint32_t(p.azimuths), name.size() + source.size());
  assert(p.rows[0].size() + p.rows[1].size() == layout.rows);

  std::vector<uint32_t> words;
  std::vector<uint16_t> shares;
  size_t data_words = 0;
  int most = 0;
  for (const auto& table : p.rows) {
    for (const ShRow& row : table) {
      words.push_back(row_word(row.bands, uint32_t(data_words)));
      shares.push_back(uint16_t(std::lround(65535 * std::clamp(row.captured, 0.0, 1.0))));
      data_words += row_words(row.bands, p.mirrored, options.half);
      most = std::max(most, row.bands);
      if (data_words > kMaxDataWords)
        throw SceneError(
            fmt::format("{}: found more than {} MB of coefficients, expected less: take fewer bands, fewer "
                        "azimuths or half floats",
                        p.name, 4 * size_t{kMaxDataWords} / 1000000));
    }
  }

  Header header{};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  header.version = kVersion;
  header.file_bytes = layout.data + 4 * data_words;
  header.flags = (options.half ? kHalf : 0) | (p.mirrored ? kMirrored : 0);
  header.azimuths = uint32_t(p.azimuths), header.elevations = ShMaterial::kElevations;
  header.max_bands = uint32_t(most);
  header.text_offset = uint32_t(layout.text), header.rows_offset = uint32_t(layout.row_words);
  header.shares_offset = uint32_t(layout.shares), header.data_offset = uint32_t(layout.data);
  header.data_words = uint32_t(data_words);
  for (int c = 0; c < 3; ++c) header.albedo[c] = std::max(0.0f, p.albedo[c]);
  header.asymmetry = float(p.asymmetry);
  header.name_bytes = uint16_t(name.size()), header.source_bytes = uint16_t(source.size());

  std::vector<std::byte> bytes(header.file_bytes);  // zero between the parts
  std::memcpy(bytes.data() + layout.text, name.data(), name.size());
  std::memcpy(bytes.data() + layout.text + name.size(), source.data(), source.size());
  std::memcpy(bytes.data() + layout.row_words, words.data(), 4 * words.size());
  std::memcpy(bytes.data() + layout.shares, shares.data(), 2 * shares.size());
  std::byte* to = bytes.data() + layout.data;
  for (const auto& table : p.rows) {
    for (const ShRow& row : table) {
      for (size_t i = 0; i < row.coefficients.size(); ++i) {
        const float x = row.coefficients[i];
        if (!std::isfinite(x) || (options.half && std::abs(x) >= 65520))
          throw SceneError(
              fmt::format("{}: found a coefficient of {}, expected {}", p.name, x,
                          std::isfinite(x) ? "one below 65520, or single floats" : "a finite one"));
        if (options.half) {
          const uint16_t h = to_half(x);
          std::memcpy(to + 2 * i, &h, 2);
        } else {
          std::memcpy(to + 4 * i, &x, 4);
        }
      }
      to += 4 * size_t{row_words(row.bands, p.mirrored, options.half)};
    }
  }
  std::memcpy(bytes.data(), &header, sizeof header);
  header.checksum = file_checksum(bytes.data(), bytes.size());
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

}  // namespace zonal
