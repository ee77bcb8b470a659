#include "solver/stepping/highest_frequency_search.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

namespace frontalis
{
namespace
{

// The eigenvalue has settled after at least `fewest_rows` if the last two rows raised it by less than `tolerance`.
constexpr std::size_t fewest_rows = 8;
constexpr double tolerance = 0.01;
// The iteration ends where a vector's image lies along itself and the vector before, but for rounding.
constexpr double smallest_remainder = 1e-6;

// Independent sums, so that loops over nodes need not wait for each addition and can be vectorised.
constexpr int lanes = 8;

template <class Real>
double sum_of(const Real (&lane)[lanes])
{
  double sum = 0;
  for (const Real x : lane)
    sum += double(x);
  return sum;
}

// Calls visit(node, lane) for the nodes [first, end).
template <class Visit>
void in_lanes(std::int32_t first, std::int32_t end, const Visit& visit)
{
  std::int32_t n = first;
  for (; n + lanes <= end; n += lanes)
    for (int lane = 0; lane < lanes; ++lane)
      visit(n + lane, lane);
  for (; n < end; ++n)
    visit(n, 0);
}

}  // namespace

// The largest eigenvalue is found by bisection: a number is above all eigenvalues if all pivots of the matrix minus
// this number are negative.
void LanczosMatrix::add_row(double diagonal, double beside)
{
  diagonal_.push_back(diagonal);
  beside_.push_back(beside);
  largest_.push_back(std::numeric_limits<double>::quiet_NaN());
  double low = 0, high = 0;
  for (std::size_t i = 0; i < rows(); ++i)
  {
    if (!std::isfinite(diagonal_[i]) || !std::isfinite(beside_[i]))
      return;
    low = std::max(low, diagonal_[i]);
    high = std::max(high, diagonal_[i] + (i > 0 ? beside_[i - 1] : 0) + (i + 1 < rows() ? beside_[i] : 0));
  }
  const auto is_above = [this](double number)
  {
    double pivot = diagonal_[0] - number;
    for (std::size_t i = 1; pivot < 0 && i < rows(); ++i)
      pivot = diagonal_[i] - number - beside_[i - 1] * beside_[i - 1] / pivot;
    return pivot < 0;
  };
  while (high - low > 1e-6 * high)
    (is_above(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
  largest_.back() = high;
}

double LanczosMatrix::largest_eigenvalue() const
{
  return largest_.empty() ? std::numeric_limits<double>::quiet_NaN() : largest_.back();
}

std::vector<LanczosMatrix::Eigenpair> LanczosMatrix::eigenpairs_above(double number) const
{
  std::vector<Eigenpair> pairs;
  if (!std::isfinite(largest_eigenvalue()))
    return pairs;
  const auto size = static_cast<Eigen::Index>(rows());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(diagonal_.data(), size),
                                Eigen::Map<const Eigen::VectorXd>(beside_.data(), size - 1));
  for (Eigen::Index i = size; i-- > 0 && solver.eigenvalues()[i] > number;)
  {
    const Eigen::VectorXd vector = solver.eigenvectors().col(i);
    pairs.push_back({ solver.eigenvalues()[i], { vector.data(), vector.data() + size } });
  }
  return pairs;
}

bool LanczosMatrix::settled() const
{
  if (largest_.empty())
    return false;
  const double found = largest_.back();
  if (!std::isfinite(found) || beside_.back() < smallest_remainder * found)
    return true;
  return rows() >= fewest_rows && found - largest_[rows() - 3] < tolerance * found;
}

std::vector<std::array<double, 3>> random_mode(std::size_t nodes)
{
  std::vector<std::array<double, 3>> mode(nodes);
  std::mt19937 random(1);
  for (auto& p : mode)
    for (double& x : p)
      x = static_cast<double>(random()) / 2147483648.0 - 1;
  return mode;
}

double mode_amplitude(const Model& model, int iteration)
{
  const double amplitude = 1e-3 * *std::min_element(model.spacing.begin(), model.spacing.end());
  return iteration % 2 == 0 ? amplitude : -amplitude;
}

std::vector<double> roots_for_search(const Discretisation& discretisation)
{
  std::vector<double> mass = discretisation.node_mass, root;
  for (const auto& node : discretisation.followers)
    mass[node.master] += node.ratio * node.ratio * mass[node.node];
  root.reserve(mass.size());
  for (const double m : mass)
    root.push_back(1 / std::sqrt(m));
  for (const auto& node : discretisation.followers)
    root[node.node] = 0;
  for (const auto n : discretisation.held)
    root[n] = 0;
  return root;
}

template <class Real>
HighestFrequencySearch<Real>::HighestFrequencySearch(const Model& model, const Discretisation& discretisation,
                                                     std::vector<std::int32_t> first_node, std::size_t entries)
    : model_(model),
      first_node_(std::move(first_node)),
      followers_(discretisation.followers),
      added_(model, discretisation, roots_for_search(discretisation)),
      size_(first_node_.size() - 1),
      along_(size_.size()),
      keeps_vectors_(model.mass_scaling.in_motion > 0)
{
  vectors_.reserve(most_lanczos_iterations);
  root_.resize(model.nodes.size());
  masses_changed(discretisation);
  std::stable_sort(followers_.begin(), followers_.end(),
                   [](const auto& a, const auto& b) { return a.master < b.master; });
  for (auto* vector : { &start_, &moved_, &present_ })
    for (auto& component : *vector)
      component.assign(entries, 0);
  const auto mode = random_mode(root_.size());
  for (std::size_t n = 0; n < root_.size(); ++n)
    for (std::size_t axis = 0; axis < 3 && root_[n] > 0; ++axis)
      start_[axis][n] = static_cast<Real>(mode[n][axis]);
}

template <class Real>
void HighestFrequencySearch<Real>::list_arrays(ArrayList& list) const
{
  const std::string what = "search for the highest frequency";
  for (const auto* vector : { &start_, &moved_, &present_ })
    for (const auto& component : *vector)
      list.add(what, component);
  list.add(what, root_);
  list.add(what, followers_);
  list.add(what, size_);
  list.add(what, along_);
  for (const auto& vector : vectors_)
    for (const auto& component : vector)
      list.add(what, component);
  added_.list_arrays(what, list);
}

template <class Real>
void HighestFrequencySearch<Real>::masses_changed(const Discretisation& discretisation)
{
  const std::vector<double> root = roots_for_search(discretisation);
  std::copy(root.begin(), root.end(), root_.begin());
  added_.masses_changed(root);
}

template <class Real>
std::vector<FoundMode> HighestFrequencySearch<Real>::modes_above(double frequency_squared)
{
  constexpr std::size_t block = 512;  // of nodes, so that their sums stay in the cache
  std::vector<FoundMode> modes;
  for (const LanczosMatrix::Eigenpair& pair : matrix_.eigenpairs_above(frequency_squared))
  {
    FoundMode& mode = modes.emplace_back(FoundMode{ pair.value, {} });
    for (std::size_t first = 0; first < root_.size(); first += block)
    {
      const std::size_t count = std::min(block, root_.size() - first);
      Real share[block] = {};
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        Real sum[block] = {};
        for (std::size_t i = 0; i < pair.vector.size(); ++i)
        {
          const auto component = static_cast<Real>(pair.vector[i] / lengths_[i]);
          const Real* const along = vector(static_cast<int>(i))[axis].data() + first;
          for (std::size_t n = 0; n < count; ++n)
            sum[n] += component * along[n];
        }
        for (std::size_t n = 0; n < count; ++n)
          share[n] += sum[n] * sum[n];
      }
      for (std::size_t n = 0; n < count; ++n)
        if (share[n] > Real(least_mode_share))
          mode.shares.push_back({ static_cast<std::int32_t>(first + n), static_cast<float>(share[n]) });
    }
  }
  return modes;
}

template <class Real>
typename HighestFrequencySearch<Real>::Size HighestFrequencySearch<Real>::total_size() const
{
  Size total;
  for (const Size& part : size_)
    total = { total.squared_length + part.squared_length, std::max(total.largest, part.largest) };
  return total;
}

template <class Real>
std::size_t HighestFrequencySearch<Real>::part_of(std::int32_t node) const
{
  return std::lower_bound(first_node_.begin(), first_node_.end(), node) - first_node_.begin();
}

// Finds the displacements with `scale` times those of the vector `now` added to u.
template <class Real>
void HighestFrequencySearch<Real>::displace(const Nodes& nodes, const Components& u, Real scale, const Components& now)
{
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    for (auto n = nodes.first; n < nodes.end; ++n)
      moved_[axis][n] = u[axis][n] + scale * root_[n] * now[axis][n];
    for (const auto& node : followers_)
      if (node.node >= nodes.first && node.node < nodes.end)
        moved_[axis][node.node] += static_cast<Real>(node.ratio) * scale * root_[node.master] * now[axis][node.master];
  }
}

// Finds an image, less `back` times the vector `before`. `factor`: from forces to the image.
template <class Real>
void HighestFrequencySearch<Real>::find_image(const Nodes& nodes, const Components& forces, Real factor, Real back,
                                              const Components& before, Components& after) const
{
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (auto n = nodes.first; n < nodes.end; ++n)
      after[axis][n] = factor * root_[n] * (forces[axis][n] - present_[axis][n]) - back * before[axis][n];
}

// Adds the forces on followers to the image at their masters.
template <class Real>
void HighestFrequencySearch<Real>::add_followers(const Nodes& nodes, const Components& forces, Real factor,
                                                 Components& image) const
{
  auto node = std::lower_bound(followers_.begin(), followers_.end(), nodes.first,
                               [](const auto& follower, std::int32_t first) { return follower.master < first; });
  for (; node != followers_.end() && node->master < nodes.end; ++node)
    for (std::size_t axis = 0; axis < 3; ++axis)
      image[axis][node->master] += factor * root_[node->master] * static_cast<Real>(node->ratio) *
                                   (forces[axis][node->node] - present_[axis][node->node]);
}

template <class Real>
double HighestFrequencySearch<Real>::product(const Nodes& nodes, const Components& a, const Components& b) const
{
  Real sum[lanes] = {};
  for (std::size_t axis = 0; axis < 3; ++axis)
    in_lanes(nodes.first, nodes.end,
             [&, x = a[axis].data(), y = b[axis].data()](std::int32_t n, int lane) { sum[lane] += x[n] * y[n]; });
  return sum_of(sum);
}

// Subtracts `share` of the vector `now` from another one, and finds the length and the largest displacement of the
// result.
template <class Real>
void HighestFrequencySearch<Real>::subtract(const Nodes& nodes, Real share, const Components& now, Components& from,
                                            Size& size) const
{
  Real sum[lanes] = {}, most[lanes] = {};
  for (std::size_t axis = 0; axis < 3; ++axis)
    in_lanes(nodes.first, nodes.end,
             [&, x = from[axis].data(), y = now[axis].data(), root = root_.data()](std::int32_t n, int lane)
             {
               x[n] -= share * y[n];
               sum[lane] += x[n] * x[n];
               const Real displacement = std::abs(x[n]) * root[n];
               most[lane] = displacement > most[lane] ? displacement : most[lane];
             });
  size = { sum_of(sum), double(*std::max_element(most, most + lanes)) };
}

template <class Real>
double HighestFrequencySearch<Real>::run(std::int32_t first, std::int32_t end, const Components& u,
                                         const Forces& forces)
{
  const Nodes own{ first, end };
  const std::size_t first_part = part_of(first), end_part = part_of(end);
  // A thread without nodes may begin at the first part, too.
  const bool leads = first_part == 0 && end_part > 0;
  forces.find(u);
  for (std::size_t axis = 0; axis < 3; ++axis)
    std::copy(forces.found[axis].begin() + own.first, forces.found[axis].begin() + own.end,
              present_[axis].begin() + own.first);
  for (auto part = first_part; part < end_part; ++part)
    subtract(nodes(part), 0, start_, start_, size_[part]);
  if (leads)
    make_room(1);
  forces.barrier();
  Size of_now = total_size();
  LanczosMatrix matrix;
  std::vector<double> lengths;
  for (int iteration = 0; iteration < most_lanczos_iterations && !matrix.settled() && of_now.largest > 0; ++iteration)
  {
    const Components &now = vector(iteration), &before = vector(std::max(iteration - 1, 0));
    Components& after = vector(iteration + 1);
    const double length = std::sqrt(of_now.squared_length), scale = mode_amplitude(model_, iteration) / of_now.largest;
    const auto factor = static_cast<Real>(1 / (scale * length));
    const auto back = static_cast<Real>(iteration == 0 ? 0 : length / lengths.back());
    displace(own, u, static_cast<Real>(scale), now);
    forces.barrier();
    forces.find(moved_);
    if (!followers_.empty())
      forces.barrier();
    for (auto part = first_part; part < end_part; ++part)
    {
      const Nodes at = nodes(part);
      find_image(at, forces.found, factor, back, before, after);
      add_followers(at, forces.found, factor, after);
      added_.add_product(at.first, at.end, static_cast<Real>(1 / length), now, after);
      along_[part] = product(at, after, now);
    }
    forces.barrier();
    const double along = std::accumulate(along_.begin(), along_.end(), 0.0);
    for (auto part = first_part; part < end_part; ++part)
      subtract(nodes(part), static_cast<Real>(along / of_now.squared_length), now, after, size_[part]);
    if (leads)
      make_room(iteration + 2);
    forces.barrier();
    of_now = total_size();
    matrix.add_row(along / length, std::sqrt(of_now.squared_length));
    lengths.push_back(length);
  }
  if (leads && keeps_vectors_)
  {
    matrix_ = matrix;
    lengths_ = lengths;
  }
  return matrix.largest_eigenvalue();
}

// The last iteration makes a vector, too.
template <class Real>
void HighestFrequencySearch<Real>::make_room(int iteration)
{
  const auto wanted = static_cast<std::size_t>(keeps_vectors_ ? std::min(iteration, most_lanczos_iterations) : 2);
  while (vectors_.size() < wanted)
    vectors_.push_back(start_);
}

template class HighestFrequencySearch<float>;
template class HighestFrequencySearch<double>;

}  // namespace frontalis
