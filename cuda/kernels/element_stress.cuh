#pragma once

#include "cuda/kernels/activation.cuh"
#include "cuda/kernels/palette_voxel.cuh"

namespace frontalis
{
namespace cuda
{

constexpr unsigned whole_warp = 0xffffffffu;

/// The largest value among the lanes of a warp. GPUs below compute capability 8.0 have no instruction for it.
__device__ __forceinline__ std::uint32_t largest_of_warp(std::uint32_t value)
{
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
  return __reduce_max_sync(whole_warp, value);
#else
  for (int apart = 16; apart > 0; apart /= 2)
    value = max(value, __shfl_xor_sync(whole_warp, value, apart));
  return value;
#endif
}

/// Data of a voxel other than its deformation. The first fibre is loaded early to hide memory latency.
struct ElementPlace
{
  std::uint32_t palette;
  std::uint32_t fibre_word;
  float4 fibre;
  std::uint32_t muscle_word;
  std::uint32_t viscous;
};

/// Loads the first fibre of a voxel. To avoid a branch, voxels without fibres load the first entry of the list.
__device__ __forceinline__ void fetch_fibre(const StepArguments& g, std::uint32_t word, ElementPlace& place)
{
  place.fibre_word = word;
  place.fibre = __ldg(g.fibres + (word >> 4));
  place.muscle_word = __ldg(g.fibre_muscle + (word >> 4));
}

/// Makes a fibre from an entry of StepArguments::fibres and the entry's word of fibre_muscle.
__device__ __forceinline__ physics::Fibre<float, float> fibre_of(const float4& entry, std::uint32_t word,
                                                                 float activation)
{
  return {
    { entry.x, entry.y, entry.z }, entry.w, activation, (word & 0x40000000u) ? 1.0f : 0.0f, (word & 0x80000000u) != 0
  };
}

/// A voxel in a step, in the form that physics/element/ reads.
template <Effects With>
struct ElementVoxel : PaletteVoxel<float, With>
{
  using Kinematics = physics::Kinematics<float>;
  using Stress = physics::Matrix3<float>;
  using PaletteVoxel<float, With>::g;
  using PaletteVoxel<float, With>::palette;

  const ElementPlace& place;
  const Activations& activation;
  float relaxes;  ///< time by which viscous stresses relax before the stress is computed [s]

  template <class Visit>
  __device__ __forceinline__ void each_fibre(Visit&& visit) const
  {
    ElementPlace at = place;
    for (std::uint32_t left = at.fibre_word & 15u; left > 0; --left)
    {
      const float active = activation[at.muscle_word & 0x3fffffffu];
      if (physics::has_stress(active, (at.muscle_word & 0x80000000u) != 0))
        visit(fibre_of(at.fibre, at.muscle_word, active));
      if (left > 1)
        fetch_fibre(g, at.fibre_word + 16, at);
    }
  }
  __device__ __forceinline__ void add_fibres(const Kinematics& k, Stress& P) const
  {
    if (has<With, Effects::fibres>)
      physics::add_fibres(*this, k, P);
  }
  __device__ __forceinline__ void add_viscosity(const Kinematics& k, Stress& P) const
  {
    if (!has<With, Effects::viscosity> || place.viscous == 0)
      return;
    if (relaxes > 0)
      relax_apart<With>(g, palette, place.viscous - 1, relaxes, k);
    physics::add_viscosity(*this, k, P);
  }
  __device__ __forceinline__ void gauss_forces(float (&mode)[3][8], bool with_bound, float& stiffness) const
  {
    // The copy lets the modes of other voxels stay in registers.
    float force[3][8];
    for (int c = 0; c < 3; ++c)
      for (int m = 0; m < 8; ++m)
        force[c][m] = mode[c][m];
    gauss_forces_apart(g, palette, force, with_bound, stiffness);
    for (int c = 0; c < 3; ++c)
      for (int m = 0; m < 8; ++m)
        mode[c][m] = force[c][m];
  }
};

/// Makes a voxel from its data in `place`. `relaxes`: time by which viscous stresses relax before the forces are
/// computed [s].
template <Effects With>
__device__ __forceinline__ ElementVoxel<With> element_voxel(const StepArguments& g, const ElementPlace& place,
                                                            const Activations& activation, float relaxes)
{
  return { { g, place.palette, place.viscous - 1, __ldg(g.palette + place.palette) }, place, activation, relaxes };
}

/// Replaces the transformed displacements of a voxel by the forces conjugate to them. Palette entry 0 has no stiffness,
/// so that places without a voxel yield exact zeros. `stiffness` must be 0 before the call; if `with_bound` is set, it
/// becomes the bound of the present stiffness [N/m].
template <class Voxel>
__device__ __forceinline__ void element_forces(const Voxel& voxel, float (&mode)[3][8], bool with_bound,
                                               float& stiffness)
{
  const auto P = physics::element_stress(voxel, mode, with_bound && voxel.palette != 0, stiffness);
#pragma unroll
  for (int c = 0; c < 3; ++c)
    physics::stress_forces(voxel, P, c, mode[c]);
}

/// Bit pattern of a non-negative number. Bit patterns are in the order of the numbers, and NaN is above all of them.
__device__ __forceinline__ std::uint32_t bits_of(float x) { return __float_as_uint(x) & 0x7fffffffu; }

/// Bits of the bound of the squared highest frequency at a node, from the summed stiffness of its voxels.
__device__ __forceinline__ std::uint32_t frequency_bits_of(const StepArguments& g, std::uint32_t node,
                                                           float inverse_mass, float stiffness)
{
  return bits_of(stiffness * (g.mobility == nullptr ? inverse_mass : __ldg(g.mobility + node)));
}

}  // namespace cuda
}  // namespace frontalis
