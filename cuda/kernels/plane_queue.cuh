#pragma once

#include "cuda/kernels/node_tasks.cuh"

namespace frontalis
{
namespace cuda
{

// If a model has sliding nodes, the last warp of a patch's block takes no part in its steps but searches for tangent
// planes. A node that would leave its plane StepArguments::lead later requests another one and continues, so that the
// plane is ready when the node needs it. Each node waits for at most one plane, so a queue with one place per node
// never overflows. The result depends only on the requested position, because the whole warp works on each search.

/// Value of an empty place in a queue.
constexpr std::int32_t nobody = -0x7fffffff;

/// Pauses between two polls by waiting threads [ns].
constexpr unsigned long_sleep = 400, short_sleep = 50;

/// The queue of a block in shared memory. All accesses are atomic.
struct PlaneQueue
{
  std::int32_t* done;     // nonzero when all steps are done
  std::uint32_t* asked;   // number of requests so far
  std::int32_t* contact;  // ring of contacts, numbered as for find_others()
  std::uint32_t size;

  __device__ __forceinline__ std::int32_t* place(std::uint32_t index) const { return contact + index % size; }
};

__device__ __forceinline__ PlaneQueue plane_queue(std::int32_t* memory, std::uint32_t size)
{
  return { memory, reinterpret_cast<std::uint32_t*>(memory + 1), memory + 2, size };
}

__device__ __forceinline__ void clear(const PlaneQueue& queue)
{
  for (std::uint32_t i = threadIdx.x; i < queue.size; i += blockDim.x)
    queue.contact[i] = nobody;
  if (threadIdx.x == 0)
  {
    *queue.done = 0;
    *queue.asked = 0;
  }
}

// State of the plane that a contact requested: nothing_ahead, wanted_ahead, or any other value if it is ready. It is
// written last and read first, because the warps have no other synchronisation.
__device__ __forceinline__ float* state_of(const StepArguments& g, std::int32_t contact)
{
  return contact >= 0 ? &g.planes_ahead[contact].reference.w : &g.gliding_searches[-1 - contact].state;
}
__device__ __forceinline__ float seen(const float* state)
{
  float value;
  asm volatile("ld.relaxed.cta.global.f32 %0, [%1];" : "=f"(value) : "l"(state) : "memory");
  __threadfence_block();
  return value;
}
__device__ __forceinline__ void show(float* state, float value)
{
  __threadfence_block();
  asm volatile("st.relaxed.cta.global.f32 [%0], %1;" ::"l"(state), "f"(value) : "memory");
}

/// Requests a plane for a node that does not wait for one yet.
__device__ __forceinline__ void ask(const StepArguments& g, const PlaneQueue& queue, std::int32_t contact,
                                    const float (&u)[3], const float (&v)[3])
{
  // the position was stored by glide(), or else:
  if (contact >= 0)
  {
    const float seconds = g.dt + g.lead + time_before(g, v, g.contact_planes[contact].reference.w);
    g.planes_ahead[contact].reference =
        make_float4(u[0] + seconds * v[0], u[1] + seconds * v[1], u[2] + seconds * v[2], nothing_ahead);
  }
  show(state_of(g, contact), wanted_ahead);
  __threadfence_block();
  atomicExch(queue.place(atomicAdd(queue.asked, 1)), contact);
}

// Finds the requested plane. A whole warp calls it.
static __device__ __forceinline__ void find_asked(const StepArguments& g, std::int32_t contact)
{
  using Team = Warp<most_patch_threads / 32>;
  SurfaceContact* on = nullptr;
  SurfaceContact::Point at;
  if (contact >= 0)
  {
    const float4 place = g.planes_ahead[contact].reference;
    const float u[3] = { place.x, place.y, place.z };
    on = &g.sliding[contact].contact;
    at = place_of(g.sliding[contact], u);
  }
  else
  {
    on = &g.gliding_searches[-1 - contact].contact;
    at = g.gliding_searches[-1 - contact].ahead;
  }
  const ContactPlane plane = on->renew<true, Team>(at);
  // One lane publishes what all lanes wrote to the contact.
  __syncwarp();
  if (Team::rank() == 0)
  {
    float state = 0;
    if (contact >= 0)
    {
      float serves = 0;
      TangentPlane found = tangent_plane(g.sliding[contact], plane, at, serves);
      state = found.reference.w;
      found.reference.w = wanted_ahead;
      g.planes_ahead[contact] = found;
    }
    else
      g.gliding_searches[-1 - contact].found = plane;
    show(state_of(g, contact), state);
  }
  __syncwarp();
}

/// Loop of the warp that finds planes, until all steps are done.
static __device__ __noinline__ void find_planes(const StepArguments& g, const PlaneQueue& queue)
{
  for (std::uint32_t next = 0;; ++next)
  {
    std::int32_t contact = nobody;
    if ((threadIdx.x & 31) == 0)
      for (bool done = false; !done && contact == nobody;)
      {
        done = atomicOr(queue.done, 0) != 0;
        // makes all requests visible that were made before the last step ended
        __threadfence_block();
        contact = atomicExch(queue.place(next), nobody);
        if (!done && contact == nobody)
          __nanosleep(long_sleep);
      }
    contact = __shfl_sync(whole_warp, contact, 0);
    if (contact == nobody)
      return;
    __threadfence_block();
    __syncwarp();
    find_asked(g, contact);
  }
}

/// Waits for the plane that a node requested and applies it if it is valid one step later. Returns whether it is.
template <Effects With>
__device__ __forceinline__ bool take_asked(const StepArguments& g, std::int32_t contact, const float (&u)[3],
                                           float (&v)[3])
{
  float* const state = state_of(g, contact);
  float known = seen(state);
  while (known == wanted_ahead)
  {
    __nanosleep(short_sleep);
    known = seen(state);
  }
  bool serves = false;
  if (known != nothing_ahead && contact >= 0)
  {
    const TangentPlane found = g.planes_ahead[contact];
    const float next[3] = { u[0] + g.dt * v[0], u[1] + g.dt * v[1], u[2] + g.dt * v[2] };
    serves = slip_squared(found.reference, next) <= found.reference.w;
    if (serves)
      change_plane<With>(g, contact, found, v);
  }
  else if (known != nothing_ahead)
  {
    GlidingContact& s = g.gliding[-1 - contact];
    const GlidingSearch& search = g.gliding_searches[-1 - contact];
    serves = norm(s.reference - search.ahead) <= search.found.limit;
    if (serves)
    {
      s.plane = search.found;
      s.reference = search.ahead;
    }
  }
  show(state, nothing_ahead);
  return serves;
}

}  // namespace cuda
}  // namespace frontalis
