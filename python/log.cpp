// Log: from a file, from columns in memory, and back.
#include <map>

#include "define.h"
#include "fields.h"
#include "state.h"

namespace servodx::python {
namespace {

py::dict signals_of(const Log& log) {
  py::dict out;
  for (int i = 0; i < n_signals; ++i)
    if (const auto s = static_cast<Signal>(i); log.has(s)) out[py::str(std::string(name_of(s)))] = array_of(log[s]);
  return out;
}

Log log_of_columns(const std::string& name, const py::dict& columns, const Rig& rig) {
  std::vector<LogColumn> in;
  for (const auto& [head, values] : columns) {
    const auto numbers = py::cast<Array>(values);
    in.push_back({py::cast<std::string>(head), {numbers.data(), numbers.data() + numbers.size()}});
  }
  return make_log(name, in, rig);
}

void save(const Log& log, const Path& path) {
  std::vector<OutputColumn> columns = {output_column(log, Signal::time, log.time)};
  for (int i = 1; i < n_signals; ++i)
    if (const auto s = static_cast<Signal>(i); log.has(s)) columns.push_back(output_column(log, s, log[s]));
  write_log(path.string(), columns);
}

}  // namespace

void define_log(py::module_& m) {
  py::class_<Log>(m, "Log", R"(A rig log in SI units.

Log(frame, units={"pressure_a": "bar"}, rig=rig) takes a DataFrame or a mapping of columns, (samples,) each. A column is
named as in a file, "pressure_a [bar]", or has its unit in `units` or in frame.attrs["units"]. Time is a column or the
index. Raises InputError by the rules of a file.)")
      .def(py::init([](const py::object& data, const py::object& units, const Rig& rig, const std::string& name) {
             const py::object columns = py::module_::import("servodx.frames").attr("columns_of")(data, units);
             return log_of_columns(name, py::cast<py::dict>(columns), rig);
           }),
           py::arg("data"), py::arg("units") = py::none(), py::arg("rig") = Rig{}, py::arg("name") = "log in memory")
      .def_static(
          "load", [](const Path& path, const Rig& rig) { return read_log(path.string(), rig); }, py::arg("path"),
          py::arg("rig") = Rig{}, "A CSV or MAT log.")
      .def("save", &save, py::arg("path"), "CSV in the log's own units; what was read reads back to the same bits.")
      .def_readonly("path", &Log::path)
      .def_readonly("sha256", &Log::sha256, "of the file's bytes; empty of a log in memory")
      .def_readonly("notes", &Log::notes)
      .def_property_readonly(
          "time", [](const Log& log) { return array_of(log.time); }, "[s] (samples,)")
      .def_property_readonly("signals", &signals_of, "name -> [SI] (samples,), NaN where a sample is missing")
      .def("__len__", &Log::samples)
      .def("__repr__",
           [](const Log& log) { return "<Log " + log.path + ", " + std::to_string(log.samples()) + " samples>"; })
      .def(pickled<Log>());
  m.def(
      "read_log", [](const Path& path, const Rig& rig) { return read_log(path.string(), rig); }, py::arg("path"),
      py::arg("rig") = Rig{}, "A CSV or MAT log. Raises InputError.");
  m.def("make_log", &log_of_columns, py::arg("name"), py::arg("columns"), py::arg("rig") = Rig{},
        "A log from columns: 'pressure_a [bar]' -> (samples,). Raises InputError.");
}

}  // namespace servodx::python
