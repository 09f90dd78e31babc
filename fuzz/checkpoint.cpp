// The checkpoint of a search.
#include "harness.h"
#include "optimise/genetic_state.h"

namespace servodx::fuzz {

void read(std::string_view input) { to_json(genetic_state_from_json(std::string(input))); }

}  // namespace servodx::fuzz
