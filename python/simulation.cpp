// Simulation: the model driven by a log's inputs; and a log beside its simulation.
#include "define.h"
#include "fields.h"
#include "state.h"
#include "watch.h"

namespace servodx::python {
namespace {

py::dict columns_of(const SimulationOfLog& s) {
  py::dict out;
  for (const OutputColumn& c : s.run.columns) out[py::str(std::string(name_of(c.signal)))] = array_of(c.value);
  return out;
}

py::array_t<double> column_of(const SimulationOfLog& s, const std::string& name) {
  const std::optional<Signal> signal = find_signal(name);
  const OutputColumn* column = signal ? s.run.find(*signal) : nullptr;
  if (!column) throw py::key_error(name);
  return array_of(column->value);
}

SimulationOfLog simulation_of(const Log& log, const Table& params, const Rig& rig, std::optional<double> step,
                              bool reference, int threads) {
  const SimulationOptions how{.step = step, .reference = reference, .threads = threads_here(threads)};
  const py::gil_scoped_release free;
  return {simulate(log, params, rig, how), log, rig};
}

py::dict chart_signals(const LogChart& chart) {
  py::dict out;
  for (const LogChart::OfSignal& s : chart.signals) {
    py::dict of;
    of["measured"] = array_of(s.measured), of["simulated"] = array_of(s.simulated);
    of["residual"] = array_of(s.residual), of["sigma"] = array_of(s.sigma);
    out[py::str(std::string(name_of(s.signal)))] = of;
  }
  return out;
}

}  // namespace

void define_simulation(py::module_& m) {
  using S = SimulationOfLog;
  py::class_<S>(m, "Simulation", "What the log's sensors would have shown: a mapping of name -> [SI] (samples,).")
      .def_property_readonly(
          "time", [](const S& s) { return array_of(s.run.time); }, "[s] (samples,)")
      .def_property_readonly("signals", &columns_of, "name -> [SI] (samples,)")
      .def_property_readonly("notes", [](const S& s) { return s.run.notes; })
      .def_property_readonly(
          "step", [](const S& s) { return s.run.step; }, "[s] that was taken")
      .def_property_readonly(
          "impact_step", [](const S& s) { return s.run.impact_step; },
          "[s] that was taken after a jump of the command, and while the rod comes upon its stop")
      .def(
          "save", [](const S& s, const Path& path) { write_simulation(path.string(), s.log, s.run, s.rig); },
          py::arg("path"), "As `servodx simulate -o` writes, byte for byte.")
      .def("keys", [](const S& s) { return columns_of(s).attr("keys")(); })
      .def("__getitem__", &column_of)
      .def("__iter__", [](const S& s) { return py::iter(columns_of(s)); })
      .def("__len__", [](const S& s) { return s.run.columns.size(); })
      .def("__repr__",
           [](const S& s) {
             return "<Simulation of " + s.log.path + ", " + std::to_string(s.run.time.size()) + " samples>";
           })
      .def(pickled<S>());
  m.def("simulate", &simulation_of, py::arg("log"), py::kw_only(), py::arg("params"), py::arg("rig") = Rig{},
        py::arg("step") = py::none(), py::arg("reference") = false, py::arg("threads") = 0,
        "The model driven by the log's inputs. step: [s] largest of the integrator.");
  py::class_<LogChart>(m, "Replay", "A log beside its simulation, with the residual and what it is expected to be.")
      .def_readonly("log", &LogChart::log)
      .def_property_readonly(
          "time", [](const LogChart& c) { return array_of(c.time); }, "[s] (samples,)")
      .def_property_readonly(
          "command", [](const LogChart& c) { return array_of(c.command); }, "[A] (samples,) what drove the simulation")
      .def_property_readonly("signals", &chart_signals,
                             "name -> measured, simulated, residual, sigma: [SI] (samples,) each")
      .def("__repr__", [](const LogChart& c) { return "<Replay of " + c.log + ">"; })
      .def(pickled<LogChart>());
  m.def(
      "replay",
      [](const Log& log, const Table& params, const Rig& rig) {
        const py::gil_scoped_release free;
        return chart_of(log, params, rig);
      },
      py::arg("log"), py::kw_only(), py::arg("params"), py::arg("rig") = Rig{},
      "The log beside its simulation by a table, tuned or not.");
}

}  // namespace servodx::python
