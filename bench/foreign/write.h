// What a foreign rig leaves on disk: logs, the rig file and data sheet of its user, and the truth beside them.
#pragma once
#include <filesystem>
#include <string>

#include "design.h"
#include "run.h"
#include "set.h"
#include "sheet.h"

namespace servodx::foreign {

std::string csv_of(const Design& design, const Recording& recording);
std::string rig_toml(const Design& design, const Sheet& sheet);
std::string datasheet(const Design& design, const Sheet& sheet);
std::string truth_header();
std::string truth_row(const Design& design, const Planned& planned);
// The design's true numbers, one a line; for those who judge, never for the program that is judged.
std::string design_text(const Design& design);
void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace servodx::foreign
