#include "fit/candidate_of.h"

#include <cstddef>

#include "effects/registry.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "simulate/nuisance.h"
#include "simulate/scenario.h"

namespace servodx {

ParameterVector candidate_of(const Table& table) {
  ParameterVector v(n_candidate, 0.0);
  for (int i = 0; i < n_parameters; ++i) v[i] = table[i].nominal;
  for (const EffectInfo& e : effect_list())
    for (std::size_t j = 0; j < e.parameters.size(); ++j) {
      const int at = table.find(e.parameters[j].name);
      v[e.first + static_cast<int>(j)] = at >= 0 ? table[at].nominal : e.parameters[j].off;
    }
  return v;
}

}  // namespace servodx
