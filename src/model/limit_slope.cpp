#include "model/limit_slope.hpp"

#include "frontalis/physics/distance_field.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace frontalis
{
namespace
{

using physics::DistanceField;

// A point of the lattice of samples. Neighbouring bricks share the two layers of points at their common face.
using Place = std::array<std::int32_t, 3>;

class Lattice
{
public:
  explicit Lattice(SampledField& field) : field_(field)
  {
    for (std::int32_t b = 0; b < static_cast<std::int32_t>(field.table.size()); ++b)
      if (field.table[b] >= 0)
        stored_.push_back(
            { { b % field.bricks[0], b / field.bricks[0] % field.bricks[1], b / field.bricks[0] / field.bricks[1] } });
  }

  // Moves two neighbouring samples that differ by more than the spacing towards each other, each by half of the excess.
  // Then the neighbours of both are checked.
  void limit()
  {
    std::vector<Place> now = steep_places(), next;
    std::vector<bool> listed(field_.samples.size(), false);
    std::vector<std::size_t> marks;  // indices into `listed`
    const auto revisit = [&](const Place& place, const Samples& samples)
    {
      const auto mark = static_cast<std::size_t>(samples.at[0] - field_.samples.data());
      if (listed[mark])
        return;
      listed[mark] = true;
      marks.push_back(mark);
      next.push_back(place);
    };
    while (!now.empty())
    {
      for (const Place& a : now)
      {
        const Samples of_a = samples_at(a);
        for (const std::int32_t side : { 1, -1 })
          for (std::size_t axis = 0; axis < 3; ++axis)
          {
            const float* const neighbour = neighbour_of(of_a, axis, side);
            if (neighbour == nullptr)
              continue;
            const double difference = double(*of_a.at[0]) - double(*neighbour);
            if (!steep(difference))
              continue;
            Place b = a;
            b[axis] += side;
            const Samples of_b = samples_at(b);
            const auto move = static_cast<float>(0.5 * (difference - std::copysign(field_.spacing, difference)));
            for (std::size_t n = 0; n < of_a.count; ++n)
              *of_a.at[n] -= move;
            for (std::size_t n = 0; n < of_b.count; ++n)
              *of_b.at[n] += move;
            revisit(a, of_a);
            revisit(b, of_b);
          }
      }
      now.swap(next);
      next.clear();
      for (const std::size_t mark : marks)
        listed[mark] = false;
      marks.clear();
    }
  }

private:
  static constexpr std::int32_t edge = DistanceField::brick_edge, width = DistanceField::brick_row;

  // The tolerance of 1 % makes the iteration end.
  bool steep(double difference) const { return std::abs(difference) > 1.01 * field_.spacing; }

  // The samples at a place, one for each stored brick that contains the place.
  struct Samples
  {
    std::array<float*, 8> at{};
    std::array<Place, 8> in_brick{};  // position of each sample in its brick, 0 to 9 along each axis
    std::size_t count = 0;
  };

  // The sample beside a place; null if none is stored. At least one brick contains both a place and its neighbour.
  static const float* neighbour_of(const Samples& samples, std::size_t axis, std::int32_t side)
  {
    constexpr std::array<std::int32_t, 3> step{ { 1, width, width * width } };
    for (std::size_t n = 0; n < samples.count; ++n)
      if (const std::int32_t at = samples.in_brick[n][axis] + side; at >= 0 && at < width)
        return samples.at[n] + std::ptrdiff_t{ side } * step[axis];
    return nullptr;
  }

  float* brick(const Place& b) const
  {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (b[axis] < 0 || b[axis] >= field_.bricks[axis])
        return nullptr;
    const std::int32_t stored = field_.table[(b[2] * field_.bricks[1] + b[1]) * field_.bricks[0] + b[0]];
    return stored < 0 ? nullptr : field_.samples.data() + std::int64_t{ stored } * DistanceField::brick_size;
  }

  Samples samples_at(const Place& place) const
  {
    Samples found;
    std::array<std::array<std::int32_t, 2>, 3> range{};
    // Brick b contains the places 8 b - 1 to 8 b + 8. The offsets keep dividends positive, so that quotients round
    // down.
    for (std::size_t axis = 0; axis < 3; ++axis)
      range[axis] = { { (place[axis] - 1 + 2 * edge) / edge - 2, (place[axis] + 1 + edge) / edge - 1 } };
    Place b{};
    for (b[2] = range[2][0]; b[2] <= range[2][1]; ++b[2])
      for (b[1] = range[1][0]; b[1] <= range[1][1]; ++b[1])
        for (b[0] = range[0][0]; b[0] <= range[0][1]; ++b[0])
        {
          const Place at{ { place[0] - edge * b[0] + 1, place[1] - edge * b[1] + 1, place[2] - edge * b[2] + 1 } };
          if (float* const samples = brick(b); samples != nullptr)
          {
            found.in_brick[found.count] = at;
            found.at[found.count++] = samples + (at[2] * width + at[1]) * width + at[0];
          }
        }
    return found;
  }

  // Places that differ from a neighbour by too much. A place may occur several times.
  std::vector<Place> steep_places() const
  {
    std::vector<Place> places;
    for (const Place& b : stored_)
    {
      const float* const samples = brick(b);
      for (std::int32_t s = 0; s < DistanceField::brick_size; ++s)
      {
        const Place at{ { s % width, s / width % width, s / (width * width) } };
        const std::array<std::int32_t, 3> step{ { 1, width, width * width } };
        for (std::size_t axis = 0; axis < 3; ++axis)
          if (at[axis] + 1 < width && steep(double(samples[s]) - double(samples[s + step[axis]])))
          {
            places.push_back({ { edge * b[0] + at[0] - 1, edge * b[1] + at[1] - 1, edge * b[2] + at[2] - 1 } });
            break;
          }
      }
    }
    return places;
  }

  SampledField& field_;
  std::vector<Place> stored_;  ///< bricks with samples
};

}  // namespace

void limit_slope(SampledField& field) { Lattice(field).limit(); }

}  // namespace frontalis
