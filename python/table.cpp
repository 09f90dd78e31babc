// Table: rows of a parameter table.
#include "define.h"
#include "fields.h"
#include "state.h"

namespace servodx::python {

void define_table(py::module_& m) {
  py::enum_<RowVerdict>(m, "RowVerdict", "What logs say of a row that a fit set free.")
      .value("bounded", RowVerdict::bounded)
      .value("one_sided", RowVerdict::one_sided)
      .value("flat", RowVerdict::flat)
      .value("at_bound", RowVerdict::at_bound)
      .value("confounded", RowVerdict::confounded)
      .value("frozen", RowVerdict::frozen);
  py::class_<Row>(m, "Row", "A row of a parameter table; numbers in its own unit.")
      .def_readonly("id", &Row::id)
      .def_readonly("name", &Row::name)
      .def_readonly("group", &Row::group)
      .def_readonly("nominal", &Row::nominal, "[unit]")
      .def_readonly("lower", &Row::lower, "[unit]")
      .def_readonly("upper", &Row::upper, "[unit]")
      .def_readonly("log_scale", &Row::log_scale)
      .def_readonly("estimate", &Row::estimate, "free in a fit")
      .def_readonly("unit", &Row::unit)
      .def_readonly("description", &Row::description)
      .def_readonly("source", &Row::source)
      .def_readonly("std_error", &Row::std_error, "[unit], in a tuned table")
      .def("__repr__", [](const Row& row) { return "<Row " + row.name + ">"; })
      .def(pickled<Row>());
  py::class_<Table>(m, "Table", "A parameter table: 41 rows, and those of its effects.")
      .def_static(
          "load", [](const Path& path) { return read_table(path.string()); }, py::arg("path"),
          "Raises InputError with file, line and column.")
      .def(
          "save", [](const Table& t, const Path& path) { write_table(path.string(), t); }, py::arg("path"),
          "The program's own file, byte for byte.")
      .def_readonly("path", &Table::path)
      .def_readonly("rows", &Table::rows)
      .def_readonly("sha256", &Table::sha256)
      .def_readonly("comments", &Table::comments, "of its file, for people")
      .def_readonly("state", &Table::state, "lines of its file that say what tuned it")
      .def_readonly("has_std_error", &Table::has_std_error, "a tuned table")
      .def("__len__", [](const Table& t) { return t.rows.size(); })
      .def("__getitem__",
           [](const Table& t, const std::string& name) {
             const int at = t.find(name);
             if (at < 0) throw py::key_error(name);
             return t[at];
           })
      .def("__repr__",
           [](const Table& t) { return "<Table " + t.path + ", " + std::to_string(t.rows.size()) + " rows>"; })
      .def(pickled<Table>());
}

}  // namespace servodx::python
