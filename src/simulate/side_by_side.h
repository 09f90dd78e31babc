// Pieces of work that need nothing of each other, such as the logs of a baseline: a thread each keeps all cores at work
// where the fits of one log alone would wait for their slowest pack.
#pragma once
#include <functional>

namespace servodx {

// work(i, threads_of_it) for i = 0 .. pieces - 1, over `threads` threads (0: all), as a loop over them would come out
// where pieces share nothing that they write. Pieces begin in their order. Throws what the first piece that failed has
// thrown; none begins after a failure.
void side_by_side(int pieces, int threads, const std::function<void(int piece, int threads_of_it)>& work);

}  // namespace servodx
