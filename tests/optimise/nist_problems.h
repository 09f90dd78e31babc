// Nonlinear regression problems of the NIST Statistical Reference Datasets, with certified values (11 digits, computed
// in 128-bit arithmetic). Source: https://www.itl.nist.gov/div898/strd/nls/nls_main.shtml, files Misra1a.dat,
// Misra1d.dat, Rat42.dat (Ratkowsky2), MGH09.dat, MGH10.dat, MGH17.dat, BoxBOD.dat, Thurber.dat. Start 1 is the far
// one. The boxes are ours: they hold both starts and the answer.
#pragma once
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "optimise/box_least_squares.h"
#include "optimise/unit_cube.h"

namespace servodx::test {

struct NistProblem {
  std::string name;
  std::vector<double> x, y;
  std::function<double(double x, const std::vector<double>& b)> model;
  std::vector<double> start1, start2;
  std::vector<double> certified;
  double certified_sum_of_squares;
  std::vector<double> lower, upper;
};

inline std::vector<NistProblem> nist_problems() {
  const std::vector<double> misra_x{77.6,  114.9, 141.1, 190.8, 239.9, 289.0, 332.8,
                                    378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0};
  const std::vector<double> misra_y{10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02,
                                    44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78};
  std::vector<double> mgh17_x;
  for (int i = 0; i < 33; ++i) mgh17_x.push_back(10.0 * i);
  return {
      {"Misra1a",
       misra_x,
       misra_y,
       [](double x, const std::vector<double>& b) { return b[0] * (1 - std::exp(-b[1] * x)); },
       {500, 0.0001},
       {250, 0.0005},
       {2.3894212918E+02, 5.5015643181E-04},
       1.2455138894E-01,
       {1, 1e-5},
       {1000, 0.01}},
      {"Misra1d",
       misra_x,
       misra_y,
       [](double x, const std::vector<double>& b) { return b[0] * b[1] * x / (1 + b[1] * x); },
       {500, 0.0001},
       {450, 0.0003},
       {4.3736970754E+02, 3.0227324449E-04},
       5.6419295283E-02,
       {1, 1e-5},
       {1000, 0.01}},
      {"Rat42",
       {9, 14, 21, 28, 42, 57, 63, 70, 79},
       {8.930, 10.800, 18.590, 22.330, 39.350, 56.110, 61.730, 64.620, 67.080},
       [](double x, const std::vector<double>& b) { return b[0] / (1 + std::exp(b[1] - b[2] * x)); },
       {100, 1, 0.1},
       {75, 2.5, 0.07},
       {7.2462237576E+01, 2.6180768402E+00, 6.7359200066E-02},
       8.0565229338E+00,
       {1, 0, 0},
       {200, 10, 1}},
      {"MGH09",
       {4, 2, 1, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625},
       {0.1957, 0.1947, 0.1735, 0.1600, 0.0844, 0.0627, 0.0456, 0.0342, 0.0323, 0.0235, 0.0246},
       [](double x, const std::vector<double>& b) { return b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3]); },
       {25, 39, 41.5, 39},
       {0.25, 0.39, 0.415, 0.39},
       {1.9280693458E-01, 1.9128232873E-01, 1.2305650693E-01, 1.3606233068E-01},
       3.0750560385E-04,
       {0, 0, 0, 0},
       {50, 50, 50, 50}},
      {"MGH10",
       {50, 55, 60, 65, 70, 75, 80, 85, 90, 95, 100, 105, 110, 115, 120, 125},
       {34780, 28610, 23650, 19630, 16370, 13720, 11540, 9744, 8261, 7030, 6005, 5147, 4427, 3820, 3307, 2872},
       [](double x, const std::vector<double>& b) { return b[0] * std::exp(b[1] / (x + b[2])); },
       {2, 400000, 25000},
       {0.02, 4000, 250},
       {5.6096364710E-03, 6.1813463463E+03, 3.4522363462E+02},
       8.7945855171E+01,
       {0, 0, 1},
       {3, 500000, 30000}},
      {"MGH17",
       mgh17_x,
       {0.844, 0.908, 0.932, 0.936, 0.925, 0.908, 0.881, 0.850, 0.818, 0.784, 0.751,
        0.718, 0.685, 0.658, 0.628, 0.603, 0.580, 0.558, 0.538, 0.522, 0.506, 0.490,
        0.478, 0.467, 0.457, 0.448, 0.438, 0.431, 0.424, 0.420, 0.414, 0.411, 0.406},
       [](double x, const std::vector<double>& b) {
         return b[0] + b[1] * std::exp(-b[3] * x) + b[2] * std::exp(-b[4] * x);
       },
       {50, 150, -100, 1, 2},
       {0.5, 1.5, -1, 0.01, 0.02},
       {3.7541005211E-01, 1.9358469127E+00, -1.4646871366E+00, 1.2867534640E-02, 2.2122699662E-02},
       5.4648946975E-05,
       {-100, -200, -200, 0, 0},
       {100, 200, 200, 3, 3}},
      {"BoxBOD",
       {1, 2, 3, 5, 7, 10},
       {109, 149, 149, 191, 213, 224},
       [](double x, const std::vector<double>& b) { return b[0] * (1 - std::exp(-b[1] * x)); },
       {1, 1},
       {100, 0.75},
       {2.1380940889E+02, 5.4723748542E-01},
       1.1680088766E+03,
       {0, 0},
       {500, 5}},
      {"Thurber",
       {-3.067, -2.981, -2.921, -2.912, -2.840, -2.797, -2.702, -2.699, -2.633, -2.481, -2.363, -2.322, -1.501,
        -1.460, -1.274, -1.212, -1.100, -1.046, -0.915, -0.714, -0.566, -0.545, -0.400, -0.309, -0.109, -0.103,
        0.010,  0.119,  0.377,  0.790,  0.963,  1.006,  1.115,  1.572,  1.841,  2.047,  2.200},
       {80.574,   84.248,   87.264,   87.195,   89.076,   89.608,   89.868,   90.101,   92.405,   95.854,
        100.696,  101.060,  401.672,  390.724,  567.534,  635.316,  733.054,  759.087,  894.206,  990.785,
        1090.109, 1080.914, 1122.643, 1178.351, 1260.531, 1273.514, 1288.339, 1327.543, 1353.863, 1414.509,
        1425.208, 1421.384, 1442.962, 1464.350, 1468.705, 1447.894, 1457.628},
       [](double x, const std::vector<double>& b) {
         return (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) / (1 + x * (b[4] + x * (b[5] + x * b[6])));
       },
       {1000, 1000, 400, 40, 0.7, 0.3, 0.03},
       {1300, 1500, 500, 75, 1, 0.4, 0.05},
       {1.2881396800E+03, 1.4910792535E+03, 5.8323836877E+02, 7.5416644291E+01, 9.6629502864E-01, 3.9797285797E-01,
        4.9727297349E-02},
       5.6427082397E+03,
       {0, 0, 0, 0, 0, 0, 0},
       {3000, 3000, 1500, 200, 2, 1, 0.2}},
  };
}

inline Point to_cube(const NistProblem& nist, const std::vector<double>& b) {
  Point point(b.size());
  for (std::size_t j = 0; j < b.size(); ++j) point[j] = (b[j] - nist.lower[j]) / (nist.upper[j] - nist.lower[j]);
  return point;
}

inline std::vector<double> from_cube(const NistProblem& nist, const Point& point) {
  std::vector<double> b(point.size());
  for (std::size_t j = 0; j < b.size(); ++j) b[j] = nist.lower[j] + point[j] * (nist.upper[j] - nist.lower[j]);
  return b;
}

inline LeastSquaresProblem least_squares(const NistProblem& nist) {
  LeastSquaresProblem problem;
  problem.n = static_cast<int>(nist.certified.size());
  problem.evaluate = [&nist](std::span<const Point> points) {
    std::vector<Evaluation> values(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const std::vector<double> b = from_cube(nist, points[k]);
      values[k].residual.resize(static_cast<Eigen::Index>(nist.x.size()));
      for (std::size_t i = 0; i < nist.x.size(); ++i)
        values[k].residual[static_cast<Eigen::Index>(i)] = nist.model(nist.x[i], b) - nist.y[i];
    }
    return values;
  };
  return problem;
}

}  // namespace servodx::test
