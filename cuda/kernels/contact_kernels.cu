#include "cuda/kernels/sliding_nodes.cuh"

namespace frontalis
{
namespace cuda
{

// In models that run as strips, tangent planes are searched for one plan ahead, beside the steps, for nodes that will
// need another plane before the next plan ends. Until the search is done, a node uses its old plane as long as that is
// valid. Patches find their planes within a launch (plane_queue.cuh).

constexpr int block = 64;
static_assert(search_group == 32, "a warp shares out the searches of a group");

// The planes that a node needs before a plan starts.
struct Wish
{
  bool now = false;
  bool ahead = false;
  SurfaceContact* contact = nullptr;
  SurfaceContact::Point here{ 0, 0, 0 };
  SurfaceContact::Point at{ 0, 0, 0 };  ///< where to search for the plane that is needed now
};

// Takes over the contact state of the search ahead.
template <class Contact>
static __device__ void take_over(const StepArguments& g, Contact& s)
{
  g.searching[s.search].stay_on(s.contact);
  s.contact = g.searching[s.search];
}

// Planes are found where nodes are predicted to be. A plane that was found ahead is taken only if it is needed, because
// each change of plane disturbs a node that vibrates about its equilibrium.

static __device__ Wish look_at_sliding(const StepArguments& g, std::uint32_t index, float (&v)[3])
{
  SlidingContact& s = g.sliding[index];
  const float4 now = g.u[g.first][s.node];
  const float u[3] = { now.x, now.y, now.z };
  for (int i = 0; i < 3; ++i)
    v[i] = g.v[i][s.node];
  const float plan = g.steps * g.dt, goes = plan * sqrtf(squared(v));
  TangentPlane plane = g.contact_planes[index];
  // Squared distance from the plane's reference after `plans` plans, if the speed grows by the fraction `more`.
  const auto reached = [&](float plans, float more)
  {
    const float seconds = plans * plan;
    const float then[3] = { u[0] + seconds * v[0], u[1] + seconds * v[1], u[2] + seconds * v[2] };
    const float far = sqrtf(fmaxf(slip_squared(plane.reference, then), slip_squared(plane.reference, u)));
    return (far + more * plans * goes) * (far + more * plans * goes);
  };
  const TangentPlane found = g.planes_ahead[index];
  const bool from_plan_to_plan = g.searches > 0;
  if (from_plan_to_plan && slip_squared(found.reference, u) <= found.reference.w &&
      (slip_squared(plane.reference, u) > s.serves || reached(1, 0.1f) > plane.reference.w))
  {
    take_over(g, s);
    change_plane<of_nodes>(g, static_cast<std::int32_t>(index), found, v);
    plane = found;
    s.serves = s.serves_ahead;
  }
  const bool first = plane.reference.w < 0;
  if (first)
    s.contact.forget();
  Wish wish;
  wish.now = slip_squared(plane.reference, u) > plane.reference.w;
  wish.ahead = !first && (reached(1, 0.1f) > s.serves || reached(2, 0.05f) > plane.reference.w);
  wish.contact = &s.contact;
  const float before = plan * share_before(goes, plane.reference.w);
  const float at[3] = { u[0] + before * v[0], u[1] + before * v[1], u[2] + before * v[2] };
  wish.here = place_of(s, u);
  wish.at = place_of(s, at);
  if (from_plan_to_plan)
    g.planes_ahead[index].reference =
        make_float4(at[0] + plan * v[0], at[1] + plan * v[1], at[2] + plan * v[2], nothing_ahead);
  return wish;
}

static __device__ __forceinline__ Wish look_at_gliding(const StepArguments& g, std::uint32_t index, const Pose& now,
                                                       const Pose& then)
{
  using Point = SurfaceContact::Point;
  GlidingContact& s = g.gliding[index];
  GlidingSearch& search = g.gliding_searches[index];
  const float4 u = g.u[g.first][search.node];
  const Point at = Point{ s.rest[0], s.rest[1], s.rest[2] } + Point{ u.x, u.y, u.z };
  const Point v{ g.v[0][search.node], g.v[1][search.node], g.v[2][search.node] };
  const Point p = now.inwards(at), way = then.inwards(at + (g.steps * g.dt_exact) * v) - p;
  const auto reached = [&](double plans, double more)
  { return fmax(norm(p + plans * way - s.reference), norm(p - s.reference)) + more * plans * norm(way); };
  const bool from_plan_to_plan = g.searches > 0;
  if (from_plan_to_plan && search.state >= 0 && norm(p - search.ahead) <= search.found.limit &&
      (norm(p - s.reference) > s.plane.slip || reached(1, 0.1) > s.plane.limit))
  {
    take_over(g, search);
    s.plane = search.found;
    s.reference = search.ahead;
  }
  const auto limit = static_cast<float>(fmax(s.plane.limit, 0.0));
  Wish wish;
  wish.now = norm(p - s.reference) > s.plane.limit;
  wish.ahead = s.plane.limit >= 0 && (reached(1, 0.1) > s.plane.slip || reached(2, 0.05) > s.plane.limit);
  wish.contact = &search.contact;
  wish.here = p;
  wish.at = p + double(share_before(static_cast<float>(norm(way)), limit * limit)) * way;
  if (from_plan_to_plan)
  {
    search.state = nothing_ahead;
    search.ahead = wish.at + way;
  }
  return wish;
}

__global__ void __launch_bounds__(block) renew_contacts(const __grid_constant__ StepArguments g)
{
  const std::uint32_t index = blockIdx.x * block + threadIdx.x, gliding = index - g.sliding_count;
  const bool slides = index < g.sliding_count, glides = !slides && gliding < g.gliding_count;
  float v[3] = {};
  Wish wish;
  if (slides)
    wish = look_at_sliding(g, index, v);
  else if (glides)
  {
    const std::int32_t bone = g.gliding[gliding].bone;
    wish = look_at_gliding(g, gliding, pose_at(g, 0, bone), pose_at(g, g.steps, bone));
  }
  const ContactPlane plane = find_before<block / 32>(wish.now, wish.contact, wish.here, wish.at);
  if (slides)
  {
    if (wish.now)
      put_on<of_nodes>(g, static_cast<std::int32_t>(index), plane, wish.at, v);
    for (int i = 0; i < 3; ++i)
      g.v[i][g.sliding[index].node] = v[i];
  }
  else if (glides && wish.now)
  {
    g.gliding[gliding].plane = plane;
    g.gliding[gliding].reference = wish.at;
  }
  // all planes found earlier are taken over before new searches are set up
  __syncwarp();
  const std::uint32_t asking = __ballot_sync(whole_warp, wish.ahead);
  const std::uint32_t place = __popc(asking & ((1u << (threadIdx.x & 31)) - 1));
  if (!wish.ahead || place >= g.searches)
    return;
  const std::uint32_t search = index / search_group * g.searches + place;
  g.searching[search] = *wish.contact;
  if (slides)
  {
    g.sliding[index].search = static_cast<std::int32_t>(search);
    g.planes_ahead[index].reference.w = wanted_ahead;
  }
  else
  {
    g.gliding_searches[gliding].search = static_cast<std::int32_t>(search);
    g.gliding_searches[gliding].state = wanted_ahead;
  }
}

// 16 blocks per multiprocessor, in the registers that a patch leaves free
__global__ void __launch_bounds__(32, 16) renew_ahead(const __grid_constant__ StepArguments g)
{
  const std::uint32_t all = g.sliding_count + g.gliding_count;
  for (std::uint32_t first = blockIdx.x * 32; first < all; first += gridDim.x * 32)
  {
    const std::uint32_t index = first + threadIdx.x, gliding = index - g.sliding_count;
    const bool slides = index < g.sliding_count;
    bool asks = false;
    SurfaceContact* contact = nullptr;
    SurfaceContact::Point at{ 0, 0, 0 };
    if (slides && g.planes_ahead[index].reference.w == wanted_ahead)
    {
      const float4 place = g.planes_ahead[index].reference;
      const float u[3] = { place.x, place.y, place.z };
      asks = true;
      contact = &g.searching[g.sliding[index].search];
      at = place_of(g.sliding[index], u);
    }
    else if (!slides && gliding < g.gliding_count && g.gliding_searches[gliding].state == wanted_ahead)
    {
      asks = true;
      contact = &g.searching[g.gliding_searches[gliding].search];
      at = g.gliding_searches[gliding].ahead;
    }
    const ContactPlane plane = find_together<1>(asks, contact, at);
    if (!asks)
      continue;
    if (slides)
      g.planes_ahead[index] = tangent_plane(g.sliding[index], plane, at, g.sliding[index].serves_ahead);
    else
    {
      g.gliding_searches[gliding].found = plane;
      g.gliding_searches[gliding].state = 0;
    }
  }
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
  // about one block per multiprocessor
  const std::uint32_t all = (arguments.sliding_count + arguments.gliding_count + 32 - 1) / 32;
  const std::uint32_t blocks = all > 132 ? 132 : all;
  if (blocks > 0)
    cuda::renew_ahead<<<blocks, 32, 0, stream>>>(arguments);
  return cudaGetLastError();
}

}  // namespace frontalis
