#include "solver/cpu/slide_kernel.hpp"

#include "frontalis/physics/element/sliding_node.hpp"
#include "solver/cpu/attach_kernel_body.hpp"

namespace frontalis
{

namespace
{

template <class Real>
void glide_plainly(const SlideArguments<Real>& g, std::int32_t block, std::int32_t l, const physics::Vec3<Real>& normal,
                   physics::Vec3<Real>& u, physics::Vec3<Real>& v)
{
  const SlidingBlock<Real>& b = g.blocks[block];
  RoughBlock<Real>& r = g.rough[block];
  const physics::CurvedLevel<Real> level{
    normal,
    b.offset[l],
    { b.reference[0][l], b.reference[1][l], b.reference[2][l] },
    { r.bend[0][l], r.bend[1][l], r.bend[2][l], r.bend[3][l], r.bend[4][l], r.bend[5][l] },
    { r.surface_velocity[0][l], r.surface_velocity[1][l], r.surface_velocity[2][l] }
  };
  physics::Vec3<Real> outward{ r.outward[0][l], r.outward[1][l], r.outward[2][l] };
  physics::glide(level, g.rubbing * r.coefficient[l], g.response, g.dt, outward, r.pressing[l], u, v);
  r.outward[0][l] = outward.x;
  r.outward[1][l] = outward.y;
  r.outward[2][l] = outward.z;
}

template <class Real>
std::int32_t slide_plainly(const SlideArguments<Real>& g, std::int32_t first, std::int32_t last)
{
  using Vector = physics::Vec3<Real>;
  std::int32_t waiting = 0;
  for (auto block = first; block < last; ++block)
  {
    const SlidingBlock<Real>& b = g.blocks[block];
    const auto at = [&](Real* const(&of)[3], std::int32_t l)
    {
      const auto n = g.node[block] + l;
      return Vector{ of[0][n], of[1][n], of[2][n] };
    };
    std::uint32_t waits = 0;
    for (std::int32_t l = 0; l < g.count[block] && g.waiting != nullptr; ++l)
    {
      const Vector slip = at(g.u, l) - Vector{ b.reference[0][l], b.reference[1][l], b.reference[2][l] };
      waits |= dot(slip, slip) > b.slip_squared[l] ? 1U << l : 0U;
    }
    if (waits != 0)
      g.waiting[waiting++] = { block, waits };
    for (std::int32_t l = 0; l < g.count[block] && waits == 0; ++l)
    {
      const auto n = g.node[block] + l;
      Vector u = at(g.u, l), v = at(g.v, l);
      const Vector normal{ b.normal[0][l], b.normal[1][l], b.normal[2][l] };
      if (g.rough != nullptr)
        glide_plainly(g, block, l, normal, u, v);
      else
      {
        physics::slide(normal, b.offset[l], u, v);
        v = v + b.speed[l] * normal;
      }
      const Real moved[3] = { u.x, u.y, u.z }, velocity[3] = { v.x, v.y, v.z };
      for (int axis = 0; axis < 3; ++axis)
      {
        g.u[axis][n] = moved[axis];
        g.v[axis][n] = velocity[axis];
      }
    }
  }
  return waiting;
}

}  // namespace

template <class Real>
SlideKernels<Real> plain_slide_kernels()
{
  return { slide_plainly<Real>, nullptr };
}

template SlideKernels<float> plain_slide_kernels();
template SlideKernels<double> plain_slide_kernels();

template <class Real>
void attach_plainly(const AttachArguments<Real>& g, std::int32_t first, std::int32_t last)
{
  AttachKernelBody<void, Real>::run(g, first, last);
}

template void attach_plainly(const AttachArguments<float>&, std::int32_t, std::int32_t);
template void attach_plainly(const AttachArguments<double>&, std::int32_t, std::int32_t);

}  // namespace frontalis
