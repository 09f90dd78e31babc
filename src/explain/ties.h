// What is likely of a cause's numbers before any data, as rows of its fit: each row a weighted sum of how far they are
// from off, zero give or take one. A learnt curve goes on in a straight line by these where no sample holds it; a shape
// that tuning has found stays within its error.
#pragma once
#include <vector>

#include "explain/subject.h"

namespace servodx {

// Appends the ties of these causes to the rows of a fit whose last numbers are theirs.
void tie(SubjectFit& fit, const std::vector<Cause>& all, const std::vector<int>& causes);

}  // namespace servodx
