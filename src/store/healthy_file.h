// What a baseline's file says, under the key "explain", of each cause in healthy logs.
#pragma once
#include <string>

#include "explain/healthy.h"

namespace servodx::store {

// Throws InputError where the file has none.
HealthyReference read_healthy(const std::string& path);

}  // namespace servodx::store
