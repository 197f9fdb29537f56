#include <algorithm>
#include <cmath>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/anatomy/joint.hpp>
#include <trocar/view/bodies/cavity.hpp>

namespace trocar::view {
namespace {

constexpr int kCollarRows = 10;           // strand to organ
constexpr double kCollarSkirt = 0.0018;   // [m] of the organ's surface that the collar covers, and ...
constexpr double kSkirtRadii = 1.1;       // ... so many of the strand's radii
constexpr double kWallSkirt = 0.008;      // [m] the same of a wall
constexpr double kCollarSteepest = 0.55;  // sine of the flattest angle at which a strand is taken to meet the surface
constexpr float kCollarTucked = 0.0003f;  // [m] the border lies below the surface
constexpr float kCollarClear = 0.00015f;  // [m] the rest above it

template <class T>
T mixed(const std::array<std::uint32_t, 3>& vertex, Vec3f share, std::span<const T> of) {
  return share.x * of[vertex[0]] + share.y * of[vertex[1]] + share.z * of[vertex[2]];
}

}  // namespace

Joint::Foot Joint::foot_at(Vec3d p, const OrganDrawing& organ, const tissue::Skin& skin) const {
  Foot best;
  double nearest = 1e9;
  for (const auto& t : skin.triangles) {
    const auto corner = [&](std::size_t k) { return vec_cast<double>(organ.positions()[std::size_t(t[k])]); };
    const auto at = geometry::closest_on_triangle(p, corner(0), corner(1), corner(2));
    if (at.distance2 >= nearest) continue;
    nearest = at.distance2;
    best.share = vec_cast<float>(at.weights);
    for (std::size_t k = 0; k < 3; ++k) best.vertex[k] = std::uint32_t(t[k]);
  }
  return best;
}

Joint::Meeting Joint::meeting(const TubeNeck& neck, Vec3d at, Vec3d n) {
  // A flat approach is taken as less flat.
  Vec3d way = neck.along;
  if (dot(way, -n) < kCollarSteepest) {
    const Vec3d flat = normalised(way - dot(way, n) * n, any_perpendicular(n));
    way = std::sqrt(1 - kCollarSteepest * kCollarSteepest) * flat - kCollarSteepest * n;
  }
  return {neck.centre + (dot(at - neck.centre, n) / dot(way, n)) * way, n, way};
}

/// A point of the strand's section, carried along the strand to the plane, and on by the skirt.
Vec3d Joint::aside(const Meeting& m, const TubeNeck& neck, std::size_t k, double skirt) {
  const Vec3d out = vec_cast<double>(neck.ring[k]) - neck.centre;
  const Vec3d on_plane = out - (dot(out, m.normal) / dot(m.way, m.normal)) * m.way;
  return m.entry + on_plane + skirt * normalised(on_plane);
}

Joint::Joint(const TubeDrawing& tube, bool at_start, const OrganDrawing& organ, const tissue::Skin& skin,
             render::Backend& backend, const Detail& detail)
    : m_at_start(at_start), m_sides(tube.sides()) {
  const TubeNeck& neck = tube.neck(at_start);
  const Foot middle = foot_at(neck.end, organ, skin);
  const Meeting m = meeting(neck, vec_cast<double>(mixed(middle.vertex, middle.share, organ.positions())),
                            normalised(vec_cast<double>(mixed(middle.vertex, middle.share, organ.normals()))));
  for (std::size_t k = 0; k < neck.ring.size(); ++k)
    m_feet.push_back(foot_at(aside(m, neck, k, kCollarSkirt + kSkirtRadii * neck.radius), organ, skin));
  make(tube, &organ, backend, detail);
}

Joint::Joint(const TubeDrawing& tube, bool at_start, const WallSurface& walls, render::Backend& backend,
             const Detail& detail)
    : m_at_start(at_start), m_sides(tube.sides()) {
  const TubeNeck& neck = tube.neck(at_start);
  const WallSurface::Place middle = walls.nearest(neck.end);
  const Meeting m = meeting(neck, middle.point, middle.normal);
  for (std::size_t k = 0; k < neck.ring.size(); ++k) {
    const double turn = portable::two_pi * double(k) / double(neck.ring.size());
    const double uneven = 1 + 0.25 * std::sin(2 * turn + 900 * neck.end.x) + 0.12 * std::sin(3 * turn + 1);
    const WallSurface::Place at = walls.nearest(aside(m, neck, k, kWallSkirt * uneven));
    Foot foot;
    foot.at = vec_cast<float>(at.point);
    foot.normal = vec_cast<float>(at.normal);
    m_feet.push_back(foot);
  }
  make(tube, nullptr, backend, detail);
}

void Joint::make(const TubeDrawing& tube, const OrganDrawing* organ, render::Backend& backend, const Detail& detail) {
  for (int i = 0; i < kCollarRows * m_sides; ++i) m_buffer.add({});
  const auto row = [this](int i) { return std::uint32_t(i * m_sides); };
  for (int i = 0; i + 1 < kCollarRows; ++i)
    join_rows(m_buffer, row(m_at_start ? i + 1 : i), row(m_at_start ? i : i + 1), std::uint32_t(m_sides), true);
  m_below.assign(m_buffer.positions.size(), 0);
  place(tube, organ);
  for (std::size_t v = 0; organ && v < m_below.size(); ++v) {
    float nearest = 1;
    for (std::size_t i = 0; i < organ->positions().size(); ++i)
      if (const float d = length(organ->positions()[i] - m_buffer.positions[v]); d < nearest) {
        nearest = d;
        m_below[v] = std::uint32_t(i);
      }
  }
  m_buffer.rest = m_buffer.positions;
  coarsen(m_buffer, detail, kBends);
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

void Joint::place(const TubeDrawing& tube, const OrganDrawing* organ) {
  const TubeNeck& neck = tube.neck(m_at_start);
  std::vector<Vec3f> foot, normal;
  Vec3f middle{}, up{};
  for (const Foot& f : m_feet) {
    foot.push_back(organ ? mixed(f.vertex, f.share, organ->positions()) : f.at);
    normal.push_back(organ ? normalised(mixed(f.vertex, f.share, organ->normals()), Vec3f{0, 0, 1}) : f.normal);
    middle += foot.back() / float(m_sides);
    up += normal.back();
  }
  const Vec3f along = vec_cast<float>(neck.along), centre = vec_cast<float>(neck.centre);
  for (std::size_t k = 0; k < std::size_t(m_sides); ++k) {
    // A strand that is cut off short leaves a low mound.
    const Vec3f inner = neck.there ? centre + 0.95f * (neck.ring[k] - centre) : middle + 0.0005f * normalised(up);
    const Vec3f out = foot[k] - middle, level = normalised(out - dot(out, normal[k]) * normal[k], along);
    const float reach = 0.95f * length(foot[k] - inner);
    double burn = 0, open = organ ? 0 : 1;
    for (std::size_t c = 0; organ && c < 3; ++c) {
      const double share = std::array{m_feet[k].share.x, m_feet[k].share.y, m_feet[k].share.z}[c] / 255.0;
      burn += share * organ->paint()[m_feet[k].vertex[c]].burn;
      open += share * organ->paint()[m_feet[k].vertex[c]].openness;
    }
    // What it goes over into: an organ's own colour, or fat here and there below a wall's peritoneum.
    const double below = organ ? 0 : fat_below(vec_cast<double>(foot[k]));
    for (int i = 0; i < kCollarRows; ++i) {
      const float t = float(i) / float(kCollarRows - 2), u = 1 - t;  // the last row is the tucked border
      const std::size_t v = std::size_t(i * m_sides) + k;
      Vec3f p = (u * u * (1 + 2 * t)) * inner + (t * t * (3 - 2 * t)) * foot[k] + (u * u * t * reach) * along -
                (t * t * u * reach) * level + (kCollarClear * t) * normal[k];
      if (i == kCollarRows - 1) p = foot[k] + 0.0008f * level - kCollarTucked * normal[k];
      m_buffer.positions[v] = p;
      const double w = std::min(1.0, double(t));
      const double under = organ ? organ->paint()[m_below[v]].burn / 255.0 : 0;
      const double burnt = smooth(0, 0.35, w) * (under + smooth(0.6, 1, w) * (burn - under));
      const double tint = std::max((organ ? 0.95 : 0.8) * smooth(0.85, 0.05, w), below * w);
      m_buffer.paint[v] = {to_byte((1 - w) * 0.92 + w * open), 0, to_byte(burnt), to_byte(tint)};
    }
  }
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  for (std::size_t k = 0; k < std::size_t(m_sides); ++k) {  // no seams: as its neighbours'
    if (neck.there) m_buffer.normals[k] = normalised(neck.ring[k] - centre, m_buffer.normals[k]);
    for (int i = kCollarRows - 4; i < kCollarRows; ++i) {
      Vec3f& n = m_buffer.normals[std::size_t(i * m_sides) + k];
      const float w = std::min(1.0f, float(i - kCollarRows + 5) / 3);
      n = normalised((1 - w) * n + w * normal[k], normal[k]);
    }
  }
}

void Joint::update(const TubeDrawing& tube, const OrganDrawing* organ) {
  const std::uint64_t version = tube.version() + (organ ? organ->version() : 0);
  if (version == m_version) return;
  m_version = version;
  place(tube, organ);
  m_mesh.update(m_buffer);
}

}  // namespace trocar::view
