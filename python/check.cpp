// Checked: the prognostic checks of one log.
#include "define.h"

namespace servodx::python {
namespace {

py::list checked_figures(const Checked& checked) {
  py::list out;
  for (const Checked::Figure& f : checked.figures) {
    py::dict row;
    row["name"] = f.name, row["value"] = f.value, row["std_error"] = f.std_error, row["unit"] = f.unit;
    out.append(row);
  }
  return out;
}

}  // namespace

void define_check(py::module_& m) {
  py::class_<Checked>(m, "Checked", R"(The prognostic checks of one log.

It does not pickle: record it where it was made. Several processes may write one history.)")
      .def_readonly("log", &Checked::log)
      .def_readonly("sha256", &Checked::sha256)
      .def_readonly("temperature", &Checked::temperature, "[K] of the oil: the log's, or estimated")
      .def_readonly("notes", &Checked::notes)
      .def_readonly("simulations", &Checked::simulations)
      .def_readonly("failed_simulations", &Checked::failed_simulations)
      .def_readonly("interrupted", &Checked::interrupted, "no figure was determined")
      .def_property_readonly("_figures", &checked_figures)
      .def("__repr__", [](const Checked& c) { return "<Checked " + c.log + ">"; });
}

}  // namespace servodx::python
