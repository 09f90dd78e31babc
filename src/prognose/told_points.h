// The points of a check as the growth model is told them: single checks far from their neighbours weigh little,
// readings at the end of their scale say "at most", and long histories are averaged in blocks.
//
// Limits: two outlying checks side by side are taken at their word; a block's own curve is straight.
#pragma once
#include <vector>

#include "prognose/growth.h"

namespace servodx {

std::vector<GrowthPoint> told_points(std::vector<GrowthPoint> points, const GrowthPrior& prior);
std::vector<GrowthPoint> thinned(const std::vector<GrowthPoint>& points);

}  // namespace servodx
