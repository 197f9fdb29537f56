#include <algorithm>
#include <cmath>

#include <trocar/render/mesh_arrays.hpp>
#include <trocar/view/cavity.hpp>
#include <trocar/view/drape.hpp>

namespace trocar::view {
namespace {

constexpr int kSpokes = 72, kRings = 16;
constexpr float kAway = 0.036f;   // [m] how far from the organ's rim its sheet reaches a wall, about
constexpr float kOver = 0.0008f;  // [m] above the organ
constexpr float kSunk = 0.004f;   // [m] the hem below what it runs out on
constexpr double kTwoPi = 6.28318530717959;

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

Drape::Drape(const sim::Model& model, int solid, const std::vector<OrganDrawing>& organs, render::Backend& backend)
    : m_solid(solid) {
  const std::span<const Vec3f> skin = organs[std::size_t(solid)].positions();
  const Vec3f centre = middle_of(skin);
  m_up = normalised(vec_cast<float>(model.scope.port) - centre, Vec3f{0, 1, 0});
  const Vec3f x = any_perpendicular(m_up), y = cross(m_up, x);
  for (int k = 0; k < kSpokes; ++k) {
    const float a = float(kTwoPi * k / kSpokes);
    Spoke spoke;
    spoke.out = std::cos(a) * x + std::sin(a) * y;
    spoke.crown = farthest(skin, spoke.out + 3.0f * m_up);
    spoke.shoulder = farthest(skin, spoke.out + 1.1f * m_up);
    const Vec3f rim = skin[std::size_t(spoke.shoulder)];
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
  }
  for (int k = 0; k < kSpokes; ++k)
    for (int r = 0; r < kRings; ++r) m_buffer.add({});
  for (std::uint32_t k = 0; k < std::uint32_t(kSpokes); ++k)
    join_rows(m_buffer, (k + 1) % kSpokes * kRings, k * kRings, kRings, false);
  place(organs);
  m_buffer.rest = m_buffer.positions;
  for (int k = 0; k < kSpokes; ++k)
    for (int r = 0; r < kRings; ++r) {
      const std::size_t i = std::size_t(k * kRings + r);
      const double w = double(r) / (kRings - 1);
      const double fat = fat_below(vec_cast<double>(m_buffer.positions[i]));
      m_buffer.paint[i] = {to_byte(1 - 0.35 * smooth(0.4, 1, w)), 0, 0, to_byte(smooth(0, 0.5, w) * (0.25 + fat))};
    }
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

void Drape::place(const std::vector<OrganDrawing>& organs) {
  const OrganDrawing& organ = organs[std::size_t(m_solid)];
  std::vector<Vec3f> crown, shoulder;
  m_hem.clear();
  for (const Spoke& s : m_spokes) {
    crown.push_back(organ.positions()[std::size_t(s.crown)]);
    shoulder.push_back(organ.positions()[std::size_t(s.shoulder)]);
    if (s.hem.solid < 0) {
      m_hem.push_back(s.hem.at - kSunk * s.hem.normal);
    } else {
      const OrganDrawing& other = organs[std::size_t(s.hem.solid)];
      m_hem.push_back(other.positions()[std::size_t(s.hem.vertex)] -
                      kSunk * other.normals()[std::size_t(s.hem.vertex)]);
    }
  }
  soften(crown, m_even, 6);
  soften(shoulder, m_even, 4);
  soften(m_hem, m_even, 3);
  for (std::size_t k = 0; k < m_spokes.size(); ++k) {
    const Vec3f a = crown[k] - 0.0015f * m_up, b = shoulder[k] + kOver * normalised(m_spokes[k].out + m_up),
                c = m_hem[k];
    // From the crown over the shoulder, leaving the organ on its tangent, to the hem.
    const Vec3f slope = normalised(b - a), way = c - b;
    const float reach = length(way);
    for (int r = 0; r < kRings; ++r) {
      const float w = float(r) / float(kRings - 1);
      Vec3f p;
      if (w < 0.2f) {
        p = a + (w / 0.2f) * (b - a);
      } else {
        const float t = (w - 0.2f) / 0.8f, u = 1 - t;
        const Vec3f flat = normalised(way - 0.8f * dot(way, m_up) * m_up);
        p = (u * u * (1 + 2 * t)) * b + (t * t * (3 - 2 * t)) * c + (0.7f * reach * u * u * t) * slope -
            (0.7f * reach * t * t * u) * flat;
        p += float(0.0011 * double(t * u) * 4 *
                   waves(vec_cast<double>(m_spokes[k].out) * 0.06 + Vec3d{0, 0, 0.01 * t}, 0.02)) *
             m_up;
      }
      m_buffer.positions[k * kRings + std::size_t(r)] = p;
    }
  }
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
}

void Drape::update(const std::vector<OrganDrawing>& organs) {
  place(organs);
  m_mesh.move(m_buffer.positions, m_buffer.normals);
}

}  // namespace trocar::view
