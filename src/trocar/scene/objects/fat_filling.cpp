#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/objects/fat_filling.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::scene {
namespace {

constexpr std::size_t kEnough = 4100;  // more than a body may have
constexpr int kInner = 10;             // neighbours from which on a lobule has no free face
constexpr double kNeighbour = 1.25;    // spacings, as septa reach
constexpr double kJitter = 0.12;       // of the spacing: fat is no crystal

/// Signed solid angle of a triangle, over 4 pi. [van Oosterom & Strackee 1983]
double winding(Vec3d a, Vec3d b, Vec3d c) {
  const double la = length(a), lb = length(b), lc = length(c);
  const double det = dot(a, cross(b, c));
  const double div = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return portable::atan2(det, div) / (2 * portable::pi);
}

/// A closed surface in the drawn shape.
struct Closed {
  std::vector<Vec3d> points;
  std::vector<std::array<int, 3>> triangles;
  Vec3d low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};

  void bound() {
    for (const Vec3d& p : points)
      for (int c = 0; c < 3; ++c) low[c] = std::min(low[c], p[c]), high[c] = std::max(high[c], p[c]);
  }
  bool holds(Vec3d p) const {
    for (int c = 0; c < 3; ++c)
      if (p[c] < low[c] || p[c] > high[c]) return false;
    double sum = 0;
    for (const auto& t : triangles)
      sum += winding(points[std::size_t(t[0])] - p, points[std::size_t(t[1])] - p, points[std::size_t(t[2])] - p);
    return std::fabs(sum) > 0.5;
  }
};

/// What is there already.
class Others {
 public:
  explicit Others(const sim::Model& model) : m_model(model) {
    for (int i = 0; i < model.organs(); ++i) {
      const tissue::Skin& skin = model.skin(i);
      Closed& c = m_closed.emplace_back();
      for (const Vec3f& p : skin.rest) c.points.push_back(vec_cast<double>(p));
      c.triangles.assign(skin.triangles.begin(), skin.triangles.end());
      c.bound();
    }
    for (const sim::MembraneBody& m : model.membranes) {
      if (!m.sheet.closed()) continue;
      Closed& c = m_closed.emplace_back();
      c.points = m.sheet.network.rest;
      c.triangles.assign(m.sheet.triangles.begin(), m.sheet.triangles.end());
      c.bound();
    }
  }
  /// @param margin  further than that from the surfaces of strands is outside [m]
  bool hold(Vec3d p, double margin) const {
    for (const interactions::StrandBody& body : m_model.strand_bodies)
      for (int e = 0; e + 1 < body.nodes(); ++e) {
        const Vec3d a = body.model.rest[std::size_t(e)], b = body.model.rest[std::size_t(e) + 1];
        const Vec3d at = a + geometry::closest_on_segment(p, a, b) * (b - a);
        if (length(p - at) < body.model.radius[std::size_t(e)] + margin) return true;
      }
    return std::any_of(m_closed.begin(), m_closed.end(), [p](const Closed& c) { return c.holds(p); });
  }

 private:
  const sim::Model& m_model;
  std::vector<Closed> m_closed;
};

/// The same for the same numbers, -1 .. 1.
double scattered(int i, int j, int k, int axis) {
  std::uint32_t h = std::uint32_t(i) * 73856093u ^ std::uint32_t(j) * 19349663u ^ std::uint32_t(k) * 83492791u ^
                    std::uint32_t(axis + 1) * 2654435761u;
  h ^= h >> 13, h *= 0x5bd1e995u, h ^= h >> 15;
  return double(h & 0xffff) / 32767.5 - 1;
}

std::vector<Vec3d> lattice_in(const FatSetting& s, const Others& others) {
  Vec3d low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  for (const FatSetting::Fill& f : s.fills)
    for (const Vec3d& p : f.line)
      for (int c = 0; c < 3; ++c)
        low[c] = std::min(low[c], p[c] - f.radius), high[c] = std::max(high[c], p[c] + f.radius);
  const double half = s.spacing / std::sqrt(2.0);  // of the cube's edge
  std::vector<Vec3d> out;
  const auto steps = [&](int c) { return int(std::min(1000.0, (high[c] - low[c]) / half)); };
  for (int k = 0; k <= steps(2); ++k)
    for (int j = 0; j <= steps(1); ++j)
      for (int i = (j + k) % 2; i <= steps(0); i += 2) {
        const Vec3d off{scattered(i, j, k, 0), scattered(i, j, k, 1), scattered(i, j, k, 2)};
        const Vec3d p = low + half * Vec3d{double(i), double(j), double(k)} + kJitter * s.spacing * off;
        const auto in = [p](const FatSetting::Fill& f) { return within(f, p); };
        if (std::none_of(s.fills.begin(), s.fills.end(), in) || others.hold(p, 0.35 * s.spacing)) continue;
        out.push_back(p);
        if (out.size() > kEnough) return out;
      }
  return out;
}

}  // namespace

bool within(const FatSetting::Fill& fill, Vec3d p) {
  const std::vector<Vec3d>& line = fill.line;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const Vec3d a = line[k], b = line[std::min(k + 1, line.size() - 1)];
    const Vec3d at = length(b - a) > 0 ? a + geometry::closest_on_segment(p, a, b) * (b - a) : a;
    if (length(p - at) <= fill.radius) return true;
  }
  return false;
}

FatFilling filled(const FatSetting& s, const sim::Model& model) {
  const Others others(model);
  FatFilling f;
  f.lobules = lattice_in(s, others);
  f.free.assign(f.lobules.size(), 0);
  for (std::size_t i = 0; i < f.lobules.size(); ++i) {
    int neighbours = 0;
    Vec3d out;
    for (std::size_t j = 0; j < f.lobules.size(); ++j) {
      const Vec3d way = f.lobules[i] - f.lobules[j];
      const double apart = length(way);
      if (j == i || apart > kNeighbour * s.spacing) continue;
      ++neighbours;
      out += way / apart;
    }
    if (neighbours >= kInner || !(length(out) > 0)) continue;
    f.free[i] = !others.hold(f.lobules[i] + s.spacing * normalised(out), 0.2 * s.spacing);
  }
  return f;
}

}  // namespace trocar::scene
