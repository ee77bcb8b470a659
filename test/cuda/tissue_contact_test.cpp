// The GPU's code for contact of tissue with itself, run on the host. The test needs a CUDA toolkit but no GPU.
#include <gtest/gtest.h>

#if __has_include(<cuda_runtime.h>) && defined(__x86_64__)

#include "touch_in_patches.hpp"

#include "solver/energy/energy_ledger_keeper.hpp"
#include "solver/tissues_touch.hpp"

#include <memory>
#include <numeric>

using namespace frontalis;
using namespace frontalis::cuda;

namespace
{

constexpr double dt = 20e-6;
constexpr int steps = 1500, steps_per_launch = 64;

using Vector = std::array<double, 3>;

// Contact forces on the surfaces of a model whose nodes follow prescribed paths, computed by the host's code and by the
// GPU's code.
class TwoWays
{
public:
  explicit TwoWays(const Model& model)
      : model_(model),
        discretisation_(model),
        tables_(model, discretisation_),
        host_(model, discretisation_, plain_touch_kernels<double>())
  {
    const std::size_t count = tables_.vertices.size();
    for (std::size_t v = 0; v < count; ++v)
      for (const std::size_t half : { 0, 4 })
      {
        const auto& nodes = model.voxel_nodes[tables_.voxel[v]];
        const auto node = [&](std::size_t b) { return static_cast<std::uint32_t>(nodes[half + b]); };
        nodes_.push_back({ node(0), node(1), node(2), node(3) });
      }
    for (auto* const words : { &moved_, &placed_, &normal_, &change_, &searched_ })
      words->assign(count, float4{ 0, 0, 0, 0 });
    dual_.resize(2 * count);
    pairs_.assign(2 * count, { -1, 0, 0, 0, { 0, 0, 0 }, -1 });
    lost_.assign(count, 0);
    stored_.assign(count, 0);
    heads_.assign(std::size_t(tables_.sizes.bucket_mask) + 1, -1);
    next_.assign(tables_.triangles.size(), -1);
    sums_.assign(count, {});
    control_ = tables_.rest;
    gpu = tables_.sizes;
    gpu.bound.coordinates = tables_.coordinates.data();
    gpu.bound.nodes = nodes_.data();
    gpu.vertices = tables_.vertices.data();
    gpu.triangles = tables_.triangles.data();
    gpu.joined_begin = tables_.joined_begin.data();
    gpu.joined_sources = tables_.joined_sources.data();
    gpu.moved = gpu.placed = moved_.data();
    gpu.normal = normal_.data();
    gpu.change = gpu.rubs ? change_.data() : nullptr;
    gpu.searched = searched_.data();
    gpu.pairs = pairs_.data();
    gpu.lost = lost_.data();
    gpu.control = &control_;
    gpu.heads = heads_.data();
    gpu.next = next_.data();
    gpu.dual = dual_.data();
    gpu.sums = sums_.data();
    gpu.stored = stored_.data();
    for (auto& component : u_)
      component.assign(model.nodes.size(), 0.0);
    for (auto& component : v_)
      component.assign(model.nodes.size(), 0.0F);
    before_ = u_;
  }
  TwoWays(const TwoWays&) = delete;
  TwoWays& operator=(const TwoWays&) = delete;

  void cut(int blocks) { patches_ = std::make_unique<test::InPatches>(model_, tables_, blocks); }

  // The order in which threads run is reversed if they run `backwards`.
  void step(bool backwards)
  {
    on_host.assign(model_.nodes.size(), {});
    on_gpu.assign(model_.nodes.size(), {});
    const NodeShare all{ 0, 1, 0, model_.size[2] + 1, 0, static_cast<std::int32_t>(model_.nodes.size()) };
    const ConstraintStep now{ 0, dt, 0, {}, {}, {} };
    Components forces = u_;
    for (auto& component : forces)
      std::fill(component.begin(), component.end(), 0.0);
    double* const into[3] = { forces[0].data(), forces[1].data(), forces[2].data() };
    host_.prepare_step(all, pointers(u_).data());
    host_.before_step(all, pointers(u_).data(), now);
    host_.add_forces(all, ForceSink<double>(into));
    for (std::size_t n = 0; n < on_host.size(); ++n)
      for (std::size_t axis = 0; axis < 3; ++axis)
        on_host[n][axis] = -forces[axis][n];

    std::vector<float4> u;
    for (std::size_t n = 0; n < model_.nodes.size(); ++n)
      u.push_back({ float(u_[0][n]), float(u_[1][n]), float(u_[2][n]), 0 });
    const auto no_wait = [] {};
    const auto each = [&](std::uint32_t count, const auto& call)
    {
      for (std::uint32_t i = 0; i < count; ++i)
        call(backwards ? count - 1 - i : i);
    };
    const int step = steps_++ % steps_per_launch;
    if (step == 0)
      search(u, each);
    if (patches_)
    {
      if (step == 0)
        patches_->list(gpu);
      on_gpu = patches_->step(gpu, u, step, steps_per_launch, dt);
      return;
    }
    each(gpu.vertex_count, [&](std::uint32_t v) { place_touching(gpu, v, u.data(), no_wait); });
    const auto response = float(physics::friction_response(dt));
    each(gpu.vertex_count,
         [&](std::uint32_t v)
         {
           if (gpu.rubs)
             touch_triangles<true>(gpu, v, response, no_wait);
           else
             touch_triangles<false>(gpu, v, response, no_wait);
         });
    for (std::uint32_t v = 0; v < gpu.vertex_count; ++v)
      for (std::uint32_t b = 0; b < 8; ++b)
      {
        const Place part = corner_push(gpu, v, b);
        Vector& node = on_gpu[model_.voxel_nodes[tables_.voxel[v]][b]];
        node = { { node[0] + double(part.x), node[1] + double(part.y), node[2] + double(part.z) } };
      }
  }
  // Moves the nodes along their paths. Displacements are rounded to single precision, so that the host's code and the
  // GPU's code use equal numbers.
  template <class Path>
  void move(const Path& path)
  {
    before_ = u_;
    for (std::size_t n = 0; n < model_.nodes.size(); ++n)
    {
      const Vector to = path(n);
      for (std::size_t axis = 0; axis < 3; ++axis)
        u_[axis][n] = double(float(to[axis]));
    }
    const NodeShare all{ 0, 1, 0, model_.size[2] + 1, 0, static_cast<std::int32_t>(model_.nodes.size()) };
    host_.after_step(all, pointers(before_).data(), pointers(u_).data());
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t n = 0; n < model_.nodes.size(); ++n)
        v_[axis][n] = float((u_[axis][n] - before_[axis][n]) / dt);
  }
  double lost_on_gpu() const { return std::accumulate(lost_.begin(), lost_.end(), 0.0); }
  double lost_on_host()
  {
    EnergyLedger ledger = empty_ledger();
    std::vector<Vector> none;
    host_.add_energies(pointers(u_).data(), {}, false, none, ledger);
    return ledger["friction"];
  }

  TissueContactArguments gpu{};
  std::vector<Vector> on_host, on_gpu;  // forces on nodes [N]
  int searches = 0;

private:
  // The search before the steps of a launch.
  template <class Each>
  void search(const std::vector<float4>& u, const Each& each)
  {
    const float* const v[3] = { v_[0].data(), v_[1].data(), v_[2].data() };
    TissueContactArguments look = gpu;
    look.placed = placed_.data();
    for (std::uint32_t vertex = 0; vertex < gpu.vertex_count; ++vertex)
    {
      place_touching(look, vertex, u.data(), [] {});
      atomicMax(&control_.moved, __float_as_uint(norm(place(placed_[vertex]) - place(searched_[vertex]))));
      atomicMax(&control_.speed, __float_as_uint(speed_of(look, vertex, v)));
    }
    const TouchReach far(look, float(steps_per_launch * dt));
    if (far.needed)
    {
      clear_grid(look, 0, 1);
      each(gpu.triangle_count, [&](std::uint32_t t) { sort_triangle(look, t, far.cell); });
      each(gpu.vertex_count, [&](std::uint32_t vertex) { search_pairs(look, far, vertex); });
      ++searches;
    }
    end_search(look, far, float(dt));
  }

  using Components = std::array<std::vector<double>, 3>;
  static std::array<const double*, 3> pointers(const Components& u)
  {
    return { { u[0].data(), u[1].data(), u[2].data() } };
  }

  const Model& model_;
  const Discretisation discretisation_;
  const TouchTables tables_;
  TissueContact<double> host_;
  Components u_, before_;
  std::array<std::vector<float>, 3> v_;
  std::vector<uint4> nodes_;
  std::vector<float4> moved_, placed_, normal_, change_, searched_, dual_;
  std::vector<TouchPair> pairs_;
  std::vector<double> lost_;
  std::vector<float> stored_;
  std::vector<std::int32_t> heads_, next_;
  std::vector<TouchSum> sums_;
  TouchControl control_{};
  int steps_ = 0;
  std::unique_ptr<test::InPatches> patches_;
};

double length(const Vector& v) { return std::hypot(v[0], v[1], v[2]); }

}  // namespace

// The upper one of two blocks is pressed into the lower one, drawn along it, turned, and lifted, while waves pass
// through both.
TEST(TissueContactOfTheGpu, IsThatOfTheHost)
{
  for (const double friction : { 0.0, 0.4 })
  {
    test::BlockSettings settings;
    settings.voxels = { { 7, 6, 2 } };
    const Model model = test::two_blocks(settings, friction);
    TwoWays contact(model), again(model), cut(model);
    cut.cut(9);
    double most = 0, worst = 0, apart = 0, unbalanced = 0;
    int touching = 0;
    for (int step = 0; step < steps; ++step)
    {
      contact.step(false);
      again.step(true);
      EXPECT_EQ(contact.on_gpu, again.on_gpu) << step;
      cut.step(false);
      Vector sum{};
      double most_now = 0;
      for (std::size_t n = 0; n < contact.on_gpu.size(); ++n)
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
          sum[axis] += contact.on_gpu[n][axis];
          most_now = std::max(most_now, std::abs(contact.on_host[n][axis]));
          worst = std::max(worst, std::abs(contact.on_host[n][axis] - contact.on_gpu[n][axis]));
          apart = std::max(apart, std::abs(cut.on_gpu[n][axis] - contact.on_gpu[n][axis]));
        }
      unbalanced = std::max(unbalanced, length(sum));
      most = std::max(most, most_now);
      touching += most_now > 0 ? 1 : 0;
      const auto path = [&](std::size_t n)
      {
        const double part = double(step + 1) / steps, press = std::sin(3.14159265 * part);
        const auto at = test::rest(model, n);
        Vector to{};
        for (std::size_t axis = 0; axis < 3; ++axis)
          to[axis] = 10e-6 * std::sin(300 * (step + 1) * dt + 900 * at[axis] + double(axis));
        if (2 * model.nodes[n][2] > model.size[2])
          to = { { to[0] + 3e-3 * part - 0.2 * part * (at[1] - 3e-3), to[1] + 0.2 * part * (at[0] - 3e-3),
                   to[2] - 1.15e-3 * press } };
        return to;
      };
      contact.move(path);
      again.move(path);
      cut.move(path);
    }
    // The gap of 1 mm is closed while 1.15 mm times the sine of the path's angle is larger. Waves change these times a
    // little.
    EXPECT_NEAR(touching, steps * (1 - 2 * std::asin(1 / 1.15) / 3.14159265), 0.02 * steps);
    EXPECT_GT(contact.searches, 5);
    EXPECT_GT(most, 1e-3);
    EXPECT_LT(worst, 1e-5 * most) << friction;
    EXPECT_LT(apart, 1e-6 * most) << friction;
    EXPECT_LT(unbalanced, 1e-5 * most) << friction;
    EXPECT_EQ(contact.lost_on_host() > 0, friction > 0);
    EXPECT_NEAR(contact.lost_on_gpu(), contact.lost_on_host(), 1e-4 * contact.lost_on_host());
    EXPECT_EQ(contact.lost_on_gpu(), cut.lost_on_gpu());
  }
}

#else

TEST(TissueContactOfTheGpu, NeedsATool) { GTEST_SKIP() << "no CUDA toolkit"; }

#endif
