#include "bound_points.hpp"
#include "cpu_kernel.hpp"
#include "flush_denormals.hpp"
#include "nodal_loads.hpp"
#include "stepping_solver.hpp"
#include "thread_team.hpp"
#include "voxel_rows.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Vectors = std::vector<std::array<double, 3>>;

/// Float, SIMD, all cores. Threads own slabs of node planes and compute the voxel plane below their slab again, so that
/// every node's force is added up in the same order whatever the number of threads.
class CpuSolver : public SteppingSolver
{
public:
  CpuSolver(std::shared_ptr<const Model> model, const SolverSettings& settings, const std::string& remark);

  void skin(SkinState& out) override { skin_state(*model_, pointers(u_).data(), out); }
  void displacements(Vectors& out) const override { interleave(u_, out); }
  void set_displacements(const Vectors& in) override;
  void set_velocities(const Vectors& in) override { separate(in, v_); }
  void internal_forces(Vectors& out) override;
  std::string description() const override;

protected:
  double run(const StepPlan& plan) override;
  void rest() override;
  void velocities(Vectors& out) const override { interleave(v_, out); }

private:
  using Components = std::array<std::vector<float>, 3>;

  static std::array<const float*, 3> pointers(const Components& c)
  {
    return { { c[0].data(), c[1].data(), c[2].data() } };
  }
  void interleave(const Components& in, Vectors& out) const;
  void separate(const Vectors& in, Components& out);
  void share_planes();
  CpuKernelArguments arguments(double dt, const float* activation);
  void add_loads(std::int32_t first, std::int32_t last, const CpuKernelArguments& g);

  VoxelRows rows_;
  std::array<std::vector<float>, 4> assumed_strain_;
  std::vector<float> mu_, kappa_, hourglass_, frequency_squared_, inverse_mass_, with_length_, with_passive_;
  Components u_, next_, v_;
  std::int32_t buffer_stride_ = 0;
  CpuKernelChoice kernel_;
  RestrictedNodes<float> restricted_;
  NodalLoads loads_;
  ThreadTeam team_;
  std::string remark_;
  std::vector<std::int32_t> slab_;           // node planes of thread t: slab_[t] .. slab_[t + 1]
  std::vector<std::vector<float>> buffers_;  // one a thread
};

std::vector<double> times(const std::vector<double>& a, const std::vector<double>& b)
{
  std::vector<double> product(a.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    product[i] = a[i] * b[i];
  return product;
}

CpuSolver::CpuSolver(std::shared_ptr<const Model> model, const SolverSettings& settings, const std::string& remark)
    : SteppingSolver(std::move(model), settings),
      rows_(*model_, discretisation_),
      mu_(rows_.blocks(times(discretisation_.mu, discretisation_.tissue_volume))),
      kappa_(rows_.blocks(times(discretisation_.kappa, discretisation_.tissue_volume))),
      hourglass_(rows_.blocks(discretisation_.hourglass)),
      frequency_squared_(rows_.blocks(discretisation_.frequency_squared)),
      kernel_(choose_cpu_kernel()),
      restricted_(*model_, kernel_.slide),
      loads_(*model_),
      team_(settings.threads),
      remark_(remark)
{
  for (const double mass : discretisation_.node_mass)
    inverse_mass_.push_back(static_cast<float>(1 / mass));
  for (const auto& muscle : model_->muscles)
  {
    with_length_.push_back(muscle.tension_length ? 1.0f : 0.0f);
    with_passive_.push_back(muscle.passive ? 1.0f : 0.0f);
  }
  for (int part = 0; part < 4; ++part)
    if (!discretisation_.assumed_strain[part].empty())
      assumed_strain_[part] = rows_.blocks(discretisation_.assumed_strain[part]);
  std::int32_t largest = 0;
  for (std::int32_t k = 0; k < rows_.planes; ++k)
    largest = std::max(largest, rows_.plane_nodes[k + 1] - rows_.plane_nodes[k]);
  buffer_stride_ = largest + 2 * Tile::width;
  share_planes();
  rest();
}

// slabs of about equal numbers of tiles
void CpuSolver::share_planes()
{
  const int threads = team_.size();
  const auto total = static_cast<std::int64_t>(rows_.tiles.size());
  slab_.assign(1, 0);
  for (int t = 1; t < threads; ++t)
  {
    const auto end = std::lower_bound(rows_.plane_tiles.begin(), rows_.plane_tiles.end(),
                                      static_cast<std::int32_t>(total * t / threads));
    const auto plane = static_cast<std::int32_t>(end - rows_.plane_tiles.begin());
    slab_.push_back(std::clamp(plane, slab_.back(), rows_.planes));
  }
  slab_.push_back(rows_.planes);
  buffers_.assign(threads, std::vector<float>(6 * static_cast<std::size_t>(buffer_stride_)));
}

void CpuSolver::rest()
{
  for (auto* field : { &u_, &next_, &v_ })
    for (auto& component : *field)
      component.assign(model_->nodes.size() + 2 * Tile::width, 0);
  restricted_.reset();
}

void CpuSolver::interleave(const Components& in, Vectors& out) const
{
  out.resize(model_->nodes.size());
  for (std::size_t n = 0; n < out.size(); ++n)
    out[n] = { { in[0][n], in[1][n], in[2][n] } };
}

void CpuSolver::separate(const Vectors& in, Components& out)
{
  for (std::size_t n = 0; n < in.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      out[axis][n] = static_cast<float>(in[n][axis]);
}

void CpuSolver::set_displacements(const Vectors& in)
{
  rest();
  separate(in, u_);
  renew_time_step();
}

CpuKernelArguments CpuSolver::arguments(double dt, const float* activation)
{
  CpuKernelArguments g{};
  const auto& h = model_->spacing;
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    g.u[axis] = u_[axis].data();
    g.next[axis] = next_[axis].data();
    g.v[axis] = v_[axis].data();
    g.scale[axis] = static_cast<float>(0.25 / h[axis]);
    g.impulse[axis] = static_cast<float>(gain(dt) * model_->gravity[axis]);
    g.hourglass_weight[axis] = static_cast<float>(discretisation_.hourglass_weight[axis]);
    sum += 1 / (h[axis] * h[axis]);
  }
  for (int part = 0; part < 4; ++part)
    g.assumed_strain[part] = assumed_strain_[part].empty() ? nullptr : assumed_strain_[part].data();
  for (int axis = 0; axis < 3; ++axis)
    g.stretch_weight[axis] = static_cast<float>(1 / (h[axis] * h[axis]) / sum);
  g.inverse_mass = inverse_mass_.data();
  g.tiles = rows_.tiles.data();
  g.plane_tiles = rows_.plane_tiles.data();
  g.plane_nodes = rows_.plane_nodes.data();
  g.planes = rows_.planes;
  g.mu = mu_.data();
  g.kappa = kappa_.data();
  g.hourglass = hourglass_.data();
  g.frequency_squared = frequency_squared_.data();
  g.fibres = rows_.fibres.data();
  g.laws = rows_.laws.data();
  g.activation = activation;
  g.with_length = with_length_.data();
  g.with_passive = with_passive_.data();
  g.dt = static_cast<float>(dt);
  g.keep = static_cast<float>(keep(dt));
  g.gain = static_cast<float>(gain(dt));
  g.buffer_stride = buffer_stride_;
  return g;
}

void CpuSolver::internal_forces(Vectors& out)
{
  const CpuKernelArguments g = arguments(0, controls().activation.data());
  team_.run([&](int t) { kernel_.kernel(g, slab_[t], slab_[t + 1], buffers_[t].data(), KernelTask::forces); });
  interleave(next_, out);
}

// the update is linear in the force: loads are added after it
void CpuSolver::add_loads(std::int32_t first, std::int32_t last, const CpuKernelArguments& g)
{
  const auto& nodes = loads_.nodes();
  for (auto l = std::lower_bound(nodes.begin(), nodes.end(), first) - nodes.begin();
       l < static_cast<std::ptrdiff_t>(nodes.size()) && nodes[l] < last; ++l)
    for (int axis = 0; axis < 3; ++axis)
    {
      const float change = g.gain * inverse_mass_[nodes[l]] * static_cast<float>(loads_.forces()[l][axis]);
      g.v[axis][nodes[l]] += change;
      g.next[axis][nodes[l]] += g.dt * change;
    }
}

double CpuSolver::run(const StepPlan& plan)
{
  const std::size_t muscles = model_->muscles.size();
  std::vector<float> activation(plan.steps * muscles);
  std::vector<Drive> drives;
  for (int step = 0; step < plan.steps; ++step)
  {
    plan.activation(step, activation.data() + step * muscles);
    drives.push_back(plan.drive(step));
  }
  std::vector<float> seen(team_.size(), 0);
  const CpuKernelArguments first = arguments(plan.dt, nullptr);
  team_.run(
      [&](int t)
      {
        const FlushDenormals flush;
        CpuKernelArguments g = first;
        const std::int32_t begin = rows_.plane_nodes[slab_[t]], end = rows_.plane_nodes[slab_[t + 1]];
        for (int step = 0; step < plan.steps; ++step)
        {
          g.activation = activation.data() + step * muscles;
          if (!loads_.empty())
          {
            if (t == 0)
              loads_.update(plan.time + step * plan.dt, g.u);
            team_.barrier();
          }
          const auto task = step + 1 == plan.steps ? KernelTask::step_and_look : KernelTask::step;
          const float frequency_squared = kernel_.kernel(g, slab_[t], slab_[t + 1], buffers_[t].data(), task);
          if (step + 1 == plan.steps)
            seen[t] = frequency_squared;
          if (!loads_.empty())
            add_loads(begin, end, g);
          if (!restricted_.empty())
            restricted_.apply(begin, end, g.next, g.v, g.u, drives[step]);
          team_.barrier();
          for (int axis = 0; axis < 3; ++axis)
          {
            float* const old = const_cast<float*>(g.u[axis]);
            g.u[axis] = g.next[axis];
            g.next[axis] = old;
          }
        }
      });
  if (plan.steps % 2 == 1)
    u_.swap(next_);
  double worst = 0;
  for (const float x : seen)
    worst = std::isfinite(x) ? std::max(worst, static_cast<double>(x)) : x;
  return worst;
}

std::string CpuSolver::description() const
{
  return std::string("cpu (float, ") + kernel_.name + ", " + std::to_string(team_.size()) +
         (team_.size() == 1 ? " thread" : " threads") + (remark_.empty() ? "" : "; " + remark_) + ")";
}

}  // namespace

std::unique_ptr<Solver> make_cpu_solver(std::shared_ptr<const Model> model, const SolverSettings& settings,
                                        const std::string& remark)
{
  return std::make_unique<CpuSolver>(std::move(model), settings, remark);
}

}  // namespace frontalis
