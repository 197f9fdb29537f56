#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/bodies/cavity.hpp>
#include <trocar/view/instruments/port_site.hpp>

namespace trocar::view {
namespace {

constexpr int kPortSides = 40, kPortRows = 14;  // from inside the slit to the untouched wall
constexpr int kPortLip = 2;                     // the row that is the slit's rim
constexpr double kBehind = 0.09;                // [m] how far before and behind its port a wall is looked for
constexpr double kTent = 0.0042;                // [m] how far the peritoneum is drawn in along the sleeve ...
constexpr double kPortAround = 0.013;           // [m] ... and how far around it
constexpr double kLap = 0.0008;                 // [m] how far it stands off the wall at least
constexpr double kPortClear = 0.0006;           // [m] that the tent bulges off the sleeve
constexpr double kMostSlope = 0.012;            // [m] that the wall leaves its plane there
constexpr double kProud = 0.0003;     // [m] that it stands before the wall near the slit, which would cut through it
constexpr double kPortSunk = 0.0002;  // [m] of the outermost row under the wall: no border shows
constexpr double kFlattest = 0.3;     // cosine: a sleeve that lies flatter on the wall is not followed

/// 0 at the rim of the slit, 1 where the wall is untouched.
double share_outwards(int row) { return std::max(0.0, double(row - kPortLip) / (kPortRows - 1 - kPortLip)); }

Paint paint_of(int row, int side) {
  const double wave = 0.5 + 0.5 * varied(side / 2, 7), x = share_outwards(row);
  Paint p;
  p.openness = row < kPortLip ? std::uint8_t(row == 0 ? 6 : 20) : to_byte(0.16 + 0.84 * smooth(0, 0.5, x));
  // Most of the rim is clean; here and there a thin dark line of blood.
  const double bled = smooth(0.45, 0.85, 0.5 + 0.5 * varied(side / 5, 11));
  p.blood = row < kPortLip ? to_byte(0.1 + 0.3 * bled) : to_byte(0.3 * bled * (1 - smooth(0, 0.04 + 0.1 * wave, x)));
  return p;
}

/// Of each wall's triangles those that come near to a place: many lines are drawn there.
std::vector<std::vector<std::uint32_t>> near_to(Vec3d place, double reach, std::span<const PiercedWall> walls) {
  std::vector<std::vector<std::uint32_t>> lists(walls.size());
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const auto& [positions, normals, indices, look] = walls[w];
    for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
      bool near = true;
      for (int axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::minmax(
            {positions[indices[t]][axis], positions[indices[t + 1]][axis], positions[indices[t + 2]][axis]});
        near = near && double(low)<place[axis] + reach&& double(high)> place[axis] - reach;
      }
      if (near) lists[w].insert(lists[w].end(), {indices[t], indices[t + 1], indices[t + 2]});
    }
  }
  return lists;
}

}  // namespace

std::optional<Crossing> last_crossing(std::span<const PiercedWall> walls, Vec3d origin, Vec3d direction, double from,
                                      double to) {
  std::optional<Crossing> last;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const PiercedWall& wall = walls[w];
    for (std::size_t t = 0; t + 2 < wall.indices.size(); t += 3) {
      const std::uint32_t i = wall.indices[t], j = wall.indices[t + 1], k = wall.indices[t + 2];
      const Vec3d a = vec_cast<double>(wall.positions[i]), u = vec_cast<double>(wall.positions[j]) - a,
                  v = vec_cast<double>(wall.positions[k]) - a;
      const Vec3d n = cross(u, v), q = cross(origin - a, direction);
      const double turn = -dot(n, direction);
      if (turn == 0) continue;
      const double at = dot(origin - a, n) / turn, along_u = dot(v, q) / turn, along_v = -dot(u, q) / turn;
      if (along_u < 0 || along_v < 0 || along_u + along_v > 1 || at < from || at > to) continue;
      if (last && last->at >= at) continue;
      Vec3d normal = n;
      if (!wall.normals.empty())
        normal = (1 - along_u - along_v) * vec_cast<double>(wall.normals[i]) +
                 along_u * vec_cast<double>(wall.normals[j]) + along_v * vec_cast<double>(wall.normals[k]);
      last = Crossing{at, origin + at * direction, normalised(normal, -direction), w};
    }
  }
  return last;
}

PortSite::PortSite(Vec3d port, Vec3d axis, double radius, std::span<const PiercedWall> walls, render::Backend& backend,
                   const Detail& detail)
    : m_port(port), m_axis(axis), m_radius(radius) {
  // Where it comes in: past the port, or else the nearest wall behind it.
  std::optional<Crossing> hole = last_crossing(walls, port, axis, 0, kBehind);
  if (!hole) hole = last_crossing(walls, port, axis, -kBehind, 0);
  if (!hole) return;
  m_depth = hole->at;
  m_centre = hole->point;
  m_look = walls[hole->wall].look;
  m_normal = dot(hole->normal, axis) < 0 ? -hole->normal : hole->normal;
  if (dot(m_normal, axis) < kFlattest) return;
  m_u = normalised(cross(m_normal, Vec3d{0.3, 0.5, 0.8}), Vec3d{1, 0, 0});
  m_v = cross(m_normal, m_u);
  const auto lists = near_to(m_centre, radius / kFlattest + kPortAround + kMostSlope, walls);
  std::vector<PiercedWall> near(walls.begin(), walls.end());
  for (std::size_t w = 0; w < near.size(); ++w) near[w].indices = lists[w];
  for (int row = 0; row < kPortRows; ++row)
    for (int k = 0; k < kPortSides; ++k) {
      const double angle = portable::two_pi * k / kPortSides, x = share_outwards(row);
      const Vec3d way = std::cos(angle) * m_u + std::sin(angle) * m_v;
      const double footprint = radius / length(way - dot(way, axis) * axis);  // of a sleeve that comes in aslant
      const double far = footprint * (0.84 + 0.1 * std::min(row, kPortLip)) + kPortAround * x;
      const Vec3d aside = m_centre + far * way;
      const auto on = last_crossing(near, aside, m_normal, -kMostSlope, kMostSlope);
      m_base.push_back(on ? on->point : aside);
      const Vec3d n = on ? on->normal : m_normal;
      m_wall_normal.push_back(vec_cast<float>(dot(n, m_normal) < 0 ? -n : n));
      m_shape.add({}, paint_of(row, k));
      m_shape.paint.back().tint = to_byte(fat_below(m_base.back()));
      m_shape.rest.push_back(vec_cast<float>(m_base.back()));
    }
  for (int row = 0; row + 1 < kPortRows; ++row)
    join_rows(m_shape, std::uint32_t((row + 1) * kPortSides), std::uint32_t(row * kPortSides), kPortSides, true);
  shape(axis);
  coarsen(m_shape, detail, kBends);
  m_mesh = OwnedMesh(backend, m_shape.data());
}

/// Of the wall at rest over its plane, so far from the hole's middle towards a side [m].
double PortSite::wall_height(int side, double away) const {
  const auto base = [&](int row) { return m_base[std::size_t(row * kPortSides + side)] - m_centre; };
  const double angle = portable::two_pi * side / kPortSides;
  const Vec3d aside = std::cos(angle) * m_u + std::sin(angle) * m_v;
  int row = 0;
  while (row + 2 < kPortRows && dot(base(row + 1), aside) < away) ++row;
  const double near = dot(base(row), aside), far = dot(base(row + 1), aside);
  const double t = std::clamp((away - near) / std::max(far - near, 1e-9), 0.0, 1.0);
  return (1 - t) * dot(base(row), m_normal) + t * dot(base(row + 1), m_normal);
}

void PortSite::shape(Vec3d axis) {
  m_axis = axis;
  const double steep = dot(axis, m_normal);
  const Vec3d hole = m_port + (dot(m_centre - m_port, m_normal) / steep) * axis;
  for (int row = 0; row < kPortRows; ++row) {
    const double x = share_outwards(row), drawn = (1 - x) * (1 - x) * (1 - 0.35 * x);  // steep at the sleeve
    for (int k = 0; k < kPortSides; ++k) {
      const double angle = portable::two_pi * k / kPortSides, c = std::cos(angle), s = std::sin(angle);
      const Vec3d aside = c * m_u + s * m_v;
      const Vec3d across = normalised(aside - dot(aside, axis) * axis, m_u);
      const double slit = row < kPortLip ? -0.05 : 0.16 * c * c * c * c;  // gapes to both sides
      // Under a sleeve that leans over it the wall only laps against it.
      const double least = (kLap - m_radius * dot(across, m_normal)) / steep;
      const double drawn_in = std::max(kTent * (1 + 0.12 * std::sin(3 * angle + 1)), least);
      const double high = drawn_in - kTent * 0.4 * std::max(0, kPortLip - row);
      const Vec3d at_sleeve = hole + high * axis + (m_radius * (1.02 + slit)) * across;
      const double folds = 0.0003 * std::sin(11 * angle + 2 * std::sin(2 * angle)) * drawn * (1 - drawn) * 4;
      const std::size_t i = std::size_t(row * kPortSides + k);
      Vec3d p = drawn * at_sleeve + (1 - drawn) * m_base[i] + folds * m_normal +
                (4 * kPortClear * drawn * (1 - drawn)) * across;
      const double short_of = wall_height(k, dot(p - m_centre, aside)) + kProud * (1 - x) - dot(p - m_centre, m_normal);
      if (row >= kPortLip) p += std::max(short_of, 0.0) * m_normal;
      m_shape.positions[i] = vec_cast<float>(p - (kPortSunk * x * x * x) * m_normal);
    }
  }
  render::vertex_normals(m_shape.positions, m_shape.indices, m_shape.normals);
  for (std::size_t i = 0; i < m_shape.normals.size(); ++i) {  // towards the border as the wall's: no seam
    const float wall = float(smooth(0.35, 0.9, share_outwards(int(i) / kPortSides)));
    m_shape.normals[i] = normalised((1 - wall) * m_shape.normals[i] + wall * m_wall_normal[i], m_wall_normal[i]);
  }
}

void PortSite::update(Vec3d axis) {
  if (m_base.empty() || axis == m_axis || dot(axis, m_normal) < kFlattest) return;
  shape(axis);
  m_mesh.move(m_shape.positions, m_shape.normals);
}

}  // namespace trocar::view
