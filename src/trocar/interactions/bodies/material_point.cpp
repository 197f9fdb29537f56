#include <algorithm>
#include <cmath>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/bodies/bodies.hpp>
#include <trocar/interactions/bodies/material_point.hpp>
#include <trocar/numerics/mat3.hpp>

namespace trocar::interactions {
namespace {

void set_offset(MaterialPoint& p, Vec3d off) noexcept { p.offset = {float(off.x), float(off.y), float(off.z)}; }

// --- rods ---

/// How it rides on a rod now: on an element that is whole, `along` beyond the place in it, as on a stump.
struct OnRod {
  std::size_t element = 0;
  double w = 0, along = 0;  ///< 0 .. 1; [m]
};

OnRod on_rod(const StrandBody& body, const tissue::StrandState& s, const MaterialPoint& p) noexcept {
  const std::size_t e = std::size_t(p.element), n = std::size_t(body.nodes());
  const double w = double(p.weight[0]);
  if (s.alive[e]) return {e, w, 0};
  const double drawn = body.arc[e + 1] - body.arc[e];
  if (w <= 0.5) return e > 0 && s.alive[e - 1] ? OnRod{e - 1, 1, w * drawn} : OnRod{e, 0, w * drawn};
  return e + 2 < n && s.alive[e + 1] ? OnRod{e + 1, 0, (w - 1) * drawn} : OnRod{e, 1, (w - 1) * drawn};
}

Vec3d direction(const std::vector<Vec3d>& x, std::size_t e) noexcept { return normalised(x[e + 1] - x[e]); }

/// Turns v as the smallest rotation from direction a to direction b does.
Vec3d swung(Vec3d v, Vec3d a, Vec3d b) noexcept {
  const Vec3d axis = cross(a, b);
  const double c = dot(a, b);
  if (c < -0.999) return v;
  return v * c + cross(axis, v) + axis * (dot(axis, v) / (1.0 + c));
}

/// A rod's element as the frame of what is beside it.
struct RodFrame {
  Vec3d drawn, now;
  double length = 1;

  RodFrame(const StrandBody& body, const tissue::StrandState& s, std::size_t e) noexcept
      : drawn(direction(body.model.rest, e)), now(direction(s.x, e)), length(trocar::length(s.x[e + 1] - s.x[e])) {}

  Vec3d beside(const OnRod& on, const MaterialPoint& p) const noexcept {
    return on.along * now + swung(offset_of(p), drawn, now);
  }
  /// Of what turns with it: t' follows the ends' velocities, and the smallest rotation from the drawn direction twists
  /// about t as t' goes around that.
  Vec3d spin(Vec3d along) const noexcept { return cross(now, along) + dot(twist(), along) * now; }
  /// Transpose of spin(): torque . spin(t') = g . t'.
  Vec3d transposed(Vec3d torque) const noexcept { return cross(torque, now) + dot(torque, now) * twist(); }

 private:
  Vec3d twist() const noexcept {
    const double c = dot(drawn, now);
    return c < -0.999 ? Vec3d{} : cross(now, drawn) / (1.0 + c);
  }
};

// --- bodies of nodes ---

/// The row as it is now.
struct Row {
  std::array<std::int32_t, kRowNodes> node{};
  std::array<double, kRowNodes> weight{};
  std::array<Vec3d, kRowNodes> x, v;
  int count = 0;

  Vec3d mean(const std::array<Vec3d, kRowNodes>& of) const noexcept {
    Vec3d sum;
    for (int i = 1; i < count; ++i) sum += weight[std::size_t(i)] * (of[std::size_t(i)] - of[0]);
    return of[0] + sum;
  }
  double magnitude() const noexcept {
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += std::fabs(weight[std::size_t(i)]);
    return sum;
  }
};

/// Where a membrane's triangle has been cut open its corners go different ways: the heaviest one has the point.
void keep_heaviest(Row& row) noexcept {
  std::size_t most = 0;
  for (std::size_t i = 1; i < std::size_t(row.count); ++i)
    if (row.weight[i] > row.weight[most]) most = i;
  for (std::size_t i = 0; i < std::size_t(row.count); ++i) row.weight[i] = i == most ? 1 : 0;
}

Row row_of(const Bodies& bodies, const MaterialPoint& p) noexcept {
  const tissue::NodeView nodes = nodes_of(bodies, p.body);
  const geometry::Tet* const cell = cell_of(bodies, p.body, p.element);
  Row row;
  row.count = p.count;
  for (std::size_t i = 0; i < std::size_t(p.count); ++i) {
    row.node[i] = cell ? (*cell)[std::size_t(p.node[i])] : p.node[i];
    row.weight[i] = double(p.weight[i]);
    row.x[i] = nodes.position(row.node[i]);
    row.v[i] = nodes.velocity(row.node[i]);
  }
  row.weight[0] = 1;  // weights of single precision add up to 1 but for rounding
  for (std::size_t i = 1; i < std::size_t(row.count); ++i) row.weight[0] -= row.weight[i];
  if (p.body.is(BodyKind::membrane) && p.element >= 0 && bodies.states.torn[p.body.index()][std::size_t(p.element)])
    keep_heaviest(row);
  return row;
}

/// The same as it was drawn; places only.
Row drawn_row(const Bodies& bodies, const MaterialPoint& p) noexcept {
  const std::span<const Vec3d> rest = is_tetrahedral(bodies, p.body)
                                          ? std::span<const Vec3d>(tets_of(bodies, p.body).rest)
                                          : drawn_nodes(bodies.models, p.body);
  const geometry::Tet* const cell = cell_of(bodies, p.body, p.element);
  Row row;
  row.count = p.count;
  for (std::size_t i = 0; i < std::size_t(p.count); ++i) {
    row.weight[i] = double(p.weight[i]);
    row.x[i] = rest[std::size_t(cell ? (*cell)[std::size_t(p.node[i])] : p.node[i])];
  }
  return row;
}

Vec3d middle_of(const Row& row) noexcept {
  Vec3d sum;
  for (std::size_t i = 0; i < std::size_t(row.count); ++i) sum += row.x[i];
  return sum / double(row.count);
}

/// Edge, across and normal of a triangle of nodes.
struct SheetFrame {
  Vec3d edge, across, normal;
  double length = 1, height = 1, foot = 0;  ///< of the edge; of the third node over it, and where on it, 0 .. 1

  explicit SheetFrame(const std::array<Vec3d, kRowNodes>& x) noexcept {
    const Vec3d ab = x[1] - x[0], ac = x[2] - x[0];
    length = std::max(1e-9, trocar::length(ab));
    edge = normalised(ab);
    normal = normalised(cross(ab, ac));
    across = cross(normal, edge);
    height = std::max(1e-9, dot(ac, across));
    foot = dot(ac, edge) / length;
  }
  Vec3d out(Vec3d v) const noexcept { return v.x * edge + v.y * across + v.z * normal; }
  Vec3d in(Vec3d v) const noexcept { return {dot(v, edge), dot(v, across), dot(v, normal)}; }
  Vec3d spin(const std::array<Vec3d, kRowNodes>& v) const noexcept {
    const Vec3d ab = v[1] - v[0];
    return (dot(normal, v[2] - v[0] - foot * ab) / height) * edge - (dot(normal, ab) / length) * across +
           (dot(across, ab) / length) * normal;
  }
  /// Transpose of spin(): the forces on the three nodes that a torque is.
  void bear(Vec3d torque, Vec3d (&force)[3]) const noexcept {
    const Vec3d lift = (dot(torque, edge) / height) * normal;
    const Vec3d swing = (1 / length) * (dot(torque, normal) * across - dot(torque, across) * normal);
    force[0] = (foot - 1) * lift - swing;
    force[1] = swing - foot * lift;
    force[2] = lift;
  }
};

/// A long row as it is now: f(node, weight, x, v) of each of its nodes.
template <class F>
void each_of_long(const Bodies& bodies, const MaterialPoint& p, F&& f) noexcept {
  const tissue::NodeView nodes = nodes_of(bodies, p.body);
  const auto give = [&](std::int32_t n, double w) {
    if (w != 0) f(n, w, nodes.position(n), nodes.velocity(n));
  };
  if (p.frame == MaterialPoint::skin_row)
    return skin_of(bodies, p.body.index()).each_carrier(p.element, [&](int n, int, float w) { give(n, double(w)); });
  const LongRow& row = bodies.models.rows[std::size_t(p.element)];
  for (std::size_t i = 0; i < row.node.size(); ++i) give(row.node[i], double(row.weight[i]));
}

struct LongMean {
  Vec3d x, v;
  double magnitude = 0;  ///< sum |w|

  LongMean(const Bodies& bodies, const MaterialPoint& p) noexcept {
    each_of_long(bodies, p, [this](std::int32_t, double w, Vec3d xi, Vec3d vi) {
      x += w * xi, v += w * vi, magnitude += std::fabs(w);
    });
  }
};

Vec3d beside(const Row& row, const MaterialPoint& p) noexcept {
  return p.frame == MaterialPoint::triangle ? SheetFrame(row.x).out(offset_of(p)) : offset_of(p);
}

Vec3d along(Vec3d v, Vec3d dir) noexcept { return dir.x == 0 && dir.y == 0 && dir.z == 0 ? v : dot(v, dir) * dir; }

/// All of a load as it is now.
Vec3d force_of(const PointLoad& load, Vec3d x, Vec3d v) noexcept {
  return load.f0 + along(load.k * (load.target - x) + load.d * (load.u - v), load.dir);
}

void put_on_rod(const Bodies& bodies, const MaterialPoint& p, const PointLoad& load, Tag tag) noexcept {
  const std::size_t i = p.body.index();
  const StrandBody& body = bodies.strand(i);
  const tissue::StrandState& s = bodies.strand_state(i);
  const OnRod on = on_rod(body, s, p);
  const RodFrame frame(body, s, on.element);
  const Vec3d off = frame.beside(on, p), ends = s.v[on.element + 1] - s.v[on.element];
  const Vec3d way = (ends - dot(ends, frame.now) * frame.now) / frame.length;
  const Vec3d swings = cross(frame.spin(way), off), axis = s.v[on.element] + on.w * ends;
  StrandLoads& loads = bodies.work->strands[i].loads;
  tissue::StrandLoad at;
  at.element = int(on.element);
  at.w = on.w;
  at.f0 = load.f0 + along(load.d * (load.u - swings), load.dir);
  at.k = load.k;
  at.x0 = load.target + body.model.tick * load.u - off;
  at.dir = load.dir;
  at.d = load.d;
  loads.add(at, tag);
  const Vec3d x = s.x[on.element] + on.w * (s.x[on.element + 1] - s.x[on.element]) + off;
  const Vec3d g = frame.transposed(cross(off, force_of(load, x, axis + swings)));
  const Vec3d couple = (g - dot(g, frame.now) * frame.now) / frame.length;
  if (dot(couple, couple) < 1e-24) return;  // [N^2]
  tissue::StrandLoad end;
  end.element = int(on.element);
  end.d = load.d * dot(off, off) / (frame.length * frame.length);  // the couple turns the element as the force moves it
  end.f0 = end.d * s.v[on.element] - couple;
  loads.add(end, tag);
  end.w = 1;
  end.f0 = end.d * s.v[on.element + 1] + couple;
  loads.add(end, tag);
}

void put_on_nodes(const Bodies& bodies, const MaterialPoint& p, const PointLoad& load, Tag tag) noexcept {
  const Row row = row_of(bodies, p);
  NetworkLoads& loads = loads_on(bodies, p.body);
  const Vec3d off = beside(row, p), x = row.mean(row.x) + off;
  Vec3d v = row.mean(row.v), couple[3] = {};
  double turns = 0;  // what a node of the frame resists: the couple turns the frame as the force moves the row
  if (p.frame == MaterialPoint::triangle) {
    const SheetFrame frame(row.x);
    v += cross(frame.spin(row.v), off);
    frame.bear(cross(off, force_of(load, x, counted_on(v))), couple);
    const double arm = std::min(frame.length, frame.height);
    turns = load.d * dot(off, off) / (arm * arm);
  }
  v = counted_on(v);
  // Each node bears a share of k and d as if it were alone: more than they are together, so that what is stable for
  // one point is for its row. Weights beyond 1, of points outside of their nodes, count for the coupling between them.
  // Both hold the nodes to their mean velocity, so that they calm what the nodes do against each other.
  const double magnitude = row.magnitude();
  Vec3d together;
  for (std::size_t i = 0; i < std::size_t(row.count); ++i)
    together += (std::fabs(row.weight[i]) / magnitude) * counted_on(row.v[i]);
  bool another = false;
  for (std::size_t i = 0; i < std::size_t(row.count); ++i) {
    const double share = row.weight[i], counts = std::fabs(share) * magnitude;
    Vec3d f0 = share * (load.f0 + along(load.d * (load.u - v), load.dir));
    if (p.frame == MaterialPoint::triangle && i < 3) f0 += couple[i] + turns * counted_on(row.v[i]);
    if (share == 0 && f0.x == 0 && f0.y == 0 && f0.z == 0) continue;
    tissue::NodeLoad node;
    node.node = row.node[i];
    node.k = float(counts * load.k);
    node.d = float(counts * load.d + (i < 3 ? turns : 0));
    node.dir = vec_cast<float>(load.dir);
    node.f0 = vec_cast<float>(f0 + along((counts * load.d) * together, load.dir));
    if (counts > 0) {
      node.x0 = vec_cast<float>(row.x[i] + (share / counts) * (load.target - x));
      node.u = vec_cast<float>(together + (share / counts) * (load.u - v));
    }
    loads.add(node, tag, another);
    another = true;
  }
}

void put_on_long_row(const Bodies& bodies, const MaterialPoint& p, const PointLoad& load, Tag tag) noexcept {
  const LongMean mean(bodies, p);
  const Vec3d x = mean.x + offset_of(p), v = counted_on(mean.v);
  NetworkLoads& loads = loads_on(bodies, p.body);
  bool another = false;
  each_of_long(bodies, p, [&](std::int32_t n, double share, Vec3d xi, Vec3d vi) {
    const double counts = std::fabs(share) * mean.magnitude;
    tissue::NodeLoad node;
    node.node = n;
    node.k = float(counts * load.k);
    node.d = float(counts * load.d);
    node.dir = vec_cast<float>(load.dir);
    node.f0 = vec_cast<float>(share * (load.f0 + along(load.d * (load.u - v), load.dir)) +
                              along((counts * load.d) * counted_on(vi), load.dir));
    if (counts > 0) {
      node.x0 = vec_cast<float>(xi + (share / counts) * (load.target - x));
      node.u = vec_cast<float>(counted_on(vi) + (share / counts) * (load.u - v));
    }
    loads.add(node, tag, another);
    another = true;
  });
}

/// Nodes of a row that are not there twice, and that take loads.
struct RowNodes {
  std::array<std::int32_t, kRowNodes> node{};
  std::array<Vec3d, kRowNodes> x;
  int count = 0;

  bool has(std::int32_t n) const noexcept {
    return std::find(node.begin(), node.begin() + count, n) != node.begin() + count;
  }
  void add(std::int32_t n, Vec3d at) noexcept {
    if (count == kRowNodes || has(n)) return;
    node[std::size_t(count)] = n;
    x[std::size_t(count++)] = at;
  }
};

/// Puts three corners first that lie in no line, if there are such. @return are there?
bool begin_with_triangle(RowNodes& corners) noexcept {
  constexpr double kInLine = 0.2;  // sine of the least angle
  const auto begins_with = [&corners](int place, int corner) {
    std::swap(corners.x[std::size_t(place)], corners.x[std::size_t(corner)]);
    std::swap(corners.node[std::size_t(place)], corners.node[std::size_t(corner)]);
  };
  for (int b = 1; b + 1 < corners.count; ++b)
    for (int c = b + 1; c < corners.count; ++c) {
      const Vec3d to_b = corners.x[std::size_t(b)] - corners.x[0], to_c = corners.x[std::size_t(c)] - corners.x[0];
      if (!(length(cross(to_b, to_c)) > kInLine * length(to_b) * length(to_c))) continue;
      begins_with(1, b);
      begins_with(2, c);
      return true;
    }
  return false;
}

/// With weights of the corners. What those do not give, as beside nodes that lie in a plane, is an offset that turns
/// with three of them.
void fit(RowNodes corners, Vec3d place, MaterialPoint& p) noexcept {
  constexpr double kGiven = 1e-6;  // [m]
  const bool turns = begin_with_triangle(corners);
  p.count = corners.count;
  std::copy(corners.node.begin(), corners.node.end(), p.node.begin());
  const std::size_t n = std::size_t(p.count);
  if (!fit_affine({corners.x.data(), n}, place, {p.weight.data(), n})) p.weight = {1};
  Row row;
  row.count = p.count;
  row.x = corners.x;
  row.weight[0] = 1;
  for (std::size_t i = 1; i < n; ++i) row.weight[i] = double(p.weight[i]), row.weight[0] -= row.weight[i];
  const Vec3d off = place - row.mean(row.x);
  p.frame = turns && length(off) > kGiven ? MaterialPoint::triangle : MaterialPoint::space;
  set_offset(p, p.frame == MaterialPoint::triangle ? SheetFrame(row.x).in(off) : off);
}

NearNodes nodes_near(const Bodies& bodies, BodyId body, Vec3d place) noexcept {
  const tissue::NodeView nodes = nodes_of(bodies, body);
  NearNodes near;
  for (std::size_t n = 0; n < node_count(bodies, body); ++n) {
    if (!takes_loads(bodies, body, int(n))) continue;
    const Vec3d off = nodes.position(int(n)) - place;
    near.offer(std::int32_t(n), dot(off, off));
  }
  return near;
}

/// f(cell) of all cells at some nodes. In a tick it is known which those are.
template <class F>
void each_cell_at(const Bodies& bodies, BodyId body, std::span<const std::int32_t> nodes, F&& f) noexcept {
  const std::size_t i = body.index() - bodies.models.solids.size();
  const bool stepping = bodies.work && i < bodies.work->cuttables.size();
  const tissue::CuttableWork* const work = stepping ? &bodies.work->cuttables[i].body : nullptr;
  if (work && work->made_for == bodies.states.cuttables[i].version) {
    for (const std::int32_t n : nodes)
      for (int k = work->begin[std::size_t(n)]; k < work->begin[std::size_t(n) + 1]; ++k)
        f(std::size_t(work->around[std::size_t(k)]));
    return;
  }
  const std::vector<geometry::Tet>& cells = tets_of(bodies, body).cells;
  const auto among = [&](std::int32_t n) { return std::find(nodes.begin(), nodes.end(), n) != nodes.end(); };
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (std::any_of(cells[c].begin(), cells[c].end(), among)) f(c);
}

/// In the cell that it is in or least outside of, of those at some nodes.
MaterialPoint in_a_cell(const Bodies& bodies, BodyId body, std::span<const std::int32_t> at, Vec3d place) noexcept {
  const tissue::NodeView nodes = nodes_of(bodies, body);
  const std::vector<geometry::Tet>& cells = tets_of(bodies, body).cells;
  MaterialPoint best;
  double least = 1e30;
  each_cell_at(bodies, body, at, [&](std::size_t c) {
    RowNodes corners;
    for (std::int32_t k = 0; k < 4; ++k) {
      const std::int32_t n = cells[c][std::size_t(k)];
      if (takes_loads(bodies, body, n)) corners.add(k, nodes.position(n));
    }
    if (corners.count < 3) return;
    MaterialPoint p;
    p.body = body;
    p.element = std::int32_t(c);
    fit(corners, place, p);
    double magnitude = length(offset_of(p)) / 0.001;
    for (std::size_t i = 0; i < std::size_t(p.count); ++i) magnitude += std::fabs(double(p.weight[i]));
    if (magnitude < least) least = magnitude, best = p;
  });
  return best;
}

MaterialPoint in_a_triangle(const Bodies& bodies, std::size_t membrane, Vec3d place) noexcept {
  const tissue::NodeView nodes = membrane_nodes(bodies, membrane);
  const auto& triangles = bodies.models.membranes[membrane].sheet.triangles;
  const std::vector<std::uint8_t>& torn = bodies.states.torn[membrane];
  MaterialPoint best;
  geometry::TrianglePoint<double> nearest{};
  double least = 1e30;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (torn[t]) continue;
    const auto [a, b, c] = triangles[t];
    const auto on = geometry::closest_on_triangle(place, nodes.position(a), nodes.position(b), nodes.position(c));
    if (!(on.distance2 < least)) continue;
    least = on.distance2;
    nearest = on;
    best.element = std::int32_t(t);
  }
  if (best.element < 0) return {};
  best.body = BodyId::membrane(membrane);
  best.count = 3;
  best.frame = MaterialPoint::triangle;
  Row row;
  for (std::size_t k = 0; k < 3; ++k) {
    best.node[k] = triangles[std::size_t(best.element)][k];
    best.weight[k] = float(nearest.weights[int(k)]);
    row.x[k] = nodes.position(best.node[k]);
    row.weight[k] = double(best.weight[k]);
  }
  row.count = 3;
  set_offset(best, SheetFrame(row.x).in(place - row.mean(row.x)));
  return best;
}

MaterialPoint on_nearest_element(const Bodies& bodies, std::size_t rod, Vec3d place) noexcept {
  const tissue::StrandState& s = bodies.strand_state(rod);
  std::int32_t best = -1;
  double least = 1e30, w = 0;
  for (int e = 0; e + 1 < bodies.strand(rod).nodes(); ++e) {
    const Vec3d a = s.x[std::size_t(e)], b = s.x[std::size_t(e) + 1];
    if (!s.alive[std::size_t(e)]) continue;
    const double at = geometry::closest_on_segment(place, a, b);
    const double far2 = geometry::distance2(place, a + at * (b - a));
    if (far2 < least) least = far2, best = e, w = at;
  }
  if (best < 0) return {};
  const Vec3d a = s.x[std::size_t(best)], b = s.x[std::size_t(best) + 1];
  return at_element(bodies, rod, best, w, place - (a + w * (b - a)));
}

}  // namespace

Vec3d offset_of(const MaterialPoint& p) noexcept {
  return {double(p.offset[0]), double(p.offset[1]), double(p.offset[2])};
}

StrandPlace place_on_rod(const MaterialPoint& p) noexcept { return {p.element, double(p.weight[0])}; }

double arc_of(const BodyModels& models, const MaterialPoint& p) noexcept {
  return arc_at(models.strand_bodies[p.body.index()], place_on_rod(p));
}

std::int32_t vertex_of(const Bodies& bodies, const MaterialPoint& p) noexcept {
  if (p.body.is(BodyKind::organ) && !is_tetrahedral(bodies, p.body)) return p.element;
  if (p.count != 1) return -1;
  const geometry::Tet* const cell = cell_of(bodies, p.body, p.element);
  return cell ? (*cell)[std::size_t(p.node[0])] : p.node[0];
}

bool is_valid(const BodyModels& models, const MaterialPoint& p) noexcept {
  const auto below = [](std::int32_t i, std::size_t count) { return i >= 0 && std::size_t(i) < count; };
  const auto none_or_below = [&below](std::int32_t i, std::size_t count) { return i == -1 || below(i, count); };
  for (const float off : p.offset)
    if (!(std::fabs(off) < 10)) return false;
  for (const float w : p.weight)
    if (!(std::fabs(w) < 10)) return false;
  if (p.in_space()) return p.body == BodyId{};
  const std::size_t i = p.body.index(), lattices = models.solids.size();
  if (p.body.is(BodyKind::strand))
    return !p.is_long() && i < models.strand_bodies.size() &&
           below(p.element, std::size_t(models.strand_bodies[i].nodes() - 1)) && p.weight[0] >= 0 && p.weight[0] <= 1;
  std::size_t nodes = 0;
  if (p.body.is(BodyKind::organ) && i < lattices) {
    const std::size_t vertices = models.solids[i].skin.weights.size();
    if (p.frame == MaterialPoint::skin_row) return below(p.element, vertices);
    if (!none_or_below(p.element, vertices)) return false;
    nodes = std::size_t(models.solids[i].network.nodes);
  } else if (p.body.is(BodyKind::organ) && i < lattices + models.cuttables.size()) {
    nodes = 4;
    if (!below(p.element, models.cuttables[i - lattices].body.drawn.cells.size())) return false;
  } else if (p.body.is(BodyKind::membrane) && i < models.membranes.size()) {
    nodes = std::size_t(models.membranes[i].sheet.nodes());
    if (!none_or_below(p.element, models.membranes[i].sheet.triangles.size())) return false;
  } else if (p.body.is(BodyKind::fat) && i < models.fat.size()) {
    nodes = std::size_t(models.fat[i].fat.lobules());
  }
  const bool turns = p.frame == MaterialPoint::triangle;
  if (!turns && p.frame != MaterialPoint::space) return false;
  if (p.count < (turns ? 3 : 1) || p.count > kRowNodes) return false;
  return std::all_of(p.node.begin(), p.node.begin() + p.count, [&](std::int32_t n) { return below(n, nodes); });
}

MaterialPoint in_space(Vec3d place) noexcept {
  MaterialPoint p;
  set_offset(p, place);
  return p;
}

MaterialPoint at_node(const Bodies& bodies, BodyId body, std::int32_t node, Vec3d offset) noexcept {
  MaterialPoint p;
  p.body = body;
  p.count = 1;
  p.node[0] = node;
  p.weight[0] = 1;
  set_offset(p, offset);
  if (!body.is(BodyKind::membrane) || (offset.x == 0 && offset.y == 0 && offset.z == 0)) return p;
  const auto& triangles = bodies.models.membranes[body.index()].sheet.triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto at = std::find(triangles[t].begin(), triangles[t].end(), node);
    if (at == triangles[t].end()) continue;
    const std::size_t first = std::size_t(at - triangles[t].begin());
    const tissue::NodeView nodes = membrane_nodes(bodies, body.index());
    std::array<Vec3d, kRowNodes> x;
    for (std::size_t k = 0; k < 3; ++k) {
      p.node[k] = triangles[t][(first + k) % 3];
      x[k] = nodes.position(p.node[k]);
    }
    p.element = std::int32_t(t);
    p.count = 3;
    p.frame = MaterialPoint::triangle;
    set_offset(p, SheetFrame(x).in(offset));
    return p;
  }
  return p;
}

MaterialPoint at_element(const Bodies& bodies, std::size_t rod, std::int32_t element, double w, Vec3d offset) noexcept {
  const StrandBody& body = bodies.strand(rod);
  const std::size_t e = std::size_t(element);
  MaterialPoint p;
  p.body = BodyId::strand(rod);
  p.element = element;
  p.weight[0] = float(w);
  p.frame = MaterialPoint::rod;
  set_offset(p, swung(offset, direction(bodies.strand_state(rod).x, e), direction(body.model.rest, e)));
  return p;
}

MaterialPoint on_object(BodyId body, std::int32_t place) noexcept {
  MaterialPoint p;
  p.body = body;
  p.element = place;
  return p;
}

MaterialPoint on_vertex(const Bodies& bodies, std::size_t organ, std::int32_t vertex) noexcept {
  MaterialPoint p;
  p.body = BodyId::organ(organ);
  if (is_tetrahedral(bodies, p.body)) {  // its skin's vertices are its nodes
    p.count = 1;
    p.weight[0] = 1;
    each_cell_at(bodies, p.body, {&vertex, 1}, [&](std::size_t c) {
      const geometry::Tet& cell = tets_of(bodies, p.body).cells[c];
      const auto at = std::find(cell.begin(), cell.end(), vertex);
      if (p.element >= 0 || at == cell.end()) return;
      p.element = std::int32_t(c);
      p.node[0] = std::int32_t(at - cell.begin());
    });
    return p.element >= 0 ? p : MaterialPoint{};
  }
  p.element = vertex;
  bool fits = true;
  skin_of(bodies, organ).each_carrier(vertex, [&](int node, int, float weight) {
    if (weight == 0) return;
    if (p.count == kRowNodes) {
      fits = false;
      return;
    }
    p.node[std::size_t(p.count)] = node;
    p.weight[std::size_t(p.count++)] = weight;
  });
  if (fits) return p;
  p.frame = MaterialPoint::skin_row;
  p.count = 0;
  p.node = {};
  p.weight = {};
  return p;
}

MaterialPoint at_vertex(const Bodies& bodies, std::size_t organ, std::int32_t vertex, Vec3d place) noexcept {
  const BodyId body = BodyId::organ(organ);
  const tissue::NodeView nodes = organ_nodes(bodies, organ);
  RowNodes corners;
  skin_of(bodies, organ).each_carrier(vertex, [&](int node, int, float) {
    if (takes_loads(bodies, body, node)) corners.add(node, nodes.position(node));
  });
  if (is_tetrahedral(bodies, body)) return in_a_cell(bodies, body, {corners.node.data(), 1}, place);
  MaterialPoint p;
  p.body = body;
  fit(corners, place, p);
  return p;
}

MaterialPoint along_with_vertex(const Bodies& bodies, std::size_t organ, std::int32_t vertex, Vec3d place) noexcept {
  MaterialPoint p;
  if (is_tetrahedral(bodies, BodyId::organ(organ))) {  // its skin's vertices are its nodes
    p = at_vertex(bodies, organ, vertex, place);
    if (p.element < 0) return {};
    const geometry::Tet& cell = tets_of(bodies, p.body).cells[std::size_t(p.element)];
    p.count = 1;
    p.frame = MaterialPoint::space;
    p.node = {std::int32_t(std::find(cell.begin(), cell.end(), vertex) - cell.begin())};
    p.weight = {1};
    p.offset = {};
  } else {
    p = on_vertex(bodies, organ, vertex);
    if (!p.is_long()) p.element = -1;
  }
  set_offset(p, place - place_of(bodies, p));
  return p;
}

MaterialPoint attach(const Bodies& bodies, BodyId body, Vec3d place) noexcept {
  if (body.is(BodyKind::strand)) return on_nearest_element(bodies, body.index(), place);
  if (body.is(BodyKind::membrane)) return in_a_triangle(bodies, body.index(), place);
  const NearNodes near = nodes_near(bodies, body, place);
  const std::span<const std::int32_t> found{near.node.data(), std::size_t(near.count)};
  if (is_tetrahedral(bodies, body)) return in_a_cell(bodies, body, found, place);
  const tissue::NodeView nodes = nodes_of(bodies, body);
  RowNodes corners;
  for (const std::int32_t n : found) corners.add(n, nodes.position(n));
  MaterialPoint p;
  if (corners.count == 0) return p;
  p.body = body;
  fit(corners, place, p);
  return p;
}

Vec3d foot_of(const Bodies& bodies, const MaterialPoint& p) noexcept {
  if (p.in_space()) return offset_of(p);
  if (p.is_long()) return LongMean(bodies, p).x;
  if (!p.body.is(BodyKind::strand)) {
    const Row row = row_of(bodies, p);
    return row.mean(row.x);
  }
  const tissue::StrandState& s = bodies.strand_state(p.body.index());
  const OnRod on = on_rod(bodies.strand(p.body.index()), s, p);
  return s.x[on.element] + on.w * (s.x[on.element + 1] - s.x[on.element]) + on.along * direction(s.x, on.element);
}

Vec3d place_of(const Bodies& bodies, const MaterialPoint& p) noexcept {
  if (p.in_space()) return offset_of(p);
  if (p.is_long()) return LongMean(bodies, p).x + offset_of(p);
  if (!p.body.is(BodyKind::strand)) {
    const Row row = row_of(bodies, p);
    return row.mean(row.x) + beside(row, p);
  }
  const StrandBody& body = bodies.strand(p.body.index());
  const tissue::StrandState& s = bodies.strand_state(p.body.index());
  const OnRod on = on_rod(body, s, p);
  return s.x[on.element] + on.w * (s.x[on.element + 1] - s.x[on.element]) + RodFrame(body, s, on.element).beside(on, p);
}

Vec3d velocity_of(const Bodies& bodies, const MaterialPoint& p) noexcept {
  if (p.in_space()) return {};
  if (p.is_long()) return counted_on(LongMean(bodies, p).v);
  if (!p.body.is(BodyKind::strand)) {
    const Row row = row_of(bodies, p);
    Vec3d v = row.mean(row.v);
    if (p.frame == MaterialPoint::triangle) {
      const SheetFrame frame(row.x);
      v += cross(frame.spin(row.v), frame.out(offset_of(p)));
    }
    return counted_on(v);
  }
  const StrandBody& body = bodies.strand(p.body.index());
  const tissue::StrandState& s = bodies.strand_state(p.body.index());
  const OnRod on = on_rod(body, s, p);
  const RodFrame frame(body, s, on.element);
  const Vec3d ends = s.v[on.element + 1] - s.v[on.element];
  const Vec3d way = (ends - dot(ends, frame.now) * frame.now) / frame.length;
  return s.v[on.element] + on.w * ends + cross(frame.spin(way), frame.beside(on, p));
}

Vec3d drawn_place(const Bodies& bodies, const MaterialPoint& p) noexcept {
  if (p.in_space()) return offset_of(p);
  if (p.frame == MaterialPoint::skin_row)
    return vec_cast<double>(skin_of(bodies, p.body.index()).rest[std::size_t(p.element)]) + offset_of(p);
  if (p.body.is(BodyKind::strand)) {
    const std::vector<Vec3d>& rest = bodies.strand(p.body.index()).model.rest;
    const std::size_t e = std::size_t(p.element);
    return rest[e] + double(p.weight[0]) * (rest[e + 1] - rest[e]) + offset_of(p);
  }
  const Row row = drawn_row(bodies, p);
  return row.mean(row.x) + beside(row, p);
}

Vec3d normal_at(const Bodies& bodies, const MaterialPoint& p, Vec3d drawn) noexcept {
  if (p.in_space()) return drawn;
  if (p.body.is(BodyKind::strand)) {
    const StrandBody& body = bodies.strand(p.body.index());
    const tissue::StrandState& s = bodies.strand_state(p.body.index());
    const RodFrame frame(body, s, on_rod(body, s, p).element);
    return swung(drawn, frame.drawn, frame.now);
  }
  const Row now = row_of(bodies, p), rest = drawn_row(bodies, p);
  if (p.count < 4) return p.count == 3 ? SheetFrame(now.x).out(SheetFrame(rest.x).in(drawn)) : drawn;
  // The affine map of the row's nodes from where they were drawn takes two lines of the plane along.
  const Vec3d middle = middle_of(now), was = middle_of(rest);
  Mat3d moved{}, spread{};
  for (std::size_t i = 0; i < std::size_t(p.count); ++i) {
    moved = moved + outer(now.x[i] - middle, rest.x[i] - was);
    spread = spread + outer(rest.x[i] - was, rest.x[i] - was);
  }
  const Mat3d map = moved * inverse(spread);
  const Vec3d u = any_perpendicular(drawn), v = cross(drawn, u);
  const Vec3d normal = cross(map * u, map * v);
  const double square = dot(normal, normal);
  return square > 0 && square < 1e12 ? normalised(normal) : drawn;  // nodes that were drawn in a plane say nothing
}

void put_load(const Bodies& bodies, const MaterialPoint& p, const PointLoad& load, Tag tag) noexcept {
  if (p.in_space()) return;
  if (p.is_long()) return put_on_long_row(bodies, p, load, tag);
  if (p.body.is(BodyKind::strand)) return put_on_rod(bodies, p, load, tag);
  put_on_nodes(bodies, p, load, tag);
}

NodeForces transposed(const Bodies& bodies, const MaterialPoint& p, Vec3d force) noexcept {
  NodeForces out;
  if (p.in_space() || p.is_long()) return out;
  if (!p.body.is(BodyKind::strand)) {
    const Row row = row_of(bodies, p);
    Vec3d couple[3] = {};
    if (p.frame == MaterialPoint::triangle) SheetFrame(row.x).bear(cross(beside(row, p), force), couple);
    for (std::size_t i = 0; i < std::size_t(row.count); ++i)
      out.add(row.node[i], row.weight[i] * force + (p.frame == MaterialPoint::triangle && i < 3 ? couple[i] : Vec3d{}));
    return out;
  }
  const StrandBody& body = bodies.strand(p.body.index());
  const tissue::StrandState& s = bodies.strand_state(p.body.index());
  const OnRod on = on_rod(body, s, p);
  const RodFrame frame(body, s, on.element);
  const Vec3d g = frame.transposed(cross(frame.beside(on, p), force));
  const Vec3d couple = (g - dot(g, frame.now) * frame.now) / frame.length;
  out.add(std::int32_t(on.element), (1 - on.w) * force - couple);
  out.add(std::int32_t(on.element) + 1, on.w * force + couple);
  return out;
}

}  // namespace trocar::interactions
