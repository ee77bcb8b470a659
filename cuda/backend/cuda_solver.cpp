#include "cuda/backend/cuda_solver.hpp"

#include "cuda/backend/contact_point.hpp"
#include "cuda/backend/device_code.hpp"
#include "cuda/backend/highest_frequency.hpp"
#include "cuda/backend/launch_choice.hpp"
#include "frontalis/solver/backend.hpp"
#include "solver/skin/film_vertices.hpp"
#include "solver/stepping/effect_switches.hpp"
#include "solver/stepping/time_stepper.hpp"

#include <fmt/format.h>

#include <cstring>

namespace frontalis
{
namespace cuda
{

CudaSolver::CudaSolver(const BackendInput& input, const std::string& remark)
    : StepBackend(input),
      remark_(remark.empty() ? "" : "; " + remark),
      device_(*model_, discretisation_, choose_cut(*model_, effects_of(*model_, discretisation_, true))),
      skin_(*model_, device_.device_node(), model_->skin.vertices, model_->skin_binding, model_->skin.triangles),
      landmarks_(*model_, device_.device_node(), model_->landmark_positions, model_->landmark_binding, {})
{
  launch_ = choose_launch(device_);
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
  // The stream synchronises with the default stream, so that events recorded there enclose this solver's work.
  require(cudaStreamCreate(&stream_), "making a stream");
  // Room for what stage() writes for the longest plan.
  const std::size_t of_body = pose_entries + 2 * 3 + 1, steps = most_steps_per_plan + 1;
  const std::size_t of_step = bone_motion_entries * model_->bones.size() + of_body * model_->contacts.size() + 1;
  const std::size_t controls = sizeof(float) * (plan_measures + 2 + 2 * model_->muscles.size() + steps * of_step);
  for (auto& slot : slots_)
  {
    slot.staged = PinnedArray<char>(controls);
    slot.controls = DeviceArray<char>(controls);
    slot.seen = PinnedArray<std::uint32_t>(plan_measures);
    std::fill_n(slot.seen.data(), plan_measures, 0u);
    require(cudaEventCreateWithFlags(&slot.done, cudaEventDisableTiming), "making an event");
  }
  if (input.settings.ledger)
  {
    account_ = std::make_unique<DeviceAccount>(*model_, device_);
    device_.viscosity().keep_account();
  }
  device_monitor();  // the guard needs it, and memory must not run out later
  rest();
  // as after each change of masses, so that equal masses have equal bits
  device_.take_masses(u_[0].data(), stream_);
  // The first search takes as long as some hundred steps, which should not be the first ones. Its result is not used.
  if (model_->time_step_estimate == TimeStepEstimate::assembled)
    highest_frequency_squared();
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

void CudaSolver::upload_displacements(const NodalVectors& in, DeviceArray<float4>& to) const
{
  std::vector<float4> u(device_.nodes(), float4{ 0, 0, 0, 0 });
  for (std::size_t n = 0; n < model_->nodes.size(); ++n)
  {
    const auto x = in.empty() ? std::array<double, 3>{ { 0, 0, 0 } } : in[n];
    u[device_.device_node()[n]] = { static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2]),
                                    static_cast<float>(1 / discretisation_.node_mass[n]) };
  }
  for (const auto node : device_.still_nodes())
    u[device_.device_node()[node]].w = 0;
  to.upload(u.data(), u.size());
}

void CudaSolver::rest()
{
  synchronise();
  present_ = 0;
  plans_ = 0;
  still_moved_ = false;
  upload_displacements({}, u_[0]);
  require(cudaMemcpy(u_[1].data(), u_[0].data(), u_[0].bytes(), cudaMemcpyDeviceToDevice), "copying on the device");
  for (auto& component : v_)
    component.clear();
  device_.reset();
  require(cudaDeviceSynchronize(), "coming to rest");
}

void CudaSolver::effects_switched()
{
  synchronise();
  device_.run(*model_, discretisation_, conditions_.running);
  launch_ = choose_launch(device_);
  // The frequency bounds of earlier plans belong to the previous set of effects and must not be used.
  plans_ = 0;
}

void CudaSolver::list_arrays(ArrayList& list)
{
  device_.list_arrays(effect_of_fibres(*model_), list);
  for (const auto& u : u_)
    list.add(Effect::elasticity, "motion", u.bytes());
  list.add_state(u_[present_].data(), u_[present_].bytes());
  for (const auto& v : v_)
    list_state(list, Effect::elasticity, "motion", v);
  list.add(Effect::elasticity, "skin", skin_.bytes() + landmarks_.bytes() + skin_output_.bytes());
  list.add(Effect::rigid_nodes, "still nodes", still_.bytes());
  list.add(Effect::elasticity, "controls", activation_.bytes());
  for (const auto& slot : slots_)
    list.add(Effect::elasticity, "controls", slot.controls.bytes());
  // What the latest plan measured limits the steps of later plans and thus belongs to the state.
  list.add_state(slots_[(plans_ + plan_slots - 1) % plan_slots].seen.data(), plan_measures * sizeof(std::uint32_t));
  if (account_)
    account_->list_arrays(effect_of_fibres(*model_), list);
  if (monitor_)
    list.add(Effect::elasticity, "what the monitor looks at", monitor_->bytes());
  if (search_)
    list.add(Effect::elasticity, "search for the highest frequency", search_->bytes());
}

void CudaSolver::set(NodalField field, const NodalVectors& in)
{
  if (field == NodalField::displacements)
  {
    rest();
    if (in.empty())
      return;
    upload_displacements(in, u_[present_]);
    still_moved_ = true;
    return;
  }
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

void CudaSolver::download(const DeviceArray<float4>& field, NodalVectors& out) const
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

void CudaSolver::get(NodalField field, NodalVectors& out) const
{
  synchronise();
  if (field == NodalField::displacements)
    return download(u_[present_], out);
  out.resize(model_->nodes.size());
  std::vector<float> component;
  for (int axis = 0; axis < 3; ++axis)
  {
    v_[axis].download(component);
    for (std::size_t n = 0; n < out.size(); ++n)
      out[n][axis] = component[device_.device_node()[n]];
  }
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
  if (!model_->film.parents.empty())
    place_film_vertices(*model_, out);
}

// Plans of 64 steps, or of 0.5 ms with short steps, are long enough to hide the host's work between them, and short
// enough for the time step to follow tissue that stiffens. Tissue may touch itself where a search before the plan has
// not looked; such plans are shorter. The guard's checks and dynamic relaxation have to wait for the device and are
// therefore rare.
BackendTraits CudaSolver::traits() const
{
  cudaDeviceProp device{};
  require(cudaGetDeviceProperties(&device, 0), "asking for the device");
  const std::string cut = launch_.patches
                              ? fmt::format("{} patches", device_.patches())
                              : fmt::format("{} strips, {:.0f} % filled", device_.strips(), 100 * device_.filled());
  BackendTraits traits;
  traits.description = fmt::format("cuda (float, {}, {}{})", device.name, cut, remark_);
  traits.seconds_per_plan = 0.5e-3;
  traits.fewest_steps_per_plan = model_->self_contacts.empty() ? 64 : 32;
  traits.most_steps_per_plan = most_steps_per_plan;
  traits.steps_per_observation = model_->nodes.size() > 1000000 ? 2048 : 512;
  traits.steps_per_check = 2048;
  return traits;
}

}  // namespace cuda

namespace
{

std::string missing_device()
{
  int count = 0, driver = 0;
  if (cudaDriverGetVersion(&driver) == cudaSuccess && driver == 0)
    return "no NVIDIA driver is installed";
  const cudaError_t found = cudaGetDeviceCount(&count);
  const cudaError_t usable = found == cudaSuccess && count > 0 ? cuda::has_device_code() : found;
  cudaGetLastError();
  if (found != cudaSuccess)
    return cudaGetErrorString(found);
  if (count == 0)
    return "no CUDA device found";
  if (usable == cudaSuccess)
    return {};
  cudaDeviceProp device{};
  if (cudaGetDeviceProperties(&device, 0) != cudaSuccess)
    return cudaGetErrorString(usable);
  return fmt::format("this build has no code for {} of compute capability {}.{} ({})", device.name, device.major,
                     device.minor, cudaGetErrorString(usable));
}

std::unique_ptr<Solver> make_cuda_solver(std::shared_ptr<const Model> model, const SolverSettings& settings,
                                         const std::string& remark)
{
  if (model->muscles.size() > most_muscles)
    throw BackendUnavailable(
        fmt::format("backend cuda: {} muscles; allowed are {}", model->muscles.size(), most_muscles));
  const auto make = [&](const BackendInput& input)
  {
    try
    {
      return std::make_unique<cuda::CudaSolver>(input, remark);
    }
    catch (const cuda::DeviceFault& fault)
    {
      throw BackendUnavailable(fault.what());  // another backend may do
    }
  };
  return std::make_unique<TimeStepper>(std::move(model), settings, make);
}

}  // namespace

BackendDescription cuda_backend() { return { "cuda", make_cuda_solver, missing_device }; }

}  // namespace frontalis
