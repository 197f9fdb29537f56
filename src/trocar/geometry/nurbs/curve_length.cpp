#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/geometry/nurbs/curve_length.hpp>
#include <trocar/geometry/nurbs/quadrature.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr double kLengthSlack = 1e-12;  // of the control polygon's length
constexpr int kMostHalvings = 24;

double speed(const Curve& curve, double u) { return length(jet(curve, u).first); }

double length_of_piece(const Curve& curve, double a, double b, double slack, int halvings) {
  const auto f = [&curve](double u) { return speed(curve, u); };
  const double whole = gauss5(a, b, f), middle = 0.5 * (a + b);
  const double halves = gauss5(a, middle, f) + gauss5(middle, b, f);
  if (std::fabs(whole - halves) <= slack || halvings == 0) return halves;
  return length_of_piece(curve, a, middle, slack, halvings - 1) +
         length_of_piece(curve, middle, b, slack, halvings - 1);
}

double polygon_length(const Curve& curve) {
  double sum = 0.0;
  for (std::size_t i = 1; i < curve.points.size(); ++i) sum += length(curve.points[i] - curve.points[i - 1]);
  return sum;
}

}  // namespace

double length(const Curve& curve, double a, double b) {
  require_valid(curve, "length");
  if (!(a <= b) || a < curve.knots.start() || b > curve.knots.end())
    throw std::invalid_argument("length: two ascending parameters in the domain expected");
  const double slack = kLengthSlack * polygon_length(curve);
  double sum = 0.0;
  const std::vector<double> ends = breaks(curve.knots);
  for (std::size_t s = 0; s + 1 < ends.size(); ++s) {
    const double from = std::max(a, ends[s]), to = std::min(b, ends[s + 1]);
    if (from < to) sum += length_of_piece(curve, from, to, slack, kMostHalvings);
  }
  return sum;
}

double length(const Curve& curve) { return length(curve, curve.knots.start(), curve.knots.end()); }

double parameter_after(const Curve& curve, double s) {
  require_valid(curve, "parameter_after");
  double a = curve.knots.start(), b = curve.knots.end(), done = 0.0;
  if (!(s > 0.0)) return a;
  const std::vector<double> ends = breaks(curve.knots);
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const double piece = length(curve, ends[k], ends[k + 1]);
    if (done + piece >= s || k + 2 == ends.size()) {
      if (done + piece <= s) return ends[k + 1];
      a = ends[k], b = ends[k + 1];
      break;
    }
    done += piece;
  }
  // Newton on the way; halves where that leaves the bracket.
  const double first = a;
  double u = 0.5 * (a + b);
  for (int step = 0; step < 60; ++step) {
    const double off = done + length(curve, first, u) - s, fast = speed(curve, u);
    if (std::fabs(off) <= kLengthSlack * s) break;
    (off > 0.0 ? b : a) = u;
    const double next = fast > 0.0 ? u - off / fast : a;
    u = next > a && next < b ? next : 0.5 * (a + b);
  }
  return u;
}

std::vector<double> parameters_by_length(const Curve& curve, int count) {
  if (count < 2) throw std::invalid_argument("parameters_by_length: at least 2 expected");
  const double whole = length(curve);
  std::vector<double> result{curve.knots.start()};
  for (int i = 1; i + 1 < count; ++i) result.push_back(parameter_after(curve, whole * i / (count - 1)));
  result.push_back(curve.knots.end());
  return result;
}

}  // namespace trocar::geometry::nurbs
