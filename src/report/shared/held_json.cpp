#include "report/shared/held_json.h"

#include <nlohmann/json.hpp>

namespace servodx::report {

HeldJson::HeldJson() : json_(std::make_unique<Value>(Value::object())) {}
HeldJson::HeldJson(const HeldJson& other) : json_(std::make_unique<Value>(*other)) {}
HeldJson& HeldJson::operator=(const HeldJson& other) {
  *json_ = *other;
  return *this;
}
HeldJson::~HeldJson() = default;

}  // namespace servodx::report
