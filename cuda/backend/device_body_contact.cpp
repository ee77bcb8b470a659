#include "cuda/backend/device_body_contact.hpp"

#include "cuda/backend/device_model.hpp"
#include "cuda/kernels/contact_kernels.hpp"
#include "frontalis/solver/backend.hpp"

#include "solver/contact/body_motion.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <set>

namespace frontalis
{
namespace cuda
{
std::uint32_t most_touching_points(const Model& model, const VoxelPatches& patches)
{
  if (model.contacts.empty())
    return 0;
  std::vector<std::uint32_t> in_voxel(model.voxels.size(), 0);
  for (const Contact& contact : model.contacts)
    for (std::size_t p = 0; p < contact.points.size(); ++p)
      in_voxel[contact.binding.voxel[p]] += contact.area[p] > 0 ? 1 : 0;
  return patches.most_in_patch(in_voxel);
}

DeviceBodyContact::DeviceBodyContact(const Model& model, const Discretisation& discretisation, const VoxelCut& cut,
                                     const std::vector<std::uint32_t>& device_node)
    : model_(model),
      host_(model, discretisation),
      first_point_(model.voxels.size() + 1, 0),
      far_corner_(far_corner(model))
{
  for (const auto& point : host_.points())
    ++first_point_[point.voxel + 1];
  std::partial_sum(first_point_.begin(), first_point_.end(), first_point_.begin());
  if (cut.patches)
    add_to_patches(*cut.patches);
  else
    add_to_strips(model, device_node);
  add_points(model);
  add_pushed(model);
  for (auto* const state : { &grips_, &forces_, &arms_, &clearances_ })
    *state = DeviceArray<float4>(point_.size());
  clearances_.clear();
  holds_ = DeviceArray<ContactHold>(point_.size());
  reset();
}

// Adds points to patches. A voxel may be in several patches; each copy of the voxel has copies of its points.
void DeviceBodyContact::add_to_patches(const VoxelPatches& patches)
{
  std::vector<PatchContact> of_patch;
  std::vector<BoundVoxel> voxels;
  std::vector<uint4> corners;
  std::vector<float4> watched;
  for (const Patch& patch : patches.patches)
  {
    PatchContact contact{ static_cast<std::uint32_t>(point_.size()),  0, static_cast<std::uint32_t>(voxels.size()), 0,
                          static_cast<std::uint32_t>(watched.size()), 0 };
    std::set<std::uint16_t> places;
    for (std::uint32_t v = 0; v < patch.voxels; ++v)
    {
      const auto e = patches.voxel[patch.voxel_begin + v];
      const std::uint32_t first = contact.points;
      for (auto p = first_point_[e]; p < first_point_[e + 1]; ++p, ++contact.points)
      {
        point_.push_back(p);
        uint4 words;
        static_assert(sizeof words == sizeof patches.corner[0], "eight places are read as four words");
        std::memcpy(&words, &patches.corner[patch.voxel_begin + v], sizeof words);
        corners.push_back(words);
      }
      if (contact.points == first)
        continue;
      voxels.push_back({ v, first, contact.points });
      const auto& of_voxel = patches.corner[patch.voxel_begin + v];
      places.insert(of_voxel.begin(), of_voxel.end());
    }
    for (const std::uint32_t place : places)
    {
      watched.push_back({ 0, 0, 0, 0 });
      std::memcpy(&watched.back().w, &place, sizeof place);
    }
    contact.nodes = static_cast<std::uint32_t>(places.size());
    contact.voxels = static_cast<std::uint32_t>(voxels.size()) - contact.voxel_begin;
    of_patch.push_back(contact);
  }
  patches_ = DeviceArray<PatchContact>(of_patch);
  voxels_ = DeviceArray<BoundVoxel>(voxels);
  corners_ = DeviceArray<uint4>(corners);
  watched_ = DeviceArray<float4>(watched);
}

void DeviceBodyContact::add_to_strips(const Model& model, const std::vector<std::uint32_t>& device_node)
{
  point_.resize(host_.points().size());
  std::iota(point_.begin(), point_.end(), 0u);
  std::vector<std::uint32_t> voxel;
  std::vector<float4> coordinates;
  for (const auto& point : host_.points())
  {
    voxel.push_back(static_cast<std::uint32_t>(point.voxel));
    coordinates.push_back({ point.coordinates[0], point.coordinates[1], point.coordinates[2], 0 });
  }
  bound_ = DeviceBoundPoints(model, voxel, coordinates, device_node);
}

void DeviceBodyContact::add_points(const Model& model)
{
  for (const Contact& contact : model.contacts)
    host_bodies_.push_back(contact_body(contact, fields_.add(contact.field)));
  bodies_ = DeviceArray<ContactBody>(host_bodies_);
  std::vector<ContactPoint> points;
  copy_.resize(host_.points().size());
  for (const auto p : point_)
  {
    const auto& from = host_.points()[p];
    copy_[p] = static_cast<std::uint32_t>(points.size());
    points.push_back(contact_point(model.contacts[from.body], host_bodies_[from.body], from));
  }
  points_ = DeviceArray<ContactPoint>(points);
  std::vector<float4> samples;
  for (const float4& word : no_samples())
    samples.insert(samples.end(), points.size(), word);
  samples_ = DeviceArray<float4>(samples);
}

void DeviceBodyContact::add_pushed(const Model& model)
{
  for (std::size_t b = 0; b < model.contacts.size(); ++b)
    if (model.contacts[b].mass > 0)
      host_pushed_.push_back({ pushed_body(model.contacts[b]), static_cast<std::int32_t>(b) });
  pushed_ = DeviceArray<PushedBody>(host_pushed_);
  motions_ = DeviceArray<PushedMotion>(host_pushed_.size());
  reactions_ = DeviceArray<Vector>(host_pushed_.size() * find_pushes_blocks(static_cast<std::uint32_t>(point_.size())));
}

void DeviceBodyContact::describe(StepArguments& g) const
{
  g.contact = { bodies_.data(),
                points_.data(),
                voxels_.data(),
                patches_.data(),
                corners_.data(),
                watched_.data(),
                static_cast<float>(1 / host_.spread()),
                bound_.view(),
                static_cast<std::uint32_t>(point_.size()),
                static_cast<std::uint32_t>(host_bodies_.size()),
                nullptr,
                nullptr,
                grips_.data(),
                holds_.data(),
                forces_.data(),
                arms_.data(),
                samples_.data(),
                clearances_.data(),
                0,
                false };
}

std::vector<float> DeviceBodyContact::motion(const std::vector<std::vector<RigidTransform>>& bones) const
{
  std::vector<float> poses, ways;
  std::vector<Vector> held_at;
  double way = 0;
  for (std::size_t step = 0; step < bones.size(); ++step)
  {
    double longest = 0;
    for (const ContactBody& body : host_bodies_)
    {
      add_pose(body, bones[step], poses);
      if (step > 0 && body.bone >= 0)
        longest = std::max(longest, longest_way(bones[step - 1][body.bone], bones[step][body.bone], far_corner_));
    }
    way += longest;
    ways.push_back(static_cast<float>(way));
    for (const PushedBody& pushed : host_pushed_)
      held_at.push_back(held_centre(model_.contacts[pushed.body], bones[step]));
  }
  // The kernels read these as numbers in double precision (PushedBodies::held_at).
  poses.resize(poses.size() + held_at.size() * (sizeof(Vector) / sizeof(float)));
  if (!held_at.empty())
    std::memcpy(poses.data() + poses.size() - held_at.size() * (sizeof(Vector) / sizeof(float)), held_at.data(),
                held_at.size() * sizeof(Vector));
  poses.insert(poses.end(), ways.begin(), ways.end());
  return poses;
}

void DeviceBodyContact::list_arrays(ArrayList& list)
{
  const Effect effect = Effect::contact;
  fields_.list_arrays(effect, list);
  list.add(effect, "points", bodies_.bytes() + points_.bytes() + corners_.bytes() + bound_.bytes());
  list.add(effect, "their voxels", voxels_.bytes() + patches_.bytes());
  list.add(effect, "points", watched_.bytes() + samples_.bytes() + clearances_.bytes());
  for (auto* const state : { &grips_, &forces_, &arms_ })
    list_state(list, effect, "forces", *state);
  list_state(list, effect, "forces", holds_);
  list.add(effect, "bodies", pushed_.bytes());
  list_state(list, effect, "bodies", motions_);
  list_state(list, effect, "bodies", reactions_);
  host_.list_arrays(list);
}

void DeviceBodyContact::run(EffectSet running)
{
  host_.run(running);
  if (idle())
    reset();
}

void DeviceBodyContact::reset()
{
  for (auto* const state : { &grips_, &forces_, &arms_ })
    state->clear();
  holds_.clear();
  motions_.clear();
  reactions_.clear();
  host_.reset();
}

std::uint32_t DeviceBodyContact::blocks_beside() const
{
  return host_pushed_.empty() ? find_pushes_blocks(static_cast<std::uint32_t>(point_.size())) : 0;
}

void DeviceBodyContact::find_pushes(const StepArguments& g, int step, cudaStream_t stream) const
{
  PushedBodies pushed{
    pushed_.data(),   static_cast<std::uint32_t>(pushed_.size()), 0, g.contact.poses, nullptr, motions_.data(),
    reactions_.data()
  };
  if (pushed.count > 0)
  {
    pushed.blocks = static_cast<std::uint32_t>(reactions_.size()) / pushed.count;
    // motion() puts these values behind the poses of all steps.
    pushed.held_at =
        reinterpret_cast<const Vector*>(g.contact.poses + 3 * (std::size_t(g.steps) + 1) * g.contact.body_count);
  }
  require(launch_find_pushes(g, pushed, step, stream), "finding forces of contact");
}

void DeviceBodyContact::follow(const ConstraintStep& step)
{
  std::vector<float4> grips, forces, arms;
  std::vector<ContactHold> holds;
  grips_.download(grips);
  forces_.download(forces);
  arms_.download(arms);
  holds_.download(holds);
  ContactArguments left{};
  left.grips = grips.data();
  left.forces = forces.data();
  left.arms = arms.data();
  left.holds = holds.data();
  std::vector<HostContact::Found> found;
  for (std::size_t p = 0; p < copy_.size(); ++p)
    found.push_back(found_at(left, copy_[p], host_.points()[p]));
  std::vector<PushedMotion> motions, of_bodies(host_pushed_.empty() ? 0 : host_bodies_.size());
  motions_.download(motions);
  for (std::size_t i = 0; i < motions.size(); ++i)
    of_bodies[host_pushed_[i].body] = motions[i];
  host_.follow(found, step, of_bodies);
}

std::vector<RigidTransform> DeviceBodyContact::bodies(const std::vector<RigidTransform>& bones) const
{
  std::vector<PushedMotion> motions;
  std::vector<Vector> reactions;
  motions_.download(motions);
  reactions_.download(reactions);
  std::vector<RigidTransform> poses;
  for (const Contact& contact : model_.contacts)
    poses.push_back(held_pose(contact, bones));
  for (std::size_t i = 0; i < motions.size(); ++i)
  {
    const auto first = reactions.begin() + static_cast<std::ptrdiff_t>(i * reactions.size() / motions.size());
    const auto last = first + static_cast<std::ptrdiff_t>(reactions.size() / motions.size());
    const Vector reaction = std::accumulate(first, last, Vector{ 0, 0, 0 });
    const PushedBody& pushed = host_pushed_[i];
    const Contact& contact = model_.contacts[pushed.body];
    poses[pushed.body] =
        pushed_pose(contact, moved_on(pushed.law, motions[i], reaction, held_centre(contact, bones)), bones);
  }
  return poses;
}

std::int64_t DeviceBodyContact::lost_points() const
{
  std::vector<ContactHold> holds;
  holds_.download(holds);
  return std::count_if(copy_.begin(), copy_.end(),
                       [&](std::uint32_t copy) { return holds[copy].touching == int(physics::Touching::lost); });
}

double DeviceBodyContact::body_energy() const
{
  std::vector<PushedMotion> motions;
  motions_.download(motions);
  double sum = 0;
  for (std::size_t p = 0; p < motions.size(); ++p)
    sum += energy_of(model_.contacts[static_cast<std::size_t>(host_pushed_[p].body)], motions[p]);
  return sum;
}

void DeviceBodyContact::add_energies(const std::vector<double> (&u)[3], const std::vector<RigidTransform>& bones,
                                     bool open, Vectors& forces, EnergyLedger& ledger)
{
  const double* const pointers[3] = { u[0].data(), u[1].data(), u[2].data() };
  host_.add_energies(pointers, bones, open, forces, ledger);
}

}  // namespace cuda
}  // namespace frontalis
