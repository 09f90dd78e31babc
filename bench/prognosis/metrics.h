// How good a life prediction was, once the end is known. Definitions after Saxena, Celaya, Saha, Saha & Goebel 2010
// ("Metrics for offline evaluation of prognostic performance") and Coble & Hines 2009 (the three of a feature's shape);
// CRPS after Gneiting & Raftery 2007, by its sample form.
#pragma once
#include <vector>

#include "prognose/growth.h"
#include "prognose/life.h"

namespace servodx {

struct Prediction {
  double at = 0;  // [h] when it was made
  Life life;      // [h] from then
};

// The median lies within (1 +- alpha) of the true remaining life.
bool alpha_lambda(const Life& life, double remaining, double alpha);
// Part of the distribution within these bounds.
double mass_within(const Life& life, double remaining, double alpha);
double relative_accuracy(const Life& life, double remaining);  // 1 - |error| / remaining; at most 1
double cumulative_relative_accuracy(const std::vector<Prediction>& predictions, double end);
// [h] before the end from which on every median stays within alpha times the whole life; 0: never.
double prognostic_horizon(const std::vector<Prediction>& predictions, double end, double alpha);
// [h] from the first prediction to the centre of the area under the error curve: the sooner, the faster it converges.
double convergence(const std::vector<Prediction>& predictions, double end);
// [h] lives beyond `horizon` count as `horizon`, so that "never" has a price.
double crps(const Life& life, double remaining, double horizon);
bool covers(const Life& life, double remaining, double coverage);  // the central interval

// Of a feature over the lives of several units.
double monotonicity(const std::vector<double>& feature);                  // 0 .. 1: |rises - falls| / steps
double trendability(const std::vector<std::vector<double>>& features);    // 0 .. 1: least correlation between two units
double prognosability(const std::vector<std::vector<double>>& features);  // 0 .. 1: exp(-spread of the ends over range)

}  // namespace servodx
