// Volume behind a restriction at a control port: a gauge line, a hose behind a valve that is nearly shut, a pocket of
// the test manifold. It fills and empties with a time constant of its own, and what it gives back leaves through the
// return line. So a leakage sweep has a tail after null on the branch that empties it, whose length in current grows
// with the rate of the sweep.
//
// State: the oil that it holds, W = C p at rest; dW/dt = (C p - W) / tau, and as much leaves the port. Linear; left
// out: inertia, and the turbulence of the restriction.
#pragma once
#include <tuple>

#include "effects/effect.h"
#include "model/hooks.h"

namespace servodx {

struct PortLine {
  static constexpr const char* name = "port_line";
  static constexpr const char* place = "flow_a";
  static constexpr const char* meaning = "volumes behind restrictions at the control ports";
  static constexpr bool stand_only = true;  // in a circuit that moves its actuator they are hose_compliance
  static constexpr Freed freed = Freed::on_stands;
  static constexpr const char* best_test =
      "leakage sweeps at two rates, ports blocked: a tail after null that lasts as long at either";
  static constexpr int n_states = 2;
  static constexpr int n_parameters = 4;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"line_compliance_a", "m3/Pa", 0.0, 0.0, 1e-11, 5e-13, "oil per pressure that the volume at port A takes"},
      {"line_compliance_b", "m3/Pa", 0.0, 0.0, 1e-11, 5e-13, "the same at port B"},
      {"line_time_a", "s", 5.0, 0.1, 30.0, 5.0, "time constant in which the volume at port A fills", false},
      {"line_time_b", "s", 5.0, 0.1, 30.0, 5.0, "the same at port B", false},
  };

  // [m3/s] into the volume at port S (0: A, 1: B).
  template <int S, class V>
  static auto flow(const V& view) {
    constexpr int port = S == 0 ? s_p_a : s_p_b;
    const auto held = view.template own_state<PortLine, S>();
    return (view.template own<PortLine, S>() * view.template state<port>() - held) /
           view.template own<PortLine, 2 + S>();
  }
  template <class V>
  static auto flow_a(const V& view) {
    return -flow<0>(view);
  }
  template <class V>
  static auto flow_b(const V& view) {
    return -flow<1>(view);
  }
  template <class V>
  static auto derivative(const V& view) {
    return std::make_tuple(flow<0>(view), flow<1>(view));
  }
  // Own states at rest; y: the base states, q: own parameters.
  template <class T>
  static void at_rest(T* own, const T* y, const T* q, const T*) {
    own[0] = q[0] * y[s_p_a];
    own[1] = q[1] * y[s_p_b];
  }
};

}  // namespace servodx
