// What no named effect explains: a learnt curve at a place of the model (effects/unexplained.h), each pair of place and
// variable that physics makes likely a cause of its own; and a short closed form for a curve that was found.
#pragma once
#include <string>
#include <vector>

#include "explain/valve.h"
#include "optimise/unit_cube.h"

namespace servodx {

struct Curve {
  int place = 0, variable = 0, factor = 0;  // codes of effects/unexplained.h
  double scale = 1;                         // [SI of the variable]
  int cause = -1;                           // position among the subject's causes
};
// Adds the curves as causes; scales are the variables' rms on the logs.
std::vector<Curve> add_curves(ValveSubject& subject);

// Where the log shows what drives and moves a block, what it misses there, sample by sample, gives the curves of its
// place a first guess, however far from a straight line the simulation's answer to them is. `point`: of fit({}).
void guess_curves(ValveSubject& subject, const std::vector<Curve>& curves, const Point& point);

struct CurvePoint {
  double x = 0, value = 0, std_error = 0;  // [SI]
};
struct LearntCurve {
  std::string where, variable, variable_unit, factor, unit;
  std::vector<CurvePoint> points;  // at the knots
  // "-1.2e+03 N per m/s times x": the form with fewest numbers that passes the knots within their errors; empty: none.
  std::string closed_form;
  std::string depends_on() const { return variable + (factor.empty() ? "" : " by " + factor); }
};
LearntCurve learnt(const Curve& curve, const std::vector<double>& knots, const std::vector<double>& std_error);

}  // namespace servodx
