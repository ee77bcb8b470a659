#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// What a model offers by name: expressions, action units, a demonstration and measured accuracy profiles.
struct ModelPresets
{
  /// Motion of a bone from its rest pose, in the face frame.
  struct BonePose
  {
    std::int32_t bone = -1;          ///< index into bones
    std::array<double, 3> shift{};   ///< [m], after the turn
    std::array<double, 3> turn{};    ///< rotation vector about the centre [rad]
    std::array<double, 3> centre{};  ///< [m]
  };
  /// Pose of the face by name. Activations by muscle index, -1..1, are added to the muscle's tone.
  struct Expression
  {
    std::string name;
    std::vector<std::pair<std::int32_t, float>> activation;
    std::vector<BonePose> bones{};
  };
  std::vector<Expression> expressions, action_units;
  struct DemoPhase
  {
    std::int32_t expression = -1;   ///< index into expressions; -1: relax; -2: that of the phase before
    double ramp = 0.3;              ///< [s] simulated
    double seconds = 1;             ///< [s] simulated
    std::vector<BonePose> bones{};  ///< other bones stay where they are
  };
  std::vector<DemoPhase> demo;

  // accuracy profiles of the scene, as they were measured (doc/accuracy.md)
  struct AccuracyProfile
  {
    std::string name;
    double error = 0;     ///< RMS error of the skin [m]; 0: not measured
    double cost = 0;      ///< wall seconds per simulated second; 0: not measured
    std::string machine;  ///< on which it was measured
  };
  std::vector<AccuracyProfile> profiles;
  std::string profile;  ///< name of the profile that the model was baked with
};

}  // namespace frontalis
