// Local least squares on the unit cube: minimise the sum of rho(e_i(x)) over 0 <= x <= 1, rho(e) = 0.5*e^2 or a robust
// loss.
//
// Levenberg-Marquardt with true bounds: each step solves the damped quadratic *on the box* (box_quadratic.h: walls
// held, re-solved on the free set), with Marquardt's diagonal and a little of the unit matrix as the damping metric and
// no coordinate moving further than `step_limit`. A step computed as if free and then clipped stops descending; that,
// and a metric that lets a weak parameter run away, is what fails in a servovalve fit. Every evaluation is a batch: the
// n points of the Jacobian, and a ladder of dampings tried at once, since lanes of a pack are nearly free.
//
// Limits: dense, n up to a few hundred, any number of rows (J, one block of it and the residuals of one ladder are
// held). The residual must be smooth on the scale of `difference_step`. Finds one local minimum; genetic.h gives
// the breadth. Why not Ceres' minimiser: decisions in box_least_squares.cpp.
//
// Between two sets of differences the Jacobian learns from the steps that keep their promise (Broyden 1965); what ends
// a search is always differences.
//
// Source: More (1978), The Levenberg-Marquardt algorithm; Nocedal and Wright (2006), ch. 10 and 16; Transtrum and
// Sethna (2012), Improvements to the Levenberg-Marquardt algorithm (bending a step by the curvature it meets).
#pragma once
#include <functional>
#include <vector>

#include "optimise/normal_equations.h"
#include "optimise/robust_loss.h"
#include "optimise/search_stop.h"
#include "optimise/unit_cube.h"

namespace servodx {

// J(i, j) = d residual_i / d x_j at a point whose residual is known. False: could not be had here; differences are
// taken instead.
using JacobianFunction = std::function<bool(const Point&, const Eigen::VectorXd& residual, Eigen::MatrixXd& jacobian)>;

struct LeastSquaresProblem {
  int n = 0;
  BatchEvaluate evaluate;     // priors: append rows (x - mean)/sd
  JacobianFunction jacobian;  // optional
};

enum class Difference {
  forward,              // n points; its error moves the minimum by about difference_step times the curvature
  central,              // 2n points
  forward_then_central  // forward until it converges or stalls, then central: the end Jacobian is the better one
};

struct LeastSquaresProgress {
  int iteration = 0;
  long evaluations = 0;
  double cost = 0;                // with the loss of the pass that runs
  double projected_gradient = 0;  // see LeastSquaresResult
  const Point* point = nullptr;
};

struct LeastSquaresOptions {
  int max_iterations = 100;       // Jacobians taken, all passes together
  long max_evaluations = 0;       // 0: no limit. Checked once an iteration, so it may be passed by one batch
  double step_limit = 0.3;        // of the box, in one iteration
  double difference_step = 1e-5;  // of the box
  Difference difference = Difference::forward_then_central;
  int damping_trials = 8;  // dampings tried at once
  // Steps taken on one set of differences while each keeps its promise: the Jacobian then learns from the step itself
  // (Broyden 1965). 0: differences after every step.
  int secant_steps = 3;
  // So does a Jacobian that the problem gives: where it costs many evaluations.
  bool given_learns = false;
  // Damping in every direction beside Marquardt's diagonal, as a part of the strongest column's: `from_afar` for starts
  // that no one chose, where it saves a fifth of the evaluations; 0 about a start that is known to be near.
  double least_metric = 0;
  static constexpr double from_afar = 1e-3;
  double first_damping = 1e-1;    // middle of the first ladder, relative to the Marquardt diagonal
  double cost_tolerance = 1e-8;   // converged when the model promises less than this part of the cost; no trial that
                                  // promises less is run
  double cost_floor = 1e-20;      // converged when the cost itself, or the promised gain, is below this
  double step_tolerance = 1e-12;  // of the box; trials shorter than this are a stall
  // Give up (stalled) after this many iterations that together lower the cost by less than a tenth: a start that leads
  // nowhere costs more than the next one. 0: never.
  int slow_iterations = 0;
  double cost_goal = -1;  // stop as soon as the plain misfit 0.5*|e|^2 is at or below this; negative: off
  RobustLoss loss = RobustLoss::none;
  double loss_scale = 1.0;
  bool compressed_first_pass = false;  // first minimise with RobustLoss::compressed to 1e-3, then with `loss`
  std::function<bool(const LeastSquaresProgress&)> progress;  // false asks to stop; the best so far is returned

  void validate() const;  // throws InputError with the option's name
};

enum class StopReason { converged, goal, stalled, iteration_limit, evaluation_limit, interrupted, start_failed };

struct LeastSquaresResult {
  Point point;
  double start_cost = 0;  // of the start
  double cost = 0;        // sum of rho(e_i); infinite when the start failed
  double misfit = 0;      // 0.5*|residual|^2 without the loss
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;  // d residual / d x at `point`, without the loss; a column that could not be had is zero
  Eigen::MatrixXd normal;    // J'J at `point`, rows as the loss changes them
  Eigen::VectorXd gradient;  // of the cost
  double projected_gradient = 0;  // largest |gradient_j| that a wall does not hold, cost per unit of the box
  double gradient_cosine = 0;     // the same over |J_j||e|: scale-free, 0 at a minimum
  double promised_gain = 0;       // cost that the undamped model still promises inside the box and the step limit
  std::vector<int> wall;          // -1 at 0, +1 at 1, 0 free; a wall counts only while the gradient pushes into it
  long evaluations = 0;           // every point asked for, Jacobian points included
  long failed_evaluations = 0;
  bool central = false;     // differences of the Jacobian
  int missing_columns = 0;  // Jacobian columns at the end for which both sides failed
  int iterations = 0;
  StopReason reason = StopReason::start_failed;
  SearchStop stop;  // the reason, closer, with the figures that matter
};

LeastSquaresResult minimise_least_squares(const LeastSquaresProblem& problem, const Point& start,
                                          const LeastSquaresOptions& options = {});

// A search's end without its rows. They are a function of the point, as what ends a search is always fresh derivatives;
// but for a search that was interrupted or has a `cost_goal`.
struct SearchEnd {
  Point point;
  double start_cost = 0, promised_gain = 0;
  bool central = false;
  long evaluations = 0, failed_evaluations = 0;
  int iterations = 0;
  StopReason reason = StopReason::start_failed;
  SearchStop stop;
};
SearchEnd without_rows(const LeastSquaresResult& end);
// The same bits as the search with these options came to, for one evaluation and one Jacobian.
LeastSquaresResult with_rows(const SearchEnd& end, const LeastSquaresProblem& problem,
                             const LeastSquaresOptions& options);

// Cost, gradient, walls and promise of an end whose point, residual and Jacobian have moved.
void take_stock(LeastSquaresResult& end, NormalEquations equations, const LeastSquaresOptions& options);

// As a search that stops for this reason usually does; without the figures where it stopped.
SearchStop stop_of(StopReason reason, const LeastSquaresOptions& options);
SearchStop::Figures figures_of(const LeastSquaresResult& end);

}  // namespace servodx
