// Results of the program, read back as JSON.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace servodx::store {

// Throws InputError where the file is no result that --json wrote, nor a baseline.
nlohmann::ordered_json read_result(const std::string& path);

}  // namespace servodx::store
