// Rig: from a file, from a dictionary, from text.
#include "define.h"
#include "fields.h"
#include "state.h"

namespace servodx::python {

void define_rig(py::module_& m) {
  py::class_<Rig>(m, "Rig", R"(What the data sheet says of valve and rig.

Rig() says nothing, Rig("bench.toml") reads a file, Rig({"valve": {"rated_current": "20 mA"}}) takes the same keys from a
dictionary. Raises InputError with file, line and key.)")
      .def(py::init<>())
      .def(py::init([](const py::dict& facts) {
             const py::object text = py::module_::import("servodx.toml_text").attr("toml_text")(facts);
             return make_rig("rig in memory", py::cast<std::string>(text));
           }),
           py::arg("facts"))
      .def(py::init([](const Path& path) { return read_rig_file(path.string()); }), py::arg("path"))
      .def_static(
          "from_text", [](const std::string& text, const std::string& name) { return make_rig(name, text); },
          py::arg("text"), py::arg("name") = "rig in memory", "What a rig.toml holds, from memory.")
      .def_readonly("path", &Rig::path)
      .def_readonly("name", &Rig::name)
      .def_readonly("serial", &Rig::serial)
      .def_readonly("sha256", &Rig::sha256)
      .def_readonly("facts", &Rig::facts, "dotted key -> [SI]")
      .def_readonly("words", &Rig::words, "dotted key -> word")
      .def_readonly("null_limit", &Rig::null_limit, "[1 of rated current]")
      .def_readonly("mains_frequency", &Rig::mains_frequency, "[Hz]; None: not said")
      .def_readonly("oil_temperature", &Rig::oil_temperature, "[K] of logs that do not record it; None: not said")
      .def("__repr__",
           [](const Rig& rig) {
             return "<Rig " + (rig.name.empty() ? rig.path : rig.name) + ", " + std::to_string(rig.facts.size()) +
                    " facts>";
           })
      .def(pickled<Rig>());
}

}  // namespace servodx::python
