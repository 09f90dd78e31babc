#include "ratios/peers.h"

#include "base/random.h"

#ifdef SERVODX_HAVE_NLOPT
#include <nlopt.hpp>
#endif
#ifdef SERVODX_HAVE_PAGMO
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/de1220.hpp>
#include <pagmo/algorithms/sade.hpp>
#include <pagmo/algorithms/sga.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#endif

namespace servodx::bench {
namespace {

constexpr unsigned ever = 100000;  // generations: the cost ends the run

#ifdef SERVODX_HAVE_PAGMO
struct Objective {
  int n = 1;
  const std::function<double(const Point&)>* cost = nullptr;
  pagmo::vector_double fitness(const pagmo::vector_double& x) const { return {(*cost)(x)}; }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(n, 0.0), pagmo::vector_double(n, 1.0)};
  }
};
template <class Make>
Peer pagmo_peer(const char* name, unsigned population, Make make) {
  return {std::string("pagmo2 ") + name, [=](int n, const std::function<double(const Point&)>& cost, unsigned seed) {
            pagmo::population people{pagmo::problem{Objective{n, &cost}}, population, seed};
            pagmo::algorithm{make(seed)}.evolve(people);
          }};
}
#endif
#ifdef SERVODX_HAVE_NLOPT
Peer nlopt_peer(const char* name, nlopt::algorithm algorithm) {
  return {std::string("NLopt ") + name, [=](int n, const std::function<double(const Point&)>& cost, unsigned seed) {
            nlopt::srand(seed);
            nlopt::opt search(algorithm, static_cast<unsigned>(n));
            search.set_lower_bounds(0.0);
            search.set_upper_bounds(1.0);
            search.set_min_objective(
                [](const std::vector<double>& x, std::vector<double>&, void* data) {
                  return (*static_cast<const std::function<double(const Point&)>*>(data))(x);
                },
                const_cast<void*>(static_cast<const void*>(&cost)));
            Random random(seed, 9);
            // A local method that ends early starts again elsewhere.
            for (;;) {
              Point x;
              for (int j = 0; j < n; ++j) x.push_back(random.uniform());
              double least = 0;
              search.set_maxeval(algorithm == nlopt::LN_BOBYQA ? 2000 : static_cast<int>(ever));
              search.set_ftol_rel(1e-6);
              try {
                search.optimize(x, least);
              } catch (const nlopt::roundoff_limited&) {
              }
            }
          }};
}
#endif

}  // namespace

const std::vector<Peer>& peers() {
  static const std::vector<Peer> all = {
#ifdef SERVODX_HAVE_PAGMO
      pagmo_peer("sga", 50,
                 [](unsigned s) {
                   return pagmo::sga(ever, 0.9, 1.0, 0.02, 1.0, 2u, "exponential", "polynomial", "tournament", s);
                 }),
      pagmo_peer("sade", 50, [](unsigned s) { return pagmo::sade(ever, 2u, 1u, 0, 0, false, s); }),
      pagmo_peer("de1220", 50,
                 [](unsigned s) {
                   return pagmo::de1220(ever, {2u, 3u, 7u, 10u, 13u, 14u, 15u, 16u}, 1u, 0, 0, false, s);
                 }),
      pagmo_peer("cmaes", 20, [](unsigned s) { return pagmo::cmaes(ever, -1, -1, -1, -1, 0.3, 0, 0, false, true, s); }),
#endif
#ifdef SERVODX_HAVE_NLOPT
      nlopt_peer("CRS2", nlopt::GN_CRS2_LM),
      nlopt_peer("ISRES", nlopt::GN_ISRES),
      nlopt_peer("ESCH", nlopt::GN_ESCH),
      nlopt_peer("BOBYQA", nlopt::LN_BOBYQA),
#endif
  };
  return all;
}

std::vector<std::string> missing_peers() {
  std::vector<std::string> out;
#ifndef SERVODX_HAVE_PAGMO
  out.push_back("pagmo2 is not installed (libpagmo-dev)");
#endif
#ifndef SERVODX_HAVE_NLOPT
  out.push_back("NLopt is not installed (libnlopt-cxx-dev)");
#endif
  return out;
}

}  // namespace servodx::bench
