#pragma once

#include "frontalis/model/surface.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// A pinhole camera without distortion. Its axes are those of images in REP 103: x to the right, y down, z ahead. The
/// centre of the pixel in column u and row v has the image coordinates (u, v), as in sensor_msgs/CameraInfo and OpenCV.
struct PinholeCamera
{
  int width = 640, height = 480;                  ///< [pixels]
  double fx = 0, fy = 0, cx = 319.5, cy = 239.5;  ///< focal lengths and principal point [pixels]
  RigidTransform to_camera;                       ///< from the frame of the scene to that of the camera

  /// Image coordinates of a point in the frame of the camera. z must be above 0.
  std::array<double, 2> project(const std::array<double, 3>& p) const
  {
    return { { cx + fx * p[0] / p[2], cy + fy * p[1] / p[2] } };
  }
};

/// A camera with square pixels and the principal point in the middle; `field_of_view`: of the width [rad]. Throws Error
/// unless both sizes are within 1..8192 and the angle is between 0 and pi.
PinholeCamera camera_with(int width, int height, double field_of_view);

/// PinholeCamera::to_camera of a camera at `position` that looks at `target`, with z of the scene up in the picture,
/// turned by `roll` about its axis [rad]. Throws Error if the two points coincide, or if one of them is vertically
/// above the other.
RigidTransform look_at(const std::array<double, 3>& position, const std::array<double, 3>& target, double roll = 0);

/// What a pixel shows. Labels from skin_label on are regions of the skin (face_appearance.hpp).
enum Label : std::uint8_t
{
  background_label,
  inside_label,  ///< the back of a surface, or the dark space behind the lips
  eye_label,
  body_label,  ///< a body that tissue touches, such as teeth
  skin_label
};

/// Colour of surfaces with the label inside_label. They are drawn in this colour, whatever the light.
constexpr std::array<float, 3> inside_colour{ { 0.25F, 0.09F, 0.08F } };

/// Triangles that are drawn with smooth shading. Colours are red, green and blue as displays take them, 0..1.
struct RenderMesh
{
  std::vector<std::array<float, 3>> vertices;  ///< [m]
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::array<float, 3>> normals;  ///< outward, per vertex; empty: area-weighted means over triangles
  std::vector<std::array<float, 3>> colours;  ///< per vertex
  std::vector<std::uint8_t> labels;           ///< per vertex; a pixel has that of the closest corner of its triangle
};

/// Outward normals of the vertices: area-weighted means over triangles.
std::vector<std::array<float, 3>> normals_of(const RenderMesh& mesh);

struct RenderBall
{
  std::array<double, 3> centre;  ///< [m]
  double radius = 0;             ///< [m]
  std::array<float, 3> colour;
  std::uint8_t label = eye_label;
};

struct RenderScene
{
  std::vector<RenderMesh> meshes;
  std::vector<RenderBall> balls;
};

/// A main light, which casts shadows, a weaker light without shadows, and light from everywhere. Directions are towards
/// the light, in the frame of the scene; a matt surface has its colour times the sum of the lights.
struct Light
{
  std::array<double, 3> key{ { 1, -0.7, 0.9 } }, fill{ { 0.7, 1, 0.1 } };
  double key_strength = 0.66, fill_strength = 0.2, ambient = 0.24;
  double highlight = 0.12;  ///< strength of the main light's highlight
  double width = 0.08;      ///< angle under which the main light appears [rad]; shadows are soft with several samples
  std::array<float, 3> background{ { 1, 1, 1 } };
};

/// Images of a scene. Pixels are stored row by row from the top.
struct Images
{
  std::vector<std::array<std::uint8_t, 3>> colour;
  std::vector<float> depth;                  ///< along the camera's z, at the centre of the pixel [m]; 0: nothing there
  std::vector<std::uint8_t> label;           ///< at the centre of the pixel
  std::vector<std::array<float, 3>> normal;  ///< of the smooth surface there, in the frame of the camera; 0: nothing
};

/// Casts rays into one frame of a scene, by Embree. Equal inputs give equal images on one machine.
class Renderer
{
public:
  /// Throws Error if indices are out of range, or if a list with one entry per vertex has a different length from the
  /// list of vertices.
  Renderer(const RenderScene& scene, const PinholeCamera& camera);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Colours are means over samples x samples rays per pixel. A single ray passes through the centre of the pixel.
  Images images(const Light& light, int samples = 1) const;
  /// Whether a point of a surface (frame of the scene) is within the image and nothing is more than 2 mm in front of
  /// it.
  bool sees(const std::array<double, 3>& point) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace frontalis
