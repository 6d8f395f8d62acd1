#include "core/strict_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/json_fields.h"

namespace zonal {
namespace {

using nlohmann::json;

/// Far beyond what a scene needs (the deepest key of the format lies at 7), far below what a stack holds.
constexpr size_t kDeepest = 64;
/// 4 million values take about 100 MB in memory; meshes belong in mesh files.
constexpr size_t kMostValues = 4'000'000;
constexpr uintmax_t kLargestFile = 256u << 20;

/// "found x, expected y" out of the library's "[json.exception...] parse error at ...: ... - unexpected x;
/// expected y".
std::string sentence_of(std::string message) {
  if (const size_t dash = message.find(" - "); dash != std::string::npos) message = message.substr(dash + 3);
  // What was read last may hold anything, even a whole string: the line and column say it better.
  if (const size_t read = message.find("; last read: "); read != std::string::npos) {
    const size_t expected = message.rfind("'; expected ");
    message = message.substr(0, read) + (expected == std::string::npos ? "" : message.substr(expected + 1));
  }
  const auto replace = [&](std::string_view from, std::string_view to) {
    if (const size_t at = message.find(from); at != std::string::npos) message.replace(at, from.size(), to);
  };
  replace("unexpected ", "found ");
  replace("; expected ", ", expected ");
  replace("expected '}'", "expected ',' or '}'");
  replace("expected ']'", "expected ',' or ']'");
  replace("expected string literal", "expected a key in double quotes");
  return message;
}

/// Builds the value and watches the rules the library does not know.
class StrictBuilder : public json::json_sax_t {
 public:
  StrictBuilder(const std::string& text, const std::string& file) : text_(text), file_(file) {}
  json root;

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(json::number_integer_t value) override { return add(value); }
  bool number_unsigned(json::number_unsigned_t value) override { return add(value); }
  bool number_float(json::number_float_t value, const std::string&) override { return add(value); }
  bool string(std::string& value) override { return add(std::move(value)); }
  bool binary(json::binary_t&) override { return false; }  // JSON text has none

  bool start_object(size_t) override { return open(json::object()); }
  bool start_array(size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(std::string& name) override {
    if (open_.back()->contains(name))
      throw SceneError(fmt::format("{}: the key {} appears twice", where(), in_quotes(name)));
    keys_.back() = std::move(name);
    return true;
  }

  bool parse_error(size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    // The library stops at the last letter of the wrong word: point at its first.
    const std::string_view text(text_.data(), std::min(position, text_.size()));
    const auto in_word = [&](size_t i) {
      const unsigned char c = static_cast<unsigned char>(text_[i]);
      return std::isalnum(c) || c == '-' || c == '+' || c == '.';
    };
    std::string sentence = sentence_of(error.what());
    size_t start = text.empty() ? 0 : text.size() - 1;
    if (sentence.rfind("found string", 0) == 0)
      start = std::min(start, text.substr(0, start).rfind('"'));
    else
      while (start > 0 && in_word(start) && in_word(start - 1)) --start;
    size_t stop = std::min(start + 1, text_.size());
    while (stop < text_.size() && stop < start + 12 && in_word(stop)) ++stop;
    const std::string word = text_.substr(start, stop - start);

    if (word == "NaN" || word == "nan" || word.find("nf") != std::string::npos)
      sentence = "found " + word + ", expected a finite number: JSON has no NaN or Infinity";
    else if (word == "/" || word == "#")
      sentence = "found " + in_quotes(word) + ", expected no comment: JSON has none";
    else if (dynamic_cast<const json::out_of_range*>(&error))
      sentence = "found " + word + ", expected a number that fits a double";
    else if (sentence.rfind("invalid literal", 0) == 0)
      sentence.replace(0, 15, "found " + in_quotes(word));
    if (sentence.find("expected") == std::string::npos && sentence.rfind("found", 0) == 0)
      sentence += ", expected a value";

    const size_t line_start = start == 0 ? std::string::npos : text_.rfind('\n', start - 1);
    const size_t column = start - (line_start == std::string::npos ? 0 : line_start + 1) + 1;
    const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(start), '\n');
    throw SceneError(fmt::format("{}:{}:{}: {}", file_, line, column, sentence));
  }

 private:
  json* place(json value) {
    if (++values_ > kMostValues)
      throw SceneError(
          fmt::format("{}: more than {} values, expected a scene file (large meshes go into OBJ, PLY or "
                      "glTF files)",
                      where(), kMostValues));
    if (open_.empty()) {
      root = std::move(value);
      return &root;
    }
    if (open_.back()->is_array()) {
      open_.back()->push_back(std::move(value));
      return &open_.back()->back();
    }
    json& slot = (*open_.back())[keys_.back()];
    slot = std::move(value);
    return &slot;
  }

  bool add(json value) {
    place(std::move(value));
    return true;
  }

  bool open(json value) {
    if (open_.size() >= kDeepest)
      throw SceneError(fmt::format("{}: nested deeper than {} levels, expected a scene", where(), kDeepest));
    open_.push_back(place(std::move(value)));
    keys_.emplace_back();
    return true;
  }

  bool close() {
    open_.pop_back();
    keys_.pop_back();
    return true;
  }

  /// Of the object or array being read.
  std::string where() const {
    std::string result = file_;
    for (size_t i = 0; i + 1 < open_.size(); ++i)
      result = open_[i]->is_array() ? where_of(result, open_[i]->size() - 1) : where_of(result, keys_[i]);
    return result;
  }

  const std::string& text_;
  const std::string& file_;
  std::vector<json*> open_;  ///< the containers around the current place, outermost first
  std::vector<std::string> keys_;
  size_t values_ = 0;
};

}  // namespace

json parse_json(const std::string& text, const std::string& file) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw SceneError(file + ": the file is empty, expected JSON");
  StrictBuilder builder(text, file);
  json::sax_parse(text, &builder);
  return std::move(builder.root);
}

std::string read_text_file(const std::string& file, const std::string& what) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found)
    throw SceneError(fmt::format("{}: there is no such file, expected {}", file, what));
  if (fs::is_directory(status)) throw SceneError(fmt::format("{}: found a folder, expected {}", file, what));
  if (!fs::is_regular_file(status))
    throw SceneError(fmt::format("{}: found no file, expected {}", file, what));
  if (fs::file_size(file, error) > kLargestFile)
    throw SceneError(fmt::format("{}: more than {} MB, expected {}", file, kLargestFile >> 20, what));

  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream.good() && !stream.eof())
    throw SceneError(fmt::format("{}: cannot be read, expected {}", file, what));
  if (text.str().empty()) throw SceneError(fmt::format("{}: the file is empty, expected {}", file, what));
  return text.str();
}

}  // namespace zonal
