// Reading JSON field by field: what is accepted, and that each refusal says where, what was found and what
// was meant.

#include "core/json_fields.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/params.h"

namespace zonal {
namespace {

using nlohmann::json;

/// The error that reading `text` by `read` ends with; "" when it is accepted.
template <class Read>
std::string error_of(const std::string& text, Read read) {
  const json value = json::parse(text);
  try {
    Fields fields(value, "box.json: /objects/3");
    read(fields);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(nearest_name, finds_what_was_meant_and_nothing_else) {
  const std::vector<std::string> names{"radius", "position", "eta", "k", "vertical_fov"};
  // One slip of each kind: a letter left out, added, changed, two swapped; the wrong case; the end forgotten.
  EXPECT_EQ(nearest_name("radus", names), "radius");
  EXPECT_EQ(nearest_name("raddius", names), "radius");
  EXPECT_EQ(nearest_name("radios", names), "radius");
  EXPECT_EQ(nearest_name("raduis", names), "radius");
  EXPECT_EQ(nearest_name("Radius", names), "radius");
  EXPECT_EQ(nearest_name("pos", names), "position");
  EXPECT_EQ(nearest_name("verticalFov", names), "vertical_fov");
  // Other words, and names of which nothing would be left.
  EXPECT_EQ(nearest_name("transform", names), "");
  EXPECT_EQ(nearest_name("x", names), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name(std::string(1'000'000, 'r'), names), "");
}

TEST(nearest_name, lists_what_there_is_when_nothing_is_near) {
  const std::vector<std::string> names{"radius", "center"};
  EXPECT_EQ(did_you_mean("radus", names), " (did you mean \"radius\"?)");
  EXPECT_EQ(did_you_mean("colour", names), " (there is: radius, center)");
  EXPECT_EQ(did_you_mean("colour", {}), "");
}

TEST(range, says_itself) {
  EXPECT_EQ((Range{0, 1}).text(), "in [0, 1]");
  EXPECT_EQ((Range{.low = 0, .open_low = true}).text(), "> 0");
  EXPECT_EQ((Range{.low = 0, .high = 180, .open_low = true, .open_high = true}).text(), "in (0, 180)");
  EXPECT_EQ((Range{.low = 2}).text(), ">= 2");
  EXPECT_EQ((Range{.high = 2}).text(), "<= 2");
  EXPECT_EQ(Range{}.text(), "");
}

TEST(range, open_ends_are_outside) {
  const Range half_open{.low = 0, .high = 1, .open_low = true};
  EXPECT_FALSE(half_open.contains(0));
  EXPECT_TRUE(half_open.contains(1));
  const Range open{.low = 0, .high = 1, .open_low = true, .open_high = true};
  EXPECT_FALSE(open.contains(1));
  EXPECT_FALSE(open.contains(std::nan("")));
}

TEST(fields, read_each_kind_of_value) {
  const json value = json::parse(R"({"n": 2.5, "i": 4, "whole": 1e3, "f": true, "t": "x", "p": [1, 2],
                                     "v": [1, 2, 3], "c": "#ff8000", "g": 0.25, "choice": "paths"})");
  Fields fields(value, "f.json");
  EXPECT_EQ(fields.number("n"), 2.5f);
  EXPECT_EQ(fields.integer("i", 0), 4);
  EXPECT_EQ(fields.integer("whole", 0), 1000);
  EXPECT_TRUE(fields.flag("f", false));
  EXPECT_EQ(fields.text("t"), "x");
  EXPECT_EQ(fields.pair("p", vec2(0)), vec2(1, 2));
  EXPECT_EQ(fields.vector("v"), vec3(1, 2, 3));
  EXPECT_EQ(fields.color("g", vec3(0)), vec3(0.25f));
  const std::vector<std::string> names{"grid", "paths"};
  EXPECT_EQ(fields.choice("choice", 0, names), 1);
  // IEC 61966-2-1: 128/255 = 0.50196 decodes to ((0.50196 + 0.055) / 1.055)^2.4 = 0.215861.
  const vec3 orange = fields.color("c", vec3(0));
  EXPECT_EQ(orange.x, 1.0f);
  EXPECT_NEAR(orange.y, 0.215861f, 2e-6f);
  EXPECT_EQ(orange.z, 0.0f);
  EXPECT_NO_THROW(fields.finish());
}

TEST(fields, absent_keys_keep_their_defaults) {
  const json value = json::object();
  Fields fields(value, "f.json");
  EXPECT_EQ(fields.number("n", 1.5f), 1.5f);
  EXPECT_EQ(fields.integer("i", 7), 7);
  EXPECT_EQ(fields.text("t", "there"), "there");
  EXPECT_EQ(fields.vector("v", vec3(1, 2, 3)), vec3(1, 2, 3));
  EXPECT_NO_THROW(fields.finish());
}

TEST(fields, an_unread_key_is_an_error_with_the_nearest_name) {
  EXPECT_EQ(error_of(R"({"raduis": 1})", [](Fields& f) { f.number("radius", 1.0f), f.finish(); }),
            "box.json: /objects/3: unknown key \"raduis\" (did you mean \"radius\"?)");
  EXPECT_EQ(error_of(R"({"raduis": 1})", [](Fields& f) { f.number("radius"); }),
            "box.json: /objects/3: found no \"radius\" but \"raduis\", expected a number");
}

TEST(fields, errors_name_place_found_and_expected) {
  const auto number = [](Fields& f) { f.number("radius", {.low = 0, .open_low = true}); };
  EXPECT_EQ(error_of("{}", number), "box.json: /objects/3: found no \"radius\", expected a number > 0");
  EXPECT_EQ(error_of(R"({"radius": 0})", number),
            "box.json: /objects/3/radius: found 0, expected a number > 0");
  EXPECT_EQ(error_of(R"({"radius": "1"})", number),
            "box.json: /objects/3/radius: found the string \"1\", expected a number > 0");
  // 1e-60 is above 0 but no float is that small: it would become 0.
  EXPECT_EQ(error_of(R"({"radius": 1e-60})", number),
            "box.json: /objects/3/radius: found 1e-60, expected a number > 0");
  EXPECT_EQ(error_of("[1]", [](Fields&) {}), "box.json: /objects/3: found [1], expected an object {...}");
  EXPECT_EQ(error_of(R"({"v": [1, null, 3]})", [](Fields& f) { f.vector("v"); }),
            "box.json: /objects/3/v/1: found null, expected a number");
}

TEST(fields, whole_numbers_only_where_they_are_counted) {
  const auto count = [](Fields& f) { f.integer("n", 1, {1, 1e7}); };
  EXPECT_EQ(error_of(R"({"n": 400.0})", count), "");
  EXPECT_EQ(error_of(R"({"n": 3.5})", count),
            "box.json: /objects/3/n: found 3.5, expected a whole number in [1, 1e+07]");
  EXPECT_NE(error_of(R"({"n": "400"})", count), "");
  EXPECT_NE(error_of(R"({"n": 3000000000})", [](Fields& f) { f.integer("n", 1); }), "");
}

TEST(fields, errors_stay_on_one_line_whatever_is_found) {
  const std::string error =
      error_of("{\"radius\": \"a\\nb\\u0000c\"}", [](Fields& f) { f.number("radius", 1.0f); });
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  EXPECT_EQ(error.find('\0'), std::string::npos) << error;
  EXPECT_NE(error.find("a\\nb"), std::string::npos) << error;
  const std::string long_text = error_of("{\"radius\": \"" + std::string(100'000, 'x') + "\"}",
                                         [](Fields& f) { f.number("radius", 1.0f); });
  EXPECT_LT(long_text.size(), 200u);
}

TEST(where, pointers_are_json_pointers) {
  EXPECT_EQ(where_of("a.json", "camera"), "a.json: /camera");
  EXPECT_EQ(where_of("a.json: /objects", size_t(2)), "a.json: /objects/2");
  EXPECT_EQ(where_of("a.json: /x", "a/b~c"), "a.json: /x/a~1b~0c");  // RFC 6901
}

// ---- parameters --------------------------------------------------------------------------------------

struct SomeParams {
  enum class Distribution { grid, paths };
  int lights = 400;
  float clamp = 0.1f;
  bool occlusion = true;
  Distribution distribution = Distribution::grid;
  void visit(ParamVisitor& v) {
    v.integer("lights", lights, {1, 1e7}, "", "virtual lights");
    v.number("clamp", clamp, {.low = 0}, "radii", "shortest distance");
    v.flag("occlusion", occlusion, "whether rays decide");
    v.choice("distribution", distribution, {"grid", "paths"}, "where lights come from");
  }
};

TEST(params, are_read_by_name_and_type_is_skipped) {
  const SomeParams params = read_params<SomeParams>(
      json::parse(
          R"({"type": "some", "lights": 10, "clamp": 0.5, "occlusion": false, "distribution": "paths"})"),
      "w");
  EXPECT_EQ(params.lights, 10);
  EXPECT_EQ(params.clamp, 0.5f);
  EXPECT_FALSE(params.occlusion);
  EXPECT_EQ(params.distribution, SomeParams::Distribution::paths);
}

TEST(params, what_is_written_is_read_again) {
  SomeParams params;
  params.lights = 17, params.clamp = 0.3f, params.distribution = SomeParams::Distribution::paths;
  const json written = write_params(params);
  EXPECT_EQ(written.dump(), R"({"clamp":0.3,"distribution":"paths","lights":17,"occlusion":true})");
  const SomeParams again = read_params<SomeParams>(written, "w");
  EXPECT_EQ(again.lights, 17);
  EXPECT_EQ(again.clamp, 0.3f);
  EXPECT_EQ(again.distribution, params.distribution);
}

TEST(params, are_listed_with_default_range_and_unit) {
  const std::vector<ParamInfo> infos = list_params<SomeParams>();
  ASSERT_EQ(infos.size(), 4u);
  EXPECT_EQ(infos[0].name, "lights");
  EXPECT_EQ(infos[0].default_value, "400");
  EXPECT_EQ(infos[0].range, "[1, 1e+07]");
  EXPECT_EQ(infos[1].default_value, "0.1");
  EXPECT_EQ(infos[1].range, ">= 0");
  EXPECT_EQ(infos[1].unit, "radii");
  EXPECT_EQ(infos[2].default_value, "true");
  EXPECT_EQ(infos[3].default_value, "grid");
  EXPECT_EQ(infos[3].range, "grid, paths");
}

TEST(params, refuse_what_they_do_not_have) {
  const auto error = [](const char* text) -> std::string {
    try {
      read_params<SomeParams>(json::parse(text), "--set");
    } catch (const SceneError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(error(R"({"light": 5})"), "--set: unknown key \"light\" (did you mean \"lights\"?)");
  EXPECT_EQ(error(R"({"lights": 0})"), "--set: /lights: found 0, expected a whole number in [1, 1e+07]");
  EXPECT_EQ(error(R"({"distribution": "path"})"),
            "--set: /distribution: found the string \"path\", expected one of grid, paths (did you mean "
            "\"paths\"?)");
}

struct MixedParams {
  enum class Radius { field_of_view, density, metres };
  int bands = 9;
  Radius radius = Radius::field_of_view;
  float metres = 0.5f;
  void visit(ParamVisitor& v) {
    v.integer_or_auto("bands", bands, {1, 64}, "bands", "of the receiver");
    v.choice_or_number("radius", radius, metres, {"field_of_view", "density"}, {.low = 0, .open_low = true},
                       "m", "of a light");
  }
};

TEST(params, a_word_or_a_number) {
  const auto read = [](const char* text) { return read_params<MixedParams>(json::parse(text), "w"); };
  EXPECT_EQ(read(R"({"bands": "auto"})").bands, kAuto);
  EXPECT_EQ(read(R"({"bands": 12})").bands, 12);
  EXPECT_EQ(read("{}").bands, 9);
  EXPECT_EQ(read(R"({"radius": "density"})").radius, MixedParams::Radius::density);
  const MixedParams number = read(R"({"radius": 0.25})");
  EXPECT_EQ(number.radius, MixedParams::Radius::metres);
  EXPECT_EQ(number.metres, 0.25f);
}

TEST(params, a_word_or_a_number_is_written_as_it_is_read) {
  for (const char* text : {R"({"bands":"auto","radius":"density"})", R"({"bands":3,"radius":0.1})"}) {
    const MixedParams params = read_params<MixedParams>(json::parse(text), "w");
    EXPECT_EQ(write_params(params).dump(), text);
  }
}

TEST(params, a_word_or_a_number_is_listed) {
  const std::vector<ParamInfo> infos = list_params<MixedParams>();
  ASSERT_EQ(infos.size(), 2u);
  EXPECT_EQ(infos[0].default_value, "9");
  EXPECT_EQ(infos[0].range, "auto, or [1, 64]");
  EXPECT_EQ(infos[1].default_value, "field_of_view");
  EXPECT_EQ(infos[1].range, "field_of_view, density, or > 0");
}

TEST(params, neither_the_word_nor_a_number_in_the_range) {
  const auto error = [](const char* text) -> std::string {
    try {
      read_params<MixedParams>(json::parse(text), "w");
    } catch (const SceneError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(error(R"({"bands": 0})"), "w: /bands: found 0, expected auto or a whole number in [1, 64]");
  EXPECT_EQ(error(R"({"bands": 2.5})"), "w: /bands: found 2.5, expected auto or a whole number in [1, 64]");
  EXPECT_EQ(error(R"({"bands": "aut"})"),
            "w: /bands: found the string \"aut\", expected auto or a whole number in [1, 64] (did you mean "
            "\"auto\"?)");
  EXPECT_EQ(error(R"({"bands": 1e300})"),
            "w: /bands: found 1e+300, expected auto or a whole number in [1, 64]");
  EXPECT_EQ(error(R"({"radius": 0})"), "w: /radius: found 0, expected a number > 0");
  EXPECT_EQ(error(R"({"radius": "densty"})"),
            "w: /radius: found the string \"densty\", expected one of field_of_view, density or a number > 0 "
            "(did you "
            "mean \"density\"?)");
  EXPECT_EQ(error(R"({"radius": null})"),
            "w: /radius: found null, expected one of field_of_view, density or a number > 0");
}

}  // namespace
}  // namespace zonal
