#include "bake/mesh/subdivide.hpp"

#include "bake/messages.hpp"

#include <fstream>
#include <sstream>
#include <unordered_map>

namespace frontalis
{
namespace
{

using Polygon = std::vector<std::int32_t>;

struct Edge
{
  std::array<std::int32_t, 2> ends{ 0, 0 };
  std::array<std::int32_t, 2> faces{ -1, -1 };
};

/// The edges of a mesh and, for each corner of a face, the index of the edge to the next corner.
struct EdgeTable
{
  std::vector<Edge> edges;
  std::vector<Polygon> of_face;

  explicit EdgeTable(const PolygonMesh& mesh)
  {
    std::unordered_map<std::uint64_t, std::int32_t> number;
    number.reserve(2 * mesh.faces.size());
    of_face.resize(mesh.faces.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    {
      const Polygon& face = mesh.faces[f];
      for (std::size_t c = 0; c < face.size(); ++c)
      {
        const std::int32_t from = face[c], to = face[(c + 1) % face.size()];
        const auto key =
            static_cast<std::uint64_t>(std::min(from, to)) << 32U | static_cast<std::uint32_t>(std::max(from, to));
        const auto [entry, added] = number.emplace(key, static_cast<std::int32_t>(edges.size()));
        if (added)
          edges.push_back({ { from, to }, { static_cast<std::int32_t>(f), -1 } });
        else
        {
          Edge& edge = edges[entry->second];
          if (edge.faces[1] >= 0 || edge.ends[0] != to)
            throw failure("a control cage must be a manifold with faces of one orientation; it is not at {}",
                          place_text(0.5 * (mesh.vertices[from] + mesh.vertices[to]), 1e-3));
          edge.faces[1] = static_cast<std::int32_t>(f);
        }
        of_face[f].push_back(entry->second);
      }
    }
  }
};

Vector3d middle(const PolygonMesh& mesh, const Polygon& face)
{
  Vector3d sum = Vector3d::Zero();
  for (const std::int32_t v : face)
    sum += mesh.vertices[v];
  return sum / static_cast<double>(face.size());
}

/// The neighbourhood of a vertex.
struct Ring
{
  double valence = 0, faces = 0;
  Vector3d neighbours{ 0, 0, 0 }, rim{ 0, 0, 0 }, face_points{ 0, 0, 0 }, opposite{ 0, 0, 0 };
  int rim_edges = 0;
};

std::vector<Ring> rings_of(const PolygonMesh& mesh, const EdgeTable& table)
{
  std::vector<Ring> rings(mesh.vertices.size());
  for (const Edge& edge : table.edges)
    for (int e = 0; e < 2; ++e)
    {
      Ring& ring = rings[edge.ends[e]];
      const Vector3d& other = mesh.vertices[edge.ends[1 - e]];
      ++ring.valence;
      ring.neighbours += other;
      if (edge.faces[1] < 0)
      {
        ring.rim += other;
        ++ring.rim_edges;
      }
    }
  for (const Polygon& face : mesh.faces)
  {
    const Vector3d point = middle(mesh, face);
    for (std::size_t c = 0; c < face.size(); ++c)
    {
      Ring& ring = rings[face[c]];
      ++ring.faces;
      ring.face_points += point;
      ring.opposite += mesh.vertices[face[(c + 2) % face.size()]];
    }
  }
  return rings;
}

PolygonMesh subdivide_once(const PolygonMesh& mesh)
{
  const EdgeTable table(mesh);
  const std::vector<Ring> rings = rings_of(mesh, table);
  PolygonMesh fine;
  fine.vertices.reserve(mesh.vertices.size() + table.edges.size() + mesh.faces.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
  {
    const Ring& r = rings[v];
    const Vector3d& p = mesh.vertices[v];
    const double n = r.valence;
    if (r.rim_edges > 0)
      fine.vertices.emplace_back(0.75 * p + 0.25 * r.rim / r.rim_edges);
    else
      fine.vertices.emplace_back((r.face_points / r.faces + (r.neighbours / n + p) + (n - 3) * p) / n);
  }
  std::vector<Vector3d> face_points;
  face_points.reserve(mesh.faces.size());
  for (const Polygon& face : mesh.faces)
    face_points.push_back(middle(mesh, face));
  for (const Edge& edge : table.edges)
  {
    const Vector3d ends = mesh.vertices[edge.ends[0]] + mesh.vertices[edge.ends[1]];
    fine.vertices.emplace_back(edge.faces[1] < 0
                                   ? Vector3d(0.5 * ends)
                                   : Vector3d(0.25 * (ends + face_points[edge.faces[0]] + face_points[edge.faces[1]])));
  }
  fine.vertices.insert(fine.vertices.end(), face_points.begin(), face_points.end());
  const auto first_edge = static_cast<std::int32_t>(mesh.vertices.size());
  const auto first_face = static_cast<std::int32_t>(first_edge + table.edges.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
  {
    const Polygon& face = mesh.faces[f];
    const Polygon& edges = table.of_face[f];
    for (std::size_t c = 0; c < face.size(); ++c)
    {
      fine.faces.push_back({ face[c], first_edge + edges[c], first_face + static_cast<std::int32_t>(f),
                             first_edge + edges[(c + face.size() - 1) % face.size()] });
      fine.groups.push_back(mesh.groups[f]);
    }
  }
  return fine;
}

/// Limit position of a vertex v of valence n among quadrilaterals: (n^2 v + 4 * sum of its neighbours + sum of the
/// opposite corners of its faces) / (n (n + 5)). A border vertex has the limit of a cubic B-spline.
Vector3d limit(const Vector3d& p, const Ring& r)
{
  if (r.rim_edges > 0)
    return (4 * p + 2 * r.rim / r.rim_edges) / 6;
  return (r.valence * r.valence * p + 4 * r.neighbours + r.opposite) / (r.valence * (r.valence + 5));
}

}  // namespace

PolygonMesh read_polygons(const std::string& file, double unit)
{
  std::ifstream stream(file);
  if (!stream)
    throw Error("mesh file " + file + ": cannot be read");
  PolygonMesh mesh;
  mesh.group_names = { "default" };
  std::int32_t group = 0;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number)
  {
    std::istringstream words(line);
    std::string key, word;
    words >> key;
    if (key == "v")
    {
      Vector3d p;
      if (!(words >> p[0] >> p[1] >> p[2]))
        throw failure("mesh file {}:{}: a vertex must have three coordinates", file, number);
      mesh.vertices.emplace_back(unit * p);
    }
    else if (key == "g" && words >> word)
    {
      const auto known = std::find(mesh.group_names.begin(), mesh.group_names.end(), word);
      group = static_cast<std::int32_t>(known - mesh.group_names.begin());
      if (known == mesh.group_names.end())
        mesh.group_names.push_back(word);
    }
    else if (key == "f")
    {
      std::vector<std::int32_t> face;
      while (words >> word)
        face.push_back(std::atoi(word.c_str()) - 1);
      if (face.size() < 3 ||
          std::any_of(face.begin(), face.end(),
                      [&](std::int32_t v) { return v < 0 || v >= static_cast<std::int32_t>(mesh.vertices.size()); }))
        throw failure("mesh file {}:{}: a face must have at least three numbers of vertices above it", file, number);
      mesh.faces.push_back(std::move(face));
      mesh.groups.push_back(group);
    }
  }
  if (mesh.faces.empty())
    throw failure("mesh file {}: has no faces as OBJ files have them, and only OBJ files can be subdivided", file);
  return mesh;
}

PolygonMesh with_mirror_image(const PolygonMesh& half, int axis, std::vector<std::int32_t>* mirror)
{
  PolygonMesh whole = half;
  std::vector<std::int32_t> image(half.vertices.size());
  double extent = 0;
  for (const Vector3d& p : half.vertices)
    extent = std::max(extent, p.cwiseAbs().maxCoeff());
  for (std::size_t v = 0; v < half.vertices.size(); ++v)
  {
    Vector3d p = half.vertices[v];
    if (std::abs(p[axis]) < 1e-5 * extent)  // files have rounded coordinates
    {
      whole.vertices[v][axis] = 0;
      image[v] = static_cast<std::int32_t>(v);
      continue;
    }
    p[axis] = -p[axis];
    image[v] = static_cast<std::int32_t>(whole.vertices.size());
    whole.vertices.push_back(p);
  }
  for (const auto& face : half.faces)
  {
    std::vector<std::int32_t> reversed;
    for (auto v = face.rbegin(); v != face.rend(); ++v)
      reversed.push_back(image[*v]);
    whole.faces.push_back(std::move(reversed));
    whole.groups.push_back(half.groups[whole.groups.size() - half.groups.size()]);
  }
  if (mirror != nullptr)
    *mirror = std::move(image);
  return whole;
}

TriangleMesh subdivide(const PolygonMesh& cage, int levels, const std::vector<std::string>& groups)
{
  PolygonMesh mesh = cage;
  for (int level = 0; level < levels; ++level)
    mesh = subdivide_once(mesh);
  TriangleMesh result;
  result.vertices.reserve(mesh.vertices.size());
  if (levels > 0)
  {
    const std::vector<Ring> rings = rings_of(mesh, EdgeTable(mesh));
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      result.vertices.push_back(to_array(rings[v].valence > 0 ? limit(mesh.vertices[v], rings[v]) : mesh.vertices[v]));
  }
  else
    for (const Vector3d& p : mesh.vertices)
      result.vertices.push_back(to_array(p));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
  {
    const Polygon& face = mesh.faces[f];
    if (!groups.empty() && std::find(groups.begin(), groups.end(), cage.group_names[mesh.groups[f]]) == groups.end())
      continue;
    for (std::size_t c = 2; c < face.size(); ++c)
      result.triangles.push_back({ face[0], face[c - 1], face[c] });
  }
  return result;
}

}  // namespace frontalis
