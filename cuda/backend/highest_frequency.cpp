#include "cuda/backend/highest_frequency.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace frontalis
{
namespace cuda
{
namespace
{

// The host waits for the iterations of a search after series of these lengths. Most searches take 9 to 15 iterations.
constexpr int first_series = 10, further_series = 4;

// Copies the entries [begin, end) of an array to the same places.
template <class T>
void download_part(const DeviceArray<T>& from, std::size_t begin, std::size_t end, std::vector<T>& to)
{
  to.resize(from.size());
  require(cudaMemcpy(to.data() + begin, from.data() + begin, (end - begin) * sizeof(T), cudaMemcpyDeviceToHost),
          "copying sums of a search");
}

}  // namespace

void CudaSolver::SearchDeleter::operator()(FrequencySearch* search) const { delete search; }

/// Allocates the memory of the search, and writes its random start and the sums of that.
void CudaSolver::prepare_search()
{
  search_.reset(new FrequencySearch(device_.nodes()));
  NodalVectors random = random_mode(model_->nodes.size());
  const std::vector<double> root = roots_for_search(discretisation_);
  std::vector<float4> values(device_.nodes(), float4{ 0, 0, 0, 0 });
  std::vector<double2> size(lanczos_blocks, double2{ 0, 0 });
  for (std::size_t n = 0; n < random.size(); ++n)
  {
    if (root[n] == 0)
      random[n] = {};
    const auto& x = random[n];
    values[device_.device_node()[n]] = { static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2]),
                                         0 };
    for (const double c : x)
      size[0] = { size[0].x + c * c, std::max(size[0].y, std::abs(c) * root[n]) };
  }
  search_->start.upload(values.data(), values.size());
  search_->sizes.upload(size.data(), size.size());
  if (!discretisation_.followers.empty())
    prepare_followers(root);
}

// Lists the nodes that follow masters, and the mobilities of groups.
void CudaSolver::prepare_followers(const std::vector<double>& root)
{
  std::vector<SearchFollower> followers;
  for (const auto& node : discretisation_.followers)
    followers.push_back(
        { device_.device_node()[node.node], device_.device_node()[node.master], static_cast<float>(node.ratio) });
  std::stable_sort(followers.begin(), followers.end(),
                   [](const SearchFollower& a, const SearchFollower& b) { return a.master < b.master; });
  std::vector<std::uint32_t> begin;
  for (std::uint32_t f = 0; f < followers.size(); ++f)
    if (f == 0 || followers[f].master != followers[f - 1].master)
      begin.push_back(f);
  begin.push_back(static_cast<std::uint32_t>(followers.size()));
  std::vector<float> mobility(device_.nodes(), 0);
  for (std::size_t n = 0; n < root.size(); ++n)
    mobility[device_.device_node()[n]] = static_cast<float>(root[n] * root[n]);
  search_->mobility = DeviceArray<float>(mobility);
  search_->followers = DeviceArray<SearchFollower>(followers);
  search_->follower_begin = DeviceArray<std::uint32_t>(begin);
}

double CudaSolver::highest_frequency_squared()
{
  synchronise();
  if (!search_)
    prepare_search();
  FrequencySearch& s = *search_;
  const DeviceArray<float> activation(conditions_.activation);
  queue_forces(u_[present_].data(), activation.data(), s.present.data(), true);
  for (const auto* vector : { &s.now, &s.before })
    require(cudaMemcpyAsync(vector->data(), s.start.data(), s.start.bytes(), cudaMemcpyDeviceToDevice, stream_),
            "starting a search");
  LanczosIteration g{};
  g.nodes = static_cast<std::uint32_t>(device_.nodes());
  g.mobility = s.mobility.size() > 0 ? s.mobility.data() : device_.arguments().mobility;
  g.followers = s.followers.data();
  g.follower_begin = s.follower_begin.data();
  g.masters = s.follower_begin.size() > 0 ? static_cast<std::uint32_t>(s.follower_begin.size()) - 1 : 0;
  g.u = u_[present_].data();
  g.present = s.present.data();
  g.forces = s.forces.data();
  g.now = s.now.data();
  g.before = s.before.data();
  g.moved = s.moved.data();
  LanczosMatrix matrix;
  std::vector<double2> sizes;
  std::vector<double> along;
  for (int i = 0; i < most_lanczos_iterations && !matrix.settled();)
  {
    const int begin = i, end = std::min(i + (i == 0 ? first_series : further_series), most_lanczos_iterations);
    for (; i < end; ++i)
    {
      g.amplitude = mode_amplitude(*model_, i);
      g.size_before = i == 0 ? nullptr : g.size;
      g.size = s.sizes.data() + i * lanczos_blocks;
      g.size_next = s.sizes.data() + (i + 1) * lanczos_blocks;
      g.along = s.along.data() + i * lanczos_blocks;
      require(launch_displace(g, stream_), "displacing nodes");
      queue_forces(s.moved.data(), activation.data(), s.forces.data(), true);
      require(launch_lanczos_product(g, stream_), "a product with the stiffness");
      std::swap(g.now, g.before);
    }
    synchronise();
    download_part(s.sizes, begin * lanczos_blocks, (end + 1) * lanczos_blocks, sizes);
    download_part(s.along, begin * lanczos_blocks, end * lanczos_blocks, along);
    for (int row = static_cast<int>(matrix.rows()); row < i && !matrix.settled(); ++row)
    {
      const auto length = [&](int vector)
      {
        const double2* const of = sizes.data() + vector * lanczos_blocks;
        return std::sqrt(std::accumulate(of, of + lanczos_blocks, 0.0,
                                         [](double sum, const double2& part) { return sum + part.x; }));
      };
      const double* const product = along.data() + row * lanczos_blocks;
      matrix.add_row(std::accumulate(product, product + lanczos_blocks, 0.0) / length(row), length(row + 1));
    }
  }
  return matrix.largest_eigenvalue();
}

}  // namespace cuda
}  // namespace frontalis
