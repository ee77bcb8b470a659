#include "cuda/backend/cuda_solver.hpp"

namespace frontalis
{
namespace cuda
{

// A copy of the state: the state arrays one after the other in device memory, and the part of the state on the host.
struct CudaSolver::State : BackendState
{
  cudaStream_t stream = nullptr;  // stream on which the copy is queued
  DeviceArray<char> bytes;
  struct
  {
    std::int64_t plans = 0;
    bool still_moved = false;
  } host;

  void archive(ByteArchive& archive) override
  {
    require(cudaStreamSynchronize(stream), "waiting for a snapshot");
    const std::size_t size = bytes.size();
    archive(host.plans)(host.still_moved);
    std::vector<char> values;
    if (!archive.reads())
      bytes.download(values);
    archive(values);
    if (values.size() != size)
      throw Error("a state of " + std::to_string(values.size()) + " bytes; allowed are " + std::to_string(size));
    if (archive.reads())
      bytes = DeviceArray<char>(values);
  }
};

// Copies between the state arrays, some of which are in host memory, and `state`. `back`: from `state` to the arrays.
void CudaSolver::copy_state(const State& state, bool back)
{
  ArrayList list;
  list_arrays(list);
  char* at = state.bytes.data();
  for (const auto& array : list.state())
  {
    require(cudaMemcpyAsync(back ? array.data : at, back ? at : array.data, array.bytes, cudaMemcpyDefault, stream_),
            "copying the state");
    at += array.bytes;
  }
}

void CudaSolver::save(std::unique_ptr<BackendState>& to)
{
  if (!to)
    to = std::make_unique<State>();
  auto& state = static_cast<State&>(*to);
  ArrayList list;
  list_arrays(list);
  if (state.bytes.size() != list.state_bytes())
    state.bytes = DeviceArray<char>(list.state_bytes());
  state.stream = stream_;
  state.host = { plans_, still_moved_ };
  copy_state(state, false);
}

void CudaSolver::restore(const BackendState& from)
{
  const auto& state = static_cast<const State&>(from);
  plans_ = state.host.plans;
  still_moved_ = state.host.still_moved;
  copy_state(state, true);
  // The host reads the frequency bound, so its copy must be complete.
  synchronise();
}

}  // namespace cuda
}  // namespace frontalis
