#include <algorithm>
#include <cmath>

#include <trocar/render/mesh_arrays.hpp>
#include <trocar/view/fat_tags.hpp>

namespace trocar::view {
namespace {

constexpr double kTwoPi = 6.28318530717959;
constexpr double kApart = 0.0055;  // [m] between two tags
constexpr int kSides = 20, kRings = 18;
constexpr int kLobes = 12;
constexpr int kParts = 3;       // drops of a tag
constexpr double kBend = 0.24;  // how fast a tag turns to hang down, a ring

Mat3f frame_at(const OrganDrawing& organ, std::uint32_t at, std::uint32_t beside) {
  const Vec3f n = organ.normals()[at], way = organ.positions()[beside] - organ.positions()[at];
  const Vec3f x = normalised(way - dot(way, n) * n, any_perpendicular(n));
  return Mat3f::from_columns(x, cross(n, x), n);
}

/// Round lobes of several sizes on a unit sphere around the tag's middle; between them the surface dips.
double lobes(Vec3d out, int seed) {
  double most = 0;
  for (int k = 0; k < kLobes; ++k) {
    const double up = 2 * varied(seed, 41 + k) - 1, turn = kTwoPi * varied(seed, 61 + k);
    const double level = std::sqrt(1 - up * up), size = 0.4 + 0.45 * varied(seed, 81 + k);
    const Vec3d centre{level * std::cos(turn), level * std::sin(turn), up};
    const double far = length(out - centre) / size;
    most = std::max(most, size * std::sqrt(std::max(0.0, 1 - 0.8 * far * far)));
  }
  return 0.66 + 0.5 * most;
}

/// A lobed drop on a stalk: from below the surface outwards, then hanging over along `down` (unit, in the same frame).
MeshBuffer drop(Vec3d down, int seed, double size) {
  MeshBuffer b;
  const double length = size * (0.007 + 0.006 * varied(seed, 21)), wide = size * (0.0024 + 0.0014 * varied(seed, 22));
  Vec3d p{0, 0, -0.0015}, along{0, 0, 1}, x{1, 0, 0};
  std::uint32_t before = 0;
  for (int i = 0; i <= kRings; ++i) {
    const double u = double(i) / kRings;
    along = normalised(along + kBend * smooth(0.05, 0.5, u) * down);
    x = normalised(x - dot(x, along) * along, any_perpendicular(along));  // carried on, so that nothing twists
    const Vec3d y = cross(along, x);
    const double bulb = std::sqrt(std::max(0.0, 1 - std::pow((u - 0.58) / 0.42, 2)));
    const double stalk = 0.5 * smooth(0.4, 0.1, u), r = wide * std::max(stalk, u > 0.16 ? bulb : 0.0);
    const Paint paint{to_byte(0.72 + 0.28 * smooth(0, 0.35, u)), 0, 0, to_byte(smooth(0.3, 0.08, u))};
    const std::uint32_t row = b.size();
    if (i == 0 || i == kRings) {
      b.add(vec_cast<float>(p), paint);
      if (i == kRings) join_pole(b, before, kSides, row, true);
    } else {
      for (int k = 0; k < kSides; ++k) {
        const double a = kTwoPi * k / kSides, c = std::cos(a), s = std::sin(a);
        const double level = std::sqrt(std::max(0.0, 1 - std::pow(2 * u - 1, 2)));
        const double lump = 1 + smooth(0.15, 0.35, u) * (lobes({level * c, level * s, 2 * u - 1}, seed) - 1);
        Paint own = paint;  // furrows between the lobes lie in shade
        own.openness = to_byte(paint.openness / 255.0 * smooth(0.55, 0.98, lump));
        b.add(vec_cast<float>(p + (r * lump) * (c * x + 0.75 * s * y) + (0.5 * wide * (lump - 1)) * along), own);
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
    down.z = std::max(down.z, -0.25);            // lies on the bowel, not in it
    for (int part = 0; part < kParts; ++part) {  // drops that hang together, the first the largest
      const int seed = kParts * k + part;
      const Vec3d aside{1.1 * (varied(seed, 32) - 0.5), 1.1 * (varied(seed, 33) - 0.5), 0};
      const float place = part == 0 ? 0.0f : 0.0016f;
      append(tag.shape, drop(normalised(down + (part == 0 ? 0.4 : 1.0) * aside), seed, part == 0 ? 1.0 : 0.72),
             Mat3f::identity(), place * vec_cast<float>(normalised(aside)));
    }
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
