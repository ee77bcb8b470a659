#include "study/verification/calculix.hpp"

#include "frontalis/error.hpp"
#include "frontalis/study/equilibrium.hpp"
#include "frontalis/study/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

namespace frontalis
{
namespace
{

using Lattice = std::array<int, 3>;  // half elements from the origin

// corners and midpoints of the edges of the element at the origin, in CalculiX's order
constexpr int element_nodes[20][3] = { { 0, 0, 0 }, { 2, 0, 0 }, { 2, 2, 0 }, { 0, 2, 0 }, { 0, 0, 2 },
                                       { 2, 0, 2 }, { 2, 2, 2 }, { 0, 2, 2 }, { 1, 0, 0 }, { 2, 1, 0 },
                                       { 1, 2, 0 }, { 0, 1, 0 }, { 1, 0, 2 }, { 2, 1, 2 }, { 1, 2, 2 },
                                       { 0, 1, 2 }, { 0, 0, 1 }, { 2, 0, 1 }, { 2, 2, 1 }, { 0, 2, 1 } };

// lengths in mm, forces in N, stresses in MPa, masses in t
std::string deck(const SolidProblem& problem, const Lattice& elements, std::vector<std::array<double, 3>>& positions)
{
  std::map<Lattice, int> number;
  std::ostringstream nodes, solids, sections, held;
  for (auto* out : { &nodes, &solids, &sections, &held })
    out->precision(12);
  const auto position = [&](const Lattice& at)
  {
    std::array<double, 3> p;
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] = problem.size[axis] * at[axis] / (2 * elements[axis]);
    return p;
  };
  std::vector<std::ostringstream> of_material(problem.materials.size());
  int element = 0;
  for (int k = 0; k < elements[2]; ++k)
    for (int j = 0; j < elements[1]; ++j)
      for (int i = 0; i < elements[0]; ++i)
      {
        const int m = problem.material ? problem.material(position({ { 2 * i + 1, 2 * j + 1, 2 * k + 1 } })) : 0;
        auto& out = of_material[m];
        out << ++element;
        for (const auto& corner : element_nodes)
        {
          const Lattice at{ { 2 * i + corner[0], 2 * j + corner[1], 2 * k + corner[2] } };
          const auto entry = number.emplace(at, static_cast<int>(positions.size()) + 1);
          if (entry.second)
          {
            const auto p = position(at);
            positions.push_back(p);
            nodes << positions.size() << ',' << 1e3 * p[0] << ',' << 1e3 * p[1] << ',' << 1e3 * p[2] << '\n';
          }
          out << (&corner == element_nodes + 10 ? ",\n" : ",") << entry.first->second;
        }
        out << '\n';
      }
  for (std::size_t m = 0; m < problem.materials.size(); ++m)
  {
    const auto& p = problem.materials[m].parameters;
    const std::string name = fmt::to_string(m);
    solids << "*ELEMENT,TYPE=C3D20R,ELSET=E" << name << '\n' << of_material[m].str();
    sections << "*MATERIAL,NAME=M" << name << "\n*HYPERELASTIC,NEO HOOKE\n"
             << 0.5e-6 * p[0] << ',' << 2e6 / p[1] << "\n*DENSITY\n"
             << 1e-12 * problem.materials[m].density << "\n*SOLID SECTION,ELSET=E" << name << ",MATERIAL=M" << name
             << '\n';
  }
  for (std::size_t n = 0; n < positions.size(); ++n)
    for (const auto& hold : problem.holds)
      if (hold.where(positions[n]))
      {
        const auto u = hold.displacement(positions[n]);
        for (int axis = 0; axis < 3; ++axis)
          if (hold.components[axis])
            held << n + 1 << ',' << axis + 1 << ',' << axis + 1 << ',' << 1e3 * u[axis] << '\n';
      }
  const auto& g = problem.gravity;
  const double gravity = std::hypot(g[0], g[1], g[2]);
  std::ostringstream out;
  out.precision(12);
  out << "*NODE,NSET=NALL\n"
      << nodes.str() << solids.str() << sections.str() << "*STEP,NLGEOM,INC=1000\n*STATIC\n0.25,1,1e-5,0.5\n*BOUNDARY\n"
      << held.str();
  for (std::size_t m = 0; gravity > 0 && m < problem.materials.size(); ++m)
    out << "*DLOAD\nE" << m << ",GRAV," << 1e3 * gravity << ',' << g[0] / gravity << ',' << g[1] / gravity << ','
        << g[2] / gravity << '\n';
  out << "*NODE PRINT,NSET=NALL,FREQUENCY=1000\nU,RF\n*END STEP\n";
  return out.str();
}

std::string text_of(const std::filesystem::path& path)
{
  std::ifstream file(path);
  return { std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
}

// the last table of that name in the output; `unit` converts its numbers to SI units
Vectors last_block(const std::string& output, const std::string& name, std::size_t count, double unit)
{
  const std::size_t at = output.rfind(name);
  if (at == std::string::npos)
    throw Error("CalculiX: its output has no table of " + name);
  std::istringstream in(output.substr(output.find('\n', at)));
  Vectors values(count);
  std::size_t node = 0;
  for (std::size_t n = 0; n < count; ++n)
  {
    in >> node;
    if (!in || node < 1 || node > count)
      throw Error(fmt::format("CalculiX: its table of {} ends after {} of {} nodes", name, n, count));
    for (double& c : values[node - 1])
    {
      in >> c;
      c *= unit;
    }
  }
  return values;
}

}  // namespace

bool calculix_is_there() { return std::system("command -v ccx >/dev/null 2>&1") == 0; }

SolidState solve_by_calculix(const SolidProblem& problem, const std::array<int, 3>& elements)
{
  SolidState state;
  std::string folder = (std::filesystem::temp_directory_path() / "frontalis_ccx_XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr)
    throw Error(folder + ": cannot be made");
  const std::filesystem::path base(folder);
  write_text((base / "deck.inp").string(), deck(problem, elements, state.positions));
  const int status = std::system(("cd '" + folder + "' && ccx -i deck >log 2>&1").c_str());
  const std::string output = text_of(base / "deck.dat"), log = text_of(base / "log");
  std::filesystem::remove_all(base);
  if (status != 0 || log.find("*ERROR") != std::string::npos || log.find("Job finished") == std::string::npos)
    throw Error("CalculiX failed: " + log.substr(log.size() < 500 ? 0 : log.size() - 500));
  state.displacements = last_block(output, "displacements", state.positions.size(), 1e-3);
  state.forces = last_block(output, "forces", state.positions.size(), 1);
  return state;
}

SolidState solve_by_voxels(const SolidProblem& problem, double edge, double period, const Backend& backend)
{
  VoxelBox box;
  box.spacing.fill(edge);
  for (std::size_t axis = 0; axis < 3; ++axis)
    box.size[axis] = static_cast<std::int32_t>(std::lround(problem.size[axis] / edge));
  box.materials = problem.materials;
  if (problem.material)
    box.material = [&](const auto& v) {
      return problem.material({ { (v[0] + 0.5) * edge, (v[1] + 0.5) * edge, (v[2] + 0.5) * edge } });
    };
  Model model = voxel_model(box);
  model.hourglass = HourglassControl::assumed_strain;
  model.gravity = problem.gravity;
  SolidState state;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
  {
    state.positions.push_back(rest_position(model, n));
    for (const auto& hold : problem.holds)
      if (hold.where(state.positions[n]))
        prescribe(model, { static_cast<std::int32_t>(n) }, hold.components, hold.displacement(state.positions[n]));
  }
  EquilibriumSettings relax{ backend, period };
  relax.tolerance = 5e-4;
  RestState rest = find_equilibrium(model, relax);
  state.displacements = rest.displacements;
  rest.solver->internal_forces(state.forces);
  return state;
}

}  // namespace frontalis
