#include "solver/contact/body_contact.hpp"

#include "frontalis/model/sample_field.hpp"
#include "solver/contact/contact_stiffness.hpp"
#include "solver/contact/bone_pose.hpp"

#include <cmath>
#include <limits>
#include <numeric>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;

// Upper bound of the rounding errors of a distance in single precision [m].
constexpr double distance_error = 1e-6;

}  // namespace

template <class Real>
BodyContact<Real>::BodyContact(const Model& model, const Discretisation& discretisation, PointKernel<Real> kernel)
    : model_(model), blocks_(kernel)
{
  const auto* const stiffness = discretisation.find_added<ContactStiffness>();
  for (std::size_t c = 0; c < model.contacts.size(); ++c)
  {
    const Contact& contact = model.contacts[c];
    fields_.push_back(view(contact.field));
    any_pushed_ = any_pushed_ || contact.mass > 0;
    for (std::size_t p = 0; p < contact.points.size(); ++p)
      if (contact.area[p] > 0)
        points_.push_back({ contact.binding.voxel[p], static_cast<std::int32_t>(c), contact.binding.coordinates[p],
                            static_cast<float>(stiffness->of(c, p)), vector_of(contact.points[p]) });
  }
  if (points_.empty())
    return;
  std::stable_sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) { return a.voxel < b.voxel; });
  const auto planes = static_cast<std::size_t>(model.size[2]);
  plane_points_.assign(planes + 2, 0);
  Binding bound;
  for (const Point& point : points_)
  {
    ++plane_points_[model.voxels[point.voxel][2] + 1];
    bound.voxel.push_back(point.voxel);
    bound.coordinates.push_back(point.coordinates);
    spread_.push_back(spread_at(point.coordinates));
  }
  std::partial_sum(plane_points_.begin(), plane_points_.end(), plane_points_.begin());
  nodes_ = BoundNodeWay(model, bound, BoundNodeWay::Of::nodes);
  blocks_.make(model, points_);
  reset();
}

template <class Real>
void BodyContact<Real>::run(EffectSet running)
{
  runs_ = running.has(Effect::contact);
  if (!runs_)
    reset();
}

template <class Real>
void BodyContact<Real>::reset()
{
  if (points_.empty())
    return;
  const std::size_t bodies = fields_.size(), planes = static_cast<std::size_t>(model_.size[2]);
  forces_.assign(points_.size(), {});
  next_.assign(bodies, {});
  motion_.assign(bodies, {});
  grips_.assign(points_.size(), {});
  due_.assign(points_.size(), 0);
  touches_.assign(points_.size(), Touching::no);
  chunks_.assign((points_.size() + chunk_size - 1) / chunk_size, {});
  bodies_.assign(bodies, {});
  node_way_.assign(planes + 1, 0);
  sums_.assign(planes * bodies, {});
  opened_.assign(1, {});
}

template <class Real>
void BodyContact<Real>::list_arrays(ArrayList& list)
{
  const Effect effect = Effect::contact;
  list.add(effect, "points", points_);
  list.add(effect, "points", plane_points_);
  list.add(effect, "points", spread_);
  blocks_.list_arrays(list);
  nodes_.list_arrays(list, effect);
  list.add(effect, "bodies", fields_);
  list.add(effect, "forces", forces_);
  list.add(effect, "bodies", next_);
  list.add(effect, "bodies", motion_);
  list.add_state(effect, "grips", grips_);
  list.add_state(effect, "distances", due_);
  list.add_state(effect, "distances", touches_);
  list.add_state(effect, "distances", chunks_);
  list.add_state(effect, "bodies", bodies_);
  list.add_state(effect, "distances", node_way_);
  list.add_state(effect, "sums", sums_);
  list.add_state(effect, "sums", opened_);
}

template <class Real>
Vector BodyContact<Real>::place(const Point& point, const Real* const u[3]) const
{
  const auto& c = point.coordinates;
  const auto& nodes = model_.voxel_nodes[point.voxel];
  double weight[8];
  physics::trilinear_weights<double>(c[0], c[1], c[2], weight);
  Vector p = point.rest;
  for (int b = 0; b < 8; ++b)
    p = p + weight[b] * Vector{ double(u[0][nodes[b]]), double(u[1][nodes[b]]), double(u[2][nodes[b]]) };
  return p;
}

template <class Real>
std::vector<RigidTransform> BodyContact<Real>::bodies(const std::vector<RigidTransform>& bones) const
{
  const std::vector<Reaction> latest = reactions();
  std::vector<RigidTransform> poses;
  for (std::size_t b = 0; b < model_.contacts.size(); ++b)
    poses.push_back(idle() ? held_pose(model_.contacts[b], bones)
                           : moved_on(model_.contacts[b], bodies_[b], latest[b], bones).pose);
  return poses;
}

template <class Real>
std::vector<BodyState> BodyContact<Real>::next(const ConstraintStep& step) const
{
  std::vector<BodyState> now;
  double way = 0;
  const std::vector<Reaction> latest = any_pushed_ ? reactions() : std::vector<Reaction>(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b)
  {
    now.push_back(moved_on(model_.contacts[b], bodies_[b], latest[b], step.bone_before));
    begin_step(now[b], bodies_[b].dt, step.dt);
    way = std::max(way, longest_way(bodies_[b].pose, now[b].pose, far_corner(model_)));
  }
  way += bodies_.front().way + *std::max_element(node_way_.begin(), node_way_.end());
  for (BodyState& body : now)
    body.way = bodies_.front().dt > 0 ? way : 0;
  return now;
}

// The value of a field divided by the steepest slope is a lower bound of the distance from the body.
template <class Real>
double BodyContact<Real>::due_after(std::size_t p, double way, double distance) const
{
  return way + (distance - distance_error) / (physics::steepest_field * spread_[p]);
}

template <class Real>
void BodyContact<Real>::find_force(std::size_t p, const Real* const u[3], const BodyState& body, double response,
                                   const PointPlaces<Real>* places)
{
  const Point& point = points_[p];
  const double stiffness = double(point.stiffness);
  const Contact& contact = model_.contacts[point.body];
  const physics::DistanceField& field = fields_[point.body];
  const physics::Pose pose = pose_of(body.pose);
  Vector x{};
  physics::FieldValue<double> value{};
  bool sampled = places != nullptr && blocks_.read(*places, p % chunk_size, field, value, x);
  if (!sampled)
  {
    x = pose.inwards(place(point, u));
    sampled = blocks_.sample(field, p, x, value);
  }
  const Vector arm = pose.turned(x);
  physics::Grip<double>& grip = grips_[p];
  due_[p] = 0;
  if (sampled && value.value < 0)
  {
    if (contact.friction > 0)
    {
      const auto touch = physics::touch<double>(value, x, grip_at(p, x), stiffness, contact.friction, response);
      grip = touch.grip;
      forces_[p] = { pose.turned(touch.force), arm, touch.lost };
    }
    else
      forces_[p] = { pose.turned(physics::push(value, stiffness)), arm, 0 };
    touches_[p] = Touching::yes;
    return;
  }
  forces_[p] = { { 0, 0, 0 }, arm, physics::let_go<double>(grip, stiffness, response) };
  const bool was_inside = touches_[p] == Touching::yes || touches_[p] == Touching::lost;
  touches_[p] = was_inside && !sampled ? Touching::lost : was_inside ? Touching::let_go : Touching::no;
  if (contact.friction > 0 && grip.normal > stiffness * physics::forgotten_depth)
    return;
  grip.normal = 0;
  if (touches_[p] == Touching::no)
    due_[p] = sampled ? due_after(p, body.way, value.value)
                      : body.way + physics::distance_without_samples(field, contact.reach, x) / spread_[p];
}

template <class Real>
void BodyContact<Real>::before_step(const NodeShare& share, const Real* const u[3], const ConstraintStep& step)
{
  const std::vector<BodyState> now = next(step);
  const double response = physics::friction_response(step.dt);
  static_assert(chunk_size == PointBlock<Real>::width, "a chunk is a block");
  std::vector<PosedBody<Real>> bodies;
  for (std::size_t b = 0; b < now.size(); ++b)
    bodies.push_back(ContactBlocks<Real>::posed(now[b].pose, fields_[b]));
  const std::size_t begin = chunks_.size() * share.thread / share.threads;
  const std::size_t end = chunks_.size() * (share.thread + 1) / share.threads;
  for (std::size_t c = begin; c < end; ++c)
  {
    Chunk& chunk = chunks_[c];
    if (chunk.due > now.front().way)
      continue;
    chunk = { std::numeric_limits<double>::max(), 0 };
    const std::size_t first = c * chunk_size, last = std::min(first + chunk_size, points_.size());
    // A point that has touched has been due ever since, with a value of 0.
    std::uint32_t in_lanes = 0;
    for (std::size_t p = first; p < last; ++p)
      if (!(due_[p] > now.front().way) && (due_[p] > 0 || touches_in_lanes(points_[p].body)))
        in_lanes |= 1U << (p - first);
    PointPlaces<Real> places;
    const bool found = blocks_.present() && in_lanes != 0;
    if (found)
      blocks_.find(c, u, bodies, in_lanes, places);
    for (std::size_t p = first; p < last; ++p)
    {
      if (due_[p] > now.front().way)
      {
        chunk.due = std::min(chunk.due, due_[p]);
        continue;
      }
      const double distance = found && due_[p] > 0 ? double(places.distance[p - first]) : 0;
      if (distance > distance_error)
        due_[p] = due_after(p, now.front().way, distance);
      else
        find_force(p, u, now[points_[p].body], response,
                   found && touches_in_lanes(points_[p].body) ? &places : nullptr);
      chunk.due = std::min(chunk.due, due_[p]);
      chunk.touches |= touches_[p] != Touching::no ? 1 : 0;
    }
  }
  if (share.thread == 0)
    go_on_to(now);
}

template <class Real>
void BodyContact<Real>::go_on_to(const std::vector<BodyState>& now)
{
  for (std::size_t b = 0; b < now.size(); ++b)
    motion_[b] = bodies_[b].dt > 0 ? motion_between(bodies_[b].pose, now[b].pose) : BodyMotion{};
  next_ = now;
}

template <class Real>
void BodyContact<Real>::follow(const std::vector<Found>& found, const ConstraintStep& step,
                               const std::vector<PushedMotion>& pushed)
{
  for (std::size_t p = 0; p < points_.size(); ++p)
  {
    forces_[p] = found[p].force;
    grips_[p] = found[p].grip;
    touches_[p] = found[p].touching;
  }
  for (Chunk& chunk : chunks_)
    chunk.touches = 1;
  std::vector<BodyState> now = next(step);
  for (std::size_t b = 0; b < pushed.size(); ++b)
    if (const Contact& contact = model_.contacts[b]; contact.mass > 0)
    {
      static_cast<PushedMotion&>(now[b]) = pushed[b];
      now[b].pose = pushed_pose(contact, pushed[b], step.bone_before);
    }
  go_on_to(now);
  add_up(0, 0, model_.size[2]);
}

template <class Real>
void BodyContact<Real>::add_forces(const NodeShare& share, const ForceSink<Real>& sink)
{
  const auto first = share.first_plane, last = share.end_plane;
  each_touching(plane_points_[std::max(first - 1, 0)], plane_points_[last],
                [&](std::int32_t p)
                {
                  push_point(points_[p], forces_[p].force, first, last,
                             [&](std::int32_t node, const Vector& part) {
                               sink(node, { part.x, part.y, part.z });
                             });
                });
  add_up(share.thread, first, last);
}

template <class Real>
void BodyContact<Real>::add_up(int thread, std::int32_t first, std::int32_t last)
{
  if (thread == 0)
    bodies_ = next_;
  const std::size_t bodies = motion_.size();
  std::vector<Reaction> now(bodies);
  for (auto k = first; k < std::min(last, model_.size[2]); ++k)
  {
    std::fill(now.begin(), now.end(), Reaction());
    PlaneSum* const sums = sums_.data() + k * bodies;
    each_touching(plane_points_[k], plane_points_[k + 1],
                  [&](std::int32_t p)
                  {
                    add_reaction(now[points_[p].body], forces_[p].arm, forces_[p].force);
                    sums[points_[p].body].lost += forces_[p].lost;
                  });
    for (std::size_t b = 0; b < bodies; ++b)
    {
      sums[b].work += work_between(sums[b].reaction, now[b], motion_[b]);
      sums[b].reaction = now[b];
    }
  }
}

template <class Real>
void BodyContact<Real>::after_step(const NodeShare& share, const Real* const before[3], const Real* const after[3])
{
  for (auto k = share.first_plane; k < share.end_plane; ++k)
    node_way_[k] = nodes_.in_plane(k, before, after);
}

template <class Real>
std::vector<Reaction> BodyContact<Real>::reactions() const
{
  std::vector<Reaction> total(model_.contacts.size());
  for (std::size_t s = 0; s < sums_.size(); ++s)
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      Reaction& sum = total[s % fields_.size()];
      sum.force[axis] += sums_[s].reaction.force[axis];
      sum.moment[axis] += sums_[s].reaction.moment[axis];
    }
  return total;
}

template <class Real>
typename BodyContact<Real>::Energy BodyContact<Real>::energy_now(const Real* const u[3],
                                                                 const std::vector<RigidTransform>& bones,
                                                                 std::vector<std::array<double, 3>>& forces) const
{
  Energy energy;
  for (const PlaneSum& sum : sums_)
  {
    energy.work += sum.work;
    energy.lost += sum.lost;
  }
  // The sums do not include the contribution of the latest step yet, because the next step adds it. It is added here.
  const std::vector<RigidTransform> present = bodies(bones);
  std::vector<Reaction> now(fields_.size());
  for (std::size_t p = 0; p < points_.size(); ++p)
  {
    const Point& point = points_[p];
    const physics::DistanceField& field = fields_[point.body];
    const physics::Pose pose = pose_of(present[point.body]);
    const Vector x = pose.inwards(place(point, u));
    physics::FieldValue<double> value{};
    const double stiffness = double(point.stiffness), response = physics::friction_response(bodies_[point.body].dt);
    if (!physics::sample(field, physics::field_point(field, x), value) || value.value >= 0)
    {
      physics::Grip<double> grip = grips_[p];
      energy.lost += physics::let_go<double>(grip, stiffness, response);
      continue;
    }
    const auto touch =
        physics::touch<double>(value, x, grip_at(p, x), stiffness, model_.contacts[point.body].friction, response);
    energy.stored += touch.stored;
    energy.lost += touch.lost;
    const Vector force = pose.turned(touch.force);
    add_reaction(now[point.body], pose.turned(x), force);
    if (!forces.empty())
      push_point(point, force, 0, model_.size[2] + 1,
                 [&](std::int32_t node, const Vector& part) { add_vector(forces[node], part); });
  }
  const std::vector<Reaction> before = reactions();
  for (std::size_t b = 0; b < now.size(); ++b)
    if (bodies_[b].dt > 0)
      energy.work += work_between(before[b], now[b], motion_between(bodies_[b].pose, present[b]));
  return energy;
}

template <class Real>
void BodyContact<Real>::add_energies(const Real* const u[3], const std::vector<RigidTransform>& bones, bool open,
                                     std::vector<std::array<double, 3>>& forces, EnergyLedger& ledger)
{
  const Energy now = energy_now(u, bones, forces);
  if (open)
    opened_[0] = now;
  ledger["contact"] += now.work - opened_[0].work;
  ledger["contact_stored"] += now.stored;
  ledger["friction"] += now.lost - opened_[0].lost;
}

template class BodyContact<float>;
template class BodyContact<double>;

}  // namespace frontalis
