#pragma once

#include "frontalis/physics/element/voxel_forces.hpp"

namespace frontalis
{
namespace physics
{

/// Energies and bounds of a voxel for the monitor.
template <class T>
struct VoxelReadings
{
  T internal;   ///< elastic energy [J]
  T hourglass;  ///< energy of hourglass control [J]
  T jacobian;   ///< smallest det F
  T stiffness;  ///< bound of the largest eigenvalue of the stiffness [N/m]
};

/// Energy of the elastic laws [J]. `material`: the neo-Hookean material of the voxel, or that material with only one of
/// its two moduli.
template <class Voxel, class T>
FRONTALIS_LAW T elastic_energy(const Voxel& voxel, const NeoHookean<T>& material, const Kinematics<T>& k)
{
  T sum = energy(material, k);
  voxel.each_law([&](const auto& law) { sum = sum + law.energy(k); });
  return sum;
}

/// Energy of hourglass control [J] at transformed displacements.
template <class Voxel, class T>
FRONTALIS_LAW T hourglass_energy(const Voxel& voxel, const Kinematics<T>& k, const T (&mode)[3][8])
{
  const T scalar = voxel.hourglass();
  if (voxel.assumed_strain())
    return hourglass_energy(voxel.stabilisation(), scalar, voxel.hourglass_weight(), k.F, mode);
  T sum = Number<T>::of(0);
  for (const auto& component : mode)
    for (int m = 0; m < 8; ++m)
      if (is_hourglass_mode(m))
        sum = sum + component[m] * component[m];
  return Number<T>::of(0.5) * scalar * sum;
}

template <class Voxel, class T>
FRONTALIS_LAW VoxelReadings<T> voxel_readings(const Voxel& voxel, const T (&mode)[3][8])
{
  using N = Number<T>;
  const Kinematics<T> k = kinematics(mode[0], mode[1], mode[2], voxel.scale());
  NeoHookean<T> material = voxel.material();
  VoxelReadings<T> readings{ N::of(0), N::of(0), k.J, N::of(0) };
  if (!voxel.selective_reduced())
  {
    readings.internal = elastic_energy(voxel, material, k);
    readings.hourglass = hourglass_energy(voxel, k, mode);
    readings.stiffness = voxel.stiffness_now(k);
    return readings;
  }
  readings.internal = N::of(0.5) * material.kappa * k.dilatation * k.dilatation;
  material.kappa = N::of(0);
  for (int point = 0; point < 8; ++point)
  {
    T moved[3][8];
    at_gauss_point(point, mode, moved);
    const Kinematics<T> there = kinematics(moved[0], moved[1], moved[2], voxel.scale());
    readings.internal = readings.internal + N::of(0.125) * elastic_energy(voxel, material, there);
    readings.jacobian = N::min(readings.jacobian, there.J);
    readings.stiffness = larger_or_none(readings.stiffness, voxel.stiffness_now(there));
  }
  return readings;
}

}  // namespace physics
}  // namespace frontalis
