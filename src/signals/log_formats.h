// The file formats behind read_log(), one function and one file each.
#pragma once
#include <string>
#include <vector>

#include "servodx/rig.h"
#include "signals/log.h"
#include "signals/mat_file.h"

namespace servodx {

Log read_csv_log(const std::string& path, const RigFile& rig, const ReadOptions& options);

// MATLAB files (levels 4, 5, 7 and 7.3, through matio): numeric vectors of one length, directly in the file or one
// structure deep ('data.qm'), or the columns of a matrix. A variable's name is the signal's or is mapped in the rig
// file, which gives the unit.
Log read_mat_log(const std::string& path, const RigFile& rig, const ReadOptions& options);

// All variables of such a file with their numbers.
std::vector<MatVariable> read_mat_variables(const std::string& path);

// By its name: '.mat', in any capitals.
bool is_mat_file(const std::string& path);

}  // namespace servodx
