// The model on a bench: every state in reach, which a run over a log does not report.
#pragma once
#include <array>
#include <vector>

#include "base/random.h"
#include "effects/registry.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "integrate/rodas3.h"
#include "model/derived.h"
#include "model/state.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "shipped_data.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"
#include "simulate/system.h"

namespace servodx {

// The shipped table's nominal values as a candidate, data sheet applied.
inline ParameterVector nominal_candidate() { return candidate_of(shipped_table()); }

// One in which a blocked screen, backlash and breakaway friction act, which a healthy valve has at zero.
inline ParameterVector lively() {
  ParameterVector v = nominal_candidate();
  v[row::filter_blockage_positive] = 0.6, v[row::filter_blockage_negative] = 0.3;
  v[row::valve_glitch] = 1e-5;
  v[row::piston_stribeck_friction] = 300;
  return v;
}

// The right-hand side and its Jacobian for one candidate. `Effects` must be the whole list or none: the candidate's
// layout is that of the whole list.
template <class Effects>
class Bench {
 public:
  using Live = System<double, Effects, false>;
  static constexpr int n = Live::n;
  using Y = std::array<double, n>;

  explicit Bench(ParameterVector v, const Oil& oil = {})
      : p_(std::move(v)), d_(derive<double, Effects>(p_.data(), oil)) {}
  const double* p() const { return p_.data(); }
  double p(int row) const { return p_[row]; }
  const Derived<double>& derived() const { return d_; }

  Live system(const Inputs<double>& u, const Inputs<double>& slope = {0, 0, 0, 0}) const {
    return Live{p_.data(), d_, u, slope, 0, 0, 0, 0};
  }
  Y rate(const Y& y, const Inputs<double>& u) const {
    Y f;
    system(u).value(y, 0.0, f);
    return f;
  }
  void step(Y& y, const Inputs<double>& u, double h) const {
    Live s = system(u);
    rodas3_step<double>(s, y, h);
  }

  // A state such as a run may pass through, contacts and stops included.
  Y state(Random& r) const {
    const double supply = p(row::supply_pressure);
    Y y{};
    y[s_current] = r.uniform(-1, 1) * p(row::current_limit);
    y[s_x_flapper] = r.uniform(-1.5, 1.5) * p(row::nozzle_gap);
    y[s_v_flapper] = r.uniform(-0.1, 0.1);
    y[s_p_filter] = r.uniform(0.5, 1.0) * supply;
    y[s_p_pilot_1] = r.uniform(0.1, 0.95) * y[s_p_filter];
    y[s_p_pilot_2] = r.uniform(0.1, 0.95) * y[s_p_filter];
    y[s_x_spool] = r.uniform(-1.05, 1.05) * p(row::spool_stop);
    y[s_v_spool] = r.uniform(-0.3, 0.3);
    y[s_p_a] = r.uniform(0.05, 1.1) * supply;
    y[s_p_b] = r.uniform(0.05, 1.1) * supply;
    const double half = p(row::piston_stroke) / 2;
    y[s_x_piston] = r.uniform() < 0.3 ? r.uniform(0.9999, 1.0002) * half : r.uniform(-1.0, 1.0) * half;
    y[s_v_piston] = r.uniform(-0.4, 0.4);
    for (int k = n_base_states; k < n; ++k) y[k] = r.uniform(-1e-3, 1e-3);
    return y;
  }
  Inputs<double> inputs(Random& r) const {
    return {r.uniform(-1, 1) * p(row::current_limit), r.uniform(0.7, 1.1) * p(row::supply_pressure),
            r.uniform(0.0, 2.0) * p(row::return_pressure), r.uniform(-8000, 8000)};
  }

 private:
  ParameterVector p_;
  Derived<double> d_;
};

// Every effect on, at its typical size.
inline ParameterVector with_effects(ParameterVector v) {
  for (const EffectInfo& e : effect_list())
    for (std::size_t j = 0; j < e.parameters.size(); ++j) v[e.first + static_cast<int>(j)] = e.parameters[j].start;
  return v;
}

// A log of even stamps from a command and a load that are functions of time. Pressures of the table.
template <class Command, class Load>
Scenario made(double seconds, double dt, Command command, Load load) {
  Scenario s;
  for (int k = 0; k <= static_cast<int>(seconds / dt + 0.5); ++k) {
    s.time.push_back(k * dt);
    s.command.push_back(command(k * dt));
    s.load_force.push_back(load(k * dt));
  }
  return s;
}
template <class Command>
Scenario made(double seconds, double dt, Command command) {
  return made(seconds, dt, command, [](double) { return 0.0; });
}

// Every signal that the model can report.
inline SimulateOptions all_signals() {
  SimulateOptions o;
  o.wanted.fill(true);
  return o;
}
inline const std::vector<double>& of(const Trajectory& t, Signal s) { return t.signals[simulated_index(s)]; }

}  // namespace servodx
