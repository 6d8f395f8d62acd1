#include "materials/tensor_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/atomic_file.h"
#include "core/error.h"

namespace zonal {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied from the file as they are");

constexpr uint64_t kLargestFile = uint64_t{4} << 30;  // the largest anisotropic spectra published have 0.3 GB
constexpr uint64_t kSmallestField = 13;               // without name and lengths
constexpr uint64_t kMostDimensions = 8;
constexpr uint64_t kAlignment = 8;  // of data, and so the most that may be left over at the end

constexpr int kTypes = 12;
constexpr const char* kTypeNames[kTypes] = {"invalid", "u8",  "i8",  "u16", "i16", "u32",
                                            "i32",     "u64", "i64", "f16", "f32", "f64"};
constexpr uint64_t kTypeSizes[kTypes] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

std::string text_of(const std::vector<uint64_t>& shape, bool expected = false) {
  std::string text = "[";
  for (const uint64_t length : shape) {
    if (text.size() > 1) text += ", ";
    text += expected && length == kAnyLength ? "any" : std::to_string(length);
  }
  return text + "]";
}

std::string read_bytes(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found)
    throw SceneError(file + ": there is no such file, expected a tensor file");
  if (!fs::is_regular_file(status))
    throw SceneError(file + ": found no regular file, expected a tensor file");
  const uint64_t size = fs::file_size(file, error);
  if (error) throw SceneError(fmt::format("{}: cannot be read: {}", file, error.message()));
  if (size > kLargestFile)
    throw SceneError(fmt::format("{}: found {} bytes, expected at most {}", file, size, kLargestFile));
  std::string bytes(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw SceneError(file + ": cannot be read, expected a tensor file");
  return bytes;
}

/// Takes the header apart, never further than its end.
class Cursor {
 public:
  Cursor(const TensorFile& file, const std::string& data) : file_(file), data_(data) {}

  std::string_view take(uint64_t size, std::string_view what) {
    if (size > left())
      file_.fail(what, fmt::format("found the end of the file at byte {}, expected {} more at byte {}",
                                   data_.size(), size, position_));
    const std::string_view bytes(data_.data() + position_, size);
    position_ += size;
    return bytes;
  }
  template <class T>
  T number(std::string_view what) {
    T value;
    std::memcpy(&value, take(sizeof(T), what).data(), sizeof(T));
    return value;
  }
  uint64_t position() const { return position_; }
  uint64_t left() const { return data_.size() - position_; }

 private:
  const TensorFile& file_;
  const std::string& data_;
  uint64_t position_ = 0;
};

}  // namespace

TensorFile::TensorFile(const std::string& file) : TensorFile(file, read_bytes(file)) {}

TensorFile::TensorFile(std::string file, std::string bytes)
    : file_(std::move(file)), data_(std::move(bytes)) {
  parse();
}

void TensorFile::fail(std::string_view field, const std::string& sentence) const {
  throw SceneError(fmt::format("{}: field {}: {}", file_, in_quotes(field), sentence));
}

void TensorFile::parse() {
  if (std::string_view(data_).substr(0, kTensorMagic.size()) != kTensorMagic)
    throw SceneError(fmt::format("{}: found {} in front, expected \"tensor_file\" and a zero byte", file_,
                                 in_quotes(std::string_view(data_).substr(0, kTensorMagic.size()))));
  Cursor cursor(*this, data_);
  cursor.take(kTensorMagic.size(), "magic");
  const int major = cursor.number<uint8_t>("version"), minor = cursor.number<uint8_t>("version");
  if (major != 1 || minor != 0)
    throw SceneError(
        fmt::format("{}: found version {}.{} of the tensor file, expected 1.0", file_, major, minor));
  const uint64_t count = cursor.number<uint32_t>("number of fields");
  if (count > cursor.left() / kSmallestField)
    throw SceneError(fmt::format("{}: found {} fields announced in a file of {} bytes, expected at most {}",
                                 file_, count, data_.size(), cursor.left() / kSmallestField));

  for (uint64_t i = 0; i < count; ++i) {
    TensorField field;
    const std::string number = fmt::format("number {}", i + 1);
    field.name = std::string(cursor.take(cursor.number<uint16_t>(number), number));
    if (find(field.name)) fail(field.name, "found twice, expected once");
    const uint64_t dimensions = cursor.number<uint16_t>(field.name);
    if (dimensions < 1 || dimensions > kMostDimensions)
      fail(field.name, fmt::format("found {} dimensions, expected 1 to {}", dimensions, kMostDimensions));
    const int type = cursor.number<uint8_t>(field.name);
    if (type < 1 || type >= kTypes)
      fail(field.name, fmt::format("found type {}, expected 1 to {}", type, kTypes - 1));
    field.type = static_cast<TensorType>(type);
    field.offset = cursor.number<uint64_t>(field.name);
    for (uint64_t d = 0; d < dimensions; ++d) field.shape.push_back(cursor.number<uint64_t>(field.name));

    // The product of the lengths may not exceed the file, so that no later multiplication overflows.
    field.count = 1;
    const uint64_t most = data_.size() / kTypeSizes[type];
    for (const uint64_t length : field.shape) {
      if (length < 1 || length > most / field.count)
        fail(field.name,
             fmt::format("found shape {} of {}, expected lengths of at least 1 that fit the file's {} bytes",
                         text_of(field.shape), kTypeNames[type], data_.size()));
      field.count *= length;
    }
    fields_.push_back(std::move(field));
  }

  // Data lie behind the header, inside the file and apart from each other.
  std::vector<const TensorField*> order;
  for (const TensorField& field : fields_) order.push_back(&field);
  std::sort(order.begin(), order.end(),
            [](const TensorField* a, const TensorField* b) { return a->offset < b->offset; });
  uint64_t free = cursor.position();
  for (const TensorField* field : order) {
    const uint64_t size = field->count * kTypeSizes[static_cast<int>(field->type)];
    if (field->offset < free)
      fail(field->name,
           fmt::format("found its data at byte {}, expected them behind the header and what lies before, at "
                       "byte {} or later",
                       field->offset, free));
    if (field->offset > data_.size() || size > data_.size() - field->offset)
      fail(field->name,
           fmt::format("found {} bytes of data at byte {}, expected them inside the file's {} bytes", size,
                       field->offset, data_.size()));
    free = field->offset + size;
  }
  if (data_.size() - free >= kAlignment)
    throw SceneError(fmt::format("{}: found {} bytes behind the last field, expected the end of the file",
                                 file_, data_.size() - free));
}

const TensorField* TensorFile::find(std::string_view name) const {
  for (const TensorField& field : fields_)
    if (field.name == name) return &field;
  return nullptr;
}

const TensorField& TensorFile::require(std::string_view name, TensorType type,
                                       const std::vector<uint64_t>& shape) const {
  const TensorField* field = find(name);
  const auto name_of = [](TensorType t) { return kTypeNames[static_cast<int>(t)]; };
  if (!field) {
    std::vector<std::string> names;
    for (const TensorField& f : fields_) names.push_back(f.name);
    fail(name, fmt::format("found none, expected {} of shape {}{}", name_of(type), text_of(shape, true),
                           names.empty() ? "" : did_you_mean(name, names)));
  }
  if (field->type != type)
    fail(name, fmt::format("found numbers of type {}, expected {}", name_of(field->type), name_of(type)));
  bool fits = field->shape.size() == shape.size();
  for (size_t d = 0; fits && d < shape.size(); ++d)
    fits = shape[d] == kAnyLength || shape[d] == field->shape[d];
  if (!fits)
    fail(name, fmt::format("found shape {}, expected {}", text_of(field->shape), text_of(shape, true)));
  return *field;
}

std::vector<float> TensorFile::floats(const TensorField& field, Range range) const {
  assert(field.type == TensorType::f32);
  std::vector<float> values(field.count);
  std::memcpy(values.data(), data_.data() + field.offset, field.count * sizeof(float));
  for (size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i]) && range.contains(values[i])) continue;
    const std::string limits = range.text();
    fail(field.name, fmt::format("found {} as number {} of {}, expected a finite number{}{}", values[i],
                                 i + 1, values.size(), limits.empty() ? "" : " ", limits));
  }
  return values;
}

std::string_view TensorFile::bytes(const TensorField& field) const {
  assert(field.type == TensorType::u8);
  return std::string_view(data_).substr(field.offset, field.count);
}

// ---- writing ---------------------------------------------------------------------------------------------

void TensorWriter::add(const std::string& name, const std::vector<uint64_t>& shape,
                       const std::vector<float>& values) {
  std::string data(values.size() * sizeof(float), '\0');
  std::memcpy(data.data(), values.data(), data.size());
  put({name, TensorType::f32, shape, std::move(data)});
}

void TensorWriter::add(const std::string& name, std::string_view bytes) {
  put({name, TensorType::u8, {bytes.size()}, std::string(bytes)});
}

void TensorWriter::remove(std::string_view name) {
  std::erase_if(entries_, [&](const Entry& e) { return e.name == name; });
}

void TensorWriter::put(Entry entry) {
  for (Entry& e : entries_)
    if (e.name == entry.name) {
      e = std::move(entry);
      return;
    }
  entries_.push_back(std::move(entry));
}

std::string TensorWriter::bytes() const {
  const auto aligned = [](uint64_t size) { return (size + kAlignment - 1) / kAlignment * kAlignment; };
  uint64_t offset = kTensorMagic.size() + 2 + 4;
  for (const Entry& e : entries_) offset += kSmallestField + e.name.size() + 8 * e.shape.size();

  std::string out(kTensorMagic);
  const auto put = [&](auto value) { out.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
  put(uint8_t{1}), put(uint8_t{0}), put(static_cast<uint32_t>(entries_.size()));
  for (const Entry& e : entries_) {
    offset = aligned(offset);
    put(static_cast<uint16_t>(e.name.size()));
    out += e.name;
    put(static_cast<uint16_t>(e.shape.size())), put(e.type), put(offset);
    for (const uint64_t length : e.shape) put(length);
    offset += e.data.size();
  }
  for (const Entry& e : entries_) {
    out.resize(aligned(out.size()), '\0');
    out += e.data;
  }
  return out;
}

void TensorWriter::write(const std::string& file) const {
  const std::string all = bytes();
  write_atomically(file, all.data(), all.size());
}

}  // namespace zonal
