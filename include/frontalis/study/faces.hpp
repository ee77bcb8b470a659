#pragma once

#include "frontalis/study/table.hpp"
#include "frontalis/solver/solver.hpp"

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// How far a landmark of people's faces moves in an expression.
struct PublishedMotion
{
  std::string landmark;           ///< without the side
  std::array<double, 3> along{};  ///< unit vector: forward, outward (from the midline), up
  double mean = 0;                ///< [m]
  double deviation = 0;           ///< [m]; 0: none is published
  bool component = false;         ///< mean and deviation are of the part along the direction
  std::string mark, source;
};

struct PublishedExpression
{
  double settles = 0;              ///< time to 97 % of the way [s]; 0: not published
  std::vector<std::string> still;  ///< landmarks that do not move
  std::vector<PublishedMotion> motions;
};

struct People
{
  std::vector<std::string> order;  ///< names of expressions as the file lists them
  std::map<std::string, PublishedExpression> expressions;
};

/// Reads a file such as config/people.yaml, which says what its keys mean. Throws Error with the file's line.
People read_people(const std::string& path);

struct FaceSettings
{
  SolverSettings solver;
  double ramp = 0.1;     ///< seconds in which activations and bones get to the expression, linearly
  double seconds = 1.2;  ///< the settled place of a landmark is where it is then
  /// Called with each expression's settled skin, in the face frame, and the controls at its end; and once with the skin
  /// at rest and an empty name.
  std::function<void(const std::string& name, const SkinState& skin, const Controls& controls)> settled{};
  std::function<void(double done)> watch{};  ///< called with the proportion of an expression that is done; may throw
};

/// One landmark in one expression, compared with people.
struct FaceRow
{
  std::string expression, landmark;
  std::array<double, 3> moved{};  ///< forward, outward, up [m]
  double size = 0;                ///< of the displacement, or of its part along the published direction [m]
  double angle = 0;               ///< between it and the published direction [rad]; NaN: only a part is published
  double settled = 0;             ///< time after which it stays within 3 % of its way from its settled place [s]
  double least = 0, most = 0;     ///< sizes that pass [m]; NaN: none is published
  double settles = 0;             ///< largest `settled` that passes [s]; 0: any
  const PublishedMotion* people = nullptr;  ///< null: a landmark that people do not move, or of which nothing is known

  bool passed() const;
};

/// Plays an expression from rest and measures its landmarks, those with published motions first, then those that stay
/// still and the others; by side where the landmark has sides. With the profile `draft`, 0.6 to 1.4 of a mean passes.
/// Throws Unstable if the guard stops the motion.
std::vector<FaceRow> measure_expression(const std::shared_ptr<const Model>& model, const std::string& expression,
                                        const PublishedExpression& people, const FaceSettings& settings);

/// The rows that are compared; with `all`, the others too.
Table faces_table(const std::vector<FaceRow>& rows, bool all);

}  // namespace frontalis
