#include "integrate/sparse_lu.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"
#include "base/sparse_dual.h"

namespace servodx {
namespace {

constexpr int n = 11;

// Neighbours, corners and a full row and column in the middle: elimination fills in.
constexpr Pattern<n> arrow() {
  Pattern<n> p;
  for (int i = 0; i < n; ++i) {
    p.row[i] |= only(i);
    p.row[i] |= only((i + 1) % n);
    p.row[(i + 2) % n] |= only(i);
    if (i % 3 == 0) {
      p.row[i] |= only(5);
      p.row[5] |= only(i);
    }
  }
  return p;
}
constexpr Pattern<n> bidiagonal() {
  Pattern<n> p;
  for (int i = 0; i < n; ++i) {
    p.row[i] |= only(i);
    if (i > 0) p.row[i] |= only(i - 1);
  }
  return p;
}
constexpr Pattern<n> diagonal_only() { return {}; }

using Dense = std::vector<std::vector<double>>;

// Gauss with row exchange; knows nothing of the pattern.
std::vector<double> dense_solve(Dense a, std::vector<double> b) {
  const std::size_t m = b.size();
  for (std::size_t k = 0; k < m; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < m; ++i)
      if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < m; ++i) {
      const double r = a[i][k] / a[k][k];
      for (std::size_t j = k; j < m; ++j) a[i][j] -= r * a[k][j];
      b[i] -= r * b[k];
    }
  }
  for (std::size_t k = m; k-- > 0;) {
    for (std::size_t j = k + 1; j < m; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

template <Pattern<n> P>
void equals_dense_solve() {
  using Lu = SparseLu<n, P>;
  for (unsigned trial = 0; trial < 50; ++trial) {
    Random random(7, trial);
    Dense a(n, std::vector<double>(n, 0.0));
    std::array<double, Lu::entries> w{};
    std::array<double, n> x{};
    std::vector<double> b(n);
    for (int i = 0; i < n; ++i) {
      double row_sum = 0;
      for (int j = 0; j < n; ++j)
        if (i != j && holds(P.row[i], j)) row_sum += std::abs(a[i][j] = random.uniform(-1.0, 1.0));
      a[i][i] = (random.uniform() < 0.5 ? -1 : 1) * (row_sum + random.uniform(0.1, 1.0));  // no pivoting is needed
      x[i] = b[i] = random.uniform(-1.0, 1.0);
    }
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        if (Lu::plan.slot[i][j] >= 0) w[Lu::plan.slot[i][j]] = a[i][j];
    Lu::template factorise<double>(w);
    Lu::template solve<double>(w, x);
    const std::vector<double> expected = dense_solve(a, b);
    double largest = 0;
    for (double v : expected) largest = std::max(largest, std::abs(v));
    for (int i = 0; i < n; ++i) EXPECT_NEAR(x[i], expected[i], 1e-12 * largest) << trial << ' ' << i;
  }
}

template <Pattern<n> P>
int entries_of_pattern() {
  int entries = 0;
  for (int i = 0; i < n; ++i) entries += count(P.row[i] | only(i));
  return entries;
}

TEST(SparseLu, EqualsDenseSolveWithFillIn) {
  EXPECT_GT((SparseLu<n, arrow()>::entries), entries_of_pattern<arrow()>());
  equals_dense_solve<arrow()>();
}

TEST(SparseLu, EqualsDenseSolveOfATriangle) { equals_dense_solve<bidiagonal()>(); }
TEST(SparseLu, EqualsDenseSolveOfADiagonal) { equals_dense_solve<diagonal_only()>(); }

TEST(SparseLu, TriangleNeedsNoFillIn) {
  EXPECT_EQ((SparseLu<n, bidiagonal()>::entries), entries_of_pattern<bidiagonal()>());
}

TEST(SparseLu, OrderOfEliminationHoldsEveryVariableOnce) {
  Mask seen{};
  for (int v : SparseLu<n, arrow()>::plan.order) seen |= only(v);
  EXPECT_EQ(seen, range(0, n));
}

}  // namespace
}  // namespace servodx
