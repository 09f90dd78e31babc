#include "fit/chart.h"

namespace servodx {

Point Chart::start() const {
  Point x;
  for (const FreeValue& f : free_) x.push_back(f.to_unit(f.start));
  return x;
}

ParameterVector Chart::candidate(const Point& x, int log) const {
  ParameterVector v;
  candidate(x, log, v);
  return v;
}

void Chart::candidate(const Point& x, int log, ParameterVector& v) const {
  v = base_;
  for (std::size_t j = 0; j < free_.size(); ++j)
    if ((free_[j].log < 0 || free_[j].log == log) && !free_[j].apply) v[free_[j].at] = free_[j].from_unit(x[j]);
  for (std::size_t j = 0; j < free_.size(); ++j)
    if ((free_[j].log < 0 || free_[j].log == log) && free_[j].apply) free_[j].apply(v.data(), free_[j].from_unit(x[j]));
}

}  // namespace servodx
