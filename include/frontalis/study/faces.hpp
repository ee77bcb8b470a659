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
  bool component = false;         ///< whether mean and deviation are those of the component along the direction
  std::string mark, source;
};

struct PublishedExpression
{
  double settles = 0;              ///< time until 97 % of the motion [s]; 0: not published
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
  double ramp = 0.1;     ///< time in which activations and bones change linearly to those of the expression [s]
  double seconds = 1.2;  ///< duration of an expression [s]; the positions at its end count as settled
  /// Called with each expression's settled skin, in the face frame, and the controls at its end. Also called once with
  /// the skin at rest and an empty name.
  std::function<void(const std::string& name, const SkinState& skin, const Controls& controls)> settled{};
  std::function<void(double done)> watch{};  ///< called with the completed fraction of an expression; may throw
};

/// One landmark in one expression, compared with people.
struct FaceRow
{
  std::string expression, landmark;
  std::array<double, 3> moved{};  ///< forward, outward, up [m]
  double size = 0;                ///< length of the displacement, or its component along the published direction [m]
  /// angle between the displacement and the published direction [rad]; NaN: only a component is published
  double angle = 0;
  /// time after which the landmark stays close to its settled position, within 3 % of its displacement [s]
  double settled = 0;
  double least = 0, most = 0;               ///< smallest and largest `size` that pass [m]; NaN: none is published
  double settles = 0;                       ///< largest `settled` that passes [s]; 0: every value passes
  const PublishedMotion* people = nullptr;  ///< null: the landmark does not move in people, or nothing is published

  bool passed() const;
};

/// Plays an expression from rest and measures its landmarks: first those with published motions, then those that stay
/// still, then the others. A landmark with sides is measured on both. With the profile `draft`, 0.6 to 1.4 times a
/// published mean passes. Throws Unstable if the guard stops the motion.
std::vector<FaceRow> measure_expression(const std::shared_ptr<const Model>& model, const std::string& expression,
                                        const PublishedExpression& people, const FaceSettings& settings);

/// The rows with published figures; with `all`, the other rows too.
Table faces_table(const std::vector<FaceRow>& rows, bool all);

}  // namespace frontalis
