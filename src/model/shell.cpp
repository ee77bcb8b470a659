#include "frontalis/model/shell.hpp"

#include "model/effect_description.hpp"
#include "model/model_checks.hpp"
#include "model/model_layout.hpp"

namespace frontalis
{
namespace
{

EffectPresence found(const Model& model)
{
  std::size_t points = 0;
  for (const Shell& shell : model.shells)
    points += shell.surface.vertices.size();
  return { points > 0,
           points > 0 ? fmt::format("{} layer{}", model.shells.size(), model.shells.size() == 1 ? "" : "s")
                      : "no layer is a shell",
           0, points };
}

void check(const Model& model)
{
  using namespace checks;
  for (const Shell& shell : model.shells)
  {
    const std::string name = "shells '" + shell.name + "'";
    check_positive(name + ".thickness", 0, shell.thickness);
    index_below(model.materials.size())(name + ".material", 0, shell.material);
    check_mesh(name, shell.surface);
    check_binding(name + ".binding", shell.binding, shell.surface.vertices.size(), model.voxels.size());
  }
}

// Writes or reads the shells of a model file. The file of a model without shells has no arrays for them.
template <class Archive, class Shells>
void exchange(Archive& archive, Shells& shells)
{
  const std::string path = "shells";
  if (!archive.group_if(!shells.empty(), path))
    return;
  archive.table(path, shells, Column{ "name", &Shell::name }, Column{ "thickness", &Shell::thickness },
                Column{ "material", &Shell::material });
  for (std::size_t s = 0; s < shells.size(); ++s)
  {
    const std::string own = path + "/" + std::to_string(s);
    exchange_mesh(archive, own, shells[s].surface);
    exchange_binding(archive, own, shells[s].binding);
  }
}

}  // namespace

EffectDescription shell_description()
{
  return { Effect::shell,
           found,
           [](Model& model, EffectSet) { model.shells.clear(); },
           check,
           [](ModelWriter& archive, const Model& model) { exchange(archive, model.shells); },
           [](ModelReader& archive, Model& model) { exchange(archive, model.shells); } };
}

}  // namespace frontalis
