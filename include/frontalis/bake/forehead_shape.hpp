#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/scene/scene.hpp"

#include <string>
#include <vector>

namespace frontalis
{

/// Dimensions of the generated forehead [m] and their defaults. Coordinates are those of the face frame: origin at the
/// sellion (the deepest point of the nasal root) on the skin, x out of the face, y to the subject's left, z up.
/// The bone is an elliptic cylinder with a brow ridge, a glabella, a nasal root and flattened temples. Its profile
/// leans and curves backwards with height. The skin is offset from the bone along the bone's normal. The defaults lie
/// within ranges of adult anthropometry and imaging:
/// - forehead height (brow to hairline) 55-75 mm, minimum frontal breadth 90-110 mm, head breadth 140-160 mm
///   (Farkas, Anthropometry of the Head and Face, 2nd ed. 1994);
/// - soft tissue over the frontal bone 3.5-5.5 mm, at the glabella and brow 5-8 mm (facial soft-tissue depth tables,
///   Stephan & Simpson 2008);
/// - frontalis 30-45 mm wide per side, corrugator 25-40 mm long, procerus 20-30 mm long (dissection series).
struct ForeheadDimensions
{
  double height = 70e-3;               ///< from the brow to the hairline, in the midline
  double width = 150e-3;               ///< arc from temple to temple
  double front_radius = 75e-3;         ///< radius of curvature of the bone's horizontal section in the midline
  double half_breadth = 68e-3;         ///< lateral semi-axis of this elliptic section
  double brow_height = 18e-3;          ///< height of the brow over the sellion
  double brow_thickness = 8e-3;        ///< thickness of the soft tissue at the brow
  double hairline_thickness = 4.5e-3;  ///< thickness of the soft tissue at the hairline
  double profile_radius = 130e-3;      ///< radius of curvature of the bone's profile in the midline
  double ridge = 3e-3;                 ///< height of the brow ridge over the bone around it
  double glabella = 2e-3;              ///< height of the glabella over the bone around it
  double temple_flattening = 3e-3;     ///< distance of the temples behind the ellipse
  double margin = 8e-3;                ///< distance by which `skull` extends beyond the edges of `skin`
  double muscle_thickness = 2e-3;      ///< thickness of frontalis, corrugators and procerus
  double galea_thickness = 1e-3;       ///< thickness of the tendon sheet
};

/// Names of the dimensions that a scene may set.
std::vector<std::string> forehead_dimension_names();

/// Triangles of one of the forehead_parts(). Throws Error on an unknown part or dimension, listing those that exist,
/// and on dimensions with which the surfaces would fold or meet.
TriangleMesh make_forehead(const Shape& shape);

}  // namespace frontalis
