// The hard case of a slit of zero width, which is pulled open and pressed shut.

#include "study/stability/stability_cases.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

/// Cuts a box of equal cubic voxels at half its height, from x = 0 over `length` voxels. The layer above is a flap.
void cut(Model& model, std::int32_t length)
{
  const std::int32_t middle = model.size[2] / 2, first = model.size[2] + 1, shift = first - middle;
  for (Voxel& voxel : model.voxels)
    if (voxel[2] == middle && voxel[0] < length)
      voxel[2] += shift;
  std::sort(model.voxels.begin(), model.voxels.end(),
            [](const Voxel& a, const Voxel& b)
            { return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend()); });
  model.flaps = { { first, shift } };
  model.size[2] = first + 1;
  build_nodes(model);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
  {
    const Voxel place = rest_place(model, model.nodes[n]);
    if (place == model.nodes[n] || (place[2] == middle && place[0] < length))
      continue;
    const auto master = std::find(model.nodes.begin(), model.nodes.end(), place);
    model.joints.push_back({ static_cast<std::int32_t>(n), static_cast<std::int32_t>(master - model.nodes.begin()) });
  }
}

/// Adds one side of the cut to the surface that touches itself. `k`: the layer of voxels behind this side.
void add_side(const Model& model, SelfContact& contact, std::int32_t k, bool upper, std::int32_t length)
{
  const auto first = static_cast<std::int32_t>(contact.surface.vertices.size());
  const std::int32_t columns = length + 1, rows = model.size[1] + 1;
  for (std::int32_t j = 0; j < rows; ++j)
    for (std::int32_t i = 0; i < columns; ++i)
    {
      const Voxel voxel{ { std::min(i, length - 1), std::min(j, model.size[1] - 1), k } };
      const auto found = std::find(model.voxels.begin(), model.voxels.end(), voxel) - model.voxels.begin();
      const double z = rest_place(model, voxel)[2] + (upper ? 0 : 1);
      contact.surface.vertices.push_back({ { i * model.spacing[0], j * model.spacing[1], z * model.spacing[2] } });
      contact.binding.voxel.push_back(static_cast<std::int32_t>(found));
      contact.binding.coordinates.push_back(
          { { static_cast<float>(i - voxel[0]), static_cast<float>(j - voxel[1]), upper ? 0.0F : 1.0F } });
    }
  for (std::int32_t j = 0; j + 1 < rows; ++j)
    for (std::int32_t i = 0; i + 1 < columns; ++i)
    {
      const std::int32_t a = first + j * columns + i, b = a + 1, c = a + columns, d = c + 1;
      for (const auto& t : { std::array<std::int32_t, 3>{ a, b, c }, std::array<std::int32_t, 3>{ b, d, c } })
        contact.surface.triangles.push_back(upper ? Voxel{ t[0], t[2], t[1] } : t);
    }
}

/// The smallest and the largest width of the slit [m] at its nodes.
std::pair<double, double> widths(GuardedTrial& motion, std::int32_t length)
{
  const Model& model = motion.model();
  const Vectors u = motion.displacements();
  double least = 1, most = -1;
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const Voxel place = rest_place(model, model.nodes[n]);
    if (place == model.nodes[n] || place[2] != model.flaps[0].first - model.flaps[0].shift || place[0] >= length)
      continue;
    const auto below = std::find(model.nodes.begin(), model.nodes.end(), place) - model.nodes.begin();
    const double width = u[n][2] - u[below][2];
    least = std::min(least, width);
    most = std::max(most, width);
  }
  return { least, most };
}

void opened_slit(CaseRun& run)
{
  Model model = damped_block(run);
  const double top = model.size[2] * model.spacing[2];
  const auto length = static_cast<std::int32_t>(run.number("length"));
  cut(model, length);
  hold(model, [](const Point& p) { return p[2] == 0; });
  hold(
      model, [&](const Point& p) { return p[2] > top - 1e-6; }, "lid");
  SelfContact contact;
  contact.name = "slit";
  contact.friction = run.number("friction");
  add_side(model, contact, model.size[2] - 1, true, length);
  add_side(model, contact, model.flaps[0].first - model.flaps[0].shift - 1, false, length);
  model.self_contacts.push_back(contact);
  GuardedTrial motion(run, model);
  const Controls open = motion.controls(0, shifted({ { 0, 0, 1e-3 * run.number("open", "mm") } })),
                 shut = motion.controls(0, shifted({ { 0, 0, -1e-3 * run.number("shut", "mm") } }));
  for (int round = 0; round < 2; ++round)
  {
    motion.advance({ run.seconds("moving"), open, 20 });
    run.check("opening of the slit over the prescribed displacement", "", 1,
              1e3 * widths(motion, length).second / run.number("open", "mm"), "opening");
    motion.advance({ run.seconds("moving"), shut, 20 });
    run.check("depth of its sides in each other", "mm", 0, -1e3 * widths(motion, length).first, "depth");
  }
  motion.plot("opened_slit", "A slit of zero width is pulled open and pressed shut");
  motion.advance({ run.seconds("rest"), motion.controls(), 20 });
  motion.check_balance("pulled open and pressed shut");
  run.check("remaining displacement", "mm", 0, 1e3 * farthest(motion.displacements()), "left");
}

}  // namespace

CaseFunctions hard_slits() { return { { "opened_slit", opened_slit } }; }

}  // namespace frontalis
