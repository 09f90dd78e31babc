// Readings of a seeded-fault test, as CSV.
#pragma once
#include <string>
#include <vector>

#include "prognose/seeded.h"

namespace servodx {

// CSV with the columns valve, name, truth, value, oil_temperature [degC] or [K]; others, as `servodx history export`
// writes them, are passed over, and so are rows without a truth. Throws InputError with file, line and column.
std::vector<SeededReading> read_seeded_csv(const std::string& path);

}  // namespace servodx
