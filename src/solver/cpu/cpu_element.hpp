#pragma once

#include "frontalis/physics/cut_voxels.hpp"
#include "frontalis/physics/element/relaxation.hpp"
#include "frontalis/physics/element/voxel_forces.hpp"
#include "solver/cpu/cpu_kernel.hpp"
#include "solver/cpu/prefetch.hpp"
#include "solver/cpu/simd_lanes.hpp"
#include "solver/law_share.hpp"

namespace frontalis
{

/// Kind of a voxel's resistance to hourglass modes.
enum class Stabilisation
{
  scalar,
  assumed_strain,
  selective_reduced
};

/// Forces of the voxels of a tile, one SIMD batch at a time. The mechanics are in physics/element/; this class provides
/// the data of a batch. The architecture is a template parameter, so that translation units for different instruction
/// sets share no instantiation.
template <class Architecture, class Real>
struct CpuElement
{
  using Arguments = CpuKernelArguments<Real>;
  using Lane = SimdLanes<Architecture, Real, Tile::strip>;
  using Batch = typename Lane::Batch;
  using N = physics::Number<Batch>;
  using Kinematics = physics::Kinematics<Batch>;
  using Stress = physics::Matrix3<Batch>;
  using Relaxed = physics::Symmetric3<Batch>;
  using Fibre = physics::Fibre<Batch, float>;
  static constexpr int lanes = Lane::count;
  static_assert(Tile::width % lanes == 0, "a tile is a whole number of batches");

  /// A batch of voxels in the form that physics/element/ reads. Functions for rare kinds of voxel are not inlined, so
  /// that common voxels do not need to spill registers for them.
  struct Voxels
  {
    const Arguments& g;
    const Tile* tile;
    std::int32_t index;  ///< of the tile
    int offset;          ///< first lane
    bool owned;          ///< false in the plane below a slab, which is computed here only for its upper nodes
    bool with_bound;     ///< whether stiffness bounds are computed
    double* work;        ///< sum of the work of fibres [J]; null without a ledger

    FRONTALIS_LAW Batch load(const float* lane_values) const { return Lane::load(lane_values + offset); }
    FRONTALIS_LAW const Real* scale() const { return g.scale; }
    FRONTALIS_LAW const Real* stretch_weight() const { return g.stretch_weight; }
    FRONTALIS_LAW Real stretch_half_sum() const { return g.stretch_half_sum; }
    FRONTALIS_LAW const Real* hourglass_weight() const { return g.hourglass_weight; }
    FRONTALIS_LAW bool assumed_strain() const { return g.stabilisation != nullptr; }
    FRONTALIS_LAW bool selective_reduced() const { return g.selective_reduced; }
    FRONTALIS_LAW physics::NeoHookean<Batch> material() const
    {
      const TileStiffness& s = g.stiffness[index];
      return { load(s.mu), load(s.kappa), load(s.stiffening) };
    }
    FRONTALIS_LAW Batch hourglass() const { return load(g.stiffness[index].hourglass); }
    FRONTALIS_LAW Batch bound_at_rest() const { return load(g.stiffness[index].bound); }
    FRONTALIS_LAW physics::AssumedStrain<Batch> stabilisation() const
    {
      const TileStabilisation& s = g.stabilisation[index];
      return { load(s.bending), load(s.coupling), load(s.torsion), load(s.warping) };
    }

    FRONTALIS_LAW physics::TissueCentre<Batch> centre() const
    {
      const CutSlot& slot = g.cut[tile->cut];
      return { load(slot.x), load(slot.y), load(slot.z) };
    }

    FRONTALIS_LAW bool has_laws() const { return tile->law_begin < tile->law_end; }
    template <class Visit>
    FRONTALIS_LAW void each_law(Visit&& visit) const
    {
      for (auto s = tile->law_begin; s < tile->law_end; ++s)
      {
        prefetch(g.laws + s + 1);
        const LawSlot& slot = g.laws[s];
        LawShare<Batch> law{ slot.law, load(slot.weight), load(slot.at_rest), load(slot.per_tangent), {} };
        for (int p = 0; p < 11; ++p)
          law.parameters[p] = load(slot.parameters[p]);
        visit(law);
      }
    }
    __attribute__((noinline)) void add_laws(const Kinematics& k, Stress& P) const { physics::add_laws(*this, k, P); }
    FRONTALIS_LAW Batch law_stiffening(const Kinematics& k) const { return physics::law_stiffening(*this, k); }
    __attribute__((noinline)) Batch stiffness_now(const Kinematics& k) const
    {
      return physics::stiffness_now(*this, k);
    }
    __attribute__((noinline)) void gauss_forces(Batch (&mode)[3][8], bool wanted, Batch& stiffness) const
    {
      physics::gauss_forces(*this, mode, wanted, stiffness);
    }

    FRONTALIS_LAW Fibre fibre(std::int32_t s) const
    {
      const FibreSlot& slot = g.fibres[s];
      const std::int32_t muscle = g.fibre_muscle[s];
      return { { load(slot.x), load(slot.y), load(slot.z) },
               load(slot.weight),
               g.activation[muscle],
               g.with_length[muscle],
               g.with_passive[muscle] != 0 };
    }
    template <class Visit>
    FRONTALIS_LAW void each_fibre(Visit&& visit) const
    {
      // Slots are fetched early, because those of a model do not fit into the cache of a core.
      constexpr int ahead = 2;
      for (auto s = tile->fibre_begin; s < tile->fibre_end; ++s)
      {
        const std::int32_t muscle = g.fibre_muscle[s];
        if (!physics::has_stress(g.activation[muscle], g.with_passive[muscle] != 0))
          continue;
        prefetch(g.fibres + s + ahead);
        visit(fibre(s));
      }
    }
    FRONTALIS_LAW void add_fibres(const Kinematics& k, Stress& P) const
    {
      if (g.fibres != nullptr && tile->fibre_begin < tile->fibre_end)
        add_fibres_apart(k, P);
    }
    __attribute__((noinline)) void add_fibres_apart(const Kinematics& k, Stress& P) const
    {
      physics::add_fibres(*this, k, P);
      if (g.fibre_memory != nullptr && owned)
        add_fibre_work(k);
    }
    // Adds the work that the fibres have done since the previous call.
    __attribute__((noinline)) void add_fibre_work(const Kinematics& k) const
    {
      for (auto s = tile->fibre_begin; s < tile->fibre_end; ++s)
      {
        const auto now = physics::fibre_state(fibre(s), k);
        FibreMemory& memory = g.fibre_memory[s];
        alignas(64) float stress[lanes], squared[lanes];
        Lane::store(now.stress, stress);
        Lane::store(now.squared, squared);
        for (int lane = 0; lane < lanes; ++lane)
        {
          const int l = offset + lane;
          *work += physics::fibre_work(memory.stress[l], memory.squared[l], stress[lane], squared[lane]);
          memory.stress[l] = stress[lane];
          memory.squared[l] = squared[lane];
        }
      }
    }

    FRONTALIS_LAW int viscous_terms() const { return g.viscous_terms; }
    FRONTALIS_LAW physics::ViscousTerm<Batch> viscous_term(int n) const
    {
      const ViscousSlot& slot = g.viscous[tile->viscous];
      return { load(slot.share[n]), load(slot.rate[n]) };
    }
    FRONTALIS_LAW float* relaxed_at(int tensor) const
    {
      const auto slot = static_cast<std::size_t>(tile->viscous) * physics::relaxed_tensors(g.viscous_terms);
      return g.relaxed + (slot + tensor) * 6 * Tile::width;
    }
    FRONTALIS_LAW Relaxed relaxed(int tensor) const
    {
      const float* const from = relaxed_at(tensor);
      Relaxed H;
      for (int n = 0; n < 6; ++n)
        H.a[n] = load(from + n * Tile::width);
      return H;
    }
    FRONTALIS_LAW void keep_relaxed(int tensor, const Relaxed& H) const
    {
      float* const to = relaxed_at(tensor) + offset;
      for (int n = 0; n < 6; ++n)
        Lane::store(H.a[n], to + n * Tile::width);
    }
    FRONTALIS_LAW void add_viscosity(const Kinematics& k, Stress& P) const
    {
      if (g.viscous_terms > 0 && tile->viscous >= 0)
        add_viscosity_apart(k, P);
    }
    __attribute__((noinline)) void add_viscosity_apart(const Kinematics& k, Stress& P) const
    {
      physics::add_viscosity(*this, k, P);
    }
  };

  /// Voxels whose kind of hourglass control is known at compile time.
  template <Stabilisation Form>
  struct VoxelsOf : Voxels
  {
    static constexpr bool assumed_strain() { return Form == Stabilisation::assumed_strain; }
    static constexpr bool selective_reduced() { return Form == Stabilisation::selective_reduced; }
    FRONTALIS_LAW void scalar_hourglass(Batch (&)[3][8]) const {}  // done in add_forces()
  };

  /// Voxels with no more than neo-Hookean stress and fibres, whose work is not needed. All of their code is inlined, so
  /// that fewer values pass through memory.
  template <Stabilisation Form, bool WithBound>
  struct SimpleVoxels : VoxelsOf<Form>
  {
    static constexpr bool with_bound = WithBound;
    static bool are(const VoxelsOf<Form>& at)
    {
      return at.tile->simple && at.with_bound == WithBound && at.g.fibre_memory == nullptr;
    }
    static constexpr bool has_laws() { return false; }
    FRONTALIS_LAW void add_laws(const Kinematics&, Stress&) const {}
    FRONTALIS_LAW void add_viscosity(const Kinematics&, Stress&) const {}
    FRONTALIS_LAW Batch stiffness_now(const Kinematics& k) const
    {
      return WithBound ? physics::stiffness_now(*this, k) : Batch(Real(0));
    }
    FRONTALIS_LAW void add_fibres(const Kinematics& k, Stress& P) const
    {
      if (this->g.fibres != nullptr)
        physics::add_fibres(*this, k, P);
    }
  };

  /// Calls visit() with the batches of a plane's tiles that hold voxels, as Voxels or VoxelsOf.
  template <class Batches = Voxels, class Visit>
  static FRONTALIS_LAW void each_batch(const Arguments& g, std::int32_t plane, bool owned, bool with_bound,
                                       double* work, Visit&& visit)
  {
    for (auto t = g.plane_tiles[plane]; t < g.plane_tiles[plane + 1]; ++t)
      for (int offset = 0; offset < Tile::width; offset += lanes)
        if (offset % Tile::strip < g.tiles[t].count[offset / Tile::strip])
        {
          prefetch(g.stiffness + t + 1);
          visit(Batches{ g, g.tiles + t, t, offset, owned, with_bound, work });
        }
  }

  /// Loads the displacements of the corners and transforms them to modes.
  template <class Number>
  static FRONTALIS_LAW void load_modes(const Voxels& at, Number* const (&u)[3], Batch (&mode)[3][8])
  {
    load_component(at, u[0], mode[0]);
    load_component(at, u[1], mode[1]);
    load_component(at, u[2], mode[2]);
  }
  static FRONTALIS_LAW void load_component(const Voxels& at, const Real* u, Batch (&mode)[8])
  {
    const Tile& tile = *at.tile;
    const int strip = at.offset / Tile::strip, within = at.offset % Tile::strip;
    for (int r = 0; r < 4; ++r)
    {
      const Real* first = u + tile.node[strip][r] + within;
      const Real* second = u + tile.node[Tile::strips - 1][r];
      mode[2 * r] = Lane::load(first, second);
      mode[2 * r + 1] = Lane::load(first + 1, second + 1);
    }
    physics::walsh_hadamard(mode);
  }
  /// Like load_modes(), with the gradients at the centroids of the tissue.
  template <class Number>
  static FRONTALIS_LAW void load_centred_modes(const Voxels& at, Number* const (&u)[3], Batch (&mode)[3][8])
  {
    load_modes(at, u, mode);
    for (int c = 0; c < 3 && at.tile->cut >= 0; ++c)
      physics::to_tissue_centre(at.centre(), mode[c]);
  }
  template <class Number>
  static FRONTALIS_LAW Kinematics kinematics(const Voxels& at, Number* const (&u)[3])
  {
    Batch mode[3][8];
    load_centred_modes(at, u, mode);
    return physics::kinematics(mode[0], mode[1], mode[2], at.g.scale);
  }

  /// Relaxes viscous stresses towards those of the present displacements. `work`: see CpuKernelArguments::viscous_work;
  /// may be null.
  static __attribute__((noinline)) void relax(const Voxels& at, double* work)
  {
    const Kinematics k = kinematics(at, at.g.u);
    // `next` still holds the displacements before the step.
    const Kinematics k_before = work == nullptr ? k : kinematics(at, at.g.next);
    physics::relax_voxel(at, Batch(at.g.viscous_elapsed), k,
                         [&](const Relaxed& before, const Relaxed& after)
                         {
                           if (work == nullptr)
                             return;
                           work[0] += sum(physics::relaxation_work(k_before, k, before, after));
                           work[1] += sum(along_strain(k, after));
                         });
  }

  /// Sum of a batch in double precision, in the order of its lanes.
  static double sum(const Batch& x)
  {
    alignas(64) Real lane_values[lanes];
    x.store_aligned(lane_values);
    double result = 0;
    for (const Real lane_value : lane_values)
      result += double(lane_value);
    return result;
  }

  /// Adds the forces of the voxels, and their stiffness bounds if requested, to the plane buffers below and above.
  template <Stabilisation Form, bool Cut, class Some>
  static FRONTALIS_LAW void add_forces(const Some& at, Real* below, Real* above, const std::int32_t* base)
  {
    const Arguments& g = at.g;
    Batch mode[3][8], stiffness(Real(0));
    load_modes(at, g.u, mode);
    for (int c = 0; c < 3 && Cut; ++c)
      physics::to_tissue_centre(at.centre(), mode[c]);
    Stress P = physics::element_stress(at, mode, at.with_bound, stiffness);
    const Batch hourglass = at.hourglass();
    if (at.with_bound)
    {
      Batch bound[8];
      for (int corner = 0; corner < 8; ++corner)
        bound[corner] = Cut ? stiffness * at.load(g.cut[at.tile->cut].corner[corner]) : stiffness;
      add_corners(at, 3, bound, below, above, base);
    }
    // The components are processed one by one, so that each stays in registers.
    const auto add_component = [&](int c) __attribute__((always_inline))
    {
      if (Form == Stabilisation::scalar)
        physics::scalar_hourglass(hourglass, mode[c]);
      physics::stress_forces(at, P, c, mode[c]);
      if (Cut)
        physics::from_tissue_centre(at.centre(), mode[c]);
      physics::walsh_hadamard_transposed(mode[c]);
      add_corners(at, c, mode[c], below, above, base);
    };
    add_component(0);
    add_component(1);
    add_component(2);
  }

  /// Adds one component of the values at the corners of the voxels to the plane buffers.
  static FRONTALIS_LAW void add_corners(const Voxels& at, int component, const Batch (&value)[8], Real* below,
                                        Real* above, const std::int32_t* base)
  {
    const Tile& tile = *at.tile;
    const int strip = at.offset / Tile::strip, within = at.offset % Tile::strip;
    const auto row_of = [&](int r, int s)
    { return (r < 2 ? below : above) + component * at.g.buffer_stride - base[r / 2] + tile.node[s][r] + within; };
    const int other = Tile::strips - 1;
    Lane::add(row_of(0, strip), row_of(0, other), value[0], value[1]);
    Lane::add(row_of(2, strip), row_of(2, other), value[4], value[5]);
    Lane::add(row_of(1, strip), row_of(1, other), value[2], value[3]);
    Lane::add(row_of(3, strip), row_of(3, other), value[6], value[7]);
  }
  // The next functions are not inlined, so that the compiler generates the same code for simple voxels without bounds
  // as without them.
  template <Stabilisation Form>
  static __attribute__((noinline)) void add_simple_forces_and_bounds(const VoxelsOf<Form>& at, Real* below, Real* above,
                                                                     const std::int32_t* base)
  {
    add_forces<Form, false>(SimpleVoxels<Form, true>{ at }, below, above, base);
  }
  template <Stabilisation Form>
  static __attribute__((noinline)) void add_other_forces(const VoxelsOf<Form>& at, Real* below, Real* above,
                                                         const std::int32_t* base)
  {
    add_forces<Form, false>(at, below, above, base);
  }
  template <Stabilisation Form>
  static __attribute__((noinline)) void add_cut_forces(const VoxelsOf<Form>& at, Real* below, Real* above,
                                                       const std::int32_t* base)
  {
    add_forces<Form, true>(at, below, above, base);
  }
};

}  // namespace frontalis
