#include "frontalis/model/contact.hpp"

#include "frontalis/model/body_shape.hpp"
#include "frontalis/physics/number.hpp"
#include "model/effect_description.hpp"
#include "model/model_checks.hpp"
#include "model/model_layout.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

EffectPresence found(const Model& model)
{
  std::size_t points = 0;
  for (const Contact& contact : model.contacts)
    points += contact.points.size();
  return { points > 0,
           points > 0 ? fmt::format("{} point{} of tissue", points, points == 1 ? "" : "s") : "no body to touch", 0,
           points };
}

void check(const Model& model)
{
  using namespace checks;
  for (const Contact& contact : model.contacts)
  {
    const std::string name = "contacts '" + contact.name + "'";
    check_field(name, contact.field);
    check_not_negative(name, "reach", contact.reach);
    index_below(model.bones.size(), -1)(name + " (bone)", 0, contact.bone);
    check_not_negative(name, "friction", contact.friction);
    check_length(name + " (area)", contact.area.size(), contact.points.size(), "point");
    check_binding(name + ".binding", contact.binding, contact.points.size(), model.voxels.size());
    check_each(name + " (points)", check_finite, contact.points);
    for (const double area : contact.area)
      check_not_negative(name, "an area", area);
    check_entry(name + " (centre)", 0, check_finite, contact.centre);
    check_each(name + " (shape)", check_finite, contact.shape.vertices);
    check_each(name + " (shape)", index_below(contact.shape.vertices.size()), contact.shape.triangles);
    for (const double number : { contact.mass, contact.spring, contact.damping })
      check_not_negative(name, "mass, spring or damping", number);
    check_entry(name + " (force)", 0, check_finite, contact.force);
  }
}

// Writes or reads the contacts of a model file. The file of a model without contacts has no arrays for them.
template <class Archive, class Contacts>
void exchange_contacts(Archive& archive, Contacts& contacts)
{
  const std::string path = "contacts";
  if (!archive.group_if(!contacts.empty(), path))
    return;
  archive.table(path, contacts, Column{ "name", &Contact::name }, Column{ "bone", &Contact::bone },
                Column{ "friction", &Contact::friction }, Column{ "reach", &Contact::reach },
                Column{ "centre", &Contact::centre }, Column{ "mass", &Contact::mass },
                Column{ "force", &Contact::force }, Column{ "spring", &Contact::spring },
                Column{ "damping", &Contact::damping });
  for (std::size_t c = 0; c < contacts.size(); ++c)
  {
    const std::string own = path + "/" + std::to_string(c);
    exchange_field(archive, own, contacts[c].field);
    exchange_mesh(archive, own, contacts[c].shape);
    archive(own + "/points", contacts[c].points);
    archive(own + "/area", contacts[c].area);
    exchange_binding(archive, own, contacts[c].binding);
  }
}

// If several bodies share nodes, the nodes get the highest bone index.
void set_bones(const Model& model, std::vector<std::int32_t>& bone)
{
  for (const Contact& contact : model.contacts)
    for (const auto voxel : contact.binding.voxel)
      for (const auto node : model.voxel_nodes[voxel])
        bone[node] = std::max(bone[node], contact.bone);
}

void add_bodies(const Model& model, std::vector<TouchedBody>& bodies)
{
  for (const Contact& contact : model.contacts)
    bodies.push_back({ contact.name, contact.bone });
}

}  // namespace

EffectDescription contact_description()
{
  return { Effect::contact,
           found,
           [](Model& model, EffectSet)
           {
             // Bodies that are only shown stay.
             const auto touches = [](const Contact& contact) { return !contact.points.empty(); };
             model.contacts.erase(std::remove_if(model.contacts.begin(), model.contacts.end(), touches),
                                  model.contacts.end());
           },
           check,
           [](ModelWriter& archive, const Model& model) { exchange_contacts(archive, model.contacts); },
           [](ModelReader& archive, Model& model) { exchange_contacts(archive, model.contacts); },
           set_bones,
           add_bodies };
}

std::vector<double> vertex_areas(const TriangleMesh& surface)
{
  std::vector<double> area(surface.vertices.size(), 0);
  const auto corner = [&](std::int32_t v)
  {
    const auto& p = surface.vertices[v];
    return physics::Vec3<double>{ p[0], p[1], p[2] };
  };
  for (const auto& t : surface.triangles)
  {
    const auto a = corner(t[0]);
    const double third = norm(cross(corner(t[1]) - a, corner(t[2]) - a)) / 6;
    for (const auto v : t)
      area[v] += third;
  }
  return area;
}

void set_points(Contact& contact, const TriangleMesh& surface, const Binding& binding)
{
  contact.points = surface.vertices;
  contact.binding = binding;
  contact.area = vertex_areas(surface);
}

namespace
{

/// Converts a point from the face frame to the local frame [m].
std::array<double, 3> local_place(const Model& model, const std::array<double, 3>& p)
{
  const RigidTransform& to_face = model.to_face;
  std::array<double, 3> out{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t axis = 0; axis < 3; ++axis)
      out[axis] += to_face.rotation[3 * row + axis] * (p[row] - to_face.translation[row]);
  return out;
}

}  // namespace

std::vector<BodyShape> body_shapes(const Model& model)
{
  std::vector<BodyShape> shapes;
  for (const Contact& contact : model.contacts)
    shapes.push_back(
        { contact.name, "body/" + contact.name, contact.centre, &contact.shape, contact.points.empty(), contact.bone });
  return shapes;
}

std::vector<BodyShape> bone_shapes(const Model& model)
{
  std::vector<BodyShape> shapes;
  shapes.reserve(model.bones.size());
  for (const std::string& bone : model.bones)
    shapes.push_back({ bone, "bone/" + bone, {} });
  std::vector<bool> known(shapes.size(), false);
  const auto set = [&](std::int32_t bone, const std::array<double, 3>& centre)
  {
    if (bone < 0 || known[bone])
      return;
    shapes[bone].centre = centre;
    known[bone] = true;
  };
  for (const ConstraintSurface& surface : model.constraint_surfaces)
    if (surface.field.radius > 0)
      set(surface.bone, surface.field.origin);
  const auto set_all = [&](const auto& poses)
  {
    for (const auto& pose : poses)
      for (const Model::BonePose& bone : pose.bones)
        set(bone.bone, local_place(model, bone.centre));
  };
  set_all(model.action_units);
  set_all(model.expressions);
  set_all(model.demo);
  std::vector<double> held(shapes.size(), 0);
  for (const RigidNode& rigid : model.rigid)
    if (rigid.bone >= 0 && !known[rigid.bone])
    {
      const auto place = rest_position(model, static_cast<std::size_t>(rigid.node));
      ++held[rigid.bone];
      for (std::size_t axis = 0; axis < 3; ++axis)
        shapes[rigid.bone].centre[axis] += (place[axis] - shapes[rigid.bone].centre[axis]) / held[rigid.bone];
    }
  return shapes;
}

}  // namespace frontalis
