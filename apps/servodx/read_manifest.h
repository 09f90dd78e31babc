// The manifest beside a result, read to make the result again.
#pragma once
#include <string>

#include "report/shared/json.h"

namespace servodx {

// As servodx writes it: every key is there and of its type. Throws InputError where it is not, or was interrupted.
report::Json read_manifest(const std::string& path);

}  // namespace servodx
