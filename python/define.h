// What the parts of the Python module share.
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <string>
#include <vector>

#include "servodx/servodx.h"

namespace servodx::python {

namespace py = pybind11;
using Path = std::filesystem::path;
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

inline py::array_t<double> array_of(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

// A table without a tune is a Table; what was tuned stays with the rig that it speaks of.
struct TunedOnRig {
  Tuned tuned;
  Rig rig;
  TuneChart chart;
};
struct SimulationOfLog {
  Simulation run;
  Log log;
  Rig rig;
};
struct VerdictText : Verdict {
  std::string json;
};
struct ExplanationText : Explanation {
  std::string json;
};
struct TrendWithChart : Trend {
  TrendChart chart;
};

// Verdicts and explanations with the text that the program writes of them.
VerdictText with_text(Verdict verdict);
ExplanationText with_text(Explanation explanation);

py::list records_of(const std::vector<ParameterResult>& parameters);
py::list records_of(const std::vector<ChannelResult>& channels);

void define_errors(py::module_& m);
void define_rig(py::module_& m);
void define_note(py::module_& m);
void define_log(py::module_& m);
void define_table(py::module_& m);
void define_baseline(py::module_& m);
void define_verdict(py::module_& m);
void define_explanation(py::module_& m);
void define_simulation(py::module_& m);
void define_tuned(py::module_& m);
void define_check(py::module_& m);
void define_history(py::module_& m);
void define_trend(py::module_& m);
void define_plan(py::module_& m);
void define_curves(py::module_& m);
void define_fleet(py::module_& m);
void define_objective(py::module_& m);
void define_process(py::module_& m);

}  // namespace servodx::python
