#include <algorithm>
#include <cmath>

#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/anatomy/lobules.hpp>
#include <trocar/view/anatomy/omentum_lobe.hpp>
#include <trocar/view/base/relief.hpp>

namespace trocar::view {
namespace {

constexpr std::size_t kLobeRows = 32;   // from the border to the root
constexpr double kLobeNear = 0.009;     // [m] aside: further points carry nothing
constexpr double kCapRadius = 0.01;     // [m] each point carries it like a ball of that radius: no steps
constexpr double kHighest = 0.06;       // [m] what is so far above is beside or over it, not below
constexpr int kLobeSlack = 14;          // passes: the more, the tauter it spans from one loop to the next
constexpr double kLobeTucked = 0.0022;  // [m] the border's underside below its upper one
constexpr double kCrowding = 1.7;       // rows crowd towards the border

/// How far from the border to the root a row lies, 0 .. 1.
double share_of(std::size_t row) { return std::pow(double(row) / (kLobeRows - 1), kCrowding); }

/// Tongues and frills [m] outwards.
double ragged(Vec3d p) {
  return 0.005 * waves(p, 0.05) + 0.0045 * waves(p + Vec3d{0.2, 0, 0.1}, 0.017) +
         0.0026 * lobules(p + Vec3d{0.3, 0.2, 0}, 0.009);
}

/// What its fat is like in a place.
struct LobeFat {
  double thick = 0;   ///< [m]
  double groove = 0;  ///< 1 between lobules
};

/// A thin sheet with unequal lobules in it, fewer of them in places; its border is a lip. @param deep [m] inside that
LobeFat lobe_fat(Vec3d p, double deep) {
  const double lip = 0.0016 * (1 - std::exp(-deep / 0.0012)), grown = smooth(-0.002, 0.006, deep);
  const double marked = 0.45 + 0.55 * smooth(-0.5, 0.4, waves(p + Vec3d{0.2, 0.6, 0.4}, 0.034));
  const double lobe = lobules(p + Vec3d{0.4, 0.1, 0.2}, 0.015), lobule = lobules(p + Vec3d{0.1, 0.5, 0.3}, 0.0068);
  return {lip + grown * (0.0030 * lobe + 0.0027 * marked * lobule),
          std::max(0.55 * (1 - lobe) * (1 - lobe), marked * (1 - lobule) * (1 - lobule))};
}

Paint paint_of(const LobeFat& fat, double deep) {
  Paint paint;
  paint.openness = to_byte(1 - 0.32 * fat.groove);
  paint.tint = to_byte(std::max(0.45 * fat.groove, 0.6 * smooth(0.005, 0, deep)));  // pinker: thin there
  return paint;
}

/// Its rows and columns, laid on what is below.
class Sheet {
 public:
  Sheet(const LobeOutline& outline, std::span<const Vec3d> below, Vec3d up)
      : m_columns(outline.border.size()), m_up(up), m_floor(m_columns * kLobeRows), m_points(m_floor.size()) {
    for (std::size_t j = 0; j < m_columns; ++j) {
      const Vec3d in = normalised(outline.root[j] - outline.border[j]);
      const Vec3d border = outline.border[j] - ragged(outline.border[j]) * in;
      for (std::size_t i = 0; i < kLobeRows; ++i)
        m_points[i * m_columns + j] = border + share_of(i) * (outline.root[j] - border);
    }
    lay(below);
    for (int pass = 0; pass < kLobeSlack; ++pass) span();
    for (std::size_t j = 0; j < m_columns; ++j) space_out(j);
  }

  MeshBuffer drawn() const {
    MeshBuffer b;
    for (const Vec3d& p : m_points) b.add(vec_cast<float>(p));
    const auto row = std::uint32_t(m_columns);
    for (std::uint32_t i = 0; i + 1 < kLobeRows; ++i) join_rows(b, i * row, (i + 1) * row, row, false);
    render::vertex_normals(b.positions, b.indices, b.normals);
    if (dot(vec_cast<double>(b.normals[b.size() / 2]), m_up) < 0) turn(b);
    for (std::size_t v = 0; v < m_points.size(); ++v) thicken(b, v);
    b.rest = b.positions;
    render::vertex_normals(b.positions, b.indices, b.normals);
    return b;
  }

 private:
  static void turn(MeshBuffer& b) {
    for (std::size_t t = 0; t + 2 < b.indices.size(); t += 3) std::swap(b.indices[t], b.indices[t + 1]);
    for (Vec3f& n : b.normals) n = -n;
  }

  void thicken(MeshBuffer& b, std::size_t v) const {
    const Vec3d p = m_points[v];
    const double deep = length(p - m_points[v % m_columns]);
    const LobeFat fat = lobe_fat(p, deep);
    const double out = v < m_columns ? -kLobeTucked : fat.thick;
    b.positions[v] = vec_cast<float>(p + out * vec_cast<double>(b.normals[v]));
    b.paint[v] = paint_of(fat, deep);
  }

  void lay(std::span<const Vec3d> below) {
    for (std::size_t v = 0; v < m_points.size(); ++v) {
      double high = -1;
      for (const Vec3d& q : below) {
        const Vec3d way = q - m_points[v];
        const double rise = dot(way, m_up), aside2 = dot(way, way) - rise * rise;
        if (aside2 < kLobeNear * kLobeNear && rise < kHighest) high = std::max(high, rise - aside2 / (2 * kCapRadius));
      }
      if (high > -1) m_points[v] += high * m_up;
      m_floor[v] = dot(m_points[v], m_up);
    }
  }

  /// Nowhere below its ground, elsewhere as high as what is around.
  void span() {
    const std::vector<Vec3d> before = m_points;
    const auto high = [&](std::size_t i, std::size_t j) { return dot(before[i * m_columns + j], m_up); };
    for (std::size_t i = 0; i + 1 < kLobeRows; ++i)
      for (std::size_t j = 0; j < m_columns; ++j) {
        const double around = 0.25 * (high(i > 0 ? i - 1 : 1, j) + high(i + 1, j) + high(i, j > 0 ? j - 1 : 1) +
                                      high(i, j + 1 < m_columns ? j + 1 : j - 1));
        const std::size_t v = i * m_columns + j;
        m_points[v] += (std::max(m_floor[v], around) - high(i, j)) * m_up;
      }
  }

  /// Where a column goes steeply down, its rows are as near to each other as elsewhere.
  void space_out(std::size_t j) {
    std::vector<Vec3d> before;
    std::vector<double> way{0};
    for (std::size_t i = 0; i < kLobeRows; ++i) before.push_back(m_points[i * m_columns + j]);
    for (std::size_t i = 1; i < kLobeRows; ++i) way.push_back(way.back() + length(before[i] - before[i - 1]));
    for (std::size_t i = 0, k = 0; i < kLobeRows; ++i) {
      const double far = share_of(i) * way.back();
      while (k + 2 < kLobeRows && way[k + 1] < far) ++k;
      const double t = (far - way[k]) / std::max(way[k + 1] - way[k], 1e-9);
      m_points[i * m_columns + j] = before[k] + t * (before[k + 1] - before[k]);
    }
  }

  std::size_t m_columns;
  Vec3d m_up;
  std::vector<double> m_floor;  ///< [m] along up
  std::vector<Vec3d> m_points;
};

}  // namespace

MeshBuffer omentum_lobe(const LobeOutline& outline, std::span<const Vec3d> below, Vec3d up) {
  if (outline.border.size() < 2 || below.empty()) return {};
  return Sheet(outline, below, up).drawn();
}

}  // namespace trocar::view
