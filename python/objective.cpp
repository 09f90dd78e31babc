// Objective: the misfit of the model to logs, for optimisers of your own. servodx/objective.py has its Python side.
#include "servodx/objective.h"

#include "define.h"
#include "watch.h"

namespace servodx::python {
namespace {

std::span<const double> span_of(const Array& values) {
  return {values.data(), static_cast<std::size_t>(values.size())};
}

py::array_t<double> residuals_of(const Objective& objective, const Array& points) {
  std::vector<double> out;
  {
    const py::gil_scoped_release free;
    out = objective.residuals(span_of(points));
  }
  const auto rows = static_cast<py::ssize_t>(objective.size());
  if (points.ndim() < 2) return py::array_t<double>(rows, out.data());
  return py::array_t<double>({static_cast<py::ssize_t>(out.size()) / std::max<py::ssize_t>(rows, 1), rows}, out.data());
}

py::object costs_of(const Objective& objective, const Array& points) {
  std::vector<double> out;
  {
    const py::gil_scoped_release free;
    out = objective.costs(span_of(points));
  }
  if (points.ndim() < 2) return py::float_(out.at(0));
  return array_of(out);
}

py::tuple jacobian_of(const Objective& objective, const Array& point) {
  Objective::Jacobian out;
  {
    const py::gil_scoped_release free;
    out = objective.jacobian(span_of(point));
  }
  if (out.values.empty()) throw std::runtime_error("the simulation left the finite numbers at this point");
  const std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(objective.size()),
                                          static_cast<py::ssize_t>(objective.numbers().size())};
  return py::make_tuple(py::array_t<double>(shape, out.values.data()), out.missing);
}

Objective::End end_of(const Objective& objective, Objective::Method method, const Array& start, int iterations,
                      int population, int generations, std::uint64_t seed, py::object progress) {
  Call call(std::move(progress));
  return call.run([&](Watch watch) {
    return objective.minimise(method, span_of(start),
                              {.iterations = iterations,
                               .population = population,
                               .generations = generations,
                               .seed = seed,
                               .watch = std::move(watch)});
  });
}

py::list numbers_of(const Objective& objective) {
  py::list out;
  for (const Objective::Number& n : objective.numbers()) {
    py::dict row;
    row["name"] = n.name, row["unit"] = n.unit, row["lower"] = n.lower, row["upper"] = n.upper;
    row["log_scale"] = n.log_scale, row["start"] = n.start, row["prior_sd"] = n.prior_sd, row["log"] = n.log;
    out.append(row);
  }
  return out;
}

py::list parts_of(const Objective& objective) {
  py::list out;
  for (const Objective::Part& p : objective.parts()) {
    py::dict row;
    row["log"] = p.log, row["signal"] = std::string(name_of(p.signal)), row["first"] = p.first, row["count"] = p.count;
    out.append(row);
  }
  return out;
}

}  // namespace

void define_objective(py::module_& m) {
  using O = Objective;
  py::class_<O> objective(m, "_Objective");
  py::enum_<O::Method>(objective, "Method")
      .value("least_squares", O::Method::least_squares)
      .value("ceres", O::Method::ceres)
      .value("nlopt", O::Method::nlopt)
      .value("whole", O::Method::whole);
  py::class_<O::End>(m, "ObjectiveEnd", "Where one of our searches ended.")
      .def_property_readonly(
          "x", [](const O::End& e) { return array_of(e.point); }, "(n,) point of the unit cube")
      .def_readonly("cost", &O::End::cost, "half of the sum of squares")
      .def_readonly("simulations", &O::End::simulations, "that it took")
      .def_readonly("message", &O::End::stopped, "why it ended")
      .def("__repr__", [](const O::End& e) { return "<ObjectiveEnd, cost " + std::to_string(e.cost) + ">"; });
  objective
      .def(py::init([](const std::vector<Log>& logs, const Table& table, const Rig& rig,
                       std::optional<std::vector<std::string>> effects, int threads) {
             const ObjectiveOptions how{.effects = std::move(effects), .threads = threads_here(threads)};
             const py::gil_scoped_release free;
             return Objective(logs, table, rig, how);
           }),
           py::arg("logs"), py::arg("table"), py::arg("rig"), py::arg("effects"), py::arg("threads"))
      .def_property_readonly("size", &O::size)
      .def_property_readonly("start", [](const O& o) { return array_of(o.start()); })
      .def("point_of", [](const O& o, const Table& table) { return array_of(o.point_of(table)); })
      .def("values_at", [](const O& o, const Array& point) { return array_of(o.values_at(span_of(point))); })
      .def("point_at", [](const O& o, const Array& values) { return array_of(o.point_at(span_of(values))); })
      .def("residuals", &residuals_of)
      .def("costs", &costs_of)
      .def("jacobian", &jacobian_of)
      .def("minimise", &end_of)
      .def_property_readonly("simulations", &O::simulations)
      .def_property_readonly("failed_simulations", &O::failed_simulations)
      .def_property_readonly("numbers", &numbers_of)
      .def_property_readonly("parts", &parts_of);
}

}  // namespace servodx::python
