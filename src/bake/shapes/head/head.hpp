#pragma once

#include "bake/mesh/subdivide.hpp"
#include "bake/mesh/triangle_tree.hpp"
#include "bake/shapes/head/solids.hpp"
#include "frontalis/scene/head_template.hpp"
#include "frontalis/scene/tissue.hpp"

#include <mutex>
#include <optional>

namespace frontalis
{

/// Moves the default head to the dimensions asked for. The displacement is the most likely one of a smooth random field
/// (Matern 3/2 covariance; kriging with differences as data) that gives each independent dimension its value.
class HeadWarp
{
public:
  /// `landmarks` [m]: those of the left side and of the midline (y = 0), by name. Throws Error on values that
  /// contradict each other, naming them.
  HeadWarp(const HeadTemplate& head, const std::map<std::string, Vector3d>& landmarks,
           const std::map<std::string, double>& wanted);

  Vector3d operator()(const Vector3d& p) const;

private:
  std::vector<Vector3d> places_;   ///< landmarks of both sides
  std::vector<Vector3d> weights_;  ///< of the covariance with each
};

/// Signed distance-like fields of the default head's bones [m], negative inside.
class HeadBones
{
public:
  /// Depths of the template are multiplied by `tissue`, but for those of the teeth and the chin.
  HeadBones(const HeadTemplate& head, const TriangleTree& skin, double tissue = 1);

  /// Outer surface of skull, teeth and mandible, as if the nose's and the eyes' openings were closed.
  double hull(const Vector3d& p) const;
  bool has(const std::string& name) const { return bones_.count(name) + bodies_.count(name) > 0; }
  double part(const std::string& name, const Vector3d& p) const;
  /// The bone or eyeball closest to the skin.
  double any(const Vector3d& p) const;

private:
  struct Bone
  {
    explicit Bone(const std::vector<HeadTemplate::BoneStep>& from);
    double operator()(const Vector3d& p, double hull) const;

    struct Step
    {
      HeadTemplate::BoneStep::Kind kind;
      std::vector<HeadSolid> solids;
      double round;
    };
    std::vector<Step> steps;
  };

  Vector3d eye_;
  double eye_radius_;
  std::map<std::string, Bone> bones_, bodies_;
  std::vector<Vector3d> centres_;
  std::vector<double> weights_;
  Eigen::Vector4d linear_{ 0, 0, 0, 0 };
};

/// Triangles of the surface f = 0 of a function that is symmetric in y, between two corners with lower y = 0: made on
/// one side by marching tetrahedra with cells of `edge` [m] and mirrored. f is negative inside; normals point outwards.
TriangleMesh isosurface(const std::function<double(const Vector3d&)>& f, const Box& half, double edge);

/// The head of a template with given dimensions. All parts are made for the default head and moved by one warp, so that
/// they fit together.
class Head
{
public:
  Head(std::shared_ptr<const HeadTemplate> head, const std::map<std::string, double>& dimensions, double tissue = 1);

  /// Triangles of a part, with edges of about `edge` [m] (0: 1.75 mm, skull 2). Throws Error on an unknown part.
  TriangleMesh part(const std::string& name, double edge) const;
  /// Control net of a muscle; nothing if the part is not one.
  std::optional<ControlNet> net(const std::string& part) const;
  /// Value of a dimension [m] on this head's skin.
  double dimension(const std::string& name) const;
  /// Where a place of the default head is on this one.
  Vector3d moved(const Vector3d& p) const { return (*warp_)(p); }
  Vector3d place(const HeadTemplate::Point& point) const;
  /// Position of a landmark; `right`: of its image on the right side.
  Vector3d landmark(const std::string& name, bool right = false) const;

private:
  TriangleMesh skin(const std::string& name, double edge) const;
  TriangleMesh eye(bool left, double edge) const;
  TriangleMesh bone(const std::string& name, double edge) const;
  ControlNet left_net(const HeadTemplate::Muscle& muscle) const;
  /// left_net(), found once per muscle: surfaces and fibres of both sides ask for it.
  ControlNet known_net(const HeadTemplate::Muscle& muscle) const;
  /// Skin's closest point to p, its outward normal, and the thickness of the soft tissue there, at most 20 mm.
  struct Below
  {
    Vector3d skin, normal;
    double thickness;
  };
  Below below(const Vector3d& p) const;

  std::shared_ptr<const HeadTemplate> head_;
  PolygonMesh cage_;
  std::vector<std::int32_t> mirror_;
  TriangleMesh default_skin_;
  std::vector<Vector3d> normals_;  ///< of the default skin's vertices
  std::optional<TriangleTree> tree_;
  std::map<std::string, Vector3d> landmarks_;  ///< of the default head, left or midline
  std::optional<HeadWarp> warp_;
  std::optional<HeadBones> bones_;
  mutable std::mutex nets_mutex_;
  mutable std::map<std::string, ControlNet> nets_;
};

/// The head that a shape is a part of; equal shapes share one.
std::shared_ptr<const Head> head_of(const Shape& shape);

/// Triangles of a part of a head, and the control net of a muscle that is one.
TriangleMesh make_head(const Shape& shape);
std::optional<ControlNet> head_muscle_net(const Shape& shape);

}  // namespace frontalis
