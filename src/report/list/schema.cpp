#include "report/list/schema.h"

#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "base/result_schema.h"
#include "report/shared/assets.h"

namespace servodx::report {
namespace {

using Kind = FieldGroup::Kind;

constexpr std::string_view of_list = "list:", of_map = "map:", of_choice = "one:";

constexpr std::array<const char*, 4> kinds = {"shared", "command", "file", "type"};  // as Kind

Kind kind_named(const std::string& word) {
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (word == kinds[i]) return static_cast<Kind>(i);
  throw std::logic_error("fields.txt: no kind is called '" + word + "'");
}

std::string without_ends(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == text.npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

// "  name?  number?  [s] meaning"
Field field_of(const std::string& line) {
  Field f;
  std::istringstream in(line);
  in >> f.name >> f.type;
  std::getline(in, f.meaning);
  f.meaning = without_ends(f.meaning);
  if (f.meaning.starts_with('[')) {
    const auto end = f.meaning.find(']');
    f.unit = f.meaning.substr(1, end - 1);
    f.meaning = without_ends(f.meaning.substr(end + 1));
  }
  f.may_be_missing = f.name.ends_with('?');
  if (f.may_be_missing) f.name.pop_back();
  return f;
}

// "command tune: meaning", and its fields below, each in a line that begins with spaces.
std::vector<FieldGroup> groups_of(std::string_view text) {
  std::vector<FieldGroup> groups;
  std::istringstream in{std::string(text)};
  for (std::string line; std::getline(in, line);) {
    if (without_ends(line).empty() || line.starts_with('#')) continue;
    if (line.starts_with(' ')) {
      groups.back().fields.push_back(field_of(line));
      continue;
    }
    const auto space = line.find(' '), colon = line.find(':');
    groups.push_back({kind_named(line.substr(0, space)),
                      line.substr(space + 1, colon - space - 1),
                      without_ends(line.substr(colon + 1)),
                      {}});
  }
  return groups;
}

const FieldGroup& shared_type(const std::string& name) {
  for (const FieldGroup& group : field_groups())
    if (group.kind == Kind::type && group.name == name) return group;
  throw std::logic_error("fields.txt: no type is called '" + name + "'");
}

// Collects on the way the shared types that are asked for.
Json type_schema(std::string type, std::set<std::string>& asked) {
  // Of a list or a map the mark at the end is its elements'; its own stands at the beginning.
  const bool holds_others = type.find(of_list) < 2 || type.find(of_map) < 2;
  const bool may_be_null = holds_others ? type.starts_with('?') : type.ends_with('?');
  if (may_be_null) type.erase(holds_others ? 0 : type.size() - 1, 1);
  Json schema;
  if (type == "text")
    schema = {{"type", "string"}};
  else if (type == "flag")
    schema = {{"type", "boolean"}};
  else if (type == "number" || type == "integer")
    schema = {{"type", type}};
  else if (type == "any")
    schema = Json::object();
  else if (type.starts_with(of_list))
    schema = {{"type", "array"}, {"items", type_schema(type.substr(of_list.size()), asked)}};
  else if (type.starts_with(of_map))
    schema = {{"type", "object"}, {"additionalProperties", type_schema(type.substr(of_map.size()), asked)}};
  else if (type.starts_with(of_choice)) {
    schema = {{"enum", Json::array()}};
    std::istringstream words(type.substr(of_choice.size()));
    for (std::string word; std::getline(words, word, '|');) schema["enum"].push_back(word);
  } else {
    asked.insert(shared_type(type).name);
    schema = {{"$ref", "#/$defs/" + type}};
  }
  return may_be_null ? Json{{"anyOf", {schema, {{"type", "null"}}}}} : schema;
}

void add_fields(Json& schema, const FieldGroup& group, std::set<std::string>& asked) {
  for (const Field& f : group.fields) {
    Json of_field = type_schema(f.type, asked);
    of_field["description"] = f.meaning;
    if (!f.unit.empty()) of_field["unit"] = f.unit;
    schema["properties"][f.name] = std::move(of_field);
    if (!f.may_be_missing) schema["required"].push_back(f.name);
  }
}

Json object_schema(const std::string& meaning) {
  return {{"description", meaning}, {"type", "object"}, {"properties", Json::object()}, {"required", Json::array()}};
}

}  // namespace

std::string kind_of(const FieldGroup& group) { return kinds[static_cast<std::size_t>(group.kind)]; }
bool is_whole_file(const FieldGroup& group) { return group.kind == Kind::command || group.kind == Kind::file; }

const std::vector<FieldGroup>& field_groups() {
  static const std::vector<FieldGroup> groups = groups_of(assets::field_list);
  return groups;
}

Json schema_of(const FieldGroup& group) {
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "servodx " + group.name},
                 {"version", result_schema}};
  schema.update(object_schema(group.meaning));
  std::set<std::string> asked, made;
  if (group.kind == Kind::command)
    for (const FieldGroup& shared : field_groups())
      if (shared.kind == Kind::shared) add_fields(schema, shared, asked);
  add_fields(schema, group, asked);
  Json types = Json::object();
  while (made != asked)
    for (const std::string& name : std::set<std::string>(asked))
      if (made.insert(name).second) {
        types[name] = object_schema(shared_type(name).meaning);
        add_fields(types[name], shared_type(name), asked);
      }
  if (!types.empty()) schema["$defs"] = types;
  return schema;
}

}  // namespace servodx::report
