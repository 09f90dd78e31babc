#include "simulate/choose_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "effects/line_inertia.h"
#include "effects/registry.h"
#include "effects/unexplained.h"
#include "simulate/kernels.h"
#include "simulate/run_in_parts.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {

namespace {

// That this processor has, the widest first.
std::vector<Choice> choices() {
  std::vector<Choice> out;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
    out.push_back({kernels_avx512(), kernels_avx512_floats(), kernels_avx512_near()});
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    out.push_back({kernels_avx2(), kernels_avx2_floats(), kernels_avx2_near()});
#endif
  out.push_back({kernels_generic(), kernels_generic(), {}});
  return out;
}

Choice choose() {
  const std::vector<Choice> all = choices();
  const char* asked = std::getenv("SERVODX_INSTRUCTION_SET");
  if (!asked || !*asked) return all.front();
  std::string known;
  for (const Choice& c : all) {
    if (std::string(asked) == c.doubles.name) return c;
    known += (known.empty() ? "" : ", ") + std::string(c.doubles.name);
  }
  throw InputError({.file = "SERVODX_INSTRUCTION_SET"}, "this processor has no kernels '" + std::string(asked) + "'",
                   "give one of " + known + ", or unset it for the widest");
}

}  // namespace

const Choice& best_kernels() {
  static const Choice chosen = choose();
  return chosen;
}

namespace {

bool is_off(const EffectInfo& e, const ParameterVector& v) {
  for (std::size_t j = 0; j < e.parameters.size(); ++j)
    if (e.parameters[j].switches && v[e.first + static_cast<int>(j)] != e.parameters[j].off) return false;
  return true;
}

}  // namespace

Need need_of(const ParameterVector& v) {
  bool any = false, rare = false, lines = false;
  for (const EffectInfo& e : effect_list()) {
    if (is_off(e, v)) continue;
    if (e.first == effect_row<Unexplained>(0)) return Need::corrected;
    any = true;
    if (e.first == effect_row<LineInertia>(0))
      lines = true;
    else
      rare = rare || e.rare;
  }
  if (lines) return rare ? Need::corrected : Need::lined;
  return rare ? Need::extended : any ? Need::common : Need::base;
}

int curve_kind(const ParameterVector& v) {
  const auto code = [&](int which) { return static_cast<int>(std::lround(v[effect_row<Unexplained>(which)])); };
  return (code(0) * Unexplained::n_variables + code(1)) * Unexplained::n_factors + code(2);
}

std::unique_ptr<RunInParts> run_in_parts(const Scenario& scenario, const ParameterVector& candidate, Trajectory& result,
                                         const SimulateOptions& options) {
  return best_kernels().doubles[need_of(candidate)].in_parts(scenario, candidate, result, options);
}

std::string instruction_set() { return best_kernels().doubles.name; }
int pack_width() { return best_kernels().doubles.width; }

}  // namespace servodx
