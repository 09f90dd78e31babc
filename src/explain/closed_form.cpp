#include "explain/closed_form.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>

#include "base/normal.h"

namespace servodx {
namespace {

struct Form {
  std::vector<double (*)(double)> terms;
  std::vector<std::string> words;  // of each term, behind its number
};

// Shortest first.
std::vector<Form> forms(const std::string& unit, const std::string& variable_unit) {
  const auto line = [](double v) { return v; };
  const auto sign = [](double v) { return v > 0 ? 1.0 : v < 0 ? -1.0 : 0.0; };
  const auto square = [](double v) { return v * std::abs(v); };
  const auto cube = [](double v) { return v * v * v; };
  const auto one = [](double) { return 1.0; };
  const std::string plain = " " + unit, per = plain + " per " + variable_unit;
  return {
      {{line}, {per + " x"}},
      {{sign}, {plain + " sign(x)"}},
      {{square}, {plain + "/(" + variable_unit + ")2 x|x|"}},
      {{cube}, {plain + "/(" + variable_unit + ")3 x3"}},
      {{one, line}, {plain, per + " x"}},
      {{sign, line}, {plain + " sign(x)", per + " x"}},
      {{line, cube}, {per + " x", plain + "/(" + variable_unit + ")3 x3"}},
  };
}

// 95 % of chi-square with f degrees of freedom, Wilson and Hilferty's cube root.
double limit_of(double f) { return f * std::pow(1 - 2 / (9 * f) + normal_95_one_sided * std::sqrt(2 / (9 * f)), 3); }

}  // namespace

std::string closed_form(const std::vector<Knot>& knots, const std::string& unit, const std::string& variable_unit) {
  for (const Form& form : forms(unit, variable_unit)) {
    const auto n = static_cast<long>(knots.size()), m = static_cast<long>(form.terms.size());
    if (n < m + 2) break;
    Eigen::MatrixXd a(n, m);
    Eigen::VectorXd b(n);
    for (long i = 0; i < n; ++i) {
      const Knot& knot = knots[static_cast<std::size_t>(i)];
      b[i] = knot.weight * knot.y;
      for (long j = 0; j < m; ++j) a(i, j) = knot.weight * form.terms[static_cast<std::size_t>(j)](knot.x);
    }
    const Eigen::VectorXd c = a.colPivHouseholderQr().solve(b);
    if ((a * c - b).squaredNorm() > limit_of(static_cast<double>(n - m))) continue;
    std::string text;
    for (long j = 0; j < m; ++j)
      text += fmt::format("{}{:.3g}{}", j ? " + " : "", c[j], form.words[static_cast<std::size_t>(j)]);
    return text;
  }
  return "";
}

}  // namespace servodx
