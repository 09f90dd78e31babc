// Fewer samples for a plot, chosen so that no peak is lost: time is cut into even buckets, and of each bucket the first
// and the last sample stay and, of every series, the least and the greatest. At the buckets' width the picture is that
// of all samples. Positions come back in order; a gap (all NaN) wider than a bucket stays a gap.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace servodx::report {

// At most about `most` positions (never fewer than one bucket's); all of them where there are no more than that.
std::vector<std::size_t> thinned(std::span<const double> x, std::span<const std::vector<double>* const> series,
                                 std::size_t most);

}  // namespace servodx::report
