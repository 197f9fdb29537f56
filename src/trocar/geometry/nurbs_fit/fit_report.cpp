#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/nurbs/closest.hpp>
#include <trocar/geometry/nurbs/closure.hpp>
#include <trocar/geometry/nurbs/mesh.hpp>
#include <trocar/geometry/nurbs_fit/fit_report.hpp>
#include <trocar/geometry/volumes/field.hpp>

namespace trocar::geometry::nurbs {

FitReport residuals_of(const Surface& surface, std::span<const Vec3d> points) {
  FitReport report;
  const ClosestOnSurface seeker(surface);
  double sum = 0.0;
  for (const Vec3d& p : points) {
    const double distance = seeker.find(p).distance;
    report.residuals.push_back(distance);
    report.greatest = std::max(report.greatest, distance);
    sum += distance * distance;
  }
  report.rms = points.empty() ? 0.0 : std::sqrt(sum / double(points.size()));
  return report;
}

void require_cloud(std::span<const Vec3d> cloud, const char* who) {
  if (cloud.size() < 16) throw std::invalid_argument(tr("{}: at least 16 points expected, got {}", who, cloud.size()));
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (!finite(cloud[i])) throw std::invalid_argument(tr("{}: point {} is not a number", who, i));
}

FitReport compare(const Surface& surface, const TriMesh& mesh) {
  constexpr int kSteps = 3;  // to a span
  FitReport report = residuals_of(surface, mesh.positions);
  const auto distance = distance_to(mesh);
  const SurfaceMesh made = tessellate(surface, Steps{kSteps, kSteps});
  double sum = 0.0;
  for (const Vec3d& p : made.mesh.positions) {
    const double off = distance(p);
    report.back_greatest = std::max(report.back_greatest, off);
    sum += off * off;
  }
  report.back_rms = std::sqrt(sum / double(made.mesh.positions.size()));
  if (check_edges(mesh).closed()) report.volume_of_mesh = std::fabs(volume(mesh));
  if (closure_of(surface).closed()) report.volume_of_fit = std::fabs(volume(surface));
  return report;
}

}  // namespace trocar::geometry::nurbs
