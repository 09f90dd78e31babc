// The shortest formula that runs through the knots of a learnt curve, each within its error.
//
// Forms of one or two terms: straight, sign, square and cube, through the origin or not. A form serves where what it
// misses is no more than errors of this size do in 95 of 100 cases (chi-square).
#pragma once
#include <string>
#include <vector>

namespace servodx {

struct Knot {
  double x = 0, y = 0, weight = 0;  // 1 / standard error of y
};

// "3.1 N per m/s x + 12 N sign(x)"; empty where none serves. Needs two knots more than the form has terms.
std::string closed_form(const std::vector<Knot>& knots, const std::string& unit, const std::string& variable_unit);

}  // namespace servodx
