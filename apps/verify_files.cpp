// Which kind of golden-vector file it is, by what its cases hold.
#include <fmt/format.h>

#include "apps/verify_kinds.h"
#include "core/error.h"
#include "core/json_fields.h"
#include "core/strict_json.h"

namespace zonal {
namespace {

struct Kind {
  const char* name;
  const char* key;  ///< a key that no other kind has, in the file or in its first case
  void (*verify)(const Golden&, Report&);
};

constexpr Kind kKinds[] = {
    {"sh_basis", "Y", verify_basis},
    {"sh_gradient", "grad", verify_gradient},
    {"zh_sphere", "zh", verify_sphere_and_disk},
    {"zh_sphere", "sh_cases", verify_sphere_and_disk},
    {"polygon_sh", "vertices", verify_polygons},
    {"rotation", "quat_wxyz", verify_rotations},
    {"products", "product_truncated", verify_products},
    {"products", "product_full", verify_products},
    {"products", "triple_entries", verify_products},
    {"products", "clamped_cosine", verify_products},
    {"ggx_zh", "alpha", verify_ggx},
    {"yuksel", "attenuation", verify_attenuation},
};

const Kind& kind_of(const nlohmann::json& root, const std::string& file) {
  const nlohmann::json* first = nullptr;
  if (const auto cases = root.find("cases"); cases != root.end() && cases->is_array() && !cases->empty())
    first = &cases->front();
  for (const Kind& kind : kKinds)
    if (root.contains(kind.key) || (first && first->is_object() && first->contains(kind.key))) return kind;
  std::string keys;
  for (const Kind& kind : kKinds) keys += fmt::format("{}{}", keys.empty() ? "" : ", ", kind.key);
  throw SceneError(fmt::format("{}: found no golden vectors, expected cases with one of {}", file, keys));
}

}  // namespace

std::string label_of(const Golden& golden_case, size_t index, const char* list) {
  const std::string tag = golden_case.text("tag", golden_case.text("kind", ""));
  return fmt::format("{} {}{}{}", list, index, tag.empty() ? "" : " ", tag.empty() ? "" : in_quotes(tag));
}

Verdict verify_file(const std::string& file) {
  const nlohmann::json root = parse_json(read_text_file(file, "a golden-vector file"), file);
  const Golden golden(root, file);
  const Kind& kind = kind_of(root, file);
  Report report(kind.name);
  kind.verify(golden, report);
  return {file, kind.name, report.cases, std::move(report.in_float), std::move(report.in_double)};
}

}  // namespace zonal
