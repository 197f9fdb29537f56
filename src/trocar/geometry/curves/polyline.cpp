#include <algorithm>
#include <stdexcept>
#include <utility>

#include <trocar/geometry/curves/polyline.hpp>

namespace trocar::geometry {
namespace {

constexpr int kPiecesPerSpan = 64;

struct Dense {
  std::vector<double> parameters;
  Polyline line;
};
Dense dense(const NurbsCurve& curve) {
  const int pieces = kPiecesPerSpan * static_cast<int>(curve.control.size());
  Dense result;
  std::vector<Vec3d> points;
  for (int i = 0; i <= pieces; ++i) {
    const double share = double(i) / pieces;
    result.parameters.push_back(i == pieces ? curve.end() : curve.start() + share * (curve.end() - curve.start()));
    points.push_back(curve.point(result.parameters.back()));
  }
  result.line = Polyline(std::move(points));
  return result;
}

// The piece [i, i+1] of the ascending `arc` in which s lies, and where in it.
std::pair<std::size_t, double> locate(const std::vector<double>& arc, double s) noexcept {
  if (arc.size() < 2 || !(s > 0.0)) return {0, 0.0};
  const auto above = std::upper_bound(arc.begin(), arc.end(), s);
  if (above == arc.end()) return {arc.size() - 2, 1.0};
  const std::size_t i = static_cast<std::size_t>(above - arc.begin()) - 1;
  return {i, (s - arc[i]) / (arc[i + 1] - arc[i])};
}

}  // namespace

Polyline::Polyline(std::vector<Vec3d> line) : points(std::move(line)), arc(points.size(), 0.0) {
  for (std::size_t i = 1; i < points.size(); ++i) arc[i] = arc[i - 1] + trocar::length(points[i] - points[i - 1]);
}

Vec3d Polyline::point(double s) const noexcept {
  const auto [i, share] = locate(arc, s);
  return i + 1 < points.size() ? points[i] + share * (points[i + 1] - points[i]) : points[i];
}

std::vector<Vec3d> Polyline::resampled(int count) const {
  if (count < 2 || points.empty()) throw std::invalid_argument("resampled: at least 2 points of a line expected");
  std::vector<Vec3d> result;
  for (int i = 0; i < count; ++i) result.push_back(point(length() * (double(i) / (count - 1))));
  result.back() = points.back();
  return result;
}

std::vector<Vec3d> Polyline::resampled_by_step(double step) const {
  return resampled(1 + std::max(1, static_cast<int>(length() / step + 0.5)));
}

std::vector<double> arc_parameters(const NurbsCurve& curve, int count) {
  if (count < 2) throw std::invalid_argument("arc_parameters: at least 2 points expected");
  const Dense d = dense(curve);
  std::vector<double> result;
  const int steps = curve.periodic ? count : count - 1;
  for (int k = 0; k < count; ++k) {
    const auto [i, share] = locate(d.line.arc, d.line.length() * (double(k) / steps));
    result.push_back(d.parameters[i] + share * (d.parameters[i + 1] - d.parameters[i]));
  }
  if (!curve.periodic) result.back() = curve.end();
  return result;
}

std::vector<Vec3d> sampled_by_arc(const NurbsCurve& curve, int count) {
  std::vector<Vec3d> result;
  for (double u : arc_parameters(curve, count)) result.push_back(curve.point(u));
  return result;
}

double length(const NurbsCurve& curve) { return dense(curve).line.length(); }

}  // namespace trocar::geometry
