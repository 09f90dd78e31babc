#include "ratios/cvode.h"

#ifdef SERVODX_HAVE_SUNDIALS
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "integrate/sparse_lu.h"
#include "model/derived.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "simulate/system.h"
#include "simulate/scenario.h"

namespace servodx::bench {
namespace {

using Live = System<double, NoEffects, false>;
using Lu = SparseLu<Live::n, Live::pattern>;
constexpr int n = Live::n;
constexpr double size_of[n] = {1e-2, 1e-5, 1e-2, 1e7, 1e7, 1e7, 1e-4, 1e-1, 1e7, 1e7, 1e-1, 1e-1};  // [SI]

struct Run {
  const Scenario& in;
  Live live;
  const double* p;

  // Inputs as they are at t, in a line between the samples.
  double at(double t) {
    const std::size_t last = in.time.size() - 2;
    const std::size_t k = std::min(last, static_cast<std::size_t>(std::max(0.0, t / (in.time[1] - in.time[0]))));
    const double per = 1.0 / (in.time[k + 1] - in.time[k]);
    live.at.current = in.command[k] + p[row::servovalve_null] * in.rated_current;
    live.at.load_force = in.load_force[k];
    live.slope = {(in.command[k + 1] - in.command[k]) * per, 0, 0, (in.load_force[k + 1] - in.load_force[k]) * per};
    return t - in.time[k];
  }
};

std::array<double, n>& state_of(N_Vector y) { return *reinterpret_cast<std::array<double, n>*>(N_VGetArrayPointer(y)); }

int rate(realtype t, N_Vector y, N_Vector f, void* data) {
  Run& run = *static_cast<Run*>(data);
  const double since = run.at(t);
  run.live.value(state_of(y), since, state_of(f));
  return 0;
}

int jacobian(realtype t, N_Vector y, N_Vector, SUNMatrix j, void* data, N_Vector, N_Vector, N_Vector) {
  Run& run = *static_cast<Run*>(data);
  const double since = run.at(t);
  run.live.at.current += run.live.slope.current * since;
  run.live.at.load_force += run.live.slope.load_force * since;
  std::array<double, Lu::entries> w;
  std::array<double, n> f, f_t;
  run.live.value_and_jacobian(state_of(y), 0.0, f, w, f_t);
  SUNMatZero(j);
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k)
      if (holds(Live::pattern.row[i], k)) SM_ELEMENT_D(j, i, k) = w[Lu::plan.slot[i][k]];
  return 0;
}

}  // namespace

const char* cvode_missing() { return nullptr; }

std::optional<Trajectory> run_cvode(const Scenario& in, const ParameterVector& p, const CvodeSetting& setting,
                                    const Trajectory& start) {
  const Derived<double> d = derive<double>(p.data(), in.oil);
  Run run{in, Live{p.data(), d, {}, {}, 0, 0, 0, 0}, p.data()};
  run.live.at.supply_pressure = p[row::supply_pressure];
  run.live.at.return_pressure = p[row::return_pressure];
  SUNContext context;
  SUNContext_Create(nullptr, &context);
  N_Vector y = N_VNew_Serial(n, context), tolerance = N_VNew_Serial(n, context), found = N_VNew_Serial(n, context);
  for (int i = 0; i < n; ++i) {
    state_of(tolerance)[i] = setting.tolerance * size_of[i];
    state_of(y)[i] = 0;
  }
  const auto first = [&](Signal s) { return start.signals[simulated_index(s)].front(); };
  auto& x = state_of(y);  // at rest, as the trace begins
  x[s_x_spool] = first(Signal::spool_position);
  x[s_p_a] = first(Signal::pressure_a);
  x[s_p_b] = first(Signal::pressure_b);
  x[s_p_pilot_1] = first(Signal::pilot_pressure_1);
  x[s_p_pilot_2] = first(Signal::pilot_pressure_2);
  x[s_p_filter] = p[row::supply_pressure];
  run.live.at.friction.rest(x[s_x_spool], x[s_x_piston]);

  void* cvode = CVodeCreate(CV_BDF, context);
  SUNMatrix matrix = SUNDenseMatrix(n, n, context);
  SUNLinearSolver solver = SUNLinSol_Dense(y, matrix, context);
  bool good = CVodeInit(cvode, rate, in.time[0], y) == CV_SUCCESS &&
              CVodeSVtolerances(cvode, setting.tolerance, tolerance) == CV_SUCCESS &&
              CVodeSetUserData(cvode, &run) == CV_SUCCESS &&
              CVodeSetLinearSolver(cvode, solver, matrix) == CV_SUCCESS &&
              CVodeSetJacFn(cvode, jacobian) == CV_SUCCESS && CVodeSetMaxOrd(cvode, 2) == CV_SUCCESS &&
              CVodeSetMaxNumSteps(cvode, 1000000) == CV_SUCCESS;
  Trajectory out;
  const auto report = [&](const std::array<double, n>& s) {
    const double values[] = {
        s[s_x_spool], p[row::position_sensor_gain] * (s[s_x_piston] - p[row::position_sensor_lag] * s[s_v_piston]),
        s[s_p_a], s[s_p_b]};
    for (int c = 0; c < 4; ++c) out.signals[c].push_back(values[c]);
  };
  report(x);
  double t = in.time[0];
  for (std::size_t k = 1; good && k < in.time.size(); ++k) {
    if (setting.stop_at_knots) CVodeSetStopTime(cvode, in.time[k]);
    while (good && t < in.time[k] * (1 - 1e-12)) {
      const double spool = x[s_x_spool], rod = x[s_x_piston], from = t;
      good = CVode(cvode, in.time[k], y, &t, CV_ONE_STEP) >= 0;
      if (good && t > from)
        run.live.at.friction.move(spool, x[s_x_spool], rod, x[s_x_piston], t - from, d.spool_presliding, d.breakaway);
    }
    good = good && CVodeGetDky(cvode, in.time[k], 0, found) == CV_SUCCESS;
    if (good) report(state_of(found));
  }
  SUNLinSolFree(solver);
  SUNMatDestroy(matrix);
  CVodeFree(&cvode);
  N_VDestroy(y), N_VDestroy(tolerance), N_VDestroy(found);
  SUNContext_Free(&context);
  if (!good) return std::nullopt;
  out.ok = true;
  return out;
}

}  // namespace servodx::bench

#else

namespace servodx::bench {

const char* cvode_missing() { return "SUNDIALS is not installed (libsundials-dev)"; }
std::optional<Trajectory> run_cvode(const Scenario&, const ParameterVector&, const CvodeSetting&, const Trajectory&) {
  return std::nullopt;
}

}  // namespace servodx::bench
#endif
