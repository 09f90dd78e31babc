// The truth that the virtual rig writes beside a log.
#pragma once
#include <string>

namespace servodx::store {

// The label in LOG.truth.json beside a log of the virtual rig whose bytes it speaks of; "" without.
std::string truth_beside(const std::string& log, const std::string& sha256);

}  // namespace servodx::store
