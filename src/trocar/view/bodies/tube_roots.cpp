// Where a strand continues below the surface of what holds it.
#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/base/looks.hpp>
#include <trocar/view/bodies/tube_drawing.hpp>

namespace trocar::view {
namespace {

constexpr double kRootDepth = 1.6;                          // radii below the organ's surface where it ends
constexpr double kRootSlide = 0.022;                        // [m] a ligament continues along a wall ...
constexpr double kRootBelow = 0.003;                        // [m] ... to below its surface
constexpr double kRootLeaves = 0.012, kRootBeside = 0.003;  // [m] from a place to the wall: it is not below that
constexpr double kRootStep = 0.002;                         // [m]
constexpr double kRootHeadOn = 0.5;     // sine of the angle to a wall above which a strand has a collar there ...
constexpr double kHeadOnDepth = 0.012;  // [m] ... behind which it ends
constexpr double kWallNeck = 0.008;     // [m] ... from so far above it on
constexpr double kNeckFar = 0.011;      // [m] from its end a strand's collar begins at most
constexpr double kSink = 0.9;           // radii that a strand has sunk into its organ at its end
constexpr double kRootReach = 0.03;     // [m] a wall further from a fixed end is not its root

/// How far there is a wall over who goes that way: beyond its border he would come out again.
double slide_below(const WallSurface::Place& from, Vec3d way, const WallSurface& walls) {
  const auto covered = [&](double far) {
    const Vec3d p = from.point + far * way;
    const WallSurface::Place at = walls.nearest(p);
    const Vec3d off = p - at.point;
    return length(off) < kRootLeaves && length(off - dot(off, at.normal) * at.normal) < kRootBeside;
  };
  double far = kRootSlide;
  while (far > 0 && !covered(far)) far -= kRootStep;
  return std::max(0.0, far);
}

TubeRow row_at(int piece, double s) {
  TubeRow row;
  row.piece = piece;
  row.s = s;
  return row;
}

}  // namespace

TubeRoot TubeDrawing::root_at(const StrandCurve& rest, bool at_start, const WallSurface* walls) const {
  const sim::StrandEndModel& end = at_start ? m_strand->start : m_strand->end;
  if (end.kind == sim::StrandEndModel::free || look(*m_model, m_strand->look).moulded) return {};
  const CurveFrame f = rest.at(0, at_start ? 0 : m_body->length());
  const double radius = at_start ? m_strand->outer.front() : m_strand->outer.back();
  if (end.kind == sim::StrandEndModel::fixed) {
    const Vec3d onward = at_start ? -f.tangent : f.tangent;
    return walls ? root_in_wall(f, onward, radius, *walls) : root_in_wall(f, onward, radius, WallSurface(*m_model));
  }
  double nearest = 1;
  Vec3d at{}, normal{};
  const std::int32_t lattice = lattice_of(*m_model, end.organ());
  const tissue::Skin& skin = lattice >= 0 ? m_model->solids[std::size_t(lattice)].fine : m_model->skin(end.organ());
  for (std::size_t i = 0; i < skin.rest.size(); ++i) {
    if (!skin.at_surface(int(i))) continue;
    const double d = length(vec_cast<double>(skin.rest[i]) - f.point);
    if (d >= nearest) continue;
    nearest = d;
    at = vec_cast<double>(skin.rest[i]);
    normal = vec_cast<double>(skin.rest_normal[i]);
  }
  TubeRoot root;
  const double above = dot(f.point - at, normal);
  root.sink = std::max(0.0, kSink * radius + above);
  at = f.point - above * normal;
  root.there = true;
  const Vec3d target = at - (kRootDepth * radius) * normal;
  root.length = length(target - f.point);
  const auto local = [&f](Vec3d v) { return Vec3d{dot(v, f.tangent), dot(v, f.normal), dot(v, f.binormal)}; };
  root.target = local(target - f.point);
  root.direction = local(-normal);
  return root;
}

/// A ligament does not end where it meets a wall, but runs on below the peritoneum and is lost there.
TubeRoot TubeDrawing::root_in_wall(const CurveFrame& end, Vec3d onward, double radius, const WallSurface& walls) const {
  TubeRoot root;
  root.there = root.in_space = true;
  const WallSurface::Place wall = walls.nearest(end.point);
  const bool near = wall.there && length(wall.point - end.point) <= kRootReach;
  if (!near || dot(onward, wall.normal) < -kRootHeadOn) {  // on into the dark
    root.direction = onward;
    root.target = end.point + (near ? kHeadOnDepth : kRootReach) * onward;
  } else {
    const Vec3d level = normalised(onward - dot(onward, wall.normal) * wall.normal, any_perpendicular(wall.normal));
    root.target = wall.point + slide_below(wall, level, walls) * level - (radius + kRootBelow) * wall.normal;
    root.direction = normalised(level - 0.3 * wall.normal);
  }
  root.length = length(root.target - end.point);
  return root;
}

/// How far from its end the whole ring lies outside the organ, with room for a collar [m].
double TubeDrawing::neck_of(const StrandCurve& rest, bool at_start) const {
  const int node = at_start ? 0 : m_body->nodes() - 1;
  const sim::StrandEndModel& end = at_start ? m_strand->start : m_strand->end;
  const std::int32_t lattice = hosted(node) ? lattice_of(*m_model, end.organ()) : -1;
  if (lattice < 0) return 0;
  const tissue::Skin& skin = m_model->solids[std::size_t(lattice)].fine;
  const double radius = m_strand->outer[std::size_t(node)];
  for (double far = 1.2 * radius; far < std::min(kNeckFar, 0.3 * m_body->length()); far += 0.0005) {
    const CurveFrame f = frame_of(row_at(0, at_start ? far : m_body->length() - far), rest);
    double nearest = 1, above = 0;
    for (std::size_t i = 0; i < skin.rest.size(); ++i) {
      const Vec3d way = f.point - vec_cast<double>(skin.rest[i]);
      if (const double d = length(way); d < nearest) {
        nearest = d;
        above = dot(way, vec_cast<double>(skin.rest_normal[i]));
      }
    }
    if (above > 1.5 * radius) return far + 0.6 * radius;
  }
  return std::min(kNeckFar, 0.3 * m_body->length());
}

/// One that meets a wall head-on needs a collar there, too.
double TubeDrawing::neck_at_wall(const StrandCurve& rest, bool at_start, const WallSurface& walls) const {
  if (look(*m_model, m_strand->look).moulded) return 0;
  const double end = at_start ? 0 : m_body->length();
  const CurveFrame f = rest.at(0, end);
  const WallSurface::Place wall = walls.nearest(f.point);
  const double steep = dot(at_start ? f.tangent : -f.tangent, wall.normal);
  if (!wall.there || length(wall.point - f.point) > kRootReach || steep < kRootHeadOn) return 0;
  const double above = dot(f.point - wall.point, wall.normal), far = (kWallNeck - above) / steep;
  return std::clamp(far, 0.002, 0.3 * m_body->length());
}

void TubeDrawing::place_necks(const StrandCurve& curve) {
  for (const bool at_start : {true, false}) {
    TubeNeck& neck = m_neck[at_start ? 0 : 1];
    if (neck.far <= 0) continue;
    const int index = at_start ? 0 : int(m_layout.pieces.size()) - 1;
    const StrandPiece& piece = m_layout.pieces[std::size_t(index)];
    const double s = at_start ? neck.far : m_body->length() - neck.far;
    neck.there = at_start ? piece.to > s && piece.from <= 0 : piece.from < s && piece.to >= m_body->length();
    const CurveFrame f = frame_of(row_at(index, s), curve);
    neck.centre = f.point;
    neck.along = at_start ? -f.tangent : f.tangent;
    neck.end = curve.at(index, at_start ? 0 : m_body->length()).point;
    neck.radius = radius_at(s);
    neck.ring.clear();
    for (int k = 0; k < m_sides; ++k) {
      const double a = 2 * portable::pi * k / m_sides;
      neck.ring.push_back(vec_cast<float>(f.point + (neck.radius * outline(s, a)) *
                                                        (std::cos(a) * f.normal + std::sin(a) * f.binormal)));
    }
  }
}

/// From the end inwards; for a start in reversed order, so that rows always follow the strand.
void TubeDrawing::add_root(int piece, bool at_start) {
  const StrandPiece& p = m_layout.pieces[std::size_t(piece)];
  const TubeRoot& root = at_start ? m_start_root : m_end_root;
  const double s = at_start ? p.from : p.to, r = radius_at(s), narrows = root.in_space ? 0.3 : 0.7;
  const int steps = std::max(3, int(root.length / 0.0015));
  std::vector<TubeRow> rows;
  for (int i = 1; i <= steps; ++i) {
    const double t = double(i) / steps;
    rows.push_back({piece, s, 0, r * (1 - narrows * t * t), 0, t, false, {to_byte(1 - 0.35 * t), 0, 0, 0}});
  }
  rows.push_back({piece, s, 0, 0, 0, 1, false, {120, 0, 0, 0}});
  if (at_start) std::reverse(rows.begin(), rows.end());
  m_rows.insert(m_rows.end(), rows.begin(), rows.end());
}

/// Near an organ the tube lies half in its surface, so that it grows out of it instead of standing on it.
CurveFrame TubeDrawing::sunk(const TubeRow& row, CurveFrame f, const StrandCurve& curve) const {
  for (const bool at_start : {true, false}) {
    const TubeRoot& root = at_start ? m_start_root : m_end_root;
    if (!root.there || root.in_space || root.sink <= 0) continue;
    const double end = at_start ? 0 : m_body->length(), far = std::fabs(row.s - end);
    const int piece = at_start ? 0 : int(m_layout.pieces.size()) - 1;
    if (row.piece != piece || far > 4 * root.sink) continue;
    const CurveFrame e = curve.at(piece, end);
    const Vec3d in = root.direction.x * e.tangent + root.direction.y * e.normal + root.direction.z * e.binormal;
    f.point += (root.sink * smooth(4 * root.sink, 0, far)) * in;
  }
  return f;
}

/// The curve's frame, or beyond an end that of the way to the root's target.
CurveFrame TubeDrawing::frame_of(const TubeRow& row, const StrandCurve& curve) const {
  CurveFrame f = curve.at(row.piece, row.s);
  if (row.out <= 0) {
    f.point += coiled(row.s, f);
    return sunk(row, f, curve);
  }
  const bool at_start = row.piece == 0 && row.s == curve.pieces().front().from;
  const TubeRoot& root = at_start ? m_start_root : m_end_root;
  const double sign = at_start ? -1 : 1;
  const auto world = [&f](Vec3d v) { return v.x * f.tangent + v.y * f.normal + v.z * f.binormal; };
  if (!root.in_space) f.point += root.sink * world(root.direction);
  const Vec3d a = f.point, b = root.in_space ? root.target : a + world(root.target);
  const Vec3d da = (sign * root.length) * f.tangent,
              db = root.length * (root.in_space ? root.direction : world(root.direction));
  const double t = row.out, u = 1 - t;
  f.point = (u * u * (1 + 2 * t)) * a + (t * t * (3 - 2 * t)) * b + (u * u * t) * da - (t * t * u) * db;
  const Vec3d along = (6 * t * u) * (b - a) + (u * (1 - 3 * t)) * da + (t * (3 * t - 2)) * db;
  f.tangent = normalised(sign * along, f.tangent);
  f.normal = normalised(f.normal - dot(f.normal, f.tangent) * f.tangent, any_perpendicular(f.tangent));
  f.binormal = cross(f.tangent, f.normal);
  return f;
}

}  // namespace trocar::view
