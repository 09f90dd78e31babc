// Effects that the base model has already: rows of the table, which a rig may hold at their off value. Reported under
// the effect's name all the same.
#pragma once
#include <vector>

namespace servodx {

struct RowEffect {
  const char *name, *where, *meaning;
  const char* best_test;         // the input that shows it best, in words
  double off;                    // [SI] of every row
  std::vector<int> rows;         // positions in a parameter vector
  std::vector<int> shapes = {};  // the same, of effect parameters that say how the rows act
  // [SI] of every row, on a valve of such rows: how far it may go if that is beyond the table's box.
  double (*worst)(const double* rows) = nullptr;
  const char* also = nullptr;    // a name that others give it
  const char* of_channel = "";   // of a sensor: the channel that it shows in
};
const std::vector<RowEffect>& row_effects();

}  // namespace servodx
