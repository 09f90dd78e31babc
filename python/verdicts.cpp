// Verdict: what diagnose says of a log.
#include "define.h"
#include "fields.h"
#include "state.h"

namespace servodx::python {
namespace {

void define_parts(py::class_<VerdictText>& verdict) {
  using V = Verdict;
  py::enum_<V::Kind>(verdict, "Kind")
      .value("healthy", V::Kind::healthy)
      .value("fault", V::Kind::fault)
      .value("unknown", V::Kind::unknown);
  py::class_<V::Suspicion>(verdict, "Suspicion",
                           "What stands first in a log that cannot be distinguished from healthy ones.")
      .def_readonly("name", &V::Suspicion::name)
      .def_readonly("severity", &V::Suspicion::severity)
      .def_readonly("rate", &V::Suspicion::rate, "of false alarms at which it would be said")
      .def_readonly("logs_needed", &V::Suspicion::logs_needed, "healthy ones; 0 or -1: more do not help by themselves")
      .def(pickled<V::Suspicion>());
  py::class_<V::Named>(verdict, "Named", "A fault that is named.")
      .def_readonly("name", &V::Named::name)
      .def_readonly("probability", &V::Named::probability)
      .def_readonly("severity", &V::Named::severity)
      .def_readonly("channel", &V::Named::channel, "of a sensor's: which signal")
      .def(pickled<V::Named>());
  py::class_<V::Detectable>(verdict, "Detectable", "The least severity that the log would have shown, 95 of 100.")
      .def_readonly("value", &V::Detectable::value, "[unit] None: not even the worst")
      .def_readonly("unit", &V::Detectable::unit)
      .def(pickled<V::Detectable>());
  py::class_<V::Beyond>(verdict, "Beyond", "What `explain` finds where no fault explains the log.")
      .def_readonly("first", &V::Beyond::first)
      .def_readonly("where", &V::Beyond::where)
      .def_readonly("depends_on", &V::Beyond::depends_on)
      .def_readonly("share", &V::Beyond::share, "of the held-out misfit that it removes")
      .def_readonly("taken", &V::Beyond::taken)
      .def_readonly("outside", &V::Beyond::outside, "of a sensor or the driver: nothing of the valve")
      .def(pickled<V::Beyond>());
  py::class_<V::Friction>(verdict, "Friction", "Of a spool, beside what leakage can press a land onto its sleeve with.")
      .def_readonly("friction", &V::Friction::friction, "[N] of the spool, sliding and breaking away")
      .def_readonly("largest", &V::Friction::largest, "[N] lateral, of one land")
      .def_property_readonly("coefficient", &V::Friction::coefficient,
                             "that the largest force would need to bring this friction")
      .def(pickled<V::Friction>());
}

}  // namespace

VerdictText with_text(Verdict verdict) {
  VerdictText out;
  out.json = json_of(verdict);
  static_cast<Verdict&>(out) = std::move(verdict);
  return out;
}

void define_verdict(py::module_& m) {
  py::enum_<ActionClass>(m, "ActionClass", "What a verdict asks for, by urgency.")
      .value("none", ActionClass::none)
      .value("abuse", ActionClass::abuse)
      .value("abnormal", ActionClass::abnormal)
      .value("critical", ActionClass::critical);
  py::class_<Verdict::Severity>(m, "Severity", "A fault's size with its 95 % interval.")
      .def_readonly("value", &Verdict::Severity::value, "[unit]")
      .def_readonly("lower", &Verdict::Severity::lower, "[unit]")
      .def_readonly("upper", &Verdict::Severity::upper, "[unit]")
      .def_readonly("unit", &Verdict::Severity::unit)
      .def(pickled<Verdict::Severity>());
  using V = VerdictText;
  py::class_<V> verdict(m, "Verdict", "The verdict on one log.");
  define_parts(verdict);
  verdict.def_readonly("log", &V::log)
      .def_readonly("kind", &V::kind)
      .def_readonly("interrupted", &V::interrupted)
      .def_readonly("error", &V::error, "[deviates] from health")
      .def_readonly("threshold", &V::threshold, "[deviates] beyond it the log is not healthy")
      .def_readonly("p_value", &V::p_value, "of such an error on a healthy log")
      .def_readonly("fault", &V::fault, "label of the one named; empty: none")
      .def_readonly("faults", &V::faults, "none, one or two; the first is the one named")
      .def_readonly("severity", &V::severity, "of the fault named")
      .def_readonly("probabilities", &V::probabilities, "by label; 'healthy' and 'unknown' among them")
      .def_readonly("ambiguous_with", &V::ambiguous_with)
      .def_readonly("separating_test", &V::separating_test)
      .def_readonly("onset", &V::onset, "[s] since when; None: no change in mid-log stands out")
      .def_readonly("suspicion", &V::suspicion, "of a healthy verdict")
      .def_readonly("detectable", &V::detectable, "by label: the least severity that this log would have shown")
      .def_readonly("beyond", &V::beyond, "of an unknown verdict")
      .def_readonly("friction", &V::friction,
                    "of a named fault that moves the spool's, where the rig file states the land's length")
      .def_readonly("action_class", &V::action_class)
      .def_readonly("action", &V::action)
      .def_readonly("notes", &V::notes)
      .def_readonly("simulations", &V::simulations)
      .def_readonly("failed_simulations", &V::failed_simulations)
      .def_readonly("json", &V::json, "as it stands among the results of the program's JSON")
      .def_property_readonly("_parameters", [](const V& v) { return records_of(v.parameters); })
      .def_property_readonly("_channels", [](const V& v) { return records_of(v.channels); })
      .def("__repr__",
           [](const V& v) {
             return "<Verdict " + name_of(v.kind) + (v.fault.empty() ? "" : " " + v.fault) + " of " + v.log + ">";
           })
      .def(pickled<V>());
}

}  // namespace servodx::python
