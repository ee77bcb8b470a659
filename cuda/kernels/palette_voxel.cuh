#pragma once

#include "cuda/kernels/step_kernel.hpp"
#include "frontalis/physics/element/relaxation.hpp"
#include "frontalis/physics/element/voxel_forces.hpp"
#include "solver/law_share.hpp"

namespace frontalis
{
namespace cuda
{

// Functions for rare kinds of voxel are not inlined, so that common voxels do not need registers for them.
template <class T>
static __device__ __noinline__ void add_laws_apart(const StepArguments& g, std::uint32_t palette,
                                                   const physics::Kinematics<T>& k, physics::Matrix3<T>& P);
template <class T>
static __device__ __noinline__ T law_stiffening_apart(const StepArguments& g, std::uint32_t palette,
                                                      const physics::Kinematics<T>& k);

/// Material of a palette entry, in the form that physics/element/ reads. T: float in a step, double in the monitor.
template <class T, Effects With>
struct PaletteVoxel
{
  const StepArguments& g;
  std::uint32_t palette;
  std::uint32_t viscous;  ///< index of the voxel among the viscous ones
  float4 entry;           ///< StepArguments::palette

  __device__ __forceinline__ const float* scale() const { return g.scale; }
  __device__ __forceinline__ const float* stretch_weight() const { return g.stretch_weight; }
  __device__ __forceinline__ float stretch_half_sum() const { return g.stretch_half_sum; }
  __device__ __forceinline__ const float* hourglass_weight() const { return g.hourglass_weight; }
  __device__ __forceinline__ bool assumed_strain() const
  {
    return has<With, Effects::general_element> && g.stabilisation != nullptr;
  }
  __device__ __forceinline__ bool selective_reduced() const
  {
    return has<With, Effects::general_element> && g.selective_reduced;
  }
  __device__ __forceinline__ physics::NeoHookean<T> material() const { return { T(entry.x), T(entry.y), T(entry.w) }; }
  __device__ __forceinline__ T hourglass() const { return T(entry.z); }
  __device__ __forceinline__ void scalar_hourglass(T (&mode)[3][8]) const
  {
    for (auto& component : mode)
      physics::scalar_hourglass(hourglass(), component);
  }
  __device__ __forceinline__ T bound_at_rest() const { return T(__ldg(g.stiffness_bounds + palette)); }
  __device__ __forceinline__ physics::AssumedStrain<T> stabilisation() const
  {
    const float4 s = __ldg(g.stabilisation + palette);
    return { T(s.x), T(s.y), T(s.z), T(s.w) };
  }

  __device__ __forceinline__ bool has_laws() const
  {
    return has<With, Effects::general_element> && g.law_begin != nullptr;
  }
  template <class Visit>
  __device__ __forceinline__ void each_law(Visit&& visit) const
  {
    if (!has_laws())
      return;
    const std::uint32_t last = __ldg(g.law_begin + palette + 1);
    for (std::uint32_t l = __ldg(g.law_begin + palette); l < last; ++l)
    {
      const LawEntry from = g.laws[l];
      LawShare<T> law{ static_cast<Law>(from.law), T(from.weight), T(from.at_rest), T(from.per_tangent), {} };
      for (int p = 0; p < 11; ++p)
        law.parameters[p] = T(from.parameters[p]);
      visit(law);
    }
  }
  __device__ __forceinline__ void add_laws(const physics::Kinematics<T>& k, physics::Matrix3<T>& P) const
  {
    add_laws_apart(g, palette, k, P);
  }
  __device__ __forceinline__ T law_stiffening(const physics::Kinematics<T>& k) const
  {
    return law_stiffening_apart(g, palette, k);
  }
  __device__ __forceinline__ T stiffness_now(const physics::Kinematics<T>& k) const
  {
    return physics::stiffness_now(*this, k);
  }

  __device__ __forceinline__ int viscous_terms() const { return g.viscous_terms; }
  __device__ __forceinline__ physics::ViscousTerm<T> viscous_term(int n) const
  {
    const float4 properties = __ldg(g.viscous_properties + viscous);
    return { n == 0 ? properties.x : properties.y, n == 0 ? properties.z : properties.w };
  }
  __device__ __forceinline__ float& relaxed_at(int tensor, int component) const
  {
    return g.relaxed[(6 * static_cast<std::size_t>(tensor) + component) * g.viscous_count + viscous];
  }
  __device__ __forceinline__ physics::Symmetric3<T> relaxed(int tensor) const
  {
    physics::Symmetric3<T> H;
#pragma unroll
    for (int n = 0; n < 6; ++n)
      H.a[n] = relaxed_at(tensor, n);
    return H;
  }
  __device__ __forceinline__ void keep_relaxed(int tensor, const physics::Symmetric3<T>& H) const
  {
    for (int n = 0; n < 6; ++n)
      relaxed_at(tensor, n) = H.a[n];
  }
};

/// A voxel known only by its palette entry.
template <class T>
__device__ __forceinline__ PaletteVoxel<T, Effects::general_element> palette_voxel(const StepArguments& g,
                                                                                   std::uint32_t palette)
{
  return { g, palette, 0, __ldg(g.palette + palette) };
}

template <class T>
static __device__ __noinline__ void add_laws_apart(const StepArguments& g, std::uint32_t palette,
                                                   const physics::Kinematics<T>& k, physics::Matrix3<T>& P)
{
  physics::add_laws(palette_voxel<T>(g, palette), k, P);
}

template <class T>
static __device__ __noinline__ T law_stiffening_apart(const StepArguments& g, std::uint32_t palette,
                                                      const physics::Kinematics<T>& k)
{
  return physics::law_stiffening(palette_voxel<T>(g, palette), k);
}

static __device__ __noinline__ void gauss_forces_apart(const StepArguments& g, std::uint32_t palette,
                                                       float (&mode)[3][8], bool with_bound, float& stiffness)
{
  physics::gauss_forces(palette_voxel<float>(g, palette), mode, with_bound, stiffness);
}

/// Relaxes viscous stresses within a step, which happens rarely. Uses a copy, so that other voxels stay in registers.
template <Effects With>
static __device__ __noinline__ void relax_copy(const StepArguments& g, std::uint32_t palette, std::uint32_t viscous,
                                               float elapsed, const physics::Kinematics<float>& k)
{
  const PaletteVoxel<float, With> voxel{ g, palette, viscous, __ldg(g.palette + palette) };
  physics::relax_voxel(voxel, elapsed, k, [](const auto&, const auto&) {});
}

template <Effects With>
__device__ __forceinline__ void relax_apart(const StepArguments& g, std::uint32_t palette, std::uint32_t viscous,
                                            float elapsed, const physics::Kinematics<float>& k)
{
  const physics::Kinematics<float> copy = k;
  relax_copy<part<With, Effects::general_element>>(g, palette, viscous, elapsed, copy);
}

}  // namespace cuda
}  // namespace frontalis
