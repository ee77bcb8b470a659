#pragma once

#include "frontalis/model/body_shape.hpp"
#include "frontalis/render/renderer.hpp"
#include "frontalis/solver/solver.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

constexpr std::array<float, 3> teeth_colour{ { 0.93F, 0.91F, 0.84F } }, gum_colour{ { 0.78F, 0.47F, 0.45F } };

/// Colours of a body's vertices, and its label. A body that tissue touches looks like teeth, or like gums if its name
/// begins with "gums". A body that is only shown looks like skin, or like what its name says if that is "hair" or
/// "tongue", or like metal if its name begins with "core". Hair gets thinner towards the open border of its surface.
struct BodyAppearance
{
  std::uint8_t label = 0;
  std::array<float, 3> colour{};              ///< of most of the body
  std::vector<std::array<float, 3>> colours;  ///< per vertex
};
BodyAppearance body_appearance(const std::string& name, bool only_shown, const TriangleMesh& surface);

/// Names of all labels, from label 0 on.
std::vector<std::string> label_names();

/// Colours and labels of the skin of a face. They follow from the places of its landmarks at rest (face frame, [m]).
struct SkinAppearance
{
  std::vector<std::array<float, 3>> colours;  ///< of the vertices: skin, lips, painted brows and edges of the lids
  std::vector<std::uint8_t> labels;           ///< of the vertices: lips, brows, and the parts around named landmarks
  std::optional<RenderBall> mouth;            ///< a dark ball behind the lips
};
/// `eyes`: the eyeballs. The edges of the lids, which lie on them, are dark like lashes.
SkinAppearance skin_appearance(const std::vector<std::string>& landmarks,
                               const std::vector<std::array<float, 3>>& places,
                               const std::vector<std::array<float, 3>>& vertices,
                               const std::vector<RenderBall>& eyes = {});

/// The fraction of each skin vertex that the hair of a painted eyebrow covers, 0..1. `vertices`, and `places` of the
/// landmarks, are at rest [m]. The brow of a side is a band with soft borders along the line through the landmarks
/// whose names begin with "brow" and end with "_left" or "_right". The band extends about 1 cm beyond the line at both
/// ends, where it is lower and its hair thinner, but it ends 12 mm from the midline. A side with fewer than two such
/// landmarks has no brow. Brows show in pictures how the skin moves; they do not act on the tissue.
std::vector<float> brow_cover(const std::vector<std::string>& landmarks,
                              const std::vector<std::array<float, 3>>& places,
                              const std::vector<std::array<float, 3>>& vertices);

/// An eyeball in the face frame: a white ball, and a cap on it with the iris and its pupil. eyeballs() returns one for
/// each ball on which tissue slides and whose bone has a name that begins with "eye". `motion`: motion of a bone in the
/// face frame.
struct Eyeball
{
  std::size_t bone = 0;
  RenderBall ball;
  RenderMesh iris;
};
std::vector<Eyeball> eyeballs(const Model& model, const std::function<RigidTransform(std::size_t bone)>& motion);

/// The white balls of eyeballs() at rest.
std::vector<RenderBall> resting_eyes(const Model& model);

/// A dark ball behind an eyeball, which is seen where the lids leave a gap beside it.
RenderBall socket_of(const RenderBall& eyeball);

/// A body on which lips rest, drawn as a row of teeth with their gums. Teeth of common sizes are painted on the middle
/// of the body, which is cut off at their edges. `surface`: at rest, in the face frame, symmetric about y = 0.
/// `corner_height`: z of the corners of the mouth at rest [m].
RenderMesh painted_teeth(const TriangleMesh& surface, bool lower, double corner_height);

/// One of the model's body_shapes() at rest, in the face frame: painted as teeth if its name begins with "teeth" and
/// the model has the landmark mouth_corner_left, else with its body_appearance().
RenderMesh body_at_rest(const Model& model, const BodyShape& body);

/// Shows a model in the face frame: its skin, its eyeballs and its bodies.
class FaceAppearance
{
public:
  /// `rest`: the skin at rest. All skins are in the face frame. The model must outlive this object.
  FaceAppearance(const Model& model, const SkinState& rest);
  RenderScene scene(const SkinState& skin, const Controls& controls) const;

private:
  /// at rest, in the face frame
  struct Body
  {
    RenderMesh mesh;
    std::int32_t bone = -1;  ///< index into Model::bones; -1: it stands still
  };

  const Model& model_;
  SkinAppearance appearance_;
  std::vector<Body> bodies_;
};

}  // namespace frontalis
