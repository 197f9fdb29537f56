#include <algorithm>
#include <cmath>

#include <trocar/numerics/mat3.hpp>
#include <trocar/view/instruments/shapes.hpp>
#include <trocar/view/objects/suture_drawing.hpp>

namespace trocar::view {
namespace {

using interactions::Suture;
using interactions::SutureModel;

constexpr int kWireAround = 14, kWireAlong = 96;
constexpr int kTubeAround = 8, kTubeFiner = 2;           // rows between two nodes
constexpr double kTaper = 0.22;                          // of the needle's length, over which it comes to a point
constexpr double kSwageLong = 0.08, kSwageThick = 1.12;  // of the length; of the wire
constexpr double kFlatFrom = 0.35, kFlatTo = 0.85;       // where the wire is flattened for jaws

double radius_at(const SutureModel& m, double share) {
  const double whole = 0.5 * m.needle.wire;
  if (share < kTaper) return whole * std::sqrt(std::max(0.0, share / kTaper)) * (0.25 + 0.75 * share / kTaper);
  return share > 1 - kSwageLong ? kSwageThick * whole : whole;
}

/// Flattened where jaws hold it, in the plane of its bend.
MeshBuffer wire_shape(const SutureModel& m) {
  MeshBuffer b;
  for (int i = 0; i <= kWireAlong; ++i) {
    const double share = double(i) / kWireAlong, s = share * m.needle.length, r = radius_at(m, share);
    const Vec3d middle = m.needle.place(s), along = -m.needle.along(s), up{0, 0, 1}, out = cross(up, along);
    const double flat = share > kFlatFrom && share < kFlatTo ? 0.86 : 1.0;
    for (int k = 0; k < kWireAround; ++k) {
      const double a = 2 * portable::pi * k / kWireAround;
      const Vec3d off = portable::cos(a) * out + portable::sin(a) * up;
      b.add(vec_cast<float>(middle + r * (portable::cos(a) * flat * out + portable::sin(a) * up)));
      b.normals.push_back(vec_cast<float>(off));
    }
  }
  for (int i = 0; i < kWireAlong; ++i)
    join_rows(b, std::uint32_t(i * kWireAround), std::uint32_t((i + 1) * kWireAround), kWireAround, true);
  const std::uint32_t end = b.add(vec_cast<float>(m.needle.place(m.needle.length)));
  b.normals.push_back(vec_cast<float>(-m.needle.along(m.needle.length)));
  join_pole(b, std::uint32_t(kWireAlong * kWireAround), kWireAround, end, true);
  return b;
}

render::Mat4 placed(const suture::NeedleState& s) {
  const Mat3d turn = to_mat3(s.q);
  Mat3f rotation;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) rotation.m[r][c] = float(turn.m[r][c]);
  return render::placement(rotation, vec_cast<float>(s.x));
}

/// Catmull and Rom's spline from b to c.
Vec3d spline(Vec3d a, Vec3d b, Vec3d c, Vec3d d, double t) {
  const double t2 = t * t, t3 = t2 * t;
  return 0.5 * (2.0 * b + t * (c - a) + t2 * (2.0 * a - 5.0 * b + 4.0 * c - d) + t3 * (3.0 * b - a - 3.0 * c + d));
}

}  // namespace

SutureDrawing::SutureDrawing(const sim::Model& model, render::Backend& backend) {
  const auto& list = interactions::part_of<Suture>(model).list;
  const Suture::States start = Suture::start(interactions::part_of<Suture>(model));
  for (std::size_t i = 0; i < list.size(); ++i) {
    const SutureModel& m = list[i];
    Drawn d{&m, &look(model, m.needle_look), &look(model, m.look), {}, {}, placed(start[i].needle)};
    if (m.has_needle()) {
      const MeshBuffer wire = wire_shape(m);
      d.needle = OwnedMesh(backend, wire.data());
    }
    if (m.has_thread()) {
      draw_tube(m, start[i].thread);
      d.tube = OwnedMesh(backend, m_tube.data());
    }
    m_sutures.push_back(std::move(d));
  }
}

void SutureDrawing::draw_tube(const SutureModel& m, const suture::ThreadState& s) {
  const int nodes = m.thread.nodes, rows = (nodes - 1) * kTubeFiner + 1;
  const double radius = 0.5 * m.thread.stuff.diameter;
  const auto node = [&](int n) { return s.x[std::size_t(std::clamp(n, 0, nodes - 1))]; };
  const auto at = [&](int row) {
    const int n = std::min(row / kTubeFiner, nodes - 2);
    return spline(node(n - 1), node(n), node(n + 1), node(n + 2), double(row - n * kTubeFiner) / kTubeFiner);
  };
  const bool anew = m_tube.positions.size() != std::size_t(rows * kTubeAround);
  if (anew) m_tube = {};
  m_tube.positions.clear(), m_tube.normals.clear(), m_tube.paint.clear();
  Vec3d side = any_perpendicular(normalised(at(1) - at(0)));
  for (int row = 0; row < rows; ++row) {
    const Vec3d middle = at(row), along = normalised(at(std::min(row + 1, rows - 1)) - at(std::max(row - 1, 0)));
    side = normalised(side - dot(side, along) * along, any_perpendicular(along));
    const Vec3d up = cross(along, side);
    // where it is parted there is nothing
    const int e = std::min(row / kTubeFiner, nodes - 2);
    const double r = s.alive[std::size_t(e)] ? radius : 0;
    for (int k = 0; k < kTubeAround; ++k) {
      const double a = 2 * portable::pi * k / kTubeAround;
      const Vec3d off = portable::cos(a) * side + portable::sin(a) * up;
      m_tube.add(vec_cast<float>(middle + r * off));
      m_tube.normals.push_back(vec_cast<float>(off));
    }
  }
  if (!anew) return;
  for (int row = 0; row + 1 < rows; ++row)
    join_rows(m_tube, std::uint32_t(row * kTubeAround), std::uint32_t((row + 1) * kTubeAround), kTubeAround, true);
  for (int row = 0; row < rows; ++row)  // a braid's pattern goes with the thread
    for (int k = 0; k < kTubeAround; ++k)
      m_tube.rest.push_back(
          Vec3f{float(radius * 2 * portable::pi * k / kTubeAround), float(row * m.thread.spacing / kTubeFiner), 0});
}

void SutureDrawing::update(const sim::State& state) {
  const Suture::States& now = interactions::part_of<Suture>(state);
  for (std::size_t i = 0; i < m_sutures.size(); ++i) {
    Drawn& d = m_sutures[i];
    d.transform = placed(now[i].needle);
    if (!d.model->has_thread()) continue;
    draw_tube(*d.model, now[i].thread);
    d.tube.move(m_tube.positions, m_tube.normals);
  }
}

void SutureDrawing::list(std::size_t first, const Listing& to) {
  for (std::size_t i = 0; i < m_sutures.size(); ++i) {
    Drawn& d = m_sutures[i];
    if (d.model->has_needle()) {
      render::DrawItem wire = item(d.needle.handle(), *d.steel, first + i);
      wire.transform = d.transform;
      to.add(wire);
    }
    if (d.model->has_thread()) to.add(item(d.tube.handle(), *d.thread, first + i));
  }
}

}  // namespace trocar::view
