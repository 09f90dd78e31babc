// Robust losses as a change of each residual: rho(e) = 0.5*t(e)^2, so that Gauss-Newton on t(e) has the exact gradient
// of the robust cost and a Hessian that stays positive semidefinite. For small e every t(e) is e. `scale`, a below, is
// the residual size (in noise standard deviations once whitened) from which a row begins to count less.
// - soft_l1: t^2 = 2a^2 (sqrt(1 + (e/a)^2) - 1). Grows like |e|: for stray samples.
// - cauchy: t^2 = a^2 log(1 + (e/a)^2). Grows like log|e|: for gross outliers; makes false minima far from the data.
// - compressed: t = e / sqrt(1 + |e|/a), a = 3. For the first pass: keeps a bad start's large residuals from ruling.
//
// Source: Triggs et al., Bundle adjustment (2000), sec. 4.3, and Ceres loss_function.h for the first two.
#pragma once
#include <cmath>

namespace servodx {

enum class RobustLoss { none, soft_l1, cauchy, compressed };

struct LossValue {
  double t;   // the changed residual
  double dt;  // dt/de
};

inline LossValue robust(RobustLoss loss, double scale, double e) {
  if (loss == RobustLoss::none) return {e, 1.0};
  const double u = e / scale, size = std::abs(u);
  if (loss == RobustLoss::compressed) {
    const double root = std::sqrt(1.0 + size);
    return {e / root, (1.0 + 0.5 * size) / (root * root * root)};
  }
  if (size < 1e-6) return {e, 1.0};
  if (loss == RobustLoss::soft_l1) {
    const double root = std::sqrt(1.0 + u * u);
    const double t = std::copysign(std::abs(e) * std::sqrt(2.0 / (root + 1.0)), e);  // 2(root-1) = 2u^2/(root+1)
    return {t, e / (root * t)};
  }
  const double t = std::copysign(scale * std::sqrt(std::log1p(u * u)), e);
  return {t, e / ((1.0 + u * u) * t)};
}

// t^2 alone.
inline double robust_square(RobustLoss loss, double scale, double e) {
  if (loss == RobustLoss::compressed) return e * e / (1.0 + std::abs(e) / scale);
  const double t = robust(loss, scale, e).t;
  return t * t;
}

}  // namespace servodx
