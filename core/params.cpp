#include "core/params.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace zonal {
namespace {

/// "[1, 1e+07]", "> 0" or "" for the range column of a table.
std::string range_column(const Range& range) {
  const std::string text = range.text();
  return text.rfind("in ", 0) == 0 ? text.substr(3) : text;
}

/// "grid, paths"
std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

/// The shortest decimal that gives the float back: 0.1 rather than 0.10000000149011612.
nlohmann::json short_number(float value) {
  return nlohmann::json::parse(fmt::format("{}", value), nullptr, false);
}

/// The sentence for a value that is neither one of the words nor a number in the range.
[[noreturn]] void refuse(const Fields& fields, const char* name, const nlohmann::json& found,
                         const std::vector<std::string>& words, const std::string& number) {
  std::string nearest;
  if (found.is_string()) nearest = nearest_name(found.get<std::string>(), words);
  if (!nearest.empty()) nearest = " (did you mean \"" + nearest + "\"?)";
  fields.fail(name, fmt::format("found {}, expected {}{} or {}{}", describe(found),
                                words.size() > 1 ? "one of " : "", listed(words), number, nearest));
}

}  // namespace

void ParamReader::integer(const char* name, int& value, Range range, const char*, const char*) {
  value = fields_.integer(name, value, range);
}

void ParamReader::integer_or_auto(const char* name, int& value, Range range, const char*, const char*) {
  const nlohmann::json* found = fields_.find(name);
  if (!found) return;
  const std::string* text = found->get_ptr<const std::string*>();
  if (text && *text == "auto") {
    value = kAuto;
    return;
  }
  const double x = found->is_number() ? found->get<double>() : -1e300;
  if (x != std::floor(x) || !range.contains(x))
    refuse(fields_, name, *found, {"auto"}, "a whole number " + range.text());
  value = static_cast<int>(x);
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

void ParamReader::choice_index_or_number(const char* name, int& index, float& number,
                                         const std::vector<std::string>& names, Range range, const char*,
                                         const char*) {
  const nlohmann::json* found = fields_.find(name);
  if (!found) return;
  if (found->is_number()) {
    number = fields_.number(name, number, range);
    index = static_cast<int>(names.size());
    return;
  }
  const std::string* text = found->get_ptr<const std::string*>();
  const auto word = text ? std::find(names.begin(), names.end(), *text) : names.end();
  if (word == names.end()) refuse(fields_, name, *found, names, "a number " + range.text());
  index = static_cast<int>(word - names.begin());
}

void ParamLister::integer(const char* name, int& value, Range range, const char* unit, const char* help) {
  infos.push_back({name, std::to_string(value), range_column(range), unit, help});
}

void ParamLister::integer_or_auto(const char* name, int& value, Range range, const char* unit,
                                  const char* help) {
  infos.push_back(
      {name, value == kAuto ? "auto" : std::to_string(value), "auto, or " + range_column(range), unit, help});
}

void ParamLister::number(const char* name, float& value, Range range, const char* unit, const char* help) {
  infos.push_back({name, fmt::format("{}", value), range_column(range), unit, help});
}

void ParamLister::flag(const char* name, bool& value, const char* help) {
  infos.push_back({name, value ? "true" : "false", "true, false", "", help});
}

void ParamLister::choice_index(const char* name, int& index, const std::vector<std::string>& names,
                               const char* help) {
  infos.push_back({name, names.at(static_cast<size_t>(index)), listed(names), "", help});
}

void ParamLister::choice_index_or_number(const char* name, int& index, float& number,
                                         const std::vector<std::string>& names, Range range, const char* unit,
                                         const char* help) {
  const auto at = static_cast<size_t>(index);
  infos.push_back({name, at < names.size() ? names[at] : fmt::format("{}", number),
                   listed(names) + ", or " + range_column(range), unit, help});
}

void ParamWriter::integer(const char* name, int& value, Range, const char*, const char*) {
  values[name] = value;
}

void ParamWriter::integer_or_auto(const char* name, int& value, Range, const char*, const char*) {
  if (value == kAuto)
    values[name] = "auto";
  else
    values[name] = value;
}

void ParamWriter::number(const char* name, float& value, Range, const char*, const char*) {
  values[name] = short_number(value);
}

void ParamWriter::flag(const char* name, bool& value, const char*) {
  values[name] = value;
}

void ParamWriter::choice_index(const char* name, int& index, const std::vector<std::string>& names,
                               const char*) {
  values[name] = names.at(static_cast<size_t>(index));
}

void ParamWriter::choice_index_or_number(const char* name, int& index, float& number,
                                         const std::vector<std::string>& names, Range, const char*,
                                         const char*) {
  const auto at = static_cast<size_t>(index);
  if (at < names.size())
    values[name] = names[at];
  else
    values[name] = short_number(number);
}

}  // namespace zonal
