// A closed mesh into a field, and into a body of about ten thousand cells.
#include <benchmark/benchmark.h>

#include <trocar/geometry/surfaces/loft.hpp>
#include <trocar/geometry/tets/stuffing.hpp>

namespace trocar::geometry {
namespace {

/// A bent organ of about 80 x 40 x 30 mm.
TriMesh organ() {
  const std::vector<Section> sections{{{0, 0, 0}, {0.018, 0, 0}, {0, 0.012, 0.002}, 2},
                                      {{0, 0.004, 0.02}, {0.022, 0, 0}, {0, 0.016, -0.001}, 2.2},
                                      {{0, 0.004, 0.04}, {0.02, 0, 0}, {0, 0.015, -0.002}, 2},
                                      {{0, -0.002, 0.058}, {0.013, 0, 0}, {0, 0.01, 0.003}, 2}};
  return tessellate(loft(sections), 0.0015);
}

void field_of_a_mesh(benchmark::State& state) {
  const TriMesh mesh = organ();
  for (auto _ : state) benchmark::DoNotOptimize(field_of(mesh));
  state.counters["triangles"] = double(mesh.triangles.size());
}
BENCHMARK(field_of_a_mesh)->Unit(benchmark::kMillisecond);

void stuffed_field(benchmark::State& state) {
  const Field field = field_of(organ());
  std::size_t cells = 0;
  for (auto _ : state) cells = stuffed(field, 0.0043).cells.size();
  state.counters["cells"] = double(cells);
}
BENCHMARK(stuffed_field)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace trocar::geometry
