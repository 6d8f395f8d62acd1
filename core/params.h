#pragma once
/// An integrator's settings: a plain struct whose `visit` names each member once, with range, unit and
/// meaning. Reading (scene file, --set), listing (`zonal list`, docs) and recording (--stats, image metadata)
/// all use it.
///
///     struct VplParams {
///       int lights = 400;
///       void visit(ParamVisitor& v) {
///         v.integer("lights", lights, {1, 1e7}, "", "virtual lights stored in all, after all bounces");
///       }
///     };
///     VplParams params = read_params<VplParams>(json, "scene.json: /integrator");

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/json_fields.h"

namespace zonal {

/// What `integer_or_auto` holds for the word "auto"; ranges lie above it.
inline constexpr int kAuto = -1;

class ParamVisitor {
 public:
  virtual ~ParamVisitor() = default;
  virtual void integer(const char* name, int& value, Range range, const char* unit, const char* help) = 0;
  /// A whole number in `range`, or the word "auto" (kAuto).
  virtual void integer_or_auto(const char* name, int& value, Range range, const char* unit,
                               const char* help) = 0;
  virtual void number(const char* name, float& value, Range range, const char* unit, const char* help) = 0;
  virtual void flag(const char* name, bool& value, const char* help) = 0;

  /// An enum whose enumerators count 0, 1, 2, ... in the order of `names`.
  template <class Enum>
  void choice(const char* name, Enum& value, std::vector<std::string> names, const char* help) {
    int index = static_cast<int>(value);
    choice_index(name, index, names, help);
    value = static_cast<Enum>(index);
  }

  /// One of `names`, or a number in `range`: then `word` is the enumerator after those of the names. `number`
  /// keeps its value while a word stands.
  template <class Enum>
  void choice_or_number(const char* name, Enum& word, float& number, std::vector<std::string> names,
                        Range range, const char* unit, const char* help) {
    int index = static_cast<int>(word);
    choice_index_or_number(name, index, number, names, range, unit, help);
    word = static_cast<Enum>(index);
  }

 protected:
  virtual void choice_index(const char* name, int& index, const std::vector<std::string>& names,
                            const char* help) = 0;
  /// index == names.size(): the number.
  virtual void choice_index_or_number(const char* name, int& index, float& number,
                                      const std::vector<std::string>& names, Range range, const char* unit,
                                      const char* help) = 0;
};

/// What `zonal list` and the generated documentation print of one parameter.
struct ParamInfo {
  std::string name, default_value, range, unit, help;
};

/// Reads members from a JSON object; keys no member claims are left to `Fields::finish`.
class ParamReader : public ParamVisitor {
 public:
  explicit ParamReader(Fields& fields) : fields_(fields) {}
  void integer(const char*, int&, Range, const char*, const char*) override;
  void integer_or_auto(const char*, int&, Range, const char*, const char*) override;
  void number(const char*, float&, Range, const char*, const char*) override;
  void flag(const char*, bool&, const char*) override;
  void choice_index(const char*, int&, const std::vector<std::string>&, const char*) override;
  void choice_index_or_number(const char*, int&, float&, const std::vector<std::string>&, Range, const char*,
                              const char*) override;

 private:
  Fields& fields_;
};

/// Collects a ParamInfo a member.
class ParamLister : public ParamVisitor {
 public:
  std::vector<ParamInfo> infos;
  void integer(const char*, int&, Range, const char*, const char*) override;
  void integer_or_auto(const char*, int&, Range, const char*, const char*) override;
  void number(const char*, float&, Range, const char*, const char*) override;
  void flag(const char*, bool&, const char*) override;
  void choice_index(const char*, int&, const std::vector<std::string>&, const char*) override;
  void choice_index_or_number(const char*, int&, float&, const std::vector<std::string>&, Range, const char*,
                              const char*) override;
};

/// Writes members into a JSON object, so that a run can be had again.
class ParamWriter : public ParamVisitor {
 public:
  nlohmann::json values = nlohmann::json::object();
  void integer(const char*, int&, Range, const char*, const char*) override;
  void integer_or_auto(const char*, int&, Range, const char*, const char*) override;
  void number(const char*, float&, Range, const char*, const char*) override;
  void flag(const char*, bool&, const char*) override;
  void choice_index(const char*, int&, const std::vector<std::string>&, const char*) override;
  void choice_index_or_number(const char*, int&, float&, const std::vector<std::string>&, Range, const char*,
                              const char*) override;
};

/// Reads all of `Params` from `object`; "type" is skipped. Throws SceneError on a bad value or an unknown
/// key.
template <class Params>
Params read_params(const nlohmann::json& object, const std::string& where) {
  Params params;
  Fields fields(object, where);
  fields.find("type");
  ParamReader reader(fields);
  params.visit(reader);
  fields.finish();
  return params;
}

template <class Params>
std::vector<ParamInfo> list_params() {
  Params params;
  ParamLister lister;
  params.visit(lister);
  return lister.infos;
}

template <class Params>
nlohmann::json write_params(Params params) {
  ParamWriter writer;
  params.visit(writer);
  return writer.values;
}

}  // namespace zonal
