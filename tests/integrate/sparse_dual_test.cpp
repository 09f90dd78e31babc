#include "base/sparse_dual.h"

#include <gtest/gtest.h>

#include "base/smooth.h"

namespace servodx {
namespace {

// f of three variables, given as one generic lambda: as duals (of variables 0, 2 and 3) and as numbers.
template <class F>
void derivative_equals_differences(F f, double a, double b, double c) {
  const auto r = f(seed<0>(a, 1.0), seed<2>(b, 1.0), seed<3>(c, 1.0));
  using R = std::remove_cvref_t<decltype(r)>;
  EXPECT_EQ(r.v, f(a, b, c)) << "the value must be the plain scalar's";
  constexpr double h = 1e-5;
  const std::array<double, 3> differences = {(f(a + h, b, c) - f(a - h, b, c)) / (2 * h),
                                             (f(a, b + h, c) - f(a, b - h, c)) / (2 * h),
                                             (f(a, b, c + h) - f(a, b, c - h)) / (2 * h)};
  const auto check = [&]<Mask M>(const Dual<double, M>& d) {
    const std::array<int, 3> variables = {0, 2, 3};
    for (int k = 0; k < 3; ++k) {
      const int at = variables[k];
      const double stated = holds(M, at) ? d.d[slot(M, at)] : 0.0;
      EXPECT_NEAR(stated, differences[k], 1e-8 * (1 + std::abs(differences[k]))) << "variable " << at;
    }
    EXPECT_FALSE(holds(M, 1)) << "a variable that is not in the expression";
  };
  check(static_cast<const R&>(r));
}

#define LAW(name, expression)                                                         \
  TEST(SparseDual, name) {                                                            \
    const auto f = []([[maybe_unused]] const auto& a, [[maybe_unused]] const auto& b, \
                      [[maybe_unused]] const auto& c) {                               \
      using std::sqrt;                                                                \
      return expression;                                                              \
    };                                                                                \
    derivative_equals_differences(f, 0.7, -1.3, 2.1);                                 \
    derivative_equals_differences(f, 1.9, 0.4, 0.6);                                  \
  }

LAW(SumOfDualsOfDifferentVariables, a + b)
LAW(SumOfDualsThatShareVariables, (a + b) + (b + c))
LAW(DifferenceOfDualsOfDifferentVariables, a - b)
LAW(DifferenceOfDualsThatShareVariables, (a - b) - (c - b))
LAW(ProductOfDuals, (a * b) * (b * c))
LAW(QuotientOfDuals, (a * c) / (b + c * c))
LAW(Negation, -(a* b))
LAW(SumWithANumber, (a * b + 1.5) + (2.5 + a * c))
LAW(DifferenceWithANumber, (a * b - 1.5) - (2.5 - a * c))
LAW(ProductWithANumber, (a * b * 1.5) * (2.5 * c))
LAW(QuotientWithANumber, (a * b / 1.5) * (2.5 / (c * c)))
LAW(SquareRoot, sqrt(a* a + c))
LAW(SmoothPrimitives, smooth_abs(a, 0.1) + soft_positive(b, 0.2) * smooth_sign(c, 0.3) + dead_zone(a * b, 0.5, 0.1) +
                          saturate(b * c, 0.6, 0.2) + signed_sqrt_behind(0.4, b, 0.1) +
                          signed_sqrt_behind(a * a, c, 0.1))
LAW(FlatStep, flat_step(a) + flat_step(b * 0.4) * flat_step(c * 0.1))
#undef LAW

TEST(SparseDual, ExpressionCarriesTheUnionOfItsVariables) {
  const auto r = seed<1>(2.0, 1.0) * seed<4>(3.0, 1.0) + seed<1>(1.0, 1.0);
  static_assert(std::is_same_v<decltype(r), const Dual<double, only(1) | only(4)>>);
  EXPECT_EQ(r.d[0], 4.0);
  EXPECT_EQ(r.d[1], 2.0);
}

}  // namespace
}  // namespace servodx
