#include "solver/skin/film_vertices.hpp"

#include "frontalis/solver/surface_normals.hpp"

namespace frontalis
{

void place_film_vertices(const Model& model, SkinState& skin)
{
  using Vector = physics::Vec3<float>;
  const auto vector = [](const std::array<float, 3>& a) { return Vector{ a[0], a[1], a[2] }; };
  skin.vertices.resize(model.skin.vertices.size());
  surface_normals(model.film.carried, skin.vertices, skin.normals);
  std::size_t v = skin.vertices.size() - model.film.parents.size();
  for (const auto& [a, b] : model.film.parents)
  {
    Vector normal{};
    const Vector at = curved_middle(vector(skin.vertices[a]), vector(skin.normals[a]), vector(skin.vertices[b]),
                                    vector(skin.normals[b]), normal);
    skin.vertices[v] = { { at.x, at.y, at.z } };
    skin.normals[v++] = { { normal.x, normal.y, normal.z } };
  }
}

}  // namespace frontalis
