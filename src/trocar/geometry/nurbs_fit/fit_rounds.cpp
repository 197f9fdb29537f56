#include <algorithm>
#include <cmath>

#include <trocar/geometry/nurbs/closest.hpp>
#include <trocar/geometry/nurbs_fit/fit_rounds.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr double kNoBetter = 1e-3;
constexpr double kStiffAtFirst = 4.0;  // times the smoothing, halved from round to round

Surface solved(const Unknowns& unknowns, const Samples& samples, double smoothing, const FitRounds& rounds) {
  SurfaceSystem system(unknowns);
  for (std::size_t i = 0; i < samples.points.size(); ++i)
    system.add_point(samples.parameters[i][0], samples.parameters[i][1], samples.points[i], samples.shares[i]);
  system.add_bending(smoothing, rounds.way_u, rounds.way_v);
  return system.solve();
}

// Moves the parameters to where the surface is nearest; the mean square distance.
double correct_parameters(const Surface& surface, Samples& samples) {
  double sum = 0.0;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    auto& [u, v] = samples.parameters[i];
    const SurfaceFoot foot = closest_from(surface, samples.points[i], u, v);
    u = foot.u, v = foot.v;
    sum += samples.shares[i] * foot.distance * foot.distance;
  }
  return sum;
}

}  // namespace

Surface fit_in_rounds(const Unknowns& unknowns, Samples& samples, FitRounds& rounds) {
  double stiff = kStiffAtFirst, last = 0.0;
  Surface surface;
  for (rounds.done = 0; rounds.done < std::max(1, rounds.rounds);) {
    surface = solved(unknowns, samples, stiff * rounds.smoothing, rounds);
    const double square = correct_parameters(surface, samples);
    ++rounds.done;
    const bool settled = stiff <= 1.0 && square > (1.0 - kNoBetter) * last;
    if (settled) break;
    last = stiff <= 1.0 ? square : 1e300;
    stiff = std::max(1.0, 0.5 * stiff);
  }
  return surface;
}

}  // namespace trocar::geometry::nurbs
