#include "solver/stepping/host_backend.hpp"

#include "frontalis/physics/time_step.hpp"
#include "frontalis/physics/viscosity.hpp"
#include "solver/skin/bound_points.hpp"
#include "solver/stepping/step_bound.hpp"

#include <cstring>

namespace frontalis
{
namespace
{

struct HostState : BackendState
{
  std::vector<char> bytes;

  void archive(ByteArchive& archive) override
  {
    const std::size_t size = bytes.size();
    archive(bytes);
    if (bytes.size() != size)
      throw Error("a state of " + std::to_string(bytes.size()) + " bytes; allowed are " + std::to_string(size));
  }
};

}  // namespace

template <class Real, class Relaxed>
HostBackend<Real, Relaxed>::HostBackend(const BackendInput& input, std::size_t padding,
                                        const PartKernels<Real>& kernels)
    : StepBackend(input),
      mobility_(mobility(discretisation_)),
      parts_(node_parts<Real>(*model_, discretisation_, kernels))
{
  for (auto* field : { &u_, &v_ })
    for (auto& component : *field)
      component.assign(model_->nodes.size() + padding, 0);
  if (input.settings.ledger)
    account_ = std::make_unique<EnergyAccount<Real>>(*model_, discretisation_);
}

template <class Real, class Relaxed>
void HostBackend<Real, Relaxed>::rest()
{
  for (auto* field : { &u_, &v_ })
    for (auto& component : *field)
      std::fill(component.begin(), component.end(), Real(0));
  mobility_ = mobility(discretisation_);
  relaxed_.reset();
  for (const auto& part : parts_)
    part->reset();
}

template <class Real, class Relaxed>
Real HostBackend<Real, Relaxed>::fastest_squared(const NodeShare& share) const
{
  constexpr int lanes = 8;
  Real most[lanes] = {};
  for (std::int32_t n = share.first_node; n < share.end_node; ++n)
    most[n % lanes] =
        physics::larger_or_none(most[n % lanes], v_[0][n] * v_[0][n] + v_[1][n] * v_[1][n] + v_[2][n] * v_[2][n]);
  Real all = 0;
  for (const Real lane : most)
    all = physics::larger_or_none(all, lane);
  return all;
}

template <class Real, class Relaxed>
void HostBackend<Real, Relaxed>::list_arrays(ArrayList& list)
{
  for (auto* field : { &u_, &v_ })
    for (auto& component : *field)
      list.add_state("motion", component);
  if (model_->time_step_estimate == TimeStepEstimate::assembled)
    list.add_state("inverse masses", mobility_);
  else
    list.add("inverse masses", mobility_);
  relaxed_.list_arrays(list);
  for (const auto& part : parts_)
    part->list_arrays(list);
  if (account_)
    account_->list_arrays(list);
  if (search_)
    search_->list_arrays(list);
}

template <class Real, class Relaxed>
void HostBackend<Real, Relaxed>::effects_switched()
{
  relaxed_.run(conditions_.running);
  for (const auto& part : parts_)
    part->run(conditions_.running);
}

template <class Real, class Relaxed>
std::vector<NodePart<Real>*> HostBackend<Real, Relaxed>::active_parts() const
{
  std::vector<NodePart<Real>*> active;
  for (const auto& part : parts_)
    if (!part->idle())
      active.push_back(part.get());
  return active;
}

template <class Real, class Relaxed>
void HostBackend<Real, Relaxed>::add_energies(bool open, NodalVectors& forces, EnergyLedger& ledger)
{
  for (NodePart<Real>* const part : active_parts())
    part->add_energies(pointers(u_).data(), conditions_.bone, open, forces, ledger);
}

template <class Real, class Relaxed>
std::vector<Reaction> HostBackend<Real, Relaxed>::reactions() const
{
  std::vector<Reaction> all;
  for (const auto& part : parts_)
    for (const Reaction& reaction : part->reactions())
      all.push_back(reaction);
  return all;
}

template <class Real, class Relaxed>
std::vector<RigidTransform> HostBackend<Real, Relaxed>::bodies() const
{
  std::vector<RigidTransform> all;
  for (const auto& part : parts_)
    for (const RigidTransform& pose : part->bodies(conditions_.bone))
      all.push_back(pose);
  return all;
}

template <class Real, class Relaxed>
std::int64_t HostBackend<Real, Relaxed>::lost_points() const
{
  std::int64_t lost = 0;
  for (const auto& part : parts_)
    lost += part->lost_points();
  return lost;
}

template <class Real, class Relaxed>
double HostBackend<Real, Relaxed>::body_energy() const
{
  double sum = 0;
  for (const auto& part : parts_)
    sum += part->body_energy();
  return sum;
}

template <class Real, class Relaxed>
void HostBackend<Real, Relaxed>::save(std::unique_ptr<BackendState>& to)
{
  if (!to)
    to = std::make_unique<HostState>();
  auto& state = static_cast<HostState&>(*to);
  ArrayList list;
  list_arrays(list);
  state.bytes.resize(list.state_bytes());
  char* at = state.bytes.data();
  for (const auto& array : list.state())
  {
    std::memcpy(at, array.data, array.bytes);
    at += array.bytes;
  }
}

template <class Real, class Relaxed>
void HostBackend<Real, Relaxed>::restore(const BackendState& from)
{
  const auto& state = static_cast<const HostState&>(from);
  ArrayList list;
  list_arrays(list);
  const char* at = state.bytes.data();
  for (const auto& array : list.state())
  {
    std::memcpy(array.data, at, array.bytes);
    at += array.bytes;
  }
}

template <class Real, class Relaxed>
void HostBackend<Real, Relaxed>::get(NodalField field, NodalVectors& out) const
{
  interleave(field == NodalField::displacements ? u_ : v_, out);
}

template <class Real, class Relaxed>
void HostBackend<Real, Relaxed>::set(NodalField field, const NodalVectors& in)
{
  if (field == NodalField::displacements)
    rest();
  separate(in, field == NodalField::displacements ? u_ : v_);
}

template <class Real, class Relaxed>
void HostBackend<Real, Relaxed>::internal_forces(NodalVectors& out)
{
  on_all_threads([&](const NodeShare& share) { find_forces(share, u_); });
  interleave(found_forces(), out);
}

template <class Real, class Relaxed>
double HostBackend<Real, Relaxed>::highest_frequency_squared()
{
  if (!search_)
    search_ = std::make_unique<HighestFrequencySearch<Real>>(*model_, discretisation_, first_nodes(), u_[0].size());
  double found = 0;
  on_all_threads(
      [&](const NodeShare& share)
      {
        const typename HighestFrequencySearch<Real>::Forces forces{ [&](const Components& u) { find_forces(share, u); },
                                                                    found_forces(), [this] { barrier(); } };
        const double squared = search_->run(share.first_node, share.end_node, u_, forces);
        if (share.thread == 0)
          found = squared;
      });
  return found;
}

template <class Real, class Relaxed>
void HostBackend<Real, Relaxed>::masses_changed(const std::vector<std::int32_t>& /*nodes*/)
{
  if (search_)
    search_->masses_changed(discretisation_);
  for (NodePart<Real>* const part : active_parts())
    part->masses_changed();
}

template <class Real, class Relaxed>
void HostBackend<Real, Relaxed>::skin(SkinState& out)
{
  skin_state(*model_, pointers(u_).data(), out);
}

template <class Real, class Relaxed>
void HostBackend<Real, Relaxed>::interleave(const Components& in, NodalVectors& out) const
{
  out.resize(model_->nodes.size());
  for (std::size_t n = 0; n < out.size(); ++n)
    out[n] = { { double(in[0][n]), double(in[1][n]), double(in[2][n]) } };
}

template <class Real, class Relaxed>
void HostBackend<Real, Relaxed>::separate(const NodalVectors& in, Components& out)
{
  for (std::size_t n = 0; n < in.size(); ++n)
    for (std::size_t axis = 0; axis < 3; ++axis)
      out[axis][n] = static_cast<Real>(in[n][axis]);
}

template class HostBackend<float, float>;
template class HostBackend<double, float>;
template class HostBackend<double, std::array<physics::Symmetric3<double>, 2>>;

}  // namespace frontalis
