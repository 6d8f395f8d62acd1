#include "core/params.h"

#include <fmt/format.h>

namespace zonal {
namespace {

/// "[1, 1e+07]", "> 0" or "" for the range column of a table.
std::string range_column(const Range& range) {
  const std::string text = range.text();
  return text.rfind("in ", 0) == 0 ? text.substr(3) : text;
}

}  // namespace

void ParamReader::integer(const char* name, int& value, Range range, const char*, const char*) {
  value = fields_.integer(name, value, range);
}

void ParamReader::number(const char* name, float& value, Range range, const char*, const char*) {
  value = fields_.number(name, value, range);
}

void ParamReader::flag(const char* name, bool& value, const char*) {
  value = fields_.flag(name, value);
}

void ParamReader::choice_index(const char* name, int& index, const std::vector<std::string>& names,
                               const char*) {
  index = fields_.choice(name, index, names);
}

void ParamLister::integer(const char* name, int& value, Range range, const char* unit, const char* help) {
  infos.push_back({name, std::to_string(value), range_column(range), unit, help});
}

void ParamLister::number(const char* name, float& value, Range range, const char* unit, const char* help) {
  infos.push_back({name, fmt::format("{}", value), range_column(range), unit, help});
}

void ParamLister::flag(const char* name, bool& value, const char* help) {
  infos.push_back({name, value ? "true" : "false", "true, false", "", help});
}

void ParamLister::choice_index(const char* name, int& index, const std::vector<std::string>& names,
                               const char* help) {
  std::string list;
  for (const std::string& choice : names) list += (list.empty() ? "" : ", ") + choice;
  infos.push_back({name, names.at(static_cast<size_t>(index)), list, "", help});
}

void ParamWriter::integer(const char* name, int& value, Range, const char*, const char*) {
  values[name] = value;
}

void ParamWriter::number(const char* name, float& value, Range, const char*, const char*) {
  // The shortest decimal that gives the float back: 0.1 rather than 0.10000000149011612.
  values[name] = nlohmann::json::parse(fmt::format("{}", value), nullptr, false);
}

void ParamWriter::flag(const char* name, bool& value, const char*) {
  values[name] = value;
}

void ParamWriter::choice_index(const char* name, int& index, const std::vector<std::string>& names,
                               const char*) {
  values[name] = names.at(static_cast<size_t>(index));
}

}  // namespace zonal
