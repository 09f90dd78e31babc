// Explanation: what the simulation gets wrong, and what mending it gains.
#include "define.h"
#include "fields.h"
#include "state.h"

namespace servodx::python {
namespace {

void define_parts(py::class_<ExplanationText>& explanation) {
  using E = Explanation;
  py::enum_<E::Kind>(explanation, "Kind")
      .value("sufficient", E::Kind::sufficient)
      .value("extended", E::Kind::extended)
      .value("unexplained", E::Kind::unexplained);
  py::class_<E::Gain>(explanation, "Gain", "Share of the held-out misfit that is removed, 90 % interval.")
      .def_readonly("value", &E::Gain::value)
      .def_readonly("lower", &E::Gain::lower)
      .def_readonly("upper", &E::Gain::upper)
      .def(pickled<E::Gain>());
  py::class_<E::Parameter> parameter(explanation, "Parameter", "A size of a cause.");
  py::enum_<E::Parameter::Told>(parameter, "Told")
      .value("interval", E::Parameter::Told::interval)
      .value("at_bound", E::Parameter::Told::at_bound)
      .value("not_told", E::Parameter::Told::not_told);
  parameter.def_readonly("value", &E::Parameter::value, "[unit]")
      .def_readonly("std_error", &E::Parameter::std_error, "[unit]")
      .def_readonly("lower", &E::Parameter::lower, "[unit] 90 %, within what is physical; NaN at a bound")
      .def_readonly("upper", &E::Parameter::upper, "[unit] 90 %, within what is physical; NaN at a bound")
      .def_readonly("told", &E::Parameter::told, "what the logs show of it")
      .def_readonly("unit", &E::Parameter::unit)
      .def(pickled<E::Parameter>());
  py::class_<E::Cause>(explanation, "Cause", "What explains the misfit.")
      .def_readonly("effect", &E::Cause::effect)
      .def_readonly("where", &E::Cause::where)
      .def_readonly("parameters", &E::Cause::parameters)
      .def_readonly("heldout_gain", &E::Cause::heldout_gain)
      .def_readonly("delta_bic", &E::Cause::delta_bic, "positive: it explains more than its parameters cost")
      .def_readonly("confusable_with", &E::Cause::confusable_with)
      .def("__repr__", [](const E::Cause& c) { return "<Cause " + c.effect + " at " + c.where + ">"; })
      .def(pickled<E::Cause>());
}

py::list channels_of(const ExplanationText& e) {
  py::list out;
  for (const Explanation::Channel& c : e.channels) {
    py::dict row;
    row["signal"] = c.signal, row["unit"] = c.unit, row["rms_before"] = c.rms_before, row["rms_after"] = c.rms_after;
    row["noise_rms"] = c.noise_rms, row["heldout_before"] = c.heldout_before, row["heldout_after"] = c.heldout_after;
    out.append(row);
  }
  return out;
}

py::list candidates_of(const ExplanationText& e) {
  py::list out;
  for (const Explanation::Candidate& c : e.candidates) {
    py::dict row;
    row["effect"] = c.effect, row["where"] = c.where, row["taken"] = c.taken, row["reason"] = c.reason;
    out.append(row);
  }
  return out;
}

}  // namespace

ExplanationText with_text(Explanation explanation) {
  ExplanationText out;
  out.json = json_of(explanation);
  static_cast<Explanation&>(out) = std::move(explanation);
  return out;
}

void define_explanation(py::module_& m) {
  using E = ExplanationText;
  py::class_<E> explanation(m, "Explanation", "What the simulation gets wrong, and what mending it gains.");
  define_parts(explanation);
  explanation.def_readonly("kind", &E::kind)
      .def_readonly("where", &E::where, "of the first cause; empty: nowhere")
      .def_readonly("depends_on", &E::depends_on, "of what no name explains: the variable that it follows")
      .def_readonly("causes", &E::causes, "new ones")
      .def_readonly("standing", &E::standing, "what the healthy logs of the baseline show too")
      .def_readonly("probabilities", &E::probabilities, "of causes, 'unlisted' and 'nothing'; empty without a baseline")
      .def_readonly("table", &E::table, "extended")
      .def_readonly("notes", &E::notes)
      .def_readonly("simulations", &E::simulations)
      .def_readonly("failed_simulations", &E::failed_simulations)
      .def_readonly("interrupted", &E::interrupted)
      .def_readonly("json", &E::json, "the keys that the program's JSON has behind its header")
      .def_property_readonly("_channels", &channels_of)
      .def_property_readonly("_candidates", &candidates_of)
      .def("__repr__",
           [](const E& e) {
             return "<Explanation " + name_of(e.kind) + (e.causes.empty() ? "" : ", " + e.causes.front().effect) + ">";
           })
      .def(pickled<E>());
}

}  // namespace servodx::python
