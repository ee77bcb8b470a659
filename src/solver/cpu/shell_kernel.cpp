#include "solver/cpu/shell_kernel_body.hpp"

namespace frontalis
{
namespace
{

template <class Number>
struct PlainLane
{
  using Real = Number;
  using Batch = Number;
  using Vector = physics::Vec3<Number>;
  static constexpr int count = 1;

  static FRONTALIS_LAW Number load(const Number* p) { return *p; }
  static FRONTALIS_LAW Vector gather(const ShellVector<Number>* from, const std::int32_t* index)
  {
    return vector(from[*index]);
  }
  static FRONTALIS_LAW void store(const Vector& v, ShellVector<Number>* to) { store(v, *to); }
  static FRONTALIS_LAW Vector vector(const ShellVector<Number>& v) { return { v.x[0], v.x[1], v.x[2] }; }
  static FRONTALIS_LAW Vector vector(Number x, Number y, Number z) { return { x, y, z }; }
  static FRONTALIS_LAW Vector times(Number weight, const Vector& v) { return weight * v; }
  static FRONTALIS_LAW void store(const Vector& v, ShellVector<Number>& to) { to = { { v.x, v.y, v.z, 0 } }; }
  static int place(int lane) { return lane; }
};

}  // namespace

template <class Real>
ShellKernels<Real> plain_shell_kernels()
{
  return ShellKernelBody<PlainLane<Real>>::all();
}

template ShellKernels<float> plain_shell_kernels();
template ShellKernels<double> plain_shell_kernels();

}  // namespace frontalis
