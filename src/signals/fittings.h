// Fittings of a line between valve and actuator, each by its loss coefficient K: a drop of K times the dynamic pressure
// of the flow in the line's bore.
//
// Source: Munson, Young & Okiishi, Fundamentals of Fluid Mechanics, table 8.2 (threaded pipe fittings), and its
// figs. 8.22 and 8.25 for entrance and exit. Turbulent flow, fittings more than some bores apart; in laminar flow of
// cold oil they lose more. A maker's own figure goes into the rig file with its source.
#pragma once
#include <array>
#include <string_view>

namespace servodx {

struct Fitting {
  std::string_view name;
  double loss;  // K
};

inline constexpr std::array<Fitting, 9> known_fittings = {{{"entrance", 0.5},  // of sharp edges, out of a manifold
                                                           {"exit", 1.0},      // into a chamber
                                                           {"elbow_90", 1.5},
                                                           {"elbow_90_long", 0.7},
                                                           {"elbow_45", 0.4},
                                                           {"bend_180", 1.5},
                                                           {"tee_straight", 0.9},
                                                           {"tee_branch", 2.0},
                                                           {"union", 0.08}}};

}  // namespace servodx
