#include "study/verification/calculix.hpp"

#include "frontalis/error.hpp"
#include "frontalis/study/table.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace frontalis
{
namespace
{

std::string text_of(const std::filesystem::path& path)
{
  std::ifstream file(path);
  return { std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
}

// Reads the last table with a name, of `count` nodes, from CalculiX's output. The factor `unit` converts to SI units.
Vectors last_block(const std::string& output, const std::string& name, std::size_t count, double unit)
{
  const std::size_t at = output.rfind(name);
  if (at == std::string::npos)
    throw Error("CalculiX: the output has no table of " + name);
  std::istringstream in(output.substr(output.find('\n', at)));
  Vectors values(count);
  std::size_t node = 0;
  for (std::size_t n = 0; n < count; ++n)
  {
    in >> node;
    if (!in || node < 1 || node > count)
      throw Error(fmt::format("CalculiX: the table of {} ends after {} of {} nodes", name, n, count));
    for (double& c : values[node - 1])
    {
      in >> c;
      c *= unit;
    }
  }
  return values;
}

}  // namespace

bool calculix_is_installed() { return std::system("command -v ccx >/dev/null 2>&1") == 0; }

std::string calculix_material(const std::string& name, const Material& material)
{
  std::ostringstream out;
  out.precision(12);
  out << "*MATERIAL,NAME=" << name << "\n*HYPERELASTIC,NEO HOOKE\n"
      << 0.5e-6 * material.parameters[0] << ',' << 2e6 / material.parameters[1] << "\n*DENSITY\n"
      << 1e-12 * material.density << '\n';
  return out.str();
}

std::string calculix_step(const std::string& supports_and_loads)
{
  return "*STEP,NLGEOM,INC=1000\n*STATIC\n0.25,1,1e-5,0.5\n" + supports_and_loads +
         "*NODE PRINT,NSET=NALL,FREQUENCY=1000\nU,RF\n*END STEP\n";
}

CalculixState run_calculix(const std::string& deck, std::size_t nodes)
{
  std::string folder = (std::filesystem::temp_directory_path() / "frontalis_ccx_XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr)
    throw Error(folder + ": cannot be created");
  const std::filesystem::path base(folder);
  write_text((base / "deck.inp").string(), deck);
  const int status = std::system(("cd '" + folder + "' && ccx -i deck >log 2>&1").c_str());
  const std::string output = text_of(base / "deck.dat"), log = text_of(base / "log");
  std::filesystem::remove_all(base);
  if (status != 0 || log.find("*ERROR") != std::string::npos || log.find("Job finished") == std::string::npos)
    throw Error("CalculiX failed: " + log.substr(log.size() < 500 ? 0 : log.size() - 500));
  return { last_block(output, "displacements", nodes, 1e-3), last_block(output, "forces", nodes, 1) };
}

}  // namespace frontalis
