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
  Need need = Need::base;
  for (const EffectInfo& e : effect_list())
    if (!is_off(e, v))
      need = std::max(need, e.first == effect_row<Unexplained>(0)   ? Need::corrected
                            : e.first == effect_row<LineInertia>(0) ? Need::lined
                                                                    : Need::extended);
  return need;
}

int curve_kind(const ParameterVector& v) {
  const auto code = [&](int which) { return static_cast<int>(std::lround(v[effect_row<Unexplained>(which)])); };
  return (code(0) * Unexplained::n_variables + code(1)) * Unexplained::n_factors + code(2);
}

RunPack run_of(const Kernels& k, Need need) {
  switch (need) {
    case Need::base:
      return k.base;
    case Need::extended:
      return k.extended;
    case Need::lined:
      return k.lined;
    case Need::corrected:
      return k.corrected;
  }
  return nullptr;
}

MakeRunInParts in_parts_of(const Kernels& k, Need need) {
  switch (need) {
    case Need::base:
      return k.base_in_parts;
    case Need::extended:
      return k.extended_in_parts;
    case Need::lined:
      return k.lined_in_parts;
    case Need::corrected:
      return k.corrected_in_parts;
  }
  return nullptr;
}

NearKernels::Make near_of(const NearKernels& k, Need need) {
  switch (need) {
    case Need::base:
      return k.base;
    case Need::extended:
      return k.extended;
    case Need::lined:  // a tap answers so fast that followers part from their run
    case Need::corrected:
      return nullptr;
  }
  return nullptr;
}

std::unique_ptr<RunInParts> run_in_parts(const Scenario& scenario, const ParameterVector& candidate, Trajectory& result,
                                         const SimulateOptions& options) {
  return in_parts_of(best_kernels().doubles, need_of(candidate))(scenario, candidate, result, options);
}

std::string instruction_set() { return best_kernels().doubles.name; }
int pack_width() { return best_kernels().doubles.width; }

}  // namespace servodx
