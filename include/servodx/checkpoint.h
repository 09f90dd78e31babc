// A checkpoint: the finished stages of long calls, in a file. A call that is made again with it takes what it has
// finished from there in place of making it, and comes to the same bits as one that nothing has broken off.
//
// A stage is a fit, a generation of a search, what a log says by itself, and so on. Each is kept under a hash of all
// that went into it and of the program's build, so what was made of other logs, options or versions does not fit and
// stays unused. A kill loses the stage at hand and no other.
#pragma once
#include <memory>
#include <string>

#include "servodx/watch.h"

namespace servodx {

class Checkpoint;

enum class CheckpointUse {
  begin,  // of what the file holds nothing is kept
  go_on   // the file must be there
};

// For `Watch::checkpoint` of tune(), make_baseline(), diagnose() and explain(). It may serve several calls, one after
// another or at once. Throws InputError where the file cannot be written, is no checkpoint, or serves another process.
std::shared_ptr<Checkpoint> open_checkpoint(const std::string& path, CheckpointUse use);

struct CheckpointReport {
  long taken = 0, kept = 0;  // stages that calls took from the file, and that they wrote to it
  std::string trouble;       // a damaged end that was left out, a disk that is full; empty: none
};
CheckpointReport report_of(const Checkpoint& checkpoint);

}  // namespace servodx
