#include "cuda/backend/highest_frequency.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace frontalis
{
namespace cuda
{
namespace
{

// The host waits for the iterations of a search after series of these lengths. Most searches take 9 to 15 iterations.
constexpr int first_series = 10, further_series = 2;

}  // namespace

void CudaSolver::SearchDeleter::operator()(FrequencySearch* search) const { delete search; }

/// Allocates the memory of the search, and writes its random start and the sums of that.
void CudaSolver::prepare_search()
{
  search_.reset(new FrequencySearch(device_.nodes(), model_->mass_scaling.in_motion > 0));
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
  require(cudaMemcpy(search_->sizes(0), size.data(), size.size() * sizeof(double2), cudaMemcpyHostToDevice),
          "copying the sums of a start");
  if (!discretisation_.followers.empty() || !discretisation_.bound_mass.empty())
    prepare_followers(root);
}

// Lists the nodes that follow masters, and the mobilities of groups.
void CudaSolver::prepare_followers(const std::vector<double>& root)
{
  std::vector<SearchFollower> followers;
  for (const auto& node : discretisation_.followers)
    followers.push_back(
        { device_.device_node()[node.node], device_.device_node()[node.master], static_cast<float>(node.ratio) });
  search_->following.resize(root.size());
  for (const auto& node : discretisation_.followers)
    search_->following[node.master] +=
        static_cast<float>(node.ratio * node.ratio * discretisation_.node_mass[node.node]);
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
  const float* const activation = present_activation();
  queue_forces(u_[present_].data(), activation, s.present.data(), true);
  LanczosIteration g{};
  g.nodes = static_cast<std::uint32_t>(device_.nodes());
  g.mobility = s.mobility.size() > 0 ? s.mobility.data() : device_.inverse_bound_masses();
  g.followers = s.followers.data();
  g.follower_begin = s.follower_begin.data();
  g.masters = s.follower_begin.size() > 0 ? static_cast<std::uint32_t>(s.follower_begin.size()) - 1 : 0;
  g.u = u_[present_].data();
  g.present = s.present.data();
  g.forces = s.forces.data();
  g.moved = s.moved.data();
  LanczosMatrix matrix;
  std::vector<double> lengths;
  for (int i = 0; i < most_lanczos_iterations && !matrix.settled();)
  {
    const int begin = i, end = std::min(i + (i == 0 ? first_series : further_series), most_lanczos_iterations);
    for (; i < end; ++i)
    {
      g.amplitude = mode_amplitude(*model_, i);
      g.size_before = i == 0 ? nullptr : g.size;
      g.size = s.sizes(i);
      g.size_next = s.sizes(i + 1);
      g.along = s.along(i);
      g.now = s.vector(i);
      g.before = s.vector(std::max(i - 1, 0));
      g.after = s.vector(i + 1);
      require(launch_displace(g, stream_), "displacing nodes");
      queue_forces(s.moved.data(), activation, s.forces.data(), true);
      require(launch_lanczos_product(g, stream_), "a product with the stiffness");
    }
    const std::size_t first = begin * s.sums_of_iteration, count = (end - begin) * s.sums_of_iteration + s.along_at;
    require(cudaMemcpyAsync(s.host_sums.data() + first, s.sums.data() + first, count * sizeof(double),
                            cudaMemcpyDeviceToHost, stream_),
            "copying sums of a search");
    synchronise();
    for (int row = static_cast<int>(matrix.rows()); row < i && !matrix.settled(); ++row)
    {
      const auto length = [&](int vector)
      {
        const double* const of = s.host_sums.data() + vector * s.sums_of_iteration;
        double sum = 0;
        for (int block = 0; block < lanczos_blocks; ++block)
          sum += of[2 * block];
        return std::sqrt(sum);
      };
      const double* const product = s.host_sums.data() + row * s.sums_of_iteration + s.along_at;
      lengths.push_back(length(row));
      matrix.add_row(std::accumulate(product, product + lanczos_blocks, 0.0) / lengths.back(), length(row + 1));
    }
  }
  s.matrix = matrix;
  s.lengths = lengths;
  return matrix.largest_eigenvalue();
}

std::vector<FoundMode> CudaSolver::modes_above(double frequency_squared)
{
  FrequencySearch& s = *search_;
  if (s.node_of_device.empty())
  {
    s.node_of_device.resize(device_.nodes());
    for (std::size_t n = 0; n < model_->nodes.size(); ++n)
      s.node_of_device[device_.device_node()[n]] = static_cast<std::int32_t>(n);
  }
  const std::vector<LanczosMatrix::Eigenpair> pairs = s.matrix.eigenpairs_above(frequency_squared);
  if (pairs.empty())
    return {};
  constexpr auto most_shares = static_cast<std::size_t>(1 / least_mode_share), entries = 1 + most_shares;
  if (s.shares.size() < pairs.size() * entries)
    s.shares = DeviceArray<uint2>(pairs.size() * entries);
  require(cudaMemsetAsync(s.shares.data(), 0, pairs.size() * entries * sizeof(uint2), stream_), "emptying lists");
  for (std::size_t i = 0; i < pairs.size(); ++i)
    list_shares(pairs[i].vector, s.shares.data() + i * entries);
  synchronise();
  std::vector<uint2> lists;
  s.shares.download(lists);
  std::vector<FoundMode> modes;
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    FoundMode mode{ pairs[i].value, {} };
    const uint2* const list = lists.data() + i * entries;
    for (std::size_t at = 1; at <= std::min<std::size_t>(list->x, most_shares); ++at)
    {
      float share;
      std::memcpy(&share, &list[at].y, sizeof share);
      mode.shares.push_back({ s.node_of_device[list[at].x], share });
    }
    std::sort(mode.shares.begin(), mode.shares.end(),
              [](const ModeShare& a, const ModeShare& b) { return a.node < b.node; });
    modes.push_back(std::move(mode));
  }
  return modes;
}

// `mode`: components along the vectors at length 1. `list`: zeros; receives the number of shares, and then these.
void CudaSolver::list_shares(const std::vector<double>& mode, uint2* list)
{
  static_assert(most_lanczos_iterations <= VectorSum::most_vectors, "a mode may have that many vectors");
  FrequencySearch& s = *search_;
  VectorSum g{};
  for (; g.vectors < static_cast<int>(mode.size()); ++g.vectors)
  {
    g.vector[g.vectors] = s.vector(g.vectors);
    g.component[g.vectors] = static_cast<float>(mode[g.vectors] / s.lengths[g.vectors]);
  }
  g.nodes = static_cast<std::uint32_t>(device_.nodes());
  g.least = least_mode_share;
  g.list = list + 1;
  g.listed = &list->x;
  require(launch_list_shares(g, stream_), "listing a mode");
}

void CudaSolver::measure_growth(double found, bool keeps)
{
  device_monitor().limit_mobility(arguments(0), u_[present_].data(),
                                  keeps ? device_.limited_mobility() : device_.inverse_bound_masses(),
                                  static_cast<float>(found), device_.limited_mobility(), stream_);
  // Earlier plans measured growth since another search.
  plans_ = 0;
}

void CudaSolver::masses_changed(const std::vector<std::int32_t>& nodes)
{
  synchronise();
  std::vector<InverseMass> masses;
  for (const std::int32_t n : nodes)
  {
    const double own = discretisation_.node_mass[n];
    const double following = search_->following.empty() ? 0 : double(search_->following[n]);
    masses.push_back(
        { device_.device_node()[n], static_cast<float>(1 / own), static_cast<float>(1 / (own + following)) });
  }
  DeviceArray<InverseMass>& changes = search_->masses;
  if (changes.size() < masses.size())
    changes = DeviceArray<InverseMass>(2 * masses.size());
  changes.upload(masses.data(), masses.size());
  // Masses for the bound that differ from those of nodes do not change.
  float* const for_bound = discretisation_.bound_mass.empty() ? device_.inverse_bound_masses() : nullptr;
  require(launch_set_inverse_masses(changes.data(), static_cast<std::uint32_t>(masses.size()), u_[0].data(),
                                    u_[1].data(), for_bound, search_->mobility.data(), stream_),
          "setting masses");
  device_.take_masses(u_[present_].data(), stream_);
}

}  // namespace cuda
}  // namespace frontalis
