#include <array>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/instruments/shapes.hpp>
#include <trocar/view/objects/bag_drawing.hpp>

namespace trocar::view {
namespace {

using interactions::Bag;
using interactions::BagModel;
using interactions::BagState;

constexpr int kFiner = 3;  // drawn quads along a node's side
constexpr int kBandAlong = 72, kBandAround = 10;
constexpr double kBandWide = 0.0013, kBandThin = 0.0005;  // [m] half of the band's cross-section

/// Catmull and Rom's spline from b to c.
Vec3d between_nodes(Vec3d a, Vec3d b, Vec3d c, Vec3d d, double t) {
  const double t2 = t * t, t3 = t2 * t;
  return 0.5 * (2.0 * b + t * (c - a) + t2 * (2.0 * a - 5.0 * b + 4.0 * c - d) + t3 * (3.0 * b - a - 3.0 * c + d));
}

/// Nodes by row and column; rows beyond the mouth and beyond the bottom continue as the cloth does there.
Vec3d node_at(const BagModel& m, const BagState& s, int r, int c) {
  const int around = m.around;
  if (r < 0) return 2.0 * node_at(m, s, 0, c) - node_at(m, s, 1, c);
  if (r == m.rows) return s.x.back();
  if (r > m.rows) return node_at(m, s, 2 * m.rows - r, c + around / 2);
  return s.x[std::size_t(r * around + ((c % around) + around) % around)];
}

Vec3d along_row(const BagModel& m, const BagState& s, int r, int c, double t) {
  return between_nodes(node_at(m, s, r, c - 1), node_at(m, s, r, c), node_at(m, s, r, c + 1), node_at(m, s, r, c + 2),
                       t);
}

/// @param i, j  of the finer rows and columns
Vec3d cloth_at(const BagModel& m, const BagState& s, int i, int j) {
  const int r = std::min(i / kFiner, m.rows - 1), c = j / kFiner;
  const double u = double(i - r * kFiner) / kFiner, v = double(j % kFiner) / kFiner;
  return between_nodes(along_row(m, s, r - 1, c, v), along_row(m, s, r, c, v), along_row(m, s, r + 1, c, v),
                       along_row(m, s, r + 2, c, v), u);
}

/// Area weighted over the triangles.
void find_smooth_normals(MeshBuffer& b) {
  b.normals.assign(b.positions.size(), {});
  for (std::size_t t = 0; t + 2 < b.indices.size(); t += 3) {
    const Vec3f p = b.positions[b.indices[t]];
    const Vec3f n = cross(b.positions[b.indices[t + 1]] - p, b.positions[b.indices[t + 2]] - p);
    for (std::size_t k = 0; k < 3; ++k) b.normals[b.indices[t + k]] += n;
  }
  for (Vec3f& n : b.normals) n = normalised(n, Vec3f{0, 0, 1});
}

}  // namespace

BagDrawing::BagDrawing(const sim::Model& model, render::Backend& backend) {
  for (const BagModel& m : interactions::part_of<Bag>(model).list) {
    BagState open;
    open.x = m.drawn;
    open.hoop = 1;
    draw_cloth(m, open);
    draw_band(m, open);
    m_bags.push_back({&m, &look(model, m.look), &look(model, "steel"), OwnedMesh(backend, m_cloth.data()),
                      OwnedMesh(backend, m_band.data()), false});
  }
}

void BagDrawing::draw_cloth(const BagModel& m, const BagState& s) {
  const int rows = m.rows * kFiner, around = m.around * kFiner;
  m_cloth = {};
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j < around; ++j) m_cloth.add(vec_cast<float>(cloth_at(m, s, i, j)));
  for (int i = 0; i < rows; ++i)
    join_rows(m_cloth, std::uint32_t((i + 1) * around), std::uint32_t(i * around), std::uint32_t(around), true);
  find_smooth_normals(m_cloth);
  for (int i = 0; i <= rows; ++i)  // a pattern goes with the cloth, not with where it is
    for (int j = 0; j < around; ++j)
      m_cloth.rest.push_back(Vec3f{float(j) / float(around), float(i) / float(rows), 0} * 0.2f);
}

void BagDrawing::draw_band(const BagModel& m, const BagState& s) {
  m_band = {};
  const Vec3d middle = s.middle(m), side = s.frame.side();
  for (int i = 0; i < kBandAlong; ++i) {
    const double turn = 2 * portable::pi * i / kBandAlong;
    const Vec3d out = portable::cos(turn) * s.frame.axis + portable::sin(turn) * side;
    for (int k = 0; k < kBandAround; ++k) {
      const double a = 2 * portable::pi * k / kBandAround;
      const Vec3d off = kBandThin * portable::cos(a) * out + kBandWide * portable::sin(a) * s.frame.up;
      m_band.add(vec_cast<float>(middle + s.hoop * m.hoop * out + off));
      m_band.normals.push_back(
          vec_cast<float>(normalised(portable::cos(a) / kBandThin * out + portable::sin(a) / kBandWide * s.frame.up)));
    }
  }
  for (int i = 0; i < kBandAlong; ++i)
    join_rows(m_band, std::uint32_t((i + 1) % kBandAlong * kBandAround), std::uint32_t(i * kBandAround), kBandAround,
              true);
}

void BagDrawing::update(const sim::State& state) {
  const Bag::States& now = interactions::part_of<Bag>(state);
  for (std::size_t i = 0; i < m_bags.size(); ++i) {
    Drawn& d = m_bags[i];
    d.there = now[i].there();
    if (!d.there) continue;
    draw_cloth(*d.model, now[i]);
    draw_band(*d.model, now[i]);
    d.cloth_mesh.move(m_cloth.positions, m_cloth.normals);
    d.band_mesh.move(m_band.positions, m_band.normals);
  }
}

void BagDrawing::list(std::size_t first, const Listing& to) {
  for (std::size_t i = 0; i < m_bags.size(); ++i) {
    if (!m_bags[i].there) continue;
    to.add(item(m_bags[i].band_mesh.handle(), *m_bags[i].band, first + i));
    to.add(item(m_bags[i].cloth_mesh.handle(), *m_bags[i].cloth, first + i));
  }
}

}  // namespace trocar::view
