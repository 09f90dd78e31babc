// Baseline: its state is its file, and what of the call that made it no file keeps.
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "define.h"
#include "fields.h"
#include "state.h"

namespace servodx::python {
namespace {

// A file of a name that nobody else has, gone with its end.
class Passing {
 public:
  Passing() {
    const py::tuple made = py::module_::import("tempfile").attr("mkstemp")(".json");
    py::module_::import("os").attr("close")(made[0]);
    path = py::cast<std::string>(made[1]);
  }
  ~Passing() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
  std::string path;
};

py::tuple state_of_baseline(const Baseline& baseline) {
  const Passing file;
  write_baseline(file.path, baseline);
  std::stringstream text;
  text << std::ifstream(file.path, std::ios::binary).rdbuf();
  return py::make_tuple(baseline.path, py::bytes(text.str()), state_of(baseline.notes), baseline.simulations,
                        baseline.failed_simulations, baseline.interrupted, baseline.rig_file);
}

Baseline baseline_of_state(const py::tuple& state) {
  if (state.size() != 7) throw py::value_error("pickled by another version of servodx: make it again");
  const Passing file;
  std::ofstream(file.path, std::ios::binary) << py::cast<std::string>(state[1]);
  Baseline out = read_baseline(file.path);
  out.path = py::cast<std::string>(state[0]);
  take_state(out.notes, state[2]);
  out.simulations = py::cast<long>(state[3]), out.failed_simulations = py::cast<long>(state[4]);
  out.interrupted = py::cast<bool>(state[5]);
  out.rig_file = py::cast<std::string>(state[6]);  // of one made in memory none, though its file names the rig's
  return out;
}

py::list scores_of(const Baseline& baseline) {
  py::list out;
  for (const Baseline::Score& s : baseline.scores) {
    py::dict row;
    row["log"] = s.log, row["score"] = s.score, row["adequacy"] = s.adequacy;
    for (const auto& [fault, gain] : s.gains) row[py::str(fault)] = gain;
    out.append(row);
  }
  return out;
}

}  // namespace

void define_baseline(py::module_& m) {
  py::class_<Baseline>(m, "Baseline", "What fault-free logs score, and the threshold that promises a false-alarm rate.")
      .def_static(
          "load", [](const Path& path) { return read_baseline(path.string()); }, py::arg("path"))
      .def(
          "save", [](const Baseline& b, const Path& path) { write_baseline(path.string(), b); }, py::arg("path"),
          "The program's own file, byte for byte.")
      .def_readonly("threshold", &Baseline::threshold, "of a score [deviates]")
      .def_readonly("asked", &Baseline::asked, "false-alarm rate")
      .def_readonly("promised", &Baseline::promised, "false-alarm rate")
      .def_readonly("promised_95", &Baseline::promised_95, "false-alarm rate, at 95 % confidence")
      .def_readonly("logs", &Baseline::logs, "that set the threshold")
      .def_readonly("logs_needed", &Baseline::logs_needed, "for the rate asked for")
      .def_readonly("tuned_sha256", &Baseline::tuned_sha256)
      .def_readonly("path", &Baseline::path, "of its file; empty where it was made in memory")
      .def_readonly("sha256", &Baseline::sha256, "of what its file holds, or would hold")
      .def_readonly("rig_file", &Baseline::rig_file, "that it was made with, as its file says; empty: none")
      .def_readonly("notes", &Baseline::notes)
      .def_readonly("simulations", &Baseline::simulations)
      .def_readonly("failed_simulations", &Baseline::failed_simulations)
      .def_readonly("interrupted", &Baseline::interrupted, "fewer logs than were given")
      .def_property_readonly("_scores", &scores_of)
      .def("__repr__", [](const Baseline& b) { return "<Baseline of " + std::to_string(b.logs) + " logs>"; })
      .def(py::pickle(&state_of_baseline, &baseline_of_state));
}

}  // namespace servodx::python
