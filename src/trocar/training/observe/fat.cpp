#include <algorithm>
#include <cmath>
#include <numeric>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/training/observe/fat.hpp>

namespace trocar::training {
namespace {

constexpr double kStride = 0.001;  // [m] between places of a strand that are looked at
constexpr double kOnIt = 0.9;      // spacings from a strand's surface: a lobule whose middle is so near lies on it
constexpr double kWasIn = 1.2;     // the same in the drawn shape: so wide that gaps between lobules count as fat
constexpr int kInFat = 3;          // sectors with fat in the drawn shape from which on a place counts
constexpr int kRows = 8;           // of sights: 64 in a triangle

using Sectors = std::uint32_t;  // bits

int how_many(Sectors sectors) {
  int n = 0;
  for (; sectors != 0; sectors &= sectors - 1) ++n;
  return n;
}

/// A place of a strand, and which way its sectors are counted.
struct Spot {
  Vec3d at;
  interactions::StrandFrame frame;
  double radius = 0;  ///< [m]
};

/// The sector that `p` lies in, if it is so near; else none.
Sectors sector_of(const Spot& spot, Vec3d p, double reach) {
  const Vec3d off = p - spot.at;
  const double across = spot.radius + reach;
  if (dot(off, off) > across * across + reach * reach) return 0;
  const double y = dot(off, spot.frame.normal), z = dot(off, spot.frame.binormal), along = dot(off, spot.frame.tangent);
  if (std::fabs(along) > reach || y * y + z * z > across * across) return 0;
  const double turn = portable::atan2(z, y) / (2 * portable::pi) + 1;
  return Sectors(1) << (int(turn * kSectors) % kSectors);
}

/// How many there are a stride apart along a strand.
std::size_t spots_along(const interactions::StrandBody& strand) { return std::size_t(strand.length() / kStride) + 1; }

Spot spot_as_drawn(const interactions::StrandBody& strand, std::size_t i) {
  const tissue::StrandModel& m = strand.model;
  const interactions::StrandPlace place = interactions::place_at(strand, double(i) * kStride);
  const std::size_t e = std::size_t(place.element);
  const Vec3d edge = m.rest[e + 1] - m.rest[e], along = normalised(edge, Vec3d{1, 0, 0}), normal = m.director_rest[e];
  return {m.rest[e] + place.w * edge, {along, normal, cross(along, normal)}, m.radius[e]};
}

Spot spot_now(const interactions::StrandBody& strand, const tissue::StrandState& state, std::size_t i) {
  const interactions::StrandPlace place = interactions::place_at(strand, double(i) * kStride);
  return {point_at(strand, state, place), frame_at(strand, state, place),
          strand.model.radius[std::size_t(place.element)]};
}

/// Which things hang together: disjoint sets.
class Together {
 public:
  explicit Together(std::size_t things) : m_parent(things) { std::iota(m_parent.begin(), m_parent.end(), 0); }
  std::size_t root(std::size_t i) {
    while (m_parent[i] != i) i = m_parent[i] = m_parent[m_parent[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { m_parent[root(a)] = root(b); }

 private:
  std::vector<std::size_t> m_parent;
};

/// A body of fat as it is now.
struct FatNow {
  const interactions::FatBody& body;
  const tissue::FatState& fat;
  const std::vector<interactions::Bond>& roots;
  const std::vector<interactions::BondState>& root_states;

  FatNow(const sim::Model& model, const sim::State& state, std::size_t i)
      : body(model.fat[i]),
        fat(state.fat[i]),
        roots(model.bonds[std::size_t(body.roots)].bonds),
        root_states(state.bonds[std::size_t(body.roots)]) {}
};

/// f(lobule, body) of all that a body of fat still holds on.
template <class F>
void for_holds(const FatNow& now, F&& f) {
  for (std::size_t i = 0; i < now.roots.size(); ++i)
    if (now.root_states[i].holds()) f(std::size_t(now.roots[i].node()), now.roots[i].far.body);
}

Together joined_by_septa(const FatNow& now) {
  Together lobules(now.fat.lobules.size());
  for (int i = 0; i < now.body.fat.septa(); ++i)
    if (holding(now.body.fat, now.fat, i) > 0)
      lobules.join(std::size_t(septum_end(now.body.fat, i, 0)), std::size_t(septum_end(now.body.fat, i, 1)));
  return lobules;
}

void add_bridged(const FatNow& now, BodyId from, std::vector<BodyId>& out) {
  Together lobules = joined_by_septa(now);
  std::vector<std::uint8_t> reached(now.fat.lobules.size(), 0);
  for_holds(now, [&](std::size_t lobule, BodyId on) {
    if (on == from) reached[lobules.root(lobule)] = 1;
  });
  for_holds(now, [&](std::size_t lobule, BodyId on) {
    if (on != from && reached[lobules.root(lobule)] && std::find(out.begin(), out.end(), on) == out.end())
      out.push_back(on);
  });
}

}  // namespace

BaredStretch::BaredStretch(const sim::Model& model, int strand) : m_model(&model), m_strand(strand) {
  const interactions::StrandBody& body = model.strand_bodies[std::size_t(strand)];
  for (std::size_t i = 0; i < spots_along(body); ++i) {
    const Spot spot = spot_as_drawn(body, i);
    Sectors covered = 0;
    for (const interactions::FatBody& fat : model.fat)
      for (const Vec3d p : fat.fat.network.rest) covered |= sector_of(spot, p, kWasIn * fat.fat.spacing);
    m_lay_in_fat.push_back(how_many(covered) >= kInFat);
  }
}

double BaredStretch::longest(const sim::State& state) const {
  const interactions::StrandBody& body = m_model->strand_bodies[std::size_t(m_strand)];
  int most = 0, run = 0;
  for (std::size_t i = 0; i < m_lay_in_fat.size(); ++i) {
    Sectors covered = 0;
    const Spot spot = spot_now(body, state.strands[std::size_t(m_strand)], i);
    if (m_lay_in_fat[i])
      for (std::size_t k = 0; k < m_model->fat.size(); ++k) {
        const tissue::FatModel& fat = m_model->fat[k].fat;
        for (int n = 0; n < fat.lobules(); ++n)
          if (!state.fat[k].lobules[std::size_t(n)].gone())
            covered |= sector_of(spot, position(fat, state.fat[k], n), kOnIt * fat.spacing);
      }
    run = m_lay_in_fat[i] && how_many(covered) <= kSectors - kBareSectors ? run + 1 : 0;
    most = std::max(most, run);
  }
  return std::max(0, most - 1) * kStride;
}

double open_share(const sim::Model& model, const sim::State& state, const std::array<Vec3d, 3>& corners, double reach) {
  const Vec3d along = corners[1] - corners[0], up = corners[2] - corners[0];
  const Vec3d normal = normalised(cross(along, up), Vec3d{0, 0, 1});
  int open = 0;
  for (int i = 0; i < kRows; ++i)
    for (int j = 0; j < kRows; ++j) {
      double u = (i + 0.5) / kRows, v = (j + 0.5) / kRows;
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3d p = corners[0] + u * along + v * up;
      open += !interactions::Fat::hides(model.fat, state.fat, p - reach * normal, p + reach * normal);
    }
  return double(open) / (kRows * kRows);
}

std::vector<BodyId> bridged_from(const sim::Model& model, const sim::State& state, BodyId body) {
  std::vector<BodyId> out;
  for (std::size_t i = 0; i < model.fat.size(); ++i) add_bridged({model, state, i}, body, out);
  return out;
}

NearStrand nearest_strand(const sim::Model& model, const sim::State& state, Vec3d place, std::span<const BodyId> but) {
  NearStrand best;
  for (std::size_t i = 0; i < model.strand_bodies.size(); ++i) {
    if (std::find(but.begin(), but.end(), BodyId::strand(i)) != but.end()) continue;
    const std::vector<Vec3d>& x = state.strands[i].x;
    for (std::size_t e = 0; e + 1 < x.size(); ++e) {
      const Vec3d edge = x[e + 1] - x[e];
      const Vec3d off = place - (x[e] + geometry::closest_on_segment(place, x[e], x[e + 1]) * edge);
      const double apart = length(off) - model.strand_bodies[i].model.radius[e];
      if (apart < best.apart)
        best = {BodyId::strand(i), apart, normalised(off, Vec3d{0, 0, 1}), normalised(edge, Vec3d{1, 0, 0})};
    }
  }
  return best;
}

double fat_left(const sim::Model& model, const sim::State& state, BodyId fat) {
  const FatNow now(model, state, fat.index());
  Together lobules = joined_by_septa(now);
  std::vector<std::uint8_t> hangs(now.fat.lobules.size(), 0);
  for_holds(now, [&](std::size_t lobule, BodyId) { hangs[lobules.root(lobule)] = 1; });
  int left = 0;
  for (std::size_t n = 0; n < hangs.size(); ++n) left += !now.fat.lobules[n].gone() && hangs[lobules.root(n)];
  return double(left) / double(now.body.fat.lobules());
}

}  // namespace trocar::training
