#pragma once

#include "solver/cpu/cpu_kernel.hpp"
#include "frontalis/physics/assumed_strain.hpp"
#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/muscle_fibre.hpp"
#include "frontalis/physics/materials/neo_hookean.hpp"
#include "frontalis/physics/selective_reduced.hpp"
#include "frontalis/physics/time_step.hpp"
#include "frontalis/physics/viscosity.hpp"
#include "solver/cpu/simd_lanes.hpp"
#include "solver/material_laws.hpp"

namespace frontalis
{

/// What gives a voxel its stiffness against other motions than constant strain.
enum class Stabilisation
{
  scalar,
  assumed_strain,
  selective_reduced
};

/// Forces of the voxels of a tile, a batch of lanes at a time: one pass an effect over the stress while it is in
/// registers. The architecture is in the type, so that translation units of different instruction sets share no
/// instantiation.
template <class Architecture, class Real>
struct CpuElement
{
  using Arguments = CpuKernelArguments<Real>;
  using Lane = SimdLanes<Architecture, Real, Tile::strip>;
  using Batch = typename Lane::Batch;
  using N = physics::Number<Batch>;
  using Kinematics = physics::Kinematics<Batch>;
  using Stress = physics::Matrix3<Batch>;
  static constexpr int lanes = Lane::count;
  static_assert(Tile::width % lanes == 0, "a tile is a whole number of batches");

  struct Place;
  /// Adds an effect's stress; `work`: of fibres, where the ledger wants it.
  using Pass = void (*)(const Arguments& g, const Place& at, const Kinematics& k, Stress& P, double& work);

  /// The passes of each kind of tile, in a fixed order, null at their end.
  struct PassLists
  {
    Pass of[pass_combinations][3];
  };

  /// Which lanes, and where their forces go.
  struct Place
  {
    const Tile* tile;
    std::int32_t index;          ///< of the tile
    int offset;                  ///< first lane
    bool owned;                  ///< false in the plane that a slab computes for its neighbour's sake
    bool look;                   ///< frequencies wanted
    const Pass* pass = nullptr;  ///< those of the tile
  };

  static FRONTALIS_LAW Kinematics load_modes(const Arguments& g, const Place& at, Batch (&mode)[3][8])
  {
    return load_modes(g, at, g.u, mode);
  }

  /// Of displacements u.
  template <class Number>
  static FRONTALIS_LAW Kinematics load_modes(const Arguments& g, const Place& at, Number* const (&u)[3],
                                             Batch (&mode)[3][8])
  {
    const Tile& tile = *at.tile;
    const int strip = at.offset / Tile::strip, within = at.offset % Tile::strip;
    for (int c = 0; c < 3; ++c)
    {
      for (int r = 0; r < 4; ++r)
      {
        const Real* first = u[c] + tile.node[strip][r] + within;
        const Real* second = u[c] + tile.node[Tile::strips - 1][r];
        mode[c][2 * r] = Lane::load(first, second);
        mode[c][2 * r + 1] = Lane::load(first + 1, second + 1);
      }
      physics::walsh_hadamard(mode[c]);
    }
    return physics::kinematics(mode[0], mode[1], mode[2], g.scale);
  }

  static FRONTALIS_LAW void load_parameters(const LawSlot& slot, int offset, Batch* parameters)
  {
    for (int p = 0; p < 11; ++p)
      parameters[p] = Lane::load(slot.parameters[p] + offset);
  }

  // not inlined: most tiles have neo-Hookean voxels alone
  static __attribute__((noinline)) void add_laws(const Arguments& g, const Place& at, const Kinematics& k, Stress& P)
  {
    for (auto s = at.tile->law_begin; s < at.tile->law_end; ++s)
    {
      Batch parameters[11];
      load_parameters(g.laws[s], at.offset, parameters);
      add_law_stress(g.laws[s].law, parameters, Lane::load(g.laws[s].weight + at.offset), k, P);
    }
  }

  static FRONTALIS_LAW physics::NeoHookean<Batch> material_of(const Arguments& g, const Place& at)
  {
    const TileStiffness& s = g.stiffness[at.index];
    return { Lane::load(s.mu + at.offset), Lane::load(s.kappa + at.offset) };
  }

  static FRONTALIS_LAW physics::AssumedStrain<Batch> stabilisation_of(const Arguments& g, const Place& at)
  {
    const TileStabilisation& s = g.stabilisation[at.index];
    return { Lane::load(s.bending + at.offset), Lane::load(s.coupling + at.offset), Lane::load(s.torsion + at.offset),
             Lane::load(s.warping + at.offset) };
  }

  /// Elastic stress times volume.
  static FRONTALIS_LAW Stress elastic(const Arguments& g, const Place& at, const physics::NeoHookean<Batch>& material,
                                      const Kinematics& k)
  {
    const auto isotropic = physics::stress(material, k);
    Stress P;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        P.a[i][j] = isotropic.on_gradient * k.F.a[i][j] + isotropic.on_cofactor * k.cofactor.a[i][j];
    if (at.tile->law_begin < at.tile->law_end)
      add_laws(g, at, k, P);
    return P;
  }

  static FRONTALIS_LAW Batch fibre_stress(const Arguments& g, const FibreSlot& slot, int offset, const Kinematics& k,
                                          Batch (&a)[3], Batch (&along)[3], Batch& squared)
  {
    a[0] = Lane::load(slot.x + offset);
    a[1] = Lane::load(slot.y + offset);
    a[2] = Lane::load(slot.z + offset);
    for (int i = 0; i < 3; ++i)
      along[i] = k.F.a[i][0] * a[0] + k.F.a[i][1] * a[1] + k.F.a[i][2] * a[2];
    squared = along[0] * along[0] + along[1] * along[1] + along[2] * along[2];
    const Batch weight = Lane::load(slot.weight + offset);
    const Batch activation(static_cast<Real>(g.activation[slot.muscle]));
    const Batch with_length(static_cast<Real>(g.with_length[slot.muscle]));
    return g.with_passive[slot.muscle] != 0
               ? physics::fibre_stress<Batch>(squared, k.J, weight, activation, with_length, N::of(1))
               : physics::fibre_stress<Batch, false>(squared, k.J, weight, activation, with_length, N::of(0));
  }

  // the stress of the fibres: P += S (F a0) (x) a0
  static void add_fibres(const Arguments& g, const Place& at, const Kinematics& k, Stress& P, double& work)
  {
    for (auto s = at.tile->fibre_begin; s < at.tile->fibre_end; ++s)
    {
      // a muscle at rest without passive stress is not computed
      const std::int32_t muscle = g.fibres[s].muscle;
      if (g.activation[muscle] == 0 && g.with_passive[muscle] == 0)
        continue;
      Batch a[3], along[3], squared;
      const Batch S = fibre_stress(g, g.fibres[s], at.offset, k, a, along, squared);
      for (int i = 0; i < 3; ++i)
      {
        const Batch traction = S * along[i];
        for (int j = 0; j < 3; ++j)
          P.a[i][j] = P.a[i][j] + traction * a[j];
      }
    }
    if (g.fibre_memory != nullptr && at.owned)
      work += work_of_fibres(g, at, k);
  }

  // work that the fibres did since the last look: minus the mean of stress over the change of half the squared stretch
  static __attribute__((noinline)) double work_of_fibres(const Arguments& g, const Place& at, const Kinematics& k)
  {
    double work = 0;
    for (auto s = at.tile->fibre_begin; s < at.tile->fibre_end; ++s)
    {
      Batch a[3], along[3], squared;
      const Batch S = fibre_stress(g, g.fibres[s], at.offset, k, a, along, squared);
      FibreMemory& memory = g.fibre_memory[s];
      alignas(64) float stress[lanes], stretch[lanes];
      Lane::store(S, stress);
      Lane::store(squared, stretch);
      for (int lane = 0; lane < lanes; ++lane)
      {
        const int l = at.offset + lane;
        work -= 0.25 * (double(memory.stress[l]) + double(stress[lane])) *
                (double(stretch[lane]) - double(memory.squared[l]));
        memory.stress[l] = stress[lane];
        memory.squared[l] = stretch[lane];
      }
    }
    return work;
  }

  static float* relaxed_of(const Arguments& g, const Place& at, int tensor)
  {
    const auto slot = static_cast<std::size_t>(at.tile->viscous) * physics::relaxed_tensors(g.viscous_terms);
    return g.relaxed + (slot + tensor) * 6 * Tile::width + at.offset;
  }

  static FRONTALIS_LAW physics::Symmetric3<Batch> load_relaxed(const float* relaxed)
  {
    physics::Symmetric3<Batch> H;
    for (int n = 0; n < 6; ++n)
      H.a[n] = Lane::load(relaxed + n * Tile::width);
    return H;
  }

  static void add_viscosity(const Arguments& g, const Place& at, const Kinematics& k, Stress& P, double&)
  {
    take_relaxed(k, load_relaxed(relaxed_of(g, at, physics::relaxed_tensors(g.viscous_terms) - 1)), P);
  }

  /// Relaxes the viscous stresses of a tile towards those at the present displacements.
  static __attribute__((noinline)) void relax(const Arguments& g, const Place& at, double* work)
  {
    Batch mode[3][8];
    const Kinematics k = load_modes(g, at, mode);
    auto material = material_of(g, at);
    material.kappa = N::of(0);
    const auto S = physics::second_piola(k, elastic(g, at, material, k));
    // the other buffer holds where the step began
    const Kinematics k_before = work == nullptr ? k : load_modes(g, at, g.next, mode);
    const ViscousSlot& slot = g.viscous[at.tile->viscous];
    physics::Symmetric3<Batch> sum;
    for (Batch& component : sum.a)
      component = N::of(0);
    for (int term = 0; term < g.viscous_terms; ++term)
    {
      float* const relaxed = relaxed_of(g, at, term);
      auto H = load_relaxed(relaxed);
      const auto before = H;
      const Batch rate = Lane::load(slot.rate[term] + at.offset);
      physics::relax(Lane::load(slot.share[term] + at.offset), N::exp(-rate * Batch(g.viscous_elapsed)), S, H);
      for (int n = 0; n < 6; ++n)
      {
        Lane::store(H.a[n], relaxed + n * Tile::width);
        sum.a[n] = sum.a[n] + H.a[n];
      }
      if (work == nullptr)
        continue;
      alignas(64) Real first[lanes], second[lanes];
      physics::relaxation_work(k_before, k, before, H).store_aligned(first);
      along_strain(k, H).store_aligned(second);
      for (int lane = 0; lane < lanes; ++lane)
      {
        work[0] += double(first[lane]);
        work[1] += double(second[lane]);
      }
    }
    if (g.viscous_terms == 2)
      for (int n = 0; n < 6; ++n)
        Lane::store(sum.a[n], relaxed_of(g, at, 2) + n * Tile::width);
  }

  /// Bound of the largest eigenvalue of the stiffness now [N/m], NaN where motion is not finite.
  static __attribute__((noinline)) Batch stiffness_now(const Arguments& g, const Place& at, const Kinematics& k)
  {
    const Batch at_rest = Lane::load(g.stiffness[at.index].bound + at.offset);
    Batch now = physics::voxel_stiffness_now(at_rest, material_of(g, at), k, g.stretch_weight, g.stretch_half_sum);
    for (auto s = at.tile->law_begin; s < at.tile->law_end; ++s)
    {
      const LawSlot& slot = g.laws[s];
      Batch parameters[11];
      load_parameters(slot, at.offset, parameters);
      now = now + law_stiffening(slot.law, parameters, Lane::load(slot.at_rest + at.offset),
                                 Lane::load(slot.per_tangent + at.offset), k);
    }
    return now;
  }

  // isochoric stress at eight points: modes to the forces on them
  static __attribute__((noinline)) void gauss_points(const Arguments& g, const Place& at, Batch (&mode)[3][8],
                                                     Batch& stiffest)
  {
    auto material = material_of(g, at);
    material.kappa = N::of(0);
    Batch force[3][8];
    for (auto& component : force)
      for (Batch& f : component)
        f = N::of(0);
    for (int point = 0; point < 8; ++point)
    {
      Batch moved[3][8];
      physics::at_gauss_point(point, mode, moved);
      const auto k = physics::kinematics(moved[0], moved[1], moved[2], g.scale);
      physics::add_gauss_forces(point, elastic(g, at, material, k), g.scale, force);
      if (at.look)
        stiffest = physics::larger_or_none(stiffest, stiffness_now(g, at, k));
    }
    for (int c = 0; c < 3; ++c)
      for (int m = 0; m < 8; ++m)
        mode[c][m] = force[c][m];
  }

  // what every voxel gets at its centre
  template <Stabilisation Form>
  static FRONTALIS_LAW Stress centre_stress(const Arguments& g, const Place& at, const Kinematics& k, double& work)
  {
    auto material = material_of(g, at);
    Stress P;
    if (Form == Stabilisation::selective_reduced)
    {
      const Batch pressure = material.kappa * k.dilatation;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          P.a[i][j] = pressure * k.cofactor.a[i][j];
    }
    else
      P = elastic(g, at, material, k);
    for (const Pass* pass = at.pass; *pass != nullptr; ++pass)
      (*pass)(g, at, k, P, work);
    return P;
  }

  /// A pass more is a line more.
  static PassLists pass_lists(std::int32_t running)
  {
    PassLists lists{};
    for (std::int32_t mask = 0; mask < pass_combinations; ++mask)
    {
      Pass* to = lists.of[mask];
      if (mask & running & pass_fibres)
        *to++ = add_fibres;
      if (mask & running & pass_viscosity)
        *to++ = add_viscosity;
    }
    return lists;
  }

  /// Forces of the voxels, and where frequencies are wanted the bound of their stiffness, added to the plane buffers
  /// below and above.
  template <Stabilisation Form>
  static FRONTALIS_LAW void add_forces(const Arguments& g, const Place& at, Real* below, Real* above,
                                       const std::int32_t* base, double& work)
  {
    Batch mode[3][8];
    const Kinematics k = load_modes(g, at, mode);
    Stress P = centre_stress<Form>(g, at, k, work);
    Batch stiffest(Real(0));
    if (Form != Stabilisation::selective_reduced && at.look)
      stiffest = stiffness_now(g, at, k);
    const TileStiffness& stiffness = g.stiffness[at.index];
    const Batch hourglass = Lane::load(stiffness.hourglass + at.offset);
    if (Form == Stabilisation::assumed_strain)
      physics::hourglass_forces(stabilisation_of(g, at), hourglass, g.hourglass_weight, k.F, mode, P);
    if (Form == Stabilisation::selective_reduced)
      gauss_points(g, at, mode, stiffest);
    const int strip = at.offset / Tile::strip, within = at.offset % Tile::strip;
    const auto row_of = [&](int component, int r)
    { return (r < 2 ? below : above) + component * g.buffer_stride - base[r / 2]; };
    if (at.look)
      for (int r = 0; r < 4; ++r)
      {
        Real* const sum = row_of(3, r);
        Lane::add(sum + at.tile->node[strip][r] + within, sum + at.tile->node[Tile::strips - 1][r], stiffest, stiffest);
      }
    for (int c = 0; c < 3; ++c)
    {
      mode[c][0] = N::of(0);
      for (int j = 0; j < 3; ++j)
      {
        const Batch force = P.a[c][j] * Batch(g.scale[j]);
        Batch& to = mode[c][physics::gradient_mode(j)];
        to = Form == Stabilisation::selective_reduced ? to + force : force;
      }
      if (Form == Stabilisation::scalar)
        for (const int m : { 3, 5, 6, 7 })
          mode[c][m] = mode[c][m] * hourglass;
      physics::walsh_hadamard_transposed(mode[c]);
      for (int r = 0; r < 4; ++r)
      {
        Real* const force = row_of(c, r);
        Lane::add(force + at.tile->node[strip][r] + within, force + at.tile->node[Tile::strips - 1][r], mode[c][2 * r],
                  mode[c][2 * r + 1]);
      }
    }
  }
};

}  // namespace frontalis
