// The fields of every JSON file that the program writes, from one list (src/report/list/fields.txt), and the JSON
// Schema (draft 2020-12) that each file keeps. What `servodx list fields` and `servodx list schemas` print; the tests
// hold real outputs against it, both ways.
#pragma once
#include <string>
#include <vector>

#include "report/shared/json.h"

namespace servodx::report {

struct Field {
  std::string name;
  std::string type;  // as the list has it: "number?", "list:channel"
  std::string unit;  // SI; empty: none, or said beside it
  std::string meaning;
  bool may_be_missing = false;
};

struct FieldGroup {
  enum class Kind { shared, command, file, type };
  Kind kind = Kind::command;
  std::string name, meaning;
  std::vector<Field> fields;
};

std::string kind_of(const FieldGroup& group);   // "command"
bool is_whole_file(const FieldGroup& group);    // a command's result, or a file beside one
const std::vector<FieldGroup>& field_groups();  // in the order of the list
Json schema_of(const FieldGroup& group);        // of a command or a file

}  // namespace servodx::report
