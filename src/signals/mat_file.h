// The variables of a MAT file, through matio. matio trusts what a file says of itself: run this in a Box (base/box.h).
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace servodx {

struct MatVariable {
  std::string name;             // "data.qm": the field of a structure; "data(:,2)": a matrix's column without a name
  std::string fault;            // why it is no signal; empty: it is one
  std::vector<double> numbers;  // of a signal
};

// Gives every variable, in the file's order, and behind them the columns of matrices: by their names where a list of as
// many texts is in the file too, else by their number. Throws InputError where the file's own sizes do not fit
// it (it is cut off, or damaged), a variable cannot be read, or there is no libmatio.
void read_mat_file(const std::string& path, const std::function<void(const MatVariable&)>& take);

}  // namespace servodx
