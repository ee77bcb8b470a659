#pragma once

#include "frontalis/study/table.hpp"
#include "study/verification/verification_cases.hpp"

namespace frontalis
{

/// Young's modulus [Pa], Poisson's ratio and thickness [m] of a shell.
inline constexpr double shell_young = 1e6, shell_poisson = 0.49, shell_thickness = 2e-4;

/// A box of tissue under layers that are shells. The box is cut out of a larger one, so that the layers cover only the
/// top. Poisson's ratio is `shell_poisson` everywhere.
struct Slab
{
  struct Layer
  {
    double young, thickness;  ///< [Pa], [m]
  };
  Voxel size;
  double edge = 1e-3;                                             ///< edge of voxels [m]
  double base = 1e3;                                              ///< Young's modulus below the layers [Pa]
  std::vector<Layer> layers{ { shell_young, shell_thickness } };  ///< outermost first
  double depth = 0;  ///< depth of the first layer's upper side below the top [m]
  double rough = 2;  ///< edge of the triangles of which the layers' surface is made before the bake, in voxel edges
};

/// The slab, baked from a scene.
Model baked(const Slab& slab, const BakeScene& bake);

/// A film on a soft base, in plane strain.
struct Film
{
  std::vector<Slab::Layer> layers;  ///< outermost first; together they are one plate
  double base;                      ///< Young's modulus of the base [Pa]
  double edge;                      ///< edge of voxels [m]
  double height = 0;                ///< from the bottom of the base to the top of the film [m]; 0: deep, of one layer
  bool glides = false;              ///< whether the bottom of the base glides on bone, or is held by it
};

/// Compares critical compression and wavelength of a film with theory.
void check_film(const Film& film, const std::string& name, const BakeScene& bake, Table& table, Finding& finding);
/// A table for check_film().
Table film_table();

/// Returns whether a case can run. If not, the finding says why.
bool runs(const BakeScene& bake, Finding& finding);

}  // namespace frontalis
