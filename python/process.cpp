// A child that was forked has none of its parent's threads. It works on one of its own, and gets the same bits.
#include <omp.h>

#include "define.h"
#include "watch.h"

namespace servodx::python {

void define_process(py::module_& m) {
  const auto forked = [] {
    in_forked_child() = true;
    omp_set_num_threads(1);
  };
  py::module_::import("os").attr("register_at_fork")(py::arg("after_in_child") = py::cpp_function(forked));
  m.def(
      "_forked", [] { return bool(in_forked_child()); }, "Whether this process was forked from one that had servodx.");
}

}  // namespace servodx::python
