#include "frontalis/study/step_time.hpp"

#include "study/bench/bare_loop.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <functional>
#include <thread>
#include <vector>

namespace frontalis
{
namespace
{

void on_threads(int threads, const std::function<void(int)>& task)
{
  std::vector<std::thread> team;
  for (int t = 1; t < threads; ++t)
    team.emplace_back(task, t);
  task(0);
  for (auto& thread : team)
    thread.join();
}

BareLoopKernel widest_kernel()
{
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq"))
    return bare_loop_avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return bare_loop_avx2;
#endif
  return bare_loop_baseline;
}

}  // namespace

double copy_bandwidth(int threads)
{
  const std::size_t bytes = std::size_t(64) << 20;
  std::vector<std::vector<char>> from(static_cast<std::size_t>(threads)), to(from.size());
  on_threads(threads,
             [&](int t)
             {
               from[static_cast<std::size_t>(t)].assign(bytes, 1);
               to[static_cast<std::size_t>(t)].assign(bytes, 0);
             });
  std::vector<double> rates;
  for (int repetition = 0; repetition < 7; ++repetition)
  {
    const double start = wall_seconds();
    on_threads(
        threads, [&](int t)
        { std::memcpy(to[static_cast<std::size_t>(t)].data(), from[static_cast<std::size_t>(t)].data(), bytes); });
    rates.push_back(2.0 * static_cast<double>(bytes) * threads / (wall_seconds() - start));
  }
  return spread_of(rates).median;
}

double bare_loop(int edge, int threads, double seconds)
{
  const int n = edge + 1;
  const std::size_t nodes = static_cast<std::size_t>(n) * n * n + 64,
                    voxels = static_cast<std::size_t>(edge) * edge * edge;
  std::vector<float> u[3], next[3], v[3];
  for (int c = 0; c < 3; ++c)
  {
    u[c].assign(nodes, 0);
    next[c].assign(nodes, 0);
    v[c].assign(nodes, 0);
    for (std::size_t i = 0; i + 64 < nodes; ++i)
      u[c][i] = 1e-5f * static_cast<float>((i * 2654435761u >> 7) % 17);
  }
  const float young = 34e3f, nu = 0.49f, spacing = 1e-3f, density = 11000;
  const float shear = young / (2 * (1 + nu)), bulk = young / (3 * (1 - 2 * nu));
  const std::vector<float> mu(voxels + 64, shear), kappa(voxels + 64, bulk);
  BareLoop loop{};
  loop.nodes_an_edge = n;
  loop.mu = mu.data();
  loop.kappa = kappa.data();
  loop.spacing = spacing;
  loop.dt = 0.3f * spacing / std::sqrt((bulk + 4 * shear / 3) / density);
  loop.keep = 0.999f;
  loop.inverse_mass = 1 / (density * spacing * spacing * spacing);
  const BareLoopKernel kernel = widest_kernel();
  std::vector<std::vector<float>> scratch(static_cast<std::size_t>(threads));
  for (auto& s : scratch)
    s.assign(6 * (static_cast<std::size_t>(n) * n + 64), 0);

  // like the solver's threads, these wait for each other in a spinning barrier after every step
  const auto run = [&](int steps)
  {
    std::atomic<int> arrived{ 0 };
    on_threads(threads,
               [&](int t)
               {
                 BareLoop mine = loop;
                 for (int step = 0; step < steps; ++step)
                 {
                   for (int c = 0; c < 3; ++c)
                   {
                     mine.u[c] = (step % 2 == 0 ? u : next)[c].data();
                     mine.next[c] = (step % 2 == 0 ? next : u)[c].data();
                     mine.v[c] = v[c].data();
                   }
                   kernel(mine, n * t / threads, n * (t + 1) / threads, scratch[static_cast<std::size_t>(t)].data());
                   arrived.fetch_add(1);
                   for (int spin = 0; arrived.load() < threads * (step + 1); ++spin)
                     if (spin > 4000)
                       std::this_thread::yield();
                 }
               });
  };
  run(2);
  double start = wall_seconds();
  run(4);
  const int steps = 2 * std::max(1, static_cast<int>(seconds / 5 / ((wall_seconds() - start) / 4) / 2));
  std::vector<double> rates;
  for (int repetition = 0; repetition < 5; ++repetition)
  {
    start = wall_seconds();
    run(steps);
    rates.push_back(static_cast<double>(voxels) * steps / (wall_seconds() - start));
  }
  return spread_of(rates).median;
}

}  // namespace frontalis
