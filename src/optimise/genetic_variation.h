// How one child is made from an island. Five variations, shared out by how often each has won lately (never below a
// floor):
// - 0, crossover: simulated binary crossover with a tournament winner, by coordinate, then polynomial mutation
// - 1, turned crossover: the same along the principal axes of the population, for valleys that lie across the axes
// - 2, difference: parent + F (one of the best - parent + a - b), mixed into the parent by coordinate at a learnt rate
// - 3, turned difference: the same along the principal axes
// - 4, ensemble: a draw about the centre of the better half, spread as all members are (rotation needs no axes)
//
// Each child competes with the parent whose slot it was made for, which keeps diversity; points outside the box are
// reflected into it.
// Sources: Deb and Agrawal (1995), SBX; Deb and Goyal (1996), polynomial mutation; Tanabe and Fukunaga (2013),
// success-history memory; Guo and Yang (2015), eigenvector crossover; Akimoto et al. (2009), REX.
#pragma once
#include <Eigen/Dense>

#include "base/random.h"
#include "optimise/genetic_state.h"
#include "optimise/unit_cube.h"

namespace servodx {

struct Child {
  int parent = 0;  // slot
  int variation = 0;
  double reach = 0, mixing = 0;  // of a difference; remembered if it wins
};

// An island as the variations see it. Looking again, a generation later, asks for no memory but a vector that Eigen
// takes to turn the axes.
struct Brood {
  const Island* island = nullptr;
  std::vector<int> by_cost;  // slots, best first
  Eigen::MatrixXd points;    // columns: the population
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> principal;
  Eigen::VectorXd centre;  // weighted, of the better half
  Eigen::VectorXd mean;    // of all
  std::array<double, kVariations> share{};
  int tournament = 2;
  Eigen::MatrixXd spread, square;  // work space, as is all that follows
  Eigen::VectorXd child, move, along;

  void look_at(const Island& one, int tournament_size);
  const Eigen::MatrixXd& axes() const { return principal.eigenvectors(); }  // columns: principal, of the population
};

Child make_child(Brood& brood, int slot, Random& random, Point& point);

double reflect(double x);  // folds any finite number into [0, 1]

}  // namespace servodx
