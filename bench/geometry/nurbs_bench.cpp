// What NURBS cost that move while somebody works on them: points with normals on a fixed grid of parameters (the figure
// is points a second on one core), single points, closest points, rows of W, and a fit.
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include <trocar/geometry/nurbs/closest.hpp>
#include <trocar/geometry/nurbs/grid.hpp>
#include <trocar/geometry/nurbs/mesh.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>
#include <trocar/geometry/nurbs/weights.hpp>
#include <trocar/geometry/nurbs_fit/fit.hpp>
#include <trocar/geometry/nurbs_shapes/surface_makers.hpp>

namespace {

using namespace trocar;
namespace nurbs = trocar::geometry::nurbs;

// A body of an organ's size as fits make them: cubic, 16 control points around and 24 along.
nurbs::Surface organ() {
  nurbs::BodyFitOptions options;
  options.around = 16, options.along = 24, options.rounds = 3;
  const nurbs::Surface egg = nurbs::ellipsoid({}, {0.02, 0, 0}, {0, 0.015, 0}, {0, 0, 0.04});
  return nurbs::fit_body(nurbs::tessellate(egg, nurbs::Steps{6, 6}).mesh, options).surface;
}

nurbs::Surface rational() { return nurbs::elevated(nurbs::torus({}, {0, 0, 1}, 0.03, 0.01), nurbs::Along::u); }

std::vector<double> even(const nurbs::Knots& knots, int count) {
  std::vector<double> result;
  for (int k = 0; k < count; ++k) result.push_back(knots.start() + knots.extent() * (k + 0.5) / count);
  return result;
}

void points_with_normals(benchmark::State& state, const nurbs::Surface& surface) {
  const int n = static_cast<int>(state.range(0));
  nurbs::GridEvaluator grid(surface, even(surface.u, n), even(surface.v, n));
  std::vector<Vec3d> points = surface.points, positions(static_cast<std::size_t>(n) * n), normals(positions.size());
  double sway = 0.0;
  for (auto _ : state) {
    sway = sway > 1e-4 ? 0.0 : sway + 1e-6;
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = surface.points[i] + Vec3d{sway, 0.0, 0.0};
    grid.evaluate(points, positions, normals);
    benchmark::DoNotOptimize(positions.data());
    benchmark::DoNotOptimize(normals.data());
  }
  state.counters["points"] = benchmark::Counter(double(state.iterations()) * n * n, benchmark::Counter::kIsRate);
}
void nurbs_grid_organ(benchmark::State& state) { points_with_normals(state, organ()); }
void nurbs_grid_rational(benchmark::State& state) { points_with_normals(state, rational()); }
BENCHMARK(nurbs_grid_organ)->Arg(32)->Arg(100)->Arg(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(nurbs_grid_rational)->Arg(100)->Unit(benchmark::kMicrosecond);

void nurbs_single_point_with_normal(benchmark::State& state) {
  const nurbs::Surface surface = organ();
  double u = 0.0;
  for (auto _ : state) {
    u = u > 1.0 ? 0.0 : u + 0.001;
    const nurbs::SurfaceJet at = nurbs::jet(surface, u, 0.4);
    benchmark::DoNotOptimize(cross(at.du, at.dv));
  }
}
BENCHMARK(nurbs_single_point_with_normal);

void nurbs_row_of_w(benchmark::State& state) {
  const nurbs::Surface surface = organ();
  const nurbs::Nodes nodes = nurbs::nodes_of(surface);
  double u = 0.0;
  for (auto _ : state) {
    u = u > 1.0 ? 0.0 : u + 0.001;
    benchmark::DoNotOptimize(nurbs::node_weights_at(surface, nodes, u, 0.4).data());
  }
}
BENCHMARK(nurbs_row_of_w);

// Points a millimetre off the surface: found anywhere, and followed from where they were.
void nurbs_closest_anywhere(benchmark::State& state) {
  const nurbs::Surface surface = organ();
  const nurbs::ClosestOnSurface seeker(surface);
  double u = 0.0;
  for (auto _ : state) {
    u = u > 1.0 ? 0.0 : u + 0.01;
    benchmark::DoNotOptimize(
        seeker.find(nurbs::point(surface, u, 0.4) + 0.001 * nurbs::normal(surface, u, 0.4)).distance);
  }
}
BENCHMARK(nurbs_closest_anywhere)->Unit(benchmark::kMicrosecond);

void nurbs_closest_followed(benchmark::State& state) {
  const nurbs::Surface surface = organ();
  double u = 0.0;
  for (auto _ : state) {
    u = u > 1.0 ? 0.0 : u + 0.01;
    const Vec3d p = nurbs::point(surface, u, 0.4) + 0.001 * nurbs::normal(surface, u, 0.4);
    benchmark::DoNotOptimize(nurbs::closest_from(surface, p, u + 0.01, 0.41).distance);
  }
}
BENCHMARK(nurbs_closest_followed)->Unit(benchmark::kMicrosecond);

void nurbs_fit_body(benchmark::State& state) {
  const nurbs::Surface egg = nurbs::ellipsoid({}, {0.02, 0, 0}, {0, 0.015, 0}, {0, 0, 0.04});
  const auto mesh = nurbs::tessellate(egg, nurbs::Steps{6, 6}).mesh;
  nurbs::BodyFitOptions options;
  options.around = 16, options.along = 24;
  for (auto _ : state) benchmark::DoNotOptimize(nurbs::fit_body(mesh, options).report.rms);
}
BENCHMARK(nurbs_fit_body)->Unit(benchmark::kMillisecond);

}  // namespace
