// The Python module on the library's front door: types with named fields, calls that leave the interpreter free.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "servodx/servodx.h"
#include "watch.h"

namespace py = pybind11;
using namespace servodx;
using python::Call;

namespace {

py::array_t<double> array_of(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

// What a Python `Tuned` is: the table and the rig that it speaks of.
struct TunedOnRig {
  Tuned tuned;
  Rig rig;
};

void define_errors(py::module_& m) {
  static const py::handle type = PyErr_NewExceptionWithDoc(
      "servodx.InputError", "A bad input: file, line, column, rule and mend say where, what and how.", PyExc_ValueError,
      nullptr);
  m.attr("InputError") = type;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      py::object raised = py::reinterpret_borrow<py::object>(type)(error.what());
      raised.attr("file") = error.where.file;
      raised.attr("line") = error.where.line;
      raised.attr("column") = error.where.column;
      raised.attr("rule") = error.rule;
      raised.attr("mend") = error.mend;
      PyErr_SetObject(type.ptr(), raised.ptr());
    }
  });
}

void define_inputs(py::module_& m) {
  py::class_<Rig>(m, "Rig", "What the data sheet says of valve and rig; facts in SI.")
      .def(py::init<>())
      .def(py::init(&read_rig_file), py::arg("path"))
      .def_static("from_text", &make_rig, py::arg("text"), py::arg("name") = "rig in memory")
      .def_readonly("path", &Rig::path)
      .def_readonly("name", &Rig::name)
      .def_readonly("serial", &Rig::serial)
      .def_readonly("facts", &Rig::facts);
  py::class_<Log>(m, "Log", "A rig log in SI units.")
      .def_readonly("path", &Log::path)
      .def_readonly("sha256", &Log::sha256)
      .def_readonly("notes", &Log::notes)
      .def_property_readonly(
          "time", [](const Log& log) { return array_of(log.time); }, "[s] (samples,)")
      .def_property_readonly(
          "signals",
          [](const Log& log) {
            py::dict out;
            for (int i = 0; i < n_signals; ++i)
              if (const auto s = static_cast<Signal>(i); log.has(s))
                out[py::str(std::string(name_of(s)))] = array_of(log[s]);
            return out;
          },
          "name -> [SI] (samples,), NaN where a sample is missing")
      .def("__len__", &Log::samples);
  m.def(
      "read_log", [](const std::string& path, const Rig& rig) { return read_log(path, rig); }, py::arg("path"),
      py::arg("rig") = Rig{}, "A CSV or MAT log. Raises InputError.");
  m.def(
      "make_log",
      [](const std::string& name, const std::map<std::string, std::vector<double>>& columns, const Rig& rig) {
        std::vector<LogColumn> in;
        for (const auto& [head, values] : columns) in.push_back({head, values});
        return make_log(name, in, rig);
      },
      py::arg("name"), py::arg("columns"), py::arg("rig") = Rig{},
      "A log from columns: 'pressure_a [bar]' -> (samples,). Raises InputError.");
  py::class_<Row>(m, "Row", "A row of a parameter table.")
      .def_readonly("id", &Row::id)
      .def_readonly("name", &Row::name)
      .def_readonly("group", &Row::group)
      .def_readonly("nominal", &Row::nominal)
      .def_readonly("lower", &Row::lower)
      .def_readonly("upper", &Row::upper)
      .def_readonly("estimate", &Row::estimate)
      .def_readonly("unit", &Row::unit)
      .def_readonly("std_error", &Row::std_error);
  py::class_<Table>(m, "Table", "A parameter table.")
      .def_static("load", &read_table, py::arg("path"))
      .def(
          "save", [](const Table& t, const std::string& path) { write_table(path, t); }, py::arg("path"))
      .def_readonly("rows", &Table::rows)
      .def_readonly("sha256", &Table::sha256);
}

void define_results(py::module_& m) {
  py::class_<Baseline>(m, "Baseline", "What fault-free logs score, and the threshold that promises a false-alarm rate.")
      .def_static("load", &read_baseline, py::arg("path"))
      .def(
          "save", [](const Baseline& b, const std::string& path) { write_baseline(path, b); }, py::arg("path"))
      .def_readonly("threshold", &Baseline::threshold)
      .def_readonly("asked", &Baseline::asked)
      .def_readonly("promised", &Baseline::promised)
      .def_readonly("logs", &Baseline::logs)
      .def_readonly("notes", &Baseline::notes);
  py::class_<Verdict::Severity>(m, "Severity", "A fault's size with its 95 % interval.")
      .def_readonly("value", &Verdict::Severity::value)
      .def_readonly("lower", &Verdict::Severity::lower)
      .def_readonly("upper", &Verdict::Severity::upper)
      .def_readonly("unit", &Verdict::Severity::unit);
  py::class_<Verdict> verdict(m, "Verdict", "The verdict on one log.");
  py::enum_<Verdict::Kind>(verdict, "Kind")
      .value("healthy", Verdict::Kind::healthy)
      .value("fault", Verdict::Kind::fault)
      .value("unknown", Verdict::Kind::unknown);
  verdict.def_readonly("log", &Verdict::log)
      .def_readonly("kind", &Verdict::kind)
      .def_readonly("error", &Verdict::error)
      .def_readonly("threshold", &Verdict::threshold)
      .def_readonly("p_value", &Verdict::p_value)
      .def_readonly("fault", &Verdict::fault)
      .def_readonly("severity", &Verdict::severity)
      .def_readonly("probabilities", &Verdict::probabilities)
      .def_readonly("ambiguous_with", &Verdict::ambiguous_with)
      .def_readonly("separating_test", &Verdict::separating_test)
      .def_readonly("onset", &Verdict::onset)
      .def_readonly("action", &Verdict::action)
      .def_readonly("notes", &Verdict::notes)
      .def("__repr__", [](const Verdict& v) {
        return "<Verdict " + name_of(v.kind) + (v.fault.empty() ? "" : " " + v.fault) + " of " + v.log + ">";
      });
  py::class_<Explanation> explanation(m, "Explanation", "What the simulation gets wrong, and what mending it gains.");
  py::enum_<Explanation::Kind>(explanation, "Kind")
      .value("sufficient", Explanation::Kind::sufficient)
      .value("extended", Explanation::Kind::extended)
      .value("unexplained", Explanation::Kind::unexplained);
  py::class_<Explanation::Cause>(explanation, "Cause")
      .def_readonly("effect", &Explanation::Cause::effect)
      .def_readonly("where", &Explanation::Cause::where)
      .def_readonly("delta_bic", &Explanation::Cause::delta_bic)
      .def_readonly("confusable_with", &Explanation::Cause::confusable_with);
  explanation.def_readonly("kind", &Explanation::kind)
      .def_readonly("where", &Explanation::where)
      .def_readonly("depends_on", &Explanation::depends_on)
      .def_readonly("causes", &Explanation::causes)
      .def_readonly("standing", &Explanation::standing)
      .def_readonly("probabilities", &Explanation::probabilities)
      .def_readonly("table", &Explanation::table)
      .def_readonly("notes", &Explanation::notes);
}

Baseline baseline_of(const TunedOnRig& self, const std::vector<Log>& logs, double false_alarm, std::uint64_t seed,
                     int threads, py::object progress) {
  Call call(std::move(progress));
  return call.run([&](Watch watch) {
    return make_baseline(logs, self.tuned, self.rig,
                         {.false_alarm = false_alarm, .seed = seed, .threads = threads, .watch = std::move(watch)});
  });
}

Verdict verdict_of(const TunedOnRig& self, const Log& log, const Baseline& baseline, std::uint64_t seed, int threads,
                   py::object progress) {
  Call call(std::move(progress));
  return call.run([&](Watch watch) {
    return diagnose(log, self.tuned, self.rig, baseline, {.seed = seed, .threads = threads, .watch = std::move(watch)});
  });
}

Explanation explanation_of(const TunedOnRig& self, const std::vector<Log>& logs,
                           const std::optional<Baseline>& baseline, std::uint64_t seed, int threads,
                           py::object progress) {
  Call call(std::move(progress));
  return call.run([&](Watch watch) {
    const ExplainOptions how{.seed = seed, .threads = threads, .watch = std::move(watch)};
    return baseline ? explain(logs, self.tuned, self.rig, *baseline, how) : explain(logs, self.tuned, self.rig, how);
  });
}

TunedOnRig tuned_on(const std::vector<Log>& logs, const Table& params, const Rig& rig, std::uint64_t seed, int threads,
                    int generations, int rounds, std::optional<std::vector<std::string>> effects, py::object progress) {
  Call call(std::move(progress));
  return call.run([&](Watch watch) {
    TuneOptions how;
    how.seed = seed, how.threads = threads, how.generations = generations, how.rounds = rounds;
    how.effects = std::move(effects);
    how.watch = std::move(watch);
    return TunedOnRig{tune(logs, params, rig, how), rig};
  });
}

void define_calls(py::module_& m) {
  const auto seed = py::arg("seed") = 1;
  const auto threads = py::arg("threads") = 0;
  const auto progress = py::arg("progress") = py::none();
  py::class_<TunedOnRig>(m, "Tuned", "A tuned table and the rig that it speaks of.")
      .def_static(
          "load",
          [](const std::string& path, const Rig& rig) {
            return TunedOnRig{read_tuned(path), rig};
          },
          py::arg("path"), py::arg("rig") = Rig{})
      .def(
          "save", [](const TunedOnRig& t, const std::string& path) { write_tuned(path, t.tuned); }, py::arg("path"))
      .def_property_readonly("table", [](const TunedOnRig& t) { return t.tuned.table; })
      .def_property_readonly("notes", [](const TunedOnRig& t) { return t.tuned.notes; })
      .def("baseline", &baseline_of, py::arg("logs"), py::arg("false_alarm") = BaselineOptions{}.false_alarm, seed,
           threads, progress, "Threshold from fault-free logs that did not tune the table.")
      .def("diagnose", &verdict_of, py::arg("log"), py::arg("baseline"), seed, threads, progress,
           "The verdict on one log.")
      .def("explain", &explanation_of, py::arg("logs"), py::arg("baseline") = py::none(), seed, threads, progress,
           "What the simulation gets wrong on logs of one valve in one state.");
  m.def("tune", &tuned_on, py::arg("logs"), py::kw_only(), py::arg("params"), py::arg("rig") = Rig{}, seed, threads,
        py::arg("generations") = TuneOptions{}.generations, py::arg("rounds") = TuneOptions{}.rounds,
        py::arg("effects") = py::none(), progress, "Nominal parameters from fault-free logs, pooled.");
  m.def(
      "simulate",
      [](const Log& log, const Table& params, const Rig& rig, std::optional<double> step, int how_many) {
        Simulation run;
        {
          py::gil_scoped_release free;
          run = simulate(log, params, rig, {.step = step, .threads = how_many});
        }
        py::dict out;
        for (const OutputColumn& c : run.columns) out[py::str(std::string(name_of(c.signal)))] = array_of(c.value);
        return out;
      },
      py::arg("log"), py::kw_only(), py::arg("params"), py::arg("rig") = Rig{}, py::arg("step") = py::none(), threads,
      "The model driven by the log's inputs: name -> [SI] (samples,).");
}

}  // namespace

PYBIND11_MODULE(_servodx, m) {
  m.doc() = "servodx: faults of electrohydraulic servovalves from rig logs.";
  define_errors(m);
  define_inputs(m);
  define_results(m);
  define_calls(m);
}
