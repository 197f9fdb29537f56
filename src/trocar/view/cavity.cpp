#include <array>
#include <cmath>
#include <map>

#include <trocar/render/mesh_arrays.hpp>
#include <trocar/view/cavity.hpp>
#include <trocar/view/relief.hpp>

namespace trocar::view {
namespace {

constexpr double kTwoPi = 6.28318530717959;
constexpr int kAround = 56, kRings = 28;
constexpr int kMarginRows = 18;  // from a wall's border to the cavity
constexpr int kEvenEnds = 60;    // passes over the far ends of what leads there

tissue::Box bounds_of(const sim::Model& model) {
  tissue::Box box;
  for (int i = 0; i < model.organs(); ++i)
    for (int v = 0; v < model.skin(i).size(); ++v)
      if (model.skin(i).at_surface(v)) box.add(model.skin(i).rest[std::size_t(v)]);
  for (const sim::WallModel& w : model.walls)
    for (const Vec3f& p : w.skin.rest) box.add(p);
  for (const sim::HandModel& t : model.hands) box.add(vec_cast<float>(t.port));
  box.add(vec_cast<float>(model.scope.port));
  return box;
}

/// An uneven ellipsoid.
struct Cavity {
  Vec3d middle, half;

  explicit Cavity(const sim::Model& model) {
    const tissue::Box box = bounds_of(model);
    middle = 0.5 * vec_cast<double>(box.low + box.high);
    half = 0.5 * vec_cast<double>(box.high - box.low) + Vec3d{0.03, 0.03, 0.03};
  }
  Vec3d at(Vec3d d) const {
    const double uneven = 1.22 + 0.05 * waves(0.1 * d, 0.09);
    return middle + uneven * Vec3d{half.x * d.x, half.y * d.y, half.z * d.z};
  }
  Vec3d behind(Vec3d p) const {
    const Vec3d d = p - middle;
    return at(normalised(Vec3d{d.x / half.x, d.y / half.y, d.z / half.z}, Vec3d{0, 1, 0}));
  }
};

/// The border of a skin as directed edges, in the order of its triangles.
std::vector<std::array<int, 2>> border_of(const tissue::Skin& skin) {
  std::map<std::pair<int, int>, int> seen;
  for (const auto& t : skin.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++seen[{t[k], t[(k + 1) % 3]}];
  std::vector<std::array<int, 2>> border;
  for (const auto& t : skin.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (const int a = t[k], b = t[(k + 1) % 3]; !seen.count({b, a})) border.push_back({a, b});
  return border;
}

}  // namespace

double fat_below(Vec3d p) {
  return 0.55 * smooth(-0.1, 0.75, 0.75 * waves(p, 0.052) + 0.4 * waves(p + Vec3d{0.3, 0.1, 0.2}, 0.019));
}

namespace {

/// What leads from one vertex of a wall's border to the cavity.
struct MarginColumn {
  int vertex = 0;
  Vec3d from, to, away;  ///< away: unit, in the wall's surface, across its border
};

/// The border's vertices in the order in which its edges follow each other.
std::vector<std::vector<int>> loops_of(const std::vector<std::array<int, 2>>& border) {
  std::map<int, int> next;
  for (const auto& [a, b] : border) next[a] = b;
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int>& loop = loops.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      const int following = at->second;
      loop.push_back(at->first);
      next.erase(at);
      at = next.find(following);
    }
  }
  return loops;
}

/// `passes` times every value becomes the mean of itself and its neighbours on the loop.
template <class Get>
void even_out(std::vector<MarginColumn>& loop, int passes, Get&& get) {
  const std::size_t n = loop.size();
  std::vector<Vec3d> old(n);
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t i = 0; i < n; ++i) old[i] = get(loop[i]);
    for (std::size_t i = 0; i < n; ++i) get(loop[i]) = 0.5 * old[i] + 0.25 * (old[(i + 1) % n] + old[(i + n - 1) % n]);
  }
}

/// Columns of one loop. Where its border turns sharply they would cross and show as ruled lines, so they fan out from
/// the loop's middle, and directions and far ends even out along it.
std::vector<MarginColumn> columns_of(const std::vector<int>& loop, const tissue::Skin& wall, const Cavity& cavity) {
  std::vector<MarginColumn> columns;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const int v = loop[i], before = loop[(i + loop.size() - 1) % loop.size()], after = loop[(i + 1) % loop.size()];
    const Vec3d edge = vec_cast<double>(wall.rest[std::size_t(after)] - wall.rest[std::size_t(before)]);
    const Vec3d away = cross(edge, vec_cast<double>(wall.rest_normal[std::size_t(v)]));
    columns.push_back({v, vec_cast<double>(wall.rest[std::size_t(v)]), {}, away});
  }
  even_out(columns, 25, [](MarginColumn& c) -> Vec3d& { return c.away; });
  Vec3d middle{}, onward{};
  for (MarginColumn& c : columns) {
    c.away = normalised(c.away, vec_cast<double>(wall.rest_normal[std::size_t(c.vertex)]));
    middle += c.from / double(columns.size());
    onward += c.away / double(columns.size());
  }
  for (MarginColumn& c : columns) {
    const Vec3d fan = normalised(normalised(c.from - middle) + 1.5 * onward, c.away);
    c.to = cavity.behind(c.from + 0.05 * fan);
  }
  even_out(columns, kEvenEnds, [](MarginColumn& c) -> Vec3d& { return c.to; });
  for (MarginColumn& c : columns) c.to = cavity.behind(c.to);
  return columns;
}

}  // namespace

std::vector<std::vector<int>> border_loops(const tissue::Skin& wall) { return loops_of(border_of(wall)); }

MeshBuffer around_wall(const sim::Model& model, const tissue::Skin& wall, std::span<const Paint> paint) {
  const Cavity cavity(model);
  const std::vector<std::array<int, 2>> border = border_of(wall);
  MeshBuffer m;
  std::map<int, std::uint32_t> column;
  for (const std::vector<int>& loop : loops_of(border)) {
    std::vector<MarginColumn> columns = columns_of(loop, wall, cavity), row = columns;
    for (const MarginColumn& c : columns) {
      column[c.vertex] = m.size();
      for (int r = 0; r < kMarginRows; ++r) m.add({}, paint[std::size_t(c.vertex)]);
    }
    for (int r = 0; r < kMarginRows; ++r) {
      const double w = double(r) / (kMarginRows - 1), u = w * w, k = 1 - u;
      for (std::size_t i = 0; i < columns.size(); ++i) {
        const MarginColumn& c = columns[i];
        const double reach = 0.7 * length(c.to - c.from);
        row[i].to = (k * k * (1 + 2 * u)) * c.from + (u * u * (3 - 2 * u)) * c.to + (k * k * u * reach) * c.away;
      }
      even_out(row, 2 * r * r, [](MarginColumn& c) -> Vec3d& { return c.to; });
      for (const MarginColumn& c : row) {
        const std::size_t at = column[c.vertex] + std::size_t(r);
        const Vec3d x = r + 1 < kMarginRows ? c.to : cavity.behind(c.to);
        m.positions[at] = vec_cast<float>(x);
        m.paint[at].openness = to_byte((1 - w) * m.paint[at].openness / 255.0 + w);
        m.paint[at].tint = to_byte((1 - w) * m.paint[at].tint / 255.0 + w * fat_below(x));
      }
    }
  }
  for (const auto& [a, b] : border) join_rows(m, column[b], column[a], std::uint32_t(kMarginRows), false);
  render::vertex_normals(m.positions, m.indices, m.normals);
  for (const auto& [v, first] : column) {  // no seam: as the wall's, and on its side
    const Vec3f n = wall.rest_normal[std::size_t(v)];
    const float side = dot(m.normals[first + 2], n) < 0 ? -1.0f : 1.0f;
    for (std::uint32_t r = 0; r < std::uint32_t(kMarginRows); ++r) m.normals[first + r] = side * m.normals[first + r];
    m.normals[first] = n;
  }
  return m;
}

MeshBuffer cavity_around(const sim::Model& model) {
  const Cavity cavity(model);
  const auto at = [&](Vec3d d) { return vec_cast<float>(cavity.at(d)); };
  MeshBuffer b;
  b.add(at({0, 0, -1}));
  for (int i = 1; i < kRings; ++i)
    for (int k = 0; k < kAround; ++k) {
      const double polar = 0.5 * kTwoPi * i / kRings, a = kTwoPi * k / kAround;
      b.add(at({std::sin(polar) * std::cos(a), std::sin(polar) * std::sin(a), -std::cos(polar)}));
    }
  b.add(at({0, 0, 1}));
  // Seen from inside: everything is joined the other way round.
  const auto row = [](int i) { return std::uint32_t(1 + (i - 1) * kAround); };
  join_pole(b, row(1), kAround, 0, true);
  for (int i = 1; i + 1 < kRings; ++i) join_rows(b, row(i + 1), row(i), kAround, true);
  join_pole(b, row(kRings - 1), kAround, b.size() - 1, false);
  for (std::uint32_t i = 0; i < b.size(); ++i) b.paint[i].tint = to_byte(fat_below(vec_cast<double>(b.positions[i])));
  return b;
}

}  // namespace trocar::view
