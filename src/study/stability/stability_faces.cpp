// Hard cases of whole faces: expressions and all muscles switched in one step, lips that press against an opening jaw,
// a blink in every frame.

#include "frontalis/error.hpp"
#include "frontalis/runner/face_frame.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "study/stability/stability_cases.hpp"

#include <algorithm>
#include <iterator>

namespace frontalis
{
namespace
{

// The guard checks every 128 steps, because the motion after a switch lasts only a few hundred steps.
constexpr int face_check_interval = 128;
constexpr int face_parts = 20;  // number of records in each phase

// The time KEY of the file [s], or KEY_in_full in long runs.
double time_of(const CaseRun& run, const std::string& key)
{
  const double brief = run.seconds(key), full = run.seconds(key + "_in_full");
  return run.settings.long_runs ? full : brief;
}

std::vector<std::string> chosen_expressions(const CaseRun& run, const Model& model)
{
  std::vector<std::string> few = run.words("expressions");
  if (!run.settings.long_runs)
    return few;
  std::vector<std::string> all;
  std::transform(model.expressions.begin(), model.expressions.end(), std::back_inserter(all),
                 [](const Model::Expression& expression) { return expression.name; });
  return all;
}

// Asks for the controls within one time step and watches the motion for some time. Each part asks for the same
// controls, because bones may be on their way to them.
void switch_to(GuardedTrial& motion, const Controls& target, double seconds)
{
  motion.advance({ motion.solver().time_step(), target });
  for (int part = 0; part < face_parts; ++part)
    motion.advance({ seconds / face_parts, target });
}

// Switches each expression on from rest, in one step, and off.
void face_switched(CaseRun& run, const std::string& scene)
{
  GuardedTrial motion(run, run.settings.scene(scene), true, { face_check_interval });
  const double on = time_of(run, "on"), off = time_of(run, "off");
  for (const std::string& name : chosen_expressions(run, motion.model()))
  {
    motion.start_over();
    switch_to(motion, expression_controls(motion.model(), name), on);
    switch_to(motion, rest_controls(motion.model()), off);
    motion.check_balance(name);
  }
}

// Switches every muscle on in one step, and off.
void face_at_full(CaseRun& run, const std::string& scene)
{
  GuardedTrial motion(run, run.settings.scene(scene), true, { face_check_interval });
  motion.hold_or_stop(
      [&]
      {
        switch_to(motion, motion.controls(1), time_of(run, "on"));
        switch_to(motion, motion.controls(0), time_of(run, "off"));
        motion.check_balance("every muscle on and off at once");
      });
  // The real face gets no plot, because its data are private.
  if (scene == "head")
    motion.plot("head_at_full", "Every muscle of the head switched on in one step, and off");
}

// Presses the lips, opens the jaw wide while they press, shuts it and lets go, each in one step.
void face_torn_lips(CaseRun& run, const std::string& scene)
{
  GuardedTrial motion(run, run.settings.scene(scene), true, { face_check_interval });
  const Controls rest = rest_controls(motion.model()), press = expression_controls(motion.model(), "lip_press");
  Controls torn = press;
  torn.bone = action_unit_controls(motion.model(), { { "AU27", 1 } }).bone;
  const auto tear = [&]
  {
    switch_to(motion, press, time_of(run, "press"));
    switch_to(motion, torn, time_of(run, "open"));
    switch_to(motion, press, time_of(run, "shut"));
    switch_to(motion, rest, time_of(run, "rest"));
    motion.check_balance("pressed, torn open, shut and let go");
  };
  // The lips of the real face may be stopped.
  if (scene == "real_face")
    motion.hold_or_stop(tear);
  else
    tear();
}

// How far the lids of an eye are apart [m], along the vertical axis.
double gap_of_lids(GuardedTrial& motion, const std::string& side)
{
  const Model& model = motion.model();
  SkinState skin;
  motion.solver().skin(skin);
  to_face_frame(model, skin);
  const auto height = [&](const std::string& landmark)
  {
    const auto found = std::find(model.landmarks.begin(), model.landmarks.end(), landmark + side);
    if (found == model.landmarks.end())
      throw Error("the model has no landmark " + landmark + side);
    return static_cast<double>(skin.landmarks[static_cast<std::size_t>(found - model.landmarks.begin())][2]);
  };
  return height("lid_upper") - height("lid_lower");
}

// Closes and opens the eyes in every frame.
void face_blinks(CaseRun& run, const std::string& scene)
{
  GuardedTrial motion(run, run.settings.scene(scene), true, { face_check_interval });
  const Controls rest = rest_controls(motion.model()), closed = expression_controls(motion.model(), "blink");
  const double half = 0.5 * run.seconds("frame");
  const int blinks = static_cast<int>(run.count("blinks"));
  double widest = 0;
  for (int i = 0; i < blinks; ++i)
  {
    motion.advance({ half, closed, 4 });
    for (const char* side : { "_left", "_right" })
      widest = std::max(widest, gap_of_lids(motion, side));
    motion.advance({ half, rest, 4 });
    run.settings.watch((i + 1.0) / blinks);
  }
  run.check("gap of closed lids", "mm", 0, 1e3 * widest, "gap");
  motion.check_balance("all blinks");
}

}  // namespace

CaseFunctions hard_faces()
{
  return { { "head_switched", [](CaseRun& run) { face_switched(run, "head"); } },
           { "head_at_full", [](CaseRun& run) { face_at_full(run, "head"); } },
           { "head_torn_lips", [](CaseRun& run) { face_torn_lips(run, "head"); } },
           { "head_blinks", [](CaseRun& run) { face_blinks(run, "head"); } },
           { "real_face_switched", [](CaseRun& run) { face_switched(run, "real_face"); } },
           { "real_face_at_full", [](CaseRun& run) { face_at_full(run, "real_face"); } },
           { "real_face_torn_lips", [](CaseRun& run) { face_torn_lips(run, "real_face"); } },
           { "real_face_blinks", [](CaseRun& run) { face_blinks(run, "real_face"); } } };
}

}  // namespace frontalis
