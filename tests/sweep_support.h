#pragma once
/// A small sweep in a folder of its own, and the program that runs it.

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "sweep/process.h"
#include "tests/paths.h"

namespace zonal {

inline const std::string kScene = test::source_dir() + "/scenes/cornell/cornell.json";

/// A folder that goes away with the test.
struct Folder {
  std::string path;
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "zonal-sweep-XXXXXX").string();
    path = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path + "/" + name) << text;
    return path + "/" + name;
  }
};

inline std::string text_of(const std::string& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

inline nlohmann::json small_sweep() {
  return {{"name", "small"},
          {"scenes", {kScene}},
          {"size", "24x16"},
          {"seeds", 2},
          {"runs", 1},
          {"budget", {{"passes", 2}}},
          {"reference", {{"passes", 4}}},
          {"methods", {"path", {{"integrator", "vpl"}, {"set", {{"lights", {4, 16}}}}}}}};
}

/// `zonal sweep` with these arguments; the last line it complained of, if wanted.
inline int sweep(std::vector<std::string> arguments, std::string* complaint = nullptr) {
  arguments.insert(arguments.begin(), {test::program(), "sweep"});
  arguments.push_back("--quiet");
  const ProcessResult result = run_process(arguments, nullptr);
  if (complaint) *complaint = result.last_line;
  return result.signal ? -result.signal : result.exit_code;
}

inline int sweep(const std::string& file, const std::string& out) {
  return sweep({file, "-o", out});
}

}  // namespace zonal
