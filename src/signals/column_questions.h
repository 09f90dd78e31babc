// What only the user can say of a column, by what its numbers are: a unit that the header lacks, or that the numbers
// contradict; a current without a sign; a piston measured from one end. Nothing absurd is taken without a question.
//
// A unit that the header lacks is taken where the SI unit, or one of time, is the only one that servovalves fit: 10 to
// 1000 bar, 2 to 500 mA, a spool of 0.1 to 10 mm, a piston of 5 mm to 1 m, 50 to 50,000 samples a second. A clock that
// counts from a date is known by its size. Leaves out: what the channels do to one another (diagnose/swapped.h).
#pragma once
#include <cstddef>
#include <vector>

#include "signals/guess.h"

namespace servodx {

// The numbers of a column as they stand in the file.
struct ColumnNumbers {
  std::size_t count = 0;
  double low = 0, high = 0;
  double step = 0;      // usual step from one row to the next
  bool counts = false;  // goes up by one in every row
  bool rises = false;   // goes up in every row
  bool whole = false;   // holds whole numbers alone
  bool stamps = false;  // are date-time stamps
};

// Takes them one by one, NaN where one is missing; memory does not grow.
class NumbersCollector {
 public:
  void take(double x);
  ColumnNumbers numbers() const;

 private:
  std::size_t count_ = 0;
  double low_ = 0, high_ = 0, last_ = 0;
  bool whole_ = true;
  std::vector<double> steps_;  // the first
};

// Adds to the guesses' questions and likeliest units; `numbers`: of the same columns.
void ask_by_numbers(std::vector<ColumnGuess>& columns, const std::vector<ColumnNumbers>& numbers);

}  // namespace servodx
