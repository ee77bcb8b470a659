#include "frontalis/study/faces.hpp"

#include "frontalis/physics/number.hpp"
#include "frontalis/runner/face_frame.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/solver/guard.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

constexpr double frame_seconds = 0.01;
constexpr double settled_share = 0.03;  // fraction of the final displacement within which a landmark has settled
constexpr double least_way = 0.5e-3;    // a settling time is found only for landmarks that move farther [m]
constexpr double still_way = 1e-3;      // allowed motion of landmarks that do not move in people [m]
constexpr double largest_angle = 25 * physics::pi / 180;

using Places = std::vector<std::array<float, 3>>;

// Displacement of a landmark between two frames: forward, outward from the midline on the side in its name, up [m].
std::array<double, 3> moved(const Places& rest, const Places& now, std::size_t landmark, const std::string& name)
{
  std::array<double, 3> way{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    way[axis] = double(now[landmark][axis]) - double(rest[landmark][axis]);
  const std::string right = "_right";
  if (name.size() > right.size() && name.compare(name.size() - right.size(), right.size(), right) == 0)
    way[1] = -way[1];
  return way;
}

double norm(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Time after which a landmark stays close to its last position [s]; NaN if it hardly moves.
double settling_time(const std::vector<Places>& frames, std::size_t landmark)
{
  const double way = norm(moved(frames.front(), frames.back(), landmark, {}));
  if (way < least_way)
    return NAN;
  std::size_t frame = frames.size() - 1;
  while (frame > 0 && norm(moved(frames[frame - 1], frames.back(), landmark, {})) <= settled_share * way)
    --frame;
  return static_cast<double>(frame) * frame_seconds;
}

// The landmarks that have this name, or this name with a side.
std::vector<std::size_t> landmarks_called(const Model& model, const std::string& name)
{
  std::vector<std::size_t> found;
  for (std::size_t l = 0; l < model.landmarks.size(); ++l)
    if (const std::string& known = model.landmarks[l];
        known == name || known == name + "_left" || known == name + "_right")
      found.push_back(l);
  return found;
}

FaceRow row_of(const Model& model, const std::string& expression, const std::vector<Places>& frames,
               std::size_t landmark)
{
  FaceRow row;
  row.expression = expression;
  row.landmark = model.landmarks[landmark];
  row.moved = moved(frames.front(), frames.back(), landmark, row.landmark);
  row.size = norm(row.moved);
  row.angle = NAN;
  row.settled = settling_time(frames, landmark);
  row.least = row.most = NAN;
  return row;
}

void compare(FaceRow& row, const PublishedMotion& people, double settles, bool draft)
{
  const double along = dot(row.moved, people.along);
  row.people = &people;
  row.settles = settles;
  if (people.component)
    row.size = along;
  else
    row.angle = std::acos(std::clamp(along / row.size, -1.0, 1.0));
  const bool has_deviation = people.deviation > 0;
  row.least = draft ? 0.6 * people.mean : has_deviation ? people.mean - people.deviation : 0.75 * people.mean;
  row.most = draft ? 1.4 * people.mean : has_deviation ? people.mean + people.deviation : 1.25 * people.mean;
}

std::vector<Places> play(const std::shared_ptr<const Model>& model, const std::string& expression,
                         const FaceSettings& settings)
{
  const Controls rest = rest_controls(*model), full = expression_controls(*model, expression);
  const ControlCurve curve{ { 0, settings.ramp }, { rest, full } };
  const std::unique_ptr<Solver> solver = make_solver(model, settings.solver);
  Guard guard(*solver, model);
  std::vector<Places> frames;
  SkinState skin;
  const int count = static_cast<int>(std::lround(settings.seconds / frame_seconds));
  frames.reserve(static_cast<std::size_t>(count) + 1);
  const auto go_on = [&]
  {
    if (settings.watch)
      settings.watch((static_cast<double>(frames.size()) - 1) / count);
    return true;
  };
  for (int frame = 0; frame <= count; ++frame)
  {
    if (frame > 0)
      guard.advance_checked(frame_seconds / model->time_scaling, curve.at(frame * frame_seconds), go_on);
    solver->skin(skin);
    to_face_frame(*model, skin);
    frames.push_back(skin.landmarks);
    go_on();
    if (frame == 0 && settings.settled)
      settings.settled({}, skin, rest);
  }
  if (settings.settled)
    settings.settled(expression, skin, solver->controls());
  return frames;
}

}  // namespace

bool FaceRow::passed() const
{
  const bool in_time = settles == 0 || std::isnan(settled) || settled <= settles;
  const bool in_range = std::isnan(most) || (size >= least && size <= most);  // a size that is NaN is not
  return in_time && in_range && !(angle > largest_angle);
}

std::vector<FaceRow> measure_expression(const std::shared_ptr<const Model>& model, const std::string& expression,
                                        const PublishedExpression& people, const FaceSettings& settings)
{
  const std::vector<Places> frames = play(model, expression, settings);
  std::vector<FaceRow> rows;
  std::vector<bool> told(model->landmarks.size(), false);
  for (const PublishedMotion& motion : people.motions)
    for (const std::size_t landmark : landmarks_called(*model, motion.landmark))
    {
      compare(rows.emplace_back(row_of(*model, expression, frames, landmark)), motion, people.settles,
              model->profile == "draft");
      told[landmark] = true;
    }
  for (const std::string& name : people.still)
    for (const std::size_t landmark : landmarks_called(*model, name))
    {
      FaceRow& row = rows.emplace_back(row_of(*model, expression, frames, landmark));
      row.least = 0;
      row.most = still_way;
      told[landmark] = true;
    }
  for (std::size_t landmark = 0; landmark < told.size(); ++landmark)
    if (!told[landmark])
      rows.push_back(row_of(*model, expression, frames, landmark));
  return rows;
}

Table faces_table(const std::vector<FaceRow>& rows, bool all)
{
  constexpr double millimetres = 1e3, degrees = 180 / physics::pi;
  Table table({ "expression", "landmark", "forward [mm]", "outward [mm]", "up [mm]", "size [mm]", "people [mm]",
                "sd [mm]", "angle [deg]", "settled [s]", "verdict", "mark", "source" });
  const auto hundredths = [](double value) { return std::round(100 * value) / 100; };
  for (const FaceRow& row : rows)
  {
    const bool compared = !std::isnan(row.most);
    if (!compared && !all)
      continue;
    const auto mm = [&](double value) { return hundredths(millimetres * value); };
    const bool published = row.people != nullptr;
    table.add({ row.expression, row.landmark, mm(row.moved[0]), mm(row.moved[1]), mm(row.moved[2]), mm(row.size),
                published  ? mm(row.people->mean)
                : compared ? 0
                           : NAN,
                published && row.people->deviation > 0 ? mm(row.people->deviation) : NAN,
                std::round(degrees * row.angle), hundredths(row.settled),
                std::string(!compared      ? ""
                            : row.passed() ? "pass"
                                           : "FAIL"),
                published ? row.people->mark : std::string(), published ? row.people->source : std::string() });
  }
  return table;
}

}  // namespace frontalis
