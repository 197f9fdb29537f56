#include <cmath>

#include <trocar/numerics/mat3.hpp>
#include <trocar/view/instruments/shapes.hpp>
#include <trocar/view/objects/rigid_drawing.hpp>

namespace trocar::view {
namespace {

using interactions::Rigid;
using interactions::RigidModel;

constexpr int kRigidAround = 20, kRigidAlong = 4;  // points around what it is made of; along, between two beads

/// A closed tube about z through the beads.
MeshBuffer ring_shape(const RigidModel& m) {
  MeshBuffer b;
  const double middle = length(m.beads.front());
  const int rows = int(m.beads.size()) * kRigidAlong;
  for (int i = 0; i < rows; ++i) {
    const double turn = 2 * portable::pi * i / rows;
    const Vec3d out{portable::cos(turn), portable::sin(turn), 0};
    for (int k = 0; k < kRigidAround; ++k) {
      const double a = 2 * portable::pi * k / kRigidAround;
      const Vec3d up = portable::cos(a) * out + portable::sin(a) * Vec3d{0, 0, 1};
      b.add(vec_cast<float>(middle * out + m.radius * up));
      b.normals.push_back(vec_cast<float>(up));
    }
  }
  for (int i = 0; i < rows; ++i)
    join_rows(b, std::uint32_t((i + 1) % rows * kRigidAround), std::uint32_t(i * kRigidAround), kRigidAround, true);
  return b;
}

/// A rod with round ends along z.
MeshBuffer rod_shape(double length, double radius) {
  constexpr int kRound = 6;
  std::vector<TurnPoint> outline;
  for (int i = 0; i <= kRound; ++i) {
    const double a = 0.5 * portable::pi * i / kRound;
    outline.push_back({-radius * portable::cos(a), radius * portable::sin(a), {}});
  }
  for (int i = 0; i <= kRound; ++i) {
    const double a = 0.5 * portable::pi * i / kRound;
    outline.push_back({length + radius * portable::sin(a), radius * portable::cos(a), {}});
  }
  return turned(outline, kRigidAround);
}

MeshBuffer line_shape(const RigidModel& m) {
  MeshBuffer b;
  for (std::size_t i = 0; i + 1 < std::max<std::size_t>(m.beads.size(), 2); ++i) {
    const Vec3d from = m.beads[i], to = m.beads[std::min(i + 1, m.beads.size() - 1)];
    const Mat3d turn = to_mat3(quat_from_two_vectors(Vec3d{0, 0, 1}, to - from));
    Mat3f rotation;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) rotation.m[r][c] = float(turn.m[r][c]);
    append(b, rod_shape(length(to - from), m.radius), rotation, vec_cast<float>(from));
  }
  return b;
}

/// An ellipsoid within its beads' hull, with facets that have worn against its fellows.
MeshBuffer pebble_shape(const RigidModel& m) {
  constexpr int kAcross = 18, kRoundPebble = 28;
  constexpr double kFacets = 0.07;  // of its thickness
  MeshBuffer b;
  const auto out = [&m](int row, int k) {
    const double up = portable::pi * row / kAcross, turn = 2 * portable::pi * k / kRoundPebble;
    const Vec3d d{portable::sin(up) * portable::cos(turn), portable::sin(up) * portable::sin(turn), portable::cos(up)};
    const double worn = portable::sin(5 * d.x + 1.3) * portable::sin(4 * d.y + 0.4) * portable::cos(6 * d.z);
    const double size = 1 - kFacets * (0.5 + 0.5 * worn);
    return size * Vec3d{m.pebble.x * d.x, m.pebble.y * d.y, m.pebble.z * d.z};
  };
  for (int row = 0; row <= kAcross; ++row)
    for (int k = 0; k < kRoundPebble; ++k) {
      const Vec3d p = out(row, k);
      b.add(vec_cast<float>(p));
      b.normals.push_back(vec_cast<float>(normalised(
          Vec3d{p.x / (m.pebble.x * m.pebble.x), p.y / (m.pebble.y * m.pebble.y), p.z / (m.pebble.z * m.pebble.z)})));
    }
  for (int row = 0; row < kAcross; ++row)
    join_rows(b, std::uint32_t((row + 1) * kRoundPebble), std::uint32_t(row * kRoundPebble), kRoundPebble, true);
  return b;
}

MeshBuffer shape_of(const RigidModel& m) {
  if (m.pebble.x > 0) return pebble_shape(m);
  return m.closed ? ring_shape(m) : line_shape(m);
}

render::Mat4 placed(const interactions::RigidState& s) {
  const Mat3d turn = to_mat3(s.q);
  Mat3f rotation;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) rotation.m[r][c] = float(turn.m[r][c]);
  return render::placement(rotation, vec_cast<float>(s.x));
}

}  // namespace

RigidDrawing::RigidDrawing(const sim::Model& model, render::Backend& backend) {
  for (const RigidModel& m : interactions::part_of<Rigid>(model).list) {
    const Detail detail(levels_of(model, m.name));
    m_bodies.push_back({rigid(shape_of(m), detail, backend), detail, &look(model, m.look), {}});
  }
}

void RigidDrawing::update(const sim::State& state) {
  const Rigid::States& now = interactions::part_of<Rigid>(state);
  for (std::size_t i = 0; i < m_bodies.size(); ++i) m_bodies[i].transform = placed(now[i]);
}

void RigidDrawing::list(std::size_t first, const Listing& to) {
  for (std::size_t i = 0; i < m_bodies.size(); ++i) {
    Drawn& b = m_bodies[i];
    render::DrawItem drawn = item(b.mesh.mesh.handle(), *b.look, first + i);
    drawn.transform = b.transform;
    to.add(b.mesh, drawn, b.detail);
  }
}

}  // namespace trocar::view
