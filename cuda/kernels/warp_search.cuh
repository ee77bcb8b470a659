#pragma once

#include "solver/contact/surface_contact.hpp"

#include <cstdint>
#include <cstring>

namespace frontalis
{
namespace cuda
{

// Closest-point searches by a whole warp, in which each lane tests one nearby triangle or one box of the tree. Most of
// a search is memory latency, so a warp takes a few microseconds and a single thread over a hundred.

constexpr unsigned whole_warp = 0xffffffffu;

/// The largest value among the lanes of a warp. GPUs below compute capability 8.0 have no instruction for it.
template <class T>
__device__ __forceinline__ T largest_of_warp(T value)
{
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
  return __reduce_max_sync(whole_warp, value);
#else
  for (int apart = 16; apart > 0; apart /= 2)
    value = max(value, __shfl_xor_sync(whole_warp, value, apart));
  return value;
#endif
}

/// A whole warp as the team of SurfaceContact::renew, in a block of at most `Warps` warps. All lanes call its
/// functions.
template <int Warps>
struct Warp
{
  static constexpr int size = 32;
  static __device__ __forceinline__ int rank() { return threadIdx.x % size; }

  template <class T>
  static __device__ __forceinline__ T from(int lane, const T& value)
  {
    static_assert(sizeof(T) % 4 == 0, "goes word by word");
    std::uint32_t words[sizeof(T) / 4];
    std::memcpy(words, &value, sizeof(T));
    for (auto& word : words)
      word = __shfl_sync(whole_warp, word, lane);
    T there;
    std::memcpy(&there, words, sizeof(T));
    return there;
  }

  static __device__ __forceinline__ double least(double x)
  {
    for (int apart = size / 2; apart > 0; apart /= 2)
      x = fmin(x, __shfl_xor_sync(whole_warp, x, apart));
    return x;
  }

  template <class T>
  static __device__ __forceinline__ T of_least(double key, const T& value)
  {
    const T there = from(__ffs(__ballot_sync(whole_warp, key == least(key))) - 1, value);
    // lanes that continue may overwrite what others still read
    __syncwarp();
    return there;
  }

  /// SurfaceSearch::near(). Of equally near triangles, those with the lowest numbers are taken.
  static __device__ __noinline__ void near(const SurfaceSearch& surface, const SurfaceSearch::Point& p,
                                           NearTriangles& out);

private:
  // One of the triangles found. Each lane holds one, nearest first.
  struct Entry
  {
    double distance;
    std::int32_t triangle;
  };
  static __device__ __forceinline__ bool before(const Entry& a, const Entry& b)
  {
    return a.distance < b.distance || (a.distance == b.distance && a.triangle < b.triangle);
  }
  // Returns the nearer or the farther of this lane's entry and that of the lane at distance `apart`.
  static __device__ __forceinline__ Entry sorted(const Entry& own, int apart, bool nearer)
  {
    const Entry other{ __shfl_xor_sync(whole_warp, own.distance, apart),
                       __shfl_xor_sync(whole_warp, own.triangle, apart) };
    return before(own, other) == nearer ? own : other;
  }
  // Returns the nearest entries of `list`, which is sorted, and `found`, by bitonic networks.
  static __device__ __forceinline__ Entry merged(const Entry& list, Entry found)
  {
    const int lane = rank();
    for (int run = 2; run <= size; run *= 2)
      for (int apart = run / 2; apart > 0; apart /= 2)
        // sorted in descending order, so that both lists form a bitonic sequence
        found = sorted(found, apart, ((lane & apart) == 0) != ((lane & run) == 0));
    Entry nearest = before(found, list) ? found : list;
    for (int apart = size / 2; apart > 0; apart /= 2)
      nearest = sorted(nearest, apart, (lane & apart) == 0);
    return nearest;
  }

  static __device__ __forceinline__ double distance(const SurfaceSearch& surface, std::int32_t triangle,
                                                    const SurfaceSearch::Point& p)
  {
    const auto& corner = surface.triangles[triangle].corner;
    return norm(p - physics::closest_point(p, corner[0], corner[1], corner[2]));
  }
};

template <int Warps>
__device__ void Warp<Warps>::near(const SurfaceSearch& surface, const SurfaceSearch::Point& p, NearTriangles& out)
{
  // At most `wide` boxes are processed in parallel; more are processed one by one, up to the depth of a tree.
  constexpr int wide = 2 * size, deepest = 64;
  constexpr double nowhere = 1e300;
  __shared__ std::int32_t waiting[Warps][wide + deepest];
  std::int32_t* const stack = waiting[threadIdx.x / size];
  const int lane = rank();
  // The previous list bounds the search: its triangles give upper limits of the distances to be found.
  const double known = lane < out.count ? distance(surface, out.triangle[lane], p) : nowhere;
  double bound = least(known) + NearTriangles::reach;
  if (out.count == NearTriangles::capacity)
    bound = fmin(bound, -least(lane < out.count ? -known : 0.0) * (1 + 1e-12) + 1e-12);
  Entry list{ nowhere, INT32_MAX };
  int depth = surface.box_count > 0 ? 1 : 0;
  if (lane == 0)
    stack[0] = 0;
  __syncwarp();
  while (depth > 0)
  {
    const int taken = max(1, min(min(depth, size), wide - depth));
    depth -= taken;
    const std::int32_t self = lane < taken ? stack[depth + lane] : -1;
    __syncwarp();
    std::int32_t first = 0, count = 0;
    bool inner = false;
    if (self >= 0)
    {
      const SurfaceSearch::Box& box = surface.boxes[self];
      if (SurfaceSearch::squared_distance(box, p) <= bound * bound)
      {
        first = box.first;
        count = box.count;
        inner = count == 0;
      }
    }
    const unsigned inners = __ballot_sync(whole_warp, inner);
    if (inner)
    {
      const int place = depth + 2 * __popc(inners & ((1u << lane) - 1));
      stack[place] = first;
      stack[place + 1] = self + 1;
    }
    depth += 2 * __popc(inners);
    const int most_triangles = largest_of_warp(count);
    for (int t = 0; t < most_triangles; ++t)
    {
      Entry found{ nowhere, INT32_MAX };
      if (t < count)
        found = { distance(surface, first + t, p), first + t };
      if (!(found.distance < bound))
        found = { nowhere, INT32_MAX };
      if (__ballot_sync(whole_warp, found.distance < nowhere) == 0)
        continue;
      list = merged(list, found);
      bound = fmin(
          bound, fmin(from(0, list.distance) + NearTriangles::reach, from(NearTriangles::capacity - 1, list.distance)));
    }
    __syncwarp();
  }
  if (lane < NearTriangles::capacity && list.distance < nowhere)
  {
    out.triangle[lane] = list.triangle;
    out.distance[lane] = NearTriangles::kept(list.distance);
  }
  const int count = __popc(__ballot_sync(whole_warp, lane < NearTriangles::capacity && list.distance < nowhere));
  const double nearest = from(0, list.distance), farthest = from(NearTriangles::capacity - 1, list.distance);
  if (lane == 0)
  {
    out.at = p;
    out.count = count;
    out.beyond = count == 0 ? nowhere : fmin(nearest + NearTriangles::reach, farthest);
  }
  __syncwarp();
}

/// Finds the plane of each asking lane's contact at its `p`. All lanes call it.
template <int Warps>
__device__ __noinline__ ContactPlane find_together(bool asks, SurfaceContact* contact, const SurfaceContact::Point& p)
{
  // most searches that a warp does one by one; more of them finish sooner with one lane each
  constexpr int few = 5;
  using Team = Warp<Warps>;
  ContactPlane own;
  // makes visible to all lanes what a lane wrote to its contact
  __syncwarp();
  const unsigned asking = __ballot_sync(whole_warp, asks);
  if (__popc(asking) > few)
  {
    if (asks)
      own = contact->renew<true>(p);
  }
  else
    for (unsigned left = asking; left != 0; left &= left - 1)
    {
      const int lane = __ffs(static_cast<int>(left)) - 1;
      const ContactPlane plane = Team::from(lane, contact)->template renew<true, Team>(Team::from(lane, p));
      if (lane == Team::rank())
        own = plane;
    }
  __syncwarp();
  return own;
}

/// Finds the tangent plane at `at`. If it is not valid at the node's position `p`, finds it at `p` and sets `at` to
/// `p`.
template <int Warps>
__device__ __forceinline__ ContactPlane find_before(bool asks, SurfaceContact* contact, const SurfaceContact::Point& p,
                                                    SurfaceContact::Point& at)
{
  ContactPlane plane = find_together<Warps>(asks, contact, at);
  const bool too_far = asks && norm(at - p) > plane.limit;
  if (__any_sync(whole_warp, too_far))
  {
    const ContactPlane here = find_together<Warps>(too_far, contact, p);
    if (too_far)
    {
      plane = here;
      at = p;
    }
  }
  return plane;
}

}  // namespace cuda
}  // namespace frontalis
