#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <trocar/geometry/nurbs/closure.hpp>
#include <trocar/geometry/nurbs/quadrature.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr double kSameWeight = 1e-12;
constexpr int kPiecesOfRational = 4;  // of a span, for quadrature

bool same_control(const Surface& s, int a, int b, double same_place) {
  return length(s.points[a] - s.points[b]) <= same_place && std::fabs(s.weight(a) - s.weight(b)) <= kSameWeight;
}

// The control point number `k` along a way in the row `r` across it.
int at(const Surface& s, Along way, int k, int r) { return way == Along::u ? s.index(k, r) : s.index(r, k); }

int count_along(const Surface& s, Along way) { return knots_along(s, way).points(); }
Along across(Along way) { return way == Along::u ? Along::v : Along::u; }

bool goes_around(const Surface& s, Along way, double same_place) {
  if (knots_along(s, way).periodic) return true;
  const int last = count_along(s, way) - 1;
  for (int r = 0; r < count_along(s, across(way)); ++r)
    if (!same_control(s, at(s, way, 0, r), at(s, way, last, r), same_place)) return false;
  return true;
}

// Whether everything at the start (or end) of the way is one point.
bool is_pole(const Surface& s, Along way, bool end, double same_place) {
  if (knots_along(s, way).periodic) return false;
  const int k = end ? count_along(s, way) - 1 : 0;
  for (int r = 1; r < count_along(s, across(way)); ++r)
    if (length(s.points[at(s, way, k, r)] - s.points[at(s, way, k, 0)]) > same_place) return false;
  return true;
}

// Integral over all spans of f(jet), in order.
template <class F>
double over_surface(const Surface& s, const F& f) {
  const int pieces = s.weights.empty() ? 1 : kPiecesOfRational;
  const auto each_piece = [pieces](const Knots& knots, const auto& act) {
    const std::vector<double> ends = breaks(knots);
    for (std::size_t k = 0; k + 1 < ends.size(); ++k)
      for (int i = 0; i < pieces; ++i) {
        const double step = (ends[k + 1] - ends[k]) / pieces;
        act(ends[k] + i * step, ends[k] + (i + 1) * step);
      }
  };
  double sum = 0.0;
  each_piece(s.v, [&](double v0, double v1) {
    each_piece(s.u, [&](double u0, double u1) {
      sum += gauss5(v0, v1, [&](double v) { return gauss5(u0, u1, [&](double u) { return f(jet(s, u, v)); }); });
    });
  });
  return sum;
}

}  // namespace

Closure closure_of(const Surface& s, double same_place) {
  require_valid(s, "closure_of");
  Closure result;
  result.around_u = goes_around(s, Along::u, same_place);
  result.around_v = goes_around(s, Along::v, same_place);
  for (int end = 0; end < 2; ++end) {
    result.pole_at_u[end] = is_pole(s, Along::u, end == 1, same_place);
    result.pole_at_v[end] = is_pole(s, Along::v, end == 1, same_place);
  }
  return result;
}

void require_closed(const Surface& surface, const char* who) {
  const Closure c = closure_of(surface);
  if (c.closed()) return;
  std::string open = std::string(who) + ": a closed surface expected; open are";
  if (!c.around_u && !c.around_v) throw std::invalid_argument(open + " both directions");
  const bool* poles = c.around_u ? c.pole_at_v : c.pole_at_u;
  if (!poles[0]) open += " its start";
  if (!poles[1]) open += std::string(poles[0] ? "" : " and") + " its end";
  throw std::invalid_argument(open + " in " + (c.around_u ? "v" : "u"));
}

Nodes nodes_of(const Surface& s, double same_place) {
  const Closure c = closure_of(s, same_place);
  const int nu = s.u.points(), nv = s.v.points();
  Nodes nodes;
  std::vector<int> number(s.points.size(), -1);
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      int first_i = c.around_u && !s.u.periodic && i == nu - 1 ? 0 : i;
      int first_j = c.around_v && !s.v.periodic && j == nv - 1 ? 0 : j;
      if ((c.pole_at_v[0] && first_j == 0) || (c.pole_at_v[1] && first_j == nv - 1)) first_i = 0;
      if ((c.pole_at_u[0] && first_i == 0) || (c.pole_at_u[1] && first_i == nu - 1)) first_j = 0;
      int& node = number[s.index(first_i, first_j)];
      if (node < 0) node = nodes.count++;
      nodes.of_point.push_back(node);
    }
  return nodes;
}

std::vector<Vec3d> places_of(const Nodes& nodes, const std::vector<Vec3d>& points) {
  std::vector<Vec3d> places(static_cast<std::size_t>(nodes.count));
  for (std::size_t i = points.size(); i-- > 0;) places[nodes.of_point[i]] = points[i];  // the first is what stays
  return places;
}

void place(const Nodes& nodes, const std::vector<Vec3d>& places, std::vector<Vec3d>& points) noexcept {
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = places[nodes.of_point[i]];
}

double area(const Surface& s) {
  require_valid(s, "area");
  return over_surface(s, [](const SurfaceJet& at) { return length(cross(at.du, at.dv)); });
}

double volume(const Surface& s) {
  require_closed(s, "volume");
  const Vec3d origin = s.points[0];  // near, so that little cancels
  return over_surface(s, [origin](const SurfaceJet& at) { return dot(at.point - origin, cross(at.du, at.dv)) / 3.0; });
}

Surface outwards(const Surface& s) { return volume(s) < 0.0 ? reversed(s, Along::u) : s; }

}  // namespace trocar::geometry::nurbs
