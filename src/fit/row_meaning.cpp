#include "fit/row_meaning.h"

#include <cstddef>

#include "effects/effect.h"
#include "effects/registry.h"
#include "parameters/list.h"

namespace servodx {

std::string meaning_of_row(const std::string& name) {
  if (const int at = find_parameter(name); at >= 0)
    return std::string(parameter_list[static_cast<std::size_t>(at)].meaning);
  for (const EffectInfo& effect : effect_list())
    for (const EffectParameter& p : effect.parameters)
      if (p.name == name) return p.meaning;
  return "";
}

}  // namespace servodx
