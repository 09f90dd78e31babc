// History: the lives of valves, in one file.
#include "define.h"

namespace servodx::python {
namespace {

void record(History& history, const std::string& valve, double at, const Checked& checked, const TunedOnRig& tuned,
            std::optional<double> cycles, const std::string& serial) {
  const std::string known = serial.empty() ? tuned.rig.serial : serial;
  const py::gil_scoped_release free;
  history.record(valve, {.at = at, .cycles = cycles, .serial = known}, checked, tuned.tuned);
}

// One row a figure.
py::list history_rows(const History& history, const std::string& valve) {
  py::list out;
  for (const Recorded& r : recordings_of(history, valve))
    for (const Recorded::Figure& f : r.figures) {
      py::dict row;
      row["at"] = r.at, row["cycles"] = r.cycles, row["name"] = f.name, row["value"] = f.value;
      row["std_error"] = f.std_error, row["unit"] = f.unit, row["measured"] = f.measured;
      row["temperature"] = r.temperature, row["log"] = r.log;
      out.append(row);
    }
  return out;
}

py::list event_rows(const History& history, const std::string& valve) {
  py::list out;
  for (const RecordedEvent& e : events_of(history, valve)) {
    py::dict row;
    row["at"] = e.at, row["kind"] = name_of(e.kind), row["text"] = e.text;
    out.append(row);
  }
  return out;
}

py::dict import_csv(const Path& history, const Path& csv) {
  const Imported added = import_history(history.string(), csv.string());
  py::dict out;
  out["checks"] = added.checks, out["events"] = added.events, out["present"] = added.present;
  return out;
}

}  // namespace

void define_history(py::module_& m) {
  py::class_<History>(m, "History", R"(The lives of valves in one SQLite file; made where it is not there.

What record() has returned from survives a crash. One thread at a time; several processes may write one file. The file
is the history: it does not pickle.)")
      .def(py::init([](const Path& path, bool make) {
             return make ? History::open_or_make(path.string()) : History::open(path.string());
           }),
           py::arg("path"), py::arg("make") = true)
      .def("record", &record, py::arg("valve"), py::arg("at"), py::arg("checked"), py::arg("tuned"), py::kw_only(),
           py::arg("cycles") = py::none(), py::arg("serial") = "",
           "All of it or nothing. at: [h] of use. Raises InputError for a log that the history holds already.")
      .def("add_event", &History::add_event, py::arg("valve"), py::arg("at"), py::arg("kind"), py::arg("text") = "",
           "kind: filter_changed, valve_swapped, overhauled, retuned or note. at: [h] of use.")
      .def("valves", &History::valves)
      .def("tracked", &History::tracked, py::arg("valve"), "Another start for check(last=); empty where it is new.")
      .def(
          "save", [](const History& h, const Path& csv) { export_history(h, csv.string()); }, py::arg("csv"),
          "As `servodx history export` writes, byte for byte.")
      .def_static("import_csv", &import_csv, py::arg("path"), py::arg("csv"),
                  "What a CSV holds and the history does not, all or nothing: counts of checks, events, present.")
      .def("_rows", &history_rows, py::arg("valve"))
      .def("_events", &event_rows, py::arg("valve"))
      .def("__repr__",
           [](const History& h) { return "<History of " + std::to_string(h.valves().size()) + " valves>"; });
}

}  // namespace servodx::python
