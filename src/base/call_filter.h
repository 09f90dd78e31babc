// What a child that works on bytes nobody vouches for may ask the system: memory, the one file, the pipe to its parent.
//
// Any other call ends the child with SIGSYS. A file is never opened: a call that would open the one file gets a
// descriptor that was opened before, by its name letter for letter; any other name is refused as if forbidden by its
// permissions. So a file of HDF5 that names another file as its data is not served. Where the processor is neither
// x86-64 nor arm64, every file may be opened to read.
#pragma once
#include <string>

namespace servodx {

// In the child, behind which it stays confined to the end. `give`: the descriptor that it may write to; `file`: the one
// that it may read, empty for none. False: this system refuses filters (a kernel or container without seccomp), and
// nothing is filtered.
bool filter_calls(int give, const std::string& file);

}  // namespace servodx
