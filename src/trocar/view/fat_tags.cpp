#include <algorithm>
#include <cmath>

#include <trocar/render/mesh_arrays.hpp>
#include <trocar/view/fat_tags.hpp>

namespace trocar::view {
namespace {

constexpr double kTwoPi = 6.28318530717959;
constexpr double kApart = 0.0055;  // [m] between two tags
constexpr int kSides = 12, kRings = 14;

Mat3f frame_at(const OrganDrawing& organ, std::uint32_t at, std::uint32_t beside) {
  const Vec3f n = organ.normals()[at], way = organ.positions()[beside] - organ.positions()[at];
  const Vec3f x = normalised(way - dot(way, n) * n, any_perpendicular(n));
  return Mat3f::from_columns(x, cross(n, x), n);
}

/// A lobed drop: from below the surface outwards, then hanging over along `down` (unit, in the same frame).
MeshBuffer drop(Vec3d down, int seed) {
  MeshBuffer b;
  const double length = 0.008 + 0.009 * varied(seed, 21), wide = 0.0022 + 0.0018 * varied(seed, 22);
  Vec3d p{0, 0, -0.001}, along{0, 0, 1};
  std::uint32_t before = 0;
  for (int i = 0; i <= kRings; ++i) {
    const double u = double(i) / kRings;
    along = normalised(along + 0.42 * down);
    const Vec3d x = normalised(any_perpendicular(along)), y = cross(along, x);
    const double swell = 0.55 + 0.75 * std::sin(0.5 * kTwoPi * (0.15 + 0.75 * u));
    const double r = wide * swell * std::sqrt(std::max(0.0, 1 - std::pow(std::max(0.0, (u - 0.55) / 0.45), 2)));
    const Paint paint{to_byte(0.7 + 0.3 * smooth(0, 0.4, u)), 0, 0, to_byte(smooth(0.45, 0.05, u))};
    const std::uint32_t row = b.size();
    if (i == 0 || i == kRings) {
      b.add(vec_cast<float>(p), paint);
      if (i == kRings) join_pole(b, before, kSides, row, true);
    } else {
      for (int k = 0; k < kSides; ++k) {
        const double a = kTwoPi * k / kSides;
        const double lumps = 1 + 0.12 * std::sin(3 * a + 5 * u + seed) + 0.16 * std::sin(2 * a - 9 * u + 2 * seed) +
                             0.1 * std::sin(17 * u + a + 3 * seed);
        b.add(vec_cast<float>(p + (r * lumps) * (std::cos(a) * x + 0.62 * std::sin(a) * y)), paint);
      }
      if (i == 1)
        join_pole(b, row, kSides, before, false);
      else
        join_rows(b, before, row, kSides, true);
    }
    before = row;
    p += (length / kRings) * along;
  }
  return b;
}

}  // namespace

FatTags::FatTags(const OrganDrawing& organ, const sim::SolidModel& solid, int count, Vec3d gravity,
                 render::Backend& backend, const Detail& detail) {
  const tissue::Skin& skin = solid.fine;
  for (int k = 0; k < 30 * count && int(m_tags.size()) < count; ++k) {
    const auto at = std::uint32_t(varied(k, 31) * double(skin.rest.size() - 1));
    const auto close = [&](const Tag& t) { return length(skin.rest[t.at] - skin.rest[at]) < float(kApart); };
    if (std::fabs(skin.rest_normal[at].z - 0.1f) > 0.4f || std::any_of(m_tags.begin(), m_tags.end(), close)) continue;
    Tag tag{at, std::uint32_t(skin.neighbour[std::size_t(skin.neighbour_first[at])]), {}};
    const Mat3f turn = frame_at(organ, tag.at, tag.beside);
    Vec3d down = vec_cast<double>(transposed(turn) * vec_cast<float>(normalised(gravity, Vec3d{0, 0, -1})));
    down.z = std::max(down.z, -0.25);  // lies on the bowel, not in it
    tag.shape = drop(normalised(down + Vec3d{0.5 * (varied(k, 32) - 0.5), 0.5 * (varied(k, 33) - 0.5), 0}), k);
    m_tags.push_back(std::move(tag));
  }
  for (const Tag& tag : m_tags) append(m_buffer, tag.shape, Mat3f::identity(), {});
  place(organ);
  m_buffer.rest = m_buffer.positions;
  coarsen(m_buffer, detail, kBends);
  if (!m_tags.empty()) m_mesh = OwnedMesh(backend, m_buffer.data());
}

void FatTags::place(const OrganDrawing& organ) {
  std::size_t v = 0;
  for (const Tag& tag : m_tags) {
    const Mat3f turn = frame_at(organ, tag.at, tag.beside);
    for (const Vec3f& p : tag.shape.positions) m_buffer.positions[v++] = organ.positions()[tag.at] + turn * p;
  }
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
}

void FatTags::update(const OrganDrawing& organ) {
  if (m_tags.empty()) return;
  place(organ);
  m_mesh.move(m_buffer.positions, m_buffer.normals);
}

}  // namespace trocar::view
