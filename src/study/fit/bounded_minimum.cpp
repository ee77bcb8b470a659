#include "study/fit/bounded_minimum.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <vector>

namespace frontalis
{
namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double relative_tolerance = 1e-12;  // relative size of gradients that count as zero

// The minimum over the free variables, with the other variables fixed.
VectorXd minimum_of_free(const MatrixXd& h, const VectorXd& g, const VectorXd& x, const std::vector<Index>& free)
{
  VectorXd held = x;
  held(free).setZero();
  const VectorXd right = VectorXd(g - h * held)(free);
  VectorXd out = x;
  out(free) = h(free, free).eval().ldlt().solve(right).eval();
  return out;
}

}  // namespace

VectorXd bounded_minimum(const MatrixXd& h, const VectorXd& g, const VectorXd& lower, const VectorXd& upper, VectorXd x)
{
  const Index count = g.size();
  x = x.cwiseMax(lower).cwiseMin(upper);
  std::vector<Index> free;
  for (Index i = 0; i < count; ++i)
    if (lower[i] < x[i] && x[i] < upper[i])
      free.push_back(i);
  const double zero = relative_tolerance * std::max(g.cwiseAbs().maxCoeff(), h.diagonal().maxCoeff());
  // Each round frees one variable or ends the search. The limit ends the search if rounding errors make a variable
  // alternate between two states.
  for (Index round = 0; round < 10 * count; ++round)
  {
    while (!free.empty())
    {
      const VectorXd best = minimum_of_free(h, g, x, free);
      // Move towards `best` until the first variable reaches its limit, and hold this variable there.
      double share = 1;
      Index first = -1;
      for (const Index i : free)
      {
        const double limit = best[i] < lower[i] ? lower[i] : best[i] > upper[i] ? upper[i] : best[i];
        if (limit == best[i])
          continue;
        if (const double reached = (limit - x[i]) / (best[i] - x[i]); reached < share)
        {
          share = reached;
          first = i;
        }
      }
      x += share * (best - x);
      if (first < 0)
        break;
      x[first] = best[first] < lower[first] ? lower[first] : upper[first];
      free.erase(std::find(free.begin(), free.end(), first));
    }
    // Free the held variable that gains most by leaving its limit.
    const VectorXd descent = g - h * x;
    double most = zero;
    Index next = -1;
    for (Index i = 0; i < count; ++i)
    {
      const double gain = lower[i] == upper[i] ? 0 : x[i] <= lower[i] ? descent[i] : x[i] >= upper[i] ? -descent[i] : 0;
      if (gain > most && std::find(free.begin(), free.end(), i) == free.end())
      {
        most = gain;
        next = i;
      }
    }
    if (next < 0)
      break;
    free.push_back(next);
  }
  return x;
}

}  // namespace frontalis
