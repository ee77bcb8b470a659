#pragma once

#include "solver/cpu/cpu_element.hpp"
#include "solver/energy/plane_monitor.hpp"

namespace frontalis
{

/// Energies and the worst voxel of each plane, in double: differences of nearly equal numbers are in them.
template <class Architecture>
struct CpuMonitor
{
  using Element = CpuElement<Architecture, double>;
  using Arguments = CpuKernelArguments<double>;
  using Lane = typename Element::Lane;
  using Batch = typename Element::Batch;
  using Kinematics = typename Element::Kinematics;
  using Place = typename Element::Place;
  using N = physics::Number<Batch>;
  static constexpr int lanes = Element::lanes;

  struct Found
  {
    Batch internal, hourglass, jacobian, stiffness;
  };

  // elastic energy, the volumetric part by kappa
  static Batch elastic_energy(const Arguments& g, const Place& at, const physics::NeoHookean<Batch>& material,
                              const Kinematics& k)
  {
    Batch sum = physics::energy(material, k);
    for (auto s = at.tile->law_begin; s < at.tile->law_end; ++s)
    {
      Batch parameters[11];
      Element::load_parameters(g.laws[s], at.offset, parameters);
      const Batch weight = Lane::load(g.laws[s].weight + at.offset);
      visit_law(g.laws[s].law, parameters,
                [&](const auto& law, const auto&... families)
                {
                  const Batch own = physics::energy(law, k, families...);
                  sum = sum + N::select(weight > N::of(0), weight * own, N::of(0));
                });
    }
    return sum;
  }

  static Batch hourglass_energy(const Arguments& g, const Place& at, const Kinematics& k, const Batch (&mode)[3][8])
  {
    const Batch scalar = Lane::load(g.stiffness[at.index].hourglass + at.offset);
    if (g.stabilisation != nullptr)
      return physics::hourglass_energy(Element::stabilisation_of(g, at), scalar, g.hourglass_weight, k.F, mode);
    Batch sum = N::of(0);
    for (const auto& component : mode)
      for (int m = 0; m < 8; ++m)
        if (physics::is_hourglass_mode(m))
          sum = sum + component[m] * component[m];
    return N::of(0.5) * scalar * sum;
  }

  static Found look(const Arguments& g, const Place& at)
  {
    Batch mode[3][8];
    const Kinematics k = Element::load_modes(g, at, mode);
    auto material = Element::material_of(g, at);
    Found found{ N::of(0), N::of(0), k.J, N::of(0) };
    if (!g.selective_reduced)
    {
      found.internal = elastic_energy(g, at, material, k);
      found.hourglass = hourglass_energy(g, at, k, mode);
      found.stiffness = Element::stiffness_now(g, at, k);
      return found;
    }
    found.internal = N::of(0.5) * material.kappa * k.dilatation * k.dilatation;
    material.kappa = N::of(0);
    for (int point = 0; point < 8; ++point)
    {
      Batch moved[3][8];
      physics::at_gauss_point(point, mode, moved);
      const auto there = physics::kinematics(moved[0], moved[1], moved[2], g.scale);
      found.internal = found.internal + N::of(0.125) * elastic_energy(g, at, material, there);
      found.jacobian = N::min(found.jacobian, there.J);
      found.stiffness = physics::larger_or_none(found.stiffness, Element::stiffness_now(g, at, there));
    }
    return found;
  }

  static void add(const Place& at, const Found& found, PlaneMonitor& plane, double* stiffness)
  {
    alignas(64) double internal[lanes], hourglass[lanes], jacobian[lanes], own[lanes];
    found.internal.store_aligned(internal);
    found.hourglass.store_aligned(hourglass);
    found.jacobian.store_aligned(jacobian);
    found.stiffness.store_aligned(own);
    for (int lane = 0; lane < lanes; ++lane)
    {
      const int l = at.offset + lane, strip = l / Tile::strip;
      if (l % Tile::strip < at.tile->count[strip])
      {
        const std::int32_t voxel = at.tile->first_voxel[strip] + l % Tile::strip;
        plane.add({ 0, internal[lane], hourglass[lane], jacobian[lane], jacobian[lane] <= 0 ? 1 : 0, voxel });
        stiffness[voxel] = own[lane];
      }
    }
  }

  /// Planes of voxels [first, last); `planes`: one a plane; stiffness: bound of each voxel [N/m].
  static void run(const Arguments& g, std::int32_t first, std::int32_t last, PlaneMonitor* planes, double* stiffness)
  {
    for (auto k = first; k < last; ++k)
      for (auto t = g.plane_tiles[k]; t < g.plane_tiles[k + 1]; ++t)
        for (int offset = 0; offset < Tile::width; offset += lanes)
          if (offset % Tile::strip < g.tiles[t].count[offset / Tile::strip])
          {
            const Place at{ g.tiles + t, t, offset, true, true };
            add(at, look(g, at), planes[k], stiffness);
          }
  }
};

}  // namespace frontalis
