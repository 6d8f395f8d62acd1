#include "gl/shader_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "core/error.h"

namespace zonal::gl {
namespace {

class Flattener {
 public:
  explicit Flattener(const ShaderText& text) : text_(text) {}

  /// `asked` names the including file and line, for errors.
  void add(const std::string& path, const std::string& asked) {
    if (std::find(result.files.begin(), result.files.end(), path) != result.files.end()) return;
    const size_t number = result.files.size();
    result.files.push_back(path);
    std::string whole;
    try {
      whole = text_.read(path);
    } catch (const SceneError& error) {
      throw asked.empty() ? error : SceneError(asked + ": " + error.what());
    }
    result.text += fmt::format("#line 1 {}\n", number);
    std::istringstream lines(whole);
    std::string line;
    for (int at = 1; std::getline(lines, line); ++at) {
      const std::string included = include_of(line, path, at);
      if (included.empty()) {
        result.text += line + '\n';
        continue;
      }
      add(included, fmt::format("{}:{}", path, at));
      result.text += fmt::format("#line {} {}\n", at + 1, number);
    }
  }

  FlatShader result;

 private:
  static std::string include_of(const std::string& line, const std::string& path, int at) {
    const size_t start = line.find_first_not_of(" \t");
    if (start == std::string::npos || line.compare(start, 8, "#include") != 0) return "";
    const size_t open = line.find('"'), close = line.rfind('"');
    if (open == std::string::npos || close <= open + 1)
      throw SceneError(fmt::format("{}:{}: found {}, expected #include \"path\"", path, at, line));
    return line.substr(open + 1, close - open - 1);
  }

  const ShaderText& text_;
};

/// Reads "1:12(5): " or "1(12) : " at the start of a line. Returns what is left of it, or nothing.
bool split_place(std::string_view line, size_t* file, int* at, std::string_view* rest) {
  const auto number = [&](size_t& i, auto* value) {
    const size_t start = i;
    *value = 0;
    while (i < line.size() && i < start + 9 && line[i] >= '0' && line[i] <= '9')
      *value = *value * 10 + (line[i++] - '0');
    return i > start;
  };
  size_t i = 0;
  if (!number(i, file) || i == line.size()) return false;
  const char between = line[i++];
  if ((between != ':' && between != '(') || !number(i, at)) return false;
  i = line.find(between == ':' ? ": " : " : ", i);
  if (i == std::string_view::npos) return false;
  *rest = line.substr(i + (between == ':' ? 2 : 3));
  return true;
}

}  // namespace

std::string ShaderText::read(const std::string& path) const {
  if (folder_.empty()) {
    for (size_t i = 0; i < kEmbeddedShaderCount; ++i)
      if (path == kEmbeddedShaders[i].path) return kEmbeddedShaders[i].text;
    throw SceneError(fmt::format("found no shader text \"{}\" in this program", path));
  }
  std::ifstream file(folder_ + "/" + path, std::ios::binary);
  std::ostringstream whole;
  if (!file || !(whole << file.rdbuf()))
    throw SceneError(fmt::format("cannot read \"{}/{}\"", folder_, path));
  return whole.str();
}

FlatShader flatten(const ShaderText& text, const std::string& path, const std::vector<std::string>& defines) {
  Flattener flattener(text);
  flattener.result.text =
      "#version 450 core\n#define KERNEL\n#define OUT(type) out type\n#define INOUT(type) inout type\n";
  for (const std::string& define : defines) flattener.result.text += "#define " + define + '\n';
  flattener.add(path, "");
  return flattener.result;
}

std::string readable_log(std::string_view log, const FlatShader& shader) {
  std::string result;
  while (!log.empty()) {
    const size_t end = std::min(log.find('\n'), log.size());
    const std::string_view line = log.substr(0, end);
    log.remove_prefix(std::min(end + 1, log.size()));
    if (line.empty() || line[0] == '\0') continue;
    size_t file;
    int at;
    std::string_view rest;
    if (!result.empty()) result += '\n';
    if (split_place(line, &file, &at, &rest) && file < shader.files.size())
      result += fmt::format("{}:{}: {}", shader.files[file], at, rest);
    else
      result += line;
  }
  return result;
}

}  // namespace zonal::gl
