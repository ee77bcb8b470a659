#include "frontalis/study/self_contact_model.hpp"

namespace frontalis
{

void let_touch(Model& model, const std::vector<TriangleMesh>& surfaces, double friction)
{
  SelfContact contact;
  contact.name = "tissue";
  contact.friction = friction;
  TriangleMesh& all = contact.surface;
  for (const TriangleMesh& mesh : surfaces)
  {
    const auto first = static_cast<std::int32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const auto& t : mesh.triangles)
      all.triangles.push_back({ { first + t[0], first + t[1], first + t[2] } });
  }
  contact.binding = bind_points(model, all.vertices);
  model.self_contacts.push_back(contact);
}

}  // namespace frontalis
