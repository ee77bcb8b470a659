#include "cuda/partition/voxel_strips.hpp"

#include "frontalis/solver/backend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace frontalis
{
namespace
{

constexpr int lanes = 32;
// Additional cost of a plane with fibres, in units of a plane without fibres. The most expensive strips start first.
constexpr double fibres_cost = 0.7;

using Cell = std::array<std::int32_t, 3>;

// Index of the first entry of each row (j,k) in a list that is sorted by k, j, i.
class RowIndex
{
public:
  RowIndex(const std::vector<Cell>& cells, std::int32_t width_y, std::int32_t width_z)
      : cells_(cells), width_y_(width_y), width_z_(width_z), begin_(static_cast<std::size_t>(width_y) * width_z + 1, 0)
  {
    for (const auto& c : cells)
      ++begin_[static_cast<std::size_t>(c[2]) * width_y + c[1] + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  }

  /// Calls call(lane, index) for the cells of row (j,k) with i in [first, first + count).
  template <class Call>
  void each(std::int32_t j, std::int32_t k, std::int32_t first, std::int32_t count, const Call& call) const
  {
    if (j < 0 || k < 0 || j >= width_y_ || k >= width_z_)
      return;
    const std::size_t row = static_cast<std::size_t>(k) * width_y_ + j;
    auto cell = begin_[row];
    const auto end = begin_[row + 1];
    if (cell < end && cells_[cell][0] < first)
      cell = static_cast<std::uint32_t>(std::lower_bound(cells_.begin() + cell, cells_.begin() + end, first,
                                                         [](const Cell& c, std::int32_t i) { return c[0] < i; }) -
                                        cells_.begin());
    for (; cell < end && cells_[cell][0] < first + count; ++cell)
      call(cells_[cell][0] - first, cell);
  }

private:
  const std::vector<Cell>& cells_;
  std::int32_t width_y_, width_z_;
  std::vector<std::uint32_t> begin_;
};

// Consecutive columns along x of one tile (rows j .. j + rows, planes k .. k + planes); at most 32 columns.
struct Piece
{
  std::int32_t i, lanes;              // columns, including the halo
  std::int32_t own_first, own_count;  // own columns, relative to i
  std::int32_t j;                     // first own row
  std::int32_t k, planes;             // first plane and number of planes, including the halo
  std::int32_t own_k, own_planes;     // own planes: first plane and number of planes
  double cost;                        // in units of a plane without fibres
};

struct Builder
{
  const Model& model;
  const StripSettings& settings;
  RowIndex nodes, voxels;
  std::vector<Piece> pieces;

  Builder(const Model& m, const StripSettings& s)
      : model(m), settings(s), nodes(m.nodes, m.size[1] + 1, m.size[2] + 1), voxels(m.voxels, m.size[1], m.size[2])
  {
  }

  template <class Is>
  bool any_voxel(const Piece& p, std::int32_t k, const Is& is) const
  {
    bool any = false;
    for (int r = -1; r < settings.rows && !any; ++r)
      voxels.each(p.j + r, k, p.i, p.lanes - 1, [&](std::int32_t, std::uint32_t e) { any = any || is(e); });
    return any;
  }

  void add_piece(Piece p)
  {
    std::int32_t lowest = p.own_k + p.own_planes, highest = p.own_k - 1;
    for (std::int32_t k = p.own_k; k < p.own_k + p.own_planes; ++k)
      for (int r = 0; r < settings.rows; ++r)
        nodes.each(p.j + r, k, p.i + p.own_first, p.own_count,
                   [&](std::int32_t, std::uint32_t)
                   {
                     lowest = std::min(lowest, k);
                     highest = std::max(highest, k);
                   });
    // The piece has one more plane if tissue continues beyond the tile.
    const auto is_there = [](std::uint32_t) { return true; };
    p.k = lowest == p.own_k && any_voxel(p, lowest - 1, is_there) ? lowest - 1 : lowest;
    const bool above = highest == p.own_k + p.own_planes - 1 && any_voxel(p, highest, is_there);
    p.planes = highest - p.k + (above ? 2 : 1);
    p.cost = p.planes;
    for (std::int32_t k = p.k; !model.fibre_muscle.empty() && k < p.k + p.planes - 1; ++k)
      if (any_voxel(p, k, [&](std::uint32_t e) { return model.fibre_begin[e] < model.fibre_begin[e + 1]; }))
        p.cost += fibres_cost;
    pieces.push_back(p);
  }

  // Cuts a run of columns into pieces that fit into a warp, with one more column on each side where tissue continues.
  void add_run(std::int32_t first, std::int32_t last, Piece tile)
  {
    for (std::int32_t begin = first; begin <= last;)
    {
      const std::int32_t left = begin > first ? 1 : 0;
      const std::int32_t rest = last - begin + 1;
      const std::int32_t own = rest + left <= lanes ? rest : lanes - 1 - left;
      Piece p = tile;
      p.i = begin - left;
      p.own_first = left;
      p.own_count = own;
      p.lanes = left + own + (own < rest ? 1 : 0);
      add_piece(p);
      begin += own;
    }
  }

  void add_tile(const Piece& tile, std::vector<char>& occupied)
  {
    std::int32_t lowest = model.size[0] + 1, highest = -1;
    for (std::int32_t k = tile.own_k; k < tile.own_k + tile.own_planes; ++k)
      for (int r = 0; r < settings.rows; ++r)
        nodes.each(tile.j + r, k, 0, model.size[0] + 1,
                   [&](std::int32_t i, std::uint32_t)
                   {
                     occupied[i] = 1;
                     lowest = std::min(lowest, i);
                     highest = std::max(highest, i);
                   });
    for (std::int32_t i = lowest; i <= highest; ++i)
      if (occupied[i])
      {
        std::int32_t last = i;
        while (last < highest && occupied[last + 1])
          ++last;
        add_run(i, last, tile);
        i = last;
      }
    if (lowest <= highest)
      std::fill(occupied.begin() + lowest, occupied.begin() + highest + 1, 0);
  }

  void cut()
  {
    std::vector<char> occupied(model.size[0] + 2, 0);
    Piece tile{};
    for (tile.own_k = 0; tile.own_k <= model.size[2]; tile.own_k += settings.planes)
    {
      tile.own_planes = std::min(settings.planes, model.size[2] + 1 - tile.own_k);
      for (tile.j = 0; tile.j <= model.size[1]; tile.j += settings.rows)
        add_tile(tile, occupied);
    }
    std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.cost > b.cost; });
  }
};

// Packs pieces of about equal length into warps, in order.
std::vector<std::vector<Piece>> pack(const std::vector<Piece>& pieces)
{
  // Many warps stay open, so that a large piece does not close a warp that small pieces could fill.
  constexpr std::size_t open_warps = 128;
  std::vector<std::vector<Piece>> warps;
  std::vector<std::int32_t> used;
  std::size_t first_open = 0;
  for (const Piece& p : pieces)
  {
    std::size_t found = warps.size();
    for (std::size_t w = std::max(first_open, warps.size() - std::min(warps.size(), open_warps)); w < warps.size(); ++w)
      if (used[w] + p.lanes <= lanes && p.planes <= warps[w][0].planes && warps[w][0].planes * 3 <= p.planes * 4)
      {
        found = w;
        break;
      }
    if (found == warps.size())
    {
      warps.emplace_back();
      used.push_back(0);
    }
    warps[found].push_back(p);
    used[found] += p.lanes;
  }
  return warps;
}

}  // namespace

std::uint32_t fibre_word(const Model& model, std::uint32_t voxel)
{
  const auto first = static_cast<std::uint32_t>(model.fibre_begin[voxel]);
  const std::uint32_t count = static_cast<std::uint32_t>(model.fibre_begin[voxel + std::size_t{ 1 }]) - first;
  if (count > 15)
    throw BackendUnavailable(fmt::format("backend cuda: voxel {} has {} muscles; allowed are 15", voxel, count));
  return count > 0 ? first * 16 + count : 0;
}

VoxelStrips::VoxelStrips(const Model& model, const StripSettings& settings) : rows(settings.rows)
{
  Builder builder(model, settings);
  builder.cut();
  const auto warps = pack(builder.pieces);
  builder.pieces = {};

  // Own nodes are numbered in the order in which a warp processes them.
  device_node.assign(model.nodes.size(), 0);
  std::uint32_t next = 1;
  std::size_t slot_count = 0;
  for (std::size_t w = 0; w < warps.size(); ++w)
  {
    slot_count += static_cast<std::size_t>(warps[w][0].planes) * (rows + 2) * lanes;
    for (std::int32_t plane = 0; plane < warps[w][0].planes; ++plane)
      for (int r = 0; r < rows; ++r)
        for (const Piece& p : warps[w])
          if (p.k + plane >= p.own_k && p.k + plane < p.own_k + p.own_planes)
            builder.nodes.each(p.j + r, p.k + plane, p.i + p.own_first, p.own_count,
                               [&](std::int32_t, std::uint32_t n) { device_node[n] = next++; });
  }
  if (next != model.nodes.size() + 1 || slot_count >= 0xffffffffu)
    throw BackendUnavailable(fmt::format("backend cuda: the strips hold {} of {} nodes", next - 1, model.nodes.size()));

  slots.assign(slot_count, StripSlot{ 0, 0 });
  std::size_t slot = 0;
  for (const auto& warp : warps)
  {
    const std::int32_t planes = warp[0].planes;
    strips.push_back({ static_cast<std::uint32_t>(slot), static_cast<std::uint32_t>(planes), Strip::none });
    bool fibres = false;
    for (std::int32_t plane = 0; plane < planes; ++plane)
      for (int r = -1; r <= rows; ++r, slot += lanes)
      {
        std::int32_t lane = 0;
        for (const Piece& p : warp)
        {
          StripSlot* const place = &slots[slot + lane];
          lane += p.lanes;
          const std::int32_t k = p.k + plane;
          if (plane >= p.planes)
            continue;
          const bool own_row = r >= 0 && r < rows && k >= p.own_k && k < p.own_k + p.own_planes;
          builder.nodes.each(p.j + r, k, p.i, p.lanes,
                             [&](std::int32_t i, std::uint32_t n)
                             {
                               const bool own = own_row && i >= p.own_first && i < p.own_first + p.own_count;
                               place[i].node = device_node[n] | (own ? StripSlot::owned | StripSlot::updated : 0);
                             });
          if (r == rows || plane == p.planes - 1)
            continue;
          builder.voxels.each(p.j + r, k, p.i, p.lanes - 1,
                              [&](std::int32_t i, std::uint32_t e)
                              {
                                place[i].voxel = e + 1;
                                fibres = fibres || model.fibre_begin[e] < model.fibre_begin[e + 1];
                              });
        }
      }
    if (!fibres)
      continue;
    strips.back().fibre_begin = static_cast<std::uint32_t>(fibre_words.size());
    for (std::int32_t plane = 0; plane < planes; ++plane)
      for (int r = 0; r <= rows; ++r)
        for (int lane = 0; lane < lanes; ++lane)
        {
          const auto& place = slots[strips.back().slot_begin + (plane * (rows + 2) + r) * lanes + lane];
          fibre_words.push_back(place.voxel > 0 ? fibre_word(model, place.voxel - 1) : 0);
        }
  }
}

namespace
{

// Fraction of entries for which has(entry) is true, among the rows of lanes with at least one such entry; 0 if there is
// no such row.
template <class Entry, class Has>
double filled_rows(const std::vector<Entry>& entries, const Has& has)
{
  std::size_t rows = 0, all = 0;
  for (std::size_t row = 0; row < entries.size(); row += lanes)
  {
    const auto begin = entries.begin() + static_cast<std::ptrdiff_t>(row);
    const auto here = static_cast<std::size_t>(std::count_if(begin, begin + lanes, has));
    rows += here > 0;
    all += here;
  }
  return rows > 0 ? static_cast<double>(all) / static_cast<double>(rows * lanes) : 0;
}

}  // namespace

double VoxelStrips::filled() const
{
  return filled_rows(slots, [](const StripSlot& slot) { return slot.voxel > 0; });
}

double VoxelStrips::filled_by_fibres() const
{
  return filled_rows(fibre_words, [](std::uint32_t word) { return word > 0; });
}

}  // namespace frontalis
