#include "cuda/backend/device_tissue_contact.hpp"

#include "cuda/backend/device_model.hpp"
#include "cuda/kernels/tissue_contact_kernels.hpp"
#include "frontalis/physics/surface_vertex.hpp"

#include <numeric>

namespace frontalis
{
namespace cuda
{
namespace
{

template <class T>
DeviceArray<T> copy_of(const DeviceArray<T>& from)
{
  DeviceArray<T> copy(from.size());
  require(cudaMemcpy(copy.data(), from.data(), from.bytes(), cudaMemcpyDeviceToDevice), "copying on the device");
  return copy;
}

template <class T>
void fill(DeviceArray<T>& array, const T& value)
{
  const std::vector<T> values(array.size(), value);
  array.upload(values.data(), values.size());
}

template <class T>
std::vector<T> values_of(const DeviceArray<T>& array)
{
  std::vector<T> values;
  array.download(values);
  return values;
}

}  // namespace

std::uint32_t most_touching_vertices(const Model& model, const VoxelPatches& patches)
{
  if (model.self_contacts.empty() || patches.patches.size() > patches.blocks)
    return 0;
  std::vector<std::uint32_t> in_voxel(model.voxels.size(), 0);
  for (const auto& vertex : TouchingSurface(model).vertices)
    ++in_voxel[vertex.voxel];
  return patches.most_in_patch(in_voxel);
}

DeviceTissueContact::DeviceTissueContact(const Model& model, const Discretisation& discretisation, const VoxelCut& cut,
                                         const std::vector<std::uint32_t>& device_node)
    : model_(model),
      device_node_(device_node),
      tables_(model, discretisation),
      all_(tables_.sizes),
      points_(model, tables_.voxel, tables_.coordinates, device_node),
      vertices_(tables_.vertices),
      triangles_(tables_.triangles),
      joined_begin_(tables_.joined_begin),
      joined_sources_(tables_.joined_sources)
{
  const std::size_t count = tables_.vertices.size();
  for (auto* const words : { &moved_, &searched_, &placed_, &normal_ })
    *words = DeviceArray<float4>(count);
  change_ = DeviceArray<float4>(all_.rubs ? count : 0);
  dual_ = DeviceArray<float4>(2 * count);
  // searches for the time step read them before the first step
  for (const auto* const words : { &placed_, &normal_, &change_, &dual_ })
    words->clear();
  pairs_ = DeviceArray<TouchPair>(touch_search::most_pairs * count);
  lost_ = DeviceArray<double>(count);
  control_ = DeviceArray<TouchControl>(1);
  heads_ = DeviceArray<std::int32_t>(std::size_t(all_.bucket_mask) + 1);
  next_ = DeviceArray<std::int32_t>(tables_.triangles.size());
  sums_ = DeviceArray<TouchSum>(count);
  stored_ = DeviceArray<float>(count);
  all_.bound = points_.view();
  all_.vertices = vertices_.data();
  all_.triangles = triangles_.data();
  all_.joined_begin = joined_begin_.data();
  all_.joined_sources = joined_sources_.data();
  all_.moved = all_.placed = moved_.data();
  all_.normal = normal_.data();
  all_.change = change_.data();
  all_.searched = searched_.data();
  all_.pairs = pairs_.data();
  all_.lost = lost_.data();
  all_.control = control_.data();
  all_.heads = heads_.data();
  all_.next = next_.data();
  all_.dual = dual_.data();
  all_.sums = sums_.data();
  all_.stored = stored_.data();
  if (cut.patches && cut.part_room.room.touch_vertices > 0)
  {
    in_patches_ = std::make_unique<DeviceTouchPatches>(TouchPatchTables(tables_, *cut.patches));
    all_.in_patches = in_patches_->view();
  }
  reset();
}

void DeviceTissueContact::list_arrays(ArrayList& list)
{
  const Effect effect = Effect::self_contact;
  list.add(effect, "vertices", vertices_.bytes() + points_.bytes() + joined_begin_.bytes() + joined_sources_.bytes());
  list.add(effect, "triangles", triangles_.bytes());
  list.add(effect, "forces", dual_.bytes() + sums_.bytes() + stored_.bytes());
  list.add(effect, "places", placed_.bytes() + normal_.bytes() + change_.bytes());
  list.add(effect, "grid", heads_.bytes() + next_.bytes());
  if (in_patches_)
    list.add(effect, "patches", in_patches_->bytes());
  for (auto* const words : { &moved_, &searched_ })
    list_state(list, effect, "places", *words);
  list_state(list, effect, "pairs", pairs_);
  list_state(list, effect, "sums", lost_);
  list_state(list, effect, "grid", control_);
  list.add_state(effect, "sums", opened_);
}

void DeviceTissueContact::run(EffectSet running)
{
  runs_ = running.has(Effect::self_contact);
  if (!runs_)
    reset();
}

void DeviceTissueContact::reset()
{
  for (auto* const words : { &moved_, &searched_ })
    words->clear();
  lost_.clear();
  fill(pairs_, TouchPair{ -1, 0, 0, 0, { 0, 0, 0 }, -1 });
  fill(control_, tables_.rest);
  opened_[0] = 0;
}

void DeviceTissueContact::prepare(const StepArguments& g, int steps, cudaStream_t stream) const
{
  if (tables_.vertices.empty())
    return;
  TissueContactArguments look = all_;
  look.placed = placed_.data();
  look.in_patches = g.touch.in_patches;
  require(launch_touch_search(look, g.u[g.first], g.v, g.dt_exact, steps, stream), "searching for contact");
}

void DeviceTissueContact::find_pushes(const StepArguments& g, int /*step*/, cudaStream_t stream) const
{
  if (tables_.vertices.empty())
    return;
  const float4* const u = g.u[g.first];
  require(g.contact.spring ? launch_touch_springs(all_, u, stream) : launch_touch(all_, u, g.dt_exact, stream),
          "finding forces of contact of tissue with itself");
}

void DeviceTissueContact::push(const StepArguments& g, float factor, float* const (&v)[3], cudaStream_t stream) const
{
  if (!tables_.vertices.empty())
    require(launch_push_touching(g, all_, factor, v, stream), "pushing nodes");
}

// The sums of losses end at the start of the latest step. Here the forces are found once more, on copies of the state,
// so that the losses that the next step would add are included.
void DeviceTissueContact::add_energies(const std::vector<double> (&u)[3], const std::vector<RigidTransform>& /*bones*/,
                                       bool open, Vectors& forces, EnergyLedger& ledger)
{
  std::vector<float4> displacements(device_node_.size() + 1, float4{ 0, 0, 0, 0 });
  for (std::size_t n = 0; n < device_node_.size(); ++n)
    displacements[device_node_[n]] = { static_cast<float>(u[0][n]), static_cast<float>(u[1][n]),
                                       static_cast<float>(u[2][n]), 0 };
  const DeviceArray<float4> at(displacements), moved = copy_of(moved_), normal = copy_of(normal_),
                                               change = copy_of(change_);
  const DeviceArray<TouchPair> pairs = copy_of(pairs_);
  const DeviceArray<double> lost = copy_of(lost_);
  TissueContactArguments look = all_;
  look.measures = true;
  look.moved = look.placed = moved.data();
  look.normal = normal.data();
  look.change = change.data();
  look.pairs = pairs.data();
  look.lost = lost.data();
  require(launch_touch(look, at.data(), double(values_of(control_)[0].dt), nullptr), "measuring contact");
  const auto sum = [](const auto& values)
  { return std::accumulate(values.begin(), values.end(), 0.0, [](double a, auto b) { return a + double(b); }); };
  const double rubbed = sum(values_of(lost));
  if (open)
    opened_[0] = rubbed;
  ledger["contact_stored"] += sum(values_of(stored_));
  ledger["friction"] += rubbed - opened_[0];
  if (forces.empty())
    return;
  const auto sums = values_of(sums_);
  const auto normals = values_of(normal), duals = values_of(dual_);
  for (std::size_t v = 0; v < tables_.vertices.size(); ++v)
  {
    using Vector = physics::Vec3<double>;
    const auto vector = [](const auto& a) { return Vector{ double(a.x), double(a.y), double(a.z) }; };
    const TouchVertex& vertex = tables_.vertices[v];
    const auto in_newton = [&](const unsigned long long(&units)[3])
    {
      const auto number = [&](std::size_t i) { return static_cast<double>(static_cast<std::int64_t>(units[i])); };
      return (1 / double(all_.per_newton)) * Vector{ number(0), number(1), number(2) };
    };
    const Vector force = in_newton(sums[v].force), turn = double(all_.edge) * in_newton(sums[v].turn);
    const Vector tangent[2] = { vector(vertex.tangent[0]), vector(vertex.tangent[1]) };
    const Vector along =
        physics::normal_forces(turn, vector(duals[2 * v]), vector(duals[2 * v + 1]), tangent,
                               Vector{ 1 / model_.spacing[0], 1 / model_.spacing[1], 1 / model_.spacing[2] });
    const float4& c = tables_.coordinates[v];
    const physics::SideWeights<double> weights(double(c.x), double(c.y), double(c.z));
    for (int b = 0; b < 8; ++b)
    {
      const Vector part = physics::surface_node_force(weights, b, force, along, vector(normals[v]));
      auto& of_node = forces[model_.voxel_nodes[tables_.voxel[v]][b]];
      of_node[0] += part.x;
      of_node[1] += part.y;
      of_node[2] += part.z;
    }
  }
}

}  // namespace cuda
}  // namespace frontalis
