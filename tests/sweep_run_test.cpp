// Whole sweeps: what they leave behind, how they resume, and what they refuse.

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <random>
#include <thread>

#include "core/image.h"
#include "tests/sweep_support.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json results_of(const std::string& out) {
  return json::parse(text_of(out + "/results.json"));
}

/// The error columns: every score of every cell and of its curve.
json errors(const std::string& out) {
  const json results = results_of(out);
  json all = json::array();
  for (const json& cell : results["cells"]) {
    json curve = json::array();
    for (const json& point : cell.value("curve", json::array()))
      curve.push_back({point["passes"], point["scores"]});
    all.push_back({cell["id"], cell["scores"], curve});
  }
  return all;
}

TEST(Sweep, runs_reports_and_does_nothing_twice) {
  const Folder folder;
  const std::string file = folder.write("s.json", small_sweep().dump()), out = folder.path + "/out";
  ASSERT_EQ(sweep(file, out), 0);
  for (const char* name : {"index.html", "data.js", "results.json", "results.csv", "table.md", "table.tex"})
    EXPECT_TRUE(fs::exists(out + "/" + name)) << name;
  const json results = json::parse(text_of(out + "/results.json"));
  ASSERT_EQ(results["cells"].size(), 6u);
  for (const json& cell : results["cells"]) {
    EXPECT_EQ(cell["status"], "done") << cell["reason"];
    EXPECT_GT(cell["scores"]["rmse"].get<double>(), 0);
    EXPECT_TRUE(fs::exists(out + "/" + cell["image"].get<std::string>()));
  }
  const auto before =
      fs::last_write_time(out + "/cells/" + results["cells"][0]["id"].get<std::string>() + "/cell.json");
  ASSERT_EQ(sweep(file, out), 0);
  EXPECT_EQ(
      fs::last_write_time(out + "/cells/" + results["cells"][0]["id"].get<std::string>() + "/cell.json"),
      before);
}

TEST(Sweep, another_sweeps_folder_and_a_folder_of_other_things_are_refused) {
  const Folder folder;
  json one = small_sweep(), other = small_sweep();
  one["methods"] = other["methods"] = {"path"};
  other["name"] = "other";
  const std::string out = folder.path + "/out";
  ASSERT_EQ(sweep(folder.write("a.json", one.dump()), out), 0);
  EXPECT_EQ(sweep(folder.write("b.json", other.dump()), out), 2);
  EXPECT_EQ(sweep(folder.path + "/a.json", folder.path), 2);  // holds a.json, no sweep
}

TEST(Sweep, a_cell_that_fails_is_a_row_with_its_reason) {
  const Folder folder;
  json sweep_json = small_sweep();
  // What the scene's file says is in order; the mesh it names is none.
  const json broken = {{"camera", {{"position", {0, 0, 1}}, {"look_at", {0, 0, 0}}, {"resolution", {8, 8}}}},
                       {"objects", {{{"type", "mesh"}, {"file", "broken.obj"}}}}};
  folder.write("broken.obj", "v a b c\n");
  sweep_json["scenes"] = {kScene, folder.write("broken.json", broken.dump())};
  sweep_json["methods"] = {"path"};
  const std::string out = folder.path + "/out";
  const int code = sweep(folder.write("s.json", sweep_json.dump()), out);
  EXPECT_EQ(code, 1);
  const json results = json::parse(text_of(out + "/results.json"));
  int failed = 0;
  for (const json& cell : results["cells"]) {
    if (cell["status"] != "failed") continue;
    ++failed;
    EXPECT_NE(cell["reason"].get<std::string>().find("broken"), std::string::npos) << cell["reason"];
  }
  EXPECT_EQ(failed, 2);
}

TEST(Sweep, killed_at_random_moments_it_resumes_to_the_same_table) {
  const Folder folder;
  const std::string file = folder.write("s.json", small_sweep().dump());
  ASSERT_EQ(sweep(file, folder.path + "/whole"), 0);
  std::mt19937 random(3);
  const std::string out = folder.path + "/killed", program = test::program();
  for (int kill_count = 0; kill_count < 20; ++kill_count) {
    const pid_t child = fork();
    if (child == 0) {
      execl(program.c_str(), "zonal", "sweep", file.c_str(), "-o", out.c_str(), "--quiet", nullptr);
      _exit(127);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 700));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (!fs::exists(out + "/cells")) continue;
    // What counts as finished is whole.
    for (const auto& cell : fs::directory_iterator(out + "/cells")) {
      if (!fs::exists(cell.path() / "cell.json")) continue;
      EXPECT_EQ(json::parse(text_of(cell.path() / "cell.json"))["status"], "done");
      EXPECT_EQ(read_image(cell.path() / "image.exr").layers.at("").pixels,
                read_image(folder.path + "/whole/cells/" + cell.path().filename().string() + "/image.exr")
                    .layers.at("")
                    .pixels);
    }
  }
  ASSERT_EQ(sweep(file, out), 0);
  EXPECT_EQ(errors(out), errors(folder.path + "/whole"));
}

TEST(Sweep, two_sweeps_of_one_file_have_the_same_errors_bit_for_bit) {
  const Folder folder;
  json wanted = small_sweep();
  wanted["curve"] = true, wanted["metrics"] = {"rmse", "flip", "flip_hdr"};
  wanted["budget"] = {{{"passes", 1}}, {{"passes", 3}}};
  const std::string file = folder.write("s.json", wanted.dump());
  ASSERT_EQ(sweep(file, folder.path + "/a"), 0);
  ASSERT_EQ(sweep(file, folder.path + "/b"), 0);
  EXPECT_EQ(errors(folder.path + "/a"), errors(folder.path + "/b"));
  const json results = results_of(folder.path + "/a");
  for (const json& cell : results["cells"]) {
    EXPECT_TRUE(cell["scores"]["flip_hdr"].is_number());
    // After 1, 2, 4, ... passes and after the last.
    std::vector<int> passes;
    for (const json& point : cell["curve"]) passes.push_back(point["passes"]);
    EXPECT_EQ(passes, cell["passes"] == 3 ? std::vector<int>({1, 2, 3}) : std::vector<int>({1}));
    EXPECT_EQ(cell["curve"].back()["scores"], cell["scores"]);
  }
  EXPECT_FALSE(results["groups"][2]["time_ratio"].is_null());
}

TEST(Sweep, timed_cells_replayed_from_their_record_are_the_same_bits) {
  const Folder folder;
  json timed = small_sweep();
  timed["budget"] = {{{"seconds", 0.05}}, {{"passes", 1}}, {{"equal_time", 0.05}}};
  timed["seeds"] = 1;
  const std::string file = folder.write("s.json", timed.dump()), out = folder.path + "/out";
  const int code = sweep(file, out);
  ASSERT_EQ(code, 0);
  EXPECT_EQ(sweep({file, "-o", out, "--replay"}), 0);
  // It can fail: another picture in a cell's place is found out.
  const json results = results_of(out);
  const std::string first = out + "/cells/" + results["cells"][0]["id"].get<std::string>() + "/image.exr";
  ImageFile changed = read_image(first);
  changed.layers[""].pixels[5] += 1e-4f;
  write_image(first, changed, 1);
  EXPECT_EQ(sweep({file, "-o", out, "--replay"}), 1);
}

TEST(Sweep, references_are_made_once_and_again_when_their_size_is_wrong) {
  const Folder folder;
  const std::string file = folder.write("s.json", small_sweep().dump()), out = folder.path + "/out";
  ASSERT_EQ(sweep(file, out), 0);
  const json before = errors(out);
  const std::string key = results_of(out)["references"][0]["id"], exr = out + "/references/" + key + ".exr";
  const auto made = fs::last_write_time(exr);
  ASSERT_EQ(sweep(file, out), 0);
  EXPECT_EQ(fs::last_write_time(exr), made);
  // Someone has put a larger picture in its place.
  ImageFile large = read_image(exr);
  for (auto& [name, layer] : large.layers) layer = Image(48, 32, layer.channels);
  write_image(exr, large, 1);
  ASSERT_EQ(sweep(file, out), 0);
  EXPECT_EQ(read_image(exr).layers.at("").width, 24);
  EXPECT_EQ(errors(out), before);
}

TEST(Sweep, a_picture_that_cannot_be_scored_is_a_row_with_its_reason) {
  const Folder folder;
  json one = small_sweep();
  one["methods"] = {"path"};
  const std::string file = folder.write("s.json", one.dump()), out = folder.path + "/out";
  ASSERT_EQ(sweep(file, out), 0);
  const std::string cell = out + "/cells/" + results_of(out)["cells"][0]["id"].get<std::string>();
  write_image(cell + "/image.exr", {.layers = {{"", Image(48, 32)}}}, 1);
  fs::remove(cell + "/scores.json");
  sweep({file, "-o", out, "--score-only"});
  const json results = results_of(out);
  EXPECT_EQ(results["cells"][0]["status"], "failed");
  EXPECT_NE(results["cells"][0]["reason"].get<std::string>().find("48x32"), std::string::npos)
      << results["cells"][0]["reason"];
  EXPECT_EQ(results["cells"][1]["status"], "done");
}

TEST(Sweep, failed_cells_run_again_with_retry_alone) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", text_of(kScene));
  json one = small_sweep();
  one["scenes"] = {scene}, one["methods"] = {{{"integrator", "vpl"}, {"set", {{"lights", 4}}}}};
  const std::string file = folder.write("s.json", one.dump()), out = folder.path + "/out";
  ASSERT_EQ(sweep(file, out), 0);
  const json results = results_of(out);
  const std::string record = out + "/cells/" + results["cells"][0]["id"].get<std::string>() + "/cell.json";
  json failed = json::parse(text_of(record));
  failed["status"] = "failed", failed["reason"] = "killed by signal 9 (out of memory?)";
  std::ofstream(record) << failed.dump();
  EXPECT_EQ(sweep(file, out), 1);
  EXPECT_EQ(results_of(out)["cells"][0]["reason"], failed["reason"]);
  EXPECT_EQ(sweep({file, "-o", out, "--retry"}), 0);
  EXPECT_EQ(results_of(out)["cells"][0]["scores"], results["cells"][0]["scores"]);
}

TEST(Sweep, a_full_disk_ends_it_in_one_line_with_nothing_finished_lost) {
  const Folder folder;
  const std::string file = folder.write("s.json", small_sweep().dump()), out = folder.path + "/out";
  ASSERT_EQ(sweep({file, "-o", out, "--only", "path"}), 0);
  // No file may grow beyond 4 KB: pictures find no room, records do.
  const auto limited = [&] {
    return run_process(
        {"/bin/sh", "-c",
         "trap '' XFSZ; ulimit -f 8; exec " + test::program() + " sweep " + file + " -o " + out + " --quiet"},
        nullptr);
  };
  const ProcessResult result = limited();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.last_line.find("no room is left"), std::string::npos) << result.last_line;
  EXPECT_NE(result.last_line.find("the same command goes on"), std::string::npos) << result.last_line;
  ASSERT_EQ(sweep(file, out), 0);
  const json results = results_of(out);
  for (const json& cell : results["cells"]) EXPECT_EQ(cell["status"], "done") << cell["reason"];
  for (const auto& entry : fs::recursive_directory_iterator(out))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
}

TEST(Sweep, dry_run_prints_cells_and_an_estimate_and_leaves_nothing) {
  const Folder folder;
  const std::string file = folder.write("s.json", small_sweep().dump()), out = folder.path + "/out";
  const std::string printed = folder.path + "/printed";
  const ProcessResult result = run_process(
      {"/bin/sh", "-c", test::program() + " sweep " + file + " -o " + out + " --dry-run > " + printed},
      nullptr);
  EXPECT_EQ(result.exit_code, 0) << result.last_line;
  const std::string text = text_of(printed);
  EXPECT_NE(text.find("cornell | vpl lights=16 | 2 passes | seed 1\n"), std::string::npos) << text;
  EXPECT_NE(text.find("6 cells in 3 groups, 2 references; about "), std::string::npos) << text;
  EXPECT_FALSE(fs::exists(out));
}

TEST(Sweep, a_scene_may_be_named_after_a_path) {
  const Folder folder;
  json one = small_sweep();
  one["methods"] = {"path"}, one["seeds"] = 1;
  one["scenes"] = {{{"file", kScene}, {"id", "a/b, bronze = \"x\""}}};
  const std::string file = folder.write("s.json", one.dump()), out = folder.path + "/out";
  ASSERT_EQ(sweep(file, out), 0);
  EXPECT_TRUE(fs::exists(out + "/" + results_of(out)["scenes"][0]["chart"].get<std::string>()));
}

}  // namespace
}  // namespace zonal
