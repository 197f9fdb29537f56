#include <algorithm>
#include <cmath>

#include <trocar/render/mesh_arrays.hpp>
#include <trocar/view/fat_tags.hpp>

namespace trocar::view {
namespace {

constexpr double kTwoPi = 6.28318530717959;
constexpr double kApart = 0.012;                    // [m] between two tags of middle size
constexpr double kSunk = 0.0022;                    // [m] a tag's foot lies below the skin
constexpr float kAround = 0.02f, kUnder = 0.0009f;  // [m] skin around a tag; the foot's edge lies below it
constexpr float kFarthestPull = 0.0036f;            // [m] of a foot down to the skin
constexpr int kSides = 22, kRings = 15;
constexpr int kLobes = 13;
constexpr int kParts = 3;       // flaps of a tag, at most
constexpr double kBend = 0.42;  // how fast a tag turns to hang down, a ring

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
    const double level = std::sqrt(1 - up * up), size = 0.45 + 0.3 * varied(seed, 81 + k);
    const Vec3d centre{level * std::cos(turn), level * std::sin(turn), up};
    const double far = length(out - centre) / size;
    most = std::max(most, (0.4 + size) * std::sqrt(std::max(0.0, 1 - 0.9 * far * far)));
  }
  return 0.62 + 0.5 * most;
}

/// How wide a flap is at `u` (0 foot .. 1 tip), of its width: a stalk, then a body with a round end.
double profile(double u) {
  const double body = std::sqrt(std::max(0.0, 1 - std::pow(std::max(0.0, u - 0.68) / 0.32, 2)));
  return body * (0.42 + 0.66 * smooth(0.22, 0.62, u));
}

/// Its foot runs out on the bowel: how much wider it is `high` above the skin [m], of its width.
double skirt(double high) {
  const double t = std::clamp((0.0026 - high) / (0.0026 + kSunk), 0.0, 1.0);
  return 1.1 * t * t;
}

/// A lobed flap of fat: broad on the bowel, then hanging over along `down` (unit, in the same frame), flat as it lies.
MeshBuffer flap(Vec3d down, int seed, double size) {
  MeshBuffer b;
  const double length = size * (0.0085 + 0.006 * varied(seed, 21)), wide = size * (0.0036 + 0.0022 * varied(seed, 22));
  const double flat = 0.32 + 0.2 * varied(seed, 23), turned = 1.1 * (varied(seed, 24) - 0.5);
  const Vec3d across = normalised(Vec3d{-down.y, down.x, 0}, Vec3d{1, 0, 0}), hangs{across.y, -across.x, 0};
  Vec3d p{0, 0, -kSunk}, along = normalised(Vec3d{0.7 * down.x, 0.7 * down.y, 1}),
                         x = std::cos(turned) * across + std::sin(turned) * hangs;
  std::uint32_t before = 0;
  for (int i = 0; i <= kRings; ++i) {
    const double u = double(i) / kRings;
    along = normalised(along + kBend * smooth(0.15, 0.6, u) * down);
    x = normalised(x - dot(x, along) * along, any_perpendicular(along));  // carried on, so that nothing twists
    const Vec3d y = cross(along, x);
    const double r = wide * (profile(u) + (1 - u) * skirt(p.z));
    const Paint paint{to_byte(0.8 + 0.2 * smooth(0, 0.3, u)), 0, 0, to_byte(smooth(0.45, 0.22, u))};
    const std::uint32_t row = b.size();
    if (i == 0 || i == kRings) {
      b.add(vec_cast<float>(p), paint);
      if (i == kRings) join_pole(b, before, kSides, row, true);
    } else {
      for (int k = 0; k < kSides; ++k) {
        const double a = kTwoPi * k / kSides, c = std::cos(a), s = std::sin(a);
        const double level = std::sqrt(std::max(0.0, 1 - std::pow(2 * u - 1, 2)));
        const double lump = 1 + smooth(0.2, 0.45, u) * (lobes({level * c, level * s, 2 * u - 1}, seed) - 1);
        Paint own = paint;  // furrows between the lobes lie in shade
        own.openness = to_byte(paint.openness / 255.0 * (0.7 + 0.3 * smooth(0.75, 1.05, lump)));
        b.add(vec_cast<float>(p + (r * lump) * (c * x + flat * s * y) + (0.5 * wide * (lump - 1)) * along), own);
      }
      if (i == 1)
        join_pole(b, row, kSides, before, false);
      else
        join_rows(b, before, row, kSides, true);
    }
    before = row;
    p += ((length + kSunk) / kRings) * along;
  }
  return b;
}

/// One to three flaps that hang together, side by side, the first the largest.
MeshBuffer tag_shape(Vec3d down, int seed, double size) {
  MeshBuffer shape;
  const int parts = 1 + int(varied(seed, 34) * (size > 1.2 ? kParts - 0.01 : 1.7));
  for (int part = 0; part < parts; ++part) {
    const int own = kParts * seed + part;
    const double side = varied(own, 32) < 0.5 ? -1 : 1, slant = 0.8 * (varied(own, 37) - 0.5);
    const Vec3d level = normalised(Vec3d{-down.y, down.x, 0}, Vec3d{1, 0, 0});
    const Vec3d aside = side * normalised(level + slant * Vec3d{level.y, -level.x, 0});
    const double place = part == 0 ? 0 : size * (0.0034 + 0.0026 * varied(own, 33));
    append(shape, flap(normalised(down + (part == 0 ? 0.2 : 0.5) * aside), own, size * (part == 0 ? 1.0 : 0.75)),
           Mat3f::identity(), vec_cast<float>(place * aside));
  }
  return shape;
}

/// The foot (what is tinted) comes to lie on the skin around, wherever that bends away.
/// @return how far that pulled it at most [m]
float lay_on(const OrganDrawing& organ, std::uint32_t at, const Mat3f& turn, MeshBuffer& shape) {
  const std::span<const Vec3f> skin = organ.positions();
  std::vector<std::uint32_t> near;
  for (std::uint32_t v = 0; v < skin.size(); ++v)
    if (length(skin[v] - skin[at]) < kAround) near.push_back(v);
  float farthest = 0;
  for (std::uint32_t i = 0; i < shape.size(); ++i) {
    if (shape.paint[i].tint == 0) continue;
    const Vec3f p = skin[at] + turn * shape.positions[i];
    const std::uint32_t v = *std::min_element(near.begin(), near.end(), [&](std::uint32_t a, std::uint32_t b) {
      return length(skin[a] - p) < length(skin[b] - p);
    });
    const Vec3f n = organ.normals()[v];
    const float high = dot(p - skin[v], n) + kUnder;
    if (high <= 0) continue;
    const float pulled = high * float(shape.paint[i].tint) / 255;
    shape.positions[i] -= transposed(turn) * (pulled * n);
    farthest = std::max(farthest, pulled);
  }
  return farthest;
}

}  // namespace

FatTags::FatTags(const OrganDrawing& organ, const sim::SolidModel& solid, int count, Vec3d gravity,
                 render::Backend& backend, const Detail& detail) {
  const tissue::Skin& skin = solid.fine;
  for (int k = 0; k < 40 * count && int(m_tags.size()) < count; ++k) {
    const auto at = std::uint32_t(varied(k, 31) * double(skin.rest.size() - 1));
    const double size = 0.9 + 1.5 * varied(k, 35) * varied(k, 36);  // a few large ones among small
    const auto close = [&](const Tag& t) {
      return length(skin.rest[t.at] - skin.rest[at]) < float(kApart * 0.5 * (size + t.size));
    };
    if (std::fabs(skin.rest_normal[at].z - 0.1f) > 0.4f || std::any_of(m_tags.begin(), m_tags.end(), close)) continue;
    Tag tag{at, std::uint32_t(skin.neighbour[std::size_t(skin.neighbour_first[at])]), size, {}};
    const Mat3f turn = frame_at(organ, tag.at, tag.beside);
    Vec3d down = vec_cast<double>(transposed(turn) * vec_cast<float>(normalised(gravity, Vec3d{0, 0, -1})));
    down.z = std::max(down.z, -0.25);  // lies on the bowel, not in it
    tag.shape = tag_shape(down, k, size);
    if (lay_on(organ, tag.at, turn, tag.shape) > kFarthestPull) continue;  // in a groove: it would be a scrap
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
  if (m_tags.empty() || m_version == organ.version()) return;
  m_version = organ.version();
  place(organ);
  m_mesh.move(m_buffer.positions, m_buffer.normals);
}

}  // namespace trocar::view
