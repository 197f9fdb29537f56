#include <algorithm>
#include <cmath>
#include <numeric>

#include <trocar/numerics/portable.hpp>
#include <trocar/training/observe/fat.hpp>

namespace trocar::training {
namespace {

using interactions::BorderHold;
using interactions::Fat;
using interactions::FatBody;
using interactions::FatBodyState;

constexpr double kStride = 0.001;  // [m] between places of a strand that are looked at
constexpr double kOnIt = 0.6;     // spacings from a strand's surface: a lobule whose middle is so near lies on it
constexpr int kRows = 8;          // of sights: 64 in a triangle

/// f(body, state) of all fat.
template <class F>
void for_fat(const sim::Model& model, const sim::State& state, F&& f) {
  const auto& bodies = interactions::part_of<Fat>(model.objects).list;
  for (std::size_t i = 0; i < bodies.size(); ++i) f(bodies[i], interactions::part_of<Fat>(state.objects)[i]);
}

/// Which sectors of a strand's place a lobule is in: bits.
class Sectors {
 public:
  Sectors(const sim::Model& model, const sim::State& state, int strand)
      : m_body(model.strand_bodies[std::size_t(strand)]),
        m_state(state.strands[std::size_t(strand)]),
        m_covered(std::size_t(m_body.length() / kStride) + 1, 0) {}

  void cover(Vec3d p, double reach) {
    for (std::size_t i = 0; i < m_covered.size(); ++i) {
      const interactions::StrandPlace at = interactions::place_at(m_body, double(i) * kStride);
      const interactions::StrandFrame frame = frame_at(m_body, m_state, at);
      const Vec3d off = p - point_at(m_body, m_state, at);
      const double y = dot(off, frame.normal), z = dot(off, frame.binormal);
      const double along = dot(off, cross(frame.normal, frame.binormal));
      const double radius = m_body.model.radius[std::size_t(at.element)];
      if (std::fabs(along) > reach || y * y + z * z > (radius + reach) * (radius + reach)) continue;
      const double turn = portable::atan2(z, y) / (2 * portable::pi) + 1;
      m_covered[i] |= std::uint32_t(1) << (int(turn * kSectors) % kSectors);
    }
  }
  double longest() const {
    int most = 0, run = 0;
    for (const std::uint32_t bits : m_covered) {
      int covered = 0;
      for (std::uint32_t b = bits; b; b &= b - 1) ++covered;
      run = covered <= kSectors - kBareSectors ? run + 1 : 0;
      most = std::max(most, run);
    }
    return std::max(0, most - 1) * kStride;
  }

 private:
  const interactions::StrandBody& m_body;
  const tissue::StrandState& m_state;
  std::vector<std::uint32_t> m_covered;
};

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

BodyId holder(const BorderHold& hold) {
  return hold.kind == BorderHold::strand ? BodyId::strand(std::size_t(hold.index))
                                         : BodyId::organ(std::size_t(hold.index));
}

/// f(lobule, body) of all that a body of fat still holds on.
template <class F>
void for_holds(const FatBody& body, const FatBodyState& s, F&& f) {
  for (std::size_t i = 0; i < body.roots.bonds.size(); ++i)
    if (s.roots[i].holds()) f(std::size_t(body.roots.bonds[i].node), holder(body.roots.bonds[i].hold));
  for (std::size_t i = 0; i < body.ties.size(); ++i)
    if (s.ties[i].holds()) f(std::size_t(body.ties[i].lobule), BodyId::membrane(std::size_t(body.ties[i].membrane)));
}

void add_bridged(const FatBody& body, const FatBodyState& s, BodyId from, std::vector<BodyId>& out) {
  Together lobules(s.fat.lobules.size());
  for (int i = 0; i < body.fat.septa(); ++i)
    if (holding(body.fat, s.fat, i) > 0)
      lobules.join(std::size_t(septum_end(body.fat, i, 0)), std::size_t(septum_end(body.fat, i, 1)));
  std::vector<std::uint8_t> reached(s.fat.lobules.size(), 0);
  for_holds(body, s, [&](std::size_t lobule, BodyId on) {
    if (on == from) reached[lobules.root(lobule)] = 1;
  });
  for_holds(body, s, [&](std::size_t lobule, BodyId on) {
    if (on != from && reached[lobules.root(lobule)] && std::find(out.begin(), out.end(), on) == out.end())
      out.push_back(on);
  });
}

}  // namespace

double bared_length(const sim::Model& model, const sim::State& state, int strand) {
  Sectors sectors(model, state, strand);
  for_fat(model, state, [&](const FatBody& body, const FatBodyState& s) {
    for (int n = 0; n < body.fat.lobules(); ++n)
      if (!s.fat.lobules[std::size_t(n)].gone()) sectors.cover(position(body.fat, s.fat, n), kOnIt * body.fat.spacing);
  });
  return sectors.longest();
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
      open += !Fat::hides(interactions::part_of<Fat>(model.objects), interactions::part_of<Fat>(state.objects),
                          p - reach * normal, p + reach * normal);
    }
  return double(open) / (kRows * kRows);
}

std::vector<BodyId> bridged_from(const sim::Model& model, const sim::State& state, BodyId body) {
  std::vector<BodyId> out;
  for_fat(model, state, [&](const FatBody& fat, const FatBodyState& s) { add_bridged(fat, s, body, out); });
  return out;
}

double fat_left(const sim::Model& model, const sim::State& state, BodyId fat) {
  const FatBody& body = interactions::part_of<Fat>(model.objects).list[fat.index()];
  const FatBodyState& s = interactions::part_of<Fat>(state.objects)[fat.index()];
  return 1 - double(s.fat.gone) / double(body.fat.lobules());
}

}  // namespace trocar::training
