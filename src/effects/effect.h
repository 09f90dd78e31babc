// What every effect states about a parameter of its own.
#pragma once

namespace servodx {

struct EffectParameter {
  const char* name;
  const char* unit;
  double off;           // [unit] with every parameter that `switches` at this value the model is exactly the base model
  double lower, upper;  // [unit]
  double start;         // [unit] a typical size: where a search begins
  const char* meaning;
  bool switches = true;  // false: shapes an effect that another parameter switches
};

}  // namespace servodx
