// libmatio, and with it HDF5 and some thirty objects that HDF5 brings (clients of networks among them), loaded only
// where a MAT file is read.
#pragma once
#include <matio.h>

#include <string>

namespace servodx {

// What is called of it; null until it is loaded.
struct MatioLibrary {
  decltype(&Mat_Open) open = nullptr;
  decltype(&Mat_Close) close = nullptr;
  decltype(&Mat_VarReadNext) read_next = nullptr;
  decltype(&Mat_VarFree) free_variable = nullptr;
  decltype(&Mat_VarGetNumberOfFields) number_of_fields = nullptr;
  decltype(&Mat_VarGetStructFieldnames) field_names = nullptr;
  decltype(&Mat_VarGetStructFieldByIndex) field = nullptr;
};

// Loads it once a process. Throws InputError about the file `path` where it is not installed.
void load_matio(const std::string& path);

// Of the process; load_matio() comes first.
const MatioLibrary& matio();

}  // namespace servodx
