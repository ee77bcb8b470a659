#include "cuda_backend.hpp"
#include "device_model.hpp"
#include "launch_choice.hpp"
#include "stepping_solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace frontalis
{
namespace
{

using cuda::DeviceArray;
using cuda::PinnedArray;
using cuda::require;
using Vectors = std::vector<std::array<double, 3>>;

/// One plan's worth of controls on its way to the device, and what is seen at its end.
struct PlanSlot
{
  PinnedArray<char> staged;
  DeviceArray<char> controls;
  PinnedArray<std::uint32_t> seen;
  cudaEvent_t done = nullptr;
};

/// Float, on one NVIDIA GPU. Steps are queued and not waited for: what a plan's last step saw of the time step rules
/// the plan after the next, and the host waits only for that and where it asks for results.
class CudaSolver : public SteppingSolver
{
public:
  CudaSolver(std::shared_ptr<const Model> model, const SolverSettings& settings);
  ~CudaSolver() override;

  void skin(SkinState& out) override;
  void displacements(Vectors& out) const override;
  void set_displacements(const Vectors& in) override;
  void set_velocities(const Vectors& in) override;
  void internal_forces(Vectors& out) override;
  std::string description() const override;

protected:
  double run(const StepPlan& plan) override;
  int steps_a_plan() const override;
  void rest() override;
  void velocities(Vectors& out) const override;

private:
  static constexpr int plan_slots = 3;

  StepArguments arguments(double dt) const;
  void stage(const StepPlan& plan, PlanSlot& slot, StepArguments& g);
  void step(StepArguments& g, int begin, int end);
  void download(const DeviceArray<float4>& field, Vectors& out) const;
  void upload_displacements(const Vectors* in, int buffer);
  void synchronise() const { require(cudaStreamSynchronize(stream_), "stepping"); }

  cuda::DeviceModel device_;
  DeviceArray<float4> u_[2];
  DeviceArray<float> v_[3];
  cuda::DeviceSurface skin_, landmarks_;
  DeviceArray<float> skin_output_;  // vertices, normals, landmarks
  PinnedArray<float> skin_staged_;
  DeviceArray<std::uint32_t> still_;  // device nodes that never move
  DeviceArray<std::uint32_t> barrier_;
  std::uint32_t barrier_base_ = 0;
  cudaStream_t stream_ = nullptr;
  PlanSlot slots_[plan_slots];
  std::int64_t plans_ = 0;
  int present_ = 0;           // buffer that holds the displacements now
  bool still_moved_ = false;  // displacements were set from outside, those of still nodes too
  StepLaunch launch_{};
  bool resident_ = false;  // all blocks fit the device at once, so that one launch does many steps
};

CudaSolver::CudaSolver(std::shared_ptr<const Model> model, const SolverSettings& settings)
    : SteppingSolver(std::move(model), settings),
      device_(*model_, discretisation_, cuda::choose_strips(*model_, cuda::effects_of(*model_, discretisation_))),
      skin_(*model_, device_.device_node(), model_->skin.vertices, model_->skin_binding, model_->skin.triangles),
      landmarks_(*model_, device_.device_node(), model_->landmark_positions, model_->landmark_binding, {})
{
  for (auto& buffer : u_)
    buffer = DeviceArray<float4>(device_.nodes());
  for (auto& component : v_)
    component = DeviceArray<float>(device_.nodes());
  const std::size_t points = 3 * (2 * skin_.vertices() + landmarks_.vertices());
  skin_output_ = DeviceArray<float>(points);
  skin_staged_ = PinnedArray<float>(points);
  std::vector<std::uint32_t> still;
  for (const auto node : device_.still_nodes())
    still.push_back(device_.device_node()[node]);
  still_ = DeviceArray<std::uint32_t>(still);
  barrier_ = DeviceArray<std::uint32_t>(std::vector<std::uint32_t>(1, 0));
  // ordered with the default stream, so that events recorded there enclose this solver's work
  require(cudaStreamCreate(&stream_), "making a stream");
  const std::size_t controls = sizeof(double) * (2 * model_->muscles.size() + 12 * 64 * model_->bones.size() + 2);
  for (auto& slot : slots_)
  {
    slot.staged = PinnedArray<char>(controls);
    slot.controls = DeviceArray<char>(controls);
    slot.seen = PinnedArray<std::uint32_t>(1);
    slot.seen.data()[0] = 0;
    require(cudaEventCreateWithFlags(&slot.done, cudaEventDisableTiming), "making an event");
  }
  if (model_->muscles.size() > most_muscles)
    throw Error("backend cuda: " + std::to_string(model_->muscles.size()) + " muscles; allowed are " +
                std::to_string(most_muscles));
  const cuda::LaunchChoice choice = cuda::choose_launch(device_);
  launch_ = choice.launch;
  resident_ = choice.resident;
  rest();
}

CudaSolver::~CudaSolver()
{
  if (stream_ != nullptr)
    cudaStreamSynchronize(stream_);
  for (auto& slot : slots_)
    if (slot.done != nullptr)
      cudaEventDestroy(slot.done);
  if (stream_ != nullptr)
    cudaStreamDestroy(stream_);
}

void CudaSolver::upload_displacements(const Vectors* in, int buffer)
{
  std::vector<float4> u(device_.nodes(), float4{ 0, 0, 0, 0 });
  for (std::size_t n = 0; n < model_->nodes.size(); ++n)
  {
    const auto x = in == nullptr ? std::array<double, 3>{ { 0, 0, 0 } } : (*in)[n];
    u[device_.device_node()[n]] = { static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2]),
                                    static_cast<float>(1 / discretisation_.node_mass[n]) };
  }
  u_[buffer].upload(u.data(), u.size());
}

void CudaSolver::rest()
{
  synchronise();
  present_ = 0;
  plans_ = 0;
  still_moved_ = false;
  upload_displacements(nullptr, 0);
  require(cudaMemcpy(u_[1].data(), u_[0].data(), u_[0].bytes(), cudaMemcpyDeviceToDevice), "copying on the device");
  for (auto& component : v_)
    require(cudaMemset(component.data(), 0, component.bytes()), "clearing velocities");
  device_.reset_contacts();
  require(cudaDeviceSynchronize(), "coming to rest");
}

void CudaSolver::set_displacements(const Vectors& in)
{
  rest();
  upload_displacements(&in, present_);
  still_moved_ = true;
  displacements_were_set();
}

void CudaSolver::set_velocities(const Vectors& in)
{
  synchronise();
  std::vector<float> component(device_.nodes(), 0);
  for (int axis = 0; axis < 3; ++axis)
  {
    for (std::size_t n = 0; n < in.size(); ++n)
      component[device_.device_node()[n]] = static_cast<float>(in[n][axis]);
    for (const auto node : device_.still_nodes())
      component[device_.device_node()[node]] = 0;
    v_[axis].upload(component.data(), component.size());
  }
}

void CudaSolver::displacements(Vectors& out) const
{
  synchronise();
  download(u_[present_], out);
}

void CudaSolver::download(const DeviceArray<float4>& field, Vectors& out) const
{
  std::vector<float4> values;
  field.download(values);
  out.resize(model_->nodes.size());
  for (std::size_t n = 0; n < out.size(); ++n)
  {
    const float4& x = values[device_.device_node()[n]];
    out[n] = { { x.x, x.y, x.z } };
  }
}

void CudaSolver::velocities(Vectors& out) const
{
  synchronise();
  out.resize(model_->nodes.size());
  std::vector<float> component;
  for (int axis = 0; axis < 3; ++axis)
  {
    v_[axis].download(component);
    for (std::size_t n = 0; n < out.size(); ++n)
      out[n][axis] = component[device_.device_node()[n]];
  }
}

StepArguments CudaSolver::arguments(double dt) const
{
  StepArguments g = device_.arguments();
  for (int buffer = 0; buffer < 2; ++buffer)
    g.u[buffer] = u_[buffer].data();
  for (int axis = 0; axis < 3; ++axis)
  {
    g.v[axis] = v_[axis].data();
    g.impulse[axis] = static_cast<float>(gain(dt) * gravity_[axis]);
  }
  g.first = present_;
  g.dt = static_cast<float>(dt);
  g.dt_exact = dt;
  g.keep = static_cast<float>(keep(dt));
  g.gain = static_cast<float>(gain(dt));
  g.barrier = barrier_.data();
  return g;
}

// look (cleared), activations, poses: one copy through page-locked memory
void CudaSolver::stage(const StepPlan& plan, PlanSlot& slot, StepArguments& g)
{
  const std::size_t muscles = model_->muscles.size(), bones = model_->bones.size();
  const std::size_t poses_at = sizeof(double) * (1 + muscles);
  const std::size_t bytes = poses_at + sizeof(double) * 12 * plan.steps * bones;
  if (bytes > slot.staged.size())
  {
    slot.staged = PinnedArray<char>(bytes);
    slot.controls = DeviceArray<char>(bytes);
  }
  char* const staged = slot.staged.data();
  std::memset(staged, 0, sizeof(double));
  if (muscles > 0)
  {
    std::memcpy(staged + sizeof(double), plan.begin.activation.data(), muscles * sizeof(float));
    std::memcpy(staged + sizeof(double) + muscles * sizeof(float), plan.end.activation.data(), muscles * sizeof(float));
  }
  for (int step = 0; bones > 0 && step < plan.steps; ++step)
  {
    const Drive drive = plan.drive(step);
    for (std::size_t b = 0; b < bones; ++b)
    {
      char* const pose = staged + poses_at + sizeof(double) * 12 * (step * bones + b);
      std::memcpy(pose, drive.bone[b].rotation.data(), 9 * sizeof(double));
      std::memcpy(pose + 9 * sizeof(double), drive.bone[b].translation.data(), 3 * sizeof(double));
    }
  }
  require(cudaMemcpyAsync(slot.controls.data(), staged, bytes, cudaMemcpyHostToDevice, stream_), "copying controls");
  char* const controls = slot.controls.data();
  g.look = reinterpret_cast<std::uint32_t*>(controls);
  g.activation_begin = reinterpret_cast<const float*>(controls + sizeof(double));
  g.activation_end = g.activation_begin + muscles;
  g.poses = reinterpret_cast<const double*>(controls + poses_at);
}

void CudaSolver::step(StepArguments& g, int begin, int end)
{
  g.step_begin = begin;
  g.step_end = end;
  g.first = present_;
  g.barrier_base = barrier_base_;
  require(launch_steps(g, launch_, stream_), "launching steps");
  barrier_base_ += static_cast<std::uint32_t>((end - begin - 1) * launch_.blocks);
  present_ = (present_ + end - begin) & 1;
}

// long plans hide what stands between them, but the time step must follow what stiffens (half a millisecond is short
// enough), and contacts are renewed between plans
int CudaSolver::steps_a_plan() const
{
  return model_->sliding.empty() ? static_cast<int>(std::clamp(0.5e-3 / time_step(), 32.0, 128.0)) : 32;
}

double CudaSolver::run(const StepPlan& plan)
{
  PlanSlot& slot = slots_[plans_ % plan_slots];
  StepArguments g = arguments(plan.dt);
  g.time = plan.time;
  g.steps = plan.steps;
  stage(plan, slot, g);
  require(launch_renewals(g, stream_), "renewing contacts");
  int done = 0;
  if (still_moved_)
  {
    const int before = present_;
    device_.loads().update(u_[present_].data(), stream_);
    step(g, 0, 1);
    require(launch_hold(still_.data(), static_cast<std::uint32_t>(still_.size()), u_[before].data(), stream_),
            "holding still nodes");
    still_moved_ = false;
    done = 1;
  }
  if (resident_ && done < plan.steps)
    step(g, done, plan.steps);
  else
    for (; done < plan.steps; ++done)
    {
      device_.loads().update(u_[present_].data(), stream_);
      step(g, done, done + 1);
    }
  require(cudaMemcpyAsync(slot.seen.data(), g.look, sizeof(std::uint32_t), cudaMemcpyDeviceToHost, stream_),
          "copying the frequency bound");
  require(cudaEventRecord(slot.done, stream_), "recording an event");
  ++plans_;
  if (plans_ == 1)
    return 0;
  // the plan before, so that the device is never without work
  const PlanSlot& before = slots_[(plans_ - 2) % plan_slots];
  require(cudaEventSynchronize(before.done), "stepping");
  float squared = 0;
  std::memcpy(&squared, before.seen.data(), sizeof squared);
  return squared;
}

void CudaSolver::internal_forces(Vectors& out)
{
  synchronise();
  StepArguments g = arguments(0);
  const DeviceArray<float> activation(this->activation());
  g.activation_begin = g.activation_end = activation.data();
  g.steps = 1;
  g.forces_only = true;
  const DeviceArray<float4> forces(device_.nodes());
  require(cudaMemset(forces.data(), 0, forces.bytes()), "clearing forces");
  g.u[1 - present_] = forces.data();
  const int present = present_;
  step(g, 0, 1);
  present_ = present;
  synchronise();
  download(forces, out);
}

void CudaSolver::skin(SkinState& out)
{
  const float4* const u = u_[present_].data();
  const std::size_t vertices = skin_.vertices(), landmarks = landmarks_.vertices();
  float* const positions = skin_output_.data();
  require(launch_place(skin_.view(), u, positions, stream_), "placing the skin");
  require(launch_normals(skin_.view(), positions, positions + 3 * vertices, stream_), "normals of the skin");
  require(launch_place(landmarks_.view(), u, positions + 6 * vertices, stream_), "placing landmarks");
  require(cudaMemcpyAsync(skin_staged_.data(), positions, skin_output_.bytes(), cudaMemcpyDeviceToHost, stream_),
          "copying the skin");
  synchronise();
  const auto take = [](std::vector<std::array<float, 3>>& to, std::size_t count, const float* from)
  {
    to.resize(count);
    if (count > 0)
      std::memcpy(to.data(), from, count * sizeof(to[0]));
  };
  take(out.vertices, vertices, skin_staged_.data());
  take(out.normals, vertices, skin_staged_.data() + 3 * vertices);
  take(out.landmarks, landmarks, skin_staged_.data() + 6 * vertices);
}

std::string CudaSolver::description() const
{
  cudaDeviceProp device{};
  require(cudaGetDeviceProperties(&device, 0), "asking for the device");
  return std::string("cuda (float, ") + device.name + ", " + std::to_string(device_.strips()) + " strips of " +
         std::to_string(device_.rows()) + " rows, " + (resident_ ? "resident" : "a launch a step") + ")";
}

}  // namespace

std::string missing_cuda_device()
{
  int count = 0;
  const cudaError_t status = cudaGetDeviceCount(&count);
  if (status != cudaSuccess)
  {
    cudaGetLastError();
    return cudaGetErrorString(status);
  }
  return count > 0 ? std::string() : "no CUDA device found";
}

std::unique_ptr<Solver> make_cuda_solver(std::shared_ptr<const Model> model, const SolverSettings& settings)
{
  const std::string missing = missing_cuda_device();
  if (!missing.empty())
    throw Error("backend cuda: " + missing + "; allowed here are auto, reference, cpu");
  return std::make_unique<CudaSolver>(std::move(model), settings);
}

}  // namespace frontalis
