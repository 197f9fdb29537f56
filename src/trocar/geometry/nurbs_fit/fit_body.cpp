#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/geometry/nurbs/closest.hpp>
#include <trocar/geometry/nurbs/closure.hpp>
#include <trocar/geometry/nurbs_fit/fit.hpp>
#include <trocar/geometry/nurbs_fit/fit_report.hpp>
#include <trocar/geometry/nurbs_fit/fit_rounds.hpp>
#include <trocar/geometry/nurbs_fit/sphere_map.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/numerics/symmetric3.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr double kSmoothedShare = 1.0 / 6.0;  // of the way between control points

Unknowns unknowns_of(const BodyFitOptions& o) {
  if (o.around < 4 || o.along < 5)
    throw std::invalid_argument("fit_body: at least 4 control points around and 5 along expected");
  return sphere_unknowns(periodic_uniform(3, o.around), clamped_uniform(3, o.along));
}

FitRounds rounds_of(const BodyFitOptions& o, double around, double length) {
  const double step = std::sqrt(around / o.around * length / (o.along - 3));
  return {o.smoothing > 0.0 ? o.smoothing : kSmoothedShare * step, around, length, o.rounds, 0};
}

}  // namespace

Fit fit_body(const TriMesh& mesh, const BodyFitOptions& options) {
  const Unknowns unknowns = unknowns_of(options);
  std::array<int, 2> poles = poles_farthest_along_edges(mesh);
  if (options.poles) poles = {nearest_vertex(mesh, (*options.poles)[0]), nearest_vertex(mesh, (*options.poles)[1])};
  const SphereMap map = map_to_sphere(mesh, poles);
  std::vector<std::array<double, 2>> parameters;
  for (std::size_t i = 0; i < map.u.size(); ++i) parameters.push_back({map.u[i], map.v[i]});
  FitRounds rounds = rounds_of(options, map.around, map.length);
  const double spacing = 0.5 * std::min(map.around / options.around, map.length / (options.along - 3));
  Samples samples = samples_of(mesh, parameters, spacing, true, {poles[0], poles[1]});
  Fit fit{fit_in_rounds(unknowns, samples, rounds), {}};
  fit.surface = outwards(fit.surface);
  fit.report = compare(fit.surface, mesh);
  fit.report.rounds = rounds.done;
  return fit;
}

Fit fit_body(std::span<const Vec3d> cloud, const BodyFitOptions& options) {
  const Unknowns unknowns = unknowns_of(options);
  require_cloud(cloud, "fit_body");
  Vec3d middle;
  const numerics::Principal axes = numerics::principal(numerics::covariance(cloud, middle));
  Samples samples;
  double radius = 0.0;
  for (const Vec3d& p : cloud) {
    const Vec3d d = p - middle;
    const double x = dot(d, axes.axis[1]), y = dot(d, axes.axis[2]), z = dot(d, axes.axis[0]), r = length(d);
    const double turn = portable::atan2(y, x) / portable::two_pi;
    samples.points.push_back(p);
    samples.parameters.push_back({turn - std::floor(turn), r > 0.0 ? 1.0 - portable::acos(z / r) / portable::pi : 0.5});
    samples.shares.push_back(1.0 / double(cloud.size()));
    radius += r / double(cloud.size());
  }
  FitRounds rounds = rounds_of(options, portable::two_pi * radius, portable::pi * radius);
  Fit fit{fit_in_rounds(unknowns, samples, rounds), {}};
  fit.surface = outwards(fit.surface);
  fit.report = residuals_of(fit.surface, cloud);
  fit.report.volume_of_fit = volume(fit.surface);
  fit.report.rounds = rounds.done;
  return fit;
}

}  // namespace trocar::geometry::nurbs
