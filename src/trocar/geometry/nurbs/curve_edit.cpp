#include <algorithm>
#include <stdexcept>

#include <trocar/geometry/nurbs/curve_edit.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr double kJointSlack = 1e-9;  // [m]

}  // namespace

Curve inserted(const Curve& curve, double u, int times) {
  require_valid(curve, "inserted");
  return curve_of(inserted(row_of(curve), u, times));
}

Curve refined(const Curve& curve, const std::vector<double>& more) {
  require_valid(curve, "refined");
  return curve_of(refined(row_of(curve), more));
}

Curve elevated(const Curve& curve, int times) {
  require_valid(curve, "elevated");
  return curve_of(elevated(row_of(curve), times));
}

Curve reversed(const Curve& curve) {
  require_valid(curve, "reversed");
  return curve_of(reversed(row_of(curve)));
}

Curve opened(const Curve& curve, double u) {
  require_valid(curve, "opened");
  return curve_of(opened(row_of(curve), u));
}

Curve part(const Curve& curve, double a, double b) {
  require_valid(curve, "part");
  if (!(b > a)) throw std::invalid_argument("part: two ascending parameters expected");
  if (!curve.knots.periodic) return curve_of(part(row_of(curve), a, b));
  if (!(b - a <= curve.knots.extent())) throw std::invalid_argument("part: at most one period expected");
  const Row open = opened(row_of(curve), a);
  return curve_of(part(open, open.knots.start(), open.knots.start() + (b - a)));
}

std::pair<Curve, Curve> split(const Curve& curve, double u) {
  require_valid(curve, "split");
  if (curve.knots.periodic) throw std::invalid_argument("split: a closed curve is one piece; open it first");
  if (!(u > curve.knots.start() && u < curve.knots.end()))
    throw std::invalid_argument("split: a parameter inside of the domain expected");
  const Row row = row_of(curve);
  return {curve_of(part(row, row.knots.start(), u)), curve_of(part(row, u, row.knots.end()))};
}

Curve joined(const Curve& a, const Curve& b) {
  require_valid(a, "joined"), require_valid(b, "joined");
  if (a.knots.periodic || b.knots.periodic) throw std::invalid_argument("joined: open curves expected");
  if (!(length(a.points.back() - b.points.front()) <= kJointSlack))
    throw std::invalid_argument("joined: the second curve does not start where the first ends");
  const int degree = std::max(a.knots.degree, b.knots.degree);
  Row front = elevated(row_of(a), degree - a.knots.degree), back = elevated(row_of(b), degree - b.knots.degree);
  const double scale = front.points.back().w / back.points.front().w;  // all of a curve's weights may be scaled
  for (Vec4d& p : back.points) p = scale * p;
  return curve_of(joined(front, back));
}

Curve on_domain(const Curve& curve, double start, double end) {
  require_valid(curve, "on_domain");
  Curve result = curve;
  result.knots = on_domain(curve.knots, start, end);
  return result;
}

Curve moved(const Curve& curve, const Mat3d& turn, Vec3d shift) {
  Curve result = curve;
  for (Vec3d& p : result.points) p = turn * p + shift;
  return result;
}

double weighted_tolerance(const std::vector<Vec3d>& points, const std::vector<double>& weights, double tolerance) {
  if (weights.empty()) return tolerance;
  double farthest = 0.0;
  for (const Vec3d& p : points) farthest = std::max(farthest, length(p));
  return tolerance * *std::min_element(weights.begin(), weights.end()) / (1.0 + farthest);
}

std::optional<Curve> without_knot(const Curve& curve, double u, double tolerance) {
  require_valid(curve, "without_knot");
  const auto removal = without_knot(row_of(curve), u);
  if (!removal || !(removal->misfit <= weighted_tolerance(curve.points, curve.weights, tolerance))) return {};
  return curve_of(removal->row);
}

Curve without_needless_knots(const Curve& curve, double tolerance) {
  Curve result = curve;
  for (const Knot& knot : distinct(curve.knots))
    for (int k = 0; k < knot.multiplicity; ++k) {
      const auto fewer = without_knot(result, knot.value, tolerance);
      if (!fewer) break;
      result = *fewer;
    }
  return result;
}

std::optional<Curve> reduced(const Curve& curve, double tolerance) {
  require_valid(curve, "reduced");
  const auto removal = reduced(row_of(curve));
  if (!removal || !(removal->misfit <= weighted_tolerance(curve.points, curve.weights, tolerance))) return {};
  Curve result = curve_of(removal->row);
  return fault_in(result).empty() ? std::optional(result) : std::nullopt;
}

}  // namespace trocar::geometry::nurbs
