#pragma once

#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// Stiffness of points that are bound to voxels, for the bound of the highest frequency (physics/time_step.hpp). A
/// point with the weights w has the stiffness k w w^T on the nodes of its voxel. By Gershgorin, the rows of these
/// matrices, added over all points and divided by the masses, bound the eigenvalues of their sum. Adds factor times the
/// rows to `rows`, one per node. `stiffness`: k of each point [N/m].
void add_stiffness_rows(const Model& model, const Binding& points, const std::vector<float>& stiffness, double factor,
                        std::vector<double>& rows);

/// Distributes what is added to nodes, `rows`, to voxels: each gets its own bound, which `voxels` holds at first, times
/// the largest ratio of `rows` to `of_voxels`, the sum of the voxels' bounds [N/m], at one of its nodes.
void share_rows(const Model& model, const std::vector<double>& rows, const std::vector<double>& of_voxels,
                std::vector<float>& voxels);

}  // namespace frontalis
