// Which logs tuned a table, as the table says it.
#pragma once
#include <string>
#include <vector>

#include "servodx/table.h"

namespace servodx {

struct TunedBy {
  std::string log;      // file name
  std::string sha256;   // of the file's bytes; empty: the log came from memory
  std::string content;  // content_hash of the log; empty: an earlier version did not keep it
};

// Empty of a table that is not tuned. Throws InputError where what the table says cannot be read.
std::vector<TunedBy> tuned_by(const Table& table);

}  // namespace servodx
