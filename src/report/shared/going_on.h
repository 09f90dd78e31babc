// What is said of a call that ended early, and of the checkpoint that it was given.
#pragma once
#include <string>

#include "servodx/checkpoint.h"

namespace servodx::report {

// One line. `limit`: of time, as the user wrote it, where that ended the call; empty: an interrupt did. `checkpoint`:
// its file; empty: none.
std::string how_to_go_on(const std::string& limit, const std::string& checkpoint);

// On standard error, as the same result with and without a checkpoint has the same bytes. Empty: nothing to say.
std::string words_of(const CheckpointReport& report, const std::string& checkpoint, bool resumed);

// Of a baseline that ended before it could be one.
std::string too_few_for_a_baseline(std::size_t scored, std::size_t logs);

}  // namespace servodx::report
