#include <algorithm>
#include <cmath>

#include <trocar/view/objects/fat_surface.hpp>

namespace trocar::view {
namespace {

constexpr float kLevel = 0.5f;
constexpr std::size_t kMostNodes = 1'500'000;
constexpr std::uint32_t kNone = ~0u;

}  // namespace

bool FatSurface::lay_grid(std::span<const DrawnLobule> lobules) {
  if (lobules.empty()) return false;
  Vec3f low{1e9f, 1e9f, 1e9f}, high{-1e9f, -1e9f, -1e9f};
  for (const DrawnLobule& l : lobules)
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], l.place[c] - l.reach);
      high[c] = std::max(high[c], l.place[c] + l.reach);
    }
  m_low = low - Vec3f{2 * m_cell, 2 * m_cell, 2 * m_cell};
  std::size_t nodes = 1;
  for (int c = 0; c < 3; ++c) {
    m_size[c] = std::min(300, int((high[c] - low[c]) / m_cell) + 5);
    nodes *= std::size_t(m_size[c]);
  }
  if (nodes > kMostNodes) return false;
  m_nodes.assign(nodes, Node{});
  m_vertex.assign(nodes, kNone);
  return true;
}

void FatSurface::add(const DrawnLobule& l) {
  int from[3], to[3];
  for (int c = 0; c < 3; ++c) {
    from[c] = std::max(0, int((l.place[c] - l.reach - m_low[c]) / m_cell));
    to[c] = std::min(m_size[c] - 1, int((l.place[c] + l.reach - m_low[c]) / m_cell) + 1);
  }
  const Vec3f moved = l.place - l.rest;
  const float per_reach = 1 / (l.reach * l.reach);
  for (int k = from[2]; k <= to[2]; ++k)
    for (int j = from[1]; j <= to[1]; ++j)
      for (int i = from[0]; i <= to[0]; ++i) {
        const Vec3f p = m_low + m_cell * Vec3f{float(i), float(j), float(k)}, off = p - l.place;
        const float inside = 1 - dot(off, off) * per_reach;
        if (inside <= 0) continue;
        const float bell = inside * inside;
        Node& n = m_nodes[at(i, j, k)];
        n.sum += bell;
        n.moved += bell * moved;
        n.burn += bell * float(l.burn);
      }
}

/// One in a cube that the surface goes through: the mean of where it crosses the cube's edges.
void FatSurface::place_vertex(int i, int j, int k, MeshBuffer& to) {
  float value[8], lowest = 1e9f, highest = -1e9f;
  const Node* corner[8];
  for (int c = 0; c < 8; ++c) {
    corner[c] = &m_nodes[at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))];
    value[c] = corner[c]->sum - kLevel;
    lowest = std::min(lowest, value[c]), highest = std::max(highest, value[c]);
  }
  if (lowest >= 0 || highest < 0) return;
  Vec3f sum{0, 0, 0};
  int crossings = 0;
  for (int c = 0; c < 8; ++c)
    for (int axis = 0; axis < 3; ++axis) {
      const int other = c | 1 << axis;
      if (other == c || (value[c] < 0) == (value[other] < 0)) continue;
      Vec3f p{float(c & 1), float(c >> 1 & 1), float(c >> 2)};
      p[axis] += value[c] / (value[c] - value[other]);
      sum += p;
      ++crossings;
    }
  const Vec3f within = sum / float(crossings);
  Node mean;
  Vec3f slope{0, 0, 0};
  for (int c = 0; c < 8; ++c) {
    const float w[3] = {c & 1 ? within.x : 1 - within.x, c >> 1 & 1 ? within.y : 1 - within.y,
                        c >> 2 ? within.z : 1 - within.z};
    const float share = w[0] * w[1] * w[2];
    mean.sum += share * corner[c]->sum;
    mean.moved += share * corner[c]->moved;
    mean.burn += share * corner[c]->burn;
    for (int axis = 0; axis < 3; ++axis)
      slope[axis] += (c >> axis & 1 ? 1.0f : -1.0f) * value[c] * w[(axis + 1) % 3] * w[(axis + 2) % 3];
  }
  const Vec3f p = m_low + m_cell * (Vec3f{float(i), float(j), float(k)} + within);
  const float per_bell = 1 / std::max(mean.sum, 1e-3f);
  m_vertex[at(i, j, k)] = to.add(p, Paint{.burn = std::uint8_t(std::clamp(per_bell * mean.burn, 0.0f, 255.0f))});
  to.normals.push_back(normalised(-1.0f * slope, Vec3f{0, 0, 1}));
  to.rest.push_back(p - per_bell * mean.moved);
}

void FatSurface::place_vertices(MeshBuffer& to) {
  for (int k = 0; k + 1 < m_size[2]; ++k)
    for (int j = 0; j + 1 < m_size[1]; ++j)
      for (int i = 0; i + 1 < m_size[0]; ++i) place_vertex(i, j, k, to);
}

/// The four cubes around an edge of the grid that the surface crosses.
void FatSurface::join_across(int i, int j, int k, int axis, MeshBuffer& to) {
  int next[3] = {i, j, k};
  ++next[axis];
  const bool inside = m_nodes[at(i, j, k)].sum >= kLevel;
  if (inside == (m_nodes[at(next[0], next[1], next[2])].sum >= kLevel)) return;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::uint32_t around[4];
  for (int q = 0; q < 4; ++q) {
    int cube[3] = {i, j, k};
    cube[u] -= q == 1 || q == 2 ? 1 : 0;
    cube[v] -= q >= 2 ? 1 : 0;
    if (cube[u] < 0 || cube[v] < 0) return;
    around[q] = m_vertex[at(cube[0], cube[1], cube[2])];
    if (around[q] == kNone) return;
  }
  if (inside)
    to.quad(around[0], around[1], around[2], around[3]);
  else
    to.quad(around[3], around[2], around[1], around[0]);
}

void FatSurface::join(MeshBuffer& to) {
  for (int k = 0; k + 1 < m_size[2]; ++k)
    for (int j = 0; j + 1 < m_size[1]; ++j)
      for (int i = 0; i + 1 < m_size[0]; ++i)
        for (int axis = 0; axis < 3; ++axis) join_across(i, j, k, axis, to);
}

void FatSurface::draw(std::span<const DrawnLobule> lobules, MeshBuffer& to) {
  if (!lay_grid(lobules)) return;
  for (const DrawnLobule& l : lobules) add(l);
  place_vertices(to);
  join(to);
}

}  // namespace trocar::view
