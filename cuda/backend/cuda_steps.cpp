#include "cuda/backend/contact_point.hpp"
#include "cuda/backend/cuda_solver.hpp"
#include "cuda/kernels/monitor_kernel.hpp"

#include "frontalis/physics/mutation.hpp"
#include "frontalis/physics/sliding.hpp"

#include <algorithm>
#include <cstring>

namespace frontalis
{
namespace cuda
{

void CudaSolver::kick(StepArguments& g, double seconds) const
{
  g.kick = seconds;
  static_cast<physics::Kick<float>&>(g) = conditions_.kick<float>(seconds);
  if (mutation::no_gpu_gravity)
    std::fill_n(g.impulse, 3, 0.0f);
}

StepArguments CudaSolver::arguments(double dt, bool idle_parts) const
{
  StepArguments g = device_.arguments(idle_parts);
  for (int buffer = 0; buffer < 2; ++buffer)
    g.u[buffer] = u_[buffer].data();
  for (int axis = 0; axis < 3; ++axis)
    g.v[axis] = v_[axis].data();
  if (account_)
    account_->describe(g);
  g.first = present_;
  g.dt = static_cast<float>(dt);
  g.dt_exact = dt;
  g.rate = 1 / dt;
  g.friction_response = physics::friction_response(dt);
  kick(g, dt);
  return g;
}

// Copies to the device, in one transfer from page-locked memory: zeros for what is measured, the motion of bones and of
// bodies that tissue may touch, the activations, and the relaxation times of viscous stresses. `relaxation` is empty if
// launches do not relax stresses.
void CudaSolver::stage(const StepPlan& plan, const std::vector<float>& relaxation, PlanSlot& slot, StepArguments& g)
{
  const std::size_t muscles = model_->muscles.size(), bones = model_->bones.size();
  const auto running = device_.running_parts();
  std::vector<std::vector<RigidTransform>> poses;
  for (int step = 0; (bones > 0 || !running.empty()) && step <= plan.steps; ++step)
    poses.push_back(step == 0 ? plan.begin.bone : plan.bones(step - 1));
  std::vector<float> motions(poses.size() * bones * bone_motion_entries), bodies;
  float* motion = motions.data();
  for (std::size_t step = 0; step < poses.size(); ++step)
    for (std::size_t bone = 0; bone < bones; ++bone)
      motion = put_bone_motion(poses[step == 0 ? 0 : step - 1][bone], poses[step][bone], 1 / plan.dt, motion);
  for (const DevicePart* const part : running)
    if (bodies.empty())
      bodies = part->motion(poses);
  // Offset of the motion of bones [bytes]. It and that of bodies are read as float4, which must be aligned to 16 bytes.
  constexpr std::size_t motions_at = 16;
  const std::size_t bodies_at = motions_at + sizeof(float) * motions.size();
  const std::size_t activation_at = bodies_at + sizeof(float) * bodies.size();
  const std::size_t relaxation_at = activation_at + 2 * sizeof(float) * muscles;
  const std::size_t bytes = relaxation_at + sizeof(float) * relaxation.size();
  if (bytes > slot.staged.size())
  {
    slot.staged = PinnedArray<char>(bytes);
    slot.controls = DeviceArray<char>(bytes);
  }
  char* const staged = slot.staged.data();
  std::memset(staged, 0, motions_at);
  const auto put = [staged](std::size_t at, const auto& values)
  {
    if (!values.empty())
      std::memcpy(staged + at, values.data(), values.size() * sizeof(values[0]));
  };
  put(motions_at, motions);
  put(bodies_at, bodies);
  put(activation_at, plan.begin.activation);
  put(activation_at + muscles * sizeof(float), plan.end.activation);
  put(relaxation_at, relaxation);
  require(cudaMemcpyAsync(slot.controls.data(), staged, bytes, cudaMemcpyHostToDevice, stream_), "copying controls");
  char* const controls = slot.controls.data();
  g.frequency_bound = reinterpret_cast<std::uint32_t*>(controls);
  if (!bodies.empty())
  {
    g.contact.poses = reinterpret_cast<float4*>(controls + bodies_at);
    g.contact.ways = reinterpret_cast<const float*>(controls + bodies_at) + (bodies.size() - poses.size());
  }
  g.activation_begin = reinterpret_cast<const float*>(controls + activation_at);
  g.activation_end = g.activation_begin + muscles;
  g.bone_motions = reinterpret_cast<const float4*>(controls + motions_at);
  g.relaxation = relaxation.empty() ? nullptr : reinterpret_cast<const float*>(controls + relaxation_at);
}

// Begins a launch of steps. In strips, the first kernel of a step finds added stress.
void CudaSolver::begin_steps(StepArguments& g, int begin, int end)
{
  g.step_begin = begin;
  g.step_end = end;
  g.first = present_;
  g.steps_before = steps_before_;
  if (adds_stress())
    require(launch_added_stress(g, stream_), "finding added stress");
}

void CudaSolver::step(const StepArguments& g)
{
  require(launch_steps(g, launch_, stream_), "launching steps");
  const int steps = g.step_end - g.step_begin;
  steps_before_ += static_cast<std::uint32_t>(steps);
  present_ = (present_ + steps) & 1;
}

// Makes as many steps per launch as loads allow if no other part has kernels, else one. The forces of parts that have
// kernels of their own change the velocities before each step.
void CudaSolver::do_steps(const StepPlan& plan, StepArguments& g, int begin, int end)
{
  const auto running = device_.running_parts();
  std::vector<DevicePart*> pushing;
  for (DevicePart* const part : running)
    if (!launch_.patches || part->has_kernels(stays()))
      pushing.push_back(part);
  const bool stay = stays() && pushing.empty();
  g.contact.blocks_beside = 0;
  for (const DevicePart* const part : pushing)
    g.contact.blocks_beside += adds_stress() ? part->blocks_beside() : 0;
  for (int s = begin, next = begin; s < end; s = next)
  {
    next = stay ? device_.loads().end_of_launch(s, end) : s + 1;
    device_.loads().update(g, s, u_[present_].data(), stream_);
    if (account_)
    {
      g.first = present_;
      account_->before_step(g, s, stream_);
    }
    begin_steps(g, s, next);
    for (const DevicePart* const part : pushing)
    {
      if (g.contact.blocks_beside == 0 || part->blocks_beside() == 0)
        part->find_pushes(g, s, stream_);
      part->push(g, g.gain / g.keep, g.v, stream_);
    }
    step(g);
    if (!account_)
      continue;
    for (const DevicePart* const part : pushing)
      part->push(g, -g.gain / g.keep, g.velocity_before, stream_);
    account_->after_step(g, conditions_.damping, s, stream_);
    if (running.empty())
      continue;
    synchronise();
    for (DevicePart* const part : running)
      part->follow(plan.constraint_step(s));
  }
}

// Whether strips have a kernel for the stress of fibres and of laws other than neo-Hookean.
bool CudaSolver::adds_stress() const
{
  return !launch_.patches && (launch_.effects & Effects::added) == Effects::added;
}

// Whether patches can make many steps per launch.
bool CudaSolver::stays() const { return launch_.patches && !account_; }

PlanMeasures CudaSolver::run(const StepPlan& plan)
{
  PlanSlot& slot = slots_[plans_ % plan_slots];
  StepArguments g = arguments(plan.dt);
  g.time = plan.time;
  g.steps = plan.steps;
  g.bound_every_step = plan.bound_every_step;
  device_.loads().begin(plan);
  if (!device_.loads().act())
    g.load_begin = nullptr;
  const bool relaxes = !device_.viscosity().idle();
  const std::vector<double> elapsed = relaxes ? plan.relaxation : std::vector<double>(plan.steps, 0);
  // Patches relax their viscous stresses within launches, unless the energy ledger needs the work of each relaxation.
  std::vector<float> relaxation;
  if (launch_.patches && !account_ && relaxes)
  {
    relaxation.push_back(0);
    relaxation.insert(relaxation.end(), elapsed.begin(), elapsed.end() - 1);
  }
  stage(plan, relaxation, slot, g);
  const auto relax_after = [&](int step)
  {
    if (elapsed[step] > 0 && (relaxation.empty() || step + 1 == plan.steps))
      device_.viscosity().relax(g, u_[present_].data(), u_[1 - present_].data(), elapsed[step], stream_);
  };
  if (!stays())
    g.touch.in_patches = {};
  for (const DevicePart* const part : device_.running_parts())
    part->prepare(g, plan.steps, stream_);
  int done = 0;
  if (still_moved_ || plan.first_kick != plan.dt)
  {
    kick(g, plan.first_kick);
    do_steps(plan, g, 0, 1);
    kick(g, plan.dt);
    for (int buffer = 0; still_moved_ && buffer < 2; ++buffer)
      require(launch_hold(still_.data(), static_cast<std::uint32_t>(still_.size()), u_[buffer].data(), stream_),
              "holding still nodes");
    still_moved_ = false;
    done = 1;
    relax_after(0);
  }
  while (done < plan.steps)
  {
    int end = done + 1;
    while (end < plan.steps && (!relaxation.empty() || elapsed[end - 1] == 0))
      ++end;
    do_steps(plan, g, done, end);
    relax_after(end - 1);
    done = end;
  }
  require(launch_largest_speed(g, static_cast<std::uint32_t>(device_.nodes()), g.frequency_bound + 1, stream_),
          "finding the largest speed");
  require(cudaMemcpyAsync(slot.seen.data(), g.frequency_bound, plan_measures * sizeof(std::uint32_t),
                          cudaMemcpyDeviceToHost, stream_),
          "copying measures");
  require(cudaEventRecord(slot.done, stream_), "recording an event");
  ++plans_;
  const auto seen = [&](std::int64_t index)
  {
    const PlanSlot& of = slots_[index % plan_slots];
    require(cudaEventSynchronize(of.done), "stepping");
    float measured[plan_measures];
    std::memcpy(measured, of.seen.data(), sizeof measured);
    return PlanMeasures{ measured[0], measured[1] };
  };
  // The host waits for the measures of the previous plan, so that the device always has work, or for those of this plan
  // if the motion changes fast.
  if (plans_ == 1 || plan.bound_awaited)
    return seen(plans_ - 1);
  const PlanMeasures before = seen(plans_ - 2);
  return before.frequency_squared > plan.alarming ? seen(plans_ - 1) : before;
}

// Computes the internal forces at any displacements. `out` must hold zeros for nodes without voxels.
void CudaSolver::queue_forces(float4* at, const float* activation, float4* out, bool springs)
{
  StepArguments g = arguments(0, springs);
  g.activation_begin = g.activation_end = activation;
  g.steps = 1;
  g.forces_only = true;
  g.u[present_] = at;
  g.u[1 - present_] = out;
  g.contact.spring = g.shell.spring = springs;
  // restored even if a launch fails
  struct Kept
  {
    StepLaunch& launch;
    int& present;
    const StepLaunch launch_then = launch;
    const int present_then = present;
    ~Kept()
    {
      launch = launch_then;
      present = present_then;
    }
  };
  {
    const Kept kept{ launch_, present_ };
    if (springs)
      launch_.effects = device_.launch_with_parts().effects;
    begin_steps(g, 0, 1);
    step(g);
  }
  float* const none[3] = { nullptr, nullptr, nullptr };
  for (const auto& part : device_.parts())
    if (springs && (!launch_.patches || part->has_kernels(false)))
    {
      part->find_pushes(g, 0, stream_);
      part->push(g, 0, none, stream_);
    }
}

const float* CudaSolver::present_activation()
{
  if (activation_.size() == 0)
    activation_ = DeviceArray<float>(conditions_.activation.size());
  activation_.upload(conditions_.activation.data(), activation_.size());
  return activation_.data();
}

void CudaSolver::internal_forces(NodalVectors& out)
{
  synchronise();
  const DeviceArray<float4> forces(device_.nodes());
  require(cudaMemset(forces.data(), 0, forces.bytes()), "clearing forces");
  queue_forces(u_[present_].data(), present_activation(), forces.data());
  synchronise();
  download(forces, out);
}

Work CudaSolver::work(bool open)
{
  synchronise();
  StepArguments g = arguments(0);
  g.activation_begin = g.activation_end = present_activation();
  g.steps = 1;
  if (open)
  {
    account_->open(g, u_[present_].data(), stream_);
    device_.viscosity().reset_account();
  }
  else
  {
    account_->measure(g, u_[present_].data(), 0, stream_);
    device_.viscosity().relax(arguments(0), u_[present_].data(), u_[1 - present_].data(), 0, stream_);
  }
  synchronise();
  Work work = account_->work();
  work.viscous = device_.viscosity().work();
  return work;
}

void CudaSolver::add_energies(bool open, NodalVectors& forces, EnergyLedger& ledger)
{
  const auto running = device_.running_parts();
  if (running.empty())
    return;
  NodalVectors u;
  get(NodalField::displacements, u);
  std::vector<double> components[3];
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const auto& moved : u)
      components[axis].push_back(moved[axis]);
  follow_without_account();
  for (DevicePart* const part : running)
    part->add_energies(components, conditions_.bone, open, forces, ledger);
}

void CudaSolver::follow_without_account() const
{
  if (!account_)
    for (const auto& part : device_.parts())
      if (!part->idle())
        part->follow({ 0, 0, 0, conditions_.bone, conditions_.bone, conditions_.activation });
}

std::vector<Reaction> CudaSolver::reactions() const
{
  synchronise();
  follow_without_account();
  std::vector<Reaction> all;
  for (const auto& part : device_.parts())
    for (const Reaction& reaction : part->reactions())
      all.push_back(reaction);
  return all;
}

std::vector<RigidTransform> CudaSolver::bodies() const
{
  synchronise();
  std::vector<RigidTransform> all;
  for (const auto& part : device_.parts())
    for (const RigidTransform& pose : part->bodies(conditions_.bone))
      all.push_back(pose);
  return all;
}

std::int64_t CudaSolver::lost_points() const
{
  synchronise();
  std::int64_t lost = 0;
  for (const auto& part : device_.parts())
    lost += part->lost_points();
  return lost;
}

double CudaSolver::body_energy() const
{
  synchronise();
  double sum = 0;
  for (const auto& part : device_.parts())
    sum += part->idle() ? 0 : part->body_energy();
  return sum;
}

DeviceMonitor& CudaSolver::device_monitor()
{
  if (!monitor_)
    monitor_ = std::make_unique<DeviceMonitor>(*model_, device_);
  return *monitor_;
}

Monitor CudaSolver::monitor() { return device_monitor().read(arguments(0), u_[present_].data(), stream_); }

}  // namespace cuda
}  // namespace frontalis
