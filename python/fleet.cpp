// Fleet: a folder of results, one a log, as `diagnose --list` and `watch` leave it.
#include "define.h"
#include "fields.h"
#include "state.h"
#include "watch.h"

namespace servodx::python {
namespace {

py::list fleet_rows(const Fleet& fleet) {
  py::list out;
  for (const Fleet::Row& r : fleet.rows) {
    py::dict row;
    row["log"] = r.log, row["verdict"] = name_of(r.kind), row["fault"] = r.fault, row["probability"] = r.probability;
    const std::optional<Verdict::Severity>& s = r.severity;
    row["severity"] = s ? std::optional(s->value) : std::nullopt;
    row["severity_lower"] = s ? std::optional(s->lower) : std::nullopt;
    row["severity_upper"] = s ? std::optional(s->upper) : std::nullopt;
    row["severity_unit"] = s ? s->unit : "";
    row["error"] = r.error, row["threshold"] = r.threshold, row["file"] = r.file;
    out.append(row);
  }
  return out;
}

py::list refused_of(const std::vector<Fleet::Refused>& files) {
  py::list out;
  for (const Fleet::Refused& f : files) {
    py::dict row;
    row["file"] = f.file, row["line"] = f.line, row["column"] = f.column, row["rule"] = f.rule, row["mend"] = f.mend;
    out.append(row);
  }
  return out;
}

py::dict counts_of(const Path& folder, const Path& truth) {
  FleetCounts found;
  {
    const py::gil_scoped_release free;
    found = count_fleet(folder.string(), truth.string());
  }
  const auto rate = [](const FleetCounts::Rate& r) { return py::make_tuple(r.counted, r.of); };
  py::dict rates, out;
  for (const auto& [name, r] : found.rates) {
    py::dict of;
    of["detected"] = rate(r.detected), of["named"] = rate(r.named), of["sized"] = rate(r.sized);
    rates[py::str(name)] = of;
  }
  out["counts"] = found.counts, out["rates"] = rates;
  out["without_truth"] = found.without_truth, out["without_result"] = found.without_result;
  return out;
}

}  // namespace

void define_fleet(py::module_& m) {
  py::class_<Fleet>(m, "Fleet", R"(A folder of results, worst first.

`servodx diagnose --list` and `servodx watch` write such folders; Fleet(folder) reads them as `servodx gather` does.)")
      .def(py::init([](const Path& folder, py::object progress) {
             Call call(std::move(progress));
             return call.run([&](Watch watch) { return gather_results(folder.string(), watch); });
           }),
           py::arg("folder"), py::arg("progress") = true)
      .def(
          "save",
          [](const Fleet& f, const Path& path) {
            py::module_::import("servodx.files").attr("write_whole")(path.string(), f.csv);
          },
          py::arg("path"), "CSV as `servodx gather -o` writes, byte for byte.")
      .def_readonly("interrupted", &Fleet::interrupted)
      .def_readonly("without_schema", &Fleet::without_schema, "results of earlier versions, read as far as they go")
      .def_property_readonly("_rows", &fleet_rows)
      .def_property_readonly("_refused", [](const Fleet& f) { return refused_of(f.refused); })
      .def_property_readonly("_unread", [](const Fleet& f) { return refused_of(f.unread); })
      .def("__len__", [](const Fleet& f) { return f.rows.size(); })
      .def("__repr__", [](const Fleet& f) { return "<Fleet of " + std::to_string(f.rows.size()) + " logs>"; })
      .def(pickled<Fleet>());
  m.def("_count_fleet", &counts_of, py::arg("folder"), py::arg("truth"));
}

}  // namespace servodx::python
