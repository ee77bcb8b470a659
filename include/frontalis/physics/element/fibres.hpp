#pragma once

#include "frontalis/physics/muscle_fibre.hpp"
#include "frontalis/physics/voxel_element.hpp"

namespace frontalis
{
namespace physics
{

/// The fibres of one muscle in a voxel. T: number type of a batch of voxels; S: number type of values that the batch
/// shares.
template <class T, class S>
struct Fibre
{
  T direction[3];  ///< unit vector at rest
  T weight;        ///< fraction of the voxel that is this muscle, times tissue volume and stress reference [N m]
  S activation;    ///< 0..1
  S with_length;   ///< 1 if the tension-length relation applies, else 0
  bool passive;    ///< whether the fibre has a passive part
};

/// State of a fibre at a deformation.
template <class T>
struct FibreState
{
  T along[3];  ///< F a0, the deformed fibre direction
  T squared;   ///< squared stretch
  T stress;    ///< second Piola-Kirchhoff stress times the weight [N m]
};

template <class T, class S>
FRONTALIS_LAW FibreState<T> fibre_state(const Fibre<T, S>& fibre, const Kinematics<T>& k)
{
  const T* const a = fibre.direction;
  FibreState<T> state;
  for (int i = 0; i < 3; ++i)
    state.along[i] = k.F.a[i][0] * a[0] + k.F.a[i][1] * a[1] + k.F.a[i][2] * a[2];
  state.squared = state.along[0] * state.along[0] + state.along[1] * state.along[1] + state.along[2] * state.along[2];
  const T activation(fibre.activation), with_length(fibre.with_length);
  state.stress = fibre.passive
                     ? fibre_stress<T>(state.squared, fibre.weight, activation, with_length, Number<T>::of(1))
                     : fibre_stress<T, false>(state.squared, fibre.weight, activation, with_length, Number<T>::of(0));
  return state;
}

/// Whether the fibres of a muscle have any stress. Backends skip muscles that have none.
template <class S>
FRONTALIS_LAW bool has_stress(S activation, bool passive)
{
  return activation != 0 || passive;
}

/// Adds the fibres' first Piola-Kirchhoff stress: P += S (F a0) (x) a0.
template <class Voxel, class T>
FRONTALIS_LAW void add_fibres(const Voxel& voxel, const Kinematics<T>& k, Matrix3<T>& P)
{
  voxel.each_fibre(
      [&](const auto& fibre)
      {
        const FibreState<T> state = fibre_state(fibre, k);
        for (int i = 0; i < 3; ++i)
        {
          const T traction = state.stress * state.along[i];
          for (int j = 0; j < 3; ++j)
            P.a[i][j] = P.a[i][j] + traction * fibre.direction[j];
        }
      });
}

/// Work of fibres between two states [J]: minus the mean stress times the change of half the squared stretch.
FRONTALIS_LAW double fibre_work(double stress_before, double squared_before, double stress, double squared)
{
  return -0.25 * (stress_before + stress) * (squared - squared_before);
}

}  // namespace physics
}  // namespace frontalis
