#include <algorithm>
#include <cmath>
#include <set>

#include <trocar/interactions/objects/bag_build.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::interactions {
namespace {

/// How wide and how deep the open sack is, so far along from its mouth to its bottom.
struct Meridian {
  double hoop, straight;  ///< [m]
  double length() const { return straight + 0.5 * portable::pi * hoop; }
  Vec3d at(double s) const {  ///< x: how wide, z
    if (s <= straight) return {hoop, 0, -s};
    const double turn = (s - straight) / hoop;
    return {hoop * portable::cos(turn), 0, -straight - hoop * portable::sin(turn)};
  }
};

void lay_nodes(const Meridian& line, BagModel& m) {
  for (int r = 0; r < m.rows; ++r) {
    const Vec3d at = line.at(line.length() * r / m.rows);
    for (int c = 0; c < m.around; ++c) {
      const double turn = 2 * portable::pi * c / m.around;
      m.drawn.push_back({at.x * portable::cos(turn), at.x * portable::sin(turn), at.z});
    }
  }
  m.drawn.push_back(line.at(line.length()));
}

void lay_triangles(BagModel& m) {
  const auto node = [&m](int r, int c) { return std::int32_t(r * m.around + (c + m.around) % m.around); };
  const std::int32_t bottom = std::int32_t(m.nodes()) - 1;
  for (int r = 0; r + 1 < m.rows; ++r)
    for (int c = 0; c < m.around; ++c) {
      const std::int32_t a = node(r, c), b = node(r, c + 1), d = node(r + 1, c), e = node(r + 1, c + 1);
      if ((r + c) % 2 == 0) {
        m.triangles.push_back({a, d, e}), m.triangles.push_back({a, e, b});
      } else {
        m.triangles.push_back({a, d, b}), m.triangles.push_back({b, d, e});
      }
    }
  for (int c = 0; c < m.around; ++c) m.triangles.push_back({node(m.rows - 1, c), bottom, node(m.rows - 1, c + 1)});
}

BagThread thread(const BagModel& m, std::int32_t a, std::int32_t b) {
  return {a, b, length(m.drawn[size_t(b)] - m.drawn[size_t(a)])};
}

/// Along every side of a triangle, but for those of the hoop.
void tie(BagModel& m) {
  std::set<std::pair<std::int32_t, std::int32_t>> sides;
  for (const auto& t : m.triangles)
    for (size_t k = 0; k < 3; ++k) sides.insert(std::minmax(t[k], t[(k + 1) % 3]));
  for (const auto& [a, b] : sides)
    if (b >= m.around) m.threads.push_back(thread(m, a, b));
}

/// Straight down from the hoop.
void rein(const Meridian& line, BagModel& m) {
  for (std::int32_t n = m.around; n < m.nodes(); ++n)
    m.reins.push_back({n % m.around, n, line.length() * (n / m.around) / m.rows});
}

/// Over two nodes, around and along.
void stiffen(BagModel& m) {
  const auto node = [&m](int r, int c) { return std::int32_t(r * m.around + c % m.around); };
  for (int r = 1; r < m.rows; ++r)
    for (int c = 0; c < m.around; ++c) {
      m.bends.push_back(thread(m, node(r, c), node(r, c + 2)));
      if (r + 1 < m.rows) m.bends.push_back(thread(m, node(r - 1, c), node(r + 1, c)));
    }
}

/// @param of  (items) the numbers that belong to each
void pack(const std::vector<std::set<std::int32_t>>& of, std::vector<std::int32_t>& first,
          std::vector<std::int32_t>& all) {
  first.assign(1, 0);
  for (const std::set<std::int32_t>& numbers : of) {
    all.insert(all.end(), numbers.begin(), numbers.end());
    first.push_back(std::int32_t(all.size()));
  }
}

void index(BagModel& m) {
  std::vector<std::set<std::int32_t>> faces(m.drawn.size()), neighbours(m.drawn.size());
  for (size_t t = 0; t < m.triangles.size(); ++t)
    for (const std::int32_t a : m.triangles[t]) {
      faces[size_t(a)].insert(std::int32_t(t));
      for (const std::int32_t b : m.triangles[t])
        if (a != b) neighbours[size_t(a)].insert(b);
    }
  pack(faces, m.face_first, m.face);
  pack(neighbours, m.neighbour_first, m.neighbour);
}

}  // namespace

BagModel build(const BagDescription& d) {
  BagModel m;
  m.hoop = d.hoop;
  m.deep = d.deep;
  const Meridian line{d.hoop, d.deep - d.hoop};
  m.around = 2 * std::max(4, int(std::lround(portable::pi * d.hoop / d.spacing)));
  m.rows = std::max(4, int(std::lround(line.length() / d.spacing)));
  lay_nodes(line, m);
  m.mass = d.weight / m.nodes();
  lay_triangles(m);
  tie(m);
  rein(line, m);
  stiffen(m);
  index(m);
  return m;
}

}  // namespace trocar::interactions
