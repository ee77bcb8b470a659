#include "frontalis/solver/tissue_state.hpp"

#include "solver/voxel_centre.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

using physics::Matrix3;

// R m R^T, the components of a symmetric tensor in the face frame.
std::array<float, 6> in_face_frame(const RigidTransform& to_face, const Matrix3<double>& m)
{
  const auto& r = to_face.rotation;
  const auto component = [&](std::size_t i, std::size_t j)
  {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l)
        sum += r[3 * i + k] * m.a[k][l] * r[3 * j + l];
    return static_cast<float>(sum);
  };
  return { { component(0, 0), component(1, 1), component(2, 2), component(0, 1), component(1, 2), component(0, 2) } };
}

std::array<float, 3> rounded(const std::array<double, 3>& v)
{
  return { { static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]) } };
}

double stretch_along(const physics::Kinematics<double>& k, const std::array<float, 3>& direction)
{
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
  {
    double component = 0;
    for (std::size_t j = 0; j < 3; ++j)
      component += k.F.a[i][j] * double(direction[j]);
    sum += component * component;
  }
  return std::sqrt(sum);
}

}  // namespace

struct TissueReader::Implementation
{
  const Model& model;
  Discretisation discretisation;
  MainParts parts;
};

TissueReader::TissueReader(const Model& model)
    : self_(new Implementation{ model, Discretisation(model), MainParts(model) })
{
}

TissueReader::~TissueReader() = default;

const MainParts& TissueReader::parts() const { return self_->parts; }

void TissueReader::read(const Solver& solver, TissueState& out) const
{
  const Model& model = self_->model;
  std::vector<std::array<double, 3>> u;
  solver.displacements(u);
  const EffectSet running = solver.effects();
  std::vector<float> activation = solver.activation();
  if (!running.has(Effect::contraction))
    std::fill(activation.begin(), activation.end(), 0.0F);

  out.place.resize(u.size());
  out.displacement.resize(u.size());
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    std::array<double, 3> place = rest_position(model, n);
    for (std::size_t axis = 0; axis < 3; ++axis)
      place[axis] += u[n][axis];
    out.place[n] = rounded(model.to_face(place));
    out.displacement[n] = rounded(model.to_face.turned(u[n]));
  }
  const std::size_t voxels = model.voxels.size();
  out.strain.resize(voxels);
  out.stress.resize(voxels);
  out.von_mises.resize(voxels);
  out.volume_ratio.resize(voxels);
  out.fibre_stretch.resize(voxels);
  VoxelProperties properties;
  for (std::size_t e = 0; e < voxels; ++e)
  {
    self_->discretisation.voxel(e, properties);
    const auto k = deformation_at_centre(model, properties, e, u);
    const Matrix3<double> stress =
        cauchy_stress({ model, self_->discretisation, properties, e, &activation, running }, k);
    out.strain[e] = in_face_frame(model.to_face, green_lagrange_strain(k));
    out.stress[e] = in_face_frame(model.to_face, stress);
    out.von_mises[e] = static_cast<float>(von_mises(stress));
    out.volume_ratio[e] = static_cast<float>(k.J);
    const std::int32_t fibres = self_->parts.fibres[e];
    out.fibre_stretch[e] =
        fibres < 0 ? 1 : static_cast<float>(stretch_along(k, model.fibre_direction[static_cast<std::size_t>(fibres)]));
  }
}

}  // namespace frontalis
