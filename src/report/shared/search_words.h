// How a local search stopped, in words.
#pragma once
#include <string>

#include "optimise/ceres_refinement.h"
#include "optimise/search_stop.h"

namespace servodx::report {

std::string word_of(CeresEnd end);  // as results write it
// "iteration limit of 100; cost 312, gradient cosine 1e-05, promised gain 0.002"
std::string words_of(const SearchStop& stop);

}  // namespace servodx::report
