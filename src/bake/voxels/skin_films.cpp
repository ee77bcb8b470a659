#include "bake/mesh/halve_edges.hpp"
#include "bake/messages.hpp"
#include "bake/voxels/model_stages.hpp"
#include "frontalis/physics/materials/lookup.hpp"

namespace frontalis
{
namespace
{

// Wavelength of fine lines divided by the longest edge allowed. The mean edge is about half as long, so that a
// wavelength has eight edges or more.
constexpr double edges_per_line = 4.5;
constexpr double vertices_per_edge_area = 6;  // vertices per square of the longest edge; 6 to 9 in the head
constexpr double most_vertices = 2e6;
constexpr double coarsening = 0.5;  // growth of edges per distance from the region in which lines are wanted

FilmLaw film_law(const Scene& scene, const SceneFilm& film, const Model& model, const std::string& place)
{
  FilmLaw law;
  law.thickness = film.thickness;
  law.stretch = film.stretch;
  // Modulus of plane strain at rest, E / (1 - nu^2) [Pa]. Poisson's ratio is the scene's, even if the profile limits
  // bulk moduli, so that lines do not depend on the profile.
  const auto plane_strain_modulus = [&](const std::string& name, double& poisson)
  {
    const std::size_t index = index_of(scene.materials, name, place, "material");
    const Material& material = model.materials[index];
    poisson = scene.materials[index].parameters.at("poisson");
    return 2 * physics::shear_modulus_of(material.law, material.parameters) / (1 - poisson);
  };
  double base_poisson = 0;
  law.modulus = plane_strain_modulus(film.material, law.poisson);
  law.base_modulus = plane_strain_modulus(film.base, base_poisson);
  if (law.modulus < 10 * law.base_modulus)
    throw failure(
        "{}: film '{}' is {:.3g} times as stiff as its base '{}'; lines need a film at least 10 times as stiff", place,
        film.material, law.modulus / law.base_modulus, film.base);
  return law;
}

}  // namespace

void add_films(const Scene& scene, TriangleMesh& surface, Model& model, BakeMonitor& monitor)
{
  const std::string place = scene.file + ": skin: fine_lines";
  SkinFilm& out = model.film;
  std::vector<Box> crops;
  std::vector<double> edges;
  double vertices = 0;
  for (const SceneFilm& film : scene.films)
  {
    const FilmLaw law = film_law(scene, film, model, place);
    out.laws.push_back(law);
    crops.push_back(to_box(film.crop));
    edges.push_back(film_wavelength(law) / edges_per_line);
    const double area = surface_area(cut_mesh(surface, film.crop));
    if (area <= 0 && !surface.triangles.empty())
      throw failure("{}: crop: no triangle of the published skin lies in it; check its corners and the skin's crop",
                    place);
    vertices += vertices_per_edge_area * area / (edges.back() * edges.back());
    if (vertices > most_vertices)
      throw failure(
          "{}: lines are {} apart, and the skin needs about {:.1f} million vertices; at most {:.0f} million are "
          "allowed: crop the film, or make it thicker",
          place, length_text(film_wavelength(law), scene.unit), 1e-6 * vertices, 1e-6 * most_vertices);
  }
  out.carried = surface.triangles;
  // the last film at a place, or -1
  const auto film_at = [&](const Vector3d& at)
  {
    auto f = static_cast<std::int32_t>(crops.size()) - 1;
    while (f >= 0 && !crops[f].contains(at))
      --f;
    return f;
  };
  const auto longest = [&](const Vector3d& at)
  {
    const std::int32_t own = film_at(at);
    double edge = own < 0 ? std::numeric_limits<double>::infinity() : edges[own];
    for (std::size_t f = 0; f < crops.size(); ++f)
      if (const double distance = crops[f].exteriorDistance(at); distance > 0)
        edge = std::min(edge, edges[f] + coarsening * distance);
    return edge;
  };
  out.parents = halve_edges(surface, longest);
  for (std::size_t v = 0; v < surface.vertices.size(); ++v)
    out.law.push_back(film_at(vertex(surface, static_cast<std::int32_t>(v))));
  for (const FilmLaw& law : out.laws)
    monitor.found("skin: fine lines {} apart from a compression of {:.3g} %",
                  length_text(film_wavelength(law), scene.unit),
                  100 * (film_critical_strain(law) + (1 + law.poisson) * law.stretch));
}

}  // namespace frontalis
