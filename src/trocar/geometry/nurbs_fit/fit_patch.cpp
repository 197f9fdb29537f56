#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/geometry/nurbs_fit/fit.hpp>
#include <trocar/geometry/nurbs_fit/fit_report.hpp>
#include <trocar/geometry/nurbs_fit/fit_rounds.hpp>
#include <trocar/geometry/nurbs_fit/square_map.hpp>
#include <trocar/numerics/symmetric3.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr double kSmoothedShareOfPatch = 1.0 / 6.0;  // of the way between control points

Unknowns unknowns_of_patch(const PatchFitOptions& o) {
  if (o.count_u < 4 || o.count_v < 4)
    throw std::invalid_argument("fit_patch: at least 4 control points each way expected");
  return free_unknowns(clamped_uniform(3, o.count_u), clamped_uniform(3, o.count_v));
}

FitRounds rounds_of_patch(const PatchFitOptions& o, double way_u, double way_v) {
  const double step = std::sqrt(way_u / (o.count_u - 3) * way_v / (o.count_v - 3));
  return {o.smoothing > 0.0 ? o.smoothing : kSmoothedShareOfPatch * step, way_u, way_v, o.rounds, 0};
}

}  // namespace

Fit fit_patch(const TriMesh& mesh, const PatchFitOptions& options) {
  const Unknowns unknowns = unknowns_of_patch(options);
  const SquareMap map = map_to_square(mesh);
  FitRounds rounds = rounds_of_patch(options, map.way_u, map.way_v);
  const double spacing = 0.5 * std::min(map.way_u / (options.count_u - 3), map.way_v / (options.count_v - 3));
  Samples samples = samples_of(mesh, map.parameters, spacing);
  Fit fit{fit_in_rounds(unknowns, samples, rounds), {}};
  fit.report = compare(fit.surface, mesh);
  fit.report.rounds = rounds.done;
  return fit;
}

Fit fit_patch(std::span<const Vec3d> cloud, const PatchFitOptions& options) {
  const Unknowns unknowns = unknowns_of_patch(options);
  require_cloud(cloud, "fit_patch");
  Vec3d middle;
  const numerics::Principal axes = numerics::principal(numerics::covariance(cloud, middle));
  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
  for (const Vec3d& p : cloud)
    for (int k = 0; k < 2; ++k) {
      const double along = dot(p - middle, axes.axis[k]);
      low[k] = std::min(low[k], along), high[k] = std::max(high[k], along);
    }
  if (!(high[1] > low[1])) throw std::invalid_argument("fit_patch: points that do not all lie on a line expected");
  Samples samples;
  for (const Vec3d& p : cloud) {
    std::array<double, 2> at{};
    for (int k = 0; k < 2; ++k) at[k] = (dot(p - middle, axes.axis[k]) - low[k]) / (high[k] - low[k]);
    samples.points.push_back(p);
    samples.parameters.push_back(at);
    samples.shares.push_back(1.0 / double(cloud.size()));
  }
  FitRounds rounds = rounds_of_patch(options, high[0] - low[0], high[1] - low[1]);
  Fit fit{fit_in_rounds(unknowns, samples, rounds), {}};
  fit.report = residuals_of(fit.surface, cloud);
  fit.report.rounds = rounds.done;
  return fit;
}

}  // namespace trocar::geometry::nurbs
