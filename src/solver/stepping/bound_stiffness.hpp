#pragma once

#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// Stiffness of points that are bound to voxels, for the bound of the highest frequency (physics/time_step.hpp). The
/// stiffness of a point on the nodes of its voxel is k w w^T, w its weights. The rows of these matrices, added over all
/// points, bound the eigenvalues of their sum divided by the masses (Gershgorin). Adds factor times the rows to `rows`,
/// one per node. `stiffness`: k of each point [N/m].
void add_stiffness_rows(const Model& model, const Binding& points, const std::vector<float>& stiffness, double factor,
                        std::vector<double>& rows);

/// Shares what is added to nodes, `rows`, among their voxels in proportion to the voxels' own bounds, which `voxels`
/// holds before and whose sums at nodes are `of_voxels` [N/m].
void share_rows(const Model& model, const std::vector<double>& rows, const std::vector<double>& of_voxels,
                std::vector<float>& voxels);

}  // namespace frontalis
