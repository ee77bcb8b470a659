#pragma once

#include "cuda/backend/device_memory.hpp"
#include "frontalis/model/sample_field.hpp"

#include <vector>

namespace frontalis
{
namespace cuda
{

/// Owns the arrays of distance fields in device memory.
class DeviceFields
{
public:
  /// Copies a field. Returns its view for device code.
  physics::DistanceField add(const SampledField& field)
  {
    tables_.emplace_back(field.table);
    samples_.emplace_back(field.samples);
    physics::DistanceField on_device = view(field);
    on_device.table = tables_.back().data();
    on_device.samples = samples_.back().data();
    return on_device;
  }
  void list_arrays(Effect effect, ArrayList& list) const
  {
    for (std::size_t s = 0; s < tables_.size(); ++s)
      list.add(effect, "fields of surfaces", tables_[s].bytes() + samples_[s].bytes());
  }

private:
  std::vector<DeviceArray<std::int32_t>> tables_;
  std::vector<DeviceArray<float>> samples_;
};

}  // namespace cuda
}  // namespace frontalis
