// Optimisers of pagmo2 and NLopt on the same objectives, whichever of the two was there when this was built.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "optimise/unit_cube.h"

namespace servodx::bench {

struct Peer {
  std::string name;
  // Minimises over the unit cube from a seed; `cost` throws to end it.
  std::function<void(int n, const std::function<double(const Point&)>& cost, unsigned seed)> run;
};

const std::vector<Peer>& peers();
std::vector<std::string> missing_peers();  // with the reason

}  // namespace servodx::bench
