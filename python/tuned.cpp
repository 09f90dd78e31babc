// Tuned: what tune() returns, and the calls that rest on it.
#include "define.h"
#include "fields.h"
#include "state.h"
#include "watch.h"

namespace servodx::python {
namespace {

constexpr const char* words[] = {"bounded", "one_sided", "flat", "at_bound", "confounded", "frozen"};

TunedOnRig on_rig(Tuned tuned, const Rig& rig) {
  TuneChart chart = chart_of(tuned);
  return {std::move(tuned), rig, std::move(chart)};
}

Baseline baseline_of(const TunedOnRig& self, const std::vector<Log>& logs, double false_alarm, std::uint64_t seed,
                     int threads, py::object progress, const std::vector<Log>& others) {
  Call call(std::move(progress));
  return call.run([&, how_many = threads_here(threads)](Watch watch) {
    return make_baseline(
        logs, self.tuned, self.rig,
        {.false_alarm = false_alarm, .seed = seed, .others = others, .threads = how_many, .watch = std::move(watch)});
  });
}

// One log, or several of one valve in one state.
VerdictText verdict_of(const TunedOnRig& self, const std::vector<Log>& logs, const Baseline& baseline,
                       const std::optional<Path>& actions, bool explain_unknown, std::uint64_t seed, int threads,
                       py::object progress) {
  if (logs.empty()) throw InputError({}, "there is no log to diagnose", "give one or more");
  Call call(std::move(progress));
  return call.run([&, how_many = threads_here(threads)](Watch watch) {
    const DiagnoseOptions how{.seed = seed,
                              .threads = how_many,
                              .watch = std::move(watch),
                              .actions = actions ? read_actions(actions->string()) : default_actions(),
                              .explain_unknown = explain_unknown};
    return with_text(logs.size() == 1 ? diagnose(logs.front(), self.tuned, self.rig, baseline, how)
                                      : diagnose_pool(logs, self.tuned, self.rig, baseline, how));
  });
}

ExplanationText explanation_of(const TunedOnRig& self, const std::vector<Log>& logs,
                               const std::optional<Baseline>& baseline, double level, std::vector<std::string> without,
                               std::uint64_t seed, int threads, py::object progress, bool keep_worse) {
  Call call(std::move(progress));
  return call.run([&, how_many = threads_here(threads)](Watch watch) {
    const ExplainOptions how{.seed = seed,
                             .threads = how_many,
                             .level = level,
                             .without = without,
                             .keep_worse = keep_worse,
                             .watch = std::move(watch)};
    return with_text(baseline ? explain(logs, self.tuned, self.rig, *baseline, how)
                              : explain(logs, self.tuned, self.rig, how));
  });
}

TunedOnRig tuned_on(const std::vector<Log>& logs, const Table& params, const Rig& rig, std::uint64_t seed, int threads,
                    int generations, int rounds, int population, double heldout,
                    std::optional<std::vector<std::string>> effects, std::vector<std::string> profile,
                    std::map<std::string, double> priors, int moving_average, const std::optional<Path>& checkpoint,
                    bool resume, py::object progress) {
  Call call(std::move(progress));
  return call.run_for_best([&, how_many = threads_here(threads)](Watch watch) {
    TuneOptions how;
    how.checkpoint = checkpoint ? checkpoint->string() : "", how.resume = resume;
    how.seed = seed, how.threads = how_many, how.generations = generations, how.rounds = rounds;
    how.population = population, how.heldout = heldout;
    how.effects = std::move(effects), how.profile = std::move(profile);
    how.priors = std::move(priors), how.moving_average = moving_average;
    how.watch = std::move(watch);
    return on_rig(tune(logs, params, rig, how), rig);
  });
}

Checked checked_of(const TunedOnRig& self, const Log& log, const std::string& model, bool track, bool correct,
                   std::vector<double> last, int threads, py::object progress) {
  Call call(std::move(progress));
  return call.run([&, how_many = threads_here(threads)](Watch watch) {
    const CheckOptions how{.model = model,
                           .threads = how_many,
                           .track = track,
                           .correct = correct,
                           .last = std::move(last),
                           .watch = std::move(watch)};
    return check(log, self.tuned, self.rig, how);
  });
}

std::vector<PlanFault> faults_of(const py::object& faults) {
  std::vector<PlanFault> out;
  if (py::isinstance<py::dict>(faults))
    for (const auto& [name, severity] : py::cast<py::dict>(faults))
      out.push_back({py::cast<std::string>(name), py::cast<double>(severity)});
  else
    for (const py::handle name : faults) out.push_back({.name = py::cast<std::string>(name)});
  return out;
}

PlannedTest plan_of(const TunedOnRig& self, const py::object& faults, const py::object& between,
                    std::vector<std::string> rows, double seconds, double rate, double max_current,
                    std::optional<double> max_stroke, std::optional<double> max_speed,
                    std::optional<double> max_pressure, std::optional<double> loop_gain, int rounds,
                    const std::optional<Baseline>& baseline, const std::optional<Log>& like, std::uint64_t seed,
                    int threads, py::object progress) {
  PlanOptions how;
  how.faults = faults_of(faults), how.between = faults_of(between), how.rows = std::move(rows);
  how.seconds = seconds, how.rate = rate, how.loop_gain = loop_gain, how.rounds = rounds;
  how.limits = {max_current, max_stroke, max_speed, max_pressure};
  how.seed = seed, how.threads = threads_here(threads);
  Call call(std::move(progress));
  return call.run([&](Watch watch) {
    how.watch = std::move(watch);
    return plan_test(self.tuned, self.rig, how, baseline ? &*baseline : nullptr, like ? &*like : nullptr);
  });
}

py::list convergence_of(const TunedOnRig& t) {
  py::list out;
  for (const TuneChart::Point& p : t.chart.convergence) {
    py::dict row;
    row["stage"] = p.stage, row["simulations"] = p.simulations, row["cost"] = p.cost;
    out.append(row);
  }
  return out;
}

void define_calls(py::class_<TunedOnRig>& tuned) {
  const auto seed = py::arg("seed") = 1;
  const auto threads = py::arg("threads") = 0;
  const auto progress = py::arg("progress") = true;
  tuned
      .def(
          "baseline", &baseline_of, py::arg("logs"), py::arg("false_alarm") = BaselineOptions{}.false_alarm, seed,
          threads, progress, py::kw_only(), py::arg("others") = std::vector<Log>(),
          "Threshold from fault-free logs that did not tune the table; three or more. others: fault-free logs of other "
          "tests, those that tuned the table as well, as the program takes them unless told.")
      .def("_diagnose", &verdict_of, py::arg("logs"), py::arg("baseline"), py::arg("actions"),
           py::arg("explain_unknown"), seed, threads, progress)
      .def("explain", &explanation_of, py::arg("logs"), py::arg("baseline") = py::none(),
           py::arg("level") = ExplainOptions{}.level, py::arg("without") = std::vector<std::string>(), seed, threads,
           progress, py::kw_only(), py::arg("keep_worse") = false,
           "What the simulation gets wrong on logs of one valve in one state. keep_worse: the table is extended even "
           "where it follows held-out data worse.")
      .def("check", &checked_of, py::arg("log"), py::kw_only(), py::arg("model") = CheckOptions{}.model,
           py::arg("track") = true, py::arg("correct") = true, py::arg("last") = std::vector<double>(), threads,
           progress, "The prognostic checks of one log; History.record keeps them.")
      .def("plan", &plan_of, py::kw_only(), py::arg("faults") = py::tuple(), py::arg("between") = py::tuple(),
           py::arg("rows") = std::vector<std::string>(), py::arg("seconds") = PlanOptions{}.seconds,
           py::arg("rate") = PlanOptions{}.rate, py::arg("max_current") = PlanLimits{}.current,
           py::arg("max_stroke") = py::none(), py::arg("max_speed") = py::none(), py::arg("max_pressure") = py::none(),
           py::arg("loop_gain") = py::none(), py::arg("rounds") = PlanOptions{}.rounds,
           py::arg("baseline") = py::none(), py::arg("like") = py::none(), seed, threads, progress,
           "The excitation that is most informative. faults: names, or name -> severity; seconds [s]; rate [Hz]; "
           "max_current "
           "[1 of rated current]; max_stroke [m]; max_speed [m/s]; max_pressure [Pa]; loop_gain [A/m].");
}

}  // namespace

py::list records_of(const std::vector<ParameterResult>& parameters) {
  py::list out;
  for (const ParameterResult& p : parameters) {
    py::dict row;
    row["id"] = p.id, row["name"] = p.name, row["nominal"] = p.nominal, row["estimate"] = p.estimate;
    row["std_error"] = p.std_error, row["unit"] = p.unit, row["verdict"] = words[static_cast<int>(p.verdict)];
    row["confounded_with"] = p.confounded_with;
    row["profile_lower"] = p.profile_lower, row["profile_upper"] = p.profile_upper;
    out.append(row);
  }
  return out;
}

py::list records_of(const std::vector<ChannelResult>& channels) {
  py::list out;
  for (const ChannelResult& c : channels) {
    py::dict row;
    row["signal"] = std::string(name_of(c.signal)), row["rms"] = c.rms, row["noise_rms"] = c.noise_rms;
    row["heldout_rms"] = c.heldout_rms;
    out.append(row);
  }
  return out;
}

void define_tuned(py::module_& m) {
  py::class_<TunedOnRig> tuned(m, "Tuned", "A tuned table and the rig that it speaks of.");
  tuned
      .def_static(
          "load", [](const Path& path, const Rig& rig) { return on_rig(read_tuned(path.string()), rig); },
          py::arg("path"), py::arg("rig") = Rig{}, "A tuned table's file. Raises InputError for one that is not tuned.")
      .def(
          "save", [](const TunedOnRig& t, const Path& path) { write_tuned(path.string(), t.tuned); }, py::arg("path"),
          "The program's own file, byte for byte.")
      .def_property_readonly("table", [](const TunedOnRig& t) { return t.tuned.table; })
      .def_property_readonly("rig", [](const TunedOnRig& t) { return t.rig; })
      .def_property_readonly("notes", [](const TunedOnRig& t) { return t.tuned.notes; })
      .def_property_readonly("interrupted", [](const TunedOnRig& t) { return t.tuned.interrupted; })
      .def_property_readonly("simulations", [](const TunedOnRig& t) { return t.tuned.simulations; })
      .def_property_readonly("failed_simulations", [](const TunedOnRig& t) { return t.tuned.failed_simulations; })
      .def_property_readonly(
          "starts", [](const TunedOnRig& t) { return array_of(t.chart.starts); },
          "(starts,) costs at which the local searches ended; empty of a table that was read")
      .def_property_readonly("_parameters", [](const TunedOnRig& t) { return records_of(t.tuned.parameters); })
      .def_property_readonly("_channels", [](const TunedOnRig& t) { return records_of(t.tuned.channels); })
      .def_property_readonly("_convergence", &convergence_of)
      .def("__repr__", [](const TunedOnRig& t) { return "<Tuned " + t.tuned.table.sha256.substr(0, 12) + ">"; })
      .def(pickled<TunedOnRig>());
  define_calls(tuned);
  m.def(
      "tune", &tuned_on, py::arg("logs"), py::kw_only(), py::arg("params"), py::arg("rig") = Rig{}, py::arg("seed") = 1,
      py::arg("threads") = 0, py::arg("generations") = TuneOptions{}.generations,
      py::arg("rounds") = TuneOptions{}.rounds, py::arg("population") = TuneOptions{}.population,
      py::arg("heldout") = TuneOptions{}.heldout, py::arg("effects") = py::none(),
      py::arg("profile") = std::vector<std::string>(), py::arg("priors") = std::map<std::string, double>(),
      py::arg("moving_average") = TuneOptions{}.moving_average, py::arg("checkpoint") = py::none(),
      py::arg("resume") = false, py::arg("progress") = true,
      "Nominal parameters from fault-free logs, pooled. profile: rows whose interval is checked, or ['all']. priors: "
      "row -> [its unit] standard deviation about the table's value. moving_average: [samples] odd. "
      "checkpoint: file that keeps what is finished; resume: go on from it, to the same bits. What ends the call early "
      "(KeyboardInterrupt, what progress raises) carries the best so far as its attribute `best`.");
}

}  // namespace servodx::python
