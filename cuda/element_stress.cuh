#pragma once

#include "frontalis/physics/assumed_strain.hpp"
#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/muscle_fibre.hpp"
#include "frontalis/physics/neo_hookean.hpp"
#include "frontalis/physics/time_step.hpp"
#include "material_laws.hpp"
#include "step_kernel.hpp"

namespace frontalis
{
namespace cuda
{

/// What a voxel's stress needs besides its deformation; the first of its fibres is fetched early.
struct ElementPlace
{
  std::uint32_t palette;
  std::uint32_t fibre_word;
  float4 fibre;
  std::uint32_t muscle_word;
};

/// Without a condition on the voxel: places without fibres fetch the first entry.
__device__ __forceinline__ void fetch_fibre(const StepArguments& g, std::uint32_t word, ElementPlace& place)
{
  place.fibre_word = word;
  place.fibre = __ldg(g.fibres + (word >> 4));
  place.muscle_word = __ldg(g.fibre_muscle + (word >> 4));
}

/// Stress of the fibres of a voxel times its tissue volume: P += S (F a0) (x) a0.
__device__ __forceinline__ void add_fibres(const StepArguments& g, ElementPlace place, const float* activation,
                                           const physics::Kinematics<float>& k, physics::Matrix3<float>& P)
{
  for (std::uint32_t left = place.fibre_word & 15u; left > 0; --left)
  {
    const float4 fibre = place.fibre;
    const std::uint32_t word = place.muscle_word;
    const float a[3] = { fibre.x, fibre.y, fibre.z };
    float along[3];
#pragma unroll
    for (int i = 0; i < 3; ++i)
      along[i] = k.F.a[i][0] * a[0] + k.F.a[i][1] * a[1] + k.F.a[i][2] * a[2];
    const float squared = along[0] * along[0] + along[1] * along[1] + along[2] * along[2];
    const float S =
        physics::fibre_stress<float>(squared, k.J, fibre.w, activation[word & 0x3fffffffu],
                                     (word & 0x40000000u) ? 1.0f : 0.0f, (word & 0x80000000u) ? 1.0f : 0.0f);
#pragma unroll
    for (int i = 0; i < 3; ++i)
    {
      const float traction = S * along[i];
#pragma unroll
      for (int j = 0; j < 3; ++j)
        P.a[i][j] += traction * a[j];
    }
    if (left > 1)
      fetch_fibre(g, place.fibre_word + 16, place);
  }
}

/// Stress of the laws beyond neo-Hookean times the tissue volume that they have; not inlined, because few voxels have
/// them. Adds to the frequency bound squared what they have stiffened since rest.
__device__ __noinline__ void add_laws(const StepArguments& g, std::uint32_t palette,
                                      const physics::Kinematics<float>& k, physics::Matrix3<float>& P,
                                      float& frequency_squared)
{
  const std::uint32_t last = __ldg(g.law_begin + palette + 1);
  for (std::uint32_t l = __ldg(g.law_begin + palette); l < last; ++l)
  {
    const LawEntry entry = g.laws[l];
    add_law_stress(static_cast<Law>(entry.law), entry.parameters, entry.weight, k, P);
    const float more = law_stiffness(static_cast<Law>(entry.law), entry.parameters, k) - entry.at_rest;
    frequency_squared += entry.inertia * fmaxf(more, 0.0f);
  }
}

/// `activation`: one a muscle, in shared memory. Replaces the transformed displacements of a voxel by the forces
/// conjugate to them; the one place where the GPU computes stress. Palette entry 0 has no stiffness, so that places
/// without a voxel give exact zeros.
template <Effects With>
__device__ __forceinline__ void element_forces(const StepArguments& g, const ElementPlace& place,
                                               const float* activation, float (&mode)[3][8], bool look,
                                               std::uint32_t& frequency_bits)
{
  const float4 entry = __ldg(g.palette + place.palette);
  const auto k = physics::kinematics(mode[0], mode[1], mode[2], g.scale);
  const physics::NeoHookean<float> material{ entry.x, entry.y };
  const auto isotropic = physics::stress(material, k);
  physics::Matrix3<float> P;
#pragma unroll
  for (int i = 0; i < 3; ++i)
#pragma unroll
    for (int j = 0; j < 3; ++j)
      P.a[i][j] = isotropic.on_gradient * k.F.a[i][j] + isotropic.on_cofactor * k.cofactor.a[i][j];
  float stiffened = 0;
  if (With != Effects::none)
    add_fibres(g, place, activation, k, P);
  if (With == Effects::all && g.law_begin != nullptr)
    add_laws(g, place.palette, k, P, stiffened);
  if (look && place.palette != 0)
  {
    const float growth = physics::stiffening(material, k, g.stretch_weight);
    const float now = entry.w * fmaxf(growth, 1.0f) + stiffened;
    // bits of numbers that are not negative are in their order; growth - growth is 0, or NaN, which lies above them all
    frequency_bits = max(frequency_bits, __float_as_uint(now + (growth - growth)) & 0x7fffffffu);
  }
  if (With == Effects::all && g.stabilisation != nullptr)
  {
    const float4 s = __ldg(g.stabilisation + place.palette);
    const physics::AssumedStrain<float> stiffness{ s.x, s.y, s.z, s.w };
    physics::hourglass_forces(stiffness, entry.z, g.hourglass_weight, k.F, mode, P);
  }
  else
  {
#pragma unroll
    for (int c = 0; c < 3; ++c)
#pragma unroll
      for (int m = 0; m < 8; ++m)
        if (physics::is_hourglass_mode(m))
          mode[c][m] *= entry.z;
  }
#pragma unroll
  for (int c = 0; c < 3; ++c)
  {
    mode[c][0] = 0;
#pragma unroll
    for (int j = 0; j < 3; ++j)
      mode[c][physics::gradient_mode(j)] = P.a[c][j] * g.scale[j];
  }
}

}  // namespace cuda
}  // namespace frontalis
