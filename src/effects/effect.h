// What every effect states about a parameter of its own.
#pragma once

namespace servodx {

struct EffectParameter {
  const char* name;
  const char* unit;
  double off;           // [unit] at this value (of the first parameter) the model is exactly the base model
  double lower, upper;  // [unit]
  double start;         // [unit] a typical size: where a search begins
  const char* meaning;
};

}  // namespace servodx
