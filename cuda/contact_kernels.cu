#include "bone_pose.cuh"
#include "node_tasks.cuh"

namespace frontalis
{
namespace cuda
{

// A closest point takes a thread some hundred microseconds: planes are found a plan ahead, beside the steps, for nodes
// that would want another before the next plan ends. Until it is there the old one serves, up to its limit.

constexpr int block = 64;
static_assert(search_group == 32, "a warp shares out the searches of a group");

// goes on with what the search ahead knows of the surface
template <class Contact>
static __device__ void take_over(const StepArguments& g, Contact& s)
{
  g.searching[s.search].stay_on(s.contact);
  s.contact = g.searching[s.search];
}

// Whether the node wants a plane ahead.
static __device__ bool renew_sliding(const StepArguments& g, std::uint32_t index)
{
  SlidingContact& s = g.sliding[index];
  const std::uint32_t node = s.node;
  const float4 now = g.u[g.first][node];
  const float u[3] = { now.x, now.y, now.z };
  float v[3] = { g.v[0][node], g.v[1][node], g.v[2][node] };
  const TangentPlane found = g.planes_ahead[index];
  bool changed = false;
  if (found.reference.w >= 0 && !s.renewed)
  {
    take_over(g, s);
    turn(g.contact_planes[index].normal_offset, found.normal_offset, v);
    g.contact_planes[index] = found;
    s.serves = s.serves_ahead;
    changed = true;
  }
  const float4 reference = g.contact_planes[index].reference;
  // where it will be after so many seconds if it goes on as it does, and may be with a share of its speed more
  const float plan = g.steps * g.dt;
  const auto reached = [&](float seconds, float more)
  {
    const float then[3] = { u[0] + seconds * v[0], u[1] + seconds * v[1], u[2] + seconds * v[2] };
    const float further = more * seconds * sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const float far = sqrtf(fmaxf(slip_squared(reference, then), slip_squared(reference, u))) + further;
    return far * far;
  };
  bool asks = false;
  if (reference.w < 0 || reached(plan, 0.1f) > reference.w)
  {
    renew_contact(g, static_cast<std::int32_t>(index), u, v);
    changed = true;
  }
  else
    asks = reached(2 * plan, 0.5f) > s.serves || slip_squared(reference, u) > 0.5f * s.serves;
  s.renewed = false;
  // where it will be halfway through the next plan
  g.planes_ahead[index].reference =
      make_float4(u[0] + 1.5f * plan * v[0], u[1] + 1.5f * plan * v[1], u[2] + 1.5f * plan * v[2], nothing_ahead);
  if (changed)
    for (int i = 0; i < 3; ++i)
      g.v[i][node] = v[i];
  return asks;
}

template <class Frame>
static __device__ __forceinline__ bool renew_gliding(const StepArguments& g, std::uint32_t index, const Frame& now,
                                                     const Frame& then)
{
  using Point = SurfaceContact::Point;
  GlidingContact& s = g.gliding[index];
  GlidingSearch& search = g.gliding_searches[index];
  const float4 u = g.u[g.first][search.node];
  const Point at = Point{ s.rest[0], s.rest[1], s.rest[2] } + Point{ u.x, u.y, u.z };
  const Point v{ g.v[0][search.node], g.v[1][search.node], g.v[2][search.node] };
  const Point p = now.inwards(at), way = then.inwards(at + (g.steps * g.dt_exact) * v) - p;
  if (search.state >= 0 && !search.renewed)
  {
    take_over(g, search);
    s.plane = search.found;
    s.reference = search.ahead;
  }
  const double slipped = norm(p - s.reference), speed = norm(way);
  const auto reached = [&](double plans, double more)
  { return fmax(norm(p + plans * way - s.reference), slipped) + more * plans * speed; };
  search.state = nothing_ahead;
  bool asks = false;
  if (s.plane.slip < 0 || reached(1, 0.1) > s.plane.limit)
  {
    s.plane = search.contact.renew<true>(p);
    s.reference = p;
  }
  else
    asks = reached(2, 0.5) > s.plane.slip || slipped * slipped > 0.5 * s.plane.slip * s.plane.slip;
  search.renewed = false;
  search.ahead = p + 1.5 * way;
  return asks;
}

__global__ void __launch_bounds__(block) renew_contacts(const __grid_constant__ StepArguments g)
{
  const std::uint32_t index = blockIdx.x * block + threadIdx.x, gliding = index - g.sliding_count;
  bool asks = false;
  if (index < g.sliding_count)
    asks = renew_sliding(g, index);
  else if (gliding < g.gliding_count)
  {
    const std::int32_t bone = g.gliding[gliding].bone;
    asks = bone < 0 ? renew_gliding(g, gliding, Still(), Still())
                    : renew_gliding(g, gliding, pose_at(g, 0, bone), pose_at(g, g.steps, bone));
  }
  // all that was found before is taken over first
  __syncwarp();
  const std::uint32_t asking = __ballot_sync(0xffffffffu, asks), lane = threadIdx.x % search_group;
  const std::uint32_t place = __popc(asking & ((1u << lane) - 1));
  if (!asks || place >= g.searches)
    return;
  const std::uint32_t search = index / search_group * g.searches + place;
  if (index < g.sliding_count)
  {
    g.sliding[index].search = static_cast<std::int32_t>(search);
    g.planes_ahead[index].reference.w = wanted_ahead;
    g.searching[search] = g.sliding[index].contact;
  }
  else
  {
    g.gliding_searches[gliding].search = static_cast<std::int32_t>(search);
    g.gliding_searches[gliding].state = wanted_ahead;
    g.searching[search] = g.gliding_searches[gliding].contact;
  }
}

// one warp a block, and registers that a patch leaves
constexpr int block_ahead = 32;

__global__ void __launch_bounds__(block_ahead, 16) renew_ahead(const __grid_constant__ StepArguments g)
{
  __shared__ std::uint32_t listed[2 * block_ahead];
  std::uint32_t count = 0;
  const auto find = [&](std::uint32_t index)
  {
    if (index >= g.sliding_count)
    {
      GlidingSearch& search = g.gliding_searches[index - g.sliding_count];
      search.found = g.searching[search.search].renew<true>(search.ahead);
      search.state = 0;
      return;
    }
    const float4 at = g.planes_ahead[index].reference;
    const float u[3] = { at.x, at.y, at.z };
    SlidingContact& s = g.sliding[index];
    g.planes_ahead[index] = contact_plane(s, g.searching[s.search], u, s.serves_ahead);
  };
  const std::uint32_t all = g.sliding_count + g.gliding_count;
  const auto state = [&](std::uint32_t index)
  {
    return index < g.sliding_count ? g.planes_ahead[index].reference.w
                                   : g.gliding_searches[index - g.sliding_count].state;
  };
  // those that ask are few: they are listed first, so that all lanes work at once
  for (std::uint32_t first = blockIdx.x * block_ahead; first < all; first += gridDim.x * block_ahead)
  {
    const std::uint32_t index = first + threadIdx.x;
    const bool asks = index < all && state(index) == wanted_ahead;
    const std::uint32_t asking = __ballot_sync(0xffffffffu, asks);
    if (asks)
      listed[count + __popc(asking & ((1u << threadIdx.x) - 1))] = index;
    count += __popc(asking);
    __syncwarp();
    if (count >= block_ahead)
    {
      count -= block_ahead;
      find(listed[count + threadIdx.x]);
    }
    __syncwarp();
  }
  if (threadIdx.x < count)
    find(listed[threadIdx.x]);
}

}  // namespace cuda

cudaError_t launch_renewals(const StepArguments& arguments, cudaStream_t stream)
{
  const std::uint32_t all = arguments.sliding_count + arguments.gliding_count;
  if (all > 0)
    cuda::renew_contacts<<<(all + cuda::block - 1) / cuda::block, cuda::block, 0, stream>>>(arguments);
  return cudaGetLastError();
}

cudaError_t launch_renewals_ahead(const StepArguments& arguments, cudaStream_t stream)
{
  // about one block a multiprocessor
  const std::uint32_t all =
      (arguments.sliding_count + arguments.gliding_count + cuda::block_ahead - 1) / cuda::block_ahead;
  const std::uint32_t blocks = all > 132 ? 132 : all;
  if (blocks > 0)
    cuda::renew_ahead<<<blocks, cuda::block_ahead, 0, stream>>>(arguments);
  return cudaGetLastError();
}

}  // namespace frontalis
