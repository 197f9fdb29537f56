#include "organ_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/sim/model/bodies.hpp>

namespace trocar {
namespace {

constexpr float kReach = 0.004f, kCell = 0.004f, kPlace = 0.0015f;

/// Closest point of a triangle [Ericson 05, 5.1.5].
Vec3f closest(Vec3f p, Vec3f a, Vec3f b, Vec3f c) {
  const Vec3f ab = b - a, ac = c - a, ap = p - a;
  const float d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3f bp = p - b;
  const float d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
  const Vec3f cp = p - c;
  const float d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  const float sum = 1 / (va + vb + vc);
  return a + (vb * sum) * ab + (vc * sum) * ac;
}

}  // namespace

OrganContacts::OrganContacts(const sim::Model& model, const sim::State& state) {
  sim::visit_solids(model, [&](auto r) {
    const sim::SolidModel& solid = model_of(model, r);
    tissue::SkinPose pose = tissue::make_pose(solid.fine);
    pose_skin(view_of(solid.network, state.solids[r.index]), solid.fine, pose);
    add(pose.position, solid.fine.triangles, solids++);
  });
  std::int32_t wall = solids;
  for (const sim::WallModel& w : model.walls) add(w.skin.rest, w.skin.triangles, wall++);
  sort_into_cells();
  make_places();
}

std::int64_t OrganContacts::key(Vec3f p, float edge) const {
  const auto cell = [edge](float x) { return std::int64_t(std::floor((x + 0.5f) / edge)); };
  return (cell(p.x) << 40) + (cell(p.y) << 20) + cell(p.z);
}

void OrganContacts::add(std::span<const Vec3f> points, std::span<const std::array<int, 3>> triangles,
                        std::int32_t body) {
  for (const std::array<int, 3>& t : triangles) {
    const Vec3f a = points[std::size_t(t[0])], b = points[std::size_t(t[1])], c = points[std::size_t(t[2])];
    const Vec3f n = cross(b - a, c - a);
    if (length(n) > 1e-12f) m_triangles.push_back({a, b, c, normalised(n), body});
  }
}

void OrganContacts::sort_into_cells() {
  for (std::size_t t = 0; t < m_triangles.size(); ++t) {
    const Triangle& tri = m_triangles[t];
    const auto low = [](float x, float y, float z) { return std::min({x, y, z}) - kReach; };
    const auto high = [](float x, float y, float z) { return std::max({x, y, z}) + kReach; };
    const Vec3f from{low(tri.a.x, tri.b.x, tri.c.x), low(tri.a.y, tri.b.y, tri.c.y), low(tri.a.z, tri.b.z, tri.c.z)};
    const Vec3f to{high(tri.a.x, tri.b.x, tri.c.x), high(tri.a.y, tri.b.y, tri.c.y), high(tri.a.z, tri.b.z, tri.c.z)};
    for (float x = from.x; x < to.x + kCell; x += kCell)
      for (float y = from.y; y < to.y + kCell; y += kCell)
        for (float z = from.z; z < to.z + kCell; z += kCell)
          m_cells.push_back({key({std::min(x, to.x), std::min(y, to.y), std::min(z, to.z)}, kCell), std::int32_t(t)});
  }
  std::sort(m_cells.begin(), m_cells.end());
  m_cells.erase(std::unique(m_cells.begin(), m_cells.end()), m_cells.end());
}

void OrganContacts::make_places() {
  for (std::size_t t = 0; t < m_triangles.size(); ++t) {
    const Triangle& tri = m_triangles[t];
    const int n = 1 + int(std::max(length(tri.b - tri.a), length(tri.c - tri.a)) / (0.5f * kPlace));
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) {
        const Vec3f p = tri.a + (float(i) / float(n)) * (tri.b - tri.a) + (float(j) / float(n)) * (tri.c - tri.a);
        m_place.push_back({key(p, kPlace), std::int32_t(m_places.size())});
        m_places.push_back({p, tri.normal, kPlace * kPlace, false});
      }
  }
  std::stable_sort(m_place.begin(), m_place.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  // One a cube: in the middle of its points.
  std::vector<view::FilmPlace> one;
  std::vector<std::pair<std::int64_t, std::int32_t>> where;
  for (std::size_t k = 0; k < m_place.size();) {
    std::size_t end = k;
    Vec3f p, n;
    for (; end < m_place.size() && m_place[end].first == m_place[k].first; ++end) {
      p += m_places[std::size_t(m_place[end].second)].position;
      n += m_places[std::size_t(m_place[end].second)].normal;
    }
    where.push_back({m_place[k].first, std::int32_t(one.size())});
    one.push_back({(1 / float(end - k)) * p, normalised(n), kPlace * kPlace, false});
    k = end;
  }
  m_places = std::move(one);
  m_place = std::move(where);
}

std::int32_t OrganContacts::place_at(Vec3f p) const {
  const auto found = std::lower_bound(m_place.begin(), m_place.end(), std::pair{key(p, kPlace), std::int32_t(0)});
  return found != m_place.end() && found->first == key(p, kPlace) ? found->second : -1;
}

OrganContacts::Near OrganContacts::near_triangle(std::int32_t t, Vec3f p) const {
  const Triangle& tri = m_triangles[std::size_t(t)];
  const Vec3f q = closest(p, tri.a, tri.b, tri.c);
  const float far = length(p - q);
  const bool above = dot(p - q, tri.normal) >= 0;
  return {above ? far : -far, q, tri.normal, t};
}

OrganContacts::Near OrganContacts::nearest(Vec3f p) const {
  Near best;
  const std::int64_t cell = key(p, kCell);
  for (auto it = std::lower_bound(m_cells.begin(), m_cells.end(), std::pair{cell, std::int32_t(0)});
       it != m_cells.end() && it->first == cell; ++it) {
    const Near near = near_triangle(it->second, p);
    if (std::fabs(near.off) < std::fabs(best.off)) best = near;
  }
  return std::fabs(best.off) < kReach ? best : Near{};
}

OrganContacts::Near OrganContacts::first_on_way(Vec3f a, Vec3f b) const {
  const int n = 1 + int(length(b - a) / 0.001f);
  for (int k = 1; k <= n; ++k) {
    const Near near = nearest(a + (float(k) / float(n)) * (b - a));
    if (near.triangle >= 0 && near.off < 0.0003f) return near;
  }
  return nearest(b);
}

std::vector<float> OrganContacts::floor_of(const fluids::PoolModel& pool, std::span<const int> organs) const {
  std::vector<float> floor(std::size_t(pool.nx) * pool.ny, -1.0f);
  for (const Triangle& t : m_triangles) {
    const bool holds = t.body >= solids || std::find(organs.begin(), organs.end(), t.body) != organs.end();
    if (!holds || dot(vec_cast<double>(t.normal), pool.up) < 0.05) continue;
    const int n = 2 + int(std::max(length(t.b - t.a), length(t.c - t.a)) / float(0.4 * pool.cell));
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) {
        const Vec3f p = t.a + (float(i) / float(n)) * (t.b - t.a) + (float(j) / float(n)) * (t.c - t.a);
        const fluids::PoolPoint at = locate(pool, vec_cast<double>(p));
        if (!at.inside) continue;
        float& height = floor[std::size_t(at.j) * pool.nx + at.i];
        height = std::max(height, at.height);
      }
  }
  // What no triangle covers goes on as what is around it.
  for (bool open = true; open;) {
    open = false;
    std::vector<float> next = floor;
    for (int j = 0; j < pool.ny; ++j)
      for (int i = 0; i < pool.nx; ++i) {
        if (floor[std::size_t(j) * pool.nx + i] > -1) continue;
        float most = -1;
        for (int b = std::max(j - 1, 0); b <= std::min(j + 1, pool.ny - 1); ++b)
          for (int a = std::max(i - 1, 0); a <= std::min(i + 1, pool.nx - 1); ++a)
            most = std::max(most, floor[std::size_t(b) * pool.nx + a]);
        open = open || most > -1;
        if (most > -1) next[std::size_t(j) * pool.nx + i] = most + 0.001f;
      }
    floor.swap(next);
  }
  return floor;
}

}  // namespace trocar
