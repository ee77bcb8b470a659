#pragma once

#include "frontalis/physics/element/voxel_readings.hpp"
#include "solver/cpu/cpu_element.hpp"
#include "solver/energy/plane_monitor.hpp"

namespace frontalis
{

/// Finds the energies, and the voxel with the smallest J, of each plane of voxels, in double precision because nearly
/// equal numbers are subtracted.
template <class Architecture>
struct CpuMonitor
{
  using Element = CpuElement<Architecture, double>;
  using Arguments = CpuKernelArguments<double>;
  using Batch = typename Element::Batch;
  using Voxels = typename Element::Voxels;
  static constexpr int lanes = Element::lanes;

  static void read(const Voxels& at, PlaneMonitor& plane, double* stiffness)
  {
    Batch mode[3][8];
    Element::load_centred_modes(at, at.g.u, mode);
    const physics::VoxelReadings<Batch> readings = physics::voxel_readings(at, mode);
    alignas(64) double internal[lanes], hourglass[lanes], jacobian[lanes], own[lanes];
    readings.internal.store_aligned(internal);
    readings.hourglass.store_aligned(hourglass);
    readings.jacobian.store_aligned(jacobian);
    readings.stiffness.store_aligned(own);
    for (int lane = 0; lane < lanes; ++lane)
    {
      const std::int32_t voxel = at.tile->voxel(at.offset + lane);
      if (voxel < 0)
        continue;
      plane.add(PlaneMonitor::of_voxel({ internal[lane], hourglass[lane], jacobian[lane], own[lane] }, voxel));
      stiffness[voxel] = own[lane];
    }
  }

  /// Processes voxel planes [first, last). `planes`: one entry per plane. `stiffness`: bound of each voxel [N/m].
  static void run(const Arguments& g, std::int32_t first, std::int32_t last, PlaneMonitor* planes, double* stiffness)
  {
    for (auto k = first; k < last; ++k)
      Element::each_batch(g, k, true, true, nullptr, [&](const Voxels& at) { read(at, planes[k], stiffness); });
  }
};

}  // namespace frontalis
