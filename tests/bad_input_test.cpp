// Bad scene files: each ends in one line that names the place, what was found and what was expected.
// tests/bad_input/expected.txt holds the exact line of every file in that folder.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "core/scene_loader.h"
#include "tests/paths.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;

const fs::path kTests = fs::path(test::source_dir()) / "tests";

/// What loading ends with, folder names removed; "" when the scene loads.
template <class Load>
std::string error_of(Load load) {
  std::string error;
  try {
    load();
  } catch (const SceneError& e) {
    error = e.what();
  }
  const std::string folder = (kTests / "bad_input").string() + "/";
  for (size_t at; (at = error.find(folder)) != std::string::npos;) error.erase(at, folder.size());
  return error;
}

std::string parse_error(const std::string& text) {
  return error_of([&] { parse_scene(text, (kTests / "bad_input" / "inline.json").string()); });
}

/// The line of a file; "..." stands for what a library says in its own words.
bool matches(const std::string& error, std::string expected) {
  size_t from = 0;
  for (bool first = true;; first = false) {
    const size_t dots = expected.find("...");
    const std::string piece = expected.substr(0, dots);
    const size_t at = error.find(piece, from);
    if (at == std::string::npos || (first && at != 0)) return false;
    from = at + piece.size();
    if (dots == std::string::npos) return from == error.size();
    expected = expected.substr(dots + 3);
    if (expected.empty()) return true;
  }
}

TEST(bad_input, every_file_of_the_corpus_gets_its_line) {
  std::map<std::string, std::string> expected;
  std::ifstream table(kTests / "bad_input" / "expected.txt");
  for (std::string line; std::getline(table, line);) expected[line.substr(0, line.find(".json"))] = line;

  size_t files = 0;
  for (const auto& entry : fs::directory_iterator(kTests / "bad_input")) {
    if (entry.path().extension() != ".json") continue;
    ++files;
    const std::string name = entry.path().stem().string();
    ASSERT_TRUE(expected.contains(name)) << name << " has no line in expected.txt";
    const std::string error = error_of([&] { load_scene(entry.path().string()); });
    EXPECT_TRUE(matches(error, expected[name])) << "found    " << error << "\nexpected " << expected[name];
    EXPECT_EQ(error.find_first_of("\n\r\t"), std::string::npos) << error;
  }
  EXPECT_EQ(files, expected.size()) << "expected.txt names files that are not there";
}

TEST(bad_input, a_missing_file_and_a_folder) {
  const std::string missing = (kTests / "bad_input" / "nothing_here.json").string();
  EXPECT_EQ(error_of([&] { load_scene(missing); }),
            "nothing_here.json: there is no such file, expected a scene");
  const std::string folder = kTests.string();
  EXPECT_EQ(error_of([&] { load_scene(folder); }), folder + ": found a folder, expected a scene");
}

TEST(bad_input, an_unset_data_folder_says_what_to_do) {
  const char* before = std::getenv("ZONAL_DATA");
  const std::string kept = before ? before : "";
  unsetenv("ZONAL_DATA");
  const std::string error = parse_error(R"({"camera": {"position": [0,0,1], "look_at": [0,0,0]},
                                             "objects": [{"type": "mesh", "file": "${ZONAL_DATA}/x.obj"}]})");
  if (before) setenv("ZONAL_DATA", kept.c_str(), 1);
  EXPECT_EQ(error,
            "inline.json: /objects/0/file: found \"${ZONAL_DATA}/x.obj\", but the environment variable "
            "ZONAL_DATA is "
            "not set: set it to the folder that holds the downloaded scenes (scenes/README.md says where to "
            "get them)");
}

TEST(bad_input, the_data_folder_is_put_in) {
  const char* before = std::getenv("ZONAL_DATA");
  const std::string kept = before ? before : "";
  setenv("ZONAL_DATA", (kTests / "scene_files").c_str(), 1);
  EXPECT_EQ(parse_error(R"({"camera": {"position": [0,0,1], "look_at": [0,0,0]},
                            "objects": [{"type": "mesh", "file": "${ZONAL_DATA}/sail.gltf"}]})"),
            "");
  if (before)
    setenv("ZONAL_DATA", kept.c_str(), 1);
  else
    unsetenv("ZONAL_DATA");
}

TEST(bad_input, nesting_and_size_are_bounded) {
  // A recursive reader would need a stack frame a bracket.
  EXPECT_NE(parse_error(std::string(1'000'000, '[')).find("nested deeper than 64 levels"), std::string::npos);
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += "{\"a\":";
  EXPECT_NE(parse_error(objects).find("nested deeper than 64 levels"), std::string::npos);
  std::string numbers = "{\"objects\": [0";
  for (int i = 0; i < 4'000'000; ++i) numbers += ",0";
  EXPECT_NE(parse_error(numbers + "]}").find("more than 4000000 values"), std::string::npos);
}

TEST(bad_input, absurd_sizes_asked_for_by_the_caller) {
  const std::string text = R"({"camera": {"position": [0,0,1], "look_at": [0,0,0], "resolution": [8, 8]}})";
  EXPECT_EQ(error_of([&] { parse_scene(text, "x.json", {.width = 70'000}); }),
            "x.json: /camera/resolution: found 70000 x 8 pixels, expected sides in [1, 65536] and at most "
            "268435456 "
            "pixels");
}

// ---- damaged copies of a scene that uses every key ---------------------------------------------------

std::string read_all(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// A scene either loads or ends in one line that starts with the file's name.
void expect_one_line(const std::string& error, const std::string& what) {
  if (error.empty()) return;
  EXPECT_EQ(error.find_first_of("\n\r"), std::string::npos) << what << ": " << error;
  EXPECT_NE(error.find("everything.json"), std::string::npos) << what << ": " << error;
  EXPECT_LT(error.size(), 600u) << what;
}

TEST(bad_input, a_file_cut_off_anywhere_is_one_line) {
  const fs::path file = kTests / "scene_files" / "everything.json";
  const std::string text = read_all(file);
  ASSERT_GT(text.size(), 1000u);
  for (size_t length = 0; length + 2 < text.size(); ++length) {
    const std::string error = error_of([&] { parse_scene(text.substr(0, length), file.string()); });
    EXPECT_FALSE(error.empty()) << length;
    expect_one_line(error, "cut at " + std::to_string(length));
  }
}

TEST(bad_input, any_value_of_the_wrong_kind_is_one_line) {
  using nlohmann::json;
  const fs::path file = kTests / "scene_files" / "everything.json";
  const json scene = json::parse(read_all(file));
  const std::vector<json> others{nullptr, -1, 1e30, "no such thing", json::array()};
  const json flat = scene.flatten();
  size_t refused = 0, tried = 0;
  for (const auto& [pointer, value] : flat.items()) {
    for (const json& other : others) {
      json damaged = scene;
      damaged[json::json_pointer(pointer)] = other;
      const std::string error = error_of([&] { parse_scene(damaged.dump(), file.string()); });
      expect_one_line(error, pointer + " = " + other.dump());
      refused += !error.empty();
      ++tried;
    }
  }
  // -1 is a fine coordinate and any string a fine name; most of the rest is not.
  EXPECT_GT(refused, tried / 2);
}

}  // namespace
}  // namespace zonal
