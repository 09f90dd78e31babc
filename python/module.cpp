// The Python module on the library's front door: types with named fields, calls that leave the interpreter free.
#include <optional>

#include "define.h"

namespace servodx::python {

void define_errors(py::module_& m) {
  static const py::handle type = PyErr_NewExceptionWithDoc(
      "servodx.InputError",
      "A bad input: file, line, column, rule and mend say where, what and how; code is its section of docs/errors.md, "
      "None where it has none.",
      PyExc_ValueError, nullptr);
  m.attr("InputError") = type;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      const std::optional<Trouble> trouble = trouble_of(error);
      py::object raised = py::reinterpret_borrow<py::object>(type)(told(error));
      raised.attr("file") = error.where.file;
      raised.attr("line") = error.where.line;
      raised.attr("column") = error.where.column;
      raised.attr("rule") = error.rule;
      raised.attr("mend") = error.mend;
      raised.attr("code") = trouble ? py::object(py::str(code_of(*trouble))) : py::object(py::none());
      PyErr_SetObject(type.ptr(), raised.ptr());
    }
  });
}

}  // namespace servodx::python

PYBIND11_MODULE(_servodx, m) {
  using namespace servodx::python;
  m.doc() = "servodx: faults of electrohydraulic servovalves from rig logs.";
  m.attr("__version__") = SERVODX_VERSION;
  define_errors(m);
  define_process(m);
  define_rig(m);
  define_note(m);
  define_log(m);
  define_table(m);
  define_baseline(m);
  define_verdict(m);
  define_explanation(m);
  define_simulation(m);
  define_check(m);
  define_history(m);
  define_trend(m);
  define_plan(m);
  define_curves(m);
  define_fleet(m);
  define_objective(m);
  define_tuned(m);
}
