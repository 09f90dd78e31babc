// The friction of a spool that sticks beside what leakage can press a land with (diagnose/lateral_force.h), in words
// and as JSON.
#pragma once
#include <optional>
#include <string>

#include "diagnose/lateral_force.h"
#include "report/shared/json.h"

namespace servodx::report {

std::string friction_in_words(const FrictionBesideForce& beside);      // "the spool rubs with 31 N; ..."
Json friction_json(const std::optional<FrictionBesideForce>& beside);  // null without

}  // namespace servodx::report
