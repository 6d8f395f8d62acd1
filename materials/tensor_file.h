#pragma once
/// The container of RGL's .bsdf files: named arrays of numbers behind a table of contents.
///
///     TensorFile tensors("paper_white_rgb.bsdf");
///     const TensorField& theta = tensors.require("theta_i", TensorType::f32, {kAnyLength});
///     std::vector<float> radians = tensors.floats(theta, {0, 1.6});
///
/// Little-endian: "tensor_file" and a zero byte, version 1.0 as two bytes, the number of fields (u32); then
/// for each field the length of its name (u16), the name, the number of dimensions (u16), the type (u8), the
/// offset of its data from the file's start (u64) and the length of each dimension (u64, the last one
/// contiguous). Nothing is believed before it has been compared with the size of the file; what does not fit
/// is a SceneError naming file, field, found and expected.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/json_fields.h"

namespace zonal {

enum class TensorType : uint8_t { u8 = 1, i8, u16, i16, u32, i32, u64, i64, f16, f32, f64 };

struct TensorField {
  std::string name;
  TensorType type = TensorType::u8;
  std::vector<uint64_t> shape;  ///< every length >= 1
  uint64_t offset = 0;          ///< bytes from the file's start
  uint64_t count = 0;           ///< numbers in all
};

/// In an expected shape: any length.
inline constexpr uint64_t kAnyLength = 0;

/// First bytes of such a file.
inline constexpr std::string_view kTensorMagic{"tensor_file\0", 12};

class TensorFile {
 public:
  /// Reads and checks a file.
  explicit TensorFile(const std::string& file);
  /// Checks bytes already read; `file` names them in errors.
  TensorFile(std::string file, std::string bytes);

  const std::string& file() const { return file_; }
  const std::vector<TensorField>& fields() const { return fields_; }
  /// Null when there is none of that name.
  const TensorField* find(std::string_view name) const;
  /// The field `name`, which must have this type and shape.
  const TensorField& require(std::string_view name, TensorType type,
                             const std::vector<uint64_t>& shape) const;

  /// The numbers of an f32 field, all finite and in `range`.
  std::vector<float> floats(const TensorField& field, Range range = {}) const;
  /// The bytes of a u8 field.
  std::string_view bytes(const TensorField& field) const;
  /// Throws SceneError: file, field, sentence.
  [[noreturn]] void fail(std::string_view field, const std::string& sentence) const;

 private:
  std::string file_, data_;
  std::vector<TensorField> fields_;

  void parse();
};

/// Makes such files: what tests and examples are built from.
class TensorWriter {
 public:
  /// `values` must be as many as the shape says. A field of that name is replaced.
  void add(const std::string& name, const std::vector<uint64_t>& shape, const std::vector<float>& values);
  void add(const std::string& name, std::string_view bytes);  ///< u8, one dimension
  void remove(std::string_view name);
  std::string bytes() const;                  ///< the whole file
  void write(const std::string& file) const;  ///< atomically; SceneError when it cannot

 private:
  struct Entry {
    std::string name;
    TensorType type;
    std::vector<uint64_t> shape;
    std::string data;
  };
  std::vector<Entry> entries_;

  void put(Entry entry);
};

}  // namespace zonal
