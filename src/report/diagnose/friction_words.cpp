#include "report/diagnose/friction_words.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "report/shared/handy.h"

namespace servodx::report {

std::string friction_in_words(const FrictionBesideForce& b) {
  return fmt::format(
      "the spool rubs with {}; leakage presses one land without grooves with {} at most (Merritt), so it takes a "
      "coefficient of friction of {}: {}",
      handy(b.friction, "N"), handy(b.largest, "N"), digits(b.coefficient(), 2),
      b.coefficient() > highest_lubricated_friction ? "more than oiled steel has, so something else holds the spool"
                                                    : "no more than oiled steel has");
}

Json friction_json(const std::optional<FrictionBesideForce>& b) {
  if (!b) return nullptr;
  return {{"friction", number(b->friction)},
          {"largest_lateral_force", number(b->largest)},
          {"coefficient", number(b->coefficient())}};
}

}  // namespace servodx::report
