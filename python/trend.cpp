// Trend: a valve's state, the levels its checks have reached, and the life left.
#include "define.h"
#include "fields.h"
#include "state.h"
#include "watch.h"

namespace servodx::python {
namespace {

TrendWithChart trend_of(const History& history, const std::string& valve, double false_alarm, int healthy,
                        double coverage, const py::dict& failures, std::uint64_t seed, int threads) {
  TrendOptions how{.false_alarm = false_alarm,
                   .healthy = healthy,
                   .coverage = coverage,
                   .seed = seed,
                   .threads = threads_here(threads)};
  for (const auto& [check, level] : failures)
    how.failures.push_back({.check = py::cast<std::string>(check), .value = py::cast<double>(level)});
  Call call{py::none()};
  return call.run([&](Watch watch) {
    how.watch = std::move(watch);
    TrendWithChart out;
    static_cast<Trend&>(out) = trend(history, valve, how);
    out.chart = chart_of(out);
    return out;
  });
}

py::object range_of(const TrendChart::Range& r) { return py::make_tuple(r.lower, r.upper); }

py::list checks_of(const TrendWithChart& t) {
  py::list out;
  for (const TrendChart::OfCheck& c : t.chart.checks) {
    std::vector<double> at, value, temperature;
    py::list healthy;
    for (const TrendChart::Point& p : c.points) {
      at.push_back(p.at), value.push_back(p.value), temperature.push_back(p.temperature);
      healthy.append(p.healthy);
    }
    py::dict row;
    row["name"] = c.name, row["unit"] = c.unit, row["cause"] = c.cause;
    row["at"] = array_of(at), row["value"] = array_of(value), row["temperature"] = array_of(temperature);
    row["healthy"] = healthy, row["life"] = array_of(c.life), row["grows"] = c.grows;
    row["began"] = c.healthy, row["now"] = c.now, row["slope"] = c.slope;
    row["threshold"] = range_of(c.threshold), row["warning"] = range_of(c.warning),
    row["failure"] = range_of(c.failure);
    out.append(row);
  }
  return out;
}

}  // namespace

void define_trend(py::module_& m) {
  using T = TrendWithChart;
  py::class_<T> of_valve(m, "Trend", "A valve's state, and the life left.");
  py::enum_<T::State>(of_valve, "State")
      .value("unknown", T::State::unknown)
      .value("blind", T::State::blind)
      .value("healthy", T::State::healthy)
      .value("watch", T::State::watch)
      .value("warning", T::State::warning)
      .value("failed", T::State::failed);
  py::class_<T::Remaining>(of_valve, "Remaining", "Hours; infinite where never.")
      .def_readonly("median", &T::Remaining::median, "[h]")
      .def_readonly("lower", &T::Remaining::lower, "[h]")
      .def_readonly("upper", &T::Remaining::upper, "[h]")
      .def(pickled<T::Remaining>());
  py::class_<T::OfCheck>(of_valve, "OfCheck", "One check's trend.")
      .def_readonly("name", &T::OfCheck::name)
      .def_readonly("unit", &T::OfCheck::unit)
      .def_readonly("state", &T::OfCheck::state)
      .def_readonly("slope", &T::OfCheck::slope, "[unit / h]")
      .def_readonly("alert_at", &T::OfCheck::alert_at, "[h]")
      .def_readonly("remaining", &T::OfCheck::remaining)
      .def(pickled<T::OfCheck>());
  of_valve.def_readonly("valve", &T::valve)
      .def_readonly("serial", &T::serial)
      .def_readonly("state", &T::state)
      .def_readonly("at", &T::at, "[h] of the last check")
      .def_readonly("checks", &T::checks)
      .def_readonly("cause", &T::cause, "label of a fault; empty: none")
      .def_readonly("alert_at", &T::alert_at, "[h]")
      .def_readonly("remaining", &T::remaining, "to failure")
      .def_readonly("trends", &T::trends)
      .def_readonly("notes", &T::notes)
      .def_property_readonly(
          "life", [](const T& t) { return array_of(t.chart.life); },
          "[h] (draws,) equally likely hours from the last check to failure, sorted; infinite where never")
      .def_property_readonly("_checks", &checks_of)
      .def("__repr__", [](const T& t) { return "<Trend of " + t.valve + ": " + name_of(t.state) + ">"; })
      .def(pickled<T>());
  m.def("trend", &trend_of, py::arg("history"), py::arg("valve"), py::kw_only(),
        py::arg("false_alarm") = TrendOptions{}.false_alarm, py::arg("healthy") = TrendOptions{}.healthy,
        py::arg("coverage") = TrendOptions{}.coverage, py::arg("failures") = py::dict(), py::arg("seed") = 1,
        py::arg("threads") = 0,
        "State and life left of a valve. failures: check -> [unit of the check] upper level. Raises InputError.");
}

}  // namespace servodx::python
