// Curves: a valve's figures on a test stand.
#include "servodx/curves.h"

#include "define.h"
#include "fields.h"
#include "state.h"

namespace servodx::python {
namespace {

py::list sheet_figures(const AcceptanceSheet& sheet) {
  py::list out;
  for (const AcceptanceSheet::Figure& f : sheet.figures) {
    py::dict row;
    row["name"] = f.name, row["signal"] = f.signal, row["value"] = f.value, row["unit"] = f.unit;
    row["uncertainty"] = f.uncertainty;
    row["min"] = f.limit ? f.limit->min : std::nullopt, row["max"] = f.limit ? f.limit->max : std::nullopt;
    row["pass"] = f.pass, row["note"] = f.note;
    out.append(row);
  }
  return out;
}

py::dict curves_of(const AcceptanceSheet& sheet) {
  py::dict out;
  for (const AcceptanceSheet::Curve& c : sheet.curves) {
    py::dict of;
    of["current"] = array_of(c.current), of["up"] = array_of(c.up);
    of["down"] = array_of(c.down), of["mean"] = array_of(c.mean);
    out[py::str(std::string(name_of(c.signal)))] = of;
  }
  return out;
}

py::list response_of(const AcceptanceSheet& sheet) {
  py::list out;
  for (const AcceptanceSheet::Response& r : sheet.response) {
    py::dict row;
    row["frequency"] = r.frequency, row["gain"] = r.gain, row["phase"] = r.phase, row["coherence"] = r.coherence;
    out.append(row);
  }
  return out;
}

std::vector<InstrumentError> errors_of(const std::map<std::string, std::pair<double, double>>& instruments) {
  std::vector<InstrumentError> out;
  for (const auto& [name, of] : instruments) {
    const std::optional<Signal> signal = find_signal(name);
    if (!signal) throw py::key_error(name);
    out.push_back({*signal, of.first, of.second});
  }
  return out;
}

}  // namespace

void define_curves(py::module_& m) {
  using S = AcceptanceSheet;
  py::class_<S> sheet(m, "Curves", "The standard figures of a valve from a log of a test stand (SAE ARP490).");
  py::enum_<S::Kind>(sheet, "Kind")
      .value("passed", S::Kind::pass)
      .value("failed", S::Kind::fail)
      .value("not_judged", S::Kind::not_judged)
      .value("incomplete", S::Kind::incomplete);
  sheet.def_readonly("kind", &S::kind, "by the rig file's [limits]")
      .def_property_readonly("curves", &curves_of, "signal -> current [A], up, down, mean [SI]: (points,) each")
      .def_readonly("response_signal", &S::response_signal)
      .def_readonly("notes", &S::notes)
      .def_property_readonly("_figures", &sheet_figures)
      .def_property_readonly("_response", &response_of)
      .def("__repr__", [](const S& s) { return "<Curves, " + std::to_string(s.figures.size()) + " figures>"; })
      .def(pickled<S>());
  m.def(
      "curves",
      [](const Log& log, const Rig& rig, const std::map<std::string, std::pair<double, double>>& instruments,
         double guard) {
        const SheetOptions how{.instruments = errors_of(instruments), .guard = guard};
        const py::gil_scoped_release free;
        return acceptance_sheet(log, rig, how);
      },
      py::arg("log"), py::arg("rig"), py::kw_only(),
      py::arg("instruments") = std::map<std::string, std::pair<double, double>>(),
      py::arg("guard") = SheetOptions{}.guard,
      "Figures and curves of a log. instruments: signal -> expanded uncertainties (k = 2) absolute [SI] and relative. "
      "guard: [expanded uncertainties] inside its limit that a figure has to be. Raises InputError where the log shows "
      "none.");
}

}  // namespace servodx::python
