// What the columns of a user's log may be, by header and numbers: where a rig file begins. CSV or MAT; of a MAT file
// its vectors of the commonest length, which are its signals.
#pragma once
#include <string>
#include <vector>

#include "signals/column_questions.h"
#include "signals/guess.h"

namespace servodx {

struct LogHeader {
  std::vector<ColumnGuess> columns;
  std::vector<ColumnNumbers> numbers;  // of the same
};
// With what only the user can say of single columns. Throws InputError where there is no header, or no numbers.
LogHeader read_log_header(const std::string& path);

}  // namespace servodx
