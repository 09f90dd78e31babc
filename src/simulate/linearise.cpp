#include "simulate/linearise.h"

#include "base/pack.h"
#include "base/sparse_dual.h"
#include "effects/registry.h"
#include "integrate/rodas3.h"
#include "integrate/sparse_lu.h"
#include "model/asperities.h"
#include "model/constants.h"
#include "model/hooks.h"
#include "parameters/list.h"
#include "servodx/rig.h"
#include "simulate/pack_run.h"
#include "simulate/scenario.h"
#include "simulate/system.h"

namespace servodx {
namespace {

enum Missing { drive, spool, metering, flow_into_a, flow_into_b, flow_across, piston, supply };

// What is missing, as an effect with a constant state at each place, that no run ever leaves zero.
struct MissingInput {
  static constexpr int n_states = n_missing_places;
  static constexpr int n_parameters = 0;
  template <Missing M, class V>
  static auto at(const V& view) {
    return view.template own_state<MissingInput, M>();
  }
  template <class V>
  static auto flapper_force(const V& view) {
    return pick<row::torque_motor_gain>(view.p) * at<drive>(view);
  }
  template <class V>
  static auto spool_force(const V& view) {
    return at<spool>(view);
  }
  template <class V>
  static auto metering_opening(const V& view) {
    return at<metering>(view);
  }
  template <class V>
  static auto flow_a(const V& view) {
    return at<flow_into_a>(view) + at<flow_across>(view);
  }
  template <class V>
  static auto flow_b(const V& view) {
    return at<flow_into_b>(view) - at<flow_across>(view);
  }
  template <class V>
  static auto piston_force(const V& view) {
    return at<piston>(view);
  }
  template <class V>
  static auto supply_pressure(const V& view) {
    return at<supply>(view);
  }
  template <class V>
  static auto derivative(const V& view) {
    return [&]<int... I>(std::integer_sequence<int, I...>) {
      return std::make_tuple(0.0 * view.template own_state<MissingInput, I>()...);
    }
    (std::make_integer_sequence<int, n_states>{});
  }
};

using Effects = Append<CorrectedEffects, MissingInput>;
using Live = System<double, Effects, false>;
constexpr int n_seals = static_cast<int>(std::size(constants::seal_presliding));
constexpr int n_live = Live::n, n_anchors = 1 + n_seals, n_all = n_live + n_anchors;

constexpr Mask anchors_mask = range(n_live, n_live + n_anchors);
using Anchored = Dual<double, anchors_mask>;

// Inputs whose memory of friction carries derivatives by its anchors.
struct AnchoredInputs {
  double current, supply_pressure, return_pressure, load_force;
  struct {
    Anchored spool_anchor;
    double spool_speed;
    std::array<Anchored, n_seals> seal_anchor;
    double rod_speed, seal_breakaway, seal_per_reach;
  } friction;
};

// The right-hand side with derivatives by the states and by friction's anchors.
auto with_derivatives(const Live& live, const std::array<double, n_live>& y) {
  const auto anchor = [](double v, int i) {
    Anchored a{v, {}};
    a.d[static_cast<std::size_t>(i)] = 1.0;
    return a;
  };
  const FrictionMemory<double>& f = live.at.friction;
  AnchoredInputs u{live.at.current,
                   live.at.supply_pressure,
                   live.at.return_pressure,
                   live.at.load_force,
                   {anchor(f.spool_anchor, 0), f.spool_speed, {}, f.rod_speed, f.seal_breakaway, f.seal_per_reach}};
  for (int i = 0; i < n_seals; ++i) u.friction.seal_anchor[i] = anchor(f.seal_anchor[i], 1 + i);
  return live.evaluate(DualStates<n_live, double>{y}, u);
}
using Rates = decltype(with_derivatives(std::declval<Live>(), {}));
template <int I>
constexpr Mask mask_of() {
  return Live::MaskOf<std::tuple_element_t<I, Rates>>::value;
}

// dx/dt = J x as the stepper sees it; T: a few columns side by side.
template <class T>
struct Linear {
  static constexpr int n = n_all;
  static constexpr Pattern<n> make_pattern() {
    Pattern<n> out;
    [&]<int... I>(std::integer_sequence<int, I...>) { ((out.row[I] = mask_of<I>()), ...); }
    (std::make_integer_sequence<int, n_live>{});
    return out;
  }
  static constexpr Pattern<n> pattern = make_pattern();
  using Lu = SparseLu<n, pattern>;
  const std::array<double, Lu::entries>& j;

  void value(const std::array<T, n>& y, const T&, std::array<T, n>& f) const {
    unroll<n>([&](auto i) {
      T sum = T(0.0);
      unroll<n>([&](auto k) {
        if constexpr (holds(pattern.row[i], k)) sum = multiply_add(T(j[Lu::plan.slot[i][k]]), y[k], sum);
      });
      f[i] = sum;
    });
  }
  void value_and_jacobian(const std::array<T, n>& y, const T& t, std::array<T, n>& f, std::array<T, Lu::entries>& w,
                          std::array<T, n>& f_t) const {
    value(y, t, f);
    for (int e = 0; e < Lu::entries; ++e) w[static_cast<std::size_t>(e)] = T(j[static_cast<std::size_t>(e)]);
    f_t.fill(T(0.0));
  }
};

struct Columns : Unwatched {
  using T = Pack<2, 0>;
  using Lu = Linear<T>::Lu;
  static constexpr int packs = (n_all + T::lanes - 1) / T::lanes;
  using Block = std::array<std::array<T, n_all>, packs>;
  std::vector<Eigen::MatrixXd>& out;
  int stride;
  int passed = 0;
  Block begun = identity(), x = begun;  // at the last sample, and now

  static Block identity() {
    Block b;
    for (int c = 0; c < packs; ++c)
      for (int i = 0; i < n_all; ++i) {
        b[c][i] = T(0.0);
        if (i / T::lanes == c) b[c][i].set(i % T::lanes, 1.0);
      }
    return b;
  }
  void interval() { x = begun; }
  template <class... OfStages>
  void step(const Live& live, const std::array<double, n_live>& y, double h, const OfStages&...) {
    const Rates rates = with_derivatives(live, y);
    std::array<double, Lu::entries> j{};
    unroll<n_live>([&](auto i) {
      constexpr Mask m = mask_of<i>();
      unroll<n_all>([&](auto k) {
        if constexpr (holds(m, k)) j[Lu::plan.slot[i][k]] = std::get<i>(rates).d[slot(m, k)];
      });
    });
    Linear<T> linear{j};
    for (auto& column : x) rodas3_step<T>(linear, column, h);
  }
  // An anchor that was dragged goes where its part goes; one that held stays.
  template <class Y>
  void taken(const Y&, const FrictionMemory<double>& before, const FrictionMemory<double>& after) {
    const auto follow = [&](bool moved, int anchor, int part) {
      if (moved)
        for (auto& column : x) column[n_live + anchor] = column[part];
    };
    follow(after.spool_anchor != before.spool_anchor, 0, s_x_spool);
    for (int i = 0; i < n_seals; ++i) follow(after.seal_anchor[i] != before.seal_anchor[i], 1 + i, s_x_piston);
  }
  // In the order that the header states: what friction remembers before what is missing.
  static int place_of(int i) {
    constexpr int own = n_live - n_missing_places;
    return i < own ? i : i < n_live ? i + n_anchors : i - n_missing_places;
  }
  void sample() {
    begun = x;
    if (++passed % stride) return;
    Eigen::MatrixXd& to = out.emplace_back(n_all, n_all);
    for (int c = 0; c < n_all; ++c)
      for (int i = 0; i < n_all; ++i) to(place_of(i), place_of(c)) = x[c / T::lanes][i][c % T::lanes];
    begun = identity();
  }
};

}  // namespace

Linearisation linearise(const Scenario& scenario, const ParameterVector& candidate, const SimulateOptions& options,
                        int stride) {
  Linearisation out;
  out.states = n_all;
  out.at_rest = Eigen::VectorXd::Zero(n_all);
  out.at_rest[Columns::place_of(n_live)] = constants::spool_presliding;
  for (int i = 0; i < n_seals; ++i) out.at_rest[Columns::place_of(n_live + 1 + i)] = constants::seal_presliding[i];
  if (scenario.ports != Ports::actuator) return out;
  SimulateOptions silent = options;
  silent.wanted.fill(false);
  Trajectory t;
  const ParameterVector* from = &candidate;
  Trajectory* to = &t;
  out.transition.reserve(scenario.time.size() / static_cast<std::size_t>(stride));
  Run<double, Effects> run(scenario, &from, &to, 1, silent);
  Columns columns{{}, out.transition, stride};
  while (run.under_way()) {
    run.next(columns);
    columns.sample();
  }
  out.ok = t.ok;
  return out;
}

}  // namespace servodx
