#include "model/limit_slope.hpp"

#include "frontalis/physics/distance_field.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace frontalis
{
namespace
{

using physics::DistanceField;

// The samples of a field by their places on the lattice. Bricks share those on their faces.
class Lattice
{
public:
  explicit Lattice(SampledField& field) : field_(field)
  {
    for (int axis = 0; axis < 3; ++axis)
      row_[axis] = std::int64_t{ DistanceField::brick_edge } * field.bricks[axis] + 2;
    offset_ = { { 1, row_[0], row_[0] * row_[1] } };
    each_sample(
        [&](std::size_t sample, std::int64_t place)
        {
          const auto [known, is_new] = at_.try_emplace(place, static_cast<std::int32_t>(values_.size()));
          if (is_new)
          {
            values_.push_back(field.samples[sample]);
            places_.push_back(place);
          }
        });
  }

  // Two neighbours that differ by more than the spacing move towards each other by half of what is too much, and their
  // own neighbours are looked at next.
  void limit()
  {
    constexpr double tolerance = 1.01;  // of the spacing, so that this ends
    const double step = field_.spacing;
    std::vector<std::int32_t> now(values_.size()), next;
    for (std::size_t n = 0; n < now.size(); ++n)
      now[n] = static_cast<std::int32_t>(n);
    std::vector<bool> listed(values_.size(), false);
    const auto revisit = [&](std::int32_t sample)
    {
      if (listed[sample])
        return;
      listed[sample] = true;
      next.push_back(sample);
    };
    while (!now.empty())
    {
      for (const auto a : now)
        for (const std::int64_t way : { offset_[0], offset_[1], offset_[2], -offset_[0], -offset_[1], -offset_[2] })
        {
          const auto found = at_.find(places_[a] + way);
          if (found == at_.end())
            continue;
          const auto b = found->second;
          const double difference = double(values_[a]) - double(values_[b]);
          if (std::abs(difference) <= tolerance * step)
            continue;
          const auto move = static_cast<float>(0.5 * (difference - std::copysign(step, difference)));
          values_[a] -= move;
          values_[b] += move;
          revisit(a);
          revisit(b);
        }
      now.swap(next);
      next.clear();
      for (const auto sample : now)
        listed[sample] = false;
    }
    each_sample([&](std::size_t sample, std::int64_t place) { field_.samples[sample] = values_[at_.at(place)]; });
  }

private:
  // visit(index in the field, place on the lattice)
  template <class Visit>
  void each_sample(const Visit& visit) const
  {
    constexpr std::int32_t width = DistanceField::brick_row;
    for (std::size_t brick = 0; brick < field_.table.size(); ++brick)
      if (field_.table[brick] >= 0)
      {
        const auto x = static_cast<std::int64_t>(brick % field_.bricks[0]),
                   row = static_cast<std::int64_t>(brick / field_.bricks[0]);
        const std::int64_t first =
            DistanceField::brick_edge * (x + row % field_.bricks[1] * offset_[1] + row / field_.bricks[1] * offset_[2]);
        for (std::int32_t s = 0; s < DistanceField::brick_size; ++s)
          visit(static_cast<std::size_t>(field_.table[brick]) * DistanceField::brick_size + s,
                first + s % width + s / width % width * offset_[1] + s / (width * width) * offset_[2]);
      }
  }

  SampledField& field_;
  std::array<std::int64_t, 3> row_{}, offset_{};  // of the lattice: samples in a row, and way to the next along an axis
  std::unordered_map<std::int64_t, std::int32_t> at_;
  std::vector<std::int64_t> places_;
  std::vector<float> values_;
};

}  // namespace

void limit_slope(SampledField& field) { Lattice(field).limit(); }

}  // namespace frontalis
