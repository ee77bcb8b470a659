// Measures kernel times of the CUDA backend on models made in code and on baked models, and the device's bandwidth.
#include "cuda/backend/device_memory.hpp"
#include "frontalis/error.hpp"
#include "frontalis/model/model_file.hpp"
#include "frontalis/solver/solver.hpp"
#include "frontalis/study/step_time.hpp"
#include "frontalis/study/voxel_model.hpp"
#include "cuda/bench/shell_model.hpp"
#include "cuda/bench/self_contact_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace frontalis;

namespace
{

struct Scene
{
  std::string name;
  std::function<Model()> make;
  int steps;
  bool touches = false;  // whether the motion begins with touching_start()
};

// Activations that rise linearly to `wanted` within 0.3 s, as in the published set-up (doc/performance.md).
Controls ramped(const Controls& wanted, double time)
{
  Controls now = wanted;
  for (auto& a : now.activation)
    a *= static_cast<float>(std::min(1.0, time / 0.3));
  return now;
}

// Device time of the work that `work` queues [s].
double device_seconds(const std::function<void()>& work)
{
  cudaEvent_t begin = nullptr, end = nullptr;
  cuda::require(cudaEventCreate(&begin), "making an event");
  cuda::require(cudaEventCreate(&end), "making an event");
  cuda::require(cudaEventRecord(begin), "recording an event");
  work();
  cuda::require(cudaEventRecord(end), "recording an event");
  cuda::require(cudaEventSynchronize(end), "waiting for the device");
  float milliseconds = 0;
  cuda::require(cudaEventElapsedTime(&milliseconds, begin, end), "reading a time");
  cudaEventDestroy(begin);
  cudaEventDestroy(end);
  return 1e-3 * milliseconds;
}

// Bytes per second that copies on the device read and write: the median of five runs.
double copy_bandwidth_of_device()
{
  const std::size_t bytes = std::size_t(1) << 30;
  const cuda::DeviceArray<char> from(bytes), to(bytes);
  std::vector<double> times(5);
  for (double& time : times)
    time = device_seconds([&] { cudaMemcpyAsync(to.data(), from.data(), bytes, cudaMemcpyDeviceToDevice, nullptr); });
  return 2.0 * static_cast<double>(bytes) / spread_of(times).median;
}

// Seconds per step over a run of at least `steps` steps. If `frame_wall_time` is above 0, the skin is fetched after
// each such interval [s] of wall time.
double seconds_of_a_run(Solver& solver, const Controls& controls, int steps, double frame_wall_time)
{
  const std::int64_t before = solver.profile().steps;
  const double time = device_seconds(
      [&]
      {
        double frame = wall_seconds();
        SkinState skin;
        while (solver.profile().steps - before < steps)
        {
          const double slice = 128 * solver.time_step();
          solver.advance(slice, ramped(controls, solver.time() + slice));
          if (frame_wall_time > 0 && wall_seconds() - frame > frame_wall_time)
          {
            frame = wall_seconds();
            solver.skin(skin);
          }
        }
      });
  return time / static_cast<double>(solver.profile().steps - before);
}

// Seconds per step: the median of five runs.
double seconds_per_step(Solver& solver, const Controls& controls, int steps)
{
  std::vector<double> times(5);
  for (double& time : times)
    time = seconds_of_a_run(solver, controls, steps, 0);
  return spread_of(times).median;
}

// Fraction of time that fetching the skin 60 times per wall second adds. It is the median of nine runs, each compared
// with the mean of the runs before and after it in which the skin is not fetched, because the motion goes on meanwhile.
double share_of_skin(Solver& solver, const Controls& controls, int steps)
{
  std::vector<double> shares(9);
  double before = seconds_of_a_run(solver, controls, steps, 0);
  for (double& share : shares)
  {
    const double with = seconds_of_a_run(solver, controls, steps, 1.0 / 60);
    const double after = seconds_of_a_run(solver, controls, steps, 0);
    share = 2 * with / (before + after) - 1;
    before = after;
  }
  return spread_of(shares).median;
}

// Voxels per second of the dense blocks of this run, by name. The rates of other models are compared with these.
using DenseRates = std::vector<std::pair<std::string, double>>;

void bench(const Scene& scene, DenseRates& dense)
{
  const double start = wall_seconds();
  const auto model = std::make_shared<const Model>(scene.make());
  std::size_t free_before = 0, free_after = 0, total = 0;
  cuda::require(cudaMemGetInfo(&free_before, &total), "asking for free memory");
  const auto solver = make_solver(model, { "cuda", 0, 0 });
  cuda::require(cudaMemGetInfo(&free_after, &total), "asking for free memory");
  const double built = wall_seconds() - start;
  Controls controls = solver->controls();
  // At rest no node enters another cell of its field. The additional time while the tissue moves is the cost of
  // entering cells.
  solver->advance(256 * solver->time_step(), controls);
  const double still = model->muscles.empty() ? 0 : seconds_per_step(*solver, controls, scene.steps);
  solver->reset();
  controls.activation.assign(model->muscles.size(), 0.75f);
  if (scene.touches)
    solver->set_displacements(touching_start(*model));
  const double warm_up = 256 * solver->time_step();
  solver->advance(warm_up, ramped(controls, warm_up));
  const double step = seconds_per_step(*solver, controls, scene.steps);
  const auto voxels = static_cast<double>(model->voxels.size());
  std::printf(
      "%-14s %10.0f voxels  %8.2f us per step  %7.2f G updates per second  %5.0f bytes per voxel  built in %.1f s  "
      "%s\n",
      scene.name.c_str(), voxels, 1e6 * step, voxels / step * 1e-9,
      static_cast<double>(free_before - free_after) / voxels, built, solver->description().c_str());
  if (scene.name.rfind("block_", 0) == 0)
    dense.emplace_back(scene.name, voxels / step);
  if (!model->skin.vertices.empty())
  {
    for (const auto& [name, rate] : dense)
      std::printf("%-14s %.2f of the rate of %s\n", "", voxels / step / rate, name.c_str());
    std::printf("%-14s at rest %.2f us per step\n", "", 1e6 * still);
    const double share = share_of_skin(*solver, controls, static_cast<int>(0.1 / step));
    std::printf(
        "%-14s skin of %zu vertices at 60 Hz: %+.1f %%   time step %.2f us, %.2f wall seconds per simulated second\n",
        "", model->skin.vertices.size(), 100 * share, 1e6 * solver->time_step(), step / solver->time_step());
  }
  const Monitor monitor = solver->monitor();
  if (!monitor.finite)
    throw Error(scene.name + ": the motion is not finite");
  std::fflush(stdout);
}

std::vector<Scene> scenes()
{
  const auto shell = [](double voxel) { return [voxel] { return shell_model({ voxel, 11000, 5e6 }); }; };
  const auto blocks = [](std::int32_t height, bool contact, double friction)
  { return [=] { return touching_blocks(height, contact, friction); }; };
  return { { "thin_plain", blocks(2, false, 0), 20000 },
           { "thin_touch", blocks(2, true, 0), 20000, true },
           { "thin_rub", blocks(2, true, 0.3), 20000, true },
           { "blocks_plain", blocks(33, false, 0), 10000 },
           { "blocks_touch", blocks(33, true, 0), 10000, true },
           { "high_plain", blocks(400, false, 0), 2000 },
           { "high_touch", blocks(400, true, 0), 2000, true },
           { "block_4k", [] { return dense_block(16, 16, 16); }, 20000 },
           { "block_1m", [] { return dense_block(102, 102, 102); }, 2000 },
           { "block_2m", [] { return dense_block(126, 126, 126); }, 2000 },
           { "block_16m", [] { return dense_block(252, 252, 252); }, 1000 },
           { "shell_4k", shell(2.8e-3), 20000 },
           { "shell_30k", shell(1.4e-3), 20000 },
           { "shell_100k", shell(0.93e-3), 10000 },
           { "shell_1m", shell(0.45e-3), 2000 },
           { "block_512", [] { return dense_block(512, 512, 512); }, 100 } };
}

int run(int count, char** arguments)
{
  const std::vector<std::string> wanted(arguments + 1, arguments + count);
  const auto is_wanted = [&](const std::string& name)
  {
    // The largest model takes minutes to build and runs only if it is named.
    return wanted.empty() ? name != "block_512" : std::find(wanted.begin(), wanted.end(), name) != wanted.end();
  };
  if (is_wanted("copy"))
    std::printf("copies on the device: %.2f TB/s\n", 1e-12 * copy_bandwidth_of_device());
  DenseRates dense;
  for (const Scene& scene : scenes())
    if (is_wanted(scene.name))
      bench(scene, dense);
  // Names with a dot are files of baked models.
  for (const std::string& name : wanted)
    if (name.find('.') != std::string::npos)
      bench({ name.substr(name.rfind('/') + 1), [&] { return read_model(name); }, 10000 }, dense);
  return 0;
}

}  // namespace

int main(int count, char** arguments)
{
  try
  {
    return run(count, arguments);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
