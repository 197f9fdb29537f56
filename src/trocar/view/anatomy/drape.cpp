#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/anatomy/drape.hpp>
#include <trocar/view/bodies/cavity.hpp>

namespace trocar::view {
namespace {

constexpr int kSpokes = 72, kOnRings = 18, kDrapeRings = 38;  // on the organ; all
constexpr std::size_t kTop = 5;                               // rings of its crown
constexpr std::size_t kDrapeHemRows = 16;                     // that take on the wall's normal
constexpr float kAway = 0.036f;        // [m] how far from the organ's rim its sheet reaches a wall, about
constexpr float kDrapeOver = 0.0022f;  // [m] above the organ, whose relief is that high
constexpr float kShoulder = 0.7f;      // [rad] how far the plane leans that touches the organ where the sheet leaves it
constexpr float kDrapeSunk = 0.004f;   // [m] the hem below what it runs out on
constexpr float kOnWall = 0.0015f;     // [m] ... or a wall

constexpr double kFolds = 0.0028, kFoldSize = 0.019;  // [m] depth of the furrows of an empty bladder's sheet, distance
constexpr double kLifted = 0.6;                       // share of it that the folds stand above the sheet

/// 0..1: round folds run across the sheet; the narrow furrows between them begin and end anywhere.
double furrow_at(Vec3d p) {
  const Vec3d bent = p + Vec3d{0, 0.2 * kFoldSize * waves(p, 1.6 * kFoldSize), 0};
  const double across = waves({0.45 * bent.x, bent.y, bent.z}, 1.5 * kFoldSize);
  const double there = smooth(-0.5, 0.2, waves(p + Vec3d{0.05, 0.03, 0}, 2.4 * kFoldSize));
  return there * std::pow(std::max(0.0, 1 - std::fabs(across) / 0.8), 1.6);
}

Vec3f middle_of(std::span<const Vec3f> points) {
  Vec3f sum{};
  for (const Vec3f& p : points) sum += p / float(points.size());
  return sum;
}

/// The point of the skin that lies farthest along a direction.
int farthest(std::span<const Vec3f> points, Vec3f direction) {
  int best = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    if (dot(points[i] - points[std::size_t(best)], direction) > 0) best = int(i);
  return best;
}

/// Neighbours along the ring even each other out.
void soften(std::vector<Vec3f>& ring, std::vector<Vec3f>& scratch, int passes) {
  const std::size_t n = ring.size();
  for (int pass = 0; pass < passes; ++pass) {
    scratch = ring;
    for (std::size_t i = 0; i < n; ++i)
      ring[i] = 0.5f * scratch[i] + 0.25f * (scratch[(i + 1) % n] + scratch[(i + n - 1) % n]);
  }
}

}  // namespace

Drape::Drape(const sim::Model& model, int solid, const std::vector<OrganDrawing>& organs, render::Backend& backend,
             const Detail& detail)
    : m_solid(solid) {
  const std::span<const Vec3f> skin = organs[std::size_t(solid)].positions();
  const Vec3f centre = middle_of(skin);
  m_up = normalised(vec_cast<float>(model.scope.port) - centre, Vec3f{0, 1, 0});
  const Vec3f x = any_perpendicular(m_up), y = cross(m_up, x);
  for (int k = 0; k < kSpokes; ++k) {
    const float a = float(portable::two_pi * k / kSpokes);
    Spoke spoke;
    spoke.out = std::cos(a) * x + std::sin(a) * y;
    // Where planes that lean more and more touch the organ: the sheet spans its hollows.
    for (int j = 0; j < kDrapeSupports; ++j) {
      const float lean = kShoulder * float(j) / (kDrapeSupports - 1);
      spoke.on[std::size_t(j)] = farthest(skin, std::sin(lean) * spoke.out + std::cos(lean) * m_up);
    }
    const Vec3f rim = skin[std::size_t(spoke.on.back())];
    const Vec3f goal = rim + kAway * normalised(spoke.out - 0.3f * m_up);
    float nearest = 1;
    for (const sim::WallModel& wall : model.walls)
      for (std::size_t i = 0; i < wall.skin.rest.size(); ++i)
        if (const float d = length(wall.skin.rest[i] - goal); d < nearest) {
          nearest = d;
          spoke.hem = {-1, -1, wall.skin.rest[i], wall.skin.rest_normal[i]};
        }
    for (int s = 0; s < int(organs.size()); ++s) {
      if (s == solid) continue;
      const std::span<const Vec3f> other = organs[std::size_t(s)].positions();
      for (std::size_t i = 0; i < other.size(); ++i) {
        const Vec3f way = other[i] - rim;
        const float d = length(other[i] - goal) + 0.004f;
        if (d < nearest && dot(way, spoke.out) > 0) {
          nearest = d;
          spoke.hem = {s, int(i), {}, {}};
        }
      }
    }
    m_spokes.push_back(spoke);
    for (const int organ : {solid, spoke.hem.solid})
      if (organ >= 0 && std::count(m_follows.begin(), m_follows.end(), organ) == 0) m_follows.push_back(organ);
  }
  for (int k = 0; k < kSpokes; ++k)
    for (int r = 0; r < kDrapeRings; ++r) m_buffer.add({});
  for (std::uint32_t k = 0; k < std::uint32_t(kSpokes); ++k)
    join_rows(m_buffer, (k + 1) % kSpokes * kDrapeRings, k * kDrapeRings, kDrapeRings, false);
  place(organs);
  m_buffer.rest = m_buffer.positions;
  fold();
  place(organs);
  for (int k = 0; k < kSpokes; ++k)
    for (int r = 0; r < kDrapeRings; ++r) {
      const std::size_t i = std::size_t(k * kDrapeRings + r);
      const double w = double(r) / (kDrapeRings - 1);
      const double wall = m_spokes[std::size_t(k)].hem.solid < 0 ? 1 : 0;  // on the womb it keeps its own
      // Goes over into the wall's colour; furrows lie in shade.
      const double deep = std::clamp(kLifted - double(m_fold[i]) / kFolds, 0.0, 1.0);
      m_buffer.paint[i] = {
          to_byte((1 - (0.1 + 0.18 * wall) * smooth(0.4, 0.7, w) * smooth(1, 0.85, w)) * (1 - 0.4 * deep)), 0, 0,
          to_byte(wall * smooth(0.55, 0.95, w))};
    }
  coarsen(m_buffer, detail, kBends);
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

void Drape::fold() {
  for (std::size_t i = 0; i < m_buffer.rest.size(); ++i) {
    const double w = double(i % kDrapeRings) / (kDrapeRings - 1);
    m_fold.push_back(float(kFolds * (kLifted - furrow_at(vec_cast<double>(m_buffer.rest[i]))) * smooth(0.85, 0.3, w)));
  }
}

void Drape::place(const std::vector<OrganDrawing>& organs) {
  const OrganDrawing& organ = organs[std::size_t(m_solid)];
  std::array<std::vector<Vec3f>, kDrapeSupports> on;
  m_hem.clear();
  for (const Spoke& s : m_spokes) {
    for (std::size_t j = 0; j < kDrapeSupports; ++j) on[j].push_back(organ.positions()[std::size_t(s.on[j])]);
    if (s.hem.solid < 0) {
      m_hem.push_back(s.hem.at - kOnWall * s.hem.normal);
    } else {
      const OrganDrawing& other = organs[std::size_t(s.hem.solid)];
      m_hem.push_back(other.positions()[std::size_t(s.hem.vertex)] -
                      kDrapeSunk * other.normals()[std::size_t(s.hem.vertex)]);
    }
  }
  for (std::vector<Vec3f>& ring : on) soften(ring, m_even, 5);
  soften(m_hem, m_even, 5);
  for (std::size_t k = 0; k < m_spokes.size(); ++k) {
    for (int r = 0; r < kOnRings; ++r) {  // from the top to the shoulder
      const float x = float(r) / float(kOnRings - 1) * float(kDrapeSupports - 1);
      const auto j = std::size_t(std::min(int(x), kDrapeSupports - 2));
      const float t = x - float(j), out = x / float(kDrapeSupports - 1);
      m_buffer.positions[k * kDrapeRings + std::size_t(r)] =
          (1 - t) * on[j][k] + t * on[j + 1][k] + kDrapeOver * normalised(out * m_spokes[k].out + m_up);
    }
    // It leaves the organ on its tangent, to the hem.
    const Vec3f b = m_buffer.positions[k * kDrapeRings + kOnRings - 1],
                before = m_buffer.positions[k * kDrapeRings + kOnRings - 6];
    const Vec3f slope = normalised(b - before, m_spokes[k].out), way = m_hem[k] - b;
    // On a wall it ends along it, as a fillet does: an edge there would catch the light like the rim of a dish.
    const Hem& hem = m_spokes[k].hem;
    const Vec3f flat = hem.solid < 0 ? normalised(way - dot(way, hem.normal) * hem.normal, m_spokes[k].out)
                                     : normalised(way - 0.8f * dot(way, m_up) * m_up);
    const float reach = length(way);
    for (int r = kOnRings; r < kDrapeRings; ++r) {
      const float t = float(r - kOnRings + 1) / float(kDrapeRings - kOnRings), u = 1 - t;
      Vec3f p = (u * u * (1 + 2 * t)) * b + (t * t * (3 - 2 * t)) * m_hem[k] + (0.7f * reach * u * u * t) * slope -
                (0.7f * reach * t * t * u) * flat;
      p += float(0.0011 * double(t * u) * 4 *
                 waves(vec_cast<double>(m_spokes[k].out) * 0.06 + Vec3d{0, 0, 0.01 * double(t)}, 0.02)) *
           m_up;
      m_buffer.positions[k * kDrapeRings + std::size_t(r)] = p;
    }
  }
  // Along each spoke corners are rounded, too.
  for (int pass = 0; pass < 16; ++pass)
    for (std::size_t k = 0; k < m_spokes.size(); ++k)
      for (std::size_t r = 1; r + 1 < kDrapeRings; ++r) {
        Vec3f& p = m_buffer.positions[k * kDrapeRings + r];
        p = 0.5f * p +
            0.25f * (m_buffer.positions[k * kDrapeRings + r - 1] + m_buffer.positions[k * kDrapeRings + r + 1]);
      }
  round_top();
  for (std::size_t i = 0; i < m_fold.size(); ++i) m_buffer.positions[i] += m_fold[i] * m_up;
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  Vec3f crown{};
  for (std::size_t k = 0; k < m_spokes.size(); ++k) crown += m_buffer.normals[k * kDrapeRings];
  for (std::size_t k = 0; k < m_spokes.size(); ++k) m_buffer.normals[k * kDrapeRings] = normalised(crown, m_up);
  for (std::size_t k = 0; k < m_spokes.size(); ++k)  // no seam: as the wall's at the hem
    for (std::size_t r = kDrapeRings - kDrapeHemRows; r < kDrapeRings && m_spokes[k].hem.solid < 0; ++r) {
      Vec3f& n = m_buffer.normals[k * kDrapeRings + r];
      const float w = float(smooth(0, 1, double(r + kDrapeHemRows + 1 - kDrapeRings) / kDrapeHemRows));
      const Vec3f hem = m_spokes[k].hem.normal;
      n = normalised((1 - w) * n + (dot(n, hem) < 0 ? -w : w) * hem, n);
    }
}

/// Spokes meet in a point of the organ's skin and may leave it the same way for a while: a straight crease. Their first
/// rings become a cap.
void Drape::round_top() {
  Vec3f middle{};
  for (std::size_t k = 0; k < m_spokes.size(); ++k)
    middle += m_buffer.positions[k * kDrapeRings + kTop] / float(m_spokes.size());
  const float high = dot(m_buffer.positions[0] - middle, m_up);
  for (std::size_t k = 0; k < m_spokes.size(); ++k) {
    const Vec3f rim = m_buffer.positions[k * kDrapeRings + kTop];
    for (std::size_t r = 0; r < kTop; ++r) {
      const float t = float(r) / float(kTop);
      m_buffer.positions[k * kDrapeRings + r] = middle + t * (rim - middle) + (high * (1 - t * t)) * m_up;
    }
  }
}

void Drape::update(const std::vector<OrganDrawing>& organs) {
  std::uint64_t version = 0;
  for (const int organ : m_follows) version += organs[std::size_t(organ)].version();
  if (version == m_version) return;
  m_version = version;
  place(organs);
  m_mesh.move(m_buffer.positions, m_buffer.normals);
}

}  // namespace trocar::view
