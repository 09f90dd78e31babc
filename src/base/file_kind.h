// What a file is by its first bytes, where it is no text: workbooks, archives and recorders' own formats, which else
// would be read as rubbish. Known by the marks that their makers set; any other file is binary where a text has no
// such bytes (a zero, or many control characters).
//
// Leaves out: text that is no table, and formats without a mark whose first bytes happen to be text.
#pragma once
#include <string>
#include <string_view>

namespace servodx {

// Throws InputError where `first`, the first bytes of the file at `path`, are none of a text.
void refuse_binary(std::string_view first, const std::string& path);

}  // namespace servodx
