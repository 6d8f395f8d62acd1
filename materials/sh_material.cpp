#include "materials/sh_material.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "materials/shmat_format.h"

#ifdef __F16C__
#include <immintrin.h>
#endif

namespace zonal {

static_assert(std::endian::native == std::endian::little, "the format is read as it lies in memory");

struct ShMaterial::Impl {
  std::vector<std::byte> owned;  ///< empty when mapped
  void* mapped = nullptr;
  std::span<const std::byte> bytes;
  std::string name, source;
  shmat::Header header{};
  const uint32_t* row_words = nullptr;
  const uint16_t* shares = nullptr;
  const std::byte* data = nullptr;
  bool mirrored = true, half = true;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (mapped) ::munmap(mapped, bytes.size());
  }

  size_t row(ShTable table, size_t azimuth, size_t elevation) const {
    return (static_cast<size_t>(table) * header.azimuths + azimuth) * ShMaterial::kElevations + elevation;
  }
  void check(const std::string& file);
};

namespace {

[[noreturn]] void fail(const std::string& file, const std::string& field, const std::string& found,
                       const std::string& expected) {
  throw SceneError(fmt::format("{}: {}: found {}, expected {}", file, field, found, expected));
}

template <class T>
void expect(const std::string& file, const char* field, T found, T expected) {
  if (found != expected) fail(file, field, fmt::format("{}", found), fmt::format("{}", expected));
}

/// Single floats are kept far enough from infinity for sums of products of two.
bool all_usable(const std::byte* data, size_t words, bool half) {
  constexpr uint32_t kLargest = std::bit_cast<uint32_t>(1e15f);
  for (size_t i = 0; i < words; ++i) {
    uint32_t w;
    std::memcpy(&w, data + 4 * i, 4);
    if (half ? (w & 0x7c00u) == 0x7c00u || (w & 0x7c000000u) == 0x7c000000u : (w & 0x7fffffffu) > kLargest)
      return false;
  }
  return true;
}

/// out[i] = (add ? out[i] : 0) + weight * in[i].
void blend(const uint16_t* in, int count, float weight, bool add, float* out) {
  int i = 0;
#ifdef __F16C__
  const __m256 w = _mm256_set1_ps(weight);
  for (; i + 8 <= count; i += 8) {
    const __m256 v =
        _mm256_mul_ps(w, _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(in + i))));
    _mm256_storeu_ps(out + i, add ? _mm256_add_ps(_mm256_loadu_ps(out + i), v) : v);
  }
#endif
  for (; i < count; ++i) out[i] = (add ? out[i] : 0.0f) + weight * shmat::from_half(in[i]);
}
void blend(const float* in, int count, float weight, bool add, float* out) {
  for (int i = 0; i < count; ++i) out[i] = (add ? out[i] : 0.0f) + weight * in[i];
}

/// The rows around a direction.
struct Neighbours {
  int count = 0;
  size_t row[4];
  float weight[4];
};

}  // namespace

// Everything the header says is compared with the size of the file before anything is read where it points
// to.
void ShMaterial::Impl::check(const std::string& file) {
  if (bytes.size() < sizeof(shmat::Header))
    fail(file, "size", fmt::format("{} bytes", bytes.size()),
         fmt::format("at least the {} of a .shmat header", sizeof(shmat::Header)));
  std::memcpy(&header, bytes.data(), sizeof header);
  const shmat::Header& h = header;
  if (std::memcmp(h.magic, shmat::kMagic, sizeof h.magic) != 0)
    fail(file, "magic", "other bytes", "a .shmat file, which starts with \"SHMAT\\r\\n\\x1a\"");
  if (h.version != shmat::kVersion)
    fail(file, "version", fmt::format("{}", h.version),
         fmt::format("{}{}", shmat::kVersion,
                     h.version > shmat::kVersion ? ": the file was written by a later program" : ""));
  if (h.file_bytes != bytes.size())
    fail(file, "file_bytes",
         fmt::format("{} in the header of a file of {} bytes", h.file_bytes, bytes.size()),
         bytes.size() < h.file_bytes ? "equal numbers: the file is cut"
                                     : "equal numbers: something was appended");
  const uint32_t sum = shmat::file_checksum(bytes.data(), bytes.size());
  if (h.checksum != sum)
    fail(file, "checksum", fmt::format("{:08x}", h.checksum),
         fmt::format("{:08x}, the CRC-32C of the bytes: the file is damaged", sum));

  if (h.flags > (shmat::kHalf | shmat::kMirrored))
    fail(file, "flags", fmt::format("{:#x}", h.flags), "0 to 3");
  half = h.flags & shmat::kHalf, mirrored = h.flags & shmat::kMirrored;
  expect(file, "elevations", h.elevations, uint32_t{ShMaterial::kElevations});
  if (h.azimuths < 1 || h.azimuths > shmat::kMaxAzimuths)
    fail(file, "azimuths", fmt::format("{}", h.azimuths), fmt::format("1 to {}", shmat::kMaxAzimuths));
  if (h.name_bytes > shmat::kMaxText || h.source_bytes > shmat::kMaxText)
    fail(file, "name_bytes, source_bytes", fmt::format("{}, {}", h.name_bytes, h.source_bytes),
         fmt::format("at most {}", shmat::kMaxText));
  const shmat::Layout layout(h.azimuths, size_t{h.name_bytes} + h.source_bytes);
  expect<size_t>(file, "text_offset", h.text_offset, layout.text);
  expect<size_t>(file, "rows_offset", h.rows_offset, layout.row_words);
  expect<size_t>(file, "shares_offset", h.shares_offset, layout.shares);
  expect<size_t>(file, "data_offset", h.data_offset, layout.data);
  if (bytes.size() < layout.data || (bytes.size() - layout.data) % 4 != 0 ||
      (bytes.size() - layout.data) / 4 > shmat::kMaxDataWords)
    fail(file, "data_words", fmt::format("{} bytes of data", int64_t(bytes.size()) - int64_t(layout.data)),
         fmt::format("a multiple of 4, at most {}", 4 * size_t{shmat::kMaxDataWords}));
  expect<size_t>(file, "data_words", h.data_words, (bytes.size() - layout.data) / 4);

  const char* text = reinterpret_cast<const char*>(bytes.data() + layout.text);
  name.assign(text, h.name_bytes);
  source.assign(text + h.name_bytes, h.source_bytes);
  row_words = reinterpret_cast<const uint32_t*>(bytes.data() + layout.row_words);
  shares = reinterpret_cast<const uint16_t*>(bytes.data() + layout.shares);
  data = bytes.data() + layout.data;

  int most = 0;
  for (size_t i = 0; i < layout.rows; ++i) {
    const int bands = shmat::row_bands(row_words[i]);
    if (bands < 1 || bands > ShMaterial::kMaxBands)
      fail(file, fmt::format("row {}: bands", i), fmt::format("{}", bands),
           fmt::format("1 to {}", ShMaterial::kMaxBands));
    const size_t end = size_t{shmat::row_offset(row_words[i])} + shmat::row_words(bands, mirrored, half);
    if (end > h.data_words)
      fail(file, fmt::format("row {}: offset", i), fmt::format("an end at word {}", end),
           fmt::format("at most {}", h.data_words));
    most = std::max(most, bands);
  }
  expect<uint32_t>(file, "max_bands", h.max_bands, uint32_t(most));
  for (float x : {h.albedo[0], h.albedo[1], h.albedo[2], h.asymmetry})
    if (!std::isfinite(x) || x < 0)
      fail(file, "albedo, asymmetry", fmt::format("{}", x), "finite numbers, none negative");
  if (!all_usable(data, h.data_words, half))
    fail(file, "coefficients", half ? "NaN or infinity" : "NaN, infinity or more than 1e15",
         "finite numbers");
}

ShMaterial ShMaterial::open(const std::string& file) {
  struct Descriptor {
    int number;
    ~Descriptor() {
      if (number >= 0) ::close(number);
    }
  } descriptor{::open(file.c_str(), O_RDONLY | O_CLOEXEC)};
  struct stat status {};
  if (descriptor.number < 0 || ::fstat(descriptor.number, &status) != 0)
    fail(file, "file", std::strerror(errno), "a .shmat file");
  if (!S_ISREG(status.st_mode)) fail(file, "file", "no regular file", "a .shmat file");
  auto impl = std::make_shared<Impl>();
  const auto size = static_cast<size_t>(status.st_size);
  if (size > 0) {
    void* p = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor.number, 0);
    if (p == MAP_FAILED) fail(file, "file", std::strerror(errno), "a file that can be mapped");
    impl->mapped = p;
    impl->bytes = {static_cast<const std::byte*>(p), size};
  }
  impl->check(file);
  ShMaterial material;
  material.impl_ = std::move(impl);
  return material;
}

ShMaterial ShMaterial::from_bytes(std::vector<std::byte> bytes, const std::string& name) {
  auto impl = std::make_shared<Impl>();
  impl->owned = std::move(bytes);
  impl->bytes = impl->owned;
  impl->check(name);
  ShMaterial material;
  material.impl_ = std::move(impl);
  return material;
}

namespace {
const std::string kNoText;
}

const std::string& ShMaterial::name() const {
  return impl_ ? impl_->name : kNoText;
}
const std::string& ShMaterial::source() const {
  return impl_ ? impl_->source : kNoText;
}
bool ShMaterial::mirrored() const {
  return !impl_ || impl_->mirrored;
}
bool ShMaterial::half() const {
  return !impl_ || impl_->half;
}
int ShMaterial::azimuths() const {
  return impl_ ? int(impl_->header.azimuths) : 0;
}
vec3 ShMaterial::albedo() const {
  return impl_ ? vec3(impl_->header.albedo[0], impl_->header.albedo[1], impl_->header.albedo[2]) : vec3(0);
}
float ShMaterial::asymmetry() const {
  return impl_ ? impl_->header.asymmetry : 0;
}
int ShMaterial::max_bands() const {
  return impl_ ? int(impl_->header.max_bands) : 0;
}
std::span<const std::byte> ShMaterial::bytes() const {
  return impl_ ? impl_->bytes : std::span<const std::byte>();
}

int ShMaterial::row_bands(ShTable table, int azimuth, int elevation) const {
  return shmat::row_bands(impl_->row_words[impl_->row(table, size_t(azimuth), size_t(elevation))]);
}
float ShMaterial::row_share(ShTable table, int azimuth, int elevation) const {
  return float(impl_->shares[impl_->row(table, size_t(azimuth), size_t(elevation))]) / 65535.0f;
}

std::vector<float> ShMaterial::row(ShTable table, int azimuth, int elevation) const {
  const uint32_t word = impl_->row_words[impl_->row(table, size_t(azimuth), size_t(elevation))];
  const std::byte* start = impl_->data + 4 * size_t{shmat::row_offset(word)};
  std::vector<float> out(3 * size_t(sh_count(shmat::row_bands(word), impl_->mirrored)));
  if (impl_->half)
    blend(reinterpret_cast<const uint16_t*>(start), int(out.size()), 1, false, out.data());
  else
    blend(reinterpret_cast<const float*>(start), int(out.size()), 1, false, out.data());
  return out;
}

namespace {

/// Below 90 degrees; at or beyond the last elevation the last row alone.
Neighbours neighbours(vec3 w, int azimuths) {
  Neighbours n;
  const float r2 = w.x * w.x + w.y * w.y;
  const float angle = std::atan2(std::sqrt(r2), w.z) * (180.0f / kPi);
  size_t low = 90, high = 90;
  float t = 0;
  if (angle < 89.5f) {
    low = std::min<size_t>(size_t(angle), 89), high = low + 1;
    t = (angle - float(low)) * (low == 89 ? 2.0f : 1.0f);
  }
  const auto add = [&](size_t azimuth, float weight) {
    if (weight * (1 - t) > 0)
      n.row[n.count] = azimuth * ShMaterial::kElevations + low, n.weight[n.count++] = weight * (1 - t);
    if (weight * t > 0)
      n.row[n.count] = azimuth * ShMaterial::kElevations + high, n.weight[n.count++] = weight * t;
  };
  if (azimuths == 1) {
    add(0, 1);
    return n;
  }
  // The view frame of the normal itself is the shading frame (ViewFrame): azimuth 0.
  float turn = r2 > 1e-12f ? std::atan2(w.y, w.x) * (0.5f * kInvPi) : 0;
  turn = (turn < 0 ? turn + 1 : turn) * float(azimuths);
  const size_t first = std::min(size_t(turn), size_t(azimuths) - 1);
  const float s = turn - float(first);
  add(first, 1 - s);
  add((first + 1) % size_t(azimuths), s);
  return n;
}

}  // namespace

int ShMaterial::bands(ShTable table, vec3 w_out) const {
  if (!impl_ || !(w_out.z > 1e-8f)) return 0;
  const Neighbours n = neighbours(w_out, azimuths());
  const uint32_t* words = impl_->row_words + impl_->row(table, 0, 0);
  int most = 0;
  for (int k = 0; k < n.count; ++k) most = std::max(most, shmat::row_bands(words[n.row[k]]));
  return most;
}

int ShMaterial::look_up(ShTable table, vec3 w_out, int bands, int stride, float* out) const {
  const int wanted = sh_count(bands, mirrored());
  int filled = 0, most = 0;
  if (impl_ && w_out.z > 1e-8f) {
    const Neighbours n = neighbours(w_out, azimuths());
    const uint32_t* words = impl_->row_words + impl_->row(table, 0, 0);
    for (int k = 0; k < n.count; ++k) {
      const uint32_t word = words[n.row[k]];
      const int stored = sh_count(shmat::row_bands(word), impl_->mirrored), count = std::min(stored, wanted);
      const std::byte* start = impl_->data + 4 * size_t{shmat::row_offset(word)};
      for (int c = 0; c < 3; ++c) {
        float* to = out + c * stride;
        const auto both = [&](auto* from) {
          from += c * stored;
          blend(from, std::min(filled, count), n.weight[k], true, to);
          if (count > filled) blend(from + filled, count - filled, n.weight[k], false, to + filled);
        };
        if (impl_->half)
          both(reinterpret_cast<const uint16_t*>(start));
        else
          both(reinterpret_cast<const float*>(start));
      }
      filled = std::max(filled, count);
      most = std::max(most, std::min(bands, shmat::row_bands(word)));
    }
  }
  for (int c = 0; c < 3; ++c) std::fill(out + c * stride + filled, out + c * stride + wanted, 0.0f);
  return most;
}

}  // namespace zonal
