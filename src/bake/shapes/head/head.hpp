#pragma once

#include "bake/mesh/subdivide.hpp"
#include "bake/mesh/triangle_tree.hpp"
#include "bake/shapes/head/solids.hpp"
#include "bake/shapes/isosurface.hpp"
#include "bake/shapes/radial_field.hpp"
#include "frontalis/scene/head_template.hpp"
#include "frontalis/scene/tissue.hpp"

#include <mutex>
#include <optional>

namespace frontalis
{

/// Dimensions and their values in mm, for messages.
std::string words_for(const std::map<std::string, double>& dimensions);

/// Deforms the default head to given dimensions. The displacement is the most likely one of a smooth random field that
/// gives each independent dimension its value (kriging with a Matern 3/2 covariance, from distances of landmarks). The
/// head is shifted so that the fissure of the mouth keeps its height.
class HeadWarp
{
public:
  /// `landmarks` [m]: positions on the left side and in the midline (y = 0), by name. Throws Error on dimensions that
  /// contradict each other, naming them.
  HeadWarp(const HeadTemplate& head, const std::map<std::string, Vector3d>& landmarks,
           const std::map<std::string, double>& wanted);

  Vector3d operator()(const Vector3d& p) const;
  /// Volume of a small piece of tissue at a place, divided by that in the default head; not positive where the head is
  /// folded.
  double volume_ratio(const Vector3d& p) const;

private:
  std::vector<Vector3d> places_;   ///< landmarks of both sides
  std::vector<Vector3d> weights_;  ///< weights of the covariance with each place
  double lift_ = 0;                ///< added to all heights, so that a landmark keeps its own [m]
};

/// Fields that approximate the signed distances from the default head's bones [m], negative inside.
class HeadBones
{
public:
  /// Multiplies the depths of the template by `tissue`, except at the teeth and the chin.
  HeadBones(const HeadTemplate& head, const TriangleTree& skin, double tissue = 1);

  /// Signed distance from the hull: the outer surface of skull, teeth and mandible, with nose and eye openings closed.
  double hull(const Vector3d& p) const { return (*hull_)(p); }
  bool has(const std::string& name) const { return bones_.count(name) + bodies_.count(name) > 0; }
  double part(const std::string& name, const Vector3d& p) const;
  /// Signed distance from the union of all bones and eyeballs.
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
  std::optional<RadialField> hull_;
};

/// The head of a template with given dimensions. All parts are made for the default head and moved by one warp, so that
/// they fit together.
class Head
{
public:
  Head(std::shared_ptr<const HeadTemplate> head, const std::map<std::string, double>& dimensions, double tissue = 1);

  /// Triangles of a part, with edges of about `edge` [m] (0: 1.75 mm, skull 2 mm). Throws Error on an unknown part.
  TriangleMesh part(const std::string& name, double edge) const;
  /// Control net of a part that is a muscle; empty for other parts.
  std::optional<ControlNet> net(const std::string& part) const;
  /// Value of a dimension [m] on this head's skin.
  double dimension(const std::string& name) const;
  /// Position on this head of a point of the default head.
  Vector3d moved(const Vector3d& p) const { return (*warp_)(p); }
  /// How far the outer surface of the bones near a point of the default head is displaced because there is more or less
  /// tissue on it. Dimensions do not count.
  Vector3d bone_shift(const Vector3d& p) const;
  Vector3d place(const HeadTemplate::Point& point) const;
  /// Position of a landmark, or with `right` of its image on the right side.
  Vector3d landmark(const std::string& name, bool right = false) const;

private:
  /// Throws Error if the dimensions fold the skin, with the place.
  void check_folds(const std::map<std::string, double>& dimensions) const;
  TriangleMesh skin(const std::string& name, double edge) const;
  TriangleMesh eye(bool left, double edge) const;
  TriangleMesh bone(const std::string& name, double edge) const;
  ControlNet left_net(const HeadTemplate::Muscle& muscle) const;
  /// How much deeper a place lies that is `depth` below a point of the skin, because the bone there is deeper: in
  /// proportion to its depth above the bone, and as much as the bone below it.
  double deeper(const Vector3d& skin, double depth) const;
  /// left_net(), computed once per muscle, because surfaces and fibres of both sides need it.
  ControlNet known_net(const HeadTemplate::Muscle& muscle) const;
  /// The point of the skin closest to p, the outward normal and the thickness of the soft tissue there, at most 20 mm.
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
  std::vector<Vector3d> normals_;  ///< normals at the default skin's vertices
  std::optional<TriangleTree> tree_;
  std::map<std::string, Vector3d> landmarks_;  ///< landmarks of the default head, left or midline
  std::optional<HeadWarp> warp_;
  std::optional<HeadBones> bones_,
      usual_bones_;  ///< usual: below the usual amount of tissue; empty if that is this one
  mutable std::mutex nets_mutex_;
  mutable std::map<std::string, ControlNet> nets_;
};

/// The head that a shape is a part of; equal shapes share one.
std::shared_ptr<const Head> head_of(const Shape& shape);

/// Triangles of a part of a head, and the control net of a part that is a muscle.
TriangleMesh make_head(const Shape& shape);
std::optional<ControlNet> head_muscle_net(const Shape& shape);

}  // namespace frontalis
