#include <algorithm>
#include <cmath>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/anatomy/fat_tags.hpp>
#include <trocar/view/anatomy/lobules.hpp>
#include <trocar/view/base/relief.hpp>

namespace trocar::view {
namespace {

constexpr double kTagApart = 0.014;          // [m] between two tags of middle size
constexpr double kLow = -0.25, kHigh = 0.7;  // sine of the skin's slope: they hang on its sides
constexpr double kTagSunk = 0.0012;          // [m] a tag's border lies below the skin
constexpr float kTagAround = 0.03f;          // [m] skin around a tag's middle
constexpr float kTagFarthest = 0.0032f;  // [m] that the skin may bend away below its base: none on the narrow rectum
constexpr float kTagReach = 0.009f;      // [m] the same and an edge of the skin
constexpr int kTagSides = 48, kTagRings = 18;
constexpr double kTagTip = 0.34;  // of the way from the border to the middle: so far out it hangs the lowest

Mat3f frame_at(const OrganDrawing& organ, std::uint32_t at, std::uint32_t beside) {
  const Vec3f n = organ.normals()[at], way = organ.positions()[beside] - organ.positions()[at];
  const Vec3f x = normalised(way - dot(way, n) * n, any_perpendicular(n));
  return Mat3f::from_columns(x, cross(n, x), n);
}

/// The skin that a tag may lie on.
class TagGround {
 public:
  TagGround(const OrganDrawing& organ, const tissue::Skin& skin, std::uint32_t at) : m_organ(&organ) {
    const Vec3f middle = organ.positions()[at];
    for (const auto& t : skin.triangles)
      if (length(organ.positions()[std::size_t(t[0])] - middle) < kTagAround)
        m_triangles.push_back({std::uint32_t(t[0]), std::uint32_t(t[1]), std::uint32_t(t[2])});
  }

  /// The nearest place to a point; its weights are 0 where none is near.
  FatTags::OnSkin below(Vec3f p) const {
    FatTags::OnSkin best;
    float nearest = 1e9f;
    for (const auto& t : m_triangles) {
      const std::span<const Vec3f> x = m_organ->positions();
      if (length(x[t[0]] - p) > kTagReach) continue;
      const auto found = geometry::closest_on_triangle(p, x[t[0]], x[t[1]], x[t[2]]);
      if (found.distance2 >= nearest) continue;
      nearest = found.distance2;
      best = {t, found.weights};
    }
    return best;
  }

 private:
  const OrganDrawing* m_organ;
  std::vector<std::array<std::uint32_t, 3>> m_triangles;
};

Vec3f mixed(const FatTags::OnSkin& on, std::span<const Vec3f> of) {
  return on.weight.x * of[on.corner[0]] + on.weight.y * of[on.corner[1]] + on.weight.z * of[on.corner[2]];
}

/// What one tag is like.
struct Form {
  Vec3d level, low, down;         ///< unit: along the bowel, down on its skin, as things hang
  double wide, tall, high, hang;  ///< [m] its base, from its middle; its height; how far its tongues hang over
  int seed;

  /// From the middle of its base to its border. @param turn 0: along the bowel, a quarter: downwards [rad]
  double border(double turn) const {
    const double c = std::cos(turn), s = std::sin(turn);
    const double ragged = waves({c, s, 0.7 * seed}, 2.1) + 0.6 * waves({c, s, 0.7 * seed + 0.3}, 0.9);
    return (1 + 0.2 * ragged) / std::sqrt(c * c / (wide * wide) + s * s / (tall * tall));
  }
  /// How far it hangs over there, none upwards, [m] where it hangs the lowest.
  double over(double turn) const { return hang * smooth(-0.1, 0.8, std::sin(turn)); }
  /// Its lower border is one of tongues: share of how far it hangs over.
  double tongue(double turn) const {
    return 0.25 + 0.9 * lobules({border(turn) * std::cos(turn), 0.013 * seed, 0}, 0.008);
  }
};

/// A tag's surface above its base, as a map from a disc: from its border (0), which lies below the skin, to its top
/// (1).
struct Bulge {
  double out, high, over;  ///< share of the way to the border; [m] above the skin; [m] along what hangs
  double openness = 1;     ///< less below what hangs over
};

Bulge bulge(const Form& form, double turn, double t) {
  const double over = form.over(turn), steep = smooth(0, 0.6 * form.hang, over);
  const double flat = smooth(0, 1, t), round = std::sin(0.25 * portable::two_pi * std::min(1.0, t / 0.75));
  const double rise = (1 - steep) * flat + steep * round;
  const double tip = t < kTagTip ? std::sin(0.25 * portable::two_pi * t / kTagTip) : smooth(1, kTagTip, t);
  const double tongue = 0.65 + (form.tongue(turn) - 0.65) * tip * tip;
  return {1 - t, -kTagSunk + (form.high + kTagSunk) * rise, over * tip * tongue,
          1 - 0.5 * steep * smooth(kTagTip, 0, t)};
}

/// The shape on the skin as it lies now; where each of its vertices is above the skin.
struct Grown {
  MeshBuffer shape;
  std::vector<FatTags::OnSkin> on;
  std::vector<double> high;  ///< about how far from the skin [m]
  bool fits = true;          ///< on the skin, all of it
};

void add(Grown& grown, const Form& form, const TagGround& ground, const OrganDrawing& organ, Vec3f middle, double turn,
         const Bulge& at) {
  const double r = at.out * form.border(turn);
  const Vec3f base = middle + vec_cast<float>(r * (std::cos(turn) * form.level + std::sin(turn) * form.low));
  const FatTags::OnSkin on = ground.below(base);
  const Vec3f skin = mixed(on, organ.positions()), n = normalised(mixed(on, organ.normals()));
  grown.fits = grown.fits && dot(on.weight, on.weight) > 0 && length(skin - base) < kTagFarthest;
  grown.shape.add(skin + float(at.high) * n + vec_cast<float>(at.over * form.down), {to_byte(at.openness), 0, 0, 0});
  grown.on.push_back(on);
  grown.high.push_back(at.high + 0.5 * at.over);
}

/// Lobes, lobules on them, grooves in shade; at its border it takes on what it grows out of.
void make_lobes(Grown& grown) {
  MeshBuffer& b = grown.shape;
  render::vertex_normals(b.positions, b.indices, b.normals);
  for (std::size_t i = 0; i < b.positions.size(); ++i) {
    const Vec3d p = vec_cast<double>(b.positions[i]);
    const double lobe = lobules(p + Vec3d{0.4, 0.1, 0.2}, 0.0095), lobule = lobules(p + Vec3d{0.1, 0.5, 0.3}, 0.0048);
    const double grown_out = smooth(0.0002, 0.003, grown.high[i]), rounded = smooth(0.0006, 0.0034, grown.high[i]);
    const double groove = std::max((1 - lobe) * (1 - lobe), 0.7 * (1 - lobule) * (1 - lobule));
    const double patch = smooth(0.2, 0.9, waves(p + Vec3d{0.3, 0.3, 0}, 0.02));
    b.positions[i] += float(rounded * (0.0018 * (lobe - 0.4) + 0.0016 * (lobule - 0.4))) * b.normals[i];
    b.paint[i].openness = to_byte(b.paint[i].openness / 255.0 * (1 - grown_out * 0.45 * groove));
    b.paint[i].tint = to_byte(std::max({1 - grown_out, 0.3 * patch, 0.35 * groove}));
  }
}

/// @param middle where it grows out, on the skin
Grown grow(const Form& form, const TagGround& ground, const OrganDrawing& organ, Vec3f middle) {
  Grown grown;
  add(grown, form, ground, organ, middle, 0, {0, -kTagSunk, 0});  // closes it, below the skin
  std::uint32_t before = 0;
  for (int i = 0; i < kTagRings; ++i) {
    const std::uint32_t row = grown.shape.size();
    for (int k = 0; k < kTagSides; ++k) {
      const double turn = portable::two_pi * k / kTagSides;
      add(grown, form, ground, organ, middle, turn, bulge(form, turn, double(i) / kTagRings));
    }
    if (!grown.fits) return grown;
    if (i == 0)
      join_pole(grown.shape, row, kTagSides, before, false);
    else
      join_rows(grown.shape, before, row, kTagSides, true);
    before = row;
  }
  const std::uint32_t top = grown.shape.size();
  add(grown, form, ground, organ, middle, 0, {0, form.high, 0});
  join_pole(grown.shape, before, kTagSides, top, true);
  make_lobes(grown);
  return grown;
}

Form form_of(Vec3d down, Vec3d normal, int seed, double size) {
  Form form;
  form.low = normalised(down - dot(down, normal) * normal, any_perpendicular(normal));
  form.level = cross(form.low, normal);
  const double out = std::max(dot(down, normal), -0.25);  // lies on the bowel, not in it
  form.down = normalised(down + (out - dot(down, normal)) * normal);
  form.wide = size * (0.0075 + 0.004 * varied(seed, 21));
  form.tall = size * (0.0044 + 0.0016 * varied(seed, 22));
  form.high = size * (0.0024 + 0.0012 * varied(seed, 23));
  form.hang = size * (0.007 + 0.008 * varied(seed, 24));
  form.seed = seed;
  return form;
}

}  // namespace

FatTags::FatTags(const OrganDrawing& organ, const sim::SolidModel& solid, int count, Vec3d gravity,
                 render::Backend& backend, const Detail& detail) {
  const tissue::Skin& skin = solid.fine;
  const Vec3d down = normalised(gravity, Vec3d{0, 0, -1});
  std::vector<double> sizes;
  for (int k = 0; k < 60 * count && int(m_tags.size()) < count; ++k) {
    const auto at = std::uint32_t(varied(k, 31) * double(skin.rest.size() - 1));
    const double size = 0.95 + 0.8 * varied(k, 35) * varied(k, 36);  // a few large ones among small
    const Vec3d normal = vec_cast<double>(organ.normals()[at]);
    const double slope = -dot(normal, down);
    bool free = slope > kLow && slope < kHigh;
    for (std::size_t i = 0; free && i < m_tags.size(); ++i)
      free = length(skin.rest[m_tags[i].at] - skin.rest[at]) > float(kTagApart * 0.5 * (size + sizes[i]));
    if (!free) continue;
    Grown grown = grow(form_of(down, normal, k, size), TagGround(organ, skin, at), organ, organ.positions()[at]);
    if (!grown.fits) continue;
    Tag tag{at, std::uint32_t(skin.neighbour[std::size_t(skin.neighbour_first[at])]), std::move(grown.on), {}};
    const Mat3f turn = transposed(frame_at(organ, tag.at, tag.beside));
    for (std::size_t i = 0; i < tag.on.size(); ++i)
      tag.off.push_back(turn * (grown.shape.positions[i] - mixed(tag.on[i], organ.positions())));
    m_tags.push_back(std::move(tag));
    sizes.push_back(size);
    append(m_buffer, grown.shape, Mat3f::identity(), {});
  }
  place(organ);
  m_buffer.rest = m_buffer.positions;
  coarsen(m_buffer, detail, kBends);
  if (!m_tags.empty()) m_mesh = OwnedMesh(backend, m_buffer.data());
}

void FatTags::place(const OrganDrawing& organ) {
  std::size_t v = 0;
  for (const Tag& tag : m_tags) {
    const Mat3f turn = frame_at(organ, tag.at, tag.beside);
    for (std::size_t i = 0; i < tag.on.size(); ++i)
      m_buffer.positions[v++] = mixed(tag.on[i], organ.positions()) + turn * tag.off[i];
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
