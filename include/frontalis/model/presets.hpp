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
    std::array<double, 3> shift{};   ///< translation, applied after the rotation [m]
    std::array<double, 3> turn{};    ///< rotation vector about `centre` [rad]
    std::array<double, 3> centre{};  ///< [m]
  };
  /// A named pose of the face. `activation` has one number per muscle, -1..1, which is added to the muscle's tone.
  struct Expression
  {
    std::string name;
    std::vector<std::pair<std::int32_t, float>> activation;
    std::vector<BonePose> bones{};
  };
  std::vector<Expression> expressions, action_units;
  struct DemoPhase
  {
    std::int32_t expression = -1;   ///< index into expressions; -1: relax; -2: that of the previous phase
    double ramp = 0.3;              ///< [s] simulated
    double seconds = 1;             ///< [s] simulated
    std::vector<BonePose> bones{};  ///< other bones stay where they are
  };
  std::vector<DemoPhase> demo;

  // An accuracy profile of the scene, as it was measured (doc/accuracy.md).
  struct AccuracyProfile
  {
    std::string name;
    double error = 0;     ///< RMS error of the skin [m]; 0: not measured
    double cost = 0;      ///< wall seconds per second of simulated time; 0: not measured
    std::string machine;  ///< on which it was measured
  };
  std::vector<AccuracyProfile> profiles;
  std::string profile;  ///< name of the profile that the model was baked with
};

}  // namespace frontalis
