#include <algorithm>
#include <cmath>

#include <trocar/interactions/objects/tissue_point.hpp>

namespace trocar::interactions {
namespace {

/// The nearest nodes to a place, nearest first.
struct NearNodes {
  std::array<std::int32_t, kPointNodes> node{};
  std::array<double, kPointNodes> square{};
  int count = 0;

  void offer(std::int32_t n, double d2) noexcept {
    if (count == kPointNodes && d2 >= square[kPointNodes - 1]) return;
    int at = count < kPointNodes ? count++ : kPointNodes - 1;
    for (; at > 0 && square[std::size_t(at - 1)] > d2; --at) {
      square[std::size_t(at)] = square[std::size_t(at - 1)];
      node[std::size_t(at)] = node[std::size_t(at - 1)];
    }
    square[std::size_t(at)] = d2;
    node[std::size_t(at)] = n;
  }
};

NearNodes nearest_nodes(const tissue::NodeView& nodes, Vec3d p) noexcept {
  NearNodes near;
  for (std::size_t n = 0; n < nodes.row_of_node.size(); ++n) {
    const Vec3d off = nodes.position(int(n)) - p;
    near.offer(std::int32_t(n), dot(off, off));
  }
  return near;
}

/// What a weighted fit of an affine function to the nodes about a place is made of.
struct PointFit {
  double a[4][4] = {}, g[kPointNodes] = {};
  Vec3d d[kPointNodes];

  PointFit(const tissue::NodeView& nodes, const NearNodes& near, Vec3d p) noexcept {
    const double scale = std::max(1e-4, std::sqrt(near.square[std::size_t(near.count - 1)]));
    double total = 0;
    for (int i = 0; i < near.count; ++i) {
      d[i] = (nodes.position(near.node[std::size_t(i)]) - p) / scale;
      g[i] = 1 / (dot(d[i], d[i]) + 0.05);
      total += g[i];
    }
    for (int i = 0; i < near.count; ++i) {
      g[i] /= total;
      const double basis[4] = {1, d[i].x, d[i].y, d[i].z};
      for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) a[r][c] += g[i] * basis[r] * basis[c];
    }
  }

  /// w_i = g_i (z0 + z . d_i) with sum w = 1 and sum w d = 0, as a strand's end has them; a ridge leaves out what nodes
  /// do not tell, as across the plane that they lie in. @return sum |w|
  double weights(double ridge, int count, std::array<float, kPointNodes>& w) const noexcept {
    double m[4][5] = {};
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) m[r][c] = a[r][c];
    for (int r = 1; r < 4; ++r) m[r][r] += ridge;
    m[0][4] = 1;
    for (int c = 0; c < 4; ++c)  // positive definite: no pivoting
      for (int r = 0; r < 4; ++r) {
        if (r == c) continue;
        const double f = m[r][c] / m[c][c];
        for (int k = c; k < 5; ++k) m[r][k] -= f * m[c][k];
      }
    const double z0 = m[0][4] / m[0][0];
    const Vec3d z{m[1][4] / m[1][1], m[2][4] / m[2][2], m[3][4] / m[3][3]};
    double sum = 0;
    for (int i = 0; i < count; ++i) {
      w[std::size_t(i)] = float(g[i] * (z0 + dot(z, d[i])));
      sum += std::fabs(double(w[std::size_t(i)]));
    }
    return sum;
  }
};

/// In tissue that is crushed the nodes about a place lie all but in a plane, and what they do across it would count a
/// hundredfold: it counts the less, then, the more that is.
void affine_weights(const tissue::NodeView& nodes, const NearNodes& near, Vec3d p, TissuePoint& out) noexcept {
  constexpr double kMostWeights = 8;  // sum |w|. Our choice: 1 inside of the nodes, up to 6 seen beside them
  const PointFit fit(nodes, near, p);
  out.count = near.count;
  double ridge = 1e-6;
  while (!(fit.weights(ridge, near.count, out.weight) <= kMostWeights) && ridge < 1) ridge *= 10;
  double sum = 0;
  for (int i = 0; i < near.count; ++i) {
    out.node[std::size_t(i)] = near.node[std::size_t(i)];
    sum += double(out.weight[std::size_t(i)]);
  }
  if (!(std::fabs(sum - 1) < 0.01)) {  // nothing to go by: the nearest node alone
    out.count = 1;
    out.weight[0] = 1;
  }
}

Vec3d mean_of(const tissue::NodeView& nodes, const TissuePoint& point) noexcept {
  Vec3d p;
  for (int i = 0; i < point.count; ++i)
    p += double(point.weight[std::size_t(i)]) * nodes.position(point.node[std::size_t(i)]);
  return p;
}
Vec3d offset_of(const TissuePoint& point) noexcept {
  return {double(point.offset[0]), double(point.offset[1]), double(point.offset[2])};
}
void set_offset(TissuePoint& point, Vec3d off) noexcept {
  for (int k = 0; k < 3; ++k) point.offset[std::size_t(k)] = float(off[k]);
}

TissuePoint stick_to_nodes(const tissue::NodeView& nodes, BodyId body, Vec3d p) noexcept {
  TissuePoint out;
  out.body = body;
  const NearNodes near = nearest_nodes(nodes, p);
  if (near.count == 0) return out;
  affine_weights(nodes, near, p, out);
  set_offset(out, p - mean_of(nodes, out));
  return out;
}

TissuePoint stick_to_strand(const StrandBody& body, const tissue::StrandState& s, BodyId id, Vec3d p) noexcept {
  TissuePoint out;
  out.body = id;
  StrandPlace best;
  double least = 1e9;
  for (int e = 0; e + 1 < body.nodes(); ++e) {
    if (!s.alive[std::size_t(e)]) continue;
    const Vec3d a = s.x[std::size_t(e)], ab = s.x[std::size_t(e) + 1] - a;
    const double w = std::clamp(dot(p - a, ab) / std::max(1e-12, dot(ab, ab)), 0.0, 1.0);
    const Vec3d off = p - (a + w * ab);
    if (dot(off, off) >= least) continue;
    least = dot(off, off);
    best = {e, w};
  }
  const StrandFrame frame = frame_at(body, s, best);
  const Vec3d off = p - point_at(body, s, best);
  out.count = 1;
  out.node[0] = best.element;
  out.weight[0] = float(best.w);
  set_offset(out, {dot(off, frame.tangent), dot(off, frame.normal), dot(off, frame.binormal)});
  return out;
}

StrandPlace place_on_strand(const TissuePoint& point) noexcept { return {point.node[0], double(point.weight[0])}; }

}  // namespace

TissuePoint stick_to(const Bodies& bodies, BodyId body, Vec3d p) noexcept {
  if (body.is(BodyKind::strand))
    return stick_to_strand(bodies.strand(body.index()), bodies.strand_state(body.index()), body, p);
  return stick_to_nodes(nodes_of(bodies, body), body, p);
}

Vec3d point_of(const Bodies& bodies, const TissuePoint& point) noexcept {
  const Vec3d off = offset_of(point);
  if (!point.body.is(BodyKind::strand)) return mean_of(nodes_of(bodies, point.body), point) + off;
  const StrandBody& body = bodies.strand(point.body.index());
  const tissue::StrandState& s = bodies.strand_state(point.body.index());
  const StrandFrame frame = frame_at(body, s, place_on_strand(point));
  return point_at(body, s, place_on_strand(point)) + off.x * frame.tangent + off.y * frame.normal +
         off.z * frame.binormal;
}

Vec3d velocity_of(const Bodies& bodies, const TissuePoint& point) noexcept {
  Vec3d v;
  if (point.body.is(BodyKind::strand)) {
    const tissue::StrandState& s = bodies.strand_state(point.body.index());
    const std::size_t e = std::size_t(point.node[0]);
    return s.v[e] + double(point.weight[0]) * (s.v[e + 1] - s.v[e]);
  }
  const tissue::NodeView nodes = nodes_of(bodies, point.body);
  for (int i = 0; i < point.count; ++i)
    v += double(point.weight[std::size_t(i)]) * nodes.velocity(point.node[std::size_t(i)]);
  return counted_on(v);
}

Vec3d drawn_place(std::span<const Vec3d> rest, const TissuePoint& point) noexcept {
  Vec3d p = offset_of(point);
  for (int i = 0; i < point.count; ++i)
    if (std::size_t(point.node[std::size_t(i)]) < rest.size())
      p += double(point.weight[std::size_t(i)]) * rest[std::size_t(point.node[std::size_t(i)])];
  return p;
}

void press_on(const Bodies& bodies, const TissuePoint& point, Vec3d force, double resists, double damps,
              Vec3d velocity) noexcept {
  if (point.body.is(BodyKind::strand)) {
    tissue::StrandLoad load;
    load.element = point.node[0];
    load.w = double(point.weight[0]);
    load.d = resists + damps;
    load.f0 = force + resists * velocity_of(bodies, point) + damps * velocity;
    bodies.work->strands[point.body.index()].loads.add(load, {Owner::body, 0, 0});
    return;
  }
  const tissue::NodeView nodes = nodes_of(bodies, point.body);
  NetworkLoads& to = loads_on(bodies, point.body);
  double weights = 0;  // above 1 where the point lies outside of its nodes: bounds the coupling between them
  for (int k = 0; k < point.count; ++k) weights += std::fabs(double(point.weight[std::size_t(k)]));
  for (int k = 0; k < point.count; ++k) {
    const double share = double(point.weight[std::size_t(k)]), d = std::fabs(share) * weights * resists;
    const double rubs = std::fabs(share) * damps;
    const int node = point.node[std::size_t(k)];
    tissue::NodeLoad load;
    load.node = node;
    load.d = float(d + rubs);
    load.f0 = vec_cast<float>(share * force + d * counted_on(nodes.velocity(node)) + rubs * velocity);
    to.add(load, {Owner::strand_end, 0, 0}, k > 0);
  }
}

}  // namespace trocar::interactions
