#include "solver/cpu/slide_kernel.hpp"

#include "frontalis/physics/sliding.hpp"
#include "solver/cpu/attach_kernel_body.hpp"

namespace frontalis
{

template <class Real>
void slide_plainly(const SlideArguments<Real>& g, std::int32_t first, std::int32_t last)
{
  using Vector = physics::Vec3<Real>;
  for (auto block = first; block < last; ++block)
  {
    SlidingBlock<Real>& b = g.blocks[block];
    for (std::int32_t l = 0; l < g.count[block]; ++l)
    {
      const auto n = g.node[block] + l;
      Vector u{ g.u[0][n], g.u[1][n], g.u[2][n] }, v{ g.v[0][n], g.v[1][n], g.v[2][n] };
      const Vector slip = u - Vector{ b.reference[0][l], b.reference[1][l], b.reference[2][l] };
      if (dot(slip, slip) > b.slip_squared[l])
      {
        const Real at[3] = { u.x, u.y, u.z };
        Real with[3] = { v.x, v.y, v.z };
        g.renew(g.context, block, l, at, with);
        v = { with[0], with[1], with[2] };
      }
      const Vector normal{ b.normal[0][l], b.normal[1][l], b.normal[2][l] };
      physics::slide(normal, b.offset[l], u, v);
      v = v + b.speed[l] * normal;
      const Real moved[3] = { u.x, u.y, u.z }, velocity[3] = { v.x, v.y, v.z };
      for (int axis = 0; axis < 3; ++axis)
      {
        g.u[axis][n] = moved[axis];
        g.v[axis][n] = velocity[axis];
      }
    }
  }
}

template void slide_plainly(const SlideArguments<float>&, std::int32_t, std::int32_t);
template void slide_plainly(const SlideArguments<double>&, std::int32_t, std::int32_t);

template <class Real>
void attach_plainly(const AttachArguments<Real>& g, std::int32_t first, std::int32_t last)
{
  AttachKernelBody<void, Real>::run(g, first, last);
}

template void attach_plainly(const AttachArguments<float>&, std::int32_t, std::int32_t);
template void attach_plainly(const AttachArguments<double>&, std::int32_t, std::int32_t);

}  // namespace frontalis
