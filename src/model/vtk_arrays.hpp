#pragma once

#include "frontalis/model/model.hpp"
#include "model/hdf5_file.hpp"

namespace frontalis
{

/// Writes the group VTKHDF, version 1.0, an unstructured grid of VTK_VOXEL cells (whose corner order is ours), with
/// material, fill, muscle and fibre of each voxel and the constraint of each node, so that ParaView opens the model
/// file. Points are in local coordinates [m].
void write_vtk_arrays(Hdf5File& file, const Model& model);

}  // namespace frontalis
