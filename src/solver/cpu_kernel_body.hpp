#pragma once

#include "cpu_kernel.hpp"
#include "frontalis/physics/assumed_strain.hpp"
#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/muscle_fibre.hpp"
#include "frontalis/physics/neo_hookean.hpp"
#include "frontalis/physics/time_step.hpp"
#include "material_laws.hpp"
#include "simd_number.hpp"

namespace frontalis
{
// the architecture is in every type, so that translation units of different instruction sets share no instantiation
template <class Architecture>
struct CpuKernelBody
{
  using Batch = xsimd::batch<float, Architecture>;
  static constexpr int lanes = static_cast<int>(Batch::size);
  static_assert(Tile::width % lanes == 0, "a tile is a whole number of batches");

  static FRONTALIS_LAW Batch load(const float* p) { return Batch::load_unaligned(p); }

  // a batch of one strip's lanes, or of both strips' of a tile
  static FRONTALIS_LAW Batch load(const float* first, [[maybe_unused]] const float* second)
  {
#if defined(__AVX512F__)
    if constexpr (lanes == Tile::width)
      return _mm512_insertf32x8(_mm512_castps256_ps512(_mm256_loadu_ps(first)), _mm256_loadu_ps(second), 1);
#endif
    return load(first);
  }
  // adds forces to the nodes of a row: `low` to the voxels' lower nodes, `high` to the nodes next to them. Neighbours
  // share nodes, so the two are added up in registers first: storing one and loading the other across it would stall
  static FRONTALIS_LAW void add(float* first, [[maybe_unused]] float* second, const Batch& low, const Batch& high)
  {
#if defined(__AVX512F__)
    if constexpr (lanes == Tile::width)
    {
      alignas(64) float last[Tile::width];
      _mm512_store_ps(last, high);
      if (second == first + Tile::strip)
      {
        const __m512i next = _mm512_set_epi32(14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0, 0);
        const __m512 sum = _mm512_add_ps(low, _mm512_maskz_permutexvar_ps(0xfffe, next, high));
        _mm512_storeu_ps(first, _mm512_add_ps(_mm512_loadu_ps(first), sum));
        first[Tile::width] += last[Tile::width - 1];
        return;
      }
      const __m512i next = _mm512_set_epi32(14, 13, 12, 11, 10, 9, 8, 8, 6, 5, 4, 3, 2, 1, 0, 0);
      const __m512 sum = _mm512_add_ps(low, _mm512_maskz_permutexvar_ps(0xfefe, next, high));
      // one strip after the other: they may share nodes
      _mm256_storeu_ps(first, _mm256_add_ps(_mm256_loadu_ps(first), _mm512_castps512_ps256(sum)));
      first[Tile::strip] += last[Tile::strip - 1];
      _mm256_storeu_ps(second, _mm256_add_ps(_mm256_loadu_ps(second), _mm512_extractf32x8_ps(sum, 1)));
      second[Tile::strip] += last[Tile::width - 1];
      return;
    }
#endif
    (load(first) + low).store_unaligned(first);
    (load(first + 1) + high).store_unaligned(first + 1);
  }

  // adds the stress of the fibres: P += S (F a0) (x) a0
  static FRONTALIS_LAW void add_fibres(const CpuKernelArguments& g, const Tile& tile, int offset,
                                       const physics::Kinematics<Batch>& k, physics::Matrix3<Batch>& P)
  {
    for (auto s = tile.fibre_begin; s < tile.fibre_end; ++s)
    {
      const FibreSlot& slot = g.fibres[s];
      const Batch a[3] = { load(slot.x + offset), load(slot.y + offset), load(slot.z + offset) };
      Batch along[3];
      for (int i = 0; i < 3; ++i)
        along[i] = k.F.a[i][0] * a[0] + k.F.a[i][1] * a[1] + k.F.a[i][2] * a[2];
      const Batch squared = along[0] * along[0] + along[1] * along[1] + along[2] * along[2];
      const Batch S =
          physics::fibre_stress<Batch>(squared, k.J, load(slot.weight + offset), Batch(g.activation[slot.muscle]),
                                       Batch(g.with_length[slot.muscle]), Batch(g.with_passive[slot.muscle]));
      for (int i = 0; i < 3; ++i)
      {
        const Batch traction = S * along[i];
        for (int j = 0; j < 3; ++j)
          P.a[i][j] = P.a[i][j] + traction * a[j];
      }
    }
  }

  static FRONTALIS_LAW void load_parameters(const LawSlot& slot, int offset, Batch* parameters)
  {
    for (int p = 0; p < 11; ++p)
      parameters[p] = load(slot.parameters[p] + offset);
  }

  // not inlined: most tiles have neo-Hookean voxels alone
  static __attribute__((noinline)) void add_laws(const CpuKernelArguments& g, const Tile& tile, int offset,
                                                 const physics::Kinematics<Batch>& k, physics::Matrix3<Batch>& P)
  {
    for (auto s = tile.law_begin; s < tile.law_end; ++s)
    {
      Batch parameters[11];
      load_parameters(g.laws[s], offset, parameters);
      add_law_stress(g.laws[s].law, parameters, load(g.laws[s].weight + offset), k, P);
    }
  }

  // adds to the frequency bound squared what the laws have stiffened since rest
  static __attribute__((noinline)) void add_law_frequencies(const CpuKernelArguments& g, const Tile& tile, int offset,
                                                            const physics::Kinematics<Batch>& k, Batch& squared)
  {
    using N = physics::Number<Batch>;
    for (auto s = tile.law_begin; s < tile.law_end; ++s)
    {
      Batch parameters[11];
      load_parameters(g.laws[s], offset, parameters);
      const Batch more = law_stiffness(g.laws[s].law, parameters, k) - load(g.laws[s].at_rest + offset);
      squared = squared + load(g.laws[s].inertia + offset) * N::max(more, N::of(0));
    }
  }

  // forces of a tile's voxels [offset, offset + lanes) added to the plane buffers below and above
  template <bool Look, bool AssumedStrain>
  static FRONTALIS_LAW void element(const CpuKernelArguments& g, const Tile& tile, std::size_t block, int offset,
                                    float* below, float* above, const std::int32_t* base, Batch& frequency_squared)
  {
    using N = physics::Number<Batch>;
    const int strip = offset / Tile::strip, within = offset % Tile::strip;
    Batch mode[3][8];
    for (int c = 0; c < 3; ++c)
    {
      for (int r = 0; r < 4; ++r)
      {
        const float* first = g.u[c] + tile.node[strip][r] + within;
        const float* second = g.u[c] + tile.node[Tile::strips - 1][r];
        mode[c][2 * r] = load(first, second);
        mode[c][2 * r + 1] = load(first + 1, second + 1);
      }
      physics::walsh_hadamard(mode[c]);
    }
    const auto k = physics::kinematics(mode[0], mode[1], mode[2], g.scale);
    const physics::NeoHookean<Batch> material{ load(g.mu + block + offset), load(g.kappa + block + offset) };
    const auto isotropic = physics::stress(material, k);
    physics::Matrix3<Batch> P;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        P.a[i][j] = isotropic.on_gradient * k.F.a[i][j] + isotropic.on_cofactor * k.cofactor.a[i][j];
    if (tile.fibre_begin < tile.fibre_end)
      add_fibres(g, tile, offset, k, P);
    if (tile.law_begin < tile.law_end)
      add_laws(g, tile, offset, k, P);
    if (Look)
    {
      const Batch growth = physics::stiffening(material, k, g.stretch_weight);
      Batch now = load(g.frequency_squared + block + offset) * N::max(growth, N::of(1));
      if (tile.law_begin < tile.law_end)
        add_law_frequencies(g, tile, offset, k, now);
      // growth - growth is 0, or NaN for good where motion is not finite
      frequency_squared = N::max(frequency_squared, now) + (growth - growth);
    }
    const Batch hourglass = load(g.hourglass + block + offset);
    if (AssumedStrain)
    {
      const physics::AssumedStrain<Batch> stiffness{ load(g.assumed_strain[0] + block + offset),
                                                     load(g.assumed_strain[1] + block + offset),
                                                     load(g.assumed_strain[2] + block + offset),
                                                     load(g.assumed_strain[3] + block + offset) };
      physics::hourglass_forces(stiffness, hourglass, g.hourglass_weight, k.F, mode, P);
    }
    for (int c = 0; c < 3; ++c)
    {
      mode[c][0] = N::of(0);
      for (int j = 0; j < 3; ++j)
        mode[c][physics::gradient_mode(j)] = P.a[c][j] * Batch(g.scale[j]);
      if (!AssumedStrain)
        for (const int m : { 3, 5, 6, 7 })
          mode[c][m] = mode[c][m] * hourglass;
      physics::walsh_hadamard_transposed(mode[c]);
      for (int r = 0; r < 4; ++r)
      {
        float* force = (r < 2 ? below : above) + c * g.buffer_stride - base[r / 2];
        float* first = force + tile.node[strip][r] + within;
        float* second = force + tile.node[Tile::strips - 1][r];
        add(first, second, mode[c][2 * r], mode[c][2 * r + 1]);
      }
    }
  }

  template <bool Look, bool AssumedStrain>
  static float plane_forces(const CpuKernelArguments& g, std::int32_t plane, float* below, float* above)
  {
    Batch frequency_squared(0.0f);
    const std::int32_t base[2] = { g.plane_nodes[plane], g.plane_nodes[plane + 1] };
    for (auto t = g.plane_tiles[plane]; t < g.plane_tiles[plane + 1]; ++t)
    {
      const Tile& tile = g.tiles[t];
      for (int offset = 0; offset < Tile::width; offset += lanes)
        if (offset % Tile::strip < tile.count[offset / Tile::strip])
          element<Look, AssumedStrain>(g, tile, static_cast<std::size_t>(t) * Tile::width, offset, below, above, base,
                                       frequency_squared);
    }
    float result = 0;
    if (Look)
    {
      float lane[lanes];
      frequency_squared.store_unaligned(lane);
      for (const float x : lane)
        result = larger(result, x);
    }
    return result;
  }

  static void update(const CpuKernelArguments& g, std::int32_t plane, const float* force)
  {
    const std::int32_t first = g.plane_nodes[plane], count = g.plane_nodes[plane + 1] - first;
    for (int c = 0; c < 3; ++c)
    {
      const float* f = force + c * g.buffer_stride;
      const float* u = g.u[c] + first;
      const float* inverse_mass = g.inverse_mass + first;
      float* __restrict v = g.v[c] + first;
      float* __restrict next = g.next[c] + first;
      const float impulse = g.impulse[c];
      for (std::int32_t n = 0; n < count; ++n)
      {
        const float velocity = g.keep * v[n] - g.gain * inverse_mass[n] * f[n] + impulse;
        v[n] = velocity;
        next[n] = u[n] + g.dt * velocity;
      }
    }
  }

  // the larger one; NaN once one was NaN
  static float larger(float a, float b) { return (a >= b ? a : b) + (a - a) + (b - b); }

  static void clear(float* p, std::int32_t count)
  {
    for (std::int32_t i = 0; i < count; ++i)
      p[i] = 0;
  }

  template <bool Look, bool AssumedStrain>
  static float step(const CpuKernelArguments& g, std::int32_t first, std::int32_t last, float* buffer, bool forces_only)
  {
    float* below = buffer;
    float* above = buffer + 3 * static_cast<std::size_t>(g.buffer_stride);
    clear(below, 3 * g.buffer_stride);
    float frequency_squared = 0;
    // voxel plane k joins node planes k and k + 1; the one below the first plane is computed for its upper nodes alone
    for (std::int32_t k = first - 1; k < last; ++k)
    {
      clear(above, 3 * g.buffer_stride);
      if (k >= 0 && k < g.planes - 1)
      {
        const float now = plane_forces<Look, AssumedStrain>(g, k, below, above);
        frequency_squared = larger(frequency_squared, now);
      }
      if (k >= first)
      {
        if (forces_only)
          for (int c = 0; c < 3; ++c)
            for (std::int32_t n = g.plane_nodes[k]; n < g.plane_nodes[k + 1]; ++n)
              g.next[c][n] = below[c * g.buffer_stride + n - g.plane_nodes[k]];
        else
          update(g, k, below);
      }
      float* const swapped = below;
      below = above;
      above = swapped;
    }
    return frequency_squared;
  }

  static float run(const CpuKernelArguments& g, std::int32_t first, std::int32_t last, float* buffer, KernelTask task)
  {
    const bool look = task == KernelTask::step_and_look, forces_only = task == KernelTask::forces;
    if (g.assumed_strain[0] != nullptr)
      return look ? step<true, true>(g, first, last, buffer, false)
                  : step<false, true>(g, first, last, buffer, forces_only);
    return look ? step<true, false>(g, first, last, buffer, false)
                : step<false, false>(g, first, last, buffer, forces_only);
  }
};

}  // namespace frontalis
