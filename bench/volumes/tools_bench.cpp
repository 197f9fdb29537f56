// Reading, segmentation tools and organs on a block of 256^3 with a ball of radius 80 and noise.
#include <benchmark/benchmark.h>

#include <trocar/core/random.hpp>
#include <trocar/volumes/files/volume_file.hpp>
#include <trocar/volumes/files/volume_writer.hpp>
#include <trocar/volumes/organ/centre_line.hpp>
#include <trocar/volumes/organ/label_surface.hpp>
#include <trocar/volumes/segment/brush.hpp>
#include <trocar/volumes/segment/islands.hpp>
#include <trocar/volumes/segment/shape_tools.hpp>
#include <trocar/volumes/segment/threshold.hpp>

namespace trocar::volumes {
namespace {

struct Organ {
  Volume volume;
  Labels labels;

  Organ() {
    volume.grid.size = {256, 256, 256};
    volume.stored.resize(volume.grid.count());
    core::Random random(2);
    for (std::size_t i = 0; i < volume.stored.size(); ++i) {
      const Index3 v = volume.grid.place(i);
      const Vec3d p{v[0] - 127.5, v[1] - 127.5, v[2] - 127.5};
      volume.stored[i] = std::int16_t((length(p) < 80 ? 80 : -100) + 60 * (random.uniform() - 0.5));
    }
    labels = on_grid_of(volume);
    apply(labels, thresholded(volume, labels, {20, 200}, 1));
  }
};
const Organ& organ() {
  static const Organ one;
  return one;
}

void BM_Threshold(benchmark::State& state) {
  const Labels empty = on_grid_of(organ().volume);
  for (auto _ : state) benchmark::DoNotOptimize(thresholded(organ().volume, empty, {20, 200}, 1).runs.data());
}
void BM_BrushOf10Millimetres(benchmark::State& state) {
  const Vec3d at[] = {{60, 60, 60}};
  for (auto _ : state)
    benchmark::DoNotOptimize(painted(organ().volume, organ().labels, at, {.radius_mm = 10}, 2).runs.data());
}
void BM_GrowFromClick(benchmark::State& state) {
  const Labels empty = on_grid_of(organ().volume);
  const Index3 seed[] = {{128, 128, 128}};
  for (auto _ : state) benchmark::DoNotOptimize(grown(organ().volume, empty, seed, {20, 200}, 1).runs.data());
}
void BM_GrowFromSeeds(benchmark::State& state) {
  Labels seeds = on_grid_of(organ().volume);
  const Vec3d inside[] = {{128, 128, 128}}, outside[] = {{10, 10, 10}};
  apply(seeds, painted(organ().volume, seeds, inside, {.radius_mm = 10}, 1));
  apply(seeds, painted(organ().volume, seeds, outside, {.radius_mm = 5}, 2));
  for (auto _ : state)
    benchmark::DoNotOptimize(grown_from_labels(organ().volume, seeds, {.margin_mm = 500}).runs.data());
}
void BM_LargestIsland(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(largest_kept(organ().volume, organ().labels, 1).runs.data());
}
void BM_Margin(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(margin_moved(organ().volume, organ().labels, 1, 3).runs.data());
}
void BM_SmoothKeepingVolume(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(
        smoothed(organ().volume, organ().labels, 1, 3, Smoothing::keeps_volume).change.runs.data());
}
void BM_Surface(benchmark::State& state) {
  std::size_t triangles = 0;
  for (auto _ : state) triangles = label_surface(organ().labels, 1).mesh.triangles.size();
  state.counters["triangles"] = double(triangles);
}
void BM_CentreTree(benchmark::State& state) {
  Labels tube = on_grid_of(organ().volume);
  const Vec3d stroke[] = {{20, 128, 20}, {128, 128, 128}, {230, 60, 200}};
  const Vec3d side[] = {{128, 128, 128}, {200, 220, 60}};
  apply(tube, painted(organ().volume, tube, stroke, {.radius_mm = 6}, 1));
  apply(tube, painted(organ().volume, tube, side, {.radius_mm = 4}, 1));
  for (auto _ : state) benchmark::DoNotOptimize(centre_tree(tube, 1).points.data());
}
void BM_ReadNiftiPacked(benchmark::State& state) {
  write_volume("volumes_bench.nii.gz", organ().volume);
  for (auto _ : state) benchmark::DoNotOptimize(read_volume("volumes_bench.nii.gz").volume.stored.data());
  std::filesystem::remove("volumes_bench.nii.gz");
}
void BM_ReadDicomSeries(benchmark::State& state) {
  const std::filesystem::path folder = "../shared/data/volumes/totalsegmentator/example_ct_dicom_raw";
  if (!std::filesystem::exists(folder)) return state.SkipWithError("the data folder is absent");
  for (auto _ : state) benchmark::DoNotOptimize(read_volume(folder).volume.stored.data());
}
BENCHMARK(BM_Threshold)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_BrushOf10Millimetres)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_GrowFromClick)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_GrowFromSeeds)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_LargestIsland)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Margin)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_SmoothKeepingVolume)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Surface)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_CentreTree)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_ReadNiftiPacked)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_ReadDicomSeries)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace trocar::volumes
