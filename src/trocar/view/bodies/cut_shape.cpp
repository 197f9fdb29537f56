#include <algorithm>
#include <cmath>
#include <map>

#include <trocar/view/bodies/cut_shape.hpp>

namespace trocar::view {
namespace {

// Our choice, by eye.
constexpr int kAlongRims = 7;        // steps of a half towards the mean: a cell's edge is three of them long
constexpr int kWithin = 6;           // ... of what is bare
constexpr int kCutAround = 10;       // ... of the skin around
constexpr float kCutRound = 0.012f;  // [m] how far from a rim it goes along
constexpr float kSamePlace = 1e-5f;  // [m] at rest: the two sides of a slit

using Key = std::array<int, 6>;

/// Up to three nodes with how much of each: vertices that share it lie in one place however the body moves.
Key key_of(const tissue::FaceSkin& skin, std::size_t vertex) {
  std::array<std::pair<int, int>, 3> named;
  for (std::size_t k = 0; k < 3; ++k) {
    const int share = int(std::lround(1000 * skin.between[vertex][k]));
    named[k] = share > 0 ? std::pair{skin.corners[vertex][k], share} : std::pair{-1, 0};
  }
  std::sort(named.begin(), named.end());
  return {named[0].first, named[0].second, named[1].first, named[1].second, named[2].first, named[2].second};
}

}  // namespace

void CutShape::find(const tissue::FaceSkin& skin) {
  m_kind.clear(), m_far.clear(), m_beside.clear();
  m_first.assign(1, 0);
  m_spot.assign(skin.bare.size(), -1);
  if (std::none_of(skin.bare.begin(), skin.bare.end(), [](std::uint8_t b) { return b != 0; })) return;
  std::vector<Edge> edges = join(skin);
  measure(skin, edges);
  keep_near(edges);
  list_beside(edges);
  find_ends(skin);
}

/// Which vertices lie in one place, and all edges between such places, each once.
std::vector<CutShape::Edge> CutShape::join(const tissue::FaceSkin& skin) {
  std::map<Key, int> spots;
  for (std::size_t v = 0; v < m_spot.size(); ++v)
    m_spot[v] = spots.insert({key_of(skin, v), int(spots.size())}).first->second;
  std::vector<Edge> edges;
  for (const std::array<int, 3>& t : skin.skin.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = m_spot[std::size_t(t[k])], b = m_spot[std::size_t(t[(k + 1) % 3])];
      const bool bare = skin.bare[std::size_t(t[0])] != 0;
      edges.push_back({std::min(a, b), std::max(a, b), bare, !bare});
    }
  const auto key = [](const Edge& e) { return std::pair{e.a, e.b}; };
  std::sort(edges.begin(), edges.end(), [&](const Edge& x, const Edge& y) { return key(x) < key(y); });
  std::size_t kept = 0;
  for (const Edge& e : edges)
    if (kept > 0 && key(edges[kept - 1]) == key(e))
      edges[kept - 1].bare |= e.bare, edges[kept - 1].skin |= e.skin;
    else
      edges[kept++] = e;
  edges.resize(kept);
  m_kind.assign(spots.size(), Kind::skin);
  for (const Edge& e : edges)
    for (const int spot : {e.a, e.b}) {
      if (e.bare && m_kind[std::size_t(spot)] == Kind::skin) m_kind[std::size_t(spot)] = Kind::bare;
    }
  for (const Edge& e : edges)
    if (e.bare && e.skin) m_kind[std::size_t(e.a)] = m_kind[std::size_t(e.b)] = Kind::rim;
  return edges;
}

/// How far the skin's places are from the rim.
void CutShape::measure(const tissue::FaceSkin& skin, std::span<const Edge> edges) {
  m_far.assign(m_kind.size(), kFar);
  std::vector<Vec3f> rest(m_kind.size());
  for (std::size_t v = 0; v < m_spot.size(); ++v) rest[std::size_t(m_spot[v])] = skin.skin.rest[v];
  for (std::size_t i = 0; i < m_kind.size(); ++i)
    if (m_kind[i] == Kind::rim) m_far[i] = 0;
  constexpr int kRings = 8;
  for (int ring = 0; ring < kRings; ++ring)
    for (const Edge& e : edges) {
      if (!e.skin) continue;
      float &a = m_far[std::size_t(e.a)], &b = m_far[std::size_t(e.b)];
      const float between = length(rest[std::size_t(e.a)] - rest[std::size_t(e.b)]);
      a = std::min(a, b + between), b = std::min(b, a + between);
    }
}

/// What lies further off than it moves along is let go.
void CutShape::keep_near(std::vector<Edge>& edges) {
  std::vector<int> renamed(m_kind.size(), -1);
  int kept = 0;
  for (std::size_t i = 0; i < m_kind.size(); ++i) {
    if (m_kind[i] == Kind::skin && m_far[i] > kCutRound) continue;
    m_kind[std::size_t(kept)] = m_kind[i], m_far[std::size_t(kept)] = m_far[i];
    renamed[i] = kept++;
  }
  m_kind.resize(std::size_t(kept)), m_far.resize(std::size_t(kept));
  for (int& spot : m_spot) spot = renamed[std::size_t(spot)];
  for (Edge& e : edges) e.a = renamed[std::size_t(e.a)], e.b = renamed[std::size_t(e.b)];
  std::erase_if(edges, [](const Edge& e) { return e.a < 0 || e.b < 0; });
}

void CutShape::list_beside(std::span<const Edge> edges) {
  std::vector<std::vector<std::int32_t>> beside(m_kind.size());
  for (const Edge& e : edges) {
    const auto add = [&](int to, int other) {
      if (m_kind[std::size_t(to)] != Kind::rim || (e.bare && e.skin)) beside[std::size_t(to)].push_back(other);
    };
    add(e.a, e.b), add(e.b, e.a);
  }
  for (const std::vector<std::int32_t>& list : beside) {
    m_beside.insert(m_beside.end(), list.begin(), list.end());
    m_first.push_back(std::int32_t(m_beside.size()));
  }
}

/// Where both sides of a slit meet: smoothing would draw it shut from there.
void CutShape::find_ends(const tissue::FaceSkin& skin) {
  std::vector<Vec3f> rest(m_kind.size());
  for (std::size_t v = 0; v < m_spot.size(); ++v)
    if (m_spot[v] >= 0) rest[std::size_t(m_spot[v])] = skin.skin.rest[v];
  m_end.assign(m_kind.size(), 0);
  for (std::size_t i = 0; i < m_kind.size(); ++i) {
    if (m_kind[i] == Kind::skin) continue;
    for (std::int32_t k = m_first[i]; k < m_first[i + 1]; ++k)
      for (std::int32_t l = m_first[i]; l < k; ++l) {
        const Vec3f apart = rest[std::size_t(m_beside[std::size_t(k)])] - rest[std::size_t(m_beside[std::size_t(l)])];
        if (length(apart) < kSamePlace) m_end[i] = 1;
      }
  }
}

template <class Wanted>
void CutShape::relax(float share, Wanted&& wanted) {
  for (std::size_t i = 0; i < m_kind.size(); ++i) {
    m_next[i] = m_place[i];
    const std::int32_t first = m_first[i], last = m_first[i + 1];
    if (!wanted(m_kind[i]) || m_end[i] || first == last) continue;
    Vec3f sum;
    for (std::int32_t k = first; k < last; ++k) sum += m_place[std::size_t(m_beside[std::size_t(k)])];
    m_next[i] = (1 - share) * m_place[i] + (share / float(last - first)) * sum;
  }
  m_place.swap(m_next);
}

void CutShape::smooth(std::span<Vec3f> positions) {
  if (m_kind.empty()) return;
  m_place.resize(m_kind.size()), m_next.resize(m_kind.size());
  for (std::size_t v = 0; v < m_spot.size(); ++v)
    if (m_spot[v] >= 0) m_place[std::size_t(m_spot[v])] = positions[v];
  m_shift = m_place;
  for (int n = 0; n < kAlongRims; ++n) relax(0.5f, [](Kind kind) { return kind == Kind::rim; });
  for (int n = 0; n < kWithin; ++n) relax(0.5f, [](Kind kind) { return kind == Kind::bare; });
  // From here on places are ways: the skin takes over its neighbours'.
  for (std::size_t i = 0; i < m_kind.size(); ++i) m_place[i] -= m_shift[i];
  for (int n = 0; n < kCutAround; ++n) relax(0.9f, [](Kind kind) { return kind == Kind::skin; });
  for (std::size_t i = 0; i < m_kind.size(); ++i)
    if (m_kind[i] == Kind::skin) m_place[i] *= 1 - m_far[i] / kCutRound;
  for (std::size_t i = 0; i < m_kind.size(); ++i) m_shift[i] += m_place[i];
  for (std::size_t v = 0; v < m_spot.size(); ++v)
    if (m_spot[v] >= 0) positions[v] = m_shift[std::size_t(m_spot[v])];
  look_outwards();
}

void CutShape::look_outwards() {
  m_outwards.assign(m_kind.size(), Vec3f{});
  for (std::size_t i = 0; i < m_kind.size(); ++i) {
    if (m_kind[i] != Kind::skin) continue;
    for (std::int32_t k = m_first[i]; k < m_first[i + 1]; ++k) {
      const auto other = std::size_t(m_beside[std::size_t(k)]);
      if (m_kind[other] == Kind::rim) m_outwards[other] += m_shift[i] - m_shift[other];
    }
  }
}

Vec3f CutShape::outwards(std::size_t vertex) const {
  const int spot = m_spot[vertex];
  return spot < 0 || m_outwards.empty() ? Vec3f{} : normalised(m_outwards[std::size_t(spot)], Vec3f{});
}

}  // namespace trocar::view
