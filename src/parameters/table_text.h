// A parameter table that is not in a file: the copy that a history keeps of what its checks rest on, and the bytes that
// a table in memory would have.
#pragma once
#include <string>

#include "parameters/table.h"

namespace servodx {

// As read_table(); `path` is for messages.
Table parse_table(const std::string& text, const std::string& path);
// What write_table() writes.
std::string table_text(const Table& table);

}  // namespace servodx
