// Plan: the excitation that tells most, within limits.
#include "define.h"
#include "fields.h"
#include "state.h"

namespace servodx::python {
namespace {

py::list planned_faults(const PlannedTest& test) {
  py::list out;
  for (const PlannedTest::Fault& f : test.planned.faults) {
    py::dict row;
    row["name"] = f.name, row["least"] = f.least, row["severity"] = f.severity, row["unit"] = f.unit;
    row["from_mildest"] = f.from_mildest;
    row["deviates"] = f.deviates, row["found"] = f.found, row["named"] = f.named, row["nearest"] = f.nearest;
    out.append(row);
  }
  return out;
}

py::list planned_pairs(const PlannedTest& test) {
  py::list out;
  for (const PlannedTest::Pair& p : test.planned.pairs) {
    py::dict row;
    row["first"] = p.first, row["second"] = p.second, row["told"] = p.told;
    out.append(row);
  }
  return out;
}

py::list planned_rows(const PlannedTest& test) {
  py::list out;
  for (const PlannedTest::Row& r : test.planned.rows) {
    py::dict row;
    row["name"] = r.name, row["before"] = r.before, row["after"] = r.after, row["unit"] = r.unit;
    out.append(row);
  }
  return out;
}

py::dict extremes_of(const PlannedTest& test) {
  const PlannedTest::Extremes& e = test.planned.extremes;
  py::dict out;
  out["current"] = e.current, out["stroke"] = e.stroke, out["speed"] = e.speed;
  out["pressure_low"] = e.pressure_low, out["pressure_high"] = e.pressure_high, out["cavitates"] = e.cavitates;
  return out;
}

py::list pieces_of(const PlannedTest& test) {
  py::list out;
  for (const PlannedTest::Piece& p : test.pieces) {
    py::dict row;
    row["shape"] = p.shape, row["start"] = p.start, row["seconds"] = p.seconds;
    row["amplitude"] = p.amplitude, row["rate"] = p.rate;
    out.append(row);
  }
  return out;
}

}  // namespace

void define_plan(py::module_& m) {
  using P = PlannedTest;
  py::class_<P>(m, "Plan", "A planned test, and what it would show.")
      .def_property_readonly(
          "time", [](const P& p) { return array_of(p.time); }, "[s] (samples,)")
      .def_property_readonly(
          "command", [](const P& p) { return array_of(p.command); }, "[A] (samples,) each is held until the next")
      .def_property_readonly(
          "setpoint", [](const P& p) { return array_of(p.setpoint); }, "[m] (samples,) of a closed loop; else empty")
      .def_property_readonly(
          "random_command", [](const P& p) { return array_of(p.random_command); }, "[A] (samples,) drawn blindly")
      .def_readonly("threshold", &P::threshold, "[deviates] that a finding needs")
      .def_property_readonly("information", [](const P& p) { return p.planned.information; })
      .def_property_readonly("random_information", [](const P& p) { return p.random.information; })
      .def_property_readonly("extremes", &extremes_of,
                             "of a healthy valve within its tolerances: current [A], stroke [m], speed [m/s], "
                             "pressure_low and pressure_high [Pa], cavitates")
      .def_readonly("notes", &P::notes)
      .def_readonly("simulations", &P::simulations)
      .def_readonly("failed_simulations", &P::failed_simulations)
      .def_readonly("interrupted", &P::interrupted)
      .def(
          "save", [](const P& p, const Path& path) { write_command(path.string(), p); }, py::arg("path"),
          "CSV as `servodx plan -o` writes, byte for byte.")
      .def_property_readonly("_faults", &planned_faults)
      .def_property_readonly("_pairs", &planned_pairs)
      .def_property_readonly("_rows", &planned_rows)
      .def_property_readonly("_pieces", &pieces_of)
      .def("__repr__", [](const P& p) { return "<Plan of " + std::to_string(p.pieces.size()) + " pieces>"; })
      .def(pickled<P>());
}

}  // namespace servodx::python
