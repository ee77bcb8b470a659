#pragma once

#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// Adds the stiffness of points that are bound to voxels to `rows`, one sum per node, for the bound of the highest
/// frequency (physics/time_step.hpp). A point with the weights w has the stiffness matrix k w w^T on the nodes of its
/// voxel. By Gershgorin's theorem, the row sums of these matrices, added over all points and divided by the masses,
/// bound the eigenvalues of their sum. `stiffness`: k of each point [N/m]; `factor`: multiplies all of them.
void add_stiffness_rows(const Model& model, const Binding& points, const std::vector<float>& stiffness, double factor,
                        std::vector<double>& rows);

/// Converts stiffness that was added at nodes, `rows`, to stiffness that is added to voxels, such that the voxels at a
/// node together add at least as much. The addition to a voxel is its own bound, which `voxels` holds on entry, times
/// the largest ratio of `rows` to `of_voxels` at its nodes. `of_voxels`: sum of the voxels' bounds at each node [N/m].
void share_rows(const Model& model, const std::vector<double>& rows, const std::vector<double>& of_voxels,
                std::vector<float>& voxels);

}  // namespace frontalis
