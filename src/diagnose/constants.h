// Numbers that decide a verdict. Each says what it is for and what halving and doubling it does.
#pragma once
#include <cstddef>

namespace servodx::diagnose_constants {

// The score (diagnose/score.cpp).
inline constexpr double adequacy_spread = 0.3;
inline constexpr double gross_score = 1e3;

// The verdict (diagnose/decide.cpp).
inline constexpr double fault_allowance = 2.0;
inline constexpr double unexplained_part = 0.25;
inline constexpr double ambiguous_probability = 0.05;
inline constexpr double effect_error = 0.1;

// The gross look (diagnose/gross.cpp).
inline constexpr double near_stop = 0.95;
inline constexpr double small_current = 0.5;
inline constexpr long both_stops_one_in = 50;
inline constexpr long one_stop_one_in = 4;
inline constexpr double least_asked = 0.05;
inline constexpr double no_response = 0.02;

// The onset (diagnose/onset.cpp).
inline constexpr std::size_t shortest_part = 200;
inline constexpr std::size_t shortest_one_in = 10;
inline constexpr std::size_t beginning_one_in = 4;
inline constexpr double variance_step = 4.0;
inline constexpr double change_gain = 30.0;
inline constexpr double onset_gain = 25.0;
inline constexpr double gain_before_part = 0.1;

// The hypotheses (diagnose/hypotheses.cpp and what it calls).
inline constexpr double inside_prior = 0.25;
inline constexpr double end_prior = 0.5;
inline constexpr int severity_grid = 6;
inline constexpr int starts_kept = 2;
inline constexpr int first_iterations = 5;
inline constexpr int iterations = 20;
inline constexpr double worth_another_start = 4.0;
inline constexpr double difference_step = 1e-3;
inline constexpr double cost_tolerance = 1e-4;
inline constexpr double on_bound = 1e-6;
inline constexpr double at_least_part = 1e-3;
inline constexpr double deviates_of_95 = 1.96;

}  // namespace servodx::diagnose_constants
