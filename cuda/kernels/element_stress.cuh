#pragma once

#include "frontalis/physics/assumed_strain.hpp"
#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/muscle_fibre.hpp"
#include "frontalis/physics/materials/neo_hookean.hpp"
#include "frontalis/physics/selective_reduced.hpp"
#include "frontalis/physics/time_step.hpp"
#include "frontalis/physics/viscosity.hpp"
#include "solver/material_laws.hpp"
#include "cuda/kernels/step_kernel.hpp"

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
  std::uint32_t viscous;
};

/// Activations in a step of a plan. They change evenly from its begin to its end.
struct Activations
{
  const float2* of;  ///< one a muscle, in shared memory: at the begin, and the change until the end
  float fraction;    ///< of the plan at the end of the step

  __device__ __forceinline__ float operator[](std::uint32_t muscle) const
  {
    const float2 activation = of[muscle];
    return activation.x + fraction * activation.y;
  }
};

/// By all threads of a block, once a launch: steps have nothing to wait for.
__device__ __forceinline__ void load_activations(const StepArguments& g, float2* to)
{
  for (std::int32_t m = threadIdx.x; m < g.muscles; m += blockDim.x)
    to[m] = make_float2(g.activation_begin[m], g.activation_end[m] - g.activation_begin[m]);
}

__device__ __forceinline__ Activations activations_at(const StepArguments& g, std::int32_t step, const float2* of)
{
  return { of, __fdiv_rn(static_cast<float>(step + 1), static_cast<float>(g.steps)) };
}

/// Without a condition on the voxel: places without fibres fetch the first entry.
__device__ __forceinline__ void fetch_fibre(const StepArguments& g, std::uint32_t word, ElementPlace& place)
{
  place.fibre_word = word;
  place.fibre = __ldg(g.fibres + (word >> 4));
  place.muscle_word = __ldg(g.fibre_muscle + (word >> 4));
}

/// Stress of the fibres of a voxel times its tissue volume: P += S (F a0) (x) a0.
__device__ __forceinline__ void add_fibres(const StepArguments& g, ElementPlace place, const Activations& activation,
                                           const physics::Kinematics<float>& k, physics::Matrix3<float>& P)
{
  for (std::uint32_t left = place.fibre_word & 15u; left > 0; --left)
  {
    const float4 fibre = place.fibre;
    const std::uint32_t word = place.muscle_word;
    const float active = activation[word & 0x3fffffffu];
    // a muscle at rest without passive stress is not computed
    if (active != 0.0f || (word & 0x80000000u) != 0)
    {
      const float a[3] = { fibre.x, fibre.y, fibre.z };
      float along[3];
#pragma unroll
      for (int i = 0; i < 3; ++i)
        along[i] = k.F.a[i][0] * a[0] + k.F.a[i][1] * a[1] + k.F.a[i][2] * a[2];
      const float squared = along[0] * along[0] + along[1] * along[1] + along[2] * along[2];
      const float with_length = (word & 0x40000000u) ? 1.0f : 0.0f;
      const float S = (word & 0x80000000u) != 0
                          ? physics::fibre_stress<float>(squared, k.J, fibre.w, active, with_length, 1.0f)
                          : physics::fibre_stress<float, false>(squared, k.J, fibre.w, active, with_length, 0.0f);
#pragma unroll
      for (int i = 0; i < 3; ++i)
      {
        const float traction = S * along[i];
#pragma unroll
        for (int j = 0; j < 3; ++j)
          P.a[i][j] += traction * a[j];
      }
    }
    if (left > 1)
      fetch_fibre(g, place.fibre_word + 16, place);
  }
}

/// Stress of the laws beyond neo-Hookean times the tissue volume that they have; not inlined, because few voxels have
/// them.
static __device__ __noinline__ void add_laws(const StepArguments& g, std::uint32_t palette,
                                             const physics::Kinematics<float>& k, physics::Matrix3<float>& P)
{
  const std::uint32_t last = __ldg(g.law_begin + palette + 1);
  for (std::uint32_t l = __ldg(g.law_begin + palette); l < last; ++l)
  {
    const LawEntry entry = g.laws[l];
    add_law_stress(static_cast<Law>(entry.law), entry.parameters, entry.weight, k, P);
  }
}

/// What the laws add to the bound of the stiffness since rest [N/m].
static __device__ __noinline__ float stiffened(const StepArguments& g, std::uint32_t palette,
                                               const physics::Kinematics<float>& k)
{
  float sum = 0;
  const std::uint32_t last = __ldg(g.law_begin + palette + 1);
  for (std::uint32_t l = __ldg(g.law_begin + palette); l < last; ++l)
  {
    const LawEntry entry = g.laws[l];
    sum += law_stiffening(static_cast<Law>(entry.law), entry.parameters, entry.at_rest, entry.per_tangent, k);
  }
  return sum;
}

/// Elastic stress times tissue volume.
template <Effects With>
__device__ __forceinline__ physics::Matrix3<float> elastic_stress(const StepArguments& g, std::uint32_t palette,
                                                                  const physics::NeoHookean<float>& material,
                                                                  const physics::Kinematics<float>& k)
{
  const auto isotropic = physics::stress(material, k);
  physics::Matrix3<float> P;
#pragma unroll
  for (int i = 0; i < 3; ++i)
#pragma unroll
    for (int j = 0; j < 3; ++j)
      P.a[i][j] = isotropic.on_gradient * k.F.a[i][j] + isotropic.on_cofactor * k.cofactor.a[i][j];
  if (has<With, Effects::general_element> && g.law_begin != nullptr)
    add_laws(g, palette, k, P);
  return P;
}

/// Bits of numbers that are not negative are in their order, and NaN's lie above them all.
__device__ __forceinline__ std::uint32_t bits_of(float x) { return __float_as_uint(x) & 0x7fffffffu; }

/// Bound of the largest eigenvalue of a voxel's stiffness now [N/m], NaN where motion is not finite.
template <Effects With>
__device__ __forceinline__ float stiffness_now(const StepArguments& g, std::uint32_t palette, const float4& entry,
                                               const physics::Kinematics<float>& k)
{
  const physics::NeoHookean<float> material{ entry.x, entry.y };
  float now = physics::voxel_stiffness_now(entry.w, material, k, g.stretch_weight, g.stretch_half_sum);
  if (has<With, Effects::general_element> && g.law_begin != nullptr)
    now += stiffened(g, palette, k);
  return now;
}

/// Bits of the highest frequency squared that a node allows. stiffness: sum of its voxels'.
__device__ __forceinline__ std::uint32_t frequency_bits_of(const StepArguments& g, std::uint32_t node,
                                                           float inverse_mass, float stiffness)
{
  return bits_of(stiffness * (g.mobility == nullptr ? inverse_mass : __ldg(g.mobility + node)));
}

/// Isochoric stress at eight points: modes to the forces on them.
static __device__ __noinline__ void gauss_points(const StepArguments& g, std::uint32_t palette, const float4& entry,
                                                 float (&mode)[3][8], bool look, float& stiffness)
{
  float force[3][8] = {};
  // unrolled, so that the weights are constants
#pragma unroll
  for (int point = 0; point < 8; ++point)
  {
    float moved[3][8];
    physics::at_gauss_point(point, mode, moved);
    const auto k = physics::kinematics(moved[0], moved[1], moved[2], g.scale);
    const physics::NeoHookean<float> material{ entry.x, 0.0f };
    physics::add_gauss_forces(point, elastic_stress<Effects::general_element>(g, palette, material, k), g.scale, force);
    if (look && palette != 0)
      stiffness = __uint_as_float(
          max(bits_of(stiffness), bits_of(stiffness_now<Effects::general_element>(g, palette, entry, k))));
  }
  for (int c = 0; c < 3; ++c)
    for (int m = 0; m < 8; ++m)
      mode[c][m] = force[c][m];
}

__device__ __forceinline__ physics::Symmetric3<float> load_relaxed(const StepArguments& g, std::uint32_t viscous,
                                                                   std::int32_t term)
{
  physics::Symmetric3<float> H;
#pragma unroll
  for (int n = 0; n < 6; ++n)
    H.a[n] = g.relaxed[(6 * static_cast<std::size_t>(term) + n) * g.viscous_count + viscous];
  return H;
}

/// Viscous stresses of a voxel relax by `elapsed` [s] towards those at k (physics/viscosity.hpp). `account`: two
/// numbers a voxel, or null: see ViscousVoxels; k_before: where the step began, read for the account alone.
template <Effects With>
__device__ __forceinline__ void relax_voxel(const StepArguments& g, std::uint32_t voxel, std::uint32_t palette,
                                            float elapsed, const physics::Kinematics<float>& k,
                                            const physics::Kinematics<float>& k_before, double* account)
{
  const physics::NeoHookean<float> material{ __ldg(&g.palette[palette].x), 0.0f };
  const auto S = physics::second_piola(k, elastic_stress<With>(g, palette, material, k));
  const float4 make = __ldg(g.viscous_makes + voxel);
  const auto store = [&](std::int32_t term, const physics::Symmetric3<float>& H)
  {
    for (int n = 0; n < 6; ++n)
      g.relaxed[(6 * static_cast<std::size_t>(term) + n) * g.viscous_count + voxel] = H.a[n];
  };
  physics::Symmetric3<float> sum{};
  double change = 0, now = 0;
  for (std::int32_t term = 0; term < g.viscous_terms; ++term)
  {
    auto H = load_relaxed(g, voxel, term);
    const auto before = H;
    physics::relax(term == 0 ? make.x : make.y, expf(-(term == 0 ? make.z : make.w) * elapsed), S, H);
    store(term, H);
    for (int n = 0; n < 6; ++n)
      sum.a[n] += H.a[n];
    if (account == nullptr)
      continue;
    change += static_cast<double>(physics::relaxation_work(k_before, k, before, H));
    now += static_cast<double>(along_strain(k, H));
  }
  if (g.viscous_terms == 2)
    store(2, sum);
  if (account != nullptr)
  {
    account[2 * static_cast<std::size_t>(voxel)] += change;
    account[2 * static_cast<std::size_t>(voxel) + 1] = now;
  }
}

/// The same within a step: seldom, so that it is not inlined, and with copies, so that the others' numbers stay in
/// registers.
template <Effects With>
static __device__ __noinline__ void relax_copy(const StepArguments& g, std::uint32_t voxel, std::uint32_t palette,
                                               float elapsed, const physics::Kinematics<float>& k)
{
  relax_voxel<With>(g, voxel, palette, elapsed, k, k, nullptr);
}

template <Effects With>
__device__ __forceinline__ void relax_apart(const StepArguments& g, const ElementPlace& place, float elapsed,
                                            const physics::Kinematics<float>& k)
{
  const physics::Kinematics<float> copy = k;
  relax_copy<part<With, Effects::general_element>>(g, place.viscous - 1, place.palette, elapsed, copy);
}

/// `relaxes`: seconds by which viscous stresses relax first. Replaces the transformed displacements of a voxel by the
/// forces conjugate to them; the one place where the GPU computes stress. Palette entry 0 has no stiffness, so that
/// places without a voxel give exact zeros. stiffness: 0 before; the bound now [N/m] where `look` asks for it.
template <Effects With>
__device__ __forceinline__ void element_forces(const StepArguments& g, const ElementPlace& place,
                                               const Activations& activation, float relaxes, float (&mode)[3][8],
                                               bool look, float& stiffness)
{
  const float4 entry = __ldg(g.palette + place.palette);
  const auto k = physics::kinematics(mode[0], mode[1], mode[2], g.scale);
  const bool reduced = has<With, Effects::general_element> && g.selective_reduced;
  physics::Matrix3<float> P;
  if (reduced)
  {
    const float pressure = entry.y * k.dilatation;
#pragma unroll
    for (int i = 0; i < 3; ++i)
#pragma unroll
      for (int j = 0; j < 3; ++j)
        P.a[i][j] = pressure * k.cofactor.a[i][j];
  }
  else
    P = elastic_stress<With>(g, place.palette, physics::NeoHookean<float>{ entry.x, entry.y }, k);
  if (has<With, Effects::fibres>)
    add_fibres(g, place, activation, k, P);
  if (has<With, Effects::viscosity> && place.viscous != 0)
  {
    if (relaxes > 0)
      relax_apart<With>(g, place, relaxes, k);
    physics::take_relaxed(k, load_relaxed(g, place.viscous - 1, physics::relaxed_tensors(g.viscous_terms) - 1), P);
  }
  if (look && place.palette != 0 && !reduced)
    stiffness = stiffness_now<With>(g, place.palette, entry, k);
  if (has<With, Effects::general_element> && g.stabilisation != nullptr)
  {
    const float4 s = __ldg(g.stabilisation + place.palette);
    const physics::AssumedStrain<float> form{ s.x, s.y, s.z, s.w };
    physics::hourglass_forces(form, entry.z, g.hourglass_weight, k.F, mode, P);
  }
  else if (reduced)
  {
    // a copy, so that the others' modes stay in registers
    float force[3][8];
    for (int c = 0; c < 3; ++c)
      for (int m = 0; m < 8; ++m)
        force[c][m] = mode[c][m];
    gauss_points(g, place.palette, entry, force, look, stiffness);
    for (int c = 0; c < 3; ++c)
      for (int m = 0; m < 8; ++m)
        mode[c][m] = force[c][m];
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
    {
      float& to = mode[c][physics::gradient_mode(j)];
      to = P.a[c][j] * g.scale[j] + (reduced ? to : 0.0f);
    }
  }
}

}  // namespace cuda
}  // namespace frontalis
