// Several fits at once in the same packs: each of them, alone, leaves lanes empty (a trial step is one run of eight).
#pragma once
#include <cstddef>
#include <functional>

namespace servodx {

// task(i) for i = 0 .. tasks - 1 side by side, as a loop over them would come out, bit for bit. Whatever they simulate
// (simulate.h) is held until none of them can go on without it, and then run as one, over `threads` threads (0: all),
// each run by the options that its task gave. Tasks must share nothing that they write. Throws what the first task
// throws. `go_on` is asked each time all tasks wait, in the calling thread; false ends those that are not done where
// they are.
void together(int tasks, int threads, const std::function<void(int)>& task, const std::function<bool()>& go_on = {});

// The same of fits on so many samples, as many fits at a time as memory holds.
void fits_together(int fits, std::size_t samples, int threads, const std::function<void(int)>& fit,
                   const std::function<bool()>& go_on = {});

}  // namespace servodx
