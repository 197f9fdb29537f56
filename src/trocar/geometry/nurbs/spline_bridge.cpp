#include <cmath>
#include <stdexcept>

#include <trocar/geometry/nurbs/spline_bridge.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr double kRepeatSlack = 1e-12;  // [m], and of weights

double weight_in(const std::vector<double>& weights, std::size_t i) { return weights.empty() ? 1.0 : weights[i]; }

void require_repeat(bool same) {
  if (!same) throw std::invalid_argument("nurbs_of: the last control points of a periodic spline repeat the first");
}

void require_degree(int degree) {
  if (degree > kMaxDegree) throw std::invalid_argument("spline_of: a degree up to 7 expected");
}

}  // namespace

Surface nurbs_of(const NurbsSurface& spline) {
  Surface s{{spline.degree_u, spline.periodic_u, spline.knots_u},
            {spline.degree_v, spline.periodic_v, spline.knots_v},
            {},
            {}};
  if (const std::string fault = fault_in(s.u); !fault.empty()) throw std::invalid_argument("nurbs_of: in u: " + fault);
  if (const std::string fault = fault_in(s.v); !fault.empty()) throw std::invalid_argument("nurbs_of: in v: " + fault);
  if (spline.count_u != s.u.functions() || spline.count_v != s.v.functions() ||
      spline.control.size() != static_cast<std::size_t>(spline.count_u) * spline.count_v ||
      (!spline.weights.empty() && spline.weights.size() != spline.control.size()))
    throw std::invalid_argument("nurbs_of: as many control points and weights as the knots ask for expected");
  for (int j = 0; j < spline.count_v; ++j)
    for (int i = 0; i < spline.count_u; ++i) {
      const std::size_t from = static_cast<std::size_t>(i) + static_cast<std::size_t>(spline.count_u) * j;
      const bool repeat = i >= s.u.points() || j >= s.v.points();
      if (!repeat) {
        s.points.push_back(spline.control[from]);
        if (!spline.weights.empty()) s.weights.push_back(spline.weights[from]);
        continue;
      }
      const std::size_t first =
          static_cast<std::size_t>(s.u.point_of(i)) + static_cast<std::size_t>(spline.count_u) * s.v.point_of(j);
      require_repeat(length(spline.control[from] - spline.control[first]) <= kRepeatSlack &&
                     std::fabs(weight_in(spline.weights, from) - weight_in(spline.weights, first)) <= kRepeatSlack);
    }
  require_valid(s, "nurbs_of");
  return s;
}

Curve nurbs_of(const NurbsCurve& spline) {
  Curve curve{{spline.degree, spline.periodic, spline.knots}, {}, {}};
  require_valid(curve.knots, "nurbs_of");
  const std::size_t functions = static_cast<std::size_t>(curve.knots.functions());
  if (spline.control.size() != functions || (!spline.weights.empty() && spline.weights.size() != functions))
    throw std::invalid_argument("nurbs_of: as many control points and weights as the knots ask for expected");
  for (int i = 0; i < curve.knots.functions(); ++i) {
    const auto first = static_cast<std::size_t>(curve.knots.point_of(i));
    if (first == static_cast<std::size_t>(i)) {
      curve.points.push_back(spline.control[first]);
      if (!spline.weights.empty()) curve.weights.push_back(spline.weights[first]);
    } else {
      require_repeat(length(spline.control[i] - spline.control[first]) <= kRepeatSlack &&
                     std::fabs(weight_in(spline.weights, i) - weight_in(spline.weights, first)) <= kRepeatSlack);
    }
  }
  require_valid(curve, "nurbs_of");
  return curve;
}

NurbsCurve spline_of(const Curve& curve) {
  require_valid(curve, "spline_of");
  require_degree(curve.knots.degree);
  NurbsCurve spline{curve.knots.degree, curve.knots.periodic, curve.knots.values, {}, {}};
  for (int i = 0; i < curve.knots.functions(); ++i) {
    spline.control.push_back(curve.points[curve.knots.point_of(i)]);
    if (!curve.weights.empty()) spline.weights.push_back(curve.weights[curve.knots.point_of(i)]);
  }
  return spline;
}

NurbsSurface spline_of(const Surface& s) {
  require_valid(s, "spline_of");
  require_degree(s.u.degree), require_degree(s.v.degree);
  NurbsSurface spline;
  spline.degree_u = s.u.degree, spline.degree_v = s.v.degree;
  spline.periodic_u = s.u.periodic, spline.periodic_v = s.v.periodic;
  spline.knots_u = s.u.values, spline.knots_v = s.v.values;
  spline.count_u = s.u.functions(), spline.count_v = s.v.functions();
  for (int j = 0; j < spline.count_v; ++j)
    for (int i = 0; i < spline.count_u; ++i) {
      const int from = s.index(s.u.point_of(i), s.v.point_of(j));
      spline.control.push_back(s.points[from]);
      if (!s.weights.empty()) spline.weights.push_back(s.weights[from]);
    }
  return spline;
}

}  // namespace trocar::geometry::nurbs
